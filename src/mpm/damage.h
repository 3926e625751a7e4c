/* Strength and fracture energy of solids on a grid: the crack band of Bazant and Oh (1983). Equation numbers:
   docs/theory/mlsmpm.md. */
#pragma once
#include "base/error.h"
#include "core/system.h"
#include "mpm/view.h"

/* TOBI_INVALID if strength and fracture energy do not belong together, or if cells of this size (m) are too
   large for them, eq. (21); TOBI_UNSUPPORTED for models that do not break. The text goes on from the name of
   the key to blame, which *key becomes. note: empty, or what the user should know of such cells. */
tobi_status mpm_damage_check(const tobi_solid_def *def, double cell, const char **key, char note[TOBI_NOTE],
                             tobi_error *err);
/* Writes strength and brittleness of a solid on cells of this size (m), eq. (20). */
void mpm_damage_describe(const tobi_solid_def *def, double cell, mpm_material *material);
/* Energy that cracks have taken from one particle so far, J, from its damage alone, eq. (19). */
double mpm_damage_spent(const mpm_view *v, int64_t i);

/* The free surface of isph on the lattice. */
#pragma once
#include "core/smoothing.h"
#include "sph/isph/view.h"

/* Sets v->surface_row, surface_force and lattice_count; v has the constants of the system and the choices.
   height: where p = 0, in spacings above the top row. */
void isph_surface_measure(isph_view *v, const tobi_smoothing_constants *c, double height);

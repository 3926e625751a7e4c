/* The passes of isph over particles, for tobi_launch. Equation numbers: docs/theory/isph.md. */
#pragma once
#include "exec/exec.h"
#include "sph/isph_pairs.h"

/* Moments, their inverse, what is missing at a free surface: eq. (2) to (5). */
extern const tobi_kernel isph_measure_geometry;
/* v += dt g. */
extern const tobi_kernel isph_add_gravity;
/* Rows of the pressure equation, eq. (6), and its source, eq. (8). totals: [0] sum of excess. */
extern const tobi_kernel isph_assemble_rows;
/* out = A in. */
extern const tobi_kernel isph_multiply;
/* v -= dt/rho grad p, eq. (9). totals: [0] sum of |grad p|. */
extern const tobi_kernel isph_kick;
/* Force of the pressure on the sides of the domain, eq. (11). totals: [0..2], N. */
extern const tobi_kernel isph_press_walls;
/* totals: [0] sum, [6] largest of |div v|, 1/s, away from a free surface. */
extern const tobi_kernel isph_measure_divergence;
/* The shift of positions, as an acceleration in accel, and the change of velocity that goes with it,
   eq. (10). */
extern const tobi_kernel isph_find_shift;
extern const tobi_kernel isph_use_change;

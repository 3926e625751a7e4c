/* The passes of isph over particles, for tobi_launch. Equation numbers: docs/theory/isph.md. */
#pragma once
#include "sph/isph_pairs.h"

/* Moments, their inverse, what is missing at a free surface: eq. (2) to (5). */
void isph_measure_geometry(const void *view, int64_t begin, int64_t end, double *totals);
/* v += dt g. */
void isph_add_gravity(const void *view, int64_t begin, int64_t end, double *totals);
/* Rows of the pressure equation, eq. (6), and its source, eq. (8). totals: [0] sum of excess. */
void isph_assemble_rows(const void *view, int64_t begin, int64_t end, double *totals);
/* out = A in. */
void isph_multiply(const void *view, int64_t begin, int64_t end, double *totals);
/* v -= dt/rho grad p, eq. (9). totals: [0] sum of |grad p|. */
void isph_kick(const void *view, int64_t begin, int64_t end, double *totals);
/* Force of the pressure on the sides of the domain, eq. (11). totals: [0..2], N. */
void isph_press_walls(const void *view, int64_t begin, int64_t end, double *totals);
/* totals: [0] sum, [6] largest of |div v|, 1/s, away from a free surface. */
void isph_measure_divergence(const void *view, int64_t begin, int64_t end, double *totals);
/* The shift of positions, as an acceleration in accel, and the change of velocity that goes with it,
   eq. (10). */
void isph_find_shift(const void *view, int64_t begin, int64_t end, double *totals);
void isph_use_change(const void *view, int64_t begin, int64_t end, double *totals);

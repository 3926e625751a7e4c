/* The free surface of isph on the lattice. */
#pragma once
#include "core/smoothing.h"
#include "sph/isph_view.h"

/* Sets v->surface_row and v->surface_force; v has the constants of the system. */
void isph_surface_measure(isph_view *v, const tobi_smoothing_constants *c);

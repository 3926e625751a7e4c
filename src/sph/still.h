/* Where the reference pressure of still water begins (core/still.h), step by step. */
#pragma once
#include "core/simulation.h"

/* Sets s->still to the reference below a drop of `low`, m; 0, a vessel without gravity across its walls and
   fluids of several densities have none. */
void sph_still_set(tobi_simulation *s, double low);
/* Drop of the free surface, m, but for the few deepest of its particles, which disorder may have made; 0
   where it has no more. After sph_measure_density, which leaves the drops in particles.delta. */
double sph_still_low(const tobi_simulation *s);
/* The drop to set in the step at hand: down with the surface at once, up slowly. */
double sph_still_follow(const tobi_simulation *s, double before, double low);

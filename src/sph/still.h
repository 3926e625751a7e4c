/* Where the reference pressure of still water begins (core/still.h), step by step. */
#pragma once
#include "core/simulation.h"

/* Sets s->still to the reference below a drop of `low`, m; 0, a vessel without gravity across its walls and
   fluids of several densities have none. */
void sph_still_set(tobi_simulation *s, double low);
/* Drop of the free surface, m, but for the few deepest of its particles, which disorder may have made; 0
   where it has no more. After sph_measure_density, which leaves the drops in particles.delta. */
double sph_still_low(const tobi_simulation *s);
/* *level, the drop of the last step, becomes that of the step at hand, by the surface of the last, `low`:
   down with it, by `speed` (m/s, of the fastest particle or body) at most, up slowly. *before: the reference
   that pressures refer to until then. */
void sph_still_move(tobi_simulation *s, tobi_still *before, double low, double speed, double *level);

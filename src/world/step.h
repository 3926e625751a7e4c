/* The step of a world that has started. */
#pragma once
#include "world/world.h"

/* One step, not longer than max_dt (s, 0 = any). TOBI_STOPPED: nothing has changed. */
tobi_status tobi_step_take(tobi_world *w, double max_dt, tobi_error *err);

/* The sums of all systems into w->sim.info. */
void tobi_step_sum_up(tobi_world *w);

/* Gravity in time, and the frame of a tank that moves. */
#pragma once
#include "world/world.h"

/* Checks the field of the whole run. */
tobi_status tobi_world_start_drive(tobi_world *w, tobi_error *err);
/* Brings the largest acceleration so far up to a time, for bounds of steps and speeds. */
tobi_status tobi_world_sample_drive(tobi_world *w, double until, tobi_error *err);
/* m/s2: the largest acceleration of liquid at rest, gravity included, in a step that begins now. */
tobi_status tobi_world_find_pull(const tobi_world *w, double step, double *pull, tobi_error *err);
/* Finds sim.acceleration for the step that has just been chosen. */
tobi_status tobi_world_drive(tobi_world *w, tobi_error *err);
void tobi_world_free_drive(tobi_world *w);

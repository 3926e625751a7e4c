/* Gravity in time, and the frame of a tank that moves. */
#pragma once
#include "world/world.h"

/* Looks for the largest acceleration of the run, for bounds of steps and speeds. */
tobi_status tobi_world_start_drive(tobi_world *w, tobi_error *err);
/* Finds sim.acceleration for the step that has just been chosen. */
tobi_status tobi_world_drive(tobi_world *w, tobi_error *err);
void tobi_world_free_drive(tobi_world *w);

/* What a checkpoint and a caller change of a world between steps. */
#pragma once
#include "world/world.h"

/* For a state from a checkpoint, which is of this gravity already. */
void tobi_world_restore_gravity(tobi_world *w, const double gravity[3]);
/* Refuses to step while a body waits for the motion that it had when the checkpoint was written. */
tobi_status tobi_world_check_motions(const tobi_world *w, tobi_error *err);

/* The bodies that move by forces, as the world sees them. */
#pragma once
#include "io/store.h"
#include "world/world.h"

/* Prepares contact once all bodies stand where they start. Does nothing if no body is free or controlled, as
   the rest. */
tobi_status tobi_world_start_bodies(tobi_world *w, tobi_error *err);
/* Before the method's step: how long it may be for the bodies' sake. */
void tobi_world_cap_step(tobi_world *w);
/* Forces, control and contact after the method's step. */
tobi_status tobi_world_kick_bodies(tobi_world *w, tobi_error *err);

/* Bodies in checkpoints: poses, velocities and the impulses that the next step starts from. */
tobi_status tobi_world_put_bodies(tobi_world *w, tobi_store *f, tobi_error *err);
/* Puts all bodies where they were at w->sim.time. */
tobi_status tobi_world_get_bodies(tobi_world *w, tobi_store *f, tobi_error *err);

/* The bodies that move by forces, as the world sees them. */
#pragma once
#include "world/motors.h"
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
void tobi_world_name_body(int k, const char *what, char name[32]);
tobi_status tobi_world_put_bodies(tobi_world *w, tobi_store *f, tobi_error *err);

/* What a checkpoint has of the bodies, read and checked before anything of the world changes. */
typedef struct tobi_loaded_body tobi_loaded_body;
typedef struct tobi_loaded_bodies {
    tobi_loaded_body *body;      /* [body_count], owned */
    int count;
    double *contacts;            /* rows of TOBI_WARM, owned */
    double (*motors)[TOBI_MOTOR_DOUBLES];    /* of motors.h, owned */
    int64_t contact_count;
} tobi_loaded_bodies;
/* To be freed in any case. */
tobi_status tobi_world_read_bodies(tobi_world *w, tobi_store *f, tobi_loaded_bodies *l, tobi_error *err);
/* Takes all over; a failure has changed nothing. */
tobi_status tobi_world_take_bodies(tobi_world *w, tobi_loaded_bodies *l, tobi_error *err);
void tobi_loaded_bodies_free(tobi_loaded_bodies *l);

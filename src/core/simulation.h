/* What all systems of a world share: the definition, the threads, the bodies, the planes, the clock. */
#pragma once
#include "core/acceleration.h"
#include "core/body.h"
#include "core/cells.h"
#include "core/constraint.h"
#include "core/damping.h"
#include "core/nest.h"
#include "core/opening.h"
#include "core/plane.h"
#include "core/porous.h"
#include "core/scalar.h"
#include "core/soft.h"
#include "tobiuo/tobiuo.h"

enum { TOBI_STAGE_LIMIT = 32 };

/* Stage timers of a step, in the order of first use. */
typedef struct tobi_stages {
    const char *name[TOBI_STAGE_LIMIT];
    double seconds[TOBI_STAGE_LIMIT];
    int count;
} tobi_stages;

typedef struct tobi_simulation {
    tobi_world_def def;             /* strings inside are not used after creation            */
    tobi_exec exec;
    tobi_body *bodies;
    int body_count;
    tobi_constraints constraints;   /* owned by the world: joints between bodies             */
    tobi_fixed_plane plane[TOBI_PLANE_LIMIT];
    int plane_count;
    tobi_opening *openings;         /* owned by the world                                    */
    int opening_count;
    tobi_nest nest;
    tobi_float4 *before;            /* owned by the world: velocities before the step by id, for nests */
    int64_t before_room;
    tobi_damping damping[TOBI_DAMPING_LIMIT];
    int damping_count;
    tobi_porous porous[TOBI_POROUS_LIMIT];
    int porous_count;
    tobi_scalar scalar[TOBI_SCALAR_LIMIT];       /* by tobi_scalar_field */
    tobi_scalar_place scalar_place[TOBI_SCALAR_VALUE_LIMIT];
    int scalar_place_count;
    double scalar_power;            /* W, that their weight gives liquids in the last step           */
    tobi_acceleration acceleration; /* besides gravity, at the middle of the step             */
    double acceleration_change;     /* m/s2, largest of the run in the liquid of the start, without gravity */
    double acceleration_most[3];    /* m/s2, of the whole run with gravity; 0: gravity alone  */
    double time, dt;                /* s; dt of the last step                                */
    double way;                     /* s after `time`, where substeps have put bodies with a motion */
    int64_t step;
    int64_t body_first_id;          /* of the particles of bodies                            */
    int64_t next_id;                /* ids given so far to particles of all systems and bodies are below */
    double wall_speed;              /* m/s, fastest side of the domain                       */
    double body_speed;              /* m/s, fastest body point or side of the last step      */
    tobi_soft soft;                 /* solids that a liquid sees                             */
    tobi_step_info info;            /* of the last step, of all systems                      */
    tobi_stages stages;
    tobi_stop_fn stop;              /* of the caller, NULL = none                            */
    void *stop_user;
    int stopped;                    /* it asked to stop, in this call                        */
    int changed;                    /* 1: particles or bodies are not any more as the step found them */
} tobi_simulation;

/* The step to take where `dt` is stable and `max_dt` (0 = any) is left: the last eight steps to a time are
   equal, so that what depends on the step before is right there (decision 111). */
double tobi_simulation_fit_dt(double dt, double max_dt);

/* Of a particle of the first system, NULL where it is not known. */
static inline const tobi_float4 *tobi_simulation_before(const tobi_simulation *s, int64_t id)
{
    return s->before && id < s->before_room ? &s->before[id] : NULL;
}

/* The largest acceleration that liquid and bodies feel along an axis, and its size, m/s2. */
double tobi_simulation_pull(const tobi_simulation *s, int axis);
double tobi_simulation_pull_size(const tobi_simulation *s);

/* Asks the caller whether to stop, until the answer is yes: then 1. */
int tobi_simulation_stops(tobi_simulation *s);
/* The same as a status: TOBI_STOPPED, in words. A step that answers it has changed nothing. */
tobi_status tobi_simulation_check_stop(tobi_simulation *s, tobi_error *err);

/* Adds the seconds since *since to a stage and moves *since to now. */
void tobi_stage_end(tobi_stages *st, const char *name, double *since);

/* The complete state in one file: what the systems share, and each of them. Loading reads and checks all
   of it before the world changes. Drawback: while it loads, the state is in memory twice. */
#include "base/error.h"
#include "io/store.h"
#include "world/bodies.h"
#include "world/change.h"
#include "world/load_system.h"
#include "world/nest.h"
#include "world/openings.h"
#include "world/scalars.h"
#include "world/step.h"
#include "world/world.h"
#include "world/motors.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* To be raised whenever what a checkpoint holds changes; 0: from before there was a number. */
enum { FORMAT = 13, CLOCK = 5 };

static tobi_status check_format(tobi_store *f, const char *path, tobi_error *err)
{
    int64_t format = 0;
    TOBI_TRY(tobi_store_get_int(f, "format", &format, err));
    if (format == FORMAT) return TOBI_OK;
    return tobi_fail(err, TOBI_UNSUPPORTED,
                     "%s: a checkpoint of format %lld, written by another version of tobiuo; this one "
                     "goes on from format %d",
                     path, (long long)format, FORMAT);
}

static tobi_status put_clock(tobi_world *w, tobi_store *f, tobi_error *err)
{
    const tobi_simulation *s = &w->sim;
    const double clock[CLOCK] = { s->time, s->dt, s->body_speed, w->system[0].start_speed,
                                  w->system[0].pushed_speed };
    TOBI_TRY(tobi_store_put_int(f, "format", FORMAT, err));
    TOBI_TRY(tobi_store_put_int(f, "step", s->step, err));
    TOBI_TRY(tobi_store_put_int(f, "bodies", s->body_count, err));
    TOBI_TRY(tobi_store_put(f, "clock", TOBI_F64, CLOCK, 1, clock, err));
    TOBI_TRY(tobi_store_put(f, "gravity", TOBI_F64, 3, 1, s->def.gravity, err));
    if (s->opening_count > 0) {
        double way[TOBI_OPENING_LIMIT];
        tobi_openings_get(w, way);
        TOBI_TRY(tobi_store_put(f, "openings", TOBI_F64, s->opening_count, 1, way, err));
    }
    TOBI_TRY(tobi_scalars_put(w, f, err));
    TOBI_TRY(tobi_nest_put(w, f, err));
    return tobi_world_put_bodies(w, f, err);
}

tobi_status tobi_world_save(tobi_world *w, const char *path, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(path, "the path");
    TOBI_TRY(tobi_world_start(w, err));
    TOBI_TRY(tobi_world_check_whole(w, err));
    tobi_store *f;
    TOBI_TRY(tobi_store_create(path, &f, err));
    tobi_status status = put_clock(w, f, err);
    for (int k = 0; status == TOBI_OK && k < w->system_count; k++)
        status = tobi_system_put(&w->system[k], k, f, err);
    if (status == TOBI_OK) return tobi_store_commit(f, err);
    tobi_store_close(f);
    return status;
}

/* A checkpoint as read, before the world takes it over. */
typedef struct loaded {
    int64_t step;
    double clock[CLOCK], gravity[3], way[TOBI_OPENING_LIMIT], stored[TOBI_SCALAR_VALUE_LIMIT];
    tobi_loaded_system system[TOBI_SYSTEM_LIMIT];
    tobi_loaded_bodies bodies;
    uint8_t *seen;
    int64_t seen_ids;
} loaded;

static void free_loaded(loaded *l)
{
    for (int k = 0; k < TOBI_SYSTEM_LIMIT; k++) tobi_loaded_system_free(&l->system[k]);
    tobi_loaded_bodies_free(&l->bodies);
    free(l->seen);
}

static tobi_status check_bodies(const tobi_world *w, tobi_store *f, tobi_error *err)
{
    int64_t bodies;
    TOBI_TRY(tobi_store_get_int(f, "bodies", &bodies, err));
    if (bodies == w->sim.body_count) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "the checkpoint is of another scene: it has %lld bodies, the scene "
                     "%d", (long long)bodies, w->sim.body_count);
}

static tobi_status read_clock(tobi_store *f, const char *path, loaded *l, tobi_error *err)
{
    TOBI_TRY(tobi_store_get_int(f, "step", &l->step, err));
    TOBI_TRY(tobi_store_get(f, "clock", TOBI_F64, CLOCK, 1, l->clock, err));
    TOBI_TRY(tobi_store_get(f, "gravity", TOBI_F64, 3, 1, l->gravity, err));
    int good = l->step >= 0 && l->clock[0] >= 0;
    for (int k = 0; k < CLOCK; k++) good &= isfinite(l->clock[k]) != 0;
    for (int k = 0; k < 3; k++) good &= isfinite(l->gravity[k]) != 0;
    if (good) return TOBI_OK;
    return tobi_fail(err, TOBI_DAMAGED, "%s: its clock or gravity is no number", path);
}

static tobi_status read_openings(const tobi_world *w, tobi_store *f, const char *path, loaded *l,
                                 tobi_error *err)
{
    const int n = w->sim.opening_count;
    int good = 1;
    if (n > 0) TOBI_TRY(tobi_store_get(f, "openings", TOBI_F64, n, 1, l->way, err));
    for (int k = 0; k < n; k++) good &= isfinite(l->way[k]) && l->way[k] >= 0;
    return good ? TOBI_OK : tobi_fail(err, TOBI_DAMAGED, "%s: the flow of an inlet is no length", path);
}

static tobi_status read_all(tobi_world *w, tobi_store *f, const char *path, loaded *l, tobi_error *err)
{
    TOBI_TRY(check_format(f, path, err));
    TOBI_TRY(check_bodies(w, f, err));
    TOBI_TRY(read_clock(f, path, l, err));
    TOBI_TRY(read_openings(w, f, path, l, err));
    TOBI_TRY(tobi_scalars_get(w, f, path, l->stored, err));
    TOBI_TRY(tobi_nest_get(w, f, path, &l->seen, &l->seen_ids, err));
    for (int k = 0; k < w->system_count; k++)
        TOBI_TRY(tobi_system_get(&w->system[k], k, f, path, &l->system[k], err));
    return tobi_world_read_bodies(w, f, &l->bodies, err);
}

static void take_over(tobi_world *w, loaded *l)
{
    tobi_simulation *s = &w->sim;
    s->step = l->step;
    s->time = l->clock[0];
    s->dt = l->clock[1];
    s->body_speed = l->clock[2];
    for (int k = 0; k < s->porous_count; k++) {       /* known after a step */
        tobi_porous *z = &s->porous[k];
        z->force[0] = z->force[1] = z->force[2] = z->power = z->volume = 0;
    }
    for (int k = 0; k < s->scalar_place_count; k++) {
        s->scalar_place[k].flow = 0;
        s->scalar_place[k].stored = l->stored[k];
    }
    s->scalar_power = 0;
    tobi_openings_set(w, l->way);
    if (w->sim.nest.outer) tobi_nest_take(w, l->seen, l->seen_ids);
    l->seen = NULL;
    for (int k = 0; k < w->system_count; k++) tobi_system_take(&w->system[k], &l->system[k]);
    w->system[0].step = l->step;
    w->system[0].dt = l->clock[1];
    w->system[0].start_speed = l->clock[3];
    w->system[0].pushed_speed = l->clock[4];
    tobi_world_restore_gravity(w, l->gravity);
    for (int k = 0; k < w->system_count; k++) tobi_system_restore(&w->system[k], &l->system[k]);
    tobi_step_sum_up(w);
    w->fresh = w->idle_steps = 0;
    w->failure.status = TOBI_OK;
}

tobi_status tobi_world_load(tobi_world *w, const char *path, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(path, "the path");
    TOBI_TRY(tobi_world_start(w, err));
    tobi_store *f;
    TOBI_TRY(tobi_store_open(path, &f, err));
    loaded l = { 0 };
    tobi_status status = read_all(w, f, path, &l, err);
    if (status == TOBI_OK) tobi_motors_take(w, (const double (*)[TOBI_MOTOR_DOUBLES])l.bodies.motors);
    if (status == TOBI_OK) status = tobi_motors_tell(w, l.clock[0], 0, err);
    if (status == TOBI_OK) status = tobi_world_take_bodies(w, &l.bodies, err);
    if (status == TOBI_OK) take_over(w, &l);
    free_loaded(&l);
    tobi_store_close(f);
    return status;
}

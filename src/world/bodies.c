/* Prepares bodies for contact and describes the world to rigid/. Drawback: domains are boxes, so that
   a vessel is a body. */
#include "world/absorb.h"
#include "world/bodies.h"
#include "world/motors.h"
#include "base/error.h"
#include "rigid/dynamics.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void describe_world(const tobi_system *s, tobi_rigid_world *r)
{
    *r = (tobi_rigid_world){ .dimension = s->box.dimension, .threads = s->sim->exec.threads,
                             .planes = s->sim->plane, .plane_count = s->sim->plane_count };
    for (int a = 0; a < s->box.dimension; a++) {
        r->gravity[a] = s->sim->def.gravity[a];
        r->size[a] = s->box.size[a];
        r->wall[a] = s->box.periodic[a] ? 0 : (s->sim->def.wall_min[a] != TOBI_WALL_OPEN) +
                                              2*(s->sim->def.wall_max[a] != TOBI_WALL_OPEN);
    }
}

tobi_status tobi_world_start_bodies(tobi_world *w, tobi_error *err)
{
    enum { NOTES = 16000 };
    tobi_system *s = &w->system[0];
    tobi_rigid_world world;
    if (!tobi_body_any_free(s->sim->bodies, s->sim->body_count) || w->dynamics) return TOBI_OK;
    TOBI_TRY(tobi_motors_start(w, err));
    TOBI_TRY(tobi_constraints_start(&w->sim.constraints, w->sim.bodies, s->box.dimension, err));
    char *notes = malloc(NOTES);
    if (!notes) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for notes");
    describe_world(s, &world);
    world.lines = w->lines;
    world.line_count = w->line_count;
    world.constraints = &w->sim.constraints;
    tobi_status status = tobi_rigid_start(s->sim->bodies, s->sim->body_count, &world, notes, NOTES,
                                          &w->dynamics, err);
    if (status == TOBI_OK) status = tobi_world_add_notes(w, "body", NULL, notes, err);
    if (status == TOBI_OK) status = tobi_motors_note(w, err);
    free(notes);
    w->step_cap = s->sim->def.time_step_max;
    return status;
}

int tobi_world_find_body(const tobi_world *w, const char *name)
{
    for (int k = 0; k < w->sim.body_count; k++)
        if (strcmp(w->sim.bodies[k].name, name) == 0) return k;
    return -1;
}

void tobi_world_cap_step(tobi_world *w)
{
    if (!w->dynamics) return;
    double cap = tobi_rigid_step_limit(w->dynamics);
    w->sim.def.time_step_max = w->step_cap > 0 ? fmin(cap, w->step_cap) : cap;
}

tobi_status tobi_world_kick_bodies(tobi_world *w, tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    double clock = tobi_clock();
    if (!w->dynamics) return TOBI_OK;
    TOBI_TRY(tobi_rigid_step(w->dynamics, s->time, s->dt, err));
    tobi_stage_end(&s->stages, "bodies", &clock);
    return TOBI_OK;
}

void tobi_world_name_body(int k, const char *what, char name[32])
{
    snprintf(name, 32, "body_%04d%s", k, what);
}

static tobi_status put_contacts(const tobi_world *w, tobi_store *f, tobi_error *err)
{
    int64_t n = tobi_rigid_warm(w->dynamics, NULL);
    double *rows = malloc((size_t)(n + 1)*TOBI_WARM*sizeof *rows);
    if (!rows) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld contacts", (long long)n);
    tobi_rigid_warm(w->dynamics, rows);
    tobi_status status = tobi_store_put(f, "body_contacts", TOBI_F64, n*TOBI_WARM, 1, rows, err);
    free(rows);
    return status;
}

static tobi_status put_shape(const tobi_body *b, int k, tobi_store *f, tobi_error *err)
{
    const int64_t n = b->swimmer->count + TOBI_SWIMMER_MORE;
    double (*rows)[3] = malloc((size_t)n*sizeof *rows);
    char name[32];
    if (!rows) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the shape of '%s'", b->name);
    tobi_swimmer_save(b->swimmer, rows);
    tobi_world_name_body(k, "_shape", name);
    const tobi_status status = tobi_store_put(f, name, TOBI_F64, n, 3, rows, err);
    free(rows);
    return status;
}

/* See load_bodies.c. */
static tobi_status put_place(const tobi_body *b, int k, tobi_store *f, tobi_error *err)
{
    tobi_body_at place;
    char name[32];
    memcpy(place.centre, b->centre, sizeof place.centre);
    memcpy(place.frame, b->frame, sizeof place.frame);
    tobi_world_name_body(k, "_vertex", name);
    TOBI_TRY(tobi_store_put(f, name, TOBI_F64, b->mesh.vertex_count, 3, b->vertex, err));
    tobi_world_name_body(k, "_before", name);
    TOBI_TRY(tobi_store_put(f, name, TOBI_F64, b->mesh.vertex_count, 3, b->vertex_before, err));
    if (b->swimmer) TOBI_TRY(put_shape(b, k, f, err));
    tobi_world_name_body(k, "_place", name);
    return tobi_store_put(f, name, TOBI_F64, 4, 3, &place, err);
}

static tobi_status put_finer(const tobi_rigid *r, const char *name, tobi_store *f, tobi_error *err)
{
    double finer[7] = { [6] = r->finer_by };
    memcpy(finer, r->finer, sizeof r->finer);
    return tobi_store_put(f, name, TOBI_F64, 7, 1, finer, err);
}

static tobi_status put_body(tobi_body *b, int k, tobi_store *f, tobi_error *err)
{
    double load[7] = { [6] = b->motion_set };
    char name[32];
    memcpy(load, b->rigid.force, sizeof b->rigid.force);
    memcpy(load + 3, b->rigid.torque, sizeof b->rigid.torque);
    tobi_world_name_body(k, "", name);
    TOBI_TRY(tobi_store_put(f, name, TOBI_U8, (int64_t)sizeof b->info, 1, &b->info, err));
    tobi_world_name_body(k, "_state", name);
    TOBI_TRY(tobi_store_put(f, name, TOBI_F64, TOBI_RIGID_DOUBLES, 1, TOBI_RIGID_STATE(&b->rigid), err));
    tobi_world_name_body(k, "_load", name);
    TOBI_TRY(tobi_store_put(f, name, TOBI_F64, 7, 1, load, err));
    tobi_world_name_body(k, "_middle", name);
    TOBI_TRY(tobi_store_put(f, name, TOBI_F64, 3, 1, b->middle, err));
    tobi_world_name_body(k, "_memory", name);
    if (b->rigid.control)
        TOBI_TRY(tobi_store_put(f, name, TOBI_F64, TOBI_CONTROL_STATE, 1, b->rigid.memory, err));
    tobi_world_name_body(k, "_nest", name);
    if (b->rigid.finer_by) TOBI_TRY(put_finer(&b->rigid, name, f, err));
    tobi_world_name_body(k, "_edge", name);
    if (b->blade) TOBI_TRY(tobi_store_put(f, name, TOBI_F64, b->piece_count, 3, b->edge_share, err));
    return b->motion ? put_place(b, k, f, err) : TOBI_OK;
}

static tobi_status put_absorber(const tobi_world *w, int k, tobi_store *f, tobi_error *err)
{
    const double *state = tobi_absorb_state(w, k);
    char name[32];
    tobi_world_name_body(k, "_absorb", name);
    return state ? tobi_store_put(f, name, TOBI_F64, TOBI_ABSORB_DOUBLES, 1, state, err) : TOBI_OK;
}

tobi_status tobi_world_put_bodies(tobi_world *w, tobi_store *f, tobi_error *err)
{
    for (int k = 0; k < w->sim.body_count; k++) {
        TOBI_TRY(put_body(&w->sim.bodies[k], k, f, err));
        TOBI_TRY(put_absorber(w, k, f, err));
    }
    TOBI_TRY(tobi_motors_put(w, f, err));
    return w->dynamics ? put_contacts(w, f, err) : TOBI_OK;
}

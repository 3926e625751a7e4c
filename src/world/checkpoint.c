/* The complete state in one file: particle state fields in memory order, the clock, the method's memory, what
   the caller set between steps. Loading reads and checks all of it before the world changes. Drawback: while
   it loads, the state is in memory twice. */
#include "base/error.h"
#include "io/store.h"
#include "world/bodies.h"
#include "world/change.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* To be raised whenever what a checkpoint holds changes; 0: from before there was a number. */
enum { FORMAT = 7 };

static tobi_status check_format(tobi_store *f, const char *path, tobi_error *err)
{
    int64_t format = 0;
    tobi_error none;
    if (tobi_store_get_int(f, "format", &format, &none) == TOBI_OK && format == FORMAT) return TOBI_OK;
    return tobi_fail(err, TOBI_UNSUPPORTED,
                     "%s: a checkpoint of format %lld, written by another version of tobiuo; this one "
                     "goes on from format %d",
                     path, (long long)format, FORMAT);
}

/* What the method keeps besides. */
static tobi_status put_rows(tobi_world *w, tobi_store *f, tobi_error *err)
{
    double *rows = NULL;
    int64_t count = 0;
    if (!w->method->keep) return TOBI_OK;
    TOBI_TRY(w->method->keep(&w->sim, w->method_state, &rows, &count, err));
    tobi_status status = tobi_store_put(f, "rows", TOBI_F64, count, TOBI_RECALL_ROW, rows, err);
    free(rows);
    return status;
}

/* A state field as columns of a basic type. */
static void shape_of(const tobi_field_ref *f, tobi_vtk_type *type, int *components)
{
    *components = f->bytes == sizeof(tobi_double3)   ? 3
                  : f->bytes == sizeof(tobi_columns) ? 12
                  : f->bytes == sizeof(tobi_float4)  ? 4
                                                     : 1;
    *type = f->bytes == sizeof(tobi_double3) ? TOBI_F64
            : f->bytes % 16 == 0 || f->bytes == 4 ? TOBI_F32
            : f->bytes == 8                   ? TOBI_I64
                                              : TOBI_U8;
}

static tobi_status put_clock(tobi_world *w, tobi_store *f, tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    double *memory;
    int n = w->method->memory(w->method_state, &memory);
    TOBI_TRY(tobi_store_put_int(f, "format", FORMAT, err));
    TOBI_TRY(tobi_store_put_text(f, "method", w->method->name, err));
    TOBI_TRY(tobi_store_put_int(f, "step", s->step, err));
    TOBI_TRY(tobi_store_put_int(f, "bodies", s->body_count, err));
    TOBI_TRY(tobi_store_put_real(f, "spacing", s->smoothing.spacing, err));
    double clock[4] = {s->time, s->dt, s->body_speed, s->start_speed};
    TOBI_TRY(tobi_store_put(f, "clock", TOBI_F64, 4, 1, clock, err));
    TOBI_TRY(tobi_store_put(f, "gravity", TOBI_F64, 3, 1, s->def.gravity, err));
    TOBI_TRY(tobi_store_put(f, "info", TOBI_U8, (int64_t)sizeof s->info, 1, &s->info, err));
    TOBI_TRY(tobi_world_put_bodies(w, f, err));
    TOBI_TRY(tobi_store_put(f, "memory", TOBI_F64, n, 1, memory, err));
    return put_rows(w, f, err);
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
    for (int k = 0; status == TOBI_OK; k++) {
        tobi_field_ref r = tobi_particles_state(&w->sim.particles, k);
        tobi_vtk_type type;
        int components;
        if (!r.name) break;
        shape_of(&r, &type, &components);
        status = tobi_store_put(f, r.name, type, w->sim.particles.count, components, r.data, err);
    }
    if (status == TOBI_OK) return tobi_store_commit(f, err);
    tobi_store_close(f);
    return status;
}

enum { FIELD_LIMIT = 16, OUTSIDE = 8 };      /* arrays; spacings */

/* A checkpoint as read, before the world takes it over. */
typedef struct loaded {
    const char *path;
    int64_t count, step;             /* particles; steps                       */
    double clock[4], gravity[3];
    tobi_step_info info;
    double *memory;                  /* of the method, owned                   */
    int memory_count;
    void *field[FIELD_LIMIT];        /* in the order of tobi_particles_state, owned */
    double *rows;                    /* of the method, owned until taken       */
    int64_t row_count;
    tobi_loaded_bodies bodies;
} loaded;

static void free_loaded(loaded *l)
{
    for (int k = 0; k < FIELD_LIMIT; k++) free(l->field[k]);
    free(l->memory);
    free(l->rows);
    tobi_loaded_bodies_free(&l->bodies);
}

static tobi_status check_scene(const tobi_world *w, tobi_store *f, const loaded *l, tobi_error *err)
{
    const tobi_simulation *s = &w->sim;
    double spacing;
    int64_t bodies;
    char *method = NULL;
    TOBI_TRY(tobi_store_get_text(f, "method", &method, err));
    const int same = strcmp(method, w->method->name) == 0;
    tobi_status status = TOBI_OK;
    if (!same)
        status = tobi_fail(err, TOBI_INVALID, "the checkpoint is of another scene: its method is %.32s, that "
                           "of the scene %s", method, w->method->name);
    free(method);
    TOBI_TRY(status);
    TOBI_TRY(tobi_store_get_int(f, "bodies", &bodies, err));
    TOBI_TRY(tobi_store_get_real(f, "spacing", &spacing, err));
    if (bodies != s->body_count || spacing != s->smoothing.spacing)
        return tobi_fail(err, TOBI_INVALID,
                         "the checkpoint is of another scene: it has %lld bodies at spacing %g m, "
                         "the scene %d at %g m",
                         (long long)bodies, spacing, s->body_count, s->smoothing.spacing);
    if (l->count > s->particles.capacity)
        return tobi_fail(err, TOBI_INVALID, "%s: holds %lld particles, the scene at most %lld", l->path,
                         (long long)l->count, (long long)s->particles.capacity);
    return TOBI_OK;
}

static tobi_status read_clock(tobi_world *w, tobi_store *f, loaded *l, tobi_error *err)
{
    double *memory;
    l->memory_count = w->method->memory(w->method_state, &memory);
    l->memory = malloc((size_t)(l->memory_count + 1)*sizeof *l->memory);
    if (!l->memory) return tobi_fail(err, TOBI_NO_MEMORY, "no memory to read %s", l->path);
    TOBI_TRY(tobi_store_get_int(f, "step", &l->step, err));
    TOBI_TRY(tobi_store_get(f, "clock", TOBI_F64, 4, 1, l->clock, err));
    TOBI_TRY(tobi_store_get(f, "gravity", TOBI_F64, 3, 1, l->gravity, err));
    TOBI_TRY(tobi_store_get(f, "info", TOBI_U8, (int64_t)sizeof l->info, 1, &l->info, err));
    TOBI_TRY(tobi_store_get(f, "memory", TOBI_F64, l->memory_count, 1, l->memory, err));
    int good = l->step >= 0 && l->clock[0] >= 0;
    for (int k = 0; k < l->memory_count; k++) good &= !isnan(l->memory[k]);
    for (int k = 0; k < 4; k++) good &= isfinite(l->clock[k]) != 0;
    for (int k = 0; k < 3; k++) good &= isfinite(l->gravity[k]) != 0;
    if (good) return TOBI_OK;
    return tobi_fail(err, TOBI_DAMAGED, "%s: its clock, gravity or memory is no number", l->path);
}

static tobi_status read_rows(const tobi_world *w, tobi_store *f, loaded *l, tobi_error *err)
{
    if (!w->method->recall) return TOBI_OK;
    TOBI_TRY(tobi_store_rows(f, "rows", &l->row_count, err));
    l->rows = malloc((size_t)(l->row_count + 1)*TOBI_RECALL_ROW*sizeof *l->rows);
    if (!l->rows)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld rows", (long long)l->row_count);
    return tobi_store_get(f, "rows", TOBI_F64, l->row_count, TOBI_RECALL_ROW, l->rows, err);
}

static tobi_status read_fields(tobi_world *w, tobi_store *f, loaded *l, tobi_error *err)
{
    for (int k = 0; k < FIELD_LIMIT; k++) {
        const tobi_field_ref r = tobi_particles_state(&w->sim.particles, k);
        tobi_vtk_type type;
        int components;
        if (!r.name) break;
        shape_of(&r, &type, &components);
        l->field[k] = malloc((size_t)(l->count + 1)*r.bytes);
        if (!l->field[k])
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld particles of %s", (long long)l->count,
                             l->path);
        TOBI_TRY(tobi_store_get(f, r.name, type, l->count, components, l->field[k], err));
    }
    return TOBI_OK;
}

/* Outside the domain by more than a particle can be between two steps, or no number. */
static int is_astray(const tobi_simulation *s, const double *x)
{
    for (int a = 0; a < 3; a++) {
        const double size = a < s->box.dimension ? s->box.size[a] : 0;
        const double slack = s->box.periodic[a] ? size : OUTSIDE*s->smoothing.spacing;
        if (!(x[a] >= -slack && x[a] <= size + slack)) return 1;
    }
    return 0;
}

/* A row that would lead outside the arrays, or is no number. seen: one byte for each id, all 0. */
static int is_bad_row(const tobi_simulation *s, const tobi_field_ref *f, const void *data, int64_t i,
                      char *seen)
{
    const float *number = (const float *)((const char *)data + (size_t)i*f->bytes);
    if (strcmp(f->name, "id") == 0) {
        const int64_t id = ((const int64_t *)data)[i];
        return id < 0 || id >= s->particles.capacity || seen[id]++;
    }
    if (strcmp(f->name, "fluid") == 0)
        return ((const uint8_t *)data)[i] >= (s->solid_count ? s->solid_count : s->fluid_count);
    if (strcmp(f->name, "position") == 0) return is_astray(s, &((const tobi_double3 *)data)[i].x);
    int good = 1;
    for (size_t k = 0; k < f->bytes/sizeof *number; k++) good &= isfinite(number[k]) != 0;
    return !good;
}

static tobi_status check_fields(tobi_world *w, const loaded *l, tobi_error *err)
{
    char *seen = calloc((size_t)w->sim.particles.capacity + 1, 1);
    if (!seen) return tobi_fail(err, TOBI_NO_MEMORY, "no memory to check %s", l->path);
    tobi_status status = TOBI_OK;
    for (int k = 0; k < FIELD_LIMIT && l->field[k]; k++) {
        const tobi_field_ref field = tobi_particles_state(&w->sim.particles, k);
        for (int64_t i = 0; i < l->count && status == TOBI_OK; i++)
            if (is_bad_row(&w->sim, &field, l->field[k], i, seen))
                status = tobi_fail(err, TOBI_DAMAGED, "%s: row %lld of '%s' is none that this scene can "
                                   "have", l->path, (long long)i, field.name);
    }
    free(seen);
    return status;
}

static tobi_status read_all(tobi_world *w, tobi_store *f, loaded *l, tobi_error *err)
{
    TOBI_TRY(check_format(f, l->path, err));
    TOBI_TRY(tobi_store_rows(f, "id", &l->count, err));
    TOBI_TRY(check_scene(w, f, l, err));
    TOBI_TRY(read_clock(w, f, l, err));
    TOBI_TRY(read_fields(w, f, l, err));
    TOBI_TRY(check_fields(w, l, err));
    TOBI_TRY(read_rows(w, f, l, err));
    return tobi_world_read_bodies(w, f, &l->bodies, err);
}

static void take_over(tobi_world *w, loaded *l)
{
    tobi_simulation *s = &w->sim;
    double *memory;
    for (int k = 0; k < FIELD_LIMIT && l->field[k]; k++) {
        const tobi_field_ref r = tobi_particles_state(&s->particles, k);
        memcpy(r.data, l->field[k], (size_t)l->count*r.bytes);
    }
    s->particles.count = l->count;
    w->method->memory(w->method_state, &memory);
    memcpy(memory, l->memory, (size_t)l->memory_count*sizeof *memory);
    s->info = l->info;
    s->step = l->step;
    s->time = l->clock[0];
    s->dt = l->clock[1];
    s->body_speed = l->clock[2];
    s->start_speed = l->clock[3];
    tobi_world_restore_gravity(w, l->gravity);
    if (w->method->recall) w->method->recall(w->method_state, l->rows, l->row_count);
    l->rows = NULL;
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
    loaded l = { .path = path };
    tobi_status status = read_all(w, f, &l, err);
    if (status == TOBI_OK) status = tobi_world_take_bodies(w, &l.bodies, err);
    if (status == TOBI_OK) take_over(w, &l);
    free_loaded(&l);
    tobi_store_close(f);
    return status;
}

/* The complete state in one file: particle state fields in memory order, the clock, the method's memory. */
#include "base/error.h"
#include "io/store.h"
#include "world/bodies.h"
#include "world/world.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* To be raised whenever what a checkpoint holds changes; 0: from before there was a number. */
enum { FORMAT = 6 };

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

static tobi_status get_rows(tobi_world *w, tobi_store *f, tobi_error *err)
{
    int64_t count;
    if (!w->method->recall) return TOBI_OK;
    TOBI_TRY(tobi_store_rows(f, "rows", &count, err));
    double *rows = malloc((size_t)(count + 1)*TOBI_RECALL_ROW*sizeof *rows);
    if (!rows) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld rows", (long long)count);
    tobi_status status = tobi_store_get(f, "rows", TOBI_F64, count, TOBI_RECALL_ROW, rows, err);
    if (status == TOBI_OK) w->method->recall(w->method_state, rows, count);
    else free(rows);
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

static tobi_status get_clock(tobi_world *w, tobi_store *f, tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    double *memory, clock[4], spacing;
    int64_t step, bodies;
    int n = w->method->memory(w->method_state, &memory);
    TOBI_TRY(tobi_store_get_int(f, "step", &step, err));
    TOBI_TRY(tobi_store_get_int(f, "bodies", &bodies, err));
    TOBI_TRY(tobi_store_get_real(f, "spacing", &spacing, err));
    if (bodies != s->body_count || spacing != s->smoothing.spacing)
        return tobi_fail(err, TOBI_INVALID,
                         "the checkpoint is of another scene: it has %lld bodies at spacing %g m, "
                         "the scene %d at %g m",
                         (long long)bodies, spacing, s->body_count, s->smoothing.spacing);
    TOBI_TRY(tobi_store_get(f, "clock", TOBI_F64, 4, 1, clock, err));
    TOBI_TRY(tobi_store_get(f, "info", TOBI_U8, (int64_t)sizeof s->info, 1, &s->info, err));
    TOBI_TRY(tobi_store_get(f, "memory", TOBI_F64, n, 1, memory, err));
    s->step = step;
    s->time = clock[0];
    s->dt = clock[1];
    s->body_speed = clock[2];
    s->start_speed = clock[3];
    return TOBI_OK;
}

tobi_status tobi_world_load(tobi_world *w, const char *path, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(path, "the path");
    TOBI_TRY(tobi_world_start(w, err));
    tobi_store *f;
    TOBI_TRY(tobi_store_open(path, &f, err));
    int64_t n = 0;
    tobi_status status = check_format(f, path, err);
    if (status == TOBI_OK) status = tobi_store_rows(f, "id", &n, err);
    if (status == TOBI_OK)
        status =
            n <= w->sim.particles.capacity
                ? get_clock(w, f, err)
                : tobi_fail(err, TOBI_INVALID, "%s: holds %lld particles, the scene at most %lld",
                            path, (long long)n, (long long)w->sim.particles.capacity);
    for (int k = 0; status == TOBI_OK; k++) {
        tobi_field_ref r = tobi_particles_state(&w->sim.particles, k);
        tobi_vtk_type type;
        int components;
        if (!r.name) break;
        shape_of(&r, &type, &components);
        status = tobi_store_get(f, r.name, type, n, components, r.data, err);
    }
    if (status == TOBI_OK) {
        w->sim.particles.count = n;
        status = tobi_world_get_bodies(w, f, err);
        if (status == TOBI_OK) status = get_rows(w, f, err);
    }
    tobi_store_close(f);
    w->fresh = 0;
    w->diverged = 0;
    return status;
}

/* Systems in checkpoints. The names in the file of all but the first begin with its number. Drawback: which
   system is which follows from the order in which the scene makes them. */
#include "world/load_system.h"
#include "base/error.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OUTSIDE = 8 };      /* spacings that a particle may be outside of the domain */

typedef struct entry { char name[64]; } entry;

static entry name_entry(int number, const char *what)
{
    entry e;
    if (number == 0) snprintf(e.name, sizeof e.name, "%s", what);
    else snprintf(e.name, sizeof e.name, "system_%d_%s", number, what);
    return e;
}

/* What the method keeps besides. */
static tobi_status put_rows(const tobi_system *s, int number, tobi_store *f, tobi_error *err)
{
    double *rows = NULL;
    int64_t count = 0;
    if (!s->method->keep) return TOBI_OK;
    TOBI_TRY(s->method->keep(s, &rows, &count, err));
    tobi_status status = tobi_store_put(f, name_entry(number, "rows").name, TOBI_F64, count,
                                        TOBI_RESTORED_ROW, rows, err);
    free(rows);
    return status;
}

/* The clock of the first is the world's. */
static tobi_status put_clock(const tobi_system *s, int number, tobi_store *f, tobi_error *err)
{
    const double clock[2] = { s->dt, s->start_speed };
    if (number == 0) return TOBI_OK;
    TOBI_TRY(tobi_store_put_int(f, name_entry(number, "step").name, s->step, err));
    return tobi_store_put(f, name_entry(number, "clock").name, TOBI_F64, 2, 1, clock, err);
}

tobi_status tobi_system_put(tobi_system *s, int number, tobi_store *f, tobi_error *err)
{
    double *memory;
    const int n = tobi_system_memory(s, &memory);
    TOBI_TRY(tobi_store_put_text(f, name_entry(number, "method").name, s->method->name, err));
    TOBI_TRY(tobi_store_put_real(f, name_entry(number, "spacing").name, s->smoothing.spacing, err));
    TOBI_TRY(put_clock(s, number, f, err));
    TOBI_TRY(tobi_store_put(f, name_entry(number, "info").name, TOBI_U8, (int64_t)sizeof s->info, 1, &s->info,
                            err));
    TOBI_TRY(tobi_store_put(f, name_entry(number, "memory").name, TOBI_F64, n, 1, memory, err));
    TOBI_TRY(put_rows(s, number, f, err));
    TOBI_TRY(tobi_store_put_int(f, name_entry(number, "next_id").name, s->particles.next_id, err));
    TOBI_TRY(tobi_store_put_int(f, name_entry(number, "started").name, s->started, err));
    for (int k = 0;; k++) {
        void *data;
        const tobi_field *r = tobi_particles_state(&s->particles, k, &data);
        if (!r) return TOBI_OK;
        TOBI_TRY(tobi_store_put(f, name_entry(number, r->name).name, r->type, s->particles.count,
                                r->components, data, err));
    }
}

void tobi_loaded_system_free(tobi_loaded_system *l)
{
    for (int k = 0; k < TOBI_LOADED_FIELDS; k++) free(l->field[k]);
    free(l->memory);
    free(l->rows);
}

static tobi_status check_scene(const tobi_system *s, int number, tobi_store *f, const char *path,
                               tobi_error *err)
{
    double spacing;
    char *method = NULL;
    TOBI_TRY(tobi_store_get_text(f, name_entry(number, "method").name, &method, err));
    tobi_status status = TOBI_OK;
    if (strcmp(method, s->method->name) != 0)
        status = tobi_fail(err, TOBI_INVALID, "the checkpoint is of another scene: its method is %.32s, that "
                           "of the scene %s", method, s->method->name);
    free(method);
    TOBI_TRY(status);
    TOBI_TRY(tobi_store_get_real(f, name_entry(number, "spacing").name, &spacing, err));
    if (spacing != s->smoothing.spacing)
        return tobi_fail(err, TOBI_INVALID,
                         "the checkpoint is of another scene: its spacing is %g m, the scene's %g m", spacing,
                         s->smoothing.spacing);
    int64_t started;
    TOBI_TRY(tobi_store_get_int(f, name_entry(number, "started").name, &started, err));
    if (started == s->started) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "%s: is of another scene: that began with %lld particles, this one "
                     "with %lld", path, (long long)started, (long long)s->started);
}

static tobi_status read_clock(int number, tobi_store *f, tobi_loaded_system *l, tobi_error *err)
{
    if (number == 0) return TOBI_OK;
    TOBI_TRY(tobi_store_get_int(f, name_entry(number, "step").name, &l->step, err));
    return tobi_store_get(f, name_entry(number, "clock").name, TOBI_F64, 2, 1, l->clock, err);
}

static tobi_status read_memory(tobi_system *s, int number, tobi_store *f, const char *path,
                               tobi_loaded_system *l, tobi_error *err)
{
    double *memory;
    l->memory_count = tobi_system_memory(s, &memory);
    l->memory = malloc((size_t)(l->memory_count + 1)*sizeof *l->memory);
    if (!l->memory) return tobi_fail(err, TOBI_NO_MEMORY, "no memory to read %s", path);
    TOBI_TRY(tobi_store_get(f, name_entry(number, "info").name, TOBI_U8, (int64_t)sizeof l->info, 1, &l->info,
                            err));
    TOBI_TRY(tobi_store_get(f, name_entry(number, "memory").name, TOBI_F64, l->memory_count, 1, l->memory,
                            err));
    int good = l->step >= 0 && isfinite(l->clock[0]) && isfinite(l->clock[1]);
    for (int k = 0; k < l->memory_count; k++) good &= !isnan(l->memory[k]);
    return good ? TOBI_OK : tobi_fail(err, TOBI_DAMAGED, "%s: the memory of %s is no number", path,
                                      s->method->name);
}

static tobi_status read_rows(const tobi_system *s, int number, tobi_store *f, tobi_loaded_system *l,
                             tobi_error *err)
{
    const entry e = name_entry(number, "rows");
    if (!s->method->restore) return TOBI_OK;
    TOBI_TRY(tobi_store_rows(f, e.name, &l->row_count, err));
    l->rows = malloc((size_t)(l->row_count + 1)*TOBI_RESTORED_ROW*sizeof *l->rows);
    if (!l->rows)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld rows", (long long)l->row_count);
    return tobi_store_get(f, e.name, TOBI_F64, l->row_count, TOBI_RESTORED_ROW, l->rows, err);
}

static tobi_status read_fields(tobi_system *s, int number, tobi_store *f, const char *path,
                               tobi_loaded_system *l, tobi_error *err)
{
    for (int k = 0; k < TOBI_LOADED_FIELDS; k++) {
        void *data;
        const tobi_field *r = tobi_particles_state(&s->particles, k, &data);
        if (!r) break;
        l->field[k] = malloc((size_t)(l->count + 1)*r->bytes);
        if (!l->field[k])
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld particles of %s", (long long)l->count,
                             path);
        TOBI_TRY(tobi_store_get(f, name_entry(number, r->name).name, r->type, l->count, r->components,
                                l->field[k], err));
    }
    return TOBI_OK;
}

/* Outside the domain by more than a particle can be between two steps, or no number. */
static int is_astray(const tobi_system *s, const double *x)
{
    for (int a = 0; a < 3; a++) {
        const double size = a < s->box.dimension ? s->box.size[a] : 0;
        const double slack = s->box.periodic[a] ? size : OUTSIDE*s->smoothing.spacing;
        if (!(x[a] >= -slack && x[a] <= size + slack)) return 1;
    }
    return 0;
}

/* A row that would lead outside the arrays, or is no number. */
static int is_bad_row(const tobi_system *s, const tobi_field *f, const void *data, int64_t i,
                      int64_t next_id)
{
    const float *number = (const float *)((const char *)data + (size_t)i*f->bytes);
    if (strcmp(f->name, "id") == 0) {
        const int64_t id = ((const int64_t *)data)[i];
        return id < 0 || id >= next_id;
    }
    if (strcmp(f->name, "fluid") == 0)
        return ((const uint8_t *)data)[i] >= (s->solid_count ? s->solid_count : s->fluid_count);
    if (strcmp(f->name, "position") == 0) return is_astray(s, &((const tobi_double3 *)data)[i].x);
    int good = 1;
    for (int k = 0; f->type == TOBI_F32 && k < f->components; k++) good &= isfinite(number[k]) != 0;
    return !good;
}

static int compare_ids(const void *p, const void *q)
{
    const int64_t x = *(const int64_t *)p, y = *(const int64_t *)q;
    return (x > y) - (x < y);
}

/* The row whose id another one has, too, -1 = none. Without memory none is found. */
static int64_t find_twin(const int64_t *id, int64_t count)
{
    int64_t *sorted = malloc((size_t)(count + 1)*sizeof *sorted), twin = -1;
    if (!sorted) return -1;
    memcpy(sorted, id, (size_t)count*sizeof *sorted);
    qsort(sorted, (size_t)count, sizeof *sorted, compare_ids);
    for (int64_t k = 1; k < count && twin < 0; k++)
        for (int64_t i = 0; sorted[k] == sorted[k - 1] && i < count; i++)
            if (id[i] == sorted[k]) twin = i;
    free(sorted);
    return twin;
}

static tobi_status refuse_row(const char *path, int64_t row, const char *field, tobi_error *err)
{
    return tobi_fail(err, TOBI_DAMAGED, "%s: row %lld of '%s' is none that this scene can have", path,
                     (long long)row, field);
}

static const void *find_loaded(tobi_system *s, const tobi_loaded_system *l, const char *name)
{
    for (int k = 0; k < TOBI_LOADED_FIELDS && l->field[k]; k++) {
        void *data;
        if (strcmp(tobi_particles_state(&s->particles, k, &data)->name, name) == 0) return l->field[k];
    }
    return NULL;
}

/* The first row that is held by a body to which the scene does not clamp its solid, -1 = none. */
static int64_t find_foreign_clamp(tobi_system *s, const tobi_loaded_system *l)
{
    const tobi_float4 *clamp = find_loaded(s, l, "clamp");
    const uint8_t *solid = find_loaded(s, l, "fluid");
    for (int64_t i = 0; clamp && solid && i < l->count; i++) {
        const double number = fabs((double)clamp[i].w);
        const int known = number == floor(number) && number <= s->sim->body_count;
        if (number != 0 && !(known && tobi_solid_is_clamped(&s->solids[solid[i]], (int)number - 1))) return i;
    }
    return -1;
}

static tobi_status check_fields(tobi_system *s, const char *path, const tobi_loaded_system *l,
                                tobi_error *err)
{
    for (int k = 0; k < TOBI_LOADED_FIELDS && l->field[k]; k++) {
        void *data;
        const tobi_field *field = tobi_particles_state(&s->particles, k, &data);
        int64_t bad = -1;
        for (int64_t i = 0; i < l->count && bad < 0; i++)
            if (is_bad_row(s, field, l->field[k], i, l->next_id)) bad = i;
        if (bad < 0 && strcmp(field->name, "id") == 0) bad = find_twin(l->field[k], l->count);
        if (bad >= 0) return refuse_row(path, bad, field->name, err);
    }
    const int64_t foreign = find_foreign_clamp(s, l);
    if (foreign >= 0)
        return tobi_fail(err, TOBI_INVALID, "%s: is of another scene: row %lld is held by a body to which "
                         "this one does not clamp its solid", path, (long long)foreign);
    return TOBI_OK;
}

tobi_status tobi_system_get(tobi_system *s, int number, tobi_store *f, const char *path,
                            tobi_loaded_system *l, tobi_error *err)
{
    TOBI_TRY(tobi_store_rows(f, name_entry(number, "id").name, &l->count, err));
    TOBI_TRY(tobi_store_get_int(f, name_entry(number, "next_id").name, &l->next_id, err));
    TOBI_TRY(check_scene(s, number, f, path, err));
    if (l->count > l->next_id || l->count > INT32_MAX) return refuse_row(path, l->next_id, "id", err);
    TOBI_TRY(read_clock(number, f, l, err));
    TOBI_TRY(read_memory(s, number, f, path, l, err));
    TOBI_TRY(read_fields(s, number, f, path, l, err));
    TOBI_TRY(check_fields(s, path, l, err));
    TOBI_TRY(read_rows(s, number, f, l, err));
    return tobi_system_room(s, l->count, err);
}

void tobi_system_take(tobi_system *s, const tobi_loaded_system *l)
{
    double *memory;
    for (int k = 0; k < TOBI_LOADED_FIELDS && l->field[k]; k++) {
        void *data;
        const tobi_field *r = tobi_particles_state(&s->particles, k, &data);
        memcpy(data, l->field[k], (size_t)l->count*r->bytes);
    }
    s->particles.count = l->count;
    s->particles.next_id = l->next_id;
    if (s->first_id + l->next_id > s->sim->next_id) s->sim->next_id = s->first_id + l->next_id;
    tobi_system_memory(s, &memory);
    memcpy(memory, l->memory, (size_t)l->memory_count*sizeof *memory);
    s->info = l->info;
    s->step = l->step;
    s->dt = l->clock[0];
    s->start_speed = l->clock[1];
}

void tobi_system_restore(tobi_system *s, tobi_loaded_system *l)
{
    if (s->method->restore) s->method->restore(s, l->rows, l->row_count);
    l->rows = NULL;
}

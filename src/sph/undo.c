/* A step changes velocities and pressures long before it is sure to end: the solves lie between. So both are
   copied, and every field of the state in the first step, which may settle the lattice around bodies, and
   before positions go half of their way. What a
   step finds anew each time is not kept. Drawback: 20 bytes per particle, copied in each step, for callers
   who may stop one. */
#include "sph/state.h"
#include "sph/undo.h"
#include <stdlib.h>
#include <string.h>

typedef struct sph_undo_body { tobi_rigid rigid; tobi_body_info info; } sph_undo_body;

tobi_status sph_undo_begin(sph_undo *u, const tobi_system *s, const double *memory, int n,
                           tobi_error *err)
{
    if (!s->sim->stop) return TOBI_OK;
    if (!u->body) u->body = calloc((size_t)s->sim->body_count + 1, sizeof *u->body);
    if (!u->body) return tobi_fail(err, TOBI_NO_MEMORY, "no memory to take back a step");
    memcpy(u->memory, memory, (size_t)n*sizeof *memory);
    memcpy(u->gravity, s->gravity, sizeof u->gravity);
    u->dt = s->dt;
    u->body_speed = s->sim->body_speed;
    u->reference = sph_of(s)->reference;
    u->info = s->info;
    u->kept = 0;
    for (int k = 0; k < s->sim->body_count; k++)
        u->body[k] = (sph_undo_body){ s->sim->bodies[k].rigid, s->sim->bodies[k].info };
    return TOBI_OK;
}

typedef struct copying { char *to; const char *from; size_t row; } copying;

static void copy_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const copying *c = view;
    (void)totals;
    memcpy(c->to + (size_t)begin*c->row, c->from + (size_t)begin*c->row, (size_t)(end - begin)*c->row);
}

static int changes(const tobi_system *s, const char *field)
{
    return s->step == 0 || strcmp(field, "velocity") == 0 || strcmp(field, "pressure") == 0;
}

tobi_status sph_undo_keep(sph_undo *u, tobi_system *s, int all, tobi_error *err)
{
    for (int k = 0; u->rows < s->particles.count && k < SPH_UNDO_FIELDS; k++) {
        tobi_array_free(u->field[k]);
        u->field[k] = NULL;
    }
    if (u->rows < s->particles.count) u->rows = s->particles.capacity;
    for (int k = 0; s->sim->stop && k < SPH_UNDO_FIELDS; k++) {
        void *data;
        const tobi_field *f = tobi_particles_state(&s->particles, k, &data);
        if (!f || !(all || changes(s, f->name))) {
            tobi_array_free(u->field[k]);
            u->field[k] = NULL;
            continue;
        }
        if (!u->field[k]) u->field[k] = tobi_array_make(u->rows + 1, f->bytes);
        if (!u->field[k]) return tobi_fail(err, TOBI_NO_MEMORY, "no memory to take back a step");
        copying c = { u->field[k], data, f->bytes };
        tobi_launch(&s->sim->exec, TOBI_HOST(copy_range, 0, 0), &c, 0, s->particles.count, NULL);
    }
    u->kept = 1;
    return TOBI_OK;
}

void sph_undo_restore(const sph_undo *u, tobi_system *s, double *memory, int n)
{
    memcpy(memory, u->memory, (size_t)n*sizeof *memory);
    memcpy(s->gravity, u->gravity, sizeof u->gravity);
    s->dt = u->dt;
    s->sim->body_speed = u->body_speed;
    sph_of(s)->reference = u->reference;
    s->info = u->info;
    for (int k = 0; k < s->sim->body_count; k++) {
        s->sim->bodies[k].rigid = u->body[k].rigid;
        s->sim->bodies[k].info = u->body[k].info;
    }
    for (int k = 0; k < SPH_UNDO_FIELDS; k++) {
        void *data;
        const tobi_field *f = tobi_particles_state(&s->particles, k, &data);
        if (f && u->kept && u->field[k]) memcpy(data, u->field[k], (size_t)s->particles.count*f->bytes);
    }
}

int64_t sph_undo_row_bytes(const tobi_system *s)
{
    return tobi_particles_state_bytes(s->method->fields, s->method->needs ? s->method->needs(s, 0) : 0);
}

int64_t sph_undo_bytes(const sph_undo *u, const tobi_system *s)
{
    int64_t row = 0;
    for (int k = 0; k < SPH_UNDO_FIELDS; k++) {
        void *data;
        const tobi_field *f = tobi_particles_state(&s->particles, k, &data);
        if (f && u->field[k]) row += (int64_t)f->bytes;
    }
    return row*(u->rows + 1);
}

void sph_undo_free(sph_undo *u)
{
    free(u->body);
    for (int k = 0; k < SPH_UNDO_FIELDS; k++) tobi_array_free(u->field[k]);
    memset(u, 0, sizeof *u);
}

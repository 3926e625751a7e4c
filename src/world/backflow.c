/* Liquid comes back through an outlet whose pressure is given: its buffer is kept filled by copies of its own
   particles, a spacing further along the normal, wherever there is room for one. So a buffer that moves
   inwards grows at its end, and rest stays rest. Drawback: what is new repeats the disorder before it. */
#include "world/openings.h"
#include "world/scalars.h"
#include <math.h>
#include <stdlib.h>

/* Spacings: nearer than that to another particle there is no room for a new one; how far a buffer is filled,
   and kept, beyond the support radius. */
static const double ROOM = 0.75, FILLED = 0.5, KEPT = 1;
/* Spacings from sides of the domain, where no particle is made. */
static const double SIDE = 0.2;

double tobi_outlet_depth(const tobi_opening *o, const tobi_smoothing_constants *c)
{
    return o->gives ? 2*c->h + KEPT*c->spacing : c->h;
}

/* Whether a row lies beyond an outlet, or nearly; where. */
static int locate(const tobi_system *s, const tobi_opening *o, int64_t i, double at[3])
{
    const double d = s->smoothing.spacing;
    const tobi_double3 *p = &s->particles.position[i];
    const double x[3] = { p->x, p->y, p->z };
    tobi_opening_locate(o, x, at);
    return at[0] >= -d && at[0] <= tobi_outlet_depth(o, &s->smoothing) + d && tobi_opening_faces(o, at);
}

static int is_beyond(const tobi_system *s, const void *o, int64_t i)
{
    double at[3];
    return locate(s, o, i, at);
}

static tobi_status gather(tobi_world *w, const tobi_opening *o, int64_t *count, tobi_error *err)
{
    const tobi_system *s = &w->system[0];
    TOBI_TRY(tobi_openings_choose(w, is_beyond, o, count, err));
    if (*count > w->beyond_room) {
        const int64_t room = *count + *count/2 + 64;
        tobi_beyond *more = realloc(w->beyond, (size_t)room*sizeof *more);
        if (!more)
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the liquid at outlet '%s'", o->name);
        w->beyond = more;
        w->beyond_room = room;
    }
    for (int64_t k = 0; k < *count; k++) {
        tobi_beyond *b = &w->beyond[k];
        *b = (tobi_beyond){ .row = w->chosen[k], .id = s->particles.id[w->chosen[k]] };
        locate(s, o, b->row, b->at);
    }
    return TOBI_OK;
}

/* By place along the patch, then by id: the same for any order of rows. */
static int compare(const void *a, const void *b)
{
    const tobi_beyond *p = a, *q = b;
    if (p->at[1] != q->at[1]) return p->at[1] < q->at[1] ? -1 : 1;
    return (p->id > q->id) - (p->id < q->id);
}

static double distance2(const double a[3], const double b[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += (a[k] - b[k])*(a[k] - b[k]);
    return sum;
}

/* k: an entry of the sorted list nearby. */
static int is_free(const tobi_beyond *list, int64_t count, int64_t k, const double at[3], double room)
{
    for (int64_t n = k; n >= 0 && list[n].at[1] > at[1] - room; n--)
        if (distance2(list[n].at, at) < room*room) return 0;
    for (int64_t n = k + 1; n < count && list[n].at[1] < at[1] + room; n++)
        if (distance2(list[n].at, at) < room*room) return 0;
    return 1;
}

int tobi_openings_is_open(const tobi_system *s, const double x[3])
{
    const double side = SIDE*s->smoothing.spacing;
    for (int a = 0; a < s->box.dimension; a++)
        if (!s->box.periodic[a] && (x[a] < side || x[a] > s->box.size[a] - side)) return 0;
    for (int b = 0; b < s->sim->body_count; b++)
        if (tobi_bvh_inside(s->sim->bodies[b].bvh, x)) return 0;
    return 1;
}

/* A copy of a row at a place. */
static tobi_status repeat(tobi_system *s, int64_t of, const double x[3], tobi_error *err)
{
    int64_t row;
    TOBI_TRY(tobi_system_insert(s, 1, &row, err));
    tobi_particles *p = &s->particles;
    p->position[row] = (tobi_double3){ x[0], x[1], x[2] };
    p->velocity[row] = p->velocity[of];
    p->fluid[row] = p->fluid[of];
    tobi_scalars_repeat(s, row, s, of);
    s->info.particles_in++;
    return TOBI_OK;
}

/* To the nearest column of a lattice over the patch: columns stay as far from each other as they are. */
static void snap(const tobi_opening *o, double d, double at[3])
{
    double u[2];
    for (int a = 0; a < 2; a++) {
        const double side = o->radius > 0 ? o->radius : o->half[a], n = fmax(1, floor(2*side/d + 0.5));
        u[a] = side > 0 ? side*((2*fmin(fmax(floor(0.5*(at[1 + a]/side + 1)*n), 0), n - 1) + 1)/n - 1) : 0;
    }
    if (o->radius > 0 && u[0]*u[0] + u[1]*u[1] > o->radius*o->radius) return;
    at[1] = u[0];
    at[2] = u[1];
}

static tobi_status fill(tobi_world *w, const tobi_opening *o, int64_t count, tobi_error *err)
{
    tobi_system *s = &w->system[0];
    const double d = s->smoothing.spacing, end = 2*s->smoothing.h + FILLED*d;
    const int64_t before = s->particles.count;
    for (int64_t k = 0; k < count; k++) {
        const tobi_beyond *b = &w->beyond[k];
        double at[3] = { b->at[0] + d, b->at[1], b->at[2] };
        snap(o, d, at);
        if (b->at[0] < 0 || at[0] > end || !is_free(w->beyond, count, k, at, ROOM*d)) continue;
        double x[3];
        int free = 1;
        for (int a = 0; a < 3; a++)
            x[a] = o->centre[a] + at[0]*o->normal[a] + at[1]*o->along[a] + at[2]*o->across[a];
        for (int64_t n = before; n < s->particles.count && free; n++) {
            const tobi_double3 *p = &s->particles.position[n];
            free = distance2((double[3]){ p->x, p->y, p->z }, x) >= ROOM*ROOM*d*d;
        }
        if (free && tobi_openings_is_open(s, x)) TOBI_TRY(repeat(s, b->row, x, err));
    }
    return TOBI_OK;
}

tobi_status tobi_openings_give(tobi_world *w, tobi_error *err)
{
    for (int k = 0; k < w->sim.opening_count; k++) {
        int64_t count;
        if (!w->sim.openings[k].gives) continue;
        TOBI_TRY(gather(w, &w->sim.openings[k], &count, err));
        if (count > 1) qsort(w->beyond, (size_t)count, sizeof *w->beyond, compare);
        TOBI_TRY(fill(w, &w->sim.openings[k], count, err));
    }
    return TOBI_OK;
}

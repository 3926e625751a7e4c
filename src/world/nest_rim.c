/* The rim of a nest: each outer particle that comes into it is new there in parts, as many as the refinement
   makes of it, so that as much liquid comes in as in the outer world; what leaves the rim is removed. Between
   them parts fill holes. Drawback: liquid that a nest throws out of its box is lost. */
#include "world/nest.h"
#include "world/openings.h"
#include "world/scalars.h"
#include "base/error.h"
#include "geom/vec3.h"
#include "sph/sensor/around.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Spacings: nearer than that to another particle there is no room for a part of an outer particle that comes
   in, or in a hole. */
static const double ROOM = 0.2, ROOM_OF_HOLE = 0.95;
/* Outer spacings: a place in the rim with no outer particle so near is dry. */
static const double DRY = 2;
/* Steps from one search for holes to the next. */
enum { HOLES = 4 };

/* Looks for a particle nearer than `reach` to a place, m. */
typedef struct looking { double reach; int found; } looking;

static void look(void *user, int64_t i, const double d[3])
{
    looking *l = user;
    (void)i;
    l->found |= d[0]*d[0] + d[1]*d[1] + d[2]*d[2] < l->reach*l->reach;
}

static int is_near(const tobi_system *s, const double x[3], double reach)
{
    looking l = { reach, 0 };
    const sph_range cells = sph_cells_around(s, x, reach + s->smoothing.spacing);
    sph_visit(s, x, &cells, look, &l);
    return l.found;
}

/* m: as tobi_nest_outside, of a row of this or the outer system. */
static double row_outside(const tobi_system *s, const tobi_system *of, int64_t i)
{
    const tobi_double3 *p = &of->particles.position[i];
    return tobi_nest_outside(&s->sim->nest, s->box.dimension, (double[3]){ p->x, p->y, p->z });
}

/* Parts of a particle at the edge lie half an outer spacing beyond it. */
static int is_gone(const tobi_system *s, const void *none, int64_t i)
{
    const tobi_nest *n = &s->sim->nest;
    const tobi_double3 *p = &s->particles.position[i];
    const double x[3] = { p->x, p->y, p->z };
    const double out = tobi_nest_outside(n, s->box.dimension, x), wide = n->outer->smoothing.spacing;
    (void)none;
    return out > n->rim + 0.5*wide || (out > 0 && !is_near(n->outer, x, DRY*wide));
}

/* Whether one of the rows from `first` on is nearer than `reach`, m. */
static int is_taken(const tobi_system *s, int64_t first, const double x[3], double reach)
{
    const tobi_particles *p = &s->particles;
    for (int64_t n = first; n < p->count; n++) {
        const double other[3] = { p->position[n].x, p->position[n].y, p->position[n].z };
        if (vec3_distance2(other, x) < reach*reach) return 1;
    }
    return 0;
}

/* Adds a part of outer row j. */
static tobi_status add(tobi_system *s, const double x[3], int64_t j, tobi_error *err)
{
    int64_t row;
    const tobi_particles *outer = &s->sim->nest.outer->particles;
    TOBI_TRY(tobi_system_insert(s, 1, &row, err));
    s->particles.position[row] = (tobi_double3){ x[0], x[1], x[2] };
    s->particles.velocity[row] = outer->velocity[j];
    s->particles.fluid[row] = outer->fluid[j];
    tobi_scalars_repeat(s, row, s->sim->nest.outer, j);
    s->info.particles_in++;
    return TOBI_OK;
}

/* Parts of an outer particle along an axis. */
static int parts_of(const tobi_system *s)
{
    return (int)fmax(1, round(s->sim->nest.outer->smoothing.spacing/s->smoothing.spacing));
}

/* The place of part k of an outer particle, if there is room for it. */
static int find_part(const tobi_system *s, int64_t j, int k, double room, double x[3])
{
    const tobi_system *outer = s->sim->nest.outer;
    const int parts = parts_of(s);
    memcpy(x, &outer->particles.position[j], sizeof *outer->particles.position);
    for (int a = 0; a < s->box.dimension; a++, k /= parts)
        x[a] += outer->smoothing.spacing*((k%parts + 0.5)/parts - 0.5);
    return tobi_nest_outside(&s->sim->nest, s->box.dimension, x) > 0 &&
           !is_near(s, x, room*s->smoothing.spacing) && tobi_openings_is_open(s, x);
}

static int count_parts(const tobi_system *s)
{
    const int parts = parts_of(s);
    return s->box.dimension == 3 ? parts*parts*parts : parts*parts;
}

/* How near others may be to the parts of an outer particle: one that has just come has all its parts. */
static double room_of(const tobi_world *w, int64_t j)
{
    return w->seen[w->sim.nest.outer->particles.id[j]] ? ROOM_OF_HOLE : ROOM;
}

/* Of outer rows. */
static int wants_parts(const tobi_system *outer, const void *view, int64_t j)
{
    const tobi_world *w = view;
    const tobi_system *s = &w->system[0];
    const double out = row_outside(s, outer, j);
    double x[3];
    if (out <= -0.5*outer->smoothing.spacing || out > s->sim->nest.rim) return 0;
    if (w->seen[outer->particles.id[j]] && w->sim.step%HOLES != 0) return 0;
    for (int k = 0; k < count_parts(s); k++)
        if (find_part(s, j, k, room_of(w, j), x)) return 1;
    return 0;
}

/* Holes are few; of what comes in two parts may be near each other, as the outer particles are. */
static tobi_status add_parts(tobi_world *w, tobi_error *err)
{
    tobi_system *s = &w->system[0];
    const tobi_system *outer = s->sim->nest.outer;
    const int64_t first = s->particles.count;
    int64_t count;
    TOBI_TRY(tobi_rows_choose(w, outer, wants_parts, w, &count, err));
    for (int64_t c = 0; c < count; c++) {
        const int64_t j = w->chosen[c];
        const double room = room_of(w, j), reach = room*s->smoothing.spacing;
        double x[3];
        for (int k = 0; k < count_parts(s); k++) {
            if (!find_part(s, j, k, room, x)) continue;
            if (room == ROOM_OF_HOLE && is_taken(s, first, x, reach)) continue;
            TOBI_TRY(add(s, x, j, err));
        }
    }
    return TOBI_OK;
}

static void see_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_world *w = view;
    const tobi_system *outer = w->sim.nest.outer;
    for (int64_t j = begin; j < end; j++) {
        const double out = row_outside(&w->system[0], outer, j) - w->sim.nest.rim;
        uint8_t *seen = &w->seen[outer->particles.id[j]];
        *seen = out <= (*seen ? outer->smoothing.spacing : 0);
    }
}

/* Room for as many ids; those that are new are 0. */
static tobi_status make_room(tobi_world *w, int64_t ids, tobi_error *err)
{
    if (w->seen && ids <= w->seen_room) return TOBI_OK;
    uint8_t *more = realloc(w->seen, (size_t)(ids + ids/2 + 1));
    if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a nest");
    memset(more + w->seen_room, 0, (size_t)(ids + ids/2 + 1 - w->seen_room));
    w->seen = more;
    w->seen_room = ids + ids/2 + 1;
    return TOBI_OK;
}

/* Which outer particles are in the rim or in the box. */
static tobi_status see(tobi_world *w, tobi_error *err)
{
    const tobi_system *outer = w->sim.nest.outer;
    TOBI_TRY(make_room(w, outer->sim->next_id, err));
    tobi_loop(w->sim.exec.threads, outer->particles.count, 0, see_range, w);
    return TOBI_OK;
}

tobi_status tobi_nest_pass(tobi_world *w, tobi_error *err)
{
    tobi_system *s = &w->system[0];
    double clock = tobi_clock();
    int64_t gone;
    if (!s->sim->nest.outer) return TOBI_OK;
    if (!w->seen) TOBI_TRY(see(w, err));      /* what is there at the start */
    TOBI_TRY(add_parts(w, err));
    TOBI_TRY(see(w, err));
    TOBI_TRY(tobi_openings_choose(w, is_gone, NULL, &gone, err));
    if (gone > 0) tobi_particles_remove(&s->particles, w->chosen, gone);
    s->info.particles_out += gone;
    s->info.fluid_particles = s->particles.count;
    tobi_stage_end(&s->sim->stages, "rim of the nest", &clock);
    return TOBI_OK;
}

tobi_status tobi_nest_put(const tobi_world *w, tobi_store *f, tobi_error *err)
{
    if (!w->sim.nest.outer) return TOBI_OK;
    return tobi_store_put(f, "nest", TOBI_U8, w->seen ? w->seen_room : 0, 1, w->seen, err);
}

tobi_status tobi_nest_get(const tobi_world *w, tobi_store *f, const char *path, uint8_t **seen, int64_t *ids,
                          tobi_error *err)
{
    const int is_nest = tobi_store_has(f, "nest");
    *seen = NULL;
    *ids = 0;
    if (is_nest && !w->outer)
        return tobi_fail(err, TOBI_INVALID, "%s is of a nest, which goes on with the run of the world around "
                         "it", path);
    if (!is_nest && w->outer) return tobi_fail(err, TOBI_INVALID, "%s is of a world that is no nest", path);
    if (!is_nest) return TOBI_OK;
    TOBI_TRY(tobi_store_rows(f, "nest", ids, err));
    if (*ids == 0) return TOBI_OK;
    *seen = malloc((size_t)*ids);
    if (!*seen) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a nest");
    const tobi_status status = tobi_store_get(f, "nest", TOBI_U8, *ids, 1, *seen, err);
    if (status == TOBI_OK) return TOBI_OK;
    free(*seen);
    *seen = NULL;
    return status;
}

void tobi_nest_take(tobi_world *w, uint8_t *seen, int64_t ids)
{
    free(w->seen);
    w->seen = seen;
    w->seen_room = ids;
    tobi_nest_follow(w);
}

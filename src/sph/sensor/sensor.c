/* Where the liquid is: the occupancy of places, and columns of it along lines. A column must stand on
   something, so that drops and sheets above it do not count. Drawback: a film thinner than half a spacing is
   not seen. */
#include "sph/sensor/sensor.h"
#include "geom/vec3.h"
#include "sph/sensor/around.h"
#include "sph/sensor/probe.h"
#include "sph/soft.h"
#include "sph/state.h"
#include <math.h>
#include <string.h>

#define WET 0.5
#define STEP 0.25           /* of the walk, spacings */
#define STANDS 1.5          /* a column begins so near to what it stands on, spacings */
#define INSIDE 0.25         /* deeper than this a place is inside of a body, spacings */
#define LEAST_OPEN 0.2      /* share of the kernel that a corner leaves at least */

typedef struct share {
    const tobi_system *s;
    const tobi_smoothing_constants *c;
    int fluid;
    double sum;
} share;

/* A fluid stands on heavier ones as on a floor: oil on water has its level. */
static int is_in_column(const tobi_system *s, int fluid, int64_t i)
{
    return tobi_sensor_counts(s, fluid, i) ||
           s->fluid[s->particles.fluid[i]].density > s->fluid[fluid].density;
}

static void add_share(void *user, int64_t i, const double d[3])
{
    share *a = user;
    if (!is_in_column(a->s, a->fluid, i)) return;
    const double r = vec3_length(d);
    if (r < a->c->h) a->sum += tobi_smoothing_w(a->c->shape, a->c->dimension, a->c->h, r);
}

/* What a plane at this distance leaves open. */
static double open_beside(const tobi_smoothing_constants *c, double away)
{
    if (away >= c->h) return 1;
    return 1 - c->plane.lambda[(int)(fmax(away, 0)/c->h*TOBI_PLANE_SAMPLES)];
}

static double open_at(const tobi_system *s, const double local[3], int *inside)
{
    const tobi_smoothing_constants *c = &s->smoothing;
    double open = 1;
    *inside = 0;
    for (int a = 0; a < s->box.dimension; a++)
        for (int side = 0; side < 2 && !s->box.periodic[a]; side++)
            open *= open_beside(c, side ? s->box.size[a] - local[a] : local[a]);
    for (int b = 0; b < s->sim->body_count; b++) {
        const tobi_bvh *bvh = s->sim->bodies[b].bvh;
        tobi_bvh_hit hit;
        if (s->sim->bodies[b].is_absent) continue;
        if (tobi_bvh_closest(bvh, local, c->h, &hit)) {
            open *= open_beside(c, hit.signed_distance);
            *inside |= hit.signed_distance < -INSIDE*c->spacing;
        } else {
            *inside |= tobi_bvh_inside(bvh, local);          /* deeper than the kernel reaches */
        }
    }
    return open;
}

double tobi_sensor_occupancy(const tobi_system *s, int fluid, const double x[3], int *inside)
{
    const tobi_smoothing_constants *c = &s->smoothing;
    share a = { s, c, fluid, 0 };
    double local[3];
    for (int k = 0; k < 3; k++) local[k] = k < s->box.dimension ? x[k] - s->box.lower[k] : 0;
    const double open = open_at(s, local, inside);
    if (*inside) return 0;
    const sph_range cells = sph_cells_around(s, local, c->h + c->spacing);
    sph_visit(s, local, &cells, add_share, &a);
    return a.sum*c->volume*c->weight_correction/fmax(open, LEAST_OPEN);
}

/* A line along which a fluid is looked for. */
typedef struct line { const tobi_system *s; int fluid; const double *from, *along; } line;

/* *inside: of a body or soft solid. */
static double look_along(const line *l, double t, int *inside)
{
    const tobi_system *s = l->s;
    double x[3], local[3];
    vec3_add_scaled(x, l->from, t, l->along);
    for (int k = 0; k < 3; k++) local[k] = k < s->box.dimension ? x[k] - s->box.lower[k] : 0;
    *inside = sph_soft_fills(s, local);
    if (*inside) return 0;
    return tobi_sensor_occupancy(l->s, l->fluid, x, inside);
}

/* Between a wet place and one that is not. */
static double find_end(const line *l, double wet, double dry)
{
    for (int k = 0; k < 12; k++) {
        int inside;
        const double middle = 0.5*(wet + dry);
        if (look_along(l, middle, &inside) >= WET) wet = middle;
        else dry = middle;
    }
    return 0.5*(wet + dry);
}

double tobi_sensor_column(const tobi_system *s, int fluid, const double from[3], const double along[3],
                          double length, double *floor_at)
{
    const line l = { s, fluid, from, along };
    const double step = STEP*s->smoothing.spacing, stands = STANDS*s->smoothing.spacing;
    double solid = 0, end = -1, last_wet = -1;       /* solid: the last place of something to stand on */
    int apart = 0;                                   /* 1: something else than solids has been passed */
    *floor_at = 0;
    for (int k = 0; ; k++) {
        int inside;
        const double t = fmin(k*step, length), phi = look_along(&l, t, &inside);
        if (inside) {
            solid = t;
            if (!apart) *floor_at = t;
        } else {
            apart |= t - solid > 2*step;
            const int joined = last_wet >= 0 && t - last_wet < 1.5*step;
            if (phi >= WET && (joined || t - solid <= stands)) last_wet = end = t;
            else if (joined && phi < WET && last_wet > solid) return find_end(&l, last_wet, t);
        }
        if (t >= length) return end;
        if (!inside && t - solid > stands && !(last_wet >= 0 && t - last_wet < 1.5*step) &&
            end >= 0) return end;
    }
}

int tobi_sensor_up(const tobi_system *s, double *sign)
{
    int axis = s->box.dimension - 1;
    double size = 0;
    *sign = 1;
    for (int a = 0; a < s->box.dimension; a++) {
        if (fabs(s->sim->def.gravity[a]) <= size) continue;
        size = fabs(s->sim->def.gravity[a]);
        axis = a;
        *sign = s->sim->def.gravity[a] > 0 ? -1 : 1;
    }
    return axis;
}

/* m from the lowest side of the domain: where liquid begins; in a nest that ends above it, its box. */
static double find_bottom(const tobi_system *s, int axis, double sign)
{
    const tobi_nest *n = &s->sim->nest;
    if (!n->outer) return 0;
    const double bottom = sign > 0 ? n->lower[axis] : s->box.size[axis] - n->upper[axis];
    return fmin(fmax(bottom, 0), s->box.size[axis]);
}

double tobi_sensor_level(const tobi_system *s, int fluid, const double x[3])
{
    double from[3] = { x[0], x[1], s->box.dimension == 3 ? x[2] : 0 }, along[3] = { 0 }, sign, floor_at;
    const int axis = tobi_sensor_up(s, &sign);
    const double bottom = find_bottom(s, axis, sign);
    from[axis] = s->box.lower[axis] + (sign > 0 ? bottom : s->box.size[axis] - bottom);
    along[axis] = sign;
    const double top = tobi_sensor_column(s, fluid, from, along, s->box.size[axis] - bottom, &floor_at);
    return from[axis] + sign*(top >= 0 ? top : floor_at);
}

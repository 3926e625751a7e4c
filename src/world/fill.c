/* Points of a lattice, or scattered by a seed, inside a region, less those in bodies or behind planes.
   Drawback: a lattice does not follow round walls; the first step relaxes it. */
#include "world/fill.h"
#include "world/overlap.h"
#include "base/error.h"
#include "world/nest.h"
#include "world/openings.h"
#include "geom/seed.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Far more than any machine takes; sums of a scene's regions, in bytes, still fit in 64 bits. */
#define COUNT_LIMIT 1e12

/* The lattice is stretched to fill the box evenly, so that no gap of part of a spacing is left at a wall. */
double tobi_region_layers(const tobi_region *r, int axis, double spacing)
{
    return fmax(1, floor((r->upper[axis] - r->lower[axis])/spacing + 0.5));
}

static void lattice(const tobi_system *s, const tobi_region *r, int64_t n[3], double step[3])
{
    double d = s->smoothing.spacing;
    for (int a = 0; a < 3; a++) {
        double side = r->upper[a] - r->lower[a];
        int flat = a == 2 && s->box.dimension == 2;
        double count = flat ? 1 : r->shape.triangle_count ? ceil(side/d) : tobi_region_layers(r, a, d);
        n[a] = count < COUNT_LIMIT ? (int64_t)count : (int64_t)COUNT_LIMIT;
        step[a] = r->shape.triangle_count ? d : side/(double)n[a];
    }
}

int64_t tobi_region_count(const tobi_system *s, const tobi_region *r)
{
    int64_t n[3];
    double step[3];
    if (r->points) return r->point_count;
    lattice(s, r, n, step);
    double count = (double)n[0]*(double)n[1]*(double)n[2];
    return count < COUNT_LIMIT ? (int64_t)count : (int64_t)COUNT_LIMIT;
}

/* 1 if x is in the body, or nearer to it than `reach` (m). */
static int meets(const tobi_system *s, const tobi_body *b, const double x[3], double reach)
{
    double lo[3], hi[3];
    tobi_bvh_hit hit;
    tobi_bvh_box(b->bvh, lo, hi);
    for (int a = 0; a < s->box.dimension; a++)
        if (x[a] < lo[a] - reach || x[a] > hi[a] + reach) return 0;
    return tobi_bvh_inside(b->bvh, x) || (reach > 0 && tobi_bvh_closest(b->bvh, x, reach, &hit));
}

/* A place of the lattice on a side of a body, as round numbers give it, is in the body on its lower sides and
   out of it on the upper ones: rounding would choose for each place anew, and the body have a ragged gap. */
static void step_aside(const tobi_system *s, double x[3])
{
    static const double way[3] = { 1e-6, 0.8e-6, 0.6e-6 };
    for (int a = 0; a < s->box.dimension; a++) x[a] += way[a]*s->smoothing.spacing;
}

/* A solid fills the bodies that hold it. Counts its points that a blade would start in: that may be thinner
   than their distance. */
static int inside_body(const tobi_system *s, tobi_region *r, const double place[3])
{
    double x[3] = { place[0], place[1], place[2] };
    int inside = 0;
    step_aside(s, x);
    for (int k = 0; k < s->sim->body_count; k++) {
        const tobi_body *b = &s->sim->bodies[k];
        if (s->solid_count > 0 && tobi_solid_is_clamped(&s->solids[r->owner], k)) continue;
        const int cuts = b->blade && s->solid_count > 0;
        if (!meets(s, b, x, cuts ? 0.25*s->smoothing.spacing : 0)) continue;
        inside = 1;
        if (cuts && !r->blade) r->blade = k + 1;
        r->cut += r->blade == k + 1;
    }
    return inside;
}

static int behind_plane(const tobi_system *s, const double x[3])
{
    for (int k = 0; k < s->sim->plane_count; k++)
        if (tobi_plane_height(&s->sim->plane[k], x) < 0) return 1;
    return 0;
}

/* Particle i at x becomes one of the region. */
static void give(tobi_system *s, const tobi_region *r, int64_t i, const double x[3])
{
    tobi_particles *p = &s->particles;
    double arm[3], v[3];
    for (int a = 0; a < 3; a++) arm[a] = x[a] + s->box.lower[a] - 0.5*(r->lower[a] + r->upper[a]);
    for (int a = 0; a < 3; a++) {
        int b = (a + 1)%3, c = (a + 2)%3;
        v[a] = r->velocity[a] + r->spin[b]*arm[c] - r->spin[c]*arm[b];
    }
    p->velocity[i] = (tobi_float4){(float)v[0], (float)v[1], s->box.dimension == 3 ? (float)v[2] : 0, 0};
    p->fluid[i] = (uint8_t)r->owner;
}

static void add_particle(tobi_system *s, const tobi_region *r, const double x[3])
{
    const int64_t i = tobi_particles_add(&s->particles);
    s->particles.position[i] = (tobi_double3){x[0], x[1], x[2]};
    give(s, r, i, x);
}

/* What the region's flow adds to the velocities of its particles. */
static tobi_status add_flow(tobi_system *s, tobi_region *r, int64_t first, tobi_error *err)
{
    tobi_particles *p = &s->particles;
    int64_t n = p->count - first;
    r->flow_speed = 0;
    if (!r->flow || n == 0) return TOBI_OK;
    double (*at)[3] = malloc((size_t)n*sizeof *at), (*v)[3] = calloc((size_t)n, sizeof *v);
    for (int64_t i = 0; at && i < n; i++)
        for (int a = 0; a < 3; a++) at[i][a] = (&p->position[first + i].x)[a] + s->box.lower[a];
    tobi_status status = at && v ? r->flow(r->flow_user, n, (const double (*)[3])at, v, err)
                                 : tobi_fail(err, TOBI_NO_MEMORY, "no memory for the flow of a region");
    for (int64_t i = 0; status == TOBI_OK && i < n; i++) {
        double speed2 = 0;
        for (int a = 0; a < s->box.dimension; a++) {
            (&p->velocity[first + i].x)[a] += (float)v[i][a];
            speed2 += v[i][a]*v[i][a];
        }
        if (!(sqrt(speed2) <= TOBI_SPEED_LIMIT))
            status = tobi_fail(err, TOBI_INVALID, "the flow of fill[%d] answers (%g, %g, %g) m/s at (%g, %g, "
                               "%g) m; allowed are up to %g m/s", r->number, v[i][0], v[i][1], v[i][2],
                               at[i][0], at[i][1], at[i][2], TOBI_SPEED_LIMIT);
        r->flow_speed = fmax(r->flow_speed, sqrt(speed2));
    }
    free(at);
    free(v);
    return status;
}

/* Spacings: three layers of a lattice that is cut across its diagonal. With less the core shows through. */
#define SKIN 1.75

/* How deep a point of a region lies below its surface, m, at most `most`. */
static double find_depth(const tobi_region *r, const tobi_bvh *tree, const double x[3], int dimension,
                         double most)
{
    double depth = most, square = 0;
    tobi_bvh_hit hit;
    if (tree) return tobi_bvh_closest(tree, x, most, &hit) ? hit.distance : most;
    for (int a = 0; a < dimension; a++) {
        double from_middle = x[a] - 0.5*(r->lower[a] + r->upper[a]);
        depth = fmin(depth, fmin(x[a] - r->lower[a], r->upper[a] - x[a]));
        square += from_middle*from_middle;
    }
    return r->radius > 0 ? fmin(most, r->radius - sqrt(square)) : depth;
}

typedef struct starting {
    tobi_system *s;
    const tobi_region *region;
    const tobi_bvh *tree;
    int64_t first, whole;
} starting;

static void start_range(const void *view, int64_t begin, int64_t end)
{
    const starting *m = view;
    tobi_system *s = m->s;
    const tobi_region *r = m->region;
    const tobi_solid_def *def = &s->solids[r->owner].def;
    const double skin = SKIN*s->smoothing.spacing, volume = r->volume/(double)m->whole;
    tobi_start start = { .volume = volume, .mass = def->density*volume };
    memcpy(start.spin, r->spin, sizeof start.spin);
    for (int64_t i = m->first + begin; i < m->first + end; i++) {
        double x[3];
        for (int a = 0; a < 3; a++) x[a] = (&s->particles.position[i].x)[a] + s->box.lower[a];
        start.core = def->core_color[0] >= 0 && find_depth(r, m->tree, x, s->box.dimension, 2*skin) > skin;
        s->method->place(s, i, &start);
    }
}

/* Solids: the particles of a region share its exact volume, those that were cut off included (`whole`). Those
   below the skin are the core, of solids that show it in pictures. */
static void start_solids(tobi_system *s, const tobi_region *r, const tobi_bvh *tree, int64_t first,
                         int64_t whole)
{
    const starting view = { s, r, tree, first, whole };
    if (s->method->solids && s->method->place)
        tobi_loop(s->sim->exec.threads, s->particles.count - first, 0, start_range, &view);
}

static int inside_region(const tobi_region *r, const tobi_bvh *tree, const double x[3], int dimension)
{
    double d2 = 0;
    if (tree) return tobi_bvh_inside(tree, x);
    for (int a = 0; a < dimension; a++) {
        double d = x[a] - 0.5*(r->lower[a] + r->upper[a]);
        d2 += d*d;
    }
    return !(r->radius > 0) || d2 < r->radius*r->radius;
}

double tobi_region_depth(const tobi_region *r, const tobi_bvh *tree, const double x[3], int dimension,
                         double most)
{
    return tree && !tobi_bvh_inside(tree, x) ? -1 : find_depth(r, tree, x, dimension, most);
}

/* The lattice points inside a region, in the order of z, y, x; those outside the domain included. */
static int64_t place_lattice(const tobi_system *s, const tobi_region *r, const tobi_bvh *tree,
                             double (*points)[3])
{
    int64_t n[3], count = 0;
    double step[3];
    if (r->points) {
        memcpy(points, r->points, (size_t)r->point_count*sizeof *points);
        return r->point_count;
    }
    lattice(s, r, n, step);
    for (int64_t k = 0; k < n[2]; k++)
        for (int64_t j = 0; j < n[1]; j++)
            for (int64_t i = 0; i < n[0]; i++) {
                const double at[3] = {(double)i + 0.5, (double)j + 0.5, (double)k + 0.5};
                double *x = points[count];
                for (int a = 0; a < 3; a++)
                    x[a] = a < s->box.dimension ? r->lower[a] + at[a]*step[a] : 0;
                count += inside_region(r, tree, x, s->box.dimension);
            }
    return count;
}

static int scattered(const tobi_system *s, const tobi_region *r)
{
    return s->solid_count && s->solids[r->owner].def.seeding == TOBI_SEED_BLUE_NOISE;
}

static tobi_status scatter(const tobi_system *s, const tobi_region *r, const tobi_bvh *tree,
                           int64_t count, double (*points)[3], tobi_error *err)
{
    tobi_seed_shape shape = { .radius = r->radius, .tree = tree, .dimension = s->box.dimension };
    memcpy(shape.lower, r->lower, sizeof shape.lower);
    memcpy(shape.upper, r->upper, sizeof shape.upper);
    return tobi_seed_scatter(&shape, s->smoothing.spacing, (uint64_t)r->owner << 32 | (uint64_t)r->number,
                             count, points, s->sim->exec.threads, err);
}

/* A compartment's own points tell what lies in it: its box may hold other places. */
static tobi_status list_points(const tobi_system *s, const tobi_region *r, tobi_overlap **within,
                               tobi_error *err)
{
    *within = NULL;
    if (!r->points || s->fluid_count < 2) return TOBI_OK;
    return tobi_overlap_create((const double (*)[3])r->points, r->point_count, s->box.dimension,
                               s->smoothing.spacing, within, err);
}

/* A fluid that starts inside an earlier one takes its place: particles in the region are its own then, on the
   lattice that they have, and none is added near them. *taken: all places so far, NULL: none was met. */
static tobi_status take_over(tobi_system *s, const tobi_region *r, const tobi_bvh *tree, tobi_overlap **taken,
                             tobi_error *err)
{
    const tobi_particles *p = &s->particles;
    int64_t met = 0;
    tobi_overlap *within;
    *taken = NULL;
    TOBI_TRY(list_points(s, r, &within, err));
    for (int64_t i = 0; i < p->count && s->fluid_count > 1; i++) {
        const double at[3] = { p->position[i].x, p->position[i].y, p->position[i].z };
        double x[3];
        int out = 0;
        for (int a = 0; a < 3; a++) {
            x[a] = at[a] + s->box.lower[a];
            if (a < s->box.dimension) out |= x[a] < r->lower[a] || x[a] > r->upper[a];
        }
        if (out || p->fluid[i] == r->owner) continue;
        if (within ? !tobi_overlap_meets(within, x) : !inside_region(r, tree, x, s->box.dimension)) continue;
        give(s, r, i, at);
        met++;
    }
    tobi_overlap_free(within);
    if (met == 0) return TOBI_OK;
    return tobi_overlap_create((const double (*)[3])p->position, p->count, s->box.dimension,
                               s->smoothing.spacing, taken, err);
}

/* Places the points of a region and keeps those in the domain, outside of bodies and before planes. */
static tobi_status fill(tobi_system *s, tobi_region *r, const tobi_bvh *tree, double (*points)[3],
                        tobi_error *err)
{
    const int64_t first = s->particles.count, count = place_lattice(s, r, tree, points);
    tobi_overlap *taken;
    if (scattered(s, r)) TOBI_TRY(scatter(s, r, tree, count, points, err));
    TOBI_TRY(take_over(s, r, tree, &taken, err));
    for (int64_t i = 0; i < count; i++) {
        double *x = points[i];
        int out = 0;
        for (int a = 0; a < 3; a++) {
            x[a] -= s->box.lower[a];
            if (a < s->box.dimension) out |= x[a] < 0 || x[a] >= s->box.size[a];
        }
        r->outside += out;
        if (tobi_overlap_meets(taken, x)) continue;
        if (out || tobi_openings_cover(s->sim, x) || !tobi_nest_takes(s, x)) continue;
        if (inside_body(s, r, x)) r->covered++;
        else if (behind_plane(s, x)) r->behind++;
        else if (tobi_overlap_meets(s->sim->soft.start, x)) r->soaked++;
        else add_particle(s, r, x);
    }
    tobi_overlap_free(taken);
    r->placed = s->particles.count - first;
    TOBI_TRY(add_flow(s, r, first, err));
    start_solids(s, r, tree, first, count);
    return TOBI_OK;
}

tobi_status tobi_region_fill(tobi_system *s, tobi_region *r, tobi_error *err)
{
    const tobi_mesh *m = &r->shape;
    tobi_bvh *tree = NULL;
    r->outside = r->covered = r->behind = r->soaked = r->cut = 0;
    r->blade = 0;
    if (m->triangle_count)
        TOBI_TRY(tobi_bvh_build(m->vertex_count, (const double (*)[3])m->vertices, m->triangle_count,
                                (const int32_t (*)[3])m->triangles, &tree, err));
    if (m->overlapping) tobi_bvh_use_winding(tree);
    double (*points)[3] = malloc((size_t)(tobi_region_count(s, r) + 1)*sizeof *points);
    tobi_status status = points ? fill(s, r, tree, points, err)
                                : tobi_fail(err, TOBI_NO_MEMORY, "no memory for the particles of a region");
    free(points);
    tobi_bvh_free(tree);
    return status;
}

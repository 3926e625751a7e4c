/* Scattered points that relax by soft repulsion. A surface repels like the point's own image behind it, so
   that the outermost points lie half a spacing inside, as those of a lattice do. */
#include "geom/seed.h"
#include "exec/exec.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

enum { PASSES = 16 };
#define REACH 1.3                      /* spacings; in the densest packing neighbours would be 1.12 apart */
#define STIFFNESS 0.2                  /* share of an overlap taken out in a pass */
#define MOST 0.2                       /* spacings, of one pass */
#define JITTER 0.45                    /* spacings */

typedef struct relaxing {
    const tobi_seed_shape *shape;
    double spacing, cell;
    int64_t size[3], count;
    uint64_t seed;
    double (*x)[3], (*next)[3];
    int64_t *start, *order;            /* of the cells, and the points in them */
} relaxing;

/* splitmix64 of Steele, Lea & Flood 2014 (OOPSLA), as a hash. */
static uint64_t scramble(uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30)*0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27)*0x94d049bb133111ebu;
    return x ^ x >> 31;
}

/* How deep x lies inside the shape, m, if that is less than `far`; else far. away: unit vector from the
   surface into the shape. */
static double find_depth(const tobi_seed_shape *s, const double x[3], double far, double away[3])
{
    tobi_bvh_hit hit;
    double depth = far;
    if (s->tree) {
        if (!tobi_bvh_closest(s->tree, x, far, &hit)) return tobi_bvh_inside(s->tree, x) ? far : -far;
        for (int a = 0; a < 3; a++) away[a] = -hit.normal[a];
        return -hit.signed_distance;
    }
    if (s->radius > 0) {
        double from[3] = {0, 0, 0};
        for (int a = 0; a < s->dimension; a++) from[a] = 0.5*(s->lower[a] + s->upper[a]) - x[a];
        depth = s->radius - vec3_length(from);
        vec3_normalize(from);
        memcpy(away, from, sizeof from);
        return fmin(depth, far);
    }
    for (int side = 0; side < 2*s->dimension; side++) {
        int a = side/2;
        double d = side%2 ? s->upper[a] - x[a] : x[a] - s->lower[a];
        if (d >= depth) continue;
        depth = d;
        for (int k = 0; k < 3; k++) away[k] = 0;
        away[a] = side%2 ? -1 : 1;
    }
    return depth;
}

static void jitter_points(const void *view, int64_t begin, int64_t end)
{
    const relaxing *r = view;
    for (int64_t i = begin; i < end; i++) {
        double moved[3], away[3];
        memcpy(moved, r->x[i], sizeof moved);
        for (int a = 0; a < r->shape->dimension; a++) {
            uint64_t bits = scramble(r->seed ^ scramble((uint64_t)i*3 + (uint64_t)a));
            moved[a] += 2*JITTER*r->spacing*((double)(bits >> 11)*0x1p-53 - 0.5);
        }
        if (find_depth(r->shape, moved, r->spacing, away) > 0) memcpy(r->x[i], moved, sizeof moved);
    }
}

static int64_t cell_at(const relaxing *r, int axis, double x)
{
    int64_t k = (int64_t)floor((x - r->shape->lower[axis])/r->cell);
    return k < 0 ? 0 : k >= r->size[axis] ? r->size[axis] - 1 : k;
}

static int64_t cell_of(const relaxing *r, const double x[3])
{
    int64_t z = r->shape->dimension == 3 ? cell_at(r, 2, x[2]) : 0;
    return (z*r->size[1] + cell_at(r, 1, x[1]))*r->size[0] + cell_at(r, 0, x[0]);
}

/* Points by cell, in their own order within each. */
static void sort_cells(relaxing *r)
{
    int64_t cells = r->size[0]*r->size[1]*r->size[2];
    memset(r->start, 0, (size_t)(cells + 1)*sizeof *r->start);
    for (int64_t i = 0; i < r->count; i++) r->start[cell_of(r, r->x[i])]++;
    for (int64_t c = 1; c <= cells; c++) r->start[c] += r->start[c - 1];
    for (int64_t i = r->count; i-- > 0;) r->order[--r->start[cell_of(r, r->x[i])]] = i;
}

static void push_from(const relaxing *r, int64_t i, int64_t cell, double push[3])
{
    const double reach = REACH*r->spacing;
    for (int64_t k = r->start[cell]; k < r->start[cell + 1]; k++) {
        double d[3];
        vec3_sub(d, r->x[i], r->x[r->order[k]]);
        double length2 = vec3_dot(d, d);
        if (length2 >= reach*reach || !(length2 > 0)) continue;
        double length = sqrt(length2);
        vec3_add_scaled(push, push, (reach - length)/length, d);
    }
}

static void move_point(const relaxing *r, int64_t i)
{
    const tobi_seed_shape *s = r->shape;
    double push[3] = {0, 0, 0}, away[3], reach = REACH*r->spacing;
    int64_t low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    for (int a = 0; a < s->dimension; a++) {
        low[a] = cell_at(r, a, r->x[i][a] - reach);
        high[a] = cell_at(r, a, r->x[i][a] + reach);
    }
    for (int64_t z = low[2]; z <= high[2]; z++)
        for (int64_t y = low[1]; y <= high[1]; y++)
            for (int64_t x = low[0]; x <= high[0]; x++)
                push_from(r, i, (z*r->size[1] + y)*r->size[0] + x, push);
    double depth = find_depth(s, r->x[i], 0.5*reach, away);
    if (depth < 0.5*reach) vec3_add_scaled(push, push, reach - 2*depth, away);
    if (s->dimension == 2) push[2] = 0;
    double length = STIFFNESS*vec3_length(push), most = MOST*r->spacing;
    double step = STIFFNESS*(length > most ? most/length : 1);
    vec3_add_scaled(r->next[i], r->x[i], step, push);
    if (!(find_depth(s, r->next[i], r->spacing, away) > 0)) memcpy(r->next[i], r->x[i], sizeof r->x[i]);
}

static void move_points(const void *view, int64_t begin, int64_t end)
{
    for (int64_t i = begin; i < end; i++) move_point(view, i);
}

static tobi_status relax(relaxing *r, int threads, tobi_error *err)
{
    double cells = 1;
    r->cell = REACH*r->spacing;
    for (int a = 0; a < 3; a++) {
        int flat = a == 2 && r->shape->dimension == 2;
        double n = flat ? 1 : fmax(1, floor((r->shape->upper[a] - r->shape->lower[a])/r->cell));
        r->size[a] = (int64_t)n;
        cells *= n;
    }
    r->next = malloc((size_t)(r->count + 1)*sizeof *r->next);
    r->order = malloc((size_t)(r->count + 1)*sizeof *r->order);
    r->start = cells < 1e10 ? malloc((size_t)(cells + 2)*sizeof *r->start) : NULL;
    if (!r->next || !r->order || !r->start)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory to scatter %lld particles", (long long)r->count);
    for (int pass = 0; pass < PASSES; pass++) {
        sort_cells(r);
        tobi_loop(threads, r->count, 0, move_points, r);
        memcpy(r->x, r->next, (size_t)r->count*sizeof *r->x);
    }
    return TOBI_OK;
}

tobi_status tobi_seed_scatter(const tobi_seed_shape *shape, double spacing, uint64_t number, int64_t count,
                              double (*points)[3], int threads, tobi_error *err)
{
    relaxing r = { .shape = shape, .spacing = spacing, .count = count, .seed = scramble(number),
                   .x = points };
    if (count < 1) return TOBI_OK;
    tobi_loop(threads, count, 0, jitter_points, &r);
    tobi_status status = relax(&r, threads, err);
    free(r.next);
    free(r.order);
    free(r.start);
    return status;
}

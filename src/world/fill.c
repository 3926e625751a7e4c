#include "world/fill.h"
#include "base/error.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Far more than any machine takes; sums of a scene's regions, in bytes, still fit in 64 bits. */
#define COUNT_LIMIT 1e12

/* Layers of a side of length a, and their distance: the lattice is stretched to fill the box evenly, so
   that no gap of part of a spacing is left at a wall. */
static double layers(double a, double d) { return fmax(1, floor(a/d + 0.5)); }

static void lattice(const tobi_simulation *s, const tobi_region *r, int64_t n[3], double step[3])
{
    double d = s->smoothing.spacing;
    for (int a = 0; a < 3; a++) {
        double side = r->upper[a] - r->lower[a];
        int flat = a == 2 && s->box.dimension == 2;
        double count = flat ? 1 : r->shape.triangle_count ? ceil(side/d) : layers(side, d);
        n[a] = count < COUNT_LIMIT ? (int64_t)count : (int64_t)COUNT_LIMIT;
        step[a] = r->shape.triangle_count ? d : side/(double)n[a];
    }
}

int64_t tobi_region_count(const tobi_simulation *s, const tobi_region *r)
{
    int64_t n[3];
    double step[3];
    lattice(s, r, n, step);
    double count = (double)n[0]*(double)n[1]*(double)n[2];
    return count < COUNT_LIMIT ? (int64_t)count : (int64_t)COUNT_LIMIT;
}

static int inside_body(const tobi_simulation *s, const double x[3])
{
    for (int k = 0; k < s->body_count; k++) {
        double lo[3], hi[3];
        int out = 0;
        tobi_bvh_box(s->bodies[k].bvh, lo, hi);
        for (int a = 0; a < s->box.dimension; a++) out |= x[a] < lo[a] || x[a] > hi[a];
        if (!out && tobi_bvh_inside(s->bodies[k].bvh, x)) return 1;
    }
    return 0;
}

static void add_particle(tobi_simulation *s, const tobi_region *r, const double x[3])
{
    tobi_particles *p = &s->particles;
    int64_t i = p->count++;
    double arm[3], v[3];
    for (int a = 0; a < 3; a++) arm[a] = x[a] + s->box.lower[a] - 0.5*(r->lower[a] + r->upper[a]);
    for (int a = 0; a < 3; a++) {
        int b = (a + 1)%3, c = (a + 2)%3;
        v[a] = r->velocity[a] + r->spin[b]*arm[c] - r->spin[c]*arm[b];
    }
    p->position[i] = (tobi_double3){x[0], x[1], x[2]};
    p->velocity[i] = (tobi_float4){(float)v[0], (float)v[1], s->box.dimension == 3 ? (float)v[2] : 0, 0};
    p->fluid[i] = (uint8_t)r->owner;
    p->id[i] = i;
    if (p->pressure) p->pressure[i] = 0;
    if (p->rest) p->rest[i] = (tobi_float4){(float)x[0], (float)x[1], (float)x[2], 0};
}

/* Solids: the particles of a region share its exact volume, those that were cut off included. */
static void set_volumes(tobi_simulation *s, const tobi_region *r, int64_t first, int64_t whole)
{
    tobi_particles *p = &s->particles;
    if (!p->strain) return;
    double volume = r->volume/(double)whole, density = s->solids[r->owner].def.density;
    float w[3] = {(float)r->spin[0], (float)r->spin[1], (float)r->spin[2]};
    tobi_columns turning = {{{0, w[2], -w[1], 0}, {-w[2], 0, w[0], 0}, {w[1], -w[0], 0, 0}}};
    if (s->box.dimension == 2) turning.c[0].z = turning.c[1].z = turning.c[2].x = turning.c[2].y = 0;
    for (int64_t i = first; i < p->count; i++) {
        p->strain[i] = (tobi_columns){0};
        p->affine[i] = turning;
        p->strain[i].c[0].w = (float)volume;
        p->strain[i].c[2].w = (float)(density*volume);
    }
}

/* Scattered points: one in each cell of the lattice, the best of a few candidates, that is the one farthest
   from the points of the cells before (Mitchell 1991). Density is as even as the lattice's, and no row of
   particles lies along an axis. */
typedef struct scatter {
    double (*point)[3];            /* [2 layers][n1][n0]; NULL: the points of the lattice itself */
    uint64_t random;
} scatter;

static double draw(scatter *c)     /* 0 to 1: splitmix64 */
{
    uint64_t z = c->random += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30))*UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27))*UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ (z >> 31)) >> 11)*0x1p-53;
}

/* Distance squared to the nearest point of the 13 cells before. */
static double look_around(const scatter *c, const int64_t n[3], const int64_t at[3], const double x[3])
{
    double nearest = INFINITY;
    for (int m = 0; m < 13; m++) {
        int64_t i = at[0] + m%3 - 1, j = at[1] + m/3%3 - 1, k = at[2] + m/9 - 1;
        if (i < 0 || j < 0 || k < 0 || i >= n[0] || j >= n[1]) continue;
        const double *p = c->point[((k & 1)*n[1] + j)*n[0] + i];
        double d2 = 0;
        for (int a = 0; a < 3; a++) d2 += (x[a] - p[a])*(x[a] - p[a]);
        nearest = fmin(nearest, d2);
    }
    return nearest;
}

/* The particle of a cell, m in the world. */
static void place_point(const tobi_region *r, scatter *c, const int64_t n[3], const double step[3],
                        const int64_t at[3], int dimension, double w[3])
{
    enum { CANDIDATES = 12 };
    double best = -1;
    for (int a = 0; a < 3; a++) w[a] = a < dimension ? r->lower[a] + ((double)at[a] + 0.5)*step[a] : 0;
    for (int m = 0; c->point && m < CANDIDATES; m++) {
        double x[3] = {0}, d2;
        for (int a = 0; a < dimension; a++) x[a] = r->lower[a] + ((double)at[a] + draw(c))*step[a];
        d2 = look_around(c, n, at, x);
        if (d2 > best) memcpy(w, x, sizeof x);
        best = fmax(best, d2);
    }
    if (c->point) memcpy(c->point[((at[2] & 1)*n[1] + at[1])*n[0] + at[0]], w, sizeof *c->point);
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

tobi_status tobi_region_fill(tobi_simulation *s, const tobi_region *r, int64_t *cut, tobi_error *err)
{
    int64_t n[3], first = s->particles.count, whole = 0;
    double step[3];
    const tobi_mesh *m = &r->shape;
    tobi_bvh *tree = NULL;
    scatter c = {0};
    if (m->triangle_count)
        TOBI_TRY(tobi_bvh_build(m->vertex_count, (const double (*)[3])m->vertices, m->triangle_count,
                                (const int32_t (*)[3])m->triangles, &tree, err));
    if (m->overlapping) tobi_bvh_use_winding(tree);
    lattice(s, r, n, step);
    if (s->particles.strain && s->solids[r->owner].def.seeding == TOBI_SEED_BLUE_NOISE) {
        c = (scatter){ calloc((size_t)(2*n[0]*n[1]), sizeof *c.point), (uint64_t)r->owner };
        if (!c.point) {
            tobi_bvh_free(tree);
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the particles of a region");
        }
    }
    for (int64_t k = 0; k < n[2]; k++)
        for (int64_t j = 0; j < n[1]; j++)
            for (int64_t i = 0; i < n[0]; i++) {
                double w[3], x[3];
                int out = 0;
                place_point(r, &c, n, step, (int64_t[3]){i, j, k}, s->box.dimension, w);
                for (int a = 0; a < 3; a++) {
                    x[a] = w[a] - s->box.lower[a];
                    if (a < s->box.dimension) out |= x[a] < 0 || x[a] >= s->box.size[a];
                }
                if (!inside_region(r, tree, w, s->box.dimension)) continue;
                whole++;
                if (!out && !inside_body(s, x)) add_particle(s, r, x);
            }
    set_volumes(s, r, first, whole);
    *cut = whole - (s->particles.count - first);
    free(c.point);
    tobi_bvh_free(tree);
    return TOBI_OK;
}

#include "world/fill.h"
#include "base/error.h"
#include <math.h>
#include <stdlib.h>

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
    p->position[i] = (tobi_double3){x[0], x[1], x[2]};
    p->velocity[i] = (tobi_float4){(float)r->velocity[0], (float)r->velocity[1], (float)r->velocity[2], 0};
    p->pressure[i] = 0;
    p->fluid[i] = (uint8_t)r->fluid;
    p->id[i] = i;
}

tobi_status tobi_region_fill(tobi_simulation *s, const tobi_region *r, tobi_error *err)
{
    int64_t n[3];
    double step[3];
    const tobi_mesh *m = &r->shape;
    tobi_bvh *tree = NULL;
    if (m->triangle_count)
        TOBI_TRY(tobi_bvh_build(m->vertex_count, (const double (*)[3])m->vertices, m->triangle_count,
                                (const int32_t (*)[3])m->triangles, &tree, err));
    if (m->overlapping) tobi_bvh_use_winding(tree);
    lattice(s, r, n, step);
    for (int64_t k = 0; k < n[2]; k++)
        for (int64_t j = 0; j < n[1]; j++)
            for (int64_t i = 0; i < n[0]; i++) {
                double w[3] = {r->lower[0] + ((double)i + 0.5) * step[0],
                               r->lower[1] + ((double)j + 0.5) * step[1],
                               s->box.dimension == 3 ? r->lower[2] + ((double)k + 0.5) * step[2]
                                                     : 0},
                       x[3];
                int out = 0;
                for (int a = 0; a < 3; a++) {
                    x[a] = w[a] - s->box.lower[a];
                    if (a < s->box.dimension) out |= x[a] < 0 || x[a] >= s->box.size[a];
                }
                if (out || (tree && !tobi_bvh_inside(tree, w)) || inside_body(s, x)) continue;
                add_particle(s, r, x);
            }
    tobi_bvh_free(tree);
    return TOBI_OK;
}

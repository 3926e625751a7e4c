/* Places in a table by cell: particles of solids, of fluids, points of a region. A fluid's particle lies in a
   solid where one of the solid's is nearer than NEAR spacings, the mean of both: inside a lattice some always
   is, outside the next layer of the same lattice is not. Drawback: between scattered particles (seeding
   blue-noise) a hole may be found. */
#include "world/overlap.h"
#include "base/error.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double NEAR = 0.9, THIN = 2;

struct tobi_overlap {
    const double (*at)[3];
    int dimension;
    double reach;              /* m, and the width of a cell                                        */
    int64_t mask;              /* buckets less one                                                  */
    int32_t *head, *next;      /* the last particle of a bucket, and the one before; -1 = none      */
};

static int64_t find_bucket(const tobi_overlap *o, const int64_t cell[3])
{
    uint64_t key = 0;
    for (int a = 0; a < 3; a++) key = (key ^ (uint64_t)cell[a])*UINT64_C(0x9e3779b97f4a7c15);
    return (int64_t)(key >> 20) & o->mask;
}

static void find_cell(const tobi_overlap *o, const double *x, int64_t cell[3])
{
    for (int a = 0; a < 3; a++)
        cell[a] = a < o->dimension ? (int64_t)floor(x[a]/o->reach) : 0;
}

tobi_status tobi_overlap_create(const double (*at)[3], int64_t n, int dimension, double between,
                                tobi_overlap **out, tobi_error *err)
{
    tobi_overlap *o = *out = calloc(1, sizeof *o);
    if (!o) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the places of particles");
    *o = (tobi_overlap){ .at = at, .dimension = dimension, .reach = NEAR*between, .mask = 1 };
    while (o->mask < n) o->mask *= 2;
    o->head = malloc((size_t)o->mask*sizeof *o->head);
    o->next = malloc((size_t)(n + 1)*sizeof *o->next);
    if (!o->head || !o->next) {
        tobi_overlap_free(o);
        *out = NULL;
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the places of %lld particles", (long long)n);
    }
    for (int64_t k = 0; k < o->mask; k++) o->head[k] = -1;
    o->mask--;
    for (int64_t i = 0; i < n; i++) {
        int64_t cell[3];
        find_cell(o, at[i], cell);
        const int64_t bucket = find_bucket(o, cell);
        o->next[i] = o->head[bucket];
        o->head[bucket] = (int32_t)i;
    }
    return TOBI_OK;
}

static int meets_bucket(const tobi_overlap *o, int64_t bucket, const double x[3])
{
    for (int32_t i = o->head[bucket]; i >= 0; i = o->next[i]) {
        const double *at = o->at[i];
        double square = 0;
        for (int a = 0; a < o->dimension; a++) square += (at[a] - x[a])*(at[a] - x[a]);
        if (square < o->reach*o->reach) return 1;
    }
    return 0;
}

int tobi_overlap_meets(const tobi_overlap *o, const double x[3])
{
    int64_t middle[3];
    if (!o) return 0;
    const int deep = o->dimension == 3;
    find_cell(o, x, middle);
    for (int z = -deep; z <= deep; z++)
        for (int y = -1; y <= 1; y++)
            for (int k = -1; k <= 1; k++) {
                const int64_t cell[3] = { middle[0] + k, middle[1] + y, middle[2] + z };
                if (meets_bucket(o, find_bucket(o, cell), x)) return 1;
            }
    return 0;
}

tobi_status tobi_overlap_note_solids(tobi_world *w, tobi_error *err)
{
    const tobi_system *solids = w->sim.soft.solids;
    for (int k = 0; solids && k < w->region_count; k++) {
        const tobi_region *r = &w->regions[k];
        const double d = w->system[0].smoothing.spacing;   /* of the water, whose kernels reach through */
        double least = INFINITY;
        char text[TOBI_NOTE];
        if (&w->system[r->system] != solids || r->shape.triangle_count) continue;
        for (int a = 0; a < solids->box.dimension; a++) least = fmin(least, r->upper[a] - r->lower[a]);
        if (!(least < THIN*d*(1 - 1e-6))) continue;
        snprintf(text, sizeof text, tr("fill[%d] is %.3g m thin, less than two spacings: water on both sides "
                 "meets through it; a spacing of %.3g m would do\n"), r->number, least, least/THIN);
        TOBI_TRY(tobi_world_add_notes(w, "solid", solids->solids[r->owner].name, text, err));
    }
    return TOBI_OK;
}

void tobi_overlap_free(tobi_overlap *o)
{
    if (!o) return;
    free(o->head);
    free(o->next);
    free(o);
}

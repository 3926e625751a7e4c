/* Regions of one fluid, and regions of solids, do not share a place: twice the particles there would burst
   apart. Boxes and spheres are compared in the scene; here those of which one is a mesh or an outline.
   Drawback: regions that share less than half a spacing are not found, so that round surfaces made of facets
   may touch. */
#include "world/apart.h"
#include "base/error.h"
#include "geom/bvh.h"
#include <stdlib.h>

static int boxes_meet(const tobi_region *a, const tobi_region *b, int dimension)
{
    for (int k = 0; k < dimension; k++)
        if (!(a->upper[k] > b->lower[k] && b->upper[k] > a->lower[k])) return 0;
    return 1;
}

/* The first particle of a region, from `begin` on, that lies half a spacing deep in an earlier one. */
static tobi_status compare(const tobi_system *s, const tobi_region *before, const tobi_region *r,
                           int64_t begin, tobi_error *err)
{
    const int solids = s->solid_count > 0;
    const char *own = solids ? s->solids[r->owner].name : s->fluid[r->owner].name,
               *other = solids ? s->solids[before->owner].name : s->fluid[before->owner].name;
    const tobi_mesh *m = &before->shape;
    const double half = 0.5*s->smoothing.spacing;
    tobi_bvh *tree = NULL;
    tobi_status status = TOBI_OK;
    if (m->triangle_count)
        TOBI_TRY(tobi_bvh_build(m->vertex_count, (const double (*)[3])m->vertices, m->triangle_count,
                                (const int32_t (*)[3])m->triangles, &tree, err));
    if (m->overlapping) tobi_bvh_use_winding(tree);
    for (int64_t i = begin; i < begin + r->placed && status == TOBI_OK; i++) {
        double x[3];
        for (int a = 0; a < 3; a++) x[a] = (&s->particles.position[i].x)[a] + s->box.lower[a];
        if (!(tobi_region_depth(before, tree, x, s->box.dimension, 2*half) > half)) continue;
        status = tobi_fail(err, TOBI_INVALID, "%s '%s': fill[%d] overlaps fill[%d] of '%s': both have "
                           "particles at (%.4g, %.4g, %.4g) m; regions may touch", solids ? tr("solid")
                           : tr("fluid"),
                           own, r->number, before->number, other, x[0], x[1], x[2]);
        tobi_at_key(err, status, "%ss[%d].fill[%d]", solids ? "solid" : "fluid", r->owner, r->number);
    }
    tobi_bvh_free(tree);
    return status;
}

/* Whether a pair is looked at: of solids all, of fluids those of one, as a later fluid takes the place. Those
   of vessels were compared when they were filled. */
static int is_pair(const tobi_system *s, const tobi_region *a, const tobi_region *b)
{
    if (a->system != b->system || a->in_vessel || b->in_vessel) return 0;
    return (s->solid_count > 0 || a->owner == b->owner) && boxes_meet(a, b, s->box.dimension);
}

tobi_status tobi_regions_check_apart(const tobi_system *s, int system, const tobi_region *regions, int count,
                                     tobi_error *err)
{
    int *shaped = malloc((size_t)(count + 1)*sizeof *shaped), n = 0;
    tobi_status status = shaped ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for regions");
    int64_t begin = 0;
    for (int k = 0; k < count && status == TOBI_OK; k++) {
        const tobi_region *r = &regions[k];
        if (r->system != system) continue;
        const int own = r->shape.triangle_count > 0, others = own ? k : n;
        for (int j = 0; j < others && status == TOBI_OK; j++) {
            const tobi_region *before = &regions[own ? j : shaped[j]];
            if (is_pair(s, before, r)) status = compare(s, before, r, begin, err);
        }
        if (own) shaped[n++] = k;
        begin += r->placed;
    }
    free(shaped);
    return status;
}

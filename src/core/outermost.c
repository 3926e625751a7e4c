/* Where nothing of a body can lie between a point of its surface and what looks at it, and whether it has
   thin parts. Found once, in the pose that the body starts in, and kept by every rigid motion: the sums over
   surface points then need no line of sight. Drawback: one round of queries through the mesh for each point
   and each triangle. */
#include "core/body.h"
#include "geom/vec3.h"

enum { MOST_TRIANGLES = 20000 };     /* coplanar ones are all looked at for each of them */

static void corners_of(const tobi_body *b, int64_t t, const double *x[3])
{
    for (int k = 0; k < 3; k++) x[k] = b->vertex[b->mesh.triangles[t][k]];
}

/* Twice the area over the longest edge. */
static double least_altitude(const tobi_body *b)
{
    double least = INFINITY;
    for (int64_t t = 0; t < b->mesh.triangle_count; t++) {
        const double *x[3];
        double ab[3], ac[3], n[3], longest = 0;
        corners_of(b, t, x);
        for (int k = 0; k < 3; k++) longest = fmax(longest, vec3_distance2(x[k], x[(k + 1)%3]));
        vec3_sub(ab, x[1], x[0]);
        vec3_sub(ac, x[2], x[0]);
        vec3_cross(n, ab, ac);
        least = fmin(least, vec3_length(n)/sqrt(longest));
    }
    return least;
}

/* A dent tilts what is nearest by its depth over the size of a triangle, and a tilted plane rises with the
   distance: only dents for which that stays far below a spacing pass. */
static int is_convex(const tobi_body *b, double point_spacing)
{
    double low[3], high[3];
    if (b->mesh.triangle_count > MOST_TRIANGLES || b->mesh.overlapping) return 0;
    tobi_bvh_box(b->bvh, low, high);
    const double size = sqrt(vec3_distance2(low, high));
    const double depth = TOBI_OUTERMOST*point_spacing*least_altitude(b)/size;
    if (!(depth > 1e-12*size)) return 0;      /* nothing that rounding leaves of a plane would pass */
    for (int64_t t = 0; t < b->mesh.triangle_count; t++) {
        const double *x[3];
        double ab[3], ac[3], n[3];
        corners_of(b, t, x);
        vec3_sub(ab, x[1], x[0]);
        vec3_sub(ac, x[2], x[0]);
        vec3_cross(n, ab, ac);
        vec3_normalize(n);
        if (tobi_bvh_rises_above(b->bvh, x[0], n, depth)) return 0;
    }
    return 1;
}

/* Nothing of the surface lies less than TOBI_THICK behind a point: a body that has no thin part. */
static int is_thick(const tobi_body *b, double point_spacing)
{
    for (int64_t k = 0; k < b->point_count; k++) {
        double from[3], to[3];
        if (!(b->area[k] > 0)) continue;
        vec3_add_scaled(from, b->point[k], -0.2*point_spacing, b->normal[k]);
        vec3_add_scaled(to, b->point[k], -TOBI_THICK*point_spacing, b->normal[k]);
        if (tobi_bvh_segment_hits(b->bvh, from, to)) return 0;
    }
    return 1;
}

void tobi_body_find_outermost(tobi_body *b, double point_spacing)
{
    if (b->deforms) return;
    b->convex = is_convex(b, point_spacing);
    b->thick = is_thick(b, point_spacing);
    for (int64_t k = 0; k < b->point_count; k++)
        b->outermost[k] = b->area[k] > 0 && !tobi_bvh_rises_above(b->bvh, b->point[k], b->normal[k],
                                                                  TOBI_OUTERMOST*point_spacing);
}

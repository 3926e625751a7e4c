/* Corners, convex edges and faces of a mesh, merged where the mesh is flat, and a ball where all
   corners are as far from one point. Drawback: a round shape that is no ball is as many faces as its
   mesh has. */
#include "geom/facets.h"
#include "geom/bvh_tree.h"
#include "geom/edges.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

#define FLAT 1e-4             /* rad: two faces at less than this are one plane                          */
#define BALL_TOLERANCE 2e-3   /* of the radius: rounding of meshes with few digits                       */
#define BALL_GAP 0.035        /* of the radius: faces of a sphere of some 320 triangles lie 2 % below it */

static tobi_status allocate(tobi_facets *f, tobi_error *err)
{
    f->ring_start = calloc((size_t)f->vertex_count + 1, sizeof *f->ring_start);
    f->ring = malloc((size_t)(6*f->triangle_count + 1)*sizeof *f->ring);
    f->owned = calloc((size_t)f->triangle_count + 1, sizeof *f->owned);
    f->corner = malloc((size_t)(f->vertex_count + 1)*sizeof *f->corner);
    if (f->ring_start && f->ring && f->owned && f->corner) return TOBI_OK;
    tobi_facets_free(f);
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the edges of a surface");
}

/* The two other corners of every triangle at a vertex; each neighbour once. */
static void list_rings(tobi_facets *f, const tobi_bvh *b)
{
    int64_t n = 0;
    for (int64_t v = 0; v < f->vertex_count; v++) {
        f->ring_start[v] = n;
        for (int64_t i = b->corner_start[v]; i < b->corner_start[v + 1]; i++)
            for (int step = 1; step < 3; step++) {
                int32_t other = b->triangles[b->corner_list[i]/3][(b->corner_list[i]%3 + step)%3];
                int64_t k = f->ring_start[v];
                while (k < n && f->ring[k] != other) k++;
                if (k == n) f->ring[n++] = other;
            }
    }
    f->ring_start[f->vertex_count] = n;
}

/* Sine of the angle by which the surface bends outward along an edge; negative in a groove. */
static double bend(const tobi_facets *f, int64_t t, int k)
{
    double turn[3], along[3];
    int32_t twin = f->opposite[t][k];
    if (twin < 0) return 0;
    vec3_sub(along, f->vertex[f->triangle[t][(k + 1)%3]], f->vertex[f->triangle[t][k]]);
    vec3_normalize(along);
    vec3_cross(turn, f->normal[t], f->normal[twin/3]);
    double sine = vec3_dot(turn, along);
    return vec3_dot(f->normal[t], f->normal[twin/3]) < 0 && fabs(sine) < FLAT ? 1 : sine;
}

/* Whether the faces at a vertex look into directions of space and not only of a plane or a line. */
static int is_corner(const tobi_facets *f, const tobi_bvh *b, int64_t v)
{
    const double *first = NULL;
    double across[3] = { 0, 0, 0 }, widest = 0;
    for (int64_t i = b->corner_start[v]; i < b->corner_start[v + 1]; i++) {
        const double *n = f->normal[b->corner_list[i]/3];
        double c[3];
        if (vec3_dot(n, n) == 0) continue;
        if (!first) first = n;
        vec3_cross(c, first, n);
        if (vec3_dot(c, c) <= widest) continue;
        widest = vec3_dot(c, c);
        memcpy(across, c, sizeof across);
    }
    if (widest < FLAT*FLAT) return 0;
    vec3_normalize(across);
    for (int64_t i = b->corner_start[v]; i < b->corner_start[v + 1]; i++)
        if (fabs(vec3_dot(across, f->normal[b->corner_list[i]/3])) > FLAT) return 1;
    return 0;
}

static void give_owners(tobi_facets *f, const tobi_bvh *b)
{
    f->convex = 1;
    for (int64_t t = 0; t < f->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            double sine = bend(f, t, k);
            if (f->opposite[t][k] < 0 || sine < -FLAT) f->convex = 0;
            if (sine > FLAT && t < f->opposite[t][k]/3) f->owned[t] |= (uint8_t)(8 << k);
        }
    for (int64_t v = 0; v < f->vertex_count; v++) {
        if (b->corner_start[v] == b->corner_start[v + 1] || !is_corner(f, b, v)) continue;
        int32_t first = b->corner_list[b->corner_start[v]];
        f->owned[first/3] |= (uint8_t)(1 << first%3);
        f->corner[f->corner_count++] = (int32_t)v;
    }
}

/* All vertices as far from the origin, and no face far below: somebody's sphere, or in 2-D disc. */
static void find_ball(tobi_facets *f, int flat)
{
    double near = INFINITY, far = 0, lowest = INFINITY;
    int axes = flat ? 2 : 3;
    for (int64_t v = 0; v < f->vertex_count; v++) {
        double r2 = 0;
        for (int a = 0; a < axes; a++) r2 += f->vertex[v][a]*f->vertex[v][a];
        near = fmin(near, sqrt(r2));
        far = fmax(far, sqrt(r2));
    }
    if (!f->convex || far - near > BALL_TOLERANCE*far) return;
    for (int64_t t = 0; t < f->triangle_count; t++) {
        if (flat && fabs(f->normal[t][2]) > 0.5) continue;
        if (vec3_dot(f->normal[t], f->normal[t]) == 0) continue;
        lowest = fmin(lowest, vec3_dot(f->normal[t], f->vertex[f->triangle[t][0]]));
    }
    if (lowest < (1 - BALL_GAP)*far) return;
    f->ball = 0.5*(near + far);
    f->ball_gap = far - lowest;
}

tobi_status tobi_facets_build(tobi_facets *f, const tobi_bvh *b, const double (*vertex)[3], int flat,
                              tobi_error *err)
{
    *f = (tobi_facets){ .bvh = b, .vertex = vertex, .triangle = (const int32_t (*)[3])b->triangles,
                        .normal = (const double (*)[3])b->face_normal,
                        .opposite = (const int32_t (*)[3])b->opposite, .vertex_count = b->vertex_count,
                        .triangle_count = b->triangle_count, .flat = flat };
    TOBI_TRY(allocate(f, err));
    list_rings(f, b);
    give_owners(f, b);
    for (int64_t v = 0; v < f->vertex_count; v++) f->reach = fmax(f->reach, vec3_length(vertex[v]));
    find_ball(f, flat);
    return TOBI_OK;
}

void tobi_facets_follow(tobi_facets *f)
{
    memset(f->owned, 0, (size_t)f->triangle_count*sizeof *f->owned);
    f->corner_count = 0;
    give_owners(f, f->bvh);
}

void tobi_facets_free(tobi_facets *f)
{
    free(f->ring_start);
    free(f->ring);
    free(f->owned);
    free(f->corner);
    memset(f, 0, sizeof *f);
}

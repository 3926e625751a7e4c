/* Plane cut by edges: a triangle with one corner on the other side is crossed at two edges. Each
   crossing is computed from the edge's lower vertex to its upper one, whichever triangle asks, so
   neighbours agree on it to the last bit. */
#include "geom/section.h"
#include "geom/vec3.h"
#include <stdlib.h>

void tobi_section_free(tobi_section *s)
{
    if (!s) return;
    free(s->triangle);
    free(s->a);
    free(s->b);
    free(s->from);
    free(s->to);
    *s = (tobi_section){0};
}

static int is_above(const tobi_mesh *mesh, int32_t v) { return mesh->vertices[v][2] >= 0; }

/* Where the edge from corner k to the next one meets the plane. */
static void cross_edge(const tobi_mesh *mesh, int32_t t, int k, double bary[3], double point[2])
{
    int next = (k + 1) % 3;
    int32_t i = mesh->triangles[t][k], j = mesh->triangles[t][next];
    int below = is_above(mesh, i) ? next : k, above = below == k ? next : k;
    const double *p = mesh->vertices[below == k ? i : j], *q = mesh->vertices[below == k ? j : i];
    double s = p[2]/(p[2] - q[2]);
    bary[0] = bary[1] = bary[2] = 0;
    bary[below] = 1 - s;
    bary[above] = s;
    for (int c = 0; c < 2; c++) point[c] = s < 1 ? p[c] + s*(q[c] - p[c]) : q[c];
}

tobi_status tobi_section_cut(const tobi_mesh *mesh, tobi_section *out, tobi_error *err)
{
    int64_t n = 0;
    *out = (tobi_section){0};
    for (int64_t t = 0; t < mesh->triangle_count; t++) {
        const int32_t *v = mesh->triangles[t];
        int above = is_above(mesh, v[0]) + is_above(mesh, v[1]) + is_above(mesh, v[2]);
        n += above == 1 || above == 2;
    }
    if (!n) {
        double min[3], max[3];
        tobi_mesh_box(mesh, min, max);
        return tobi_fail(err, TOBI_INVALID, "the plane z = 0 does not cut the mesh (its z runs from %g to "
                         "%g m); a 2-D body is the section of its mesh with z = 0", min[2], max[2]);
    }
    tobi_section s = {.count = n};
    s.triangle = malloc((size_t)n*sizeof *s.triangle);
    s.a = malloc((size_t)n*sizeof *s.a);
    s.b = malloc((size_t)n*sizeof *s.b);
    s.from = malloc((size_t)n*sizeof *s.from);
    s.to = malloc((size_t)n*sizeof *s.to);
    if (!s.triangle || !s.a || !s.b || !s.from || !s.to) {
        tobi_section_free(&s);
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a section of %lld pieces", (long long)n);
    }
    n = 0;
    for (int64_t t = 0; t < mesh->triangle_count; t++) {
        const int32_t *v = mesh->triangles[t];
        int rising = -1, falling = -1;
        for (int k = 0; k < 3; k++) {
            int here = is_above(mesh, v[k]), there = is_above(mesh, v[(k + 1) % 3]);
            if (!here && there) rising = k;
            if (here && !there) falling = k;
        }
        if (rising < 0) continue;
        /* seen from outside the triangle runs counter-clockwise: up on its right, down on its left */
        s.triangle[n] = (int32_t)t;
        cross_edge(mesh, (int32_t)t, falling, s.a[n], s.from[n]);
        cross_edge(mesh, (int32_t)t, rising, s.b[n], s.to[n]);
        n++;
    }
    *out = s;
    return TOBI_OK;
}

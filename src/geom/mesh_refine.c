/* Splitting long edges: a heap of edges, longest first; an edge is split at its middle in both of
   its triangles at once, so that the surface is conforming after every split.

   Heap entries are never removed early; an entry whose edge has been split meanwhile is recognised
   by its end points and skipped. */
#include "geom/edges.h"
#include "geom/mesh.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

#define MAX_TRIANGLES 100000000    /* refuses a mistyped max_edge before the memory is gone */

typedef struct long_edge {
    double length2;
    int32_t half, a, b;            /* half-edge and its vertices when it was filed */
} long_edge;

typedef struct refiner {
    tobi_mesh mesh;
    int32_t (*opposite)[3];
    int64_t vertex_room, triangle_room;
    long_edge *heap;
    int64_t heap_count, heap_room;
    double max2;
} refiner;

static int grow(void *array, int64_t *room, int64_t needed, size_t size)
{
    if (needed <= *room) return 1;
    int64_t larger = needed + needed/2 + 64;
    void *old, *moved;
    memcpy(&old, array, sizeof old);
    moved = realloc(old, (size_t)larger*size);
    if (!moved) return 0;
    memcpy(array, &moved, sizeof moved);
    *room = larger;
    return 1;
}

/* Longer first; ties by vertex numbers, so that the result does not depend on filing order. */
static int comes_before(const long_edge *p, const long_edge *q)
{
    if (p->length2 != q->length2) return p->length2 > q->length2;
    int32_t pl = p->a < p->b ? p->a : p->b, ql = q->a < q->b ? q->a : q->b;
    if (pl != ql) return pl < ql;
    return p->a + (int64_t)p->b < q->a + (int64_t)q->b;
}

static int push_edge(refiner *r, int32_t half)
{
    int32_t a = r->mesh.triangles[half/3][half % 3], b = r->mesh.triangles[half/3][(half + 1) % 3];
    long_edge e = {vec3_distance2(r->mesh.vertices[a], r->mesh.vertices[b]), half, a, b};
    if (!(e.length2 > r->max2)) return 1;
    if (!grow(&r->heap, &r->heap_room, r->heap_count + 1, sizeof *r->heap)) return 0;
    int64_t i = r->heap_count++;
    for (; i > 0 && comes_before(&e, &r->heap[(i - 1)/2]); i = (i - 1)/2) r->heap[i] = r->heap[(i - 1)/2];
    r->heap[i] = e;
    return 1;
}

static long_edge pop_edge(refiner *r)
{
    long_edge top = r->heap[0], last = r->heap[--r->heap_count];
    int64_t i = 0;
    for (int64_t child; (child = 2*i + 1) < r->heap_count; i = child) {
        if (child + 1 < r->heap_count && comes_before(&r->heap[child + 1], &r->heap[child])) child++;
        if (!comes_before(&r->heap[child], &last)) break;
        r->heap[i] = r->heap[child];
    }
    r->heap[i] = last;
    return top;
}

/* Cuts triangle t = (.., a, b, c) at m, the middle of its edge k from a to b: t keeps a, the new
   triangle u = (m, b, c) takes over b and the edge b c. */
static void cut_triangle(refiner *r, int32_t t, int k, int32_t m, int32_t u)
{
    int32_t *old = r->mesh.triangles[t], *new = r->mesh.triangles[u];
    int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
    int32_t outer = r->opposite[t][k1];
    new[0] = m;
    new[1] = old[k1];
    new[2] = old[k2];
    old[k1] = m;
    r->opposite[u][1] = outer;
    r->opposite[outer/3][outer % 3] = 3*u + 1;
    r->opposite[u][2] = 3*t + k1;
    r->opposite[t][k1] = 3*u + 2;
}

static int split_edge(refiner *r, int32_t half)
{
    tobi_mesh *mesh = &r->mesh;
    int32_t twin = r->opposite[half/3][half % 3], t = half/3, s = twin/3;
    int32_t u = (int32_t)mesh->triangle_count, w = u + 1, m = (int32_t)mesh->vertex_count;
    int64_t room = r->triangle_room;
    if (!grow(&mesh->vertices, &r->vertex_room, m + 1, sizeof *mesh->vertices) ||
        !grow(&mesh->triangles, &room, w + 1, sizeof *mesh->triangles) ||
        !grow(&r->opposite, &r->triangle_room, w + 1, sizeof *r->opposite)) return 0;
    const double *a = mesh->vertices[mesh->triangles[t][half % 3]],
                 *b = mesh->vertices[mesh->triangles[s][twin % 3]];
    for (int k = 0; k < 3; k++) mesh->vertices[m][k] = 0.5*(a[k] + b[k]);
    mesh->vertex_count++;
    mesh->triangle_count += 2;
    cut_triangle(r, t, half % 3, m, u);
    cut_triangle(r, s, twin % 3, m, w);
    /* t keeps a-m against w's m-a; u has m-b against s's b-m */
    r->opposite[t][half % 3] = 3*w;
    r->opposite[w][0] = half;
    r->opposite[s][twin % 3] = 3*u;
    r->opposite[u][0] = twin;
    return push_edge(r, half) && push_edge(r, twin) && push_edge(r, 3*u + 1) && push_edge(r, 3*u + 2) &&
           push_edge(r, 3*w + 1) && push_edge(r, 3*w + 2);
}

static tobi_status split_all(refiner *r, double max_edge, tobi_error *err)
{
    for (int32_t h = 0; h < 3*r->mesh.triangle_count; h++)
        if (r->opposite[h/3][h % 3] > h && !push_edge(r, h)) return TOBI_NO_MEMORY;
    while (r->heap_count) {
        long_edge e = pop_edge(r);
        const int32_t *t = r->mesh.triangles[e.half/3];
        int32_t a = t[e.half % 3], b = t[(e.half % 3 + 1) % 3];
        if (a != e.a || b != e.b) {
            /* the edge may have moved to a new triangle; its new owner filed it again */
            continue;
        }
        if (r->mesh.triangle_count + 2 > MAX_TRIANGLES)
            return tobi_fail(err, TOBI_INVALID, "refining to edges of %g m needs more than %d triangles; "
                             "allow longer edges", max_edge, MAX_TRIANGLES);
        if (!split_edge(r, e.half)) return TOBI_NO_MEMORY;
    }
    return TOBI_OK;
}

tobi_status tobi_mesh_refine(tobi_mesh *mesh, double max_edge, tobi_error *err)
{
    if (!(max_edge > 0)) return tobi_fail(err, TOBI_INVALID, "max_edge is %g m; it must be > 0", max_edge);
    refiner r = {.max2 = max_edge*max_edge};
    tobi_edge_report report = {0};
    TOBI_TRY(tobi_mesh_copy(mesh, &r.mesh, err));
    r.vertex_room = mesh->vertex_count;
    r.triangle_room = mesh->triangle_count;
    r.opposite = malloc((size_t)(r.triangle_room + 1)*sizeof *r.opposite);
    tobi_status status = TOBI_NO_MEMORY;
    if (r.opposite)
        status = tobi_edges_match(mesh->vertex_count, mesh->triangle_count,
                                  (const int32_t (*)[3])mesh->triangles, r.opposite, &report);
    if (status == TOBI_OK && (report.open || report.non_manifold))
        status = tobi_fail(err, TOBI_INVALID, "only a closed mesh can be refined");
    else if (status == TOBI_OK)
        status = split_all(&r, max_edge, err);
    if (status == TOBI_NO_MEMORY) tobi_fail(err, status, "no memory to refine a mesh to %g m", max_edge);
    free(r.opposite);
    free(r.heap);
    if (status != TOBI_OK) {
        tobi_mesh_free(&r.mesh);
        return status;
    }
    r.mesh.texture = mesh->texture;
    mesh->texture = NULL;
    tobi_mesh_free(mesh);
    *mesh = r.mesh;
    return TOBI_OK;
}

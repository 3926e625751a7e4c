/* Short edges are merged where that leaves the mesh a closed manifold: the two ends have exactly two
   neighbours in common. Marching cubes makes many tiny triangles beside the nodes of its grid; without them
   smoothing has less to do and finds better triangles. Drawback: one thread, edge after edge, so that the
   result has one order. */
#include "view/surface/surface.h"
#include <stdlib.h>
#include <string.h>

#define SHORT 0.4f               /* cells */
enum { RING = 12 };              /* neighbours that a vertex may get */

static int32_t find_root(int32_t *part, int32_t i)
{
    while (part[i] != i) i = part[i] = part[part[i]];
    return i;
}

static void join(int32_t *part, int32_t a, int32_t b)
{
    a = find_root(part, a);
    b = find_root(part, b);
    if (a < b) part[b] = a;
    else part[a] = b;
}

static double triangle_volume(const tobi_float4 *p, const int32_t t[3])
{
    const tobi_float4 *a = p + t[0], *b = p + t[1], *c = p + t[2];
    const double x = (double)b->y*c->z - (double)b->z*c->y, y = (double)b->z*c->x - (double)b->x*c->z,
                 z = (double)b->x*c->y - (double)b->y*c->x;
    return (a->x*x + a->y*y + a->z*z)/6;
}

/* Connected parts, in the order of their first vertices, and their volumes. */
tobi_status surface_find_parts(surface_work *w, tobi_error *err)
{
    const int64_t n = w->vertices;
    w->part = tobi_array_make(n + 1, sizeof *w->part);
    if (!w->part) return surface_no_memory(err, 4.0*(double)n);
    for (int64_t i = 0; i < n; i++) w->part[i] = (int32_t)i;
    for (int64_t t = 0; t < w->triangles; t++) {
        join(w->part, w->triangle[t][0], w->triangle[t][1]);
        join(w->part, w->triangle[t][0], w->triangle[t][2]);
    }
    /* a root is the least of its part: its number stands there when the others come */
    for (int64_t i = 0; i < n; i++) w->part[i] = find_root(w->part, (int32_t)i);
    for (int64_t i = 0; i < n; i++) w->part[i] = w->part[i] == i ? (int32_t)w->parts++ : w->part[w->part[i]];
    w->part_volume = tobi_array_zero(w->parts + 1, sizeof *w->part_volume);
    if (!w->part_volume) return surface_no_memory(err, 8.0*(double)w->parts);
    for (int64_t t = 0; t < w->triangles; t++)
        w->part_volume[w->part[w->triangle[t][0]]] += triangle_volume(w->vertex, w->triangle[t]);
    return TOBI_OK;
}

/* The corners of triangles at each vertex as lists; a triangle that is gone has a corner of -1. */
typedef struct corners {
    int32_t (*triangle)[3];
    int32_t *head, *next;
} corners;

static int list_ring(corners *c, int32_t v, int32_t ring[RING])
{
    int n = 0;
    int32_t *from = &c->head[v];
    while (*from >= 0) {
        const int32_t corner = *from, t = corner/3;
        if (c->triangle[t][0] < 0) {
            *from = c->next[corner];
            continue;
        }
        if (n == RING) return RING + 1;
        ring[n++] = c->triangle[t][(corner%3 + 1)%3];
        from = &c->next[corner];
    }
    return n;
}

static bool can_merge(corners *c, int32_t a, int32_t b)
{
    int32_t of_a[RING], of_b[RING];
    const int n = list_ring(c, a, of_a), m = n > RING ? n : list_ring(c, b, of_b);
    if (n > RING || m > RING || n + m - 4 > RING || (n == 3 && m == 3)) return false;
    int shared = 0;
    for (int k = 0; k < n; k++)
        for (int q = 0; q < m; q++) shared += of_a[k] == of_b[q];
    return shared == 2;
}

/* b becomes a. */
static void merge(corners *c, int32_t a, int32_t b)
{
    for (int32_t corner = c->head[b], next; corner >= 0; corner = next) {
        int32_t *t = c->triangle[corner/3];
        next = c->next[corner];
        if (t[0] < 0) continue;
        if (t[0] == a || t[1] == a || t[2] == a) {
            t[0] = -1;
            continue;
        }
        t[corner%3] = a;
        c->next[corner] = c->head[a];
        c->head[a] = corner;
    }
    c->head[b] = -1;
}

/* Where both go: half way, but what lies on a flat side stays on it, and the edge of a cap where it is. */
static void place_merged(surface_work *w, int32_t a, int32_t b)
{
    float p[3], *const to = &w->vertex[a].x;
    const uint8_t at[2] = { w->sides[a], w->sides[b] };
    const float *from[2] = { &w->vertex[a].x, &w->vertex[b].x };
    const int within[2] = { at[0] & SURFACE_WITHIN, at[1] & SURFACE_WITHIN };
    const int edge = within[0] == within[1] ? -1 : within[0] ? 1 : 0;
    for (int k = 0; k < 3; k++) {
        const int own = at[0] >> k & 9, other = at[1] >> k & 9;
        p[k] = own && !other ? from[0][k] : other && !own ? from[1][k] : edge >= 0 ? from[edge][k]
             : 0.5f*(from[0][k] + from[1][k]);
    }
    for (int k = 0; k < 3; k++) to[k] = p[k];
    w->sides[a] = (uint8_t)(((at[0] | at[1]) & ~SURFACE_WITHIN) | (at[0] & at[1] & SURFACE_WITHIN));
}

static float length2(const tobi_float4 *a, const tobi_float4 *b)
{
    const float x = a->x - b->x, y = a->y - b->y, z = a->z - b->z;
    return x*x + y*y + z*z;
}

static void merge_edges(surface_work *w, corners *c, float limit)
{
    for (int64_t t = 0; t < w->triangles; t++)
        for (int k = 0; k < 3 && c->triangle[t][0] >= 0; k++) {
            const int32_t a = c->triangle[t][k], b = c->triangle[t][(k + 1)%3];
            if (length2(&w->vertex[a], &w->vertex[b]) >= limit*limit || !can_merge(c, a, b)) continue;
            place_merged(w, a, b);
            merge(c, a, b);
        }
}

/* What is left, in its old order. */
static void close_gaps(surface_work *w, const corners *c, int32_t *number)
{
    int64_t n = 0, m = 0;
    for (int64_t i = 0; i < w->vertices; i++) {
        number[i] = (int32_t)n;
        if (c->head[i] < 0) continue;
        w->vertex[n] = w->vertex[i];
        w->sides[n] = w->sides[i];
        w->block_of[n] = w->block_of[i];
        w->part[n++] = w->part[i];
    }
    for (int64_t t = 0; t < w->triangles; t++) {
        if (w->triangle[t][0] < 0) continue;
        for (int k = 0; k < 3; k++) w->triangle[m][k] = number[w->triangle[t][k]];
        m++;
    }
    w->vertices = n;
    w->triangles = m;
}

tobi_status surface_merge_short(surface_work *w, tobi_error *err)
{
    const int64_t n = w->vertices, m = w->triangles;
    int32_t *number = malloc((size_t)n*sizeof *number + 1);
    corners c = { w->triangle, malloc((size_t)n*4 + 1), malloc((size_t)m*12 + 1) };
    const bool good = number && c.head && c.next;
    if (good) {
        memset(c.head, -1, (size_t)n*4);
        for (int64_t k = 3*m - 1; k >= 0; k--) {
            const int32_t v = w->triangle[k/3][k%3];
            c.next[k] = c.head[v];
            c.head[v] = (int32_t)k;
        }
        const float *cell = w->view.cell;
        const float least = cell[0] < cell[1] ? cell[0] < cell[2] ? cell[0] : cell[2]
                                              : cell[1] < cell[2] ? cell[1] : cell[2];
        merge_edges(w, &c, SHORT*least);
        close_gaps(w, &c, number);
    }
    free(number), free(c.head), free(c.next);
    return good ? TOBI_OK : surface_no_memory(err, 8.0*(double)n + 12.0*(double)m);
}

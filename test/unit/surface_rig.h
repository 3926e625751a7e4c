/* Checks of triangle meshes: closed, manifold, volume; and particles on lattices. */
#pragma once
#include "tobiuo/surface.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct rig_edge { int32_t from, to, third; } rig_edge;

static int rig_order(const void *a, const void *b)
{
    const rig_edge *p = a, *q = b;
    if (p->from != q->from) return p->from < q->from ? -1 : 1;
    return p->to < q->to ? -1 : p->to > q->to;
}

/* Every edge belongs to two triangles that run along it in opposite directions, and the triangles around
   each vertex form one ring. */
static inline bool rig_is_closed(const tobi_surface *s)
{
    const int64_t n = 3*s->triangle_count;
    rig_edge *e = malloc((size_t)n*sizeof *e + 1);
    bool good = true;
    for (int64_t k = 0; k < n; k++) {
        const int32_t *t = s->triangles[k/3];
        e[k] = (rig_edge){ t[k%3], t[(k + 1)%3], t[(k + 2)%3] };
        good &= t[k%3] >= 0 && t[k%3] < s->vertex_count;
    }
    qsort(e, (size_t)n, sizeof *e, rig_order);
    for (int64_t k = 0; k < n && good; k++) {
        const rig_edge back = { e[k].to, e[k].from, 0 };
        good = e[k].from != e[k].to && (k == 0 || rig_order(&e[k - 1], &e[k]) != 0) &&
               bsearch(&back, e, (size_t)n, sizeof *e, rig_order);
    }
    /* around a vertex: from its first edge on to the edge of the third corner, until the first comes again */
    for (int64_t k = 0, size; k < n && good; k += size) {
        for (size = 1; k + size < n && e[k + size].from == e[k].from;) size++;
        const rig_edge *at = &e[k];
        int64_t steps = 0;
        do {
            const rig_edge next = { at->from, at->third, 0 };
            at = bsearch(&next, e, (size_t)n, sizeof *e, rig_order);
            steps++;
        } while (at && at != &e[k] && steps <= size);
        good = at && steps == size;
    }
    free(e);
    return good;
}

static inline double rig_volume(const tobi_surface *s)
{
    double sum = 0;
    for (int64_t t = 0; t < s->triangle_count; t++) {
        const double *a = s->vertices[s->triangles[t][0]], *b = s->vertices[s->triangles[t][1]];
        const double *c = s->vertices[s->triangles[t][2]];
        sum += (a[0]*(b[1]*c[2] - b[2]*c[1]) + a[1]*(b[2]*c[0] - b[0]*c[2]) + a[2]*(b[0]*c[1] - b[1]*c[0]))/6;
    }
    return sum;
}

static int32_t rig_root(int32_t *part, int32_t i)
{
    while (part[i] != i) i = part[i] = part[part[i]];
    return i;
}

/* Parts of the mesh that are not connected. */
static inline int64_t rig_parts(const tobi_surface *s)
{
    int32_t *part = malloc((size_t)s->vertex_count*sizeof *part + 1);
    for (int64_t i = 0; i < s->vertex_count; i++) part[i] = (int32_t)i;
    for (int64_t k = 0; k < 3*s->triangle_count; k++)
        part[rig_root(part, s->triangles[k/3][k%3])] = rig_root(part, s->triangles[k/3][(k + 1)%3]);
    int64_t n = 0;
    for (int64_t i = 0; i < s->vertex_count; i++) n += part[i] == i;
    free(part);
    return n;
}

typedef struct rig_points { int64_t count; double (*position)[3]; } rig_points;

static inline double rig_random(uint64_t *seed)
{
    *seed = *seed*6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11)/9007199254740992.0 - 0.5;
}

/* Points (i + 1/2) d of a box of n[0] x n[1] x n[2] spacings at its corner, each moved by up to jitter/2. */
static inline rig_points rig_box(const int n[3], const double corner[3], double d, double jitter)
{
    rig_points p = { 0, malloc((size_t)n[0]*(size_t)n[1]*(size_t)n[2]*24) };
    uint64_t seed = 7;
    for (int z = 0; z < n[2]; z++)
        for (int y = 0; y < n[1]; y++)
            for (int x = 0; x < n[0]; x++, p.count++) {
                const int at[3] = { x, y, z };
                for (int a = 0; a < 3; a++)
                    p.position[p.count][a] = corner[a] + d*(at[a] + 0.5 + jitter*rig_random(&seed));
            }
    return p;
}

/* Those of them within a ball. */
static inline void rig_cut_ball(rig_points *p, const double middle[3], double radius)
{
    int64_t kept = 0;
    for (int64_t i = 0; i < p->count; i++) {
        double square = 0;
        for (int a = 0; a < 3; a++) square += pow(p->position[i][a] - middle[a], 2);
        if (square < radius*radius) memcpy(p->position[kept++], p->position[i], 24);
    }
    p->count = kept;
}

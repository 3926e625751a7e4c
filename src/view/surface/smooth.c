/* Weighted Laplacian smoothing (Loeschner, Boettcher, Jeske & Bender 2023, Weighted Laplacian Smoothing for
   Surface Reconstruction of Particle-based Fluids, VMV): each round moves a vertex to the mean of its
   neighbours, as far as the particles around are many. That flattens waves of up to twelve spacings too, so
   what was moved is smoothed itself and given back (Tukey's twicing), and each connected part gets its volume
   back along its normals. Vertices on flat sides stay there, and the edge of a cap is moved as if the liquid
   went on in a mirror. Drawback: corners of a body of liquid become round. */
#include "view/surface/surface.h"
#include "exec/rows.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct smooth_view {
    const surface_work *w;
    const int32_t *begin, *list; /* neighbours to take the mean of */
    const quad *factor;
    const quad *from;
    quad *to;
} smooth_view;

/* The two others of the triangles around each vertex. */
tobi_status surface_make_fans(surface_work *w, tobi_error *err)
{
    const int64_t n = w->vertices;
    w->fan_begin = tobi_array_zero(n + 2, sizeof *w->fan_begin);
    w->fan = tobi_array_make(3*w->triangles + 1, sizeof *w->fan);
    if (!w->fan_begin || !w->fan) return surface_no_memory(err, 8.0*(double)(n + 3*w->triangles));
    for (int64_t t = 0; t < w->triangles; t++)
        for (int k = 0; k < 3; k++) w->fan_begin[w->triangle[t][k] + 2]++;
    for (int64_t i = 0; i < n; i++) w->fan_begin[i + 2] += w->fan_begin[i + 1];
    for (int64_t t = 0; t < w->triangles; t++)
        for (int k = 0; k < 3; k++) {
            const int32_t *c = w->triangle[t];
            int32_t *to = w->fan[w->fan_begin[c[k] + 1]++];
            to[0] = c[(k + 1)%3], to[1] = c[(k + 2)%3];
        }
    return TOBI_OK;
}

/* A vertex of which all triangles are in caps. */
static bool is_within_cap(const surface_work *w, int32_t i)
{
    if (!w->sides[i]) return false;
    for (int32_t k = w->fan_begin[i]; k < w->fan_begin[i + 1]; k++)
        if (!surface_in_cap(w->sides, (int32_t[3]){ i, w->fan[k][0], w->fan[k][1] })) return false;
    return true;
}

/* Vertices at the free surface take no notice of those within caps. */
static void list_neighbours(const surface_work *w, uint8_t *within, int32_t *begin, int32_t *list)
{
    int32_t n = 0;
    for (int32_t i = 0; i < w->vertices; i++) within[i] = is_within_cap(w, i);
    for (int32_t i = 0; i < w->vertices; i++) {
        begin[i] = n;
        for (int32_t k = w->fan_begin[i]; k < w->fan_begin[i + 1]; k++)
            if (within[i] || !within[w->fan[k][0]]) list[n++] = w->fan[k][0];
    }
    begin[w->vertices] = n;
}

static quad free_axes(uint8_t sides)
{
    return (quad){ sides & 9 ? 0 : 1, sides & 18 ? 0 : 1, sides & 36 ? 0 : 1, 0 };
}

/* One round: to = from + factor (mean - from). */
static void smooth_range(const void *view, int64_t begin, int64_t end)
{
    const smooth_view *v = view;
    for (int64_t i = begin; i < end; i++) {
        const int32_t first = v->begin[i], last = v->begin[i + 1];
        quad sum = quad_set(0);
        for (int32_t k = first; k < last; k++) sum = sum + v->from[v->list[k]];
        const quad own = v->from[i];
        v->to[i] = last > first ? own + v->factor[i]*(sum*quad_set(1/(float)(last - first)) - own) : own;
    }
}

static quad *smooth_rounds(const surface_work *w, smooth_view *v, quad *a, quad *b)
{
    for (int round = 0; round < w->def->smoothing; round++) {
        v->from = a, v->to = b;
        tobi_loop(tobi_team(&w->exec, w->vertices, 2048), w->vertices, 0, smooth_range, v);
        quad *const swap = a;
        a = b, b = swap;
    }
    return a;
}

/* What smoothing has moved is smoothed and given back. */
static quad *smooth_twice(const surface_work *w, smooth_view *v, quad *a, quad *b)
{
    const quad *start = (const quad *)w->vertex;
    for (int64_t i = 0; i < w->vertices; i++) a[i] = start[i]*(quad){ 1, 1, 1, 0 };
    quad *smooth = smooth_rounds(w, v, a, b), *moved = smooth == a ? b : a;
    quad *copy = (quad *)w->normal;          /* not used yet */
    memcpy(copy, smooth, (size_t)w->vertices*sizeof *copy);
    for (int64_t i = 0; i < w->vertices; i++) moved[i] = start[i]*(quad){ 1, 1, 1, 0 } - copy[i];
    quad *back = smooth_rounds(w, v, moved, smooth);
    for (int64_t i = 0; i < w->vertices; i++) back[i] = copy[i] + back[i];
    return back;
}

static void cross_of(const tobi_float4 *p, int32_t i, int32_t j, int32_t k, float out[3])
{
    const float a[3] = { p[j].x - p[i].x, p[j].y - p[i].y, p[j].z - p[i].z };
    const float b[3] = { p[k].x - p[i].x, p[k].y - p[i].y, p[k].z - p[i].z };
    out[0] = a[1]*b[2] - a[2]*b[1], out[1] = a[2]*b[0] - a[0]*b[2], out[2] = a[0]*b[1] - a[1]*b[0];
}

/* Normal by area of the free triangles around a vertex, of all if none is free. */
static void normal_range(const void *view, int64_t begin, int64_t end)
{
    const surface_work *w = *(const surface_work *const *)view;
    for (int64_t i = begin; i < end; i++) {
        float n[3] = { 0, 0, 0 }, cap[3] = { 0, 0, 0 }, c[3];
        bool free = false;
        for (int32_t k = w->fan_begin[i]; k < w->fan_begin[i + 1]; k++) {
            const int32_t t[3] = { (int32_t)i, w->fan[k][0], w->fan[k][1] };
            const bool in_cap = surface_in_cap(w->sides, t);
            cross_of(w->vertex, t[0], t[1], t[2], c);
            free |= !in_cap;
            for (int a = 0; a < 3; a++) *(in_cap ? &cap[a] : &n[a]) += c[a];
        }
        const float *from = free ? n : cap, size = sqrtf(from[0]*from[0] + from[1]*from[1] + from[2]*from[2]);
        const float one = size > 0 ? 1/size : 0;
        w->normal[i] = (tobi_float4){ one*from[0], one*from[1], size > 0 ? one*from[2] : 1, 0 };
    }
}

void surface_make_normals(surface_work *w)
{
    const surface_work *const view = w;
    tobi_loop(tobi_team(&w->exec, w->vertices, 1024), w->vertices, 0, normal_range, &view);
}

typedef struct part_sum { double volume, area; } part_sum;

/* Volume and free area of each part. */
static void sum_parts(const surface_work *w, part_sum *sum)
{
    memset(sum, 0, (size_t)w->parts*sizeof *sum);
    for (int64_t t = 0; t < w->triangles; t++) {
        const int32_t *c = w->triangle[t], part = w->part[c[0]];
        const tobi_float4 *p = w->vertex;
        float n[3];
        cross_of(p, c[0], c[1], c[2], n);
        sum[part].volume += ((double)p[c[0]].x*n[0] + (double)p[c[0]].y*n[1] + (double)p[c[0]].z*n[2])/6;
        if (!surface_in_cap(w->sides, c))
            sum[part].area += 0.5*sqrt((double)n[0]*n[0] + (double)n[1]*n[1] + (double)n[2]*n[2]);
    }
}

/* Moves each part along its normals until it has its volume again; twice, because areas change. */
static void restore_volume(surface_work *w, part_sum *sum)
{
    for (int round = 0; round < 2; round++) {
        surface_make_normals(w);
        sum_parts(w, sum);
        for (int64_t i = 0; i < w->vertices; i++) {
            const part_sum *s = &sum[w->part[i]];
            const double way = s->area > 0 ? (w->part_volume[w->part[i]] - s->volume)/s->area : 0;
            const float step = (float)fmax(-0.2, fmin(0.2, way));
            const quad move = quad_set(step)*free_axes(w->sides[i])*quad_load(&w->normal[i]);
            quad_store(&w->vertex[i], quad_load(&w->vertex[i]) + move);
        }
    }
}

tobi_status surface_smooth(surface_work *w, tobi_error *err)
{
    const int64_t n = w->vertices;
    w->normal = tobi_array_make(n + 1, sizeof *w->normal);
    quad *a = tobi_array_make(n + 1, sizeof *a), *b = tobi_array_make(n + 1, sizeof *b);
    quad *factor = tobi_array_make(n + 1, sizeof *factor);
    int32_t *begin = malloc((size_t)n*4 + 4), *list = malloc((size_t)w->triangles*12 + 1);
    part_sum *sum = malloc((size_t)w->parts*sizeof *sum + 1);
    uint8_t *within = malloc((size_t)n + 1);
    const bool good = w->normal && a && b && factor && begin && list && sum && within;
    if (good && w->def->smoothing > 0) {
        list_neighbours(w, within, begin, list);
        for (int64_t i = 0; i < n; i++) factor[i] = quad_set(w->vertex[i].w)*free_axes(w->sides[i]);
        smooth_view v = { .w = w, .begin = begin, .list = list, .factor = factor };
        memcpy(w->vertex, smooth_twice(w, &v, a, b), (size_t)n*sizeof *w->vertex);
    }
    if (good) restore_volume(w, sum);
    tobi_array_free(a), tobi_array_free(b), tobi_array_free(factor);
    free(begin), free(list), free(sum), free(within);
    return good ? TOBI_OK : surface_no_memory(err, 100.0*(double)n);
}

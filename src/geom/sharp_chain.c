/* From the sharp edges of a mesh to chains: in each cluster of edges the shortest way between the
   two vertices that lie farthest apart along it (Dijkstra, twice), then what is left aside of it,
   and so on. */
#include "geom/sharp.h"
#include "geom/vec3.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct graph {
    const tobi_ridges *ridges;
    double width;
    int64_t *start;          /* [vertices + 1] into link                                        */
    int64_t *link;           /* 2 ridge + end: this vertex is its `from` (0) or its `to` (1)    */
    uint8_t *gone;           /* [ridges] taken, or too short a piece                            */
    double *distance;        /* [vertices] INFINITY before a search reaches it                  */
    int64_t *came_by;        /* [vertices] the ridge by which the search came, -1 at its start  */
    int32_t *heap, *reached; /* [vertices]                                                      */
    int64_t *place;          /* [vertices] in the heap, -1 outside                              */
    int64_t heap_count, reached_count;
    int64_t *way, way_count; /* ridges of the chain, from its first vertex on                   */
    int32_t *corner;         /* [way_count + 1] its vertices                                    */
    uint8_t *kept;           /* [way_count + 1] 1: stays when the chain is simplified           */
    int64_t *stack;
} graph;

static void free_graph(graph *g)
{
    free(g->start); free(g->link); free(g->gone); free(g->distance); free(g->came_by); free(g->heap);
    free(g->reached); free(g->place); free(g->way); free(g->corner); free(g->kept); free(g->stack);
}

static tobi_status make_graph(graph *g, const tobi_ridges *r, double width, tobi_error *err)
{
    size_t n = (size_t)r->vertex_count + 2, m = (size_t)r->count + 2;
    *g = (graph){ .ridges = r, .width = width };
    g->start = calloc(n, sizeof *g->start);
    g->link = malloc(2*m*sizeof *g->link);
    g->gone = calloc(m, 1);
    g->distance = malloc(n*sizeof *g->distance);
    g->came_by = malloc(n*sizeof *g->came_by);
    g->heap = malloc(n*sizeof *g->heap);
    g->reached = malloc(n*sizeof *g->reached);
    g->place = malloc(n*sizeof *g->place);
    g->way = malloc(m*sizeof *g->way);
    g->corner = malloc(m*sizeof *g->corner);
    g->kept = malloc(m);
    g->stack = malloc(2*m*sizeof *g->stack);
    if (!g->start || !g->link || !g->gone || !g->distance || !g->came_by || !g->heap || !g->reached ||
        !g->place || !g->way || !g->corner || !g->kept || !g->stack)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the edges of a blade");
    for (int64_t k = 0; k < r->count; k++) {
        g->gone[k] = r->ridge[k].width > width;
        g->start[r->ridge[k].from + 1]++;
        g->start[r->ridge[k].to + 1]++;
    }
    for (int64_t v = 0; v < r->vertex_count; v++) {
        g->start[v + 1] += g->start[v];
        g->distance[v] = INFINITY;
        g->place[v] = -1;
    }
    for (int64_t k = r->count - 1; k >= 0; k--) {        /* each list fills from its end */
        g->link[--g->start[r->ridge[k].from + 1]] = 2*k;
        g->link[--g->start[r->ridge[k].to + 1]] = 2*k + 1;
    }
    return TOBI_OK;
}

/* After the filling, the list of v begins at start[v + 1] and ends where that of v + 1 begins. */
static int64_t list_begin(const graph *g, int32_t v) { return g->start[v + 1]; }
static int64_t list_end(const graph *g, int32_t v)
{
    return v + 1 < g->ridges->vertex_count ? g->start[v + 2] : 2*g->ridges->count;
}

static int nearer(const graph *g, int32_t a, int32_t b)
{
    return g->distance[a] != g->distance[b] ? g->distance[a] < g->distance[b] : a < b;
}

static void put(graph *g, int64_t at, int32_t v)
{
    g->heap[at] = v;
    g->place[v] = at;
}

static void rise(graph *g, int64_t at, int32_t v)
{
    for (; at > 0 && nearer(g, v, g->heap[(at - 1)/2]); at = (at - 1)/2) put(g, at, g->heap[(at - 1)/2]);
    put(g, at, v);
}

static int32_t take_nearest(graph *g)
{
    int32_t top = g->heap[0], v = g->heap[--g->heap_count];
    int64_t at = 0, child;
    g->place[top] = -1;
    if (g->heap_count == 0) return top;
    for (; (child = 2*at + 1) < g->heap_count; at = child) {
        if (child + 1 < g->heap_count && nearer(g, g->heap[child + 1], g->heap[child])) child++;
        if (!nearer(g, g->heap[child], v)) break;
        put(g, at, g->heap[child]);
    }
    put(g, at, v);
    return top;
}

/* Distances along the ridges from a vertex; those below the tip count up to twice. Returns the
   vertex farthest away, the lowest of several. */
static int32_t search(graph *g, int32_t first)
{
    const tobi_ridges *r = g->ridges;
    int32_t farthest = first;
    for (int64_t k = 0; k < g->reached_count; k++) g->distance[g->reached[k]] = INFINITY;
    g->reached_count = g->heap_count = 0;
    g->distance[first] = 0;
    g->came_by[first] = -1;
    put(g, g->heap_count++, first);
    while (g->heap_count) {
        int32_t v = take_nearest(g);
        g->reached[g->reached_count++] = v;
        if (g->distance[v] > g->distance[farthest]) farthest = v;
        for (int64_t i = list_begin(g, v); i < list_end(g, v); i++) {
            int64_t k = g->link[i]/2;
            const tobi_ridge *ridge = &r->ridge[k];
            int32_t other = g->link[i] & 1 ? ridge->from : ridge->to;
            double blunt = ridge->width > 0 ? 10*ridge->low/ridge->width : 0;
            double d = g->distance[v] + ridge->length*(1 + blunt);
            if (g->gone[k] || d >= g->distance[other]) continue;
            g->distance[other] = d;
            g->came_by[other] = k;
            rise(g, g->place[other] >= 0 ? g->place[other] : g->heap_count++, other);
        }
    }
    return farthest;
}

/* The way of the last search back from v. */
static void trace(graph *g, int32_t v)
{
    g->way_count = 0;
    g->corner[0] = v;
    while (g->came_by[v] >= 0) {
        const tobi_ridge *ridge = &g->ridges->ridge[g->came_by[v]];
        g->way[g->way_count++] = g->came_by[v];
        v = ridge->from == v ? ridge->to : ridge->from;
        g->corner[g->way_count] = v;
    }
}

static double length_of_way(const graph *g)
{
    double sum = 0;
    for (int64_t k = 0; k < g->way_count; k++) sum += g->ridges->ridge[g->way[k]].length;
    return sum;
}

static double distance_to_piece(const double p[3], const double a[3], const double b[3])
{
    double d[3], e[3];
    vec3_sub(d, b, a);
    vec3_sub(e, p, a);
    double square = vec3_dot(d, d), share = square > 0 ? vec3_dot(e, d)/square : 0;
    vec3_add_scaled(e, e, -fmin(fmax(share, 0), 1), d);
    return vec3_length(e);
}

/* 1 if the chain comes back to its first corner: a place twice the width or less from it lies much
   farther along the chain. */
static int hooks(const graph *g)
{
    const double *end = g->ridges->vertex[g->corner[0]];
    double gone = 0;
    for (int64_t k = 0; k < g->way_count; k++) {
        double apart = distance_to_piece(end, g->ridges->vertex[g->corner[k]],
                                         g->ridges->vertex[g->corner[k + 1]]);
        if (k > 0 && apart <= 2*g->width && gone > 1.5*apart + g->width) return 1;
        gone += g->ridges->ridge[g->way[k]].length;
    }
    return 0;
}

static void turn_way(graph *g)
{
    for (int64_t i = 0, j = g->way_count; i < j; i++, j--) {
        int32_t corner = g->corner[i];
        g->corner[i] = g->corner[j];
        g->corner[j] = corner;
    }
    for (int64_t i = 0, j = g->way_count - 1; i < j; i++, j--) {
        int64_t way = g->way[i];
        g->way[i] = g->way[j];
        g->way[j] = way;
    }
}

static int leads_only(const tobi_ridge *r) { return vec3_dot(r->ahead, r->ahead) == 0; }

/* The farthest vertex may lie around the end of a strip of several ridges, and back: that is cut
   off. */
static void trim(graph *g)
{
    for (int side = 0; side < 2 && g->width > 0; side++) {
        while (g->way_count > 0 && (hooks(g) || leads_only(&g->ridges->ridge[g->way[0]]))) {
            g->way_count--;
            memmove(g->way, g->way + 1, (size_t)g->way_count*sizeof *g->way);
            memmove(g->corner, g->corner + 1, (size_t)(g->way_count + 1)*sizeof *g->corner);
        }
        turn_way(g);
    }
}

/* Takes the chain out of the graph, and all ridges that lie beside it within twice the width. */
static void clear_way(graph *g)
{
    const double reach = 2*g->width;
    for (int64_t k = 0; k < g->way_count; k++) g->gone[g->way[k]] = 1;
    for (int64_t i = 0; i < g->reached_count && g->width > 0; i++) {
        int32_t v = g->reached[i];
        const double *p = g->ridges->vertex[v];
        int beside = 0;
        for (int64_t k = 0; k < g->way_count && !beside; k++)
            beside = distance_to_piece(p, g->ridges->vertex[g->corner[k]],
                                       g->ridges->vertex[g->corner[k + 1]]) <= reach;
        for (int64_t j = list_begin(g, v); j < list_end(g, v) && beside; j++) g->gone[g->link[j]/2] = 1;
    }
}

/* Keeps as few corners of the chain as tell where it runs, within the tolerance (Douglas & Peucker
   1973). */
static void simplify(graph *g, double tolerance)
{
    int64_t depth = 0;
    memset(g->kept, 0, (size_t)g->way_count + 1);
    g->kept[0] = g->kept[g->way_count] = 1;
    g->stack[depth++] = 0;
    g->stack[depth++] = g->way_count;
    while (depth) {
        int64_t last = g->stack[--depth], first = g->stack[--depth], far = -1;
        double most = tolerance;
        for (int64_t k = first + 1; k < last; k++) {
            double d = distance_to_piece(g->ridges->vertex[g->corner[k]], g->ridges->vertex[g->corner[first]],
                                         g->ridges->vertex[g->corner[last]]);
            if (d > most) {
                most = d;
                far = k;
            }
        }
        if (far < 0) continue;
        g->kept[far] = 1;
        g->stack[depth++] = first;
        g->stack[depth++] = far;
        g->stack[depth++] = far;
        g->stack[depth++] = last;
    }
}

/* Across `along`, of length 1. */
static void straighten(double ahead[3], const double along[3])
{
    double square = vec3_dot(along, along);
    if (square > 0) vec3_add_scaled(ahead, ahead, -vec3_dot(ahead, along)/square, along);
    vec3_normalize(ahead);
}

/* The pieces of the chain run so that the sum of their normals has a positive largest component. */
static void turn_chain(tobi_edge *edge, int64_t n)
{
    double sum[3] = { 0 };
    for (int64_t i = 0; i < n; i++) {
        double along[3], normal[3];
        vec3_sub(along, edge[i].b, edge[i].a);
        vec3_cross(normal, along, edge[i].ahead);
        vec3_add_scaled(sum, sum, 1, normal);
    }
    int largest = 0;
    for (int a = 1; a < 3; a++)
        if (fabs(sum[a]) > 1.1*fabs(sum[largest])) largest = a;
    if (sum[largest] >= 0) return;
    for (int64_t i = 0; i < n/2; i++) {
        tobi_edge swap = edge[i];
        edge[i] = edge[n - 1 - i];
        edge[n - 1 - i] = swap;
    }
    for (int64_t i = 0; i < n; i++) {
        double swap[3];
        memcpy(swap, edge[i].a, sizeof swap);
        memcpy(edge[i].a, edge[i].b, sizeof swap);
        memcpy(edge[i].b, swap, sizeof swap);
    }
}

static tobi_status add_chain(const graph *g, tobi_sharp *out, tobi_error *err)
{
    int64_t first = out->count;
    tobi_edge *more = realloc(out->edge, (size_t)(out->count + g->way_count + 1)*sizeof *more);
    if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the edges of a blade");
    out->edge = more;
    for (int64_t k = 0, begin = 0; k < g->way_count; k++) {
        if (!g->kept[k + 1]) continue;
        tobi_edge *e = &out->edge[out->count];
        double along[3];
        int faces = 0;
        for (int64_t i = begin; i <= k; i++) faces |= !leads_only(&g->ridges->ridge[g->way[i]]);
        if (!faces) continue;                    /* becomes part of the next piece */
        out->count++;
        *e = (tobi_edge){ 0 };
        memcpy(e->a, g->ridges->vertex[g->corner[begin]], sizeof e->a);
        memcpy(e->b, g->ridges->vertex[g->corner[k + 1]], sizeof e->b);
        vec3_sub(along, e->b, e->a);
        for (; begin <= k; begin++) {
            const tobi_ridge *ridge = &g->ridges->ridge[g->way[begin]];
            vec3_add_scaled(e->ahead, e->ahead, ridge->length, ridge->ahead);
        }
        straighten(e->ahead, along);
    }
    turn_chain(out->edge + first, out->count - first);
    return TOBI_OK;
}

/* Chains shorter than `least` are dropped, also from the graph. */
static tobi_status take_chains(graph *g, double least, double tolerance, tobi_sharp *out, double *longest,
                               tobi_error *err)
{
    for (int64_t k = 0; k < g->ridges->count; k++) {
        while (!g->gone[k]) {
            int32_t end = search(g, g->ridges->ridge[k].from);
            end = search(g, end);
            trace(g, end);
            clear_way(g);
            trim(g);
            double length = length_of_way(g);
            *longest = fmax(*longest, length);
            if (g->way_count && length >= least && out) {
                simplify(g, tolerance);
                TOBI_TRY(add_chain(g, out, err));
            }
        }
    }
    return TOBI_OK;
}

tobi_status tobi_sharp_chains(const tobi_ridges *r, double width, double tolerance, tobi_sharp *out,
                              double *longest, tobi_error *err)
{
    graph g;
    *longest = 0;
    out->edge = NULL;
    out->count = 0;
    tobi_status status = make_graph(&g, r, width, err);
    if (status == TOBI_OK) status = take_chains(&g, 0, tolerance, NULL, longest, err);
    for (int64_t k = 0; k < r->count && status == TOBI_OK; k++) g.gone[k] = r->ridge[k].width > width;
    double again = 0;
    if (status == TOBI_OK) status = take_chains(&g, 0.2**longest, tolerance, out, &again, err);
    free_graph(&g);
    if (status == TOBI_OK) return TOBI_OK;
    free(out->edge);
    out->edge = NULL;
    return status;
}

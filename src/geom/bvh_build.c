/* Building the tree: binary splits by the binned surface area heuristic (Wald 2007), then every
   second level is folded away, so that a query tests four boxes at once. */
#include "geom/bvh_tree.h"
#include "geom/edges.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

enum { BINS = 16 };

typedef struct binary_node {
    double  box[6];
    int32_t left, right;             /* children, or first and count of a leaf when left < 0  */
    int32_t first, count;
} binary_node;

typedef struct builder {
    const double (*vertices)[3];
    const int32_t (*triangles)[3];
    double (*box)[6];                /* of each triangle                                      */
    int32_t *order;                  /* permuted in place                                     */
    binary_node *nodes;
    int32_t node_count;
} builder;

static void empty_box(double box[6])
{
    for (int k = 0; k < 3; k++) {
        box[k] = INFINITY;
        box[3 + k] = -INFINITY;
    }
}

static void join_boxes(double box[6], const double other[6])
{
    for (int k = 0; k < 3; k++) {
        if (other[k] < box[k]) box[k] = other[k];
        if (other[3 + k] > box[3 + k]) box[3 + k] = other[3 + k];
    }
}

static double measure_box(const double b[6])
{
    double x = b[3] - b[0], y = b[4] - b[1], z = b[5] - b[2];
    return x >= 0 ? x*y + y*z + z*x : 0;
}

/* Twice the middle of a triangle's box along an axis. */
static double middle(const double box[6], int axis) { return box[axis] + box[3 + axis]; }

static int find_bin(double m, double low, double scale)
{
    int bin = (int)((m - low)*scale);
    return bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin;
}

/* The cheapest of the splits of order[first, first + n) between bins of one axis. */
static double split_axis(const builder *b, int32_t first, int32_t n, int axis, double low, double scale,
                         int *best_bin)
{
    double box[BINS][6], right_cost[BINS], side[6], best = INFINITY;
    int32_t count[BINS] = {0}, seen = 0;
    for (int i = 0; i < BINS; i++) empty_box(box[i]);
    for (int32_t i = first; i < first + n; i++) {
        const double *t = b->box[b->order[i]];
        int bin = find_bin(middle(t, axis), low, scale);
        count[bin]++;
        join_boxes(box[bin], t);
    }
    empty_box(side);
    for (int i = BINS - 1; i > 0; i--) {
        join_boxes(side, box[i]);
        seen += count[i];
        right_cost[i] = seen ? measure_box(side)*seen : INFINITY;
    }
    empty_box(side);
    seen = 0;
    for (int i = 1; i < BINS; i++) {
        join_boxes(side, box[i - 1]);
        seen += count[i - 1];
        double cost = seen ? measure_box(side)*seen + right_cost[i] : INFINITY;
        if (cost < best) {
            best = cost;
            *best_bin = i;
        }
    }
    return best;
}

/* Orders order[first, first + n) and returns where its right half starts. */
static int32_t split_range(builder *b, int32_t first, int32_t n, int depth)
{
    double middles[6], best = INFINITY, low = 0, scale = 0;
    int axis = -1, bin = 0;
    empty_box(middles);
    for (int32_t i = first; i < first + n; i++)
        for (int k = 0; k < 3; k++) {
            double m = middle(b->box[b->order[i]], k);
            if (m < middles[k]) middles[k] = m;
            if (m > middles[3 + k]) middles[3 + k] = m;
        }
    for (int k = 0; k < 3 && depth < BVH_DEPTH; k++) {
        int found = 0;
        double width = middles[3 + k] - middles[k], s = BINS/width;
        if (!(width > 0) || !isfinite(s)) continue;
        double cost = split_axis(b, first, n, k, middles[k], s, &found);
        if (cost < best) {
            best = cost;
            axis = k;
            bin = found;
            low = middles[k];
            scale = s;
        }
    }
    if (axis < 0) return first + n/2;
    int32_t i = first, j = first + n - 1;
    while (i <= j) {
        if (find_bin(middle(b->box[b->order[i]], axis), low, scale) < bin) {
            i++;
        } else {
            int32_t swap = b->order[i];
            b->order[i] = b->order[j];
            b->order[j--] = swap;
        }
    }
    return i > first && i < first + n ? i : first + n/2;
}

static int32_t build_binary(builder *b, int32_t first, int32_t n, int depth)
{
    int32_t me = b->node_count++;
    binary_node *node = &b->nodes[me];
    *node = (binary_node){.left = -1, .right = -1, .first = first, .count = n};
    empty_box(node->box);
    for (int32_t i = first; i < first + n; i++) join_boxes(node->box, b->box[b->order[i]]);
    if (n <= BVH_LEAF) return me;
    int32_t right = split_range(b, first, n, depth);
    node->left = build_binary(b, first, right - first, depth + 1);
    node->right = build_binary(b, right, first + n - right, depth + 1);
    return me;
}

/* Writes the wide node for a binary one and, recursively, its children. */
static int32_t widen_node(tobi_bvh *bvh, const builder *b, int32_t source)
{
    int32_t lanes[BVH_WIDTH] = {source}, used = 1, me = (int32_t)bvh->node_count++;
    while (used < BVH_WIDTH) {
        int widest = -1;
        double width = -1;
        for (int i = 0; i < used; i++) {
            const binary_node *node = &b->nodes[lanes[i]];
            if (node->left < 0 || !(measure_box(node->box) > width)) continue;
            width = measure_box(node->box);
            widest = i;
        }
        if (widest < 0) break;
        lanes[used++] = b->nodes[lanes[widest]].right;
        lanes[widest] = b->nodes[lanes[widest]].left;
    }
    for (int i = 0; i < BVH_WIDTH; i++) {
        int32_t child = -1, count = 0;
        if (i < used && b->nodes[lanes[i]].left < 0) {
            child = b->nodes[lanes[i]].first;
            count = b->nodes[lanes[i]].count;
        } else if (i < used) {
            child = widen_node(bvh, b, lanes[i]);
        }
        bvh->nodes[me].child[i] = child;
        bvh->nodes[me].count[i] = count;
    }
    return me;
}

static tobi_status build_tree(tobi_bvh *bvh, const double (*vertices)[3])
{
    int64_t n = bvh->triangle_count;
    builder b = {vertices, (const int32_t (*)[3])bvh->triangles, NULL, bvh->leaf_triangle, NULL, 0};
    b.box = malloc((size_t)n*sizeof *b.box);
    b.nodes = malloc((size_t)(2*n)*sizeof *b.nodes);
    tobi_status status = b.box && b.nodes ? TOBI_OK : TOBI_NO_MEMORY;
    if (status == TOBI_OK) {
        for (int64_t t = 0; t < n; t++) {
            empty_box(b.box[t]);
            for (int c = 0; c < 3; c++) {
                const double *x = vertices[bvh->triangles[t][c]];
                join_boxes(b.box[t], (const double[6]){x[0], x[1], x[2], x[0], x[1], x[2]});
            }
            b.order[t] = (int32_t)t;
        }
        build_binary(&b, 0, (int32_t)n, 0);
        widen_node(bvh, &b, 0);
    }
    free(b.box);
    free(b.nodes);
    return status;
}

static void list_corners(tobi_bvh *bvh)
{
    for (int64_t t = 0; t < bvh->triangle_count; t++)
        for (int k = 0; k < 3; k++) bvh->corner_start[bvh->triangles[t][k] + 2]++;
    for (int64_t v = 0; v < bvh->vertex_count; v++) bvh->corner_start[v + 2] += bvh->corner_start[v + 1];
    for (int64_t t = 0; t < bvh->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            bvh->corner_list[bvh->corner_start[bvh->triangles[t][k] + 1]++] = (int32_t)(3*t + k);
}

static int allocate_bvh(tobi_bvh *b)
{
    size_t n = (size_t)b->triangle_count, v = (size_t)b->vertex_count;
    b->nodes = aligned_alloc(128, n*sizeof *b->nodes);   /* every node has a leaf or two children */
    b->node_box = malloc(n*sizeof *b->node_box);
    b->corners = malloc(n*sizeof *b->corners);
    b->leaf_triangle = malloc(n*sizeof *b->leaf_triangle);
    b->triangles = malloc(n*sizeof *b->triangles);
    b->opposite = malloc(n*sizeof *b->opposite);
    b->corner_start = calloc(v + 2, sizeof *b->corner_start);
    b->corner_list = malloc(3*n*sizeof *b->corner_list);
    b->face_normal = malloc(n*sizeof *b->face_normal);
    b->edge_normal = malloc(n*sizeof *b->edge_normal);
    b->vertex_normal = malloc(v*sizeof *b->vertex_normal);
    b->corner_angle = malloc(n*sizeof *b->corner_angle);
    return b->nodes && b->node_box && b->corners && b->leaf_triangle && b->triangles && b->opposite &&
           b->corner_start && b->corner_list && b->face_normal && b->edge_normal && b->vertex_normal &&
           b->corner_angle;
}

int64_t tobi_bvh_bytes(const tobi_bvh *b)
{
    if (!b) return 0;
    const size_t node = sizeof *b->nodes + sizeof *b->node_box,
                 triangle = sizeof *b->corners + sizeof *b->leaf_triangle + sizeof *b->triangles +
                            sizeof *b->opposite + 3*sizeof *b->corner_list + sizeof *b->face_normal +
                            sizeof *b->edge_normal + sizeof *b->corner_angle,
                 vertex = sizeof *b->corner_start + sizeof *b->vertex_normal;
    return b->node_count*(int64_t)node + b->triangle_count*(int64_t)triangle +
           b->vertex_count*(int64_t)vertex;
}

void tobi_bvh_free(tobi_bvh *b)
{
    if (!b) return;
    free(b->nodes);
    free(b->node_box);
    free(b->corners);
    free(b->leaf_triangle);
    free(b->triangles);
    free(b->opposite);
    free(b->corner_start);
    free(b->corner_list);
    free(b->face_normal);
    free(b->edge_normal);
    free(b->vertex_normal);
    free(b->corner_angle);
    free(b);
}

tobi_status tobi_bvh_build(int64_t vertex_count, const double (*vertices)[3],
                           int64_t triangle_count, const int32_t (*triangles)[3],
                           tobi_bvh **out, tobi_error *err)
{
    *out = NULL;
    if (triangle_count <= 0 || triangle_count > INT32_MAX/3 || vertex_count <= 0)
        return tobi_fail(err, TOBI_INVALID, "a search tree over %lld triangles; allowed are 1 to %d",
                         (long long)triangle_count, INT32_MAX/3);
    tobi_bvh *bvh = calloc(1, sizeof *bvh);
    tobi_status status = TOBI_NO_MEMORY;
    if (bvh) {
        bvh->vertex_count = vertex_count;
        bvh->triangle_count = triangle_count;
        if (allocate_bvh(bvh)) {
            memcpy(bvh->triangles, triangles, (size_t)triangle_count*sizeof *triangles);
            status = tobi_edges_match(vertex_count, triangle_count, triangles, bvh->opposite, NULL);
        }
        if (status == TOBI_OK) status = build_tree(bvh, vertices);
    }
    if (status != TOBI_OK) {
        tobi_bvh_free(bvh);
        return tobi_fail(err, status, "no memory for a search tree over %lld triangles",
                         (long long)triangle_count);
    }
    list_corners(bvh);
    tobi_bvh_refit(bvh, vertices);
    *out = bvh;
    return TOBI_OK;
}

/* Edge matching by bucket: half-edges are filed under their lower vertex, each small bucket is
   sorted by the other vertex, equal neighbours are one edge. Linear in practice and deterministic. */
#include "geom/edges.h"
#include <stdlib.h>

typedef struct half_edge {
    int32_t other, index;
} half_edge;

static int compare_half_edges(const void *a, const void *b)
{
    const half_edge *p = a, *q = b;
    if (p->other != q->other) return p->other < q->other ? -1 : 1;
    return (p->index > q->index) - (p->index < q->index);
}

static void match_bucket(int32_t low, half_edge *bucket, int64_t n, int32_t *opposite,
                         tobi_edge_report *report)
{
    if (n > 1) qsort(bucket, (size_t)n, sizeof *bucket, compare_half_edges);
    for (int64_t i = 0, j; i < n; i = j) {
        for (j = i + 1; j < n && bucket[j].other == bucket[i].other; j++) {}
        if (j - i == 2) {
            opposite[bucket[i].index] = bucket[i + 1].index;
            opposite[bucket[i + 1].index] = bucket[i].index;
            continue;
        }
        for (int64_t k = i; k < j; k++)
            opposite[bucket[k].index] = j - i == 1 ? TOBI_EDGE_OPEN : TOBI_EDGE_NON_MANIFOLD;
        if (!report->open && !report->non_manifold) {
            report->ends[0] = low;
            report->ends[1] = bucket[i].other;
        }
        if (j - i == 1) report->open++;
        else report->non_manifold++;
    }
}

tobi_status tobi_edges_match(int64_t vertex_count, int64_t triangle_count,
                             const int32_t (*triangles)[3], int32_t (*opposite)[3],
                             tobi_edge_report *report)
{
    tobi_edge_report local = {0};
    int64_t n = 3*triangle_count;
    int64_t *start = calloc((size_t)vertex_count + 2, sizeof *start);
    half_edge *filed = malloc((size_t)(n + 1)*sizeof *filed);
    if (!start || !filed) {
        free(start);
        free(filed);
        return TOBI_NO_MEMORY;
    }
    for (int pass = 0; pass < 2; pass++) {
        for (int64_t t = 0; t < triangle_count; t++) {
            for (int k = 0; k < 3; k++) {
                int32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
                int32_t low = a < b ? a : b, high = a < b ? b : a;
                if (pass == 0) start[low + 2]++;
                else filed[start[low + 1]++] = (half_edge){high, (int32_t)(3*t + k)};
            }
        }
        if (pass == 0)
            for (int64_t v = 0; v < vertex_count; v++) start[v + 2] += start[v + 1];
    }
    for (int64_t v = 0; v < vertex_count; v++)
        match_bucket((int32_t)v, filed + start[v], start[v + 1] - start[v], &opposite[0][0], &local);
    free(start);
    free(filed);
    if (report) *report = local;
    return TOBI_OK;
}

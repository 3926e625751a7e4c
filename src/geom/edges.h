/* Which triangles meet at which edge. Half-edge 3 t + k is the edge from corner k to corner
   (k + 1) mod 3 of triangle t. */
#pragma once
#include "base/error.h"

enum { TOBI_EDGE_OPEN = -1, TOBI_EDGE_NON_MANIFOLD = -2 };

typedef struct tobi_edge_report {
    int64_t open, non_manifold;   /* edges with one triangle; with more than two                 */
    int32_t ends[2];              /* vertices of one faulty edge, the first found                */
} tobi_edge_report;

/* Fills opposite[t][k] with the other half-edge of the same edge, whichever way it runs, or
   TOBI_EDGE_OPEN / TOBI_EDGE_NON_MANIFOLD. Returns TOBI_OK or TOBI_NO_MEMORY; report may be NULL. */
tobi_status tobi_edges_match(int64_t vertex_count, int64_t triangle_count,
                             const int32_t (*triangles)[3], int32_t (*opposite)[3],
                             tobi_edge_report *report);

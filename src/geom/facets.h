/* Where a closed surface can touch another: its corners, its convex edges and its faces, and whether it is
   meant to be a ball. Coordinates are those of the tree the facets are made from. */
#pragma once
#include "geom/bvh.h"

typedef struct tobi_facets {
    const tobi_bvh *bvh;             /* borrowed, as are the next five                                  */
    const double (*vertex)[3];
    const int32_t (*triangle)[3];
    const double (*normal)[3];       /* unit, of the triangles; 0 for one without area                  */
    const int32_t (*opposite)[3];    /* see edges.h                                                     */
    int64_t vertex_count, triangle_count;
    int64_t *ring_start;             /* [vertices + 1] offsets into ring                                */
    int32_t *ring;                   /* the vertices that share an edge with a vertex                   */
    uint8_t *owned;                  /* per triangle, bit k: corner k, bit 3 + k: the edge from corner k
                                        is this triangle's to look at; flat places are nobody's         */
    int32_t *corner;                 /* the vertices that are somebody's                                */
    int64_t corner_count;
    double reach;                    /* m, of the farthest vertex from the origin                       */
    double ball;                     /* m, radius if the surface stands for a sphere about the origin, or 0 */
    double ball_gap;                 /* m, how far its faces lie below that sphere at most              */
    int convex;
    int flat;                        /* a prism along z that stands for its section: its ends are nothing */
} tobi_facets;

/* The tree and the arrays must outlive the facets. flat: 1 if the surface is a prism along z that stands for
   its section (2-D). Errors: TOBI_NO_MEMORY. */
tobi_status tobi_facets_build(tobi_facets *f, const tobi_bvh *bvh, const double (*vertex)[3], int flat,
                              tobi_error *err);
/* Corners and edges of a surface that has moved: the tree was refitted to other places of the vertices. Of
   such a surface reach and ball are the caller's. */
void tobi_facets_follow(tobi_facets *f);
void tobi_facets_free(tobi_facets *f);

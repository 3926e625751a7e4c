/* The tree itself, shared by building and querying. */
#pragma once
#include "geom/bvh.h"

enum { BVH_WIDTH = 4, BVH_LEAF = 2, BVH_STACK = 256, BVH_DEPTH = 40 };

/* Four children, their boxes as centre and half width in float relative to the tree's origin,
   widened so that rounding never loses a triangle. count 0: child is a node; else: child is the
   first of count leaf triangles. An unused lane has half width -infinity. Children come after their
   parent. 128 bytes. */
typedef struct bvh_node {
    float   centre[3][BVH_WIDTH], half[3][BVH_WIDTH];
    int32_t child[BVH_WIDTH], count[BVH_WIDTH];
} bvh_node;

typedef struct bvh_corners {
    double a[3], b[3], c[3];
} bvh_corners;

struct tobi_bvh {
    int64_t vertex_count, triangle_count, node_count;
    int     by_winding;              /* see tobi_bvh_use_winding                             */
    double  origin[3];               /* middle of the box                                    */
    double  min[3], max[3];          /* m, around all triangles                              */
    bvh_node *nodes;
    double  (*node_box)[6];          /* min and max of each node, for refitting              */
    bvh_corners *corners;            /* in leaf order                                        */
    int32_t *leaf_triangle;          /* triangle of each leaf slot                           */
    int32_t (*triangles)[3];
    int32_t (*opposite)[3];          /* see edges.h                                          */
    int64_t *corner_start;           /* per vertex, offsets into corner_list                 */
    int32_t *corner_list;            /* 3 t + k of the corners at each vertex                */
    double  (*face_normal)[3];       /* unit; 0 for a triangle without area                  */
    double  (*edge_normal)[3][3];    /* unit, of the edge from corner k                      */
    double  (*vertex_normal)[3];     /* unit, angle-weighted                                 */
    double  (*corner_angle)[3];
};

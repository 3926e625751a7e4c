/* Closest point, inside test and crossing test against a closed triangle surface.

   A tree of boxes built once by the surface area heuristic and refitted when the vertices move.
   Queries are const, allocate nothing, may run from many threads, and give the same answer whatever
   the thread; among features equally near the first in tree order wins. */
#pragma once
#include "base/error.h"

typedef struct tobi_bvh tobi_bvh;

typedef struct tobi_bvh_hit {
    double  distance;          /* m, >= 0                                                       */
    double  signed_distance;   /* m, negative inside                                            */
    double  point[3];          /* m, the nearest point of the surface                           */
    double  normal[3];         /* outward unit pseudonormal of the nearest feature              */
    double  barycentric[3];    /* of point in its triangle, sum 1                               */
    int32_t triangle;
    int32_t slot;              /* of the triangle in the tree                                   */
} tobi_bvh_hit;

/* Builds over triangles that tobi_mesh_orient has passed (an open mesh works, but its sign means
   little at the open edges). The triangles are copied; vertices are read now and at each refit. */
tobi_status tobi_bvh_build(int64_t vertex_count, const double (*vertices)[3],
                           int64_t triangle_count, const int32_t (*triangles)[3],
                           tobi_bvh **out, tobi_error *err);
void tobi_bvh_free(tobi_bvh *bvh);
/* Bytes that it takes; 0 of NULL. */
int64_t tobi_bvh_bytes(const tobi_bvh *bvh);

/* Takes new positions of the same vertices. The boxes and pseudonormals follow; the shape of the
   tree stays, so queries slow down when the shape changes beyond recognition, but stay right. */
void tobi_bvh_refit(tobi_bvh *bvh, const double (*vertices)[3]);

/* The box around all triangles, m. */
void tobi_bvh_box(const tobi_bvh *bvh, double min[3], double max[3]);

/* The nearest point of the surface closer than max_distance (INFINITY = anywhere): 1 and fills hit,
   or 0 and leaves it alone. The sign is that of the angle-weighted pseudonormal of the nearest
   vertex, edge or face (Baerentzen & Aanaes, IEEE TVCG 11 (2005)). */
int tobi_bvh_closest(const tobi_bvh *bvh, const double p[3], double max_distance, tobi_bvh_hit *hit);
/* The same; *others: no other triangle is nearer than that, m, max_distance at most. */
int tobi_bvh_closest_two(const tobi_bvh *bvh, const double p[3], double max_distance, tobi_bvh_hit *hit,
                         double *others);
/* The same hit for who knows that hit->triangle is nearest, and no other as near: from hit->slot. */
void tobi_bvh_closest_again(const tobi_bvh *bvh, const double p[3], tobi_bvh_hit *hit);

/* 1 if p is inside. */
int tobi_bvh_inside(const tobi_bvh *bvh, const double p[3]);

/* How often the surface winds around p: 1 inside, 0 outside, 2 where two solids overlap. Exact for a
   closed mesh. */
int tobi_bvh_winding(const tobi_bvh *bvh, const double p[3]);
/* From now on inside, also for the sign of tobi_bvh_closest, is where the winding number is above 0: for
   meshes that overlap themselves, where the nearest feature may lie within the solid. */
void tobi_bvh_use_winding(tobi_bvh *bvh);

/* Calls visit for every triangle that the line from p along +z meets; turn is +1 where the line enters,
   -1 where it leaves. */
typedef void tobi_bvh_crossing_fn(void *user, int32_t triangle, int turn);
void tobi_bvh_look_up(const tobi_bvh *bvh, const double p[3], tobi_bvh_crossing_fn *visit, void *user);

/* 1 if a triangle lies strictly between a and b: touching with an end, or running within the plane
   of a triangle, is no hit. Neighbouring triangles decide about their common edge with the same
   arithmetic, so nothing slips through an edge. */
int tobi_bvh_segment_hits(const tobi_bvh *bvh, const double a[3], const double b[3]);
/* 1 if the segment from a to b goes through the surface, not just past an edge: the normals of a face that
   it enters by and of one that it leaves by have a cosine below `cosine`. If an end lies on the surface or
   behind it, the unit normal there counts for the face that is missing. */
int tobi_bvh_segment_passes(const tobi_bvh *bvh, const double a[3], const double b[3],
                            const double normal_a[3], const double normal_b[3], double cosine);

/* 1 if a corner of a triangle lies more than `height` (m) above the plane through p across the unit vector
   normal. */
int tobi_bvh_rises_above(const tobi_bvh *bvh, const double p[3], const double normal[3], double height);

/* Calls visit for every triangle that may touch the box from lower to upper (m), in tree order; some that
   only come near it, too. */
typedef void tobi_bvh_visit_fn(void *user, int32_t triangle);
void tobi_bvh_touching(const tobi_bvh *bvh, const double lower[3], const double upper[3],
                       tobi_bvh_visit_fn *visit, void *user);

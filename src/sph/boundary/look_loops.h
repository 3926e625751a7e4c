/* The loops of a particle's look at the points of a body, compiled once per instruction set (isa_look.c). */
#pragma once
#include "core/body.h"
#include "core/smoothing.h"
#include "exec/portable.h"
#include "sph/boundary/points.h"
#include "sph/boundary/couple.k.h"

/* What the sums read besides the points: of the body and of the particle. */
typedef struct tobi_look_view {
    const tobi_body *body;
    const tobi_smoothing_constants *smoothing;
    double gravity[3];        /* m/s2, what the particle feels                                    */
    int alone;                /* 1: no other thread looks at the body                             */
} tobi_look_view;

enum { TOBI_HIDING_MOST = 8 };

/* What may hide neighbours from a particle, in float. */
typedef struct tobi_hiding {
    const tobi_record *record;
    const float *from_fixed;  /* m per unit of the records                                        */
    const float *body_distance;      /* m, of each particle                                       */
    float h;                  /* m                                                                */
    int bodies;               /* that the particle sees                                           */
    float distance[TOBI_HIDING_MOST];           /* m, from each                                   */
    float offset[TOBI_HIDING_MOST][3];          /* m, from its nearest point                      */
    float least[TOBI_HIDING_MOST];   /* m2: what is more along the offset is surely not hidden by it */
} tobi_hiding;

typedef struct tobi_look_loops {
    /* Adds those of points [begin, end) to the list that face x and are nearer than the root of reach2. */
    void (*list)(double *const row[TOBI_POINT_ROWS], int64_t begin, int64_t end, const double x[3],
                 double reach2, tobi_facing_points *list);
    /* Whether there is any. */
    int (*any)(double *const row[TOBI_POINT_ROWS], int64_t begin, int64_t end, const double x[3],
               double reach2);
    /* Adds those of the places [begin, end) to the list that x faces, by its normal, and that are nearer: the
       other way round. deep: 0 in 2-D. Reads up to three places beyond the end. */
    void (*list_places)(const tobi_double3 *place, int64_t begin, int64_t end, const double x[3],
                        const double normal[3], int deep, double reach2, tobi_facing_points *list);
    /* Adds the listed points, by their weights, to link and entry, and marks them as wet and covered. */
    void (*sum)(const tobi_look_view *v, const tobi_facing_points *list, tobi_boundary_link *link,
                tobi_boundary_entry *entry);
    /* Bit k: a body may lie between i and j[k]; a bit too many does no harm. */
    unsigned (*may_hide)(const tobi_hiding *v, int32_t i, const int32_t j[8]);
} tobi_look_loops;

extern const tobi_look_loops tobi_look_loops_v2, tobi_look_loops_v3, tobi_look_loops_v4;

/* How much of a point counts, by the particle's height above its plane and its distance from the body, m. A
   particle beyond an edge would see the next face at once when it passes the plane of that face. */
static inline double tobi_boundary_rise(double height, double distance, double spacing)
{
    const double width = distance < 0.25*spacing ? distance : 0.25*spacing;
    return height < width ? height/width : 1;
}

/* Quadrature points of bodies by cells of width h over their boxes. */
#pragma once
#include "core/body.h"
#include "core/smoothing.h"

/* What loops over the points near a particle read, side by side. */
typedef struct tobi_boundary_point {
    double at[3], normal[3];  /* m from the lower corner of the box; outward                      */
    double area;              /* m2                                                               */
    int32_t number;           /* of the body's points                                             */
    int32_t outermost;        /* of a rigid body: see tobi_body                                   */
} tobi_boundary_point;

/* Rows of the same points side by side, for the search: x, y, z, then the normal, 0 without an area. */
enum { TOBI_POINT_ROWS = 6 };

/* The cells of one body. */
typedef struct tobi_boundary_bins {
    int n[3];
    double lower[3], upper[3];    /* m, the body's box; in 2-D around its plane                    */
    double orientation[4];    /* of the body when its points were put here                        */
    int64_t start, item;      /* where its own begin in bin_start, point                          */
} tobi_boundary_bins;

/* Points that follow one another. */
typedef struct tobi_point_run { const tobi_boundary_point *begin, *end; } tobi_point_run;
enum { TOBI_POINT_RUNS = 9 };

struct tobi_boundary_links;

/* The points in the bins around x, m from the lower corner of the box; returns how many runs. */
int tobi_boundary_runs(const struct tobi_boundary_links *links, int64_t body, const double x[3],
                       tobi_point_run run[TOBI_POINT_RUNS]);
/* Points of a body that face a place within reach: so many at a time, the rest follow. */
enum { TOBI_FACING_MOST = 128 };
typedef struct tobi_facing_points {
    int count;
    const tobi_boundary_point *all;
    int32_t index[TOBI_FACING_MOST + 4];       /* of each in `all`; lists may write four beyond their end */
    double square[TOBI_FACING_MOST + 4];       /* m2, the distance to each                         */
    double height[TOBI_FACING_MOST + 4];       /* m, above its tangent plane                       */
    double weight[TOBI_FACING_MOST];  /* W there: tobi_facing_weigh                                */
} tobi_facing_points;

static inline const tobi_boundary_point *tobi_facing_point(const tobi_facing_points *q, int k)
{
    return &q->all[q->index[k]];
}

/* Calls take with the points that have an area, face x, m from the lower corner of the box, and are nearer
   than reach, m, in the order of their bins. */
void tobi_boundary_take_facing(const struct tobi_boundary_links *links, int64_t body, const double x[3],
                               double reach, void (*take)(void *user, tobi_facing_points *list),
                               void *user);
void tobi_facing_weigh(tobi_facing_points *list, const tobi_smoothing_constants *c);
/* The points in the bin of x, or in the nearest one. */
tobi_point_run tobi_boundary_nearest_run(const struct tobi_boundary_links *links, int64_t body,
                                         const double x[3]);

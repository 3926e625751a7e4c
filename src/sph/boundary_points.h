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

/* The cells of one body. */
typedef struct tobi_boundary_bins {
    int n[3];
    double lower[3];          /* m                                                                */
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
    const tobi_boundary_point *point[TOBI_FACING_MOST];
    double square[TOBI_FACING_MOST];  /* m2, the distance to each                                  */
    double height[TOBI_FACING_MOST];  /* m, above its tangent plane                                */
    double weight[TOBI_FACING_MOST];  /* W there: tobi_facing_weigh                                */
} tobi_facing_points;

/* Calls take with the points that have an area, face x, m from the lower corner of the box, and are nearer
   than reach, m, in the order of their bins. */
void tobi_boundary_take_facing(const struct tobi_boundary_links *links, int64_t body, const double x[3],
                               double reach, void (*take)(void *user, tobi_facing_points *list),
                               void *user);
void tobi_facing_weigh(tobi_facing_points *list, const tobi_smoothing_constants *c);
/* The points in the bin of x, or in the nearest one. */
tobi_point_run tobi_boundary_nearest_run(const struct tobi_boundary_links *links, int64_t body,
                                         const double x[3]);

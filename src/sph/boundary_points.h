/* Quadrature points of bodies by cells of width h over their boxes. */
#pragma once
#include "core/body.h"

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
/* The points in the bin of x, or in the nearest one. */
tobi_point_run tobi_boundary_nearest_run(const struct tobi_boundary_links *links, int64_t body,
                                         const double x[3]);

/* A grid over unknowns that are points in cells: what the kernels of the multigrid read and write. */
#pragma once
#include "exec/portable.h"

/* Points sorted by cell, x fastest, rows as in exec/strips.h. Positions are measured from the lower corner
   of the cells and lie inside them. */
typedef struct tobi_cell_points {
    int dimension;
    int n[3], strip, periodic[3];    /* cells per axis                                              */
    double inverse[3];               /* cells per metre                                             */
    const int32_t *start;            /* first point of each cell                                    */
    const tobi_double3 *position;    /* m                                                           */
    int64_t count;
} tobi_cell_points;

/* Nodes x + n[0] (y + n[1] z) with the seven-point finite-volume stencil. */
typedef struct tobi_grid_level {
    int n[3];
    float *value, *source;           /* u and f of B u = f                                          */
    float *next;                     /* the value that a sweep of Jacobi makes                      */
    int odd;                         /* 1: it wraps over an odd number of nodes                     */
    float *face[3];                  /* weight between a node and the next along each axis          */
    float *inverse;                  /* 1/diagonal, 0 where nothing is to be solved                 */
} tobi_grid_level;

/* Values at nodes, to be read between them (linear/value.k.h). */
typedef struct tobi_grid_values {
    const float *value;              /* NULL: there are none                                        */
    double per_metre[3];             /* cells per metre                                             */
    int n[3], dimension;             /* nodes                                                       */
} tobi_grid_values;

/* What the kernels of the multigrid and of its points see. */
#pragma once
#include "linear/grid.h"

/* What a point adds to the corners of its cell. */
enum { TOBI_SHARE_ONE, TOBI_SHARE_FLOAT, TOBI_SHARE_DOUBLE, TOBI_SHARE_BYTE };

typedef struct tobi_grid_view {
    tobi_grid_level g, other;        /* the level at hand; the finer or coarser one                 */
    int colour;                      /* of the nodes swept                                          */
    int axis;                        /* of the faces at hand                                        */
    float full;                      /* points per node where they lie densely                      */
    float face;                      /* weight of a face there                                      */
    float scale;
    /* points */
    tobi_cell_points points;
    int wide, cells[3];
    double per_metre[3];
    float (*corner)[8];
    int share;                       /* TOBI_SHARE_*: value, times factor                           */
    const void *value;
    const float *active;             /* only points where > 0; NULL: all                            */
    double factor;                   /* of doubles                                                  */
    float *out;                      /* at nodes                                                    */
    /* sweeps on points */
    tobi_grid_values coarse;
    const double *inverse, *r;
    double *z, *t;
    double damping;
} tobi_grid_view;

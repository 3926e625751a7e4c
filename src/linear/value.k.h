/* The value of a grid between its nodes. */
#pragma once
#include "linear/grid.h"

/* Linear between the corners of the cell of x; positions as in tobi_cell_points. */
TOBI_FN float tobi_grid_value(const tobi_grid_values *g, const double *x)
{
    int64_t node = 0, up[3], stride = 1;
    float w[3], sum = 0;
    for (int a = 0; a < g->dimension; a++) {
        double at = x[a]*g->per_metre[a];
        int k = (int)at;
        w[a] = (float)(at - k);
        node += k*stride;
        up[a] = k + 1 < g->n[a] ? stride : -k*stride;
        stride *= g->n[a];
    }
    for (int z = 0; z < g->dimension - 1; z++)
        for (int y = 0; y < 2; y++) {
            const float *p = g->value + node + y*up[1] + (z ? up[2] : 0);
            float share = y ? w[1] : 1 - w[1];
            if (g->dimension == 3) share *= z ? w[2] : 1 - w[2];
            sum += share*(p[0] + w[0]*(p[up[0]] - p[0]));
        }
    return sum;
}

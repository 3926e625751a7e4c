/* Smoothing kernels on lanes. A kernel is split into a shape and two constants:
     V W(r)       = weight * shape(q),        q = r/h, zero for q >= 1
     V grad_i W   = -slope * falloff(q) * (x_i - x_j)
   with weight and slope normalised on the particle lattice (core/smoothing.c). */
#pragma once
#include "exec/portable.h"

enum { TOBI_SHAPE_WENDLAND, TOBI_SHAPE_CUBIC };

/* Wendland C2 (Wendland 1995): (1-q)^4 (1+4q).
   Cubic spline (Monaghan 1992) with support h: 2(1-q)^3 - 8(1/2-q)^3, each term where positive. */
TOBI_FN lane smoothing_shape(const int shape, lane q)
{
    lane t = lane_positive(1.0f - q);
    if (shape == TOBI_SHAPE_WENDLAND) {
        lane t2 = t*t;
        return t2*t2*(4.0f*q + 1.0f);
    }
    lane u = lane_positive(0.5f - q);
    return 2.0f*t*t*t - 8.0f*u*u*u;
}

/* falloff(q) of the gradient; r = h q. */
TOBI_FN lane smoothing_falloff(const int shape, lane q, lane r)
{
    lane t = lane_positive(1.0f - q);
    if (shape == TOBI_SHAPE_WENDLAND) return t*t*t;
    lane u = lane_positive(0.5f - q);
    return (t*t - 4.0f*u*u)/(r + 1e-20f);
}

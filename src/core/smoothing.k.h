/* Smoothing kernels on lanes. A kernel is split into a shape and two constants:
     V W(r)       = weight * shape(q),        q = r/h, zero for q >= 1
     V grad_i W   = -slope * falloff(q) * (x_i - x_j)
   with weight and slope normalised on the particle lattice (core/smoothing.c). */
#pragma once
#include "exec/portable.h"

enum { TOBI_SHAPE_WENDLAND, TOBI_SHAPE_CUBIC, TOBI_SHAPE_QUARTIC, TOBI_SHAPE_QUINTIC, TOBI_SHAPE_WENDLAND_C4,
       TOBI_SHAPE_WENDLAND_C6, TOBI_SHAPES };

/* Wendland C2 (Wendland 1995): (1-q)^4 (1+4q).
   Cubic spline (Monaghan 1992) with support h: 2(1-q)^3 - 8(1/2-q)^3, each term where positive.
   Quartic, quintic (Schoenberg 1946): (1-q)^4 - 5(3/5-q)^4 + 10(1/5-q)^4, over its value at 0, 46/125;
   (1-q)^5 - 6(2/3-q)^5 + 15(1/3-q)^5, over 22/81, each term where positive.
   Wendland C4, C6: (1-q)^6 (1+6q+35/3 q^2), (1-q)^8 (1+8q+25q^2+32q^3).
   All are 1 at 0, what a particle adds to its own sums. */
TOBI_FN lane smoothing_shape(const int shape, lane q)
{
    lane t = lane_positive(1.0f - q), t2 = t*t, u, w;
    switch (shape) {
    case TOBI_SHAPE_WENDLAND:
        return t2*t2*(4.0f*q + 1.0f);
    case TOBI_SHAPE_CUBIC:
        u = lane_positive(0.5f - q);
        return 2.0f*t*t*t - 8.0f*u*u*u;
    case TOBI_SHAPE_QUARTIC:
        u = lane_positive(0.6f - q);
        w = lane_positive(0.2f - q);
        return 125/46.0f*(t2*t2 - 5.0f*(u*u)*(u*u) + 10.0f*(w*w)*(w*w));
    case TOBI_SHAPE_QUINTIC:
        u = lane_positive(2/3.0f - q);
        w = lane_positive(1/3.0f - q);
        return 81/22.0f*(t2*t2*t - 6.0f*(u*u)*(u*u)*u + 15.0f*(w*w)*(w*w)*w);
    case TOBI_SHAPE_WENDLAND_C4:
        return t2*t2*t2*((35/3.0f*q + 6.0f)*q + 1.0f);
    default:
        return (t2*t2)*(t2*t2)*(((32.0f*q + 25.0f)*q + 8.0f)*q + 1.0f);
    }
}

/* a/r, and 0 for a particle itself, where a has a rounding error. */
TOBI_FN lane smoothing_over(lane a, lane q, lane r)
{
    return lane_where_less(q, lane_set(1e-3f), lane_set(0), a)/(r + 1e-20f);
}

/* falloff(q) of the gradient; r = h q. */
TOBI_FN lane smoothing_falloff(const int shape, lane q, lane r)
{
    lane t = lane_positive(1.0f - q), t2 = t*t, u, w;
    switch (shape) {
    case TOBI_SHAPE_WENDLAND:
        return t*t*t;
    case TOBI_SHAPE_CUBIC:
        u = lane_positive(0.5f - q);
        return (t*t - 4.0f*u*u)/(r + 1e-20f);
    case TOBI_SHAPE_QUARTIC:
        u = lane_positive(0.6f - q);
        w = lane_positive(0.2f - q);
        return smoothing_over(t2*t - 5.0f*u*u*u + 10.0f*w*w*w, q, r);
    case TOBI_SHAPE_QUINTIC:
        u = lane_positive(2/3.0f - q);
        w = lane_positive(1/3.0f - q);
        return smoothing_over(t2*t2 - 6.0f*(u*u)*(u*u) + 15.0f*(w*w)*(w*w), q, r);
    case TOBI_SHAPE_WENDLAND_C4:
        return t2*t2*t*(5.0f*q + 1.0f);
    default:
        return t2*t2*t2*t*((16.0f*q + 7.0f)*q + 1.0f);
    }
}

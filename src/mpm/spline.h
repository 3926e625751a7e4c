/* Weights of quadratic B-splines for one place and axis, eq. (2) of docs/theory/mlsmpm.md; the transfers have
   them eight at a time in particle.k.h. */
#pragma once
#include <math.h>
#include <stdint.h>

/* At x cells from its node. */
static inline double mpm_spline_at(double x)
{
    const double far = fabs(x);
    return far < 0.5 ? 0.75 - far*far : far < 1.5 ? 0.5*(1.5 - far)*(1.5 - far) : 0;
}

/* x: in cells. Returns the lowest of the three nodes. */
static inline int64_t mpm_spline(double x, double w[3])
{
    const int64_t low = (int64_t)(x - 0.5);        /* towards 0; floor is a call on plain x86-64 */
    const double base = (double)(low - ((double)low > x - 0.5)), f = x - base;
    w[0] = 0.5*(1.5 - f)*(1.5 - f);
    w[1] = 0.75 - (f - 1)*(f - 1);
    w[2] = 0.5*(f - 0.5)*(f - 0.5);
    return (int64_t)base;
}

/* Weights of the particles around a place: (1 - (r/h)^2)^2 within h = 2 spacings. */
#pragma once

/* r2, h2: squares, r below h. */
static inline double view_weight(double r2, double h2)
{
    const double one = 1 - r2/h2;
    return one*one;
}

/* Their sum in full liquid: the integral over the spacing to the power of the dimension. */
static inline double view_full_weight(int dimension) { return dimension == 2 ? 4.189 : 7.660; }

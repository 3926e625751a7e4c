/* The kernel of isph for time: the first half of the way in a step of second order. */
#pragma once
#include "sph/isph/isph.k.h"

/* Of the spacing: how near particles come to sides, as in sph_advance. */
#define ISPH_SIDE_LEAST 0.2

/* x += way v, eq. (1b). */
TOBI_FN void isph_drift(const isph_view *v, int64_t i, double *totals)
{
    (void)totals;
    for (int a = 0; a < v->dimension; a++) {
        const double least = ISPH_SIDE_LEAST*v->spacing;
        double x = (&v->position[i].x)[a] + v->way*(double)(&v->velocity[i].x)[a];
        if (!v->periodic[a]) x = isph_clamp(x, least, v->size[a] - least);
        (&v->position[i].x)[a] = x;
    }
}

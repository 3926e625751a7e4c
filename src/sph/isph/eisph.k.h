/* Sweeps of the pressure equation, eq. (E.2) to (E.5) of docs/theory/eisph.md. Vectors are those of a solve:
   source holds the residual, in and out the old and the new change of the pressure. */
#pragma once
#include "sph/isph/isph.k.h"

/* Along gravity, from a plane below all: totals[6] of the lowest, totals[7] of the highest particle. */
TOBI_FN void eisph_extent(const isph_view *v, int64_t i, double *totals)
{
    double along = 0, reach = 0, size = 0;
    for (int a = 0; a < v->dimension; a++) {
        along += (&v->position[i].x)[a]*v->gravity[a];
        reach += v->size[a]*v->size[a];
        size += (double)v->gravity[a]*v->gravity[a];
    }
    if (!(size > 0)) return;
    along /= sqrt(size);
    totals[6] = isph_larger(totals[6], sqrt(reach) + along);
    totals[7] = isph_larger(totals[7], sqrt(reach) - along);
}

/* out: the product with the pressure. totals: the residual, the square of the source. */
TOBI_FN void eisph_residual(const isph_view *v, int64_t i, double *totals)
{
    const double source = v->source[i];
    v->source[i] = source - v->out[i];
    totals[0] += v->source[i];
    totals[1] += source*source;
}

/* A change of gain r/D. totals: the square of the residual. */
TOBI_FN void eisph_begin(const isph_view *v, int64_t i, double *totals)
{
    const double r = v->source[i] - v->mean, change = v->gain*r*v->inverse_diagonal[i];
    v->source[i] = r;
    v->out[i] = change;
    v->solution[i] += change;
    totals[0] += r*r;
}

/* A change of carry times the last and gain r/D. */
TOBI_FN void eisph_sweep(const isph_view *v, int64_t i, double *totals)
{
    const double r = v->source[i] - v->out[i],
                 change = v->carry*v->in[i] + v->gain*r*v->inverse_diagonal[i];
    v->source[i] = r;
    v->out[i] = change;
    v->solution[i] += change;
    totals[0] += r*r;
}

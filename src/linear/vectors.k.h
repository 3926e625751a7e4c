/* Kernels on vectors of doubles. y may be x. */
#pragma once
#include "exec/portable.h"

typedef struct tobi_vectors_view {
    double *y;
    const double *x;
    double a;
} tobi_vectors_view;

/* totals[0]: x . y. */
TOBI_FN void vector_dot(const tobi_vectors_view *v, int64_t i, double *totals)
{
    totals[0] += v->x[i]*v->y[i];
}
/* totals[0]: sum of y. */
TOBI_FN void vector_sum(const tobi_vectors_view *v, int64_t i, double *totals)
{
    totals[0] += v->y[i];
}
/* y = a x. */
TOBI_FN void vector_scale(const tobi_vectors_view *v, int64_t i, double *totals)
{
    (void)totals;
    v->y[i] = v->a*v->x[i];
}
/* y += a x; totals[0]: y . y. */
TOBI_FN void vector_add(const tobi_vectors_view *v, int64_t i, double *totals)
{
    const double y = v->y[i] + v->a*v->x[i];
    v->y[i] = y;
    totals[0] += y*y;
}
/* y = x + a y; totals[0]: y . y. */
TOBI_FN void vector_blend(const tobi_vectors_view *v, int64_t i, double *totals)
{
    const double y = v->x[i] + v->a*v->y[i];
    v->y[i] = y;
    totals[0] += y*y;
}
/* y -= a. */
TOBI_FN void vector_shift(const tobi_vectors_view *v, int64_t i, double *totals)
{
    (void)totals;
    v->y[i] -= v->a;
}

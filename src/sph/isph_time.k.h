/* Kernels of isph for time: the first half of the way in a step of second order, and the invariant of the
   velocity's gradient that the divergence makes up for. Rows that see soft solids go without. */
#pragma once
#include "sph/isph.k.h"

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

/* tr (grad v grad v), 1/s2, eq. (6b). */
typedef struct isph_invariant_acc { lane ux, uy, uz, slope[9]; } isph_invariant_acc;

TOBI_FN void isph_invariant_start(const isph_view *v, int64_t i, isph_invariant_acc *a)
{
    const tobi_float4 u = v->velocity[i];
    a->ux = lane_set(u.x); a->uy = lane_set(u.y); a->uz = lane_set(u.z);
    for (int k = 0; k < 9; k++) a->slope[k] = lane_set(0);
}

TOBI_FN void isph_invariant_pair(const isph_view *v, int64_t i, const tobi_neighbors *n, const isph_image *m,
                                 isph_invariant_acc *a, const int shape, const int kind)
{
    const lane f = isph_falloff(v, n, m, shape, kind), x[3] = {n->dx, n->dy, n->dz};
    lane u[3];
    (void)i;
    isph_velocity(v, n, m, kind, u);
    u[0] = f*(u[0] - a->ux); u[1] = f*(u[1] - a->uy); u[2] = f*(u[2] - a->uz);
    for (int b = 0; b < 3; b++)
        for (int c = 0; c < 3; c++) a->slope[3*b + c] += u[b]*x[c];
}

TOBI_FN void isph_invariant_finish(const isph_view *v, int64_t i, isph_invariant_acc *a, double *totals)
{
    double g[9], sum = 0;
    (void)totals;
    for (int b = 0; b < 3; b++) {
        double raw[3];
        for (int c = 0; c < 3; c++) raw[c] = -v->slope*lane_sum(a->slope[3*b + c]);
        isph_apply(&v->inverse[i], raw, &g[3*b]);
    }
    for (int b = 0; b < v->dimension; b++)
        for (int c = 0; c < v->dimension; c++) sum += g[3*b + c]*g[3*c + b];
    v->invariant[i] = v->trace[i] < ISPH_DROP*v->dimension || isph_soft_last(v, i) >= 0 ? 0 : (float)sum;
}

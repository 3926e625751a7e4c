/* The shift of positions of isph, and the change of velocity that goes with it, docs/theory/isph.md. */
#pragma once
#include "sph/isph/isph.k.h"

/* Size of n, eq. (10b), from which the shift begins to lose its part along n, and has lost it. */
#define ISPH_LACK_BEGIN 0.3
#define ISPH_LACK_FULL 0.8
/* Shift: pairs nearer than CORE spacings go apart by PUSH of the overlap each; SHIFT_MAX in spacings. */
#define ISPH_CORE 0.8f
#define ISPH_PUSH 0.25f
#define ISPH_SHIFT_MAX 0.1

/* The shift of positions, eq. (10), as an acceleration over `way` in accel, and the change of velocity that
   goes with it, eq. (10a). totals: [0] sum, [6] largest of |div v|, 1/s, away from a free surface. */
typedef struct isph_shift_acc {
    lane ux, uy, uz, core[3], normal[3], slope[9], bend[3];
    lane low[3], high[3];            /* m/s: of the neighbours, less that of i; 0 is among them     */
} isph_shift_acc;

/* Points of soft solids push by their core, and mirror velocities. */
TOBI_FN void isph_shift_soft(const isph_view *v, int64_t i, isph_shift_acc *a)
{
    double n[3], core[3] = {0, 0, 0}, bend[3] = {0, 0, 0}, low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    double slope[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
    isph_soft_normal(v, i, n);
    ISPH_SOFT_LINKS(v, i, k) {
        const sph_soft_link *l = &v->soft[k];
        const double jump = isph_soft_speed(v, i, l, n), speed = jump/v->slope;
        double r2 = 0;
        for (int c = 0; c < 3; c++) r2 += (double)l->gradient[c]*l->gradient[c]/((double)l->rate*l->rate);
        const double r = sqrt(r2), push = ISPH_PUSH*isph_larger(ISPH_CORE*v->spacing - r, 0)/(r + 1e-20);
        for (int b = 0; b < 3; b++) {
            core[b] -= push*l->gradient[b]/l->rate;
            bend[b] += speed*n[b]*l->rate;
            if (jump*n[b] < low[b]) low[b] = jump*n[b];
            if (jump*n[b] > high[b]) high[b] = jump*n[b];
            for (int c = 0; c < 3; c++) slope[3*b + c] -= speed*n[b]*l->gradient[c];
        }
    }
    for (int b = 0; b < 3; b++) {
        a->core[b] = isph_first(core[b]);
        a->bend[b] = isph_first(bend[b]);
        a->low[b] = isph_first(low[b]);
        a->high[b] = isph_first(high[b]);
    }
    for (int k = 0; k < 9; k++) a->slope[k] = isph_first(slope[k]);
}

TOBI_FN void isph_shift_start(const isph_view *v, int64_t i, isph_shift_acc *a)
{
    const tobi_float4 u = v->velocity[i];
    a->ux = lane_set(u.x); a->uy = lane_set(u.y); a->uz = lane_set(u.z);
    for (int k = 0; k < 3; k++) a->core[k] = a->normal[k] = a->bend[k] = a->low[k] = a->high[k] = lane_set(0);
    for (int k = 0; k < 9; k++) a->slope[k] = lane_set(0);
    if (isph_soft_last(v, i) >= 0) isph_shift_soft(v, i, a);
}

TOBI_FN void isph_shift_pair(const isph_view *v, int64_t i, const tobi_neighbors *n, const isph_image *m,
                             isph_shift_acc *a, const int shape, const int kind)
{
    const lane f = isph_falloff(v, n, m, shape, kind), x[3] = {n->dx, n->dy, n->dz};
    const float core = ISPH_CORE*(float)v->spacing;
    lane u[3];
    (void)i;
    isph_velocity(v, n, m, kind, u);
    u[0] -= a->ux; u[1] -= a->uy; u[2] -= a->uz;
    for (int b = 0; b < 3; b++) {
        const lane change = lane_where_less(lane_set(0), f, u[b], lane_set(0));
        a->high[b] += lane_positive(change - a->high[b]);
        a->low[b] -= lane_positive(a->low[b] - change);
        u[b] = f*u[b];
    }
    if (lane_mask_less(n->r2, lane_set(core*core))) {       /* few pairs are so near */
        const lane r = lane_sqrt(n->r2), push = ISPH_PUSH*lane_positive(core - r)/(r + 1e-20f);
        for (int b = 0; b < 3; b++) a->core[b] += push*x[b];
    }
    for (int b = 0; b < 3; b++) {
        a->bend[b] += u[b];
        for (int c = 0; c < 3; c++) a->slope[3*b + c] += u[b]*x[c];
    }
    if (kind != ISPH_PLAIN) return;
    lane c[4];
    lane_load_float4(v->concentration_gradient, n->j, &c[0], &c[1], &c[2], &c[3]);
    c[3] = lane_where_equal(n->index, lane_set_int((int32_t)i), lane_set(0), c[3]);
    for (int b = 0; b < 3; b++) a->normal[b] += c[3]*c[b];
}

/* Takes that share of the part of x along n out. */
TOBI_FN void isph_remove_normal(double x[3], const double n[3], double share)
{
    const double n2 = n[0]*n[0] + n[1]*n[1] + n[2]*n[2];
    if (!(n2 > 1e-24)) return;
    const double along = (x[0]*n[0] + x[1]*n[1] + x[2]*n[2])/n2;
    for (int a = 0; a < 3; a++) x[a] -= share*along*n[a];
}

/* |div v| of the gradient g. */
TOBI_FN void isph_add_divergence(const isph_view *v, int64_t i, const double g[9], double *totals)
{
    const isph_tensor *b = &v->inverse[i];
    if (v->gate[i] > 0) return;
    const double sum = g[0]*b->xx + g[4]*b->yy + g[8]*b->zz + (g[1] + g[3])*b->xy + (g[5] + g[7])*b->yz +
                       (g[2] + g[6])*b->zx, size = sum < 0 ? -sum : sum;
    totals[0] += size;
    totals[6] = isph_larger(totals[6], size);
}

/* A change of velocity along axis a, kept within those of the neighbours: a gradient goes on beyond them, and
   liquid that the shift holds before a wall would gain speed [Bermejo & Staniforth 1992]. */
TOBI_FN double isph_limit_change(const isph_shift_acc *s, int a, double change)
{
    double low = 0, high = 0;
    for (int k = 0; k < TOBI_LANES; k++) {
        if (lane_at(s->low[a], k) < low) low = lane_at(s->low[a], k);
        if (lane_at(s->high[a], k) > high) high = lane_at(s->high[a], k);
    }
    return isph_clamp(change, low, high);
}

TOBI_FN void isph_shift_finish(const isph_view *v, int64_t i, isph_shift_acc *s, double *totals)
{
    const double full = v->trace[i]/(double)v->dimension, d = v->spacing;
    double x[3], along[3], n[3], g[9], size = 0;
    for (int k = 0; k < 9; k++) g[k] = -v->slope*lane_sum(s->slope[k]);
    for (int a = 0; a < 3; a++) {
        x[a] = -v->shifting*d*d*(&v->concentration_gradient[i].x)[a];
        n[a] = lane_sum(s->normal[a]);
    }
    isph_add_divergence(v, i, g, totals);
    if (v->gate[i] > 0 && full < ISPH_DROP) x[0] = x[1] = x[2] = 0;
    else if (v->gate[i] > 0) isph_remove_normal(x, n, 1);
    else if (v->fades && !(v->last_link && v->last_link[i] >= 0))
        isph_remove_normal(x, n, 1 - isph_fade(isph_length(n), ISPH_LACK_BEGIN, ISPH_LACK_FULL));
    for (int a = 0; a < 3; a++) {
        x[a] = a < v->dimension ? x[a] + lane_sum(s->core[a]) : 0;
        size += x[a]*x[a];
    }
    const double most = ISPH_SHIFT_MAX*d, keep = size > most*most ? most/sqrt(size) : 1;
    const double part = v->open && full < ISPH_DROP ? 0 : keep;
    isph_apply(&v->inverse[i], x, along);
    const double damping = v->shift_damping*part*v->slope*
                           (along[0]*along[0] + along[1]*along[1] + along[2]*along[2]);
    for (int a = 0; a < 3; a++) {
        const double change = g[3*a]*along[0] + g[3*a + 1]*along[1] + g[3*a + 2]*along[2] +
                              damping*lane_sum(s->bend[a]);
        (&v->shift_velocity[i].x)[a] = a < v->dimension ? (float)isph_limit_change(s, a, part*change) : 0;
        (&v->accel[i].x)[a] = (float)(keep*x[a]/(v->way*v->way));
    }
}

TOBI_FN void isph_add_shift_velocity(const isph_view *v, int64_t i, double *totals)
{
    (void)totals;
    for (int a = 0; a < 3; a++) (&v->velocity[i].x)[a] += (&v->shift_velocity[i].x)[a];
}

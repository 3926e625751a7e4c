/* Temperature and concentration: diffusion between particles, what walls give, and what a shift of positions
   changes. Both at once; equation numbers: docs/theory/scalars.md. */
#pragma once
#include "sph/sph.k.h"

/* Differences from the values at the start are exact enough in single precision. */
TOBI_FN void sph_scalar_look(const sph_view *v, int64_t i, double *totals)
{
    const int f = v->fluid[i];
    const tobi_scalar_lift *l = &v->scalar.lift;
    const float all = v->viscous.apparent ? v->eddy[f]*v->viscous.apparent[i].y*v->inverse_density[f] : 0,
                eddy = all < v->scalar.most_eddy ? all : v->scalar.most_eddy;
    const tobi_float4 out = {(float)(v->scalars[i].x - l->value[0]), (float)(v->scalars[i].y - l->value[1]),
                             eddy, 1/v->inverse_density[f]};
    (void)totals;
    v->scalar_now[i] = out;
}

typedef struct sph_scalar_spread_acc {
    lane own[4], spread[2], low[2], high[2], slope[2][3];
    sph_moments m;
} sph_scalar_spread_acc;

TOBI_FN void sph_scalar_spread_start(const sph_view *v, int64_t i, sph_scalar_spread_acc *a)
{
    const tobi_float4 c = v->scalar_now[i];
    a->own[0] = lane_set(c.x); a->own[1] = lane_set(c.y);
    a->own[2] = lane_set(c.z); a->own[3] = lane_set(c.w);
    for (int k = 0; k < 2; k++) {
        a->spread[k] = a->low[k] = a->high[k] = lane_set(0);
        for (int b = 0; b < 3; b++) a->slope[k][b] = lane_set(0);
    }
    sph_moments_clear(&a->m);
}

/* Pairs of different density have its harmonic mean: what one gives the other takes. */
TOBI_FN void sph_scalar_spread_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                    sph_scalar_spread_acc *a, const int shape)
{
    const lane r = lane_sqrt(n->r2), f = smoothing_falloff(shape, r*v->inverse_h, r);
    lane c[4];
    (void)i;
    lane_load_float4(v->scalar_now, n->j, &c[0], &c[1], &c[2], &c[3]);
    const lane mixed = 2*c[3]/(c[3] + a->own[3]), eddy = 0.5f*(c[2] + a->own[2]);
    for (int k = 0; k < 2; k++) {
        const lane change = c[k] - a->own[k], near = lane_where_less(lane_set(0), f, change, lane_set(0));
        a->spread[k] += f*mixed*(v->scalar.diffusivity[k] + v->scalar.per_eddy[k]*eddy)*change;
        a->high[k] += lane_positive(near - a->high[k]);
        a->low[k] -= lane_positive(a->low[k] - near);
        a->slope[k][0] -= f*change*n->dx;
        a->slope[k][1] -= f*change*n->dy;
        a->slope[k][2] -= f*change*n->dz;
    }
    sph_moments_add(&a->m, f, n);
}

/* Eq. (3), unit/s, of a wall at the distance s, whose integral of the kernel is sigma, on a particle with c
   of density rho. */
TOBI_FN float sph_scalar_wall_rate(const sph_view *v, const tobi_scalar_wall *w, float diffusivity,
                                   float sigma, float s, float c, float rho)
{
    const float conducted = w->fixed*diffusivity*(w->value - c)/(w->resistance*rho*diffusivity + s);
    return 2*v->scalar.lattice*sigma*(w->flux/rho + conducted);
}

/* Least and most of the lanes and 0. */
TOBI_FN float sph_scalar_limit(lane low, lane high, float x)
{
    float least = 0, most = 0;
    for (int k = 0; k < TOBI_LANES; k++) {
        if (lane_at(low, k) < least) least = lane_at(low, k);
        if (lane_at(high, k) > most) most = lane_at(high, k);
    }
    return x < least ? least : x > most ? most : x;
}

/* Eq. (1), (4) into scalar_change, without walls. totals: what the shift adds to each, by mass; what it
   takes. */
TOBI_FN void sph_scalar_spread_finish(const sph_view *v, int64_t i, sph_scalar_spread_acc *a, double *totals)
{
    const tobi_float4 shift = v->accel[i], none = {0, 0, 0, 0};
    const float way = v->scalar.way*v->scalar.way, mass = v->volume*v->scalar_now[i].w;
    float rate[2], moved[2] = {0, 0};
    sph_matrix m = sph_moments_sum(&a->m, v->slope);
    if (v->dimension == 2) m.zz = 1;
    v->scalar_change[i] = none;
    if (sph_driven(v, i)) return;
    const int spans = sph_invert(&m, &m);
    for (int k = 0; k < 2; k++) {
        const tobi_float4 slope = lane_sum4(a->slope[k][0], a->slope[k][1], a->slope[k][2], lane_set(0)),
                          g = sph_matrix_times(&m, slope);
        rate[k] = 2*v->slope*lane_sum(a->spread[k]);
        if (spans) moved[k] = sph_scalar_limit(a->low[k], a->high[k],
                                               way*v->slope*(shift.x*g.x + shift.y*g.y + shift.z*g.z));
        totals[k] += moved[k] > 0 ? (double)mass*moved[k] : 0;
        totals[2 + k] -= moved[k] < 0 ? (double)mass*moved[k] : 0;
    }
    const tobi_float4 out = {v->scalar.dt*rate[0], v->scalar.dt*rate[1], moved[0], moved[1]};
    v->scalar_change[i] = out;
}

/* Eq. (5): the shift neither makes nor takes any. totals: W, what the change of weight gives. */
TOBI_FN void sph_scalar_take(const sph_view *v, int64_t i, double *totals)
{
    const tobi_float4 c = v->scalar_change[i], u = v->velocity[i];
    tobi_double2 *own = &v->scalars[i];
    float lift[3] = {0, 0, 0};
    sph_add_lift(v, i, lift);
    totals[0] += (double)v->volume*v->scalar_now[i].w*(lift[0]*u.x + lift[1]*u.y + lift[2]*u.z);
    own->x += (double)c.x + (double)c.z*(c.z > 0 ? v->scalar.gain[0] : v->scalar.loss[0]);
    own->y += (double)c.y + (double)c.w*(c.w > 0 ? v->scalar.gain[1] : v->scalar.loss[1]);
}

/* The filter of full vessels and of isph, eq. (13b) of docs/theory/dfsph.md: blind to linear flows, which L
   sees where neighbours are in disorder or, beside walls, missing, and to what L' v has in common with its
   neighbours, as in a parabolic profile:
   L' v_i = sum_j V F (1 - c_i . x_ji) (v_j - v_i), R = -S L S L' v, and v -= dt k L'^T R. It takes energy and
   no momentum. Three passes: accel = S L' v, roughness = R, then the rest. */
#pragma once
#include "exec/pairs.h"
#include "sph/sph.k.h"

/* sum of V F over that of the lattice from which on neighbours crowd. */
#define SPH_FILTER_CROWD 1.15f

typedef struct sph_filter_acc { sph_laplacian_acc sum; lane x, y, z, all, held; } sph_filter_acc;

TOBI_FN void sph_filter_begin(const sph_view *v, int64_t i, sph_filter_acc *a, const tobi_float4 *field)
{
    sph_laplacian_begin(&a->sum, field, i);
    tobi_float4 c = v->moment[i];
    a->x = lane_set(c.x); a->y = lane_set(c.y); a->z = lane_set(c.z);
    a->all = a->held = lane_set(0);
}
TOBI_FN void sph_filter_start(const sph_view *v, int64_t i, sph_filter_acc *a)
{
    sph_filter_begin(v, i, a, v->velocity);
}
TOBI_FN void sph_filter_pair(const sph_view *v, int64_t i, const tobi_neighbors *n, sph_filter_acc *a,
                             const int shape)
{
    lane x, y, z, w, r = lane_sqrt(n->r2), f = smoothing_falloff(shape, r*v->inverse_h, r);
    a->all += lane_where_equal(n->index, lane_set_int((int32_t)i), lane_set(0), f);
    f *= 1 + (a->x*n->dx + a->y*n->dy + a->z*n->dz);
    lane_load_float4(v->velocity, n->j, &x, &y, &z, &w);
    a->sum.ax += f*(x - a->sum.vx); a->sum.ay += f*(y - a->sum.vy); a->sum.az += f*(z - a->sum.vz);
    if (!v->held) return;
    lane_load_float4(v->held, n->j, &x, &y, &z, &w);
    a->held += w*w;
}
/* accel = s_i L' v, w = s_i: less than 1 where neighbours crowd, which else would be fed, and 0 beside
   buffers of openings, whose velocities are given: a buffer would act and feel nothing. */
TOBI_FN void sph_filter_finish(const sph_view *v, int64_t i, sph_filter_acc *a, double *totals)
{
    const float crowd = v->slope*lane_sum(a->all)*v->inverse_rate/SPH_FILTER_CROWD;
    const float s = v->held && lane_sum(a->held) > 0 ? 0 : crowd > 1 ? 1/(crowd*sqrtf(crowd)) : 1;
    tobi_float4 *out = &v->accel[i];
    sph_laplacian_finish(v, i, &a->sum, totals);
    *out = (tobi_float4){s*out->x, s*out->y, s*out->z, s};
}

/* roughness = s_i times what accel has beyond the mean of its neighbours. */
typedef sph_laplacian_acc sph_filter_compare_acc;
TOBI_FN void sph_filter_compare_start(const sph_view *v, int64_t i, sph_laplacian_acc *a)
{
    sph_laplacian_begin(a, v->accel, i);
}
TOBI_FN void sph_filter_compare_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                     sph_laplacian_acc *a, const int shape)
{
    (void)i;
    sph_laplacian_add(v, n, a, v->accel, shape);
}
TOBI_FN void sph_filter_compare_finish(const sph_view *v, int64_t i, sph_laplacian_acc *a, double *totals)
{
    const tobi_float4 sum = lane_sum4(a->ax, a->ay, a->az, lane_set(0));
    const float k = -v->slope*v->accel[i].w;
    (void)totals;
    v->roughness[i] = (tobi_float4){k*sum.x, k*sum.y, k*sum.z, 0};
}

typedef sph_filter_acc sph_filter_kick_acc;
TOBI_FN void sph_filter_kick_start(const sph_view *v, int64_t i, sph_filter_acc *a)
{
    sph_filter_begin(v, i, a, v->roughness);
}
TOBI_FN void sph_filter_kick_pair(const sph_view *v, int64_t i, const tobi_neighbors *n, sph_filter_acc *a,
                           const int shape)
{
    lane x, y, z, w, r = lane_sqrt(n->r2), f = smoothing_falloff(shape, r*v->inverse_h, r);
    lane cx, cy, cz;
    lane_load_float4(v->moment, n->j, &cx, &cy, &cz, &w);
    lane own = f*(1 + (a->x*n->dx + a->y*n->dy + a->z*n->dz)),
         other = f*(1 - (cx*n->dx + cy*n->dy + cz*n->dz));
    (void)i;
    lane_load_float4(v->roughness, n->j, &x, &y, &z, &w);
    a->sum.ax += other*x - own*a->sum.vx;
    a->sum.ay += other*y - own*a->sum.vy;
    a->sum.az += other*z - own*a->sum.vz;
}
TOBI_FN void sph_filter_kick_finish(const sph_view *v, int64_t i, sph_filter_acc *a, double *totals)
{
    tobi_float4 sum = lane_sum4(a->sum.ax, a->sum.ay, a->sum.az, lane_set(0)), u = v->velocity[i];
    float k = -v->dt*v->filter*v->slope;
    (void)totals;
    u.x += k*sum.x; u.y += k*sum.y; u.z += k*sum.z;
    v->velocity[i] = u;
}

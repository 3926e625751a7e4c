/* Liquids whose viscosity depends on the shear rate. Equation numbers: docs/theory/viscosity.md. */
#pragma once
#include "exec/series.h"
#include "sph/viscosity.k.h"

/* Least share of its trace in the matrix of eq. (6b): what has too few neighbours has a gradient. */
#define SPH_STRAIN_LEAST 1e-4f

/* The sums of eq. (6b). turning = M (xx, yy, zz, xy), lack = M (yz, zx); direction, product, residual = the
   rows of G. Bodies add theirs. */
typedef struct sph_strain_acc { lane wx, wy, wz, g[3][3]; sph_moments m; } sph_strain_acc;
TOBI_FN void sph_strain_start(const sph_view *v, int64_t i, sph_strain_acc *a)
{
    const tobi_float4 w = v->viscous.operand[i];
    a->wx = lane_set(w.x); a->wy = lane_set(w.y); a->wz = lane_set(w.z);
    for (int c = 0; c < 3; c++) a->g[c][0] = a->g[c][1] = a->g[c][2] = lane_set(0);
    sph_moments_clear(&a->m);
}
TOBI_FN void sph_strain_pair(const sph_view *v, int64_t i, const tobi_neighbors *n, sph_strain_acc *a,
                             const int shape)
{
    const lane r = lane_sqrt(n->r2), f = smoothing_falloff(shape, r*v->inverse_h, r);
    lane w[3], none;
    (void)i;
    lane_load_float4(v->viscous.operand, n->j, &w[0], &w[1], &w[2], &none);
    w[0] = f*(a->wx - w[0]); w[1] = f*(a->wy - w[1]); w[2] = f*(a->wz - w[2]);
    for (int c = 0; c < 3; c++) {
        a->g[c][0] += w[c]*n->dx; a->g[c][1] += w[c]*n->dy; a->g[c][2] += w[c]*n->dz;
    }
    sph_moments_add(&a->m, f, n);
}
TOBI_FN void sph_strain_finish(const sph_view *v, int64_t i, sph_strain_acc *a, double *totals)
{
    const tobi_float4 w = v->viscous.operand[i];
    const float k = v->slope;
    tobi_float4 row[3];
    sph_matrix m = sph_moments_sum(&a->m, k);
    (void)totals;
    for (int c = 0; c < 3; c++) {
        row[c] = lane_sum4(a->g[c][0], a->g[c][1], a->g[c][2], lane_set(0));
        row[c] = (tobi_float4){k*row[c].x, k*row[c].y, k*row[c].z, 0};
    }
    for (int p = 0; p < v->plane_count; p++) {
        const tobi_plane *wall = &v->plane[p];
        const float s = sph_viscous_reach(v, p, i);
        if (!(s > 0)) continue;
        const float sigma = sph_plane_value(v, v->table->sigma, s);
        (&m.xx)[wall->axis] += sigma*s;
        for (int c = 0; c < 3; c++)
            (&row[c].x)[wall->axis] += sigma*wall->sign*((&w.x)[c] - wall->velocity[c]);
    }
    v->viscous.turning[i] = (tobi_float4){m.xx, m.yy, m.zz, m.xy};
    v->viscous.lack[i] = (tobi_float4){m.yz, m.zx, 0, 0};
    v->viscous.direction[i] = row[0];
    v->viscous.product[i] = row[1];
    v->viscous.residual[i] = row[2];
}

/* Eq. (6d): of the viscosity, by temperature and concentration. */
TOBI_FN float sph_thinner(const sph_view *v, int64_t i)
{
    const tobi_scalar_lift *l = &v->scalar.lift;
    const float power = v->scalar.thinning[0]*(float)(v->scalars[i].x - l->value[0]) +
                        v->scalar.thinning[1]*(float)(v->scalars[i].y - l->value[1]);
    return lane_at(lane_exp(lane_set(-power)), 0);
}

/* apparent = the viscosity, eq. (6), (6d), and the shear rate, eq. (6b). */
TOBI_FN void sph_apparent(const sph_view *v, int64_t i, double *totals)
{
    const tobi_float4 a = v->viscous.turning[i], b = v->viscous.lack[i];
    const int f = v->fluid[i];
    const float least = SPH_STRAIN_LEAST*(a.x + a.y + a.z) + 1e-30f, creep = v->creep_rate[f];
    const sph_matrix m = {a.x + least, a.y + least, a.z + (v->dimension > 2 ? least : 1), a.w, b.x, b.y};
    const sph_matrix inverse = sph_inverse(&m);
    const tobi_float4 x = sph_matrix_times(&inverse, v->viscous.direction[i]),
                      y = sph_matrix_times(&inverse, v->viscous.product[i]),
                      z = sph_matrix_times(&inverse, v->viscous.residual[i]);
    const float xy = x.y + y.x, yz = y.z + z.y, zx = z.x + x.z, expansion = (x.x + y.y + z.z)/3;
    const float xx = x.x - expansion, yy = y.y - expansion, zz = z.z - expansion;
    const float rate = 2*(xx*xx + yy*yy + zz*zz) + xy*xy + yz*yz + zx*zx, faster = sqrtf(rate + creep*creep);
    const lane thinner = lane_exp((v->flow_index[f] - 1)*lane_log1p(lane_set(faster/creep - 1)));
    const float shear = sqrtf(rate), eddy = v->eddy[f]*shear;
    float mu = v->creep_viscosity[f]*lane_at(thinner, 0) + v->yield_stress[f]/faster;
    (void)totals;
    if (v->scalar.thins) mu *= sph_thinner(v, i);
    v->viscous.apparent[i] = (tobi_float4){mu + eddy, shear, 0, 0};
}

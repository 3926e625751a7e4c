/* Implicit viscosity: the sums of pairs and of plane walls, and conjugate gradients over them. Equation
   numbers: docs/theory/viscosity.md. Unknown are the velocities x after the forces; products are forces times
   the step, kg/m2/s2 s: rows times the density, so that they are symmetric between fluids. */
#pragma once
#include "sph/sph.k.h"
#include "sph/tensor.k.h"

/* beta of eq. (2b): a thread that is drawn out has 97 % of its resistance before pressure acts. */
#define SPH_VISCOUS_BULK 8.0f

/* 4 F mu_ij of eight pairs, mu_ij the harmonic mean of the viscosities. */
TOBI_FN lane sph_viscous_weight(const sph_view *v, const tobi_neighbors *n, lane own, const int shape)
{
    const lane r = lane_sqrt(n->r2), f = smoothing_falloff(shape, r*v->inverse_h, r);
    lane mean = own;
    if (v->phase) {
        lane rho, mu, depth, id;
        lane_load_float4(v->phase, n->j, &rho, &mu, &depth, &id);
        mean = 2*own*mu/(mu + own + 1e-30f);
    }
    return 4*f*mean;
}
TOBI_FN lane sph_viscous_own(const sph_view *v, int64_t i)
{
    return lane_set(v->phase ? v->phase[i].y : v->dynamic);
}

/* accel = the rotation that takes most from the differences of velocity around i: the Omega of the least sum
   of 4 V F mu_ij (w_j - w_i - Omega x x_ji)^2, eq. (2); w = the expansion that does so, eq. (2b). */
typedef struct sph_viscous_spin_acc {
    lane wx, wy, wz, x, y, z, along, mu;
    sph_moments m;
} sph_viscous_spin_acc;
TOBI_FN void sph_viscous_spin_start(const sph_view *v, int64_t i, sph_viscous_spin_acc *a)
{
    const tobi_float4 w = v->viscous.operand[i];
    a->wx = lane_set(w.x); a->wy = lane_set(w.y); a->wz = lane_set(w.z);
    a->x = a->y = a->z = a->along = lane_set(0);
    a->mu = sph_viscous_own(v, i);
    sph_moments_clear(&a->m);
}
TOBI_FN void sph_viscous_spin_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                   sph_viscous_spin_acc *a, const int shape)
{
    lane x, y, z, none;
    const lane f = sph_viscous_weight(v, n, a->mu, shape);
    (void)i;
    lane_load_float4(v->viscous.operand, n->j, &x, &y, &z, &none);
    x = f*(a->wx - x); y = f*(a->wy - y); z = f*(a->wz - z);
    a->x += n->dy*z - n->dz*y; a->y += n->dz*x - n->dx*z; a->z += n->dx*y - n->dy*x;
    a->along += n->dx*x + n->dy*y + n->dz*z;
    sph_moments_add(&a->m, f, n);
}
TOBI_FN void sph_viscous_spin_finish(const sph_view *v, int64_t i, sph_viscous_spin_acc *a, double *totals)
{
    const tobi_float4 turn = lane_sum4(a->x, a->y, a->z, a->along);
    const sph_matrix m = sph_moments_sum(&a->m, 1);
    const float trace = m.xx + m.yy + m.zz, more = 1e-6f*trace, k = trace > 0 ? 1/trace : 0;
    const sph_matrix inertia = {k*(m.yy + m.zz + more), k*(m.zz + m.xx + more), k*(m.xx + m.yy + more),
                                -k*m.xy, -k*m.yz, -k*m.zx};
    tobi_float4 out = {0, 0, 0, 0};
    (void)totals;
    if (trace > 0) out = sph_solve(&inertia, (tobi_float4){k*turn.x, k*turn.y, k*turn.z, 0});
    out.w = k*turn.w;
    v->accel[i] = out;
}

/* sum over j of 4 V F mu_ij (w_j - w_i - (Omega_i + Omega_j)/2 x x_ji + beta (alpha_i + alpha_j) x_ji),
   eq. (1), (2b): N/m3 where w is a velocity. */
typedef struct sph_viscous_acc { lane wx, wy, wz, ox, oy, oz, ow, x, y, z, all, mu; } sph_viscous_acc;
TOBI_FN void sph_viscous_begin(const sph_view *v, int64_t i, sph_viscous_acc *a)
{
    const tobi_float4 w = v->viscous.operand[i], o = v->accel[i];
    a->wx = lane_set(w.x); a->wy = lane_set(w.y); a->wz = lane_set(w.z);
    a->ox = lane_set(o.x); a->oy = lane_set(o.y); a->oz = lane_set(o.z); a->ow = lane_set(o.w);
    a->x = a->y = a->z = a->all = lane_set(0);
    a->mu = sph_viscous_own(v, i);
}
TOBI_FN void sph_viscous_add(const sph_view *v, int64_t i, const tobi_neighbors *n, sph_viscous_acc *a,
                             const int shape)
{
    lane x, y, z, ox, oy, oz, ow, none;
    const lane f = sph_viscous_weight(v, n, a->mu, shape);
    lane_load_float4(v->viscous.operand, n->j, &x, &y, &z, &none);
    lane_load_float4(v->accel, n->j, &ox, &oy, &oz, &ow);
    ox = 0.5f*(ox + a->ox); oy = 0.5f*(oy + a->oy); oz = 0.5f*(oz + a->oz);
    ow = SPH_VISCOUS_BULK*(ow + a->ow);
    a->x += f*(x - a->wx + oy*n->dz - oz*n->dy - ow*n->dx);
    a->y += f*(y - a->wy + oz*n->dx - ox*n->dz - ow*n->dy);
    a->z += f*(z - a->wz + ox*n->dy - oy*n->dx - ow*n->dz);
    a->all += lane_where_equal(n->index, lane_set_int((int32_t)i), lane_set(0), f);
}

/* Rate times density at which the no-slip planes brake a particle along each axis, kg/m3/s, eq. (3); and what
   it is times their velocity. */
TOBI_FN void sph_viscous_planes(const sph_view *v, int64_t i, float rate[3], float drive[3])
{
    const float mu = v->phase ? v->phase[i].y : v->dynamic, least = 0.25f*v->spacing;
    for (int c = 0; c < 3; c++) rate[c] = drive[c] = 0;
    for (int p = 0; p < v->plane_count; p++) {
        const tobi_plane *wall = &v->plane[p];
        float s = sph_plane_distance(v, p, i);
        if (!wall->no_slip || s >= v->h) continue;
        s = s > least ? s : least;
        const float k = 2*mu*sph_plane_value(v, v->table->sigma, s)/s;
        for (int c = 0; c < 3; c++) {
            if (c == wall->axis) continue;
            rate[c] += k;
            drive[c] += k*wall->velocity[c];
        }
    }
}

/* residual = rho (v - x) + dt (viscous force of x), v the velocity that all other forces make; inverse = 1 /
   diagonal. Buffers of inlets have given velocities: no row. Bodies add theirs. */
typedef sph_viscous_acc sph_viscous_rows_acc;
TOBI_FN void sph_viscous_rows_start(const sph_view *v, int64_t i, sph_viscous_acc *a)
{
    sph_viscous_begin(v, i, a);
}
TOBI_FN void sph_viscous_rows_pair(const sph_view *v, int64_t i, const tobi_neighbors *n, sph_viscous_acc *a,
                                   const int shape)
{
    sph_viscous_add(v, i, n, a, shape);
}
TOBI_FN void sph_viscous_rows_finish(const sph_view *v, int64_t i, sph_viscous_acc *a, double *totals)
{
    const tobi_float4 sum = lane_sum4(a->x, a->y, a->z, a->all), u = v->velocity[i],
                      x = v->viscous.operand[i];
    const float rho = 1/v->inverse_density[v->fluid[i]];
    float rate[3], drive[3];
    tobi_float4 r = {0, 0, 0, 0}, inverse = {0, 0, 0, 0};
    (void)totals;
    sph_viscous_planes(v, i, rate, drive);
    for (int c = 0; c < 3 && !sph_driven(v, i); c++) {
        const float w = (&x.x)[c];
        (&r.x)[c] = rho*((&u.x)[c] - w) + v->dt*(v->slope*(&sum.x)[c] + drive[c] - rate[c]*w);
        (&inverse.x)[c] = 1/(rho + v->dt*(v->slope*sum.w + rate[c]));
    }
    v->viscous.residual[i] = r;
    v->viscous.inverse[i] = inverse;
}

/* product = A q = rho q - dt (viscous force of q, planes at rest). */
typedef sph_viscous_acc sph_viscous_product_acc;
TOBI_FN void sph_viscous_product_start(const sph_view *v, int64_t i, sph_viscous_acc *a)
{
    sph_viscous_begin(v, i, a);
}
TOBI_FN void sph_viscous_product_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                      sph_viscous_acc *a, const int shape)
{
    sph_viscous_add(v, i, n, a, shape);
}
TOBI_FN void sph_viscous_product_finish(const sph_view *v, int64_t i, sph_viscous_acc *a, double *totals)
{
    const tobi_float4 sum = lane_sum4(a->x, a->y, a->z, lane_set(0)), q = v->viscous.operand[i];
    const float rho = 1/v->inverse_density[v->fluid[i]];
    float rate[3], drive[3];
    tobi_float4 out = {0, 0, 0, 0};
    (void)totals;
    sph_viscous_planes(v, i, rate, drive);
    for (int c = 0; c < 3 && !sph_driven(v, i); c++)
        (&out.x)[c] = rho*(&q.x)[c] - v->dt*(v->slope*(&sum.x)[c] - rate[c]*(&q.x)[c]);
    v->viscous.product[i] = out;
}

TOBI_FN double sph_viscous_dot(tobi_float4 a, tobi_float4 b)
{
    return (double)a.x*b.x + (double)a.y*b.y + (double)a.z*b.z;
}
TOBI_FN tobi_float4 sph_viscous_times(tobi_float4 a, tobi_float4 b)
{
    return (tobi_float4){a.x*b.x, a.y*b.y, a.z*b.z, 0};
}
TOBI_FN tobi_float4 sph_viscous_blend(tobi_float4 a, float k, tobi_float4 b)
{
    return (tobi_float4){a.x + k*b.x, a.y + k*b.y, a.z + k*b.z, 0};
}

/* totals: r . M r with M the inverse diagonal; mean squares of the residual and of what x is to become, over
   the density: m2/s2. */
TOBI_FN void sph_viscous_measure(const sph_view *v, int64_t i, double *totals)
{
    const tobi_float4 r = v->viscous.residual[i], u = v->velocity[i];
    const double k = v->inverse_density[v->fluid[i]];
    totals[0] += sph_viscous_dot(r, sph_viscous_times(v->viscous.inverse[i], r));
    totals[1] += k*k*sph_viscous_dot(r, r);
    totals[2] += sph_viscous_dot(u, u);
}
/* direction = M r + beta direction; with beta 0 the direction before is void. */
TOBI_FN void sph_viscous_turn(const sph_view *v, int64_t i, double *totals)
{
    const tobi_float4 z = sph_viscous_times(v->viscous.inverse[i], v->viscous.residual[i]);
    (void)totals;
    v->viscous.direction[i] = v->beta > 0 ? sph_viscous_blend(z, v->beta, v->viscous.direction[i]) : z;
}
/* totals[0]: q . A q. */
TOBI_FN void sph_viscous_curve(const sph_view *v, int64_t i, double *totals)
{
    totals[0] += sph_viscous_dot(v->viscous.direction[i], v->viscous.product[i]);
}
TOBI_FN void sph_viscous_advance(const sph_view *v, int64_t i, double *totals)
{
    v->viscous.x[i] = sph_viscous_blend(v->viscous.x[i], v->alpha, v->viscous.direction[i]);
    v->viscous.residual[i] = sph_viscous_blend(v->viscous.residual[i], -v->alpha, v->viscous.product[i]);
    sph_viscous_measure(v, i, totals);
}
/* expected = what v has gained since that was v itself. */
TOBI_FN void sph_viscous_expect(const sph_view *v, int64_t i, double *totals)
{
    (void)totals;
    v->viscous.expected[i] = sph_viscous_blend(v->velocity[i], -1, v->viscous.expected[i]);
}
/* velocity = x + r/rho, less what was expected: what the forces of x make of it, so that pairs keep their
   momentum whatever the residual. totals: impulse on plane walls, N s. */
TOBI_FN void sph_viscous_finish(const sph_view *v, int64_t i, double *totals)
{
    const tobi_float4 x = v->viscous.x[i];
    float rate[3], drive[3];
    if (sph_driven(v, i)) {
        const float given = v->velocity[i].w;
        v->velocity[i] = sph_viscous_blend(v->velocity[i], -1, v->viscous.expected[i]);
        v->velocity[i].w = given;
        return;
    }
    sph_viscous_planes(v, i, rate, drive);
    for (int c = 0; c < 3; c++)
        totals[c] += (double)v->dt*v->volume*(rate[c]*(&x.x)[c] - drive[c]);
    tobi_float4 u = sph_viscous_blend(x, v->inverse_density[v->fluid[i]], v->viscous.residual[i]);
    u = sph_viscous_blend(u, -1, v->viscous.expected[i]);
    u.w = v->velocity[i].w;
    v->velocity[i] = u;
}

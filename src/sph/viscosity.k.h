/* Implicit viscosity: the sums of pairs and of plane walls, and conjugate gradients over them. Equation
   numbers: docs/theory/viscosity.md. Unknown are the velocities x after the forces; products are forces times
   the step, kg/m2/s2 s: rows times the density, so that they are symmetric between fluids. */
#pragma once
#include "sph/sph.k.h"
#include "sph/tensor.k.h"

/* beta of eq. (2b): a thread that is drawn out has 97 % of its resistance before pressure acts. */
#define SPH_VISCOUS_BULK 8.0f
/* delta of eq. (2b), least moment of eq. (2c): bounds where few neighbours are left. */
#define SPH_VISCOUS_LEAST 0.3f
#define SPH_VISCOUS_SPARSE 0.4f

/* Pa s, of one particle. */
TOBI_FN float sph_viscosity_of(const sph_view *v, int64_t i)
{
    if (v->viscous.apparent) return v->viscous.apparent[i].x;
    return v->phase ? v->phase[i].y : v->dynamic;
}

/* 4 F mu_ij of eight pairs, mu_ij the harmonic mean of the viscosities. */
TOBI_FN lane sph_viscous_weight(const sph_view *v, const tobi_neighbors *n, lane own, const int shape)
{
    const lane r = lane_sqrt(n->r2), f = smoothing_falloff(shape, r*v->inverse_h, r);
    lane mean = own;
    if (v->viscous.apparent || v->phase) {
        lane mu, rest, a, b;
        if (v->viscous.apparent) lane_load_float4(v->viscous.apparent, n->j, &mu, &rest, &a, &b);
        else lane_load_float4(v->phase, n->j, &rest, &mu, &a, &b);
        mean = 2*own*mu/(mu + own + 1e-30f);
    }
    return 4*f*mean;
}
TOBI_FN lane sph_viscous_own(const sph_view *v, int64_t i)
{
    return lane_set(sph_viscosity_of(v, i));
}

/* 1/(4 mu/V): sums over 4 F mu_ij are of sums over V F times that. */
TOBI_FN float sph_viscous_share(const sph_view *v, int64_t i)
{
    const float mu = sph_viscosity_of(v, i);
    return mu > 0 ? v->slope/(4*mu) : 0;
}

/* Distance from a no-slip plane that acts on i, at least a quarter of a spacing; 0: none. */
TOBI_FN float sph_viscous_reach(const sph_view *v, int plane, int64_t i)
{
    const float s = sph_plane_distance(v, plane, i), least = 0.25f*v->spacing;
    if (!v->plane[plane].no_slip || s >= v->h) return 0;
    return s > least ? s : least;
}

/* turning = J of the pairs; spread (xx, yy, zz), slant (xy, yz, zx) = sum of V F x x without viscosities.
   Meanwhile direction and product hold N, the sum of sigma s n n over plane walls; bodies add theirs. */
typedef struct sph_viscous_shape_acc { lane mu; sph_moments m, even; } sph_viscous_shape_acc;
TOBI_FN void sph_viscous_shape_start(const sph_view *v, int64_t i, sph_viscous_shape_acc *a)
{
    a->mu = sph_viscous_own(v, i);
    sph_moments_clear(&a->m);
    sph_moments_clear(&a->even);
}
TOBI_FN void sph_viscous_shape_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                    sph_viscous_shape_acc *a, const int shape)
{
    const lane r = lane_sqrt(n->r2);
    (void)i;
    sph_moments_add(&a->m, sph_viscous_weight(v, n, a->mu, shape), n);
    sph_moments_add(&a->even, smoothing_falloff(shape, r*v->inverse_h, r), n);
}
TOBI_FN void sph_viscous_shape_finish(const sph_view *v, int64_t i, sph_viscous_shape_acc *a, double *totals)
{
    const sph_matrix m = sph_moments_sum(&a->m, sph_viscous_share(v, i)),
                     even = sph_moments_sum(&a->even, v->slope);
    float along[3] = {0, 0, 0};
    (void)totals;
    for (int p = 0; p < v->plane_count; p++) {
        const float s = sph_viscous_reach(v, p, i);
        if (s > 0) along[v->plane[p].axis] += s*sph_plane_value(v, v->table->sigma, s);
    }
    v->viscous.turning[i] = (tobi_float4){m.yy + m.zz, m.zz + m.xx, m.xx + m.yy, -m.xy};
    v->viscous.lack[i] = (tobi_float4){-m.yz, -m.zx, 0, 0};
    v->viscous.spread[i] = (tobi_float4){even.xx, even.yy, even.zz, 0};
    v->viscous.slant[i] = (tobi_float4){even.xy, even.yz, even.zx, 0};
    v->viscous.direction[i] = (tobi_float4){along[0], along[1], along[2], 0};
    v->viscous.product[i] = (tobi_float4){0, 0, 0, 0};
}

/* r of eq. (3b): what M lacks along the normals of walls, N, over N. */
TOBI_FN float sph_viscous_lacks(const sph_matrix *m, const sph_matrix *n, int dimension)
{
    const float walls = n->xx + n->yy + n->zz, wall = walls/dimension;
    const float all = (m->xx + m->yy + m->zz)/dimension;
    const float a = n->xx - wall, b = n->yy - wall, c = dimension > 2 ? n->zz - wall : 0;
    const float square = a*a + b*b + c*c + 2*(n->xy*n->xy + n->yz*n->yz + n->zx*n->zx);
    const float both = a*(m->xx - all) + b*(m->yy - all) + c*(m->zz - all) +
                       2*(n->xy*m->xy + n->yz*m->yz + n->zx*m->zx);
    if (!(walls > 0)) return 0;
    return square > 1e-4f*walls*walls ? fminf(fmaxf(-both/square, 0), 2) : 1;
}

/* lack.z = r, eq. (3b); lack.w = s, eq. (2c), 0 without neighbours; turning, lack: J^-1 with both; fit: such
   a matrix Q that s beta E of eq. (2b) is Q (Q : G), G that of sph_viscous_spin, M by J. The payload is s. */
TOBI_FN void sph_viscous_close(const sph_view *v, int64_t i, double *totals)
{
    const tobi_float4 j = v->viscous.turning[i], l = v->viscous.lack[i], d = v->viscous.direction[i],
                      o = v->viscous.product[i], e = v->viscous.spread[i], g = v->viscous.slant[i];
    const float all = 0.5f*(j.x + j.y + j.z), walls = d.x + d.y + d.z, even = e.x + e.y + e.z;
    const sph_matrix m = {all - j.x, all - j.y, all - j.z, -j.w, -l.x, -l.y},
                     n = {d.x, d.y, d.z, o.x, o.y, o.z}, bare = {e.x, e.y, e.z, g.x, g.y, g.z};
    const float r = sph_viscous_lacks(&m, &n, v->dimension), wall = r*walls, more = 2e-6f*all;
    const float whole = even + v->moment_lattice*walls*sph_viscous_lacks(&bare, &n, v->dimension);
    const float s = even > 0 ? 1/fmaxf(whole/v->dimension, SPH_VISCOUS_SPARSE) : 0;
    const sph_matrix turning = {s*j.x + wall - r*n.xx + more, s*j.y + wall - r*n.yy + more,
                                s*j.z + wall - r*n.zz + more, s*j.w - r*n.xy, s*l.x - r*n.yz, s*l.y - r*n.zx};
    const float half = 0.5f*(turning.xx + turning.yy + turning.zz), mean = half/v->dimension;
    const float unit = mean > 0 ? 1/mean : 0, least = SPH_VISCOUS_LEAST;
    const int deep = v->dimension > 2;
    sph_matrix fit = {unit*(half - turning.xx) + least, unit*(half - turning.yy) + least,
                      deep ? unit*(half - turning.zz) + least : 1,
                      -unit*turning.xy, -unit*turning.yz, -unit*turning.zx}, turn = {0};
    (void)totals;
    const float size = s > 0 && sph_invert(&fit, &fit) ?
                       s*(1 + least)*sqrtf(SPH_VISCOUS_BULK*unit/v->dimension) : 0;
    if (s > 0) turn = sph_inverse(&turning);
    v->viscous.turning[i] = (tobi_float4){turn.xx, turn.yy, turn.zz, turn.xy};
    v->viscous.lack[i] = (tobi_float4){turn.yz, turn.zx, r, s};
    v->record[i].w = s;
    v->viscous.fit[i] = (tobi_float4){size*fit.xx, size*fit.yy, deep ? size*fit.zz : 0, size*fit.xy};
    v->viscous.fit_shear[i] = (tobi_float4){size*fit.yz, size*fit.zx, 0, 0};
}

/* What `turn` is as a rotation around i: J^-1 turn. */
TOBI_FN tobi_float4 sph_viscous_turned(const sph_view *v, int64_t i, tobi_float4 turn)
{
    const tobi_float4 j = v->viscous.turning[i], l = v->viscous.lack[i];
    const sph_matrix m = {j.x, j.y, j.z, j.w, l.x, l.y};
    return sph_matrix_times(&m, turn);
}

/* accel = the rotation that takes most from the differences of velocity around i, eq. (2), (3b), but for what
   bodies add; spread, slant = s beta E, eq. (2b). Their w: the operand. */
typedef struct sph_viscous_spin_acc { lane wx, wy, wz, g[3][3], mu; } sph_viscous_spin_acc;
TOBI_FN void sph_viscous_spin_start(const sph_view *v, int64_t i, sph_viscous_spin_acc *a)
{
    const tobi_float4 w = v->viscous.operand[i];
    a->wx = lane_set(w.x); a->wy = lane_set(w.y); a->wz = lane_set(w.z);
    for (int c = 0; c < 3; c++) a->g[c][0] = a->g[c][1] = a->g[c][2] = lane_set(0);
    a->mu = sph_viscous_own(v, i);
}
TOBI_FN void sph_viscous_spin_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                   sph_viscous_spin_acc *a, const int shape)
{
    lane w[3], none;
    const lane f = sph_viscous_weight(v, n, a->mu, shape);
    (void)i;
    lane_load_float4(v->viscous.operand, n->j, &w[0], &w[1], &w[2], &none);
    w[0] = f*(a->wx - w[0]); w[1] = f*(a->wy - w[1]); w[2] = f*(a->wz - w[2]);
    for (int c = 0; c < 3; c++) {
        a->g[c][0] += w[c]*n->dx; a->g[c][1] += w[c]*n->dy; a->g[c][2] += w[c]*n->dz;
    }
}
TOBI_FN void sph_viscous_spin_finish(const sph_view *v, int64_t i, sph_viscous_spin_acc *a, double *totals)
{
    const tobi_float4 w = v->viscous.operand[i];
    const float k = sph_viscous_share(v, i), r = v->viscous.lack[i].z, t = v->viscous.lack[i].w*k;
    tobi_float4 g[3];
    (void)totals;
    for (int c = 0; c < 3; c++) g[c] = lane_sum4(a->g[c][0], a->g[c][1], a->g[c][2], lane_set(0));
    float turn[3] = {t*(g[2].y - g[1].z), t*(g[0].z - g[2].x), t*(g[1].x - g[0].y)};
    for (int p = 0; p < v->plane_count; p++) {
        const tobi_plane *wall = &v->plane[p];
        const float s = sph_viscous_reach(v, p, i);
        if (!(s > 0)) continue;
        const float b = r*sph_plane_value(v, v->table->sigma, s)*wall->sign;
        const int c = wall->axis, d = (c + 1)%3, e = (c + 2)%3;
        turn[d] += b*(v->viscous.moving*wall->velocity[e] - (&w.x)[e]);
        turn[e] -= b*(v->viscous.moving*wall->velocity[d] - (&w.x)[d]);
    }
    const tobi_float4 spin = sph_viscous_turned(v, i, (tobi_float4){turn[0], turn[1], turn[2], 0});
    const tobi_float4 q = v->viscous.fit[i], p = v->viscous.fit_shear[i];
    const float all = k*(q.x*g[0].x + q.y*g[1].y + q.z*g[2].z + q.w*(g[0].y + g[1].x) +
                         p.x*(g[1].z + g[2].y) + p.y*(g[2].x + g[0].z));
    v->accel[i] = (tobi_float4){spin.x, spin.y, spin.z, w.x};
    v->viscous.spread[i] = (tobi_float4){all*q.x, all*q.y, all*q.z, w.y};
    v->viscous.slant[i] = (tobi_float4){all*q.w, all*p.x, all*p.y, w.z};
}

/* sum over j of 4 V F mu_ij ((s_i + s_j)/2 (w_j - w_i) - (s_i Omega_i + s_j Omega_j)/2 x x_ji +
   beta (s_i E_i + s_j E_j) x_ji), eq. (1): N/m3 where w is a velocity. */
typedef struct sph_viscous_acc {
    tobi_float4 turn, spread, slant;
    float scale;
    lane x, y, z, all, mu;
} sph_viscous_acc;
TOBI_FN void sph_viscous_begin(const sph_view *v, int64_t i, sph_viscous_acc *a)
{
    a->turn = v->accel[i];
    a->scale = v->viscous.lack[i].w;
    a->spread = v->viscous.spread[i];
    a->slant = v->viscous.slant[i];
    a->x = a->y = a->z = a->all = lane_set(0);
    a->mu = sph_viscous_own(v, i);
}
TOBI_FN void sph_viscous_add(const sph_view *v, int64_t i, const tobi_neighbors *n, sph_viscous_acc *a,
                             const int shape)
{
    lane x, y, z, ox, oy, oz, xx, yy, zz, xy, yz, zx;
    const lane f = sph_viscous_weight(v, n, a->mu, shape);
    lane_load_float4(v->accel, n->j, &ox, &oy, &oz, &x);
    lane_load_float4(v->viscous.spread, n->j, &xx, &yy, &zz, &y);
    lane_load_float4(v->viscous.slant, n->j, &xy, &yz, &zx, &z);
    const float own = 0.5f*a->scale;
    const lane theirs = 0.5f*n->w, both = theirs + own;
    ox = theirs*ox + own*a->turn.x; oy = theirs*oy + own*a->turn.y; oz = theirs*oz + own*a->turn.z;
    xx += a->spread.x; yy += a->spread.y; zz += a->spread.z;
    xy += a->slant.x; yz += a->slant.y; zx += a->slant.z;
    a->x += f*(both*(x - a->turn.w) - xx*n->dx + (-oz - xy)*n->dy + (oy - zx)*n->dz);
    a->y += f*(both*(y - a->spread.w) + (oz - xy)*n->dx - yy*n->dy + (-ox - yz)*n->dz);
    a->z += f*(both*(z - a->slant.w) + (-oy - zx)*n->dx + (ox - yz)*n->dy - zz*n->dz);
    a->all += lane_where_equal(n->index, lane_set_int((int32_t)i), lane_set(0), f*both);
}

/* Friction of the no-slip planes at velocity w and the rotation in accel, N/m3, eq. (3); and what it is of
   -w, kg/m3/s. */
TOBI_FN void sph_viscous_planes(const sph_view *v, int64_t i, tobi_float4 w, float force[3], float own[3])
{
    const float mu = sph_viscosity_of(v, i), r = v->viscous.lack[i].z;
    const float *turn = &v->accel[i].x;
    for (int c = 0; c < 3; c++) force[c] = own[c] = 0;
    for (int p = 0; p < v->plane_count; p++) {
        const tobi_plane *wall = &v->plane[p];
        const float s = sph_viscous_reach(v, p, i);
        if (!(s > 0)) continue;
        const float k = 2*mu*sph_plane_value(v, v->table->sigma, s)/s, rate = k*(1 + 0.5f*r);
        const int c = wall->axis, d = (c + 1)%3, e = (c + 2)%3;
        const float along = k*r*s*wall->sign;
        force[d] += rate*(v->viscous.moving*wall->velocity[d] - (&w.x)[d]) + along*turn[e];
        force[e] += rate*(v->viscous.moving*wall->velocity[e] - (&w.x)[e]) - along*turn[d];
        own[d] += rate;
        own[e] += rate;
    }
}

/* residual = rho (v - x) + dt (viscous force of x), v the velocity that all other forces make; inverse = 1 /
   diagonal, without the rotations, and with the viscosity of i for that of its neighbours in E. Buffers of
   inlets have given velocities: no row. Bodies add theirs. own: squares of fit_j x; x, y, z: sum of x. */
typedef struct sph_viscous_rows_acc { sph_viscous_acc sums; lane x, y, z, own[3]; } sph_viscous_rows_acc;
TOBI_FN void sph_viscous_rows_start(const sph_view *v, int64_t i, sph_viscous_rows_acc *a)
{
    sph_viscous_begin(v, i, &a->sums);
    a->x = a->y = a->z = a->own[0] = a->own[1] = a->own[2] = lane_set(0);
}
TOBI_FN void sph_viscous_rows_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                   sph_viscous_rows_acc *a, const int shape)
{
    const lane f = sph_viscous_weight(v, n, a->sums.mu, shape), dx = f*n->dx, dy = f*n->dy, dz = f*n->dz;
    lane xx, yy, zz, xy, yz, zx, none[2];
    sph_viscous_add(v, i, n, &a->sums, shape);
    lane_load_float4(v->viscous.fit, n->j, &xx, &yy, &zz, &xy);
    lane_load_float4(v->viscous.fit_shear, n->j, &yz, &zx, &none[0], &none[1]);
    const lane x = xx*dx + xy*dy + zx*dz, y = xy*dx + yy*dy + yz*dz, z = zx*dx + yz*dy + zz*dz;
    a->own[0] += x*x; a->own[1] += y*y; a->own[2] += z*z;
    a->x += dx; a->y += dy; a->z += dz;
}
TOBI_FN void sph_viscous_rows_finish(const sph_view *v, int64_t i, sph_viscous_rows_acc *a, double *totals)
{
    const tobi_float4 sum = lane_sum4(a->sums.x, a->sums.y, a->sums.z, a->sums.all), u = v->velocity[i],
                      x = v->viscous.operand[i], q = v->viscous.fit[i], p = v->viscous.fit_shear[i],
                      side = lane_sum4(a->x, a->y, a->z, lane_set(0)),
                      more = lane_sum4(a->own[0], a->own[1], a->own[2], lane_set(0));
    const sph_matrix fit = {q.x, q.y, q.z, q.w, p.x, p.y};
    const tobi_float4 edge = sph_matrix_times(&fit, side);
    const float rho = 1/v->inverse_density[v->fluid[i]], k = sph_viscous_share(v, i);
    float force[3], own[3];
    tobi_float4 r = {0, 0, 0, 0}, inverse = {0, 0, 0, 0};
    (void)totals;
    sph_viscous_planes(v, i, x, force, own);
    for (int c = 0; c < 3 && !sph_driven(v, i); c++) {
        const float wide = k*((&more.x)[c] + (&edge.x)[c]*(&edge.x)[c]);
        (&r.x)[c] = rho*((&u.x)[c] - (&x.x)[c]) + v->dt*(v->slope*(&sum.x)[c] + force[c]);
        (&inverse.x)[c] = 1/(rho + v->dt*(v->slope*(sum.w + wide) + own[c]));
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
    float force[3], own[3];
    tobi_float4 out = {0, 0, 0, 0};
    (void)totals;
    sph_viscous_planes(v, i, q, force, own);
    for (int c = 0; c < 3 && !sph_driven(v, i); c++)
        (&out.x)[c] = rho*(&q.x)[c] - v->dt*(v->slope*(&sum.x)[c] + force[c]);
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
    float force[3], own[3];
    if (sph_driven(v, i)) {
        const float given = v->velocity[i].w;
        v->velocity[i] = sph_viscous_blend(v->velocity[i], -1, v->viscous.expected[i]);
        v->velocity[i].w = given;
        return;
    }
    sph_viscous_planes(v, i, x, force, own);
    for (int c = 0; c < 3; c++) totals[c] -= (double)v->dt*v->volume*force[c];
    tobi_float4 u = sph_viscous_blend(x, v->inverse_density[v->fluid[i]], v->viscous.residual[i]);
    u = sph_viscous_blend(u, -1, v->viscous.expected[i]);
    u.w = v->velocity[i].w;
    v->velocity[i] = u;
}

/* The pressure equation of DFSPH, solved by conjugate gradients.
   C u = sum_j V grad W . (u_i - u_j) + 2 G . (u_i - u_wall)   is the rate of relative compression,
   a(p) = -(1/rho) C^T p = -(1/rho) [ sum_j (p_i + p_j) V grad W + 2 p_i G ]   the pressure acceleration,
   A = -C a = C (1/rho) C^T the operator: symmetric, so momentum is exact and CG applies.
   In full vessels, and beside bodies in others, both have T grad W in place of grad W, eq. (7c) and (7b).
   Equation numbers: docs/theory/dfsph.md and, for (7b), boundaries.md. */
#pragma once
#include "core/smoothing.k.h"
#include "exec/pairs.h"
#include "linear/value.k.h"
#include "sph/porous.k.h"
#include "sph/tensor.k.h"
#include "sph/view.h"

/* a(p) for the payload p of the records, eq. (8). */
typedef struct sph_pressure_accel_acc { lane p, x, y, z; sph_tensor t; } sph_pressure_accel_acc;

TOBI_FN void sph_pressure_accel_start(const sph_view *v, int64_t i, sph_pressure_accel_acc *a)
{
    a->p = lane_set(v->record[i].w);
    a->x = a->y = a->z = lane_set(0);
    a->t = sph_tensor_of(v, i);
}

TOBI_FN void sph_pressure_accel_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                     sph_pressure_accel_acc *a, const int shape)
{
    lane r = lane_sqrt(n->r2), f = smoothing_falloff(shape, r*v->inverse_h, r);
    (void)i;
    if (!a->t.due) {
        f *= a->p + n->w;
        a->x += f*n->dx; a->y += f*n->dy; a->z += f*n->dz;
        return;
    }
    sph_tensor both = sph_tensor_both(v, &a->t, a->p, n);
    lane tilted[3];
    sph_tensor_times(&both, n->dx, n->dy, n->dz, tilted);
    a->x += f*tilted[0]; a->y += f*tilted[1]; a->z += f*tilted[2];
}

TOBI_FN tobi_float4 sph_pressure_accel_value(const sph_view *v, int64_t i, sph_pressure_accel_acc *a)
{
    tobi_float4 w = v->wall[i], out, sum = lane_sum4(a->x, a->y, a->z, lane_set(0));
    float k = v->inverse_density[v->fluid[i]], p2 = 2*v->record[i].w;
    out.x = k*(v->slope*sum.x - p2*w.x);
    out.y = k*(v->slope*sum.y - p2*w.y);
    out.z = k*(v->slope*sum.z - p2*w.z);
    out.w = 0;
    return v->porous ? sph_porous_give(v->porous[i], out) : out;
}

TOBI_FN void sph_pressure_accel_finish(const sph_view *v, int64_t i, sph_pressure_accel_acc *a,
                                       double *totals)
{
    const tobi_float4 none = {0, 0, 0, 0};
    (void)totals;
    v->accel[i] = sph_driven(v, i) ? none : sph_pressure_accel_value(v, i, a);
    if (sph_held(v, i) && !sph_driven(v, i)) v->accel[i] = sph_take_normal(v, i, v->accel[i]);
}

/* v += dt a(p). totals[0]: sum of rho |a|. */
#define sph_pressure_kick_acc sph_pressure_accel_acc
#define sph_pressure_kick_start sph_pressure_accel_start
#define sph_pressure_kick_pair sph_pressure_accel_pair
TOBI_FN void sph_pressure_kick_finish(const sph_view *v, int64_t i, sph_pressure_accel_acc *a,
                                      double *totals)
{
    tobi_float4 f = sph_pressure_accel_value(v, i, a), u = v->velocity[i];
    u.x += v->dt*f.x; u.y += v->dt*f.y; u.z += v->dt*f.z;
    v->velocity[i] = u;
    totals[0] += (double)sqrtf(f.x * f.x + f.y * f.y + f.z * f.z) / v->inverse_density[v->fluid[i]];
}

/* C u for a float4 array u, eq. (7). */
typedef struct sph_compression_acc { lane ux, uy, uz, sum; sph_tensor t; } sph_compression_acc;

TOBI_FN void sph_compression_start(const sph_view *v, int64_t i, sph_compression_acc *a,
                                   const tobi_float4 *field)
{
    tobi_float4 u = field[i];
    a->t = sph_tensor_of(v, i);
    a->ux = lane_set(u.x); a->uy = lane_set(u.y); a->uz = lane_set(u.z);
    a->sum = lane_set(0);
}

TOBI_FN void sph_compression_pair(const sph_view *v, const tobi_neighbors *n, sph_compression_acc *a,
                                  const tobi_float4 *field, const int shape)
{
    lane x, y, z, w, r = lane_sqrt(n->r2), f = smoothing_falloff(shape, r*v->inverse_h, r);
    lane_load_float4(field, n->j, &x, &y, &z, &w);
    x -= a->ux; y -= a->uy; z -= a->uz;
    lane tilted[3] = {n->dx, n->dy, n->dz};
    if (a->t.due) sph_tensor_times(&a->t, n->dx, n->dy, n->dz, tilted);
    a->sum += f*(x*tilted[0] + y*tilted[1] + z*tilted[2]);
}

TOBI_FN float sph_compression_value(const sph_view *v, int64_t i, sph_compression_acc *a,
                                    const tobi_float4 *field, float wall_speed)
{
    tobi_float4 u = field[i], g = v->wall[i];
    return v->slope*lane_sum(a->sum) + 2*(g.x*u.x + g.y*u.y + g.z*u.z - wall_speed*g.w);
}

/* Rows of a few drops that touch are dependent: pressures of alternating sign make no force. With what they
   give way by, (10g), such pressures stay bounded. The row of a flat surface has a density above that. */
TOBI_FN float sph_compliance(const sph_view *v, int64_t i, float pressure)
{
    return v->surface[i] == SPH_SPARSE && v->density[i] < 0.75f ? 0.05f*v->diagonal[i]*pressure : 0;
}

/* The least pressure of a free surface: none that pulls, but what tension carries where it is hollow. */
TOBI_FN float sph_floor(const sph_view *v, int64_t i)
{
    float c = sph_capillary(v, i);
    return c < 0 ? c : 0;
}

/* The divergence asked for, eq. (10d): dt/2 tr(grad v grad v), into delta, free until the solve. */
typedef struct sph_target_divergence_acc { lane ux, uy, uz, g[9]; sph_tensor t; } sph_target_divergence_acc;
TOBI_FN void sph_target_divergence_start(const sph_view *v, int64_t i, sph_target_divergence_acc *a)
{
    tobi_float4 u = v->velocity[i];
    a->t = sph_tensor_of(v, i);
    a->ux = lane_set(u.x); a->uy = lane_set(u.y); a->uz = lane_set(u.z);
    for (int k = 0; k < 9; k++) a->g[k] = lane_set(0);
}
TOBI_FN void sph_target_divergence_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                        sph_target_divergence_acc *a,
                             const int shape)
{
    lane x, y, z, w, r = lane_sqrt(n->r2), f = smoothing_falloff(shape, r*v->inverse_h, r), tilted[3];
    (void)i;
    lane_load_float4(v->velocity, n->j, &x, &y, &z, &w);
    x = f*(a->ux - x); y = f*(a->uy - y); z = f*(a->uz - z);
    sph_tensor_times(&a->t, n->dx, n->dy, n->dz, tilted);
    for (int k = 0; k < 3; k++) {
        a->g[3*k] += tilted[k]*x; a->g[3*k + 1] += tilted[k]*y; a->g[3*k + 2] += tilted[k]*z;
    }
}
TOBI_FN void sph_target_divergence_finish(const sph_view *v, int64_t i, sph_target_divergence_acc *a,
                                          double *totals)
{
    float g[9];
    (void)totals;
    for (int k = 0; k < 9; k++) g[k] = v->slope*lane_sum(a->g[k]);
    float squares = g[0]*g[0] + g[4]*g[4] + g[8]*g[8], mixed = g[1]*g[3] + g[5]*g[7] + g[6]*g[2];
    v->target_divergence[i] = 0.5f*v->dt*(squares + 2*mixed);
}

/* Inverse of the diagonal, which porous zones make smaller. */
TOBI_FN float sph_inverse_diagonal(const sph_view *v, int64_t i)
{
    const float share = v->porous ? sph_porous_mean(v->porous[i], v->dimension) : 1;
    return 1/(share*v->diagonal[i]);
}

/* Source of the velocity equation, eq. (10): s = C v/dt for the velocity without pressure. At a free
   surface pressure only pushes: a particle that neither is compressed nor holds pressure is left out
   (precondition 0), and so is one that hardly touches another. Elsewhere s has either sign. In the same
   pass product = A p, from accel = a(p) for the pressure p of the last step. Sparse liquid may come
   together until it has its density, eq. (10f): else drops that touch would hang on each other like a foam.
   totals[0]: |s|^2/diagonal, the scale of residuals. */
TOBI_FN void sph_start_search(const sph_view *v, int64_t i, float r, int active, double *totals)
{
    v->precondition[i] = active ? sph_inverse_diagonal(v, i) : 0;
    v->residual[i] = active ? r : 0;
    v->delta[i] = 0;
    float size = fabsf(v->residual[i]);
    totals[0] += (double)v->residual[i]*(v->residual[i]*v->precondition[i]);
    totals[1] += size;
    totals[2] += v->residual[i];
    totals[6] = size > totals[6] ? size : totals[6];
}

typedef struct sph_source_acc { sph_compression_acc free, held; } sph_source_acc;
TOBI_FN void sph_source_start(const sph_view *v, int64_t i, sph_source_acc *a)
{
    sph_compression_start(v, i, &a->free, v->velocity);
    sph_compression_start(v, i, &a->held, v->accel);
}
TOBI_FN void sph_source_pair(const sph_view *v, int64_t i, const tobi_neighbors *n, sph_source_acc *a,
                             const int shape)
{
    (void)i;
    sph_compression_pair(v, n, &a->free, v->velocity, shape);
    sph_compression_pair(v, n, &a->held, v->accel, shape);
}
TOBI_FN void sph_source_finish(const sph_view *v, int64_t i, sph_source_acc *a, double *totals)
{
    float rate = sph_compression_value(v, i, &a->free, v->velocity, 1);
    if (v->exact) rate += v->target_divergence[i];
    float room = 1 - v->density[i];
    if (v->surface[i] == SPH_SPARSE && room > 0) rate -= v->inverse_dt*room;      /* eq. (10f) */
    float r = v->inverse_dt*rate;
    int active = v->diagonal[i] > v->isolated && !sph_held(v, i) &&
                 (!v->surface[i] || r > 0 || v->pressure[i] > sph_floor(v, i));
    v->precondition[i] = active ? sph_inverse_diagonal(v, i) : 0;
    v->residual[i] = active ? r : 0;
    v->product[i] = sph_compliance(v, i, v->pressure[i]) - sph_compression_value(v, i, &a->held, v->accel, 0);
    totals[0] += (double)v->residual[i]*(v->residual[i]*v->precondition[i]);
}

/* r = s - A p for the pressure p of the last step, from product = A p. */
TOBI_FN void sph_warm_residual(const sph_view *v, int64_t i, double *totals)
{
    float m = v->precondition[i];
    sph_start_search(v, i, v->residual[i] - v->product[i], m > 0, totals);
}

/* Residual of the position equation, eq. (11): r = e/dt^2 with the density error e that the step
   starts from. Compression is taken out at a bounded pace; gaps close slowly, and not at a free surface.
   In still water no weight closes them: were they slow there too, it would swell. */
TOBI_FN void sph_density_residual(const sph_view *v, int64_t i, double *totals)
{
    float e = v->density[i] - 1;
    float pace = tobi_reference_pressure(&v->reference, &v->position[i].x) > 0 ? 1 : 0.1f;
    e = e > 0 ? (e > 0.1f ? 0.1f : e) : v->surface[i] ? 0 : pace*(e < -0.02f ? -0.02f : e);
    v->pressure[i] = 0;
    sph_start_search(v, i, e * v->inverse_dt * v->inverse_dt,
                     v->diagonal[i] > v->isolated && !sph_held(v, i) && (!v->surface[i] || e > 0), totals);
}

/* product = A q for the search direction q, from accel = a(q). totals: q . A q, sum of A q. */
#define sph_product_acc sph_compression_acc
TOBI_FN void sph_product_start(const sph_view *v, int64_t i, sph_compression_acc *a)
{
    sph_compression_start(v, i, a, v->accel);
}
TOBI_FN void sph_product_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                              sph_compression_acc *a, const int shape)
{
    (void)i;
    sph_compression_pair(v, n, a, v->accel, shape);
}
TOBI_FN void sph_product_finish(const sph_view *v, int64_t i, sph_compression_acc *a, double *totals)
{
    float p = sph_compliance(v, i, v->record[i].w) - sph_compression_value(v, i, a, v->accel, 0);
    v->product[i] = p;
    totals[0] += (double)p*v->record[i].w;
    totals[1] += p;
}

/* Without a free surface a constant pressure is free, and on a displaced lattice it would push the
   flow about: residual, product, direction and result are kept orthogonal to it, eq. (10b). */
TOBI_FN void sph_center_residual(const sph_view *v, int64_t i, double *totals)
{
    sph_start_search(v, i, v->residual[i] - v->mean, v->precondition[i] > 0, totals);
}
TOBI_FN void sph_center_product(const sph_view *v, int64_t i, double *totals)
{
    v->product[i] -= v->mean;
    totals[0] += (double)v->product[i]*v->record[i].w;
}

/* delta += alpha q, r -= alpha A q. totals: r . z, sum |r|; max |r|. */
TOBI_FN void sph_cg_update(const sph_view *v, int64_t i, double *totals)
{
    float m = v->precondition[i];
    if (m == 0) return;
    v->delta[i] += v->alpha*v->record[i].w;
    float r = v->residual[i] - v->alpha*v->product[i], size = fabsf(r);
    v->residual[i] = r;
    totals[0] += (double)r*(r*m);
    totals[1] += size;
    totals[6] = size > totals[6] ? size : totals[6];
}

/* q = z + beta q with z = r/diagonal + the grid's value, eq. (10c). totals[0]: sum of q. */
TOBI_FN void sph_cg_direction(const sph_view *v, int64_t i, double *totals)
{
    float m = v->precondition[i], q = v->beta != 0 ? v->beta*v->record[i].w : 0;
    float coarse = m > 0 && v->coarse.value ? tobi_grid_value(&v->coarse, &v->position[i].x) : 0;
    q = m > 0 ? v->residual[i]*m + q + coarse : 0;
    v->record[i].w = q;
    totals[0] += q;
}
TOBI_FN void sph_center_direction(const sph_view *v, int64_t i, double *totals)
{
    (void)totals;
    v->record[i].w -= v->mean;
}

/* The pressure of the last step less what still water has gained since, eq. (18).
   A free surface keeps no pressure that pulls, a particle that hardly touches another none at all: it
   would need an enormous one, which the next step, with its neighbour nearer, would start from.
   Payload = that pressure. */
TOBI_FN void sph_warm_start(const sph_view *v, int64_t i, double *totals)
{
    (void)totals;
    const double *x = &v->position[i].x;
    if (v->reference_before.push > 0)
        v->pressure[i] += (float)(tobi_reference_pressure(&v->reference_before, x) -
                                  tobi_reference_pressure(&v->reference, x));
    float least = sph_floor(v, i);
    if (v->surface[i] && v->pressure[i] < least) v->pressure[i] = least;
    if (v->diagonal[i] <= v->isolated) v->pressure[i] = 0;
    v->record[i].w = v->pressure[i];
}

/* A pressure of a free surface that would pull goes to its floor and stays there; payload = the change, a
   direction of the search. totals: sum of the changes, sum of |p|. */
TOBI_FN void sph_clamp_pressure(const sph_view *v, int64_t i, double *totals)
{
    float p = v->pressure[i] + v->delta[i], least = sph_floor(v, i);
    int pulls = v->surface[i] && v->precondition[i] > 0 && p < least;
    v->record[i].w = pulls ? least - p : 0;
    if (pulls) {
        v->delta[i] = least - v->pressure[i];
        v->precondition[i] = 0;
        v->residual[i] = 0;
    }
    totals[0] += v->record[i].w;
    totals[1] += fabsf(p);
}

/* Adds the correction, clamped at free surfaces; payload = the pressure. totals: |p|/rho, m2/s2; p. */
TOBI_FN void sph_correct_pressure(const sph_view *v, int64_t i, double *totals)
{
    float p = v->pressure[i] + v->delta[i];
    if (v->surface[i] && p < sph_floor(v, i)) p = sph_floor(v, i);
    totals[0] += (double)fabsf(p)*v->inverse_density[v->fluid[i]];
    totals[1] += p;
    v->pressure[i] = p;
    v->record[i].w = p;
}
TOBI_FN void sph_center_pressure(const sph_view *v, int64_t i, double *totals)
{
    (void)totals;
    v->pressure[i] -= v->mean;
    v->record[i].w = v->pressure[i];
}

/* e of eq. (23). */
TOBI_FN float sph_density_error(const sph_view *v, int64_t i)
{
    float e = v->density[i] - 1;
    return e > 0 ? (e > 0.1f ? 0.1f : e) : v->surface[i] ? 0 : (e < -0.1f ? -0.1f : e);
}

/* One Jacobi step of the position equation, eq. (23): the potential of the shift. */
TOBI_FN float sph_relax_value(const sph_view *v, int64_t i)
{
    float e = sph_density_error(v, i);
    return v->diagonal[i] > v->isolated ? v->relaxation*v->inverse_dt*v->inverse_dt*e/v->diagonal[i] : 0;
}

/* What an outlet's buffer, no unknown of the solve, adds to the shift: payload = its potential. */
TOBI_FN void sph_relax_outlet(const sph_view *v, int64_t i, double *totals)
{
    (void)totals;
    if (sph_held(v, i) && !sph_driven(v, i)) v->record[i].w = sph_relax_value(v, i);
}

/* The shift of positions over dt^2, eq. (12): a(phi) with phi the payload, a uniform background (particle
   shifting, Xu et al. 2009), and pairs nearer than the core pushed apart. */
typedef struct sph_shift_acc { sph_pressure_accel_acc accel; lane x, y, z, cx, cy, cz; } sph_shift_acc;
TOBI_FN void sph_shift_start(const sph_view *v, int64_t i, sph_shift_acc *a)
{
    sph_pressure_accel_start(v, i, &a->accel);
    a->x = a->y = a->z = a->cx = a->cy = a->cz = lane_set(0);
}
TOBI_FN void sph_shift_pair(const sph_view *v, int64_t i, const tobi_neighbors *n, sph_shift_acc *a,
                            const int shape)
{
    lane r = lane_sqrt(n->r2), f = smoothing_falloff(shape, r*v->inverse_h, r);
    lane c = lane_positive(v->core/(r + 1e-3f*v->core) - 1);
    sph_pressure_accel_pair(v, i, n, &a->accel, shape);
    a->x += f*n->dx; a->y += f*n->dy; a->z += f*n->dz;
    a->cx += c*n->dx; a->cy += c*n->dy; a->cz += c*n->dz;
}
TOBI_FN void sph_shift_finish(const sph_view *v, int64_t i, sph_shift_acc *a, double *totals)
{
    tobi_float4 w = v->wall[i], out = sph_pressure_accel_value(v, i, &a->accel),
                sum = lane_sum4(a->x, a->y, a->z, lane_set(0)),
                core = lane_sum4(a->cx, a->cy, a->cz, lane_set(0));
    float b = 2*v->inverse_density[0]*v->background, c = v->push*v->inverse_dt*v->inverse_dt;
    (void)totals;
    out.x += b*(v->slope*sum.x - w.x) + c*core.x;
    out.y += b*(v->slope*sum.y - w.y) + c*core.y;
    out.z += b*(v->slope*sum.z - w.z) + c*core.z;
    v->accel[i] = out;
}

/* Several fluids: where they meet, how viscosity acts between them, and the tension of the interface.
   Of each particle `phase` has density, viscosity, distance from the interface and number of the fluid.
   Equation numbers: docs/theory/two_liquids.md. */
#pragma once
#include "sph/tension.k.h"

/* Spacings: the least distance from an interface. */
#define SPH_PHASE_LEAST 0.05f

/* The constants of the fluid. */
TOBI_FN void sph_phase_set(const sph_view *v, int64_t i, double *totals)
{
    const int f = v->fluid[i];
    const float rho = 1/v->inverse_density[f];
    const tobi_float4 phase = {rho, v->kinematic[f]*rho, v->h, (float)f};
    (void)totals;
    v->phase[i] = phase;
}

/* 1 where j is of another fluid than i, else 0. */
TOBI_FN lane sph_phase_other(lane own, lane id)
{
    const lane apart = own - id;
    return lane_where_less(lane_set(0.25f), apart*apart, lane_set(1), lane_set(0));
}

/* v += dt/rho sum 2 V F ((dim + 2) mu_ij e e . (v_j - v_i) - mu_i (v_j - v_i)), e the direction of x_ij and
   mu_ij the harmonic mean, eq. (41): div mu (grad v + grad v^T), which differs from mu_i div grad v where the
   viscosity does; into `interface`, for sph_phase_kick. */
typedef struct sph_phase_viscosity_acc { lane ux, uy, uz, x, y, z, mu; } sph_phase_viscosity_acc;
TOBI_FN void sph_phase_viscosity_start(const sph_view *v, int64_t i, sph_phase_viscosity_acc *a)
{
    const tobi_float4 u = v->velocity[i];
    a->ux = lane_set(u.x); a->uy = lane_set(u.y); a->uz = lane_set(u.z);
    a->x = a->y = a->z = lane_set(0);
    a->mu = lane_set(v->phase[i].y);
}
TOBI_FN void sph_phase_viscosity_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                      sph_phase_viscosity_acc *a, const int shape)
{
    lane x, y, z, w, rho, mu, depth, id, r = lane_sqrt(n->r2);
    (void)i;
    lane_load_float4(v->velocity, n->j, &x, &y, &z, &w);
    lane_load_float4(v->phase, n->j, &rho, &mu, &depth, &id);
    x -= a->ux; y -= a->uy; z -= a->uz;
    const lane f = 2*smoothing_falloff(shape, r*v->inverse_h, r), own = f*a->mu;
    const lane mean = 2*a->mu*mu/(mu + a->mu + 1e-30f);
    const lane along = (float)(v->dimension + 2)*f*mean*(x*n->dx + y*n->dy + z*n->dz)/(n->r2 + 1e-30f);
    a->x += along*n->dx - own*x; a->y += along*n->dy - own*y; a->z += along*n->dz - own*z;
}
TOBI_FN void sph_phase_viscosity_finish(const sph_view *v, int64_t i, sph_phase_viscosity_acc *a,
                                        double *totals)
{
    const tobi_float4 sum = lane_sum4(a->x, a->y, a->z, lane_set(0));
    const float k = v->dt*v->slope*v->inverse_density[v->fluid[i]];
    const tobi_float4 out = {k*sum.x, k*sum.y, k*sum.z, 0};
    (void)totals;
    v->interface[i] = out;
}

TOBI_FN void sph_phase_kick(const sph_view *v, int64_t i, double *totals)
{
    const tobi_float4 k = v->interface[i];
    tobi_float4 u = v->velocity[i];
    (void)totals;
    u.x += k.x; u.y += k.y; u.z += k.z;
    v->velocity[i] = u;
}

/* accel = g = sum of V grad W over other fluids, towards them; w = distance from the interface, at which a
   plane leaves as much of the kernel to the others, eq. (42). */
typedef struct sph_phase_depth_acc { lane id, x, y, z, all, other; } sph_phase_depth_acc;
TOBI_FN void sph_phase_depth_start(const sph_view *v, int64_t i, sph_phase_depth_acc *a)
{
    a->id = lane_set(v->phase[i].w);
    a->x = a->y = a->z = a->all = a->other = lane_set(0);
}
TOBI_FN void sph_phase_depth_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                  sph_phase_depth_acc *a, const int shape)
{
    lane rho, mu, depth, id, r = lane_sqrt(n->r2);
    lane_load_float4(v->phase, n->j, &rho, &mu, &depth, &id);
    const lane other = sph_phase_other(a->id, id);
    const lane w = lane_where_equal(n->index, lane_set_int((int32_t)i), lane_set(0),
                                    smoothing_shape(shape, r*v->inverse_h));
    const lane f = other*smoothing_falloff(shape, r*v->inverse_h, r);
    a->all += w;
    a->other += other*w;
    a->x += f*n->dx; a->y += f*n->dy; a->z += f*n->dz;
}

/* The distance at which a plane hides that share of the kernel. */
TOBI_FN float sph_phase_distance(const sph_view *v, float share)
{
    int low = 0, high = TOBI_PLANE_SAMPLES;
    if (!(share > 0)) return v->h;
    while (high - low > 1) {
        const int middle = (low + high)/2;
        if (v->table->lambda[middle] > share) low = middle;
        else high = middle;
    }
    const float a = v->table->lambda[low], b = v->table->lambda[high], least = SPH_PHASE_LEAST*v->spacing;
    const float part = a > b ? (a - share)/(a - b) : 0;
    const float s = v->h*((float)low + (part > 0 ? part : 0))/TOBI_PLANE_SAMPLES;
    return s > least ? s : least;
}

TOBI_FN void sph_phase_depth_finish(const sph_view *v, int64_t i, sph_phase_depth_acc *a, double *totals)
{
    const tobi_float4 sum = lane_sum4(a->x, a->y, a->z, a->other);
    const float k = -v->slope, all = 1 + lane_sum(a->all);
    const tobi_float4 out = {k*sum.x, k*sum.y, k*sum.z, sph_phase_distance(v, sum.w/all)};
    (void)totals;
    v->accel[i] = out;
}

/* The distance into `phase`; accel.w = weight b in the band at the interface, eq. (43). */
TOBI_FN void sph_phase_place(const sph_view *v, int64_t i, double *totals)
{
    tobi_float4 g = v->accel[i];
    const float b = sqrtf(g.x*g.x + g.y*g.y + g.z*g.z)/(2.5f*v->surface_gradient) - 0.2f;
    (void)totals;
    v->phase[i].z = g.w;
    v->accel[i].w = b > 0 ? b : 0;
}

/* interface = unit normal out of the fluid of i, from g of both sides; w = b. Level with plane walls. */
typedef struct sph_phase_normal_acc { lane id, x, y, z; } sph_phase_normal_acc;
TOBI_FN void sph_phase_normal_start(const sph_view *v, int64_t i, sph_phase_normal_acc *a)
{
    a->id = lane_set(v->phase[i].w);
    a->x = a->y = a->z = lane_set(0);
}
TOBI_FN void sph_phase_normal_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                   sph_phase_normal_acc *a, const int shape)
{
    lane x, y, z, b, rho, mu, depth, id, w = smoothing_shape(shape, lane_sqrt(n->r2)*v->inverse_h);
    lane_load_float4(v->accel, n->j, &x, &y, &z, &b);
    lane_load_float4(v->phase, n->j, &rho, &mu, &depth, &id);
    w *= b*(1 - 2*sph_phase_other(a->id, id));
    w = lane_where_equal(n->index, lane_set_int((int32_t)i), lane_set(0), w);
    a->x += w*x; a->y += w*y; a->z += w*z;
}
TOBI_FN void sph_phase_normal_finish(const sph_view *v, int64_t i, sph_phase_normal_acc *a, double *totals)
{
    const tobi_float4 g = v->accel[i];
    float n[3] = {g.w*g.x + lane_sum(a->x), g.w*g.y + lane_sum(a->y), g.w*g.z + lane_sum(a->z)};
    (void)totals;
    sph_finish_normal(v, i, n, 0);
    const tobi_float4 out = {n[0], n[1], n[2], g.w};
    v->interface[i] = out;
}

/* payload = curvature of the interface, positive on a drop of the fluid of i: eq. (34) over both sides,
   brought to the interface by the particle's own distance, eq. (44). */
typedef struct sph_phase_curvature_acc {
    lane id, nx, ny, nz, turn, area, weight, depth;
} sph_phase_curvature_acc;
TOBI_FN void sph_phase_curvature_start(const sph_view *v, int64_t i, sph_phase_curvature_acc *a)
{
    const tobi_float4 n = v->interface[i];
    a->id = lane_set(v->phase[i].w);
    a->nx = lane_set(n.x); a->ny = lane_set(n.y); a->nz = lane_set(n.z);
    a->turn = a->area = a->weight = a->depth = lane_set(0);
}
TOBI_FN void sph_phase_curvature_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                      sph_phase_curvature_acc *a, const int shape)
{
    lane x, y, z, b, rho, mu, depth, id, r = lane_sqrt(n->r2);
    lane_load_float4(v->interface, n->j, &x, &y, &z, &b);
    lane_load_float4(v->phase, n->j, &rho, &mu, &depth, &id);
    const lane same = 1 - 2*sph_phase_other(a->id, id);
    b *= smoothing_falloff(shape, r*v->inverse_h, r);
    b = lane_where_equal(n->index, lane_set_int((int32_t)i), lane_set(0), b);
    const lane own = a->nx*n->dx + a->ny*n->dy + a->nz*n->dz, other = same*(x*n->dx + y*n->dy + z*n->dz);
    const lane across = 0.5f*(own + other);
    a->turn += b*(own - other);
    a->area += b*(n->r2 - across*across);
    a->weight += b;
    a->depth += b*across;
}
TOBI_FN void sph_phase_curvature_finish(const sph_view *v, int64_t i, sph_phase_curvature_acc *a,
                                        double *totals)
{
    const float area = lane_sum(a->area), weight = lane_sum(a->weight), d = v->spacing;
    float k = 0;
    (void)totals;
    if (area > 0 && v->interface[i].w > 0) {
        k = lane_sum(a->turn)/area;
        k = k*d > 0.7f ? 0.7f/d : k*d < -0.7f ? -0.7f/d : k;
        k = (float)(v->dimension - 1)*k/(1 + k*(v->phase[i].z + 0.5f*lane_sum(a->depth)/weight));
    }
    v->record[i].w = k;
}

/* accel.x = mean curvature of the band in reach, eq. (45): evens out what disorder makes, and reaches all
   that see another fluid. */
typedef struct sph_phase_even_acc { lane id, weight, sum; } sph_phase_even_acc;
TOBI_FN void sph_phase_even_start(const sph_view *v, int64_t i, sph_phase_even_acc *a)
{
    a->id = lane_set(v->phase[i].w);
    a->weight = a->sum = lane_set(0);
}
TOBI_FN void sph_phase_even_pair(const sph_view *v, int64_t i, const tobi_neighbors *n, sph_phase_even_acc *a,
                                 const int shape)
{
    lane x, y, z, b, rho, mu, depth, id;
    lane_load_float4(v->interface, n->j, &x, &y, &z, &b);
    lane_load_float4(v->phase, n->j, &rho, &mu, &depth, &id);
    b *= smoothing_shape(shape, lane_sqrt(n->r2)*v->inverse_h);
    b = lane_where_equal(n->index, lane_set_int((int32_t)i), lane_set(0), b);
    a->weight += b;
    a->sum += b*n->w*(1 - 2*sph_phase_other(a->id, id));
}
TOBI_FN void sph_phase_even_finish(const sph_view *v, int64_t i, sph_phase_even_acc *a, double *totals)
{
    const float b = v->interface[i].w, weight = b + lane_sum(a->weight);
    (void)totals;
    v->accel[i].x = weight > 0 ? (b*v->record[i].w + lane_sum(a->sum))/weight : 0;
}

/* interface.w = that. */
TOBI_FN void sph_phase_bend(const sph_view *v, int64_t i, double *totals)
{
    (void)totals;
    v->interface[i].w = v->accel[i].x;
}

/* The tension between the fluid of i and each j, N/m: 0 within a fluid. */
TOBI_FN lane sph_phase_tension_of(const float *row, int count, lane id)
{
    lane sigma = lane_set(0);
    for (int f = 0; f < count; f++) {
        const lane apart = id - (float)f;
        sigma += lane_where_less(apart*apart, lane_set(0.25f), lane_set(row[f]), lane_set(0));
    }
    return sigma;
}

/* v -= dt/rho sum over other fluids of sigma kappa V grad W, eq. (46): balanced by a pressure that jumps by
   sigma kappa, with the sums of eq. (8). */
typedef struct sph_phase_tension_acc { lane kappa, x, y, z; } sph_phase_tension_acc;
TOBI_FN void sph_phase_tension_start(const sph_view *v, int64_t i, sph_phase_tension_acc *a)
{
    a->kappa = lane_set(v->interface[i].w);
    a->x = a->y = a->z = lane_set(0);
}
TOBI_FN void sph_phase_tension_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                    sph_phase_tension_acc *a, const int shape)
{
    lane x, y, z, kappa, rho, mu, depth, id, r = lane_sqrt(n->r2);
    lane_load_float4(v->interface, n->j, &x, &y, &z, &kappa);
    lane_load_float4(v->phase, n->j, &rho, &mu, &depth, &id);
    const lane sigma = sph_phase_tension_of(v->interface_tension[v->fluid[i]], v->fluid_count, id);
    const lane f = 0.5f*sigma*(a->kappa - kappa)*smoothing_falloff(shape, r*v->inverse_h, r);
    a->x += f*n->dx; a->y += f*n->dy; a->z += f*n->dz;
}
TOBI_FN void sph_phase_tension_finish(const sph_view *v, int64_t i, sph_phase_tension_acc *a, double *totals)
{
    const tobi_float4 sum = lane_sum4(a->x, a->y, a->z, lane_set(0));
    const float k = v->dt*v->slope*v->inverse_density[v->fluid[i]];
    tobi_float4 u = v->velocity[i];
    (void)totals;
    u.x += k*sum.x; u.y += k*sum.y; u.z += k*sum.z;
    v->velocity[i] = u;
}

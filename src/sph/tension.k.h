/* Surface tension of one phase by the curvature of its free surface, with the gradient that the pressure
   has: a constant curvature is balanced by the constant pressure sigma kappa exactly.
   Equation numbers: docs/theory/surface_tension.md. */
#pragma once
#include "sph/sph.k.h"

/* accel = g = sum V grad W + G, the gradient of the fluid's share, eq. (31); w = its weight in the band
   at the surface, eq. (32): 0 for what disorder alone makes of a bulk. */
typedef struct sph_normal_acc { lane x, y, z; } sph_normal_acc;
TOBI_FN void sph_normal_start(const sph_view *v, int64_t i, sph_normal_acc *a)
{
    (void)v; (void)i;
    a->x = a->y = a->z = lane_set(0);
}
TOBI_FN void sph_normal_pair(const sph_view *v, int64_t i, const tobi_neighbors *n, sph_normal_acc *a,
                             const int shape)
{
    lane r = lane_sqrt(n->r2), f = smoothing_falloff(shape, r*v->inverse_h, r);
    (void)i;
    a->x += f*n->dx; a->y += f*n->dy; a->z += f*n->dz;
}
TOBI_FN void sph_normal_finish(const sph_view *v, int64_t i, sph_normal_acc *a, double *totals)
{
    tobi_float4 w = v->wall[i];
    float x = w.x - v->slope*lane_sum(a->x), y = w.y - v->slope*lane_sum(a->y),
          z = w.z - v->slope*lane_sum(a->z);
    float b = sqrtf(x*x + y*y + z*z)/(2.5f*v->surface_gradient) - 0.2f;
    tobi_float4 out = {x, y, z, v->surface[i] && b > 0 ? b : 0};
    (void)totals;
    v->accel[i] = out;
}

/* normal = unit of -sum V W b g, eq. (33), out of the liquid; w = b. At plane walls it has the angle of
   contact. */
typedef struct sph_smooth_normal_acc { lane x, y, z; } sph_smooth_normal_acc;
TOBI_FN void sph_smooth_normal_start(const sph_view *v, int64_t i, sph_smooth_normal_acc *a)
{
    (void)v; (void)i;
    a->x = a->y = a->z = lane_set(0);
}
TOBI_FN void sph_smooth_normal_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                    sph_smooth_normal_acc *a, const int shape)
{
    lane x, y, z, b, w = smoothing_shape(shape, lane_sqrt(n->r2)*v->inverse_h);
    lane_load_float4(v->accel, n->j, &x, &y, &z, &b);
    w = lane_where_equal(n->index, lane_set_int((int32_t)i), lane_set(0), w*b);
    a->x += w*x; a->y += w*y; a->z += w*z;
}

/* The normal turned in its plane with the wall's normal w to the angle of contact, eq. (36). */
TOBI_FN void sph_touch_wall(float n[3], const float w[3], float cosine)
{
    float across = n[0]*w[0] + n[1]*w[1] + n[2]*w[2], t[3], size = 0;
    for (int c = 0; c < 3; c++) {
        t[c] = n[c] - across*w[c];
        size += t[c]*t[c];
    }
    if (!(size > 1e-6f)) return;
    size = sqrtf((1 - cosine*cosine)/size);
    for (int c = 0; c < 3; c++) n[c] = size*t[c] + cosine*w[c];
}

/* A unit normal out of the sum in n, at planes nearer than 1.5 spacings with that angle. */
TOBI_FN void sph_finish_normal(const sph_view *v, int64_t i, float n[3], float cosine)
{
    const float size = sqrtf(n[0]*n[0] + n[1]*n[1] + n[2]*n[2]);
    for (int c = 0; c < 3; c++) n[c] = size > 0 ? n[c]/size : 0;
    for (int k = 0; k < v->plane_count && size > 0; k++) {
        if (sph_plane_distance(v, k, i) >= 1.5f*v->spacing) continue;
        float w[3] = {0, 0, 0};
        w[v->plane[k].axis] = v->plane[k].sign;
        sph_touch_wall(n, w, cosine);
    }
}

TOBI_FN void sph_smooth_normal_finish(const sph_view *v, int64_t i, sph_smooth_normal_acc *a, double *totals)
{
    tobi_float4 g = v->accel[i];
    float n[3] = {-g.w*g.x - lane_sum(a->x), -g.w*g.y - lane_sum(a->y), -g.w*g.z - lane_sum(a->z)};
    (void)totals;
    sph_finish_normal(v, i, n, v->contact_cosine);
    tobi_float4 out = {n[0], n[1], n[2], g.w};
    v->normal[i] = out;
}

/* payload = kappa: with x = x_i - x_j and the mean normal n of the pair, sum b F (n_i - n_j).x over
   sum b F (x^2 - (n.x)^2) is the mean of 1/r on a sphere, whatever the arrangement, eq. (34); brought to
   the surface by eq. (35). */
typedef struct sph_curvature_acc { lane nx, ny, nz, turn, area, weight, depth; } sph_curvature_acc;
TOBI_FN void sph_curvature_start(const sph_view *v, int64_t i, sph_curvature_acc *a)
{
    tobi_float4 n = v->normal[i];
    a->nx = lane_set(n.x); a->ny = lane_set(n.y); a->nz = lane_set(n.z);
    a->turn = a->area = a->weight = a->depth = lane_set(0);
}
TOBI_FN void sph_curvature_pair(const sph_view *v, int64_t i, const tobi_neighbors *n, sph_curvature_acc *a,
                                const int shape)
{
    lane x, y, z, b, r = lane_sqrt(n->r2);
    lane_load_float4(v->normal, n->j, &x, &y, &z, &b);
    b *= smoothing_falloff(shape, r*v->inverse_h, r);
    b = lane_where_equal(n->index, lane_set_int((int32_t)i), lane_set(0), b);
    lane own = a->nx*n->dx + a->ny*n->dy + a->nz*n->dz, other = x*n->dx + y*n->dy + z*n->dz;
    lane across = 0.5f*(own + other);
    a->turn += b*(own - other);
    a->area += b*(n->r2 - across*across);
    a->weight += b;
    a->depth += b*across;
}
TOBI_FN void sph_curvature_finish(const sph_view *v, int64_t i, sph_curvature_acc *a, double *totals)
{
    float area = lane_sum(a->area), weight = lane_sum(a->weight), k = 0, d = v->spacing;
    (void)totals;
    if (area > 0 && v->normal[i].w > 0) {
        k = lane_sum(a->turn)/area;
        k = k*d > 0.7f ? 0.7f/d : k*d < -0.7f ? -0.7f/d : k;
        k = (float)(v->dimension - 1)*k/(1 + k*(v->band_depth - 0.5f*lane_sum(a->depth)/weight));
    }
    v->record[i].w = k;
}

/* v += dt 2 sigma kappa g/rho0, eq. (30); capillary = sigma kappa. Below the band kappa is the mean of the
   band in reach, eq. (37): force that were left out there would be missing in the jump of pressure. */
typedef struct sph_tension_acc { lane weight, sum; } sph_tension_acc;
TOBI_FN void sph_tension_start(const sph_view *v, int64_t i, sph_tension_acc *a)
{
    (void)v; (void)i;
    a->weight = a->sum = lane_set(0);
}
TOBI_FN void sph_tension_pair(const sph_view *v, int64_t i, const tobi_neighbors *n, sph_tension_acc *a,
                              const int shape)
{
    lane x, y, z, b;
    lane_load_float4(v->normal, n->j, &x, &y, &z, &b);
    b *= smoothing_shape(shape, lane_sqrt(n->r2)*v->inverse_h);
    b = lane_where_equal(n->index, lane_set_int((int32_t)i), lane_set(0), b);
    a->weight += b;
    a->sum += b*n->w;
}
TOBI_FN void sph_tension_finish(const sph_view *v, int64_t i, sph_tension_acc *a, double *totals)
{
    float b = v->normal[i].w, sigma = v->tension[v->fluid[i]], p = 0;
    tobi_float4 g = v->accel[i], u = v->velocity[i];
    (void)totals;
    if (b > 0) p = sigma*v->record[i].w;
    else if (lane_sum(a->weight) > 0) p = sigma*lane_sum(a->sum)/lane_sum(a->weight);
    v->capillary[i] = p;
    if (v->jumps) return;
    float k = 2*p*v->dt*v->inverse_density[v->fluid[i]];
    u.x += k*g.x; u.y += k*g.y; u.z += k*g.z;
    v->velocity[i] = u;
}

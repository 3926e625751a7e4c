/* SPH kernels that are not the pressure solve: walls, density, viscosity, motion.
   Notation: q = r/h, V the particle volume, x_ij = x_i - x_j, grad W the gradient at i;
   V grad W = -slope falloff x_ij (core/smoothing). Equation numbers: docs/theory/dfsph.md. */
#pragma once
#include "core/smoothing.k.h"
#include "sph/wall_law.h"
#include "exec/pairs.h"
#include "sph/tensor.k.h"
#include "sph/view.h"

/* Linear interpolation in a plane table at distance s. */
TOBI_FN float sph_plane_value(const sph_view *v, const float *table, float s)
{
    float at = (s > 0 ? s : 0)*v->inverse_h*TOBI_PLANE_SAMPLES;
    if (at >= TOBI_PLANE_SAMPLES) return 0;
    int k = (int)at;
    return table[k] + (at - (float)k)*(table[k + 1] - table[k]);
}

TOBI_FN float sph_plane_distance(const sph_view *v, int plane, int64_t i)
{
    const tobi_plane *w = &v->plane[plane];
    const double *x = &v->position[i].x;
    return (float)(w->sign*(x[w->axis] - w->at));
}

/* Wall gradient G and wall share of the density, eq. (4), (5). In corners the uncovered fractions
   multiply: 1 - lambda = prod (1 - lambda_k). Leaves the share in density[i]. */
TOBI_FN void sph_walls(const sph_view *v, int64_t i, double *totals)
{
    float free[6], sigma[6], g[3] = {0, 0, 0}, open = 1;
    (void)totals;
    for (int k = 0; k < v->plane_count; k++) {
        float s = sph_plane_distance(v, k, i);
        free[k] = 1;
        sigma[k] = 0;
        if (s >= v->h) continue;
        free[k] = 1 - sph_plane_value(v, v->table->lambda, s);
        sigma[k] = sph_plane_value(v, v->table->sigma, s);
        open *= free[k];
    }
    for (int k = 0; k < v->plane_count; k++)
        if (sigma[k] > 0) g[v->plane[k].axis] -= v->plane[k].sign*sigma[k]*open/free[k];
    tobi_float4 wall = {g[0], g[1], g[2], 0};
    v->wall[i] = wall;
    v->density[i] = 1 - open;
}

/* What walls and bodies with a share lambda of the kernel add to the relative density, eq. (5b). */
TOBI_FN float sph_wall_density(const sph_view *v, float share)
{
    float at = v->wall_share, full = v->wall_lattice;
    if (share <= at) return share*full/at;
    return share < 0.5f ? full + (share - at)*(0.5f - full)/(0.5f - at) : share;
}

/* Relative density, eq. (3), the diagonal of the pressure operator, eq. (9), and the free-surface
   sign div x (Lee et al. 2008): dim in the bulk, less where neighbours are missing.
   totals: error, surface particles, diagonal, those at a surface beyond doubt; maxima: error, and how deep
   the latter reach, which delta keeps for each, m. */
typedef struct sph_density_acc {
    lane rho, pressure, gx, gy, gz, g2, div;
    sph_moments first, second;      /* sums of F x x, for (7c), and of F^2 x x, where T is due */
    int due;
} sph_density_acc;

TOBI_FN void sph_density_start(const sph_view *v, int64_t i, sph_density_acc *a)
{
    a->due = sph_tensor_due(v, i);
    sph_moments_clear(&a->first);
    sph_moments_clear(&a->second);
    a->rho = a->pressure = a->gx = a->gy = a->gz = a->g2 = a->div = lane_set(0);
}

TOBI_FN void sph_density_pair(const sph_view *v, int64_t i, const tobi_neighbors *n, sph_density_acc *a,
                              const int shape)
{
    lane r = lane_sqrt(n->r2), q = r*v->inverse_h, f = smoothing_falloff(shape, q, r);
    /* padding repeats i itself: it must not count */
    lane w = lane_where_equal(n->index, lane_set_int((int32_t)i), lane_set(0), smoothing_shape(shape, q));
    a->rho += w;
    a->pressure += w*n->w;
    a->gx += f*n->dx; a->gy += f*n->dy; a->gz += f*n->dz;
    lane f2 = f*n->r2;
    a->g2 += f*f2;
    a->div += f2;
    if (!a->due && !v->blind) return;
    if (v->blind) sph_moments_add(&a->first, f, n);
    if (a->due) sph_moments_add(&a->second, f*f, n);
}

/* c of eq. (13b): M^-1 sum V F x, of size 3/h at most; 0 where M has no inverse. */
TOBI_FN void sph_find_moment(const sph_view *v, int64_t i, const sph_matrix *inverse, tobi_float4 g)
{
    tobi_float4 c = sph_matrix_times(inverse, g);
    float size = v->slope*v->h*sqrtf(c.x*c.x + c.y*c.y + c.z*c.z), k = -v->slope*(size > 3 ? 3/size : 1);
    const tobi_float4 moment = {k*c.x, k*c.y, k*c.z, 0};
    v->moment[i] = moment;
}

/* T of a particle: (7c), or (7b) at walls where that is not asked for or has no answer, as on the rim of a
   cavity (open): what is exact across a gap does not see it close. */
TOBI_FN sph_matrix sph_make_tensor(const sph_view *v, int64_t i, const sph_density_acc *a, float share,
                                   int open)
{
    sph_matrix t = {1, 1, 1, 0, 0, 0};
    int walled = share > 0 && (v->full || (v->last_link && v->last_link[i] >= 0)), made = 0;
    if (v->blind) {
        sph_matrix m = sph_moments_sum(&a->first, v->slope);
        sph_matrix b = {0, 0, 0, 0, 0, 0};
        if (v->dimension == 2) m.zz = 1;
        made = sph_invert(&m, &b) && v->exact && !open && sph_tilt(&m, &b, v->wall[i], share, &t);
        sph_find_moment(v, i, &b, lane_sum4(a->gx, a->gy, a->gz, lane_set(0)));
    }
    if (!v->stretch) return t;
    if (!made && walled) t = sph_along_wall(v->wall[i], sph_wall_density(v, share), v->dimension);
    sph_tensor_store(v, i, &t, walled);
    return t;
}

/* The diagonal, eq. (9): of C^T C, with k*g = -sum V grad W. */
TOBI_FN float sph_diagonal(const sph_view *v, int64_t i, tobi_float4 g, const sph_density_acc *a,
                           const sph_matrix *t)
{
    tobi_float4 w = v->wall[i];
    float k = v->slope, squares = a->due ? sph_matrix_squares(t, &a->second) : lane_sum(a->g2);
    float sx = 2*w.x - k*(t->xx*g.x + t->xy*g.y + t->zx*g.z),
          sy = 2*w.y - k*(t->xy*g.x + t->yy*g.y + t->yz*g.z),
          sz = 2*w.z - k*(t->zx*g.x + t->yz*g.y + t->zz*g.z);
    return v->inverse_density[v->fluid[i]]*(sx*sx + sy*sy + sz*sz + k*k*squares);
}

TOBI_FN void sph_density_finish(const sph_view *v, int64_t i, sph_density_acc *a, double *totals)
{
    float share = v->density[i], k = v->slope;
    tobi_float4 w = v->wall[i], g = lane_sum4(a->gx, a->gy, a->gz, a->rho);
    float fluid = v->weight*(1 + g.w), rho = fluid + sph_wall_density(v, share);
    float div = k*lane_sum(a->div) + (float)v->dimension*share;
    /* The kernel average of the pressure is what users read; a little of it, away from walls, damps the
       layer-by-layer mode that a collocated pressure leaves free. */
    int flagged = div < v->surface_limit;
    /* in still water nothing is at a surface: that is how its level was chosen */
    v->surface[i] = flagged && !(tobi_reference_pressure(&v->reference, &v->position[i].x) > 0);
    /* edges of the box, disorder and spray lower div x as well, but on all sides alike */
    float nx = w.x - k*g.x, ny = w.y - k*g.y, nz = w.z - k*g.z, n2 = nx*nx + ny*ny + nz*nz;
    int sure = div < v->open_limit &&
               (div < v->sheet_limit || n2 > v->surface_gradient*v->surface_gradient);
    if (v->surface[i] && 4*n2 < v->surface_gradient*v->surface_gradient) v->surface[i] = SPH_SPARSE;
    totals[3] += sure;
    /* beside walls disorder and the corners of the box make a gradient as well */
    if (share > 0 && div > 0.7f*(float)v->dimension) sure = 0;
    double depth = sure && flagged ? tobi_reference_depth(&v->reference, &v->position[i].x) : 0;
    v->surface_depth[i] = (float)depth;
    totals[7] = depth > totals[7] ? depth : totals[7];
    float p = v->record[i].w, mean = (v->weight*(p + lane_sum(a->pressure)) + share*p)/(fluid + share);
    v->mean_pressure[i] = mean;
    if (share == 0 && !v->surface[i] && !sph_held(v, i)) v->pressure[i] = p + v->smooth*(mean - p);
    v->density[i] = rho;
    sph_matrix t = sph_make_tensor(v, i, a, share, sure);
    v->diagonal[i] = sph_diagonal(v, i, g, a, &t);
    float error = rho > 1 ? rho - 1 : v->surface[i] ? 0 : 1 - rho;
    totals[0] += error;
    totals[1] += v->surface[i] != 0;
    totals[2] += v->diagonal[i];
    totals[6] = error > totals[6] ? error : totals[6];
}

/* L u_i = sum V F (u_j - u_i), half the Laplacian of Morris et al. (1997): symmetric, so momentum is
   exact. First pass: accel = L v. */
typedef struct sph_laplacian_acc { lane vx, vy, vz, ax, ay, az; } sph_laplacian_acc;

TOBI_FN void sph_laplacian_begin(sph_laplacian_acc *a, const tobi_float4 *field, int64_t i)
{
    tobi_float4 u = field[i];
    a->vx = lane_set(u.x); a->vy = lane_set(u.y); a->vz = lane_set(u.z);
    a->ax = a->ay = a->az = lane_set(0);
}

TOBI_FN void sph_laplacian_add(const sph_view *v, const tobi_neighbors *n, sph_laplacian_acc *a,
                               const tobi_float4 *field, const int shape)
{
    lane x, y, z, w, r = lane_sqrt(n->r2), f = smoothing_falloff(shape, r*v->inverse_h, r);
    lane_load_float4(field, n->j, &x, &y, &z, &w);
    a->ax += f*(x - a->vx); a->ay += f*(y - a->vy); a->az += f*(z - a->vz);
}

TOBI_FN void sph_laplacian_start(const sph_view *v, int64_t i, sph_laplacian_acc *a)
{
    sph_laplacian_begin(a, v->velocity, i);
}
TOBI_FN void sph_laplacian_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                sph_laplacian_acc *a, const int shape)
{
    (void)i;
    sph_laplacian_add(v, n, a, v->velocity, shape);
}
TOBI_FN void sph_laplacian_finish(const sph_view *v, int64_t i, sph_laplacian_acc *a, double *totals)
{
    tobi_float4 sum = lane_sum4(a->ax, a->ay, a->az, lane_set(0));
    tobi_float4 out = {v->slope*sum.x, v->slope*sum.y, v->slope*sum.z, 0};
    (void)totals;
    v->accel[i] = out;
}

/* Eq. (6b), 0 .. 1: the pressure there is to continue into a wall, over that of two spacings of depth; none
   where (7b) or (7c) leaves nothing to make up along it. */
TOBI_FN float sph_wetness(const sph_view *v, int64_t i)
{
    float g2 = v->gravity[0]*v->gravity[0] + v->gravity[1]*v->gravity[1] + v->gravity[2]*v->gravity[2];
    if (sph_walled(v, i)) return 0;
    float full = 2*v->spacing*(float)sqrt(g2)/v->inverse_density[v->fluid[i]];
    float p = v->pressure[i] + (float)tobi_reference_pressure(&v->reference, &v->position[i].x);
    return p >= full ? 1 : p > 0 ? p/full : 0;
}

/* A full vessel takes from gravity what holds the first of several fluids: the others feel the rest. */
TOBI_FN void sph_add_buoyancy(const sph_view *v, int64_t i, float g[3])
{
    const float rest = 1 - v->inverse_density[v->fluid[i]]/v->inverse_density[0];
    for (int c = 0; c < 3; c++) g[c] += rest*v->removed_gravity[c];
}

/* What temperature and concentration change of the weight, eq. (2) of scalars. */
TOBI_FN void sph_add_lift(const sph_view *v, int64_t i, float g[3])
{
    double more[3];
    if (!v->scalar.lift.acts) return;
    tobi_scalar_add_lift(&v->scalar.lift, v->scalars[i], g);
    if (!v->acceleration.acts) return;
    tobi_acceleration_at(&v->acceleration, &v->position[i].x, more);
    tobi_scalar_add_share(&v->scalar.lift, v->scalars[i], more, g);
}

/* Gravity less what still water holds, and what acts besides, m/s2. */
TOBI_FN void sph_gravity(const sph_view *v, int64_t i, float g[3])
{
    double taken = tobi_reference_share(&v->reference, &v->position[i].x)*v->reference.push*
                   v->inverse_density[v->fluid[i]];
    for (int c = 0; c < 3; c++) g[c] = v->gravity[c] - (float)(taken*v->reference.down[c]);
    if (v->phase) sph_add_buoyancy(v, i, g);
    sph_add_lift(v, i, g);
    if (!v->acceleration.acts) return;
    double more[3];
    tobi_acceleration_at(&v->acceleration, &v->position[i].x, more);
    for (int c = 0; c < 3; c++) g[c] += (float)more[c];
}

/* The Coriolis part, which walls do not mirror. */
TOBI_FN void sph_add_turning(const sph_view *v, int64_t i, float add[3])
{
    double more[3];
    if (!v->acceleration.acts) return;
    tobi_acceleration_by_velocity(&v->acceleration, &v->velocity[i].x, more);
    for (int c = 0; c < 3; c++) add[c] += (float)more[c];
}

/* Rate at which a no-slip plane at the distance s brakes a particle along itself, eq. (14), (14b). */
TOBI_FN float sph_plane_friction(const sph_view *v, int plane, float s, float sigma, float nu,
                                 const float *speed)
{
    const tobi_plane *p = &v->plane[plane];
    float along2 = 0;
    if (v->implicit) return 0;
    for (int c = 0; c < 3; c++) {
        const float u = c == p->axis ? 0 : speed[c] - p->velocity[c];
        along2 += u*u;
    }
    return 2*nu*sigma/s*(nu > 0 ? tobi_wall_law(sqrtf(along2)*s/nu) : 1);
}

/* v += dt (g + 2 nu L v - filter L L v + walls), eq. (13), (14): laminar viscosity, a fourth-order
   filter that takes motion at the particle scale and leaves longer waves, no-slip planes and the lift of
   planes, the hydrostatic part of their mirrored pressure, -(g . n)(s sigma + lambda) n and along them
   -lambda g, eq. (6), (6b). */
TOBI_FN void sph_kick_by(const sph_view *v, int64_t i, const float filter[3])
{
    const tobi_float4 none = {0, 0, 0, 0};
    float nu = v->implicit ? 0 : v->kinematic[v->fluid[i]];
    tobi_float4 u = v->velocity[i], l = nu > 0 ? v->accel[i] : none;
    float speed[3] = {u.x, u.y, u.z}, wet = sph_wetness(v, i);
    float g[3];
    sph_gravity(v, i, g);
    float add[3] = {g[0] + 2*nu*l.x + filter[0], g[1] + 2*nu*l.y + filter[1], g[2] + 2*nu*l.z + filter[2]};
    sph_add_turning(v, i, add);
    for (int p = 0; p < v->plane_count; p++) {
        float s = sph_plane_distance(v, p, i);
        if (s >= v->h) continue;
        s = s > 0.25f*v->spacing ? s : 0.25f*v->spacing;
        float sigma = sph_plane_value(v, v->table->sigma, s),
              lambda = sph_plane_value(v, v->table->lambda, s);
        int axis = v->plane[p].axis;
        for (int c = 0; c < 3; c++) add[c] -= g[c]*(c == axis ? lambda + s*sigma : wet*lambda);
        if (!v->plane[p].no_slip) continue;
        const float rate = sph_plane_friction(v, p, s, sigma, nu, speed);
        for (int c = 0; c < 3; c++)
            if (c != axis) add[c] -= rate*(speed[c] - v->plane[p].velocity[c]);
    }
    u.x += v->dt*add[0]; u.y += v->dt*add[1]; u.z += v->dt*add[2];
    v->wetness[i] = wet;      /* the walls' reaction needs the same */
    v->velocity[i] = u;
}

typedef sph_laplacian_acc sph_kick_acc;
TOBI_FN void sph_kick_start(const sph_view *v, int64_t i, sph_laplacian_acc *a)
{
    sph_laplacian_begin(a, v->accel, i);
}
TOBI_FN void sph_kick_pair(const sph_view *v, int64_t i, const tobi_neighbors *n, sph_laplacian_acc *a,
                           const int shape)
{
    (void)i;
    sph_laplacian_add(v, n, a, v->accel, shape);
}
TOBI_FN void sph_kick_finish(const sph_view *v, int64_t i, sph_laplacian_acc *a, double *totals)
{
    const tobi_float4 sum = lane_sum4(a->ax, a->ay, a->az, lane_set(0));
    const float k = -v->filter*v->slope, filter[3] = {k*sum.x, k*sum.y, k*sum.z};
    (void)totals;
    sph_kick_by(v, i, filter);
}

/* The same without a filter; without viscosity accel may be anything. */
TOBI_FN void sph_kick_unfiltered(const sph_view *v, int64_t i, double *totals)
{
    const float filter[3] = {0, 0, 0};
    (void)totals;
    sph_kick_by(v, i, filter);
}

/* Force of the fluid on plane walls: reaction of pressure, lift and friction. totals[0..2]: N; 3: sum of the
   shares of gravity that still water holds. */
TOBI_FN void sph_wall_force(const sph_view *v, int64_t i, double *totals)
{
    float free[6], sigma[6], lambda[6], s_sigma[6], open = 1;
    int touched = 0;
    totals[3] += tobi_reference_share(&v->reference, &v->position[i].x);
    for (int k = 0; k < v->plane_count; k++) {
        float s = sph_plane_distance(v, k, i);
        free[k] = 1;
        sigma[k] = 0;
        if (s >= v->h) continue;
        s = s > 0.25f*v->spacing ? s : 0.25f*v->spacing;
        lambda[k] = sph_plane_value(v, v->table->lambda, s);
        sigma[k] = sph_plane_value(v, v->table->sigma, s);
        s_sigma[k] = s*sigma[k];
        lambda[k] += s_sigma[k];
        free[k] = 1 - sph_plane_value(v, v->table->lambda, sph_plane_distance(v, k, i));
        open *= free[k];
        touched = 1;
    }
    if (!touched) return;
    double mass = v->volume/v->inverse_density[v->fluid[i]];
    float push = (v->pressure ? v->pressure[i] : 0) - sph_capillary(v, i), wet = v->wetness[i], g[3];
    sph_gravity(v, i, g);
    for (int k = 0; k < v->plane_count; k++) {
        if (!(sigma[k] > 0)) continue;
        int axis = v->plane[k].axis;
        float here = sph_plane_value(v, v->table->sigma, sph_plane_distance(v, k, i));
        totals[axis] -= 2.0*v->volume*push*v->plane[k].sign*here*open/free[k];
        for (int c = 0; c < 3; c++)
            totals[c] += mass*g[c]*(c == axis ? lambda[k] : wet*(lambda[k] - s_sigma[k]));
        if (!v->plane[k].no_slip) continue;
        const float s = sph_plane_distance(v, k, i), least = 0.25f*v->spacing;
        const double drag = mass*sph_plane_friction(v, k, s > least ? s : least, sigma[k],
                                                    v->kinematic[v->fluid[i]], &v->velocity[i].x);
        for (int c = 0; c < 3; c++)
            if (c != axis) totals[c] += drag*((&v->velocity[i].x)[c] - v->plane[k].velocity[c]);
    }
}

/* u_i = curl v by differences, eq. (15); into accel. */
typedef struct sph_vorticity_acc { lane vx, vy, vz, x, y, z; } sph_vorticity_acc;
TOBI_FN void sph_vorticity_start(const sph_view *v, int64_t i, sph_vorticity_acc *a)
{
    tobi_float4 u = v->velocity[i];
    a->vx = lane_set(u.x); a->vy = lane_set(u.y); a->vz = lane_set(u.z);
    a->x = a->y = a->z = lane_set(0);
}
TOBI_FN void sph_vorticity_pair(const sph_view *v, int64_t i, const tobi_neighbors *n,
                                sph_vorticity_acc *a, const int shape)
{
    lane x, y, z, w, r = lane_sqrt(n->r2), f = smoothing_falloff(shape, r*v->inverse_h, r);
    (void)i;
    lane_load_float4(v->velocity, n->j, &x, &y, &z, &w);
    x -= a->vx; y -= a->vy; z -= a->vz;
    a->x += f*(y*n->dz - z*n->dy); a->y += f*(z*n->dx - x*n->dz); a->z += f*(x*n->dy - y*n->dx);
}
TOBI_FN void sph_vorticity_finish(const sph_view *v, int64_t i, sph_vorticity_acc *a, double *totals)
{
    tobi_float4 sum = lane_sum4(a->x, a->y, a->z, lane_set(0));
    tobi_float4 out = {v->slope*sum.x, v->slope*sum.y, v->slope*sum.z, 0};
    (void)totals;
    v->accel[i] = out;
}

/* Speed^2 that the time step sees, 0.4^2 of it for a lone drop, a particle with next to no neighbours: it
   flies free, and may go a whole spacing where others go 0.4. Its neighbours' density is below 1/4. */
TOBI_FN double sph_step_speed2(const sph_view *v, int64_t i, double speed2)
{
    return v->density[i] - v->weight < 0.25f ? 0.16*speed2 : speed2;
}

/* x += dt (v + dt shift), held at a small distance from plane walls; a particle pressed further loses
   its normal speed. The shift (accel) corrects positions and never enters the velocity, eq. (12).
   A particle beyond the speed cap, squeezed where surfaces meet, is slowed to it and counted. A
   speed_limit of the user lifts the cap.
   totals: contacts, momentum lost to walls, capped; maxima: speed^2 for the time step, and before the cap. */
TOBI_FN void sph_advance(const sph_view *v, int64_t i, double *totals)
{
    tobi_float4 u = v->velocity[i], shift = v->accel[i];
    double speed2 = (double)u.x * u.x + (double)u.y * u.y + (double)u.z * u.z,
           cap2 = (double)v->speed_cap * v->speed_cap;
    if (!(speed2 < 1e30)) speed2 = 1e30;   /* NaN shows as a runaway */
    totals[7] = speed2 > totals[7] ? speed2 : totals[7];
    if (speed2 > cap2 && speed2 < 1e30) {
        float slow = (float)(v->speed_cap/sqrt(speed2));
        u.x *= slow; u.y *= slow; u.z *= slow;
        totals[4] += 1;
        speed2 = cap2;
    }
    double seen = sph_step_speed2(v, i, speed2);
    totals[6] = seen > totals[6] ? seen : totals[6];
    double x[3] = {v->position[i].x + (double)v->dt*(u.x + v->dt*shift.x),
                   v->position[i].y + (double)v->dt*(u.y + v->dt*shift.y),
                   v->position[i].z + (double)v->dt*(u.z + v->dt*shift.z)};
    float w[3] = {u.x, u.y, u.z};
    if (v->dimension == 2) x[2] = w[2] = 0;      /* normals of bodies have some 1e-17 */
    double least = 0.2*v->spacing;
    for (int p = 0; p < v->plane_count; p++) {
        const tobi_plane *pl = &v->plane[p];
        if (pl->sign*(x[pl->axis] - pl->at) >= least) continue;
        x[pl->axis] = pl->at + pl->sign*least;
        if (pl->sign*w[pl->axis] < 0) {
            totals[0] += 1;
            totals[1 + pl->axis] += w[pl->axis]*v->volume/v->inverse_density[v->fluid[i]];
            w[pl->axis] = 0;
        }
    }
    tobi_float4 out = {w[0], w[1], w[2], u.w};
    tobi_double3 at = {x[0], x[1], x[2]};
    v->velocity[i] = out;
    v->position[i] = at;
}

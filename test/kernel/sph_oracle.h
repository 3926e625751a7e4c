/* The SPH kernels once more, in double, from the equations of docs/theory: every pair of particles is
   looked at, there are no lists, no records, no tables of production code. Slow on purpose. */
#pragma once
#include "kernel/smoothing_oracle.h"
#include "sph/view.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One row per particle: everything a kernel may read or write, in double. */
enum {
    POS, PAYLOAD = POS + 3, VEL, ACC = VEL + 3, BAND = ACC + 3, NORMAL, NORMAL_BAND = NORMAL + 3, WALL,
    FLUX = WALL + 3, CAPILLARY, RHO, DIAG, PRE, RES, PROD, DELTA, PRES, SURF, WET,
    TENSOR, WALLED = TENSOR + 6, MOMENT, MEAN = MOMENT + 3, DROP, MIDWAY, DAMPED,
    VISCOUS, VISCOUS_EXPECTED = VISCOUS + 3, VISCOUS_RESIDUAL = VISCOUS_EXPECTED + 3,
    VISCOUS_DIRECTION = VISCOUS_RESIDUAL + 3, VISCOUS_PRODUCT = VISCOUS_DIRECTION + 3,
    VISCOUS_INVERSE = VISCOUS_PRODUCT + 3, TURNING = VISCOUS_INVERSE + 3, LACK = TURNING + 4,
    APPARENT = LACK + 4, SHEAR_RATE, ROUGH, SPREAD = ROUGH + 3, SLANT = SPREAD + 4, FIT = SLANT + 4,
    COLUMNS = FIT + 6
};
typedef double row[COLUMNS];
static const char *const column_name[COLUMNS] = {
    "x", "y", "z", "payload", "vx", "vy", "vz", "ax", "ay", "az", "band", "nx", "ny", "nz",
    "normal band", "Gx", "Gy", "Gz", "flux", "capillary", "density", "diagonal", "precondition",
    "residual", "product", "delta", "pressure", "surface", "wetness", "Txx", "Tyy", "Tzz", "Txy", "Tyz",
    "Tzx", "walled", "cx", "cy", "cz", "mean pressure", "drop", "target_divergence", "damped",
    "viscous x", "viscous y", "viscous z", "expected x", "expected y", "expected z",
    "viscous rx", "viscous ry", "viscous rz", "viscous qx", "viscous qy", "viscous qz",
    "viscous Aqx", "viscous Aqy", "viscous Aqz", "viscous Mx", "viscous My", "viscous Mz",
    "Jxx", "Jyy", "Jzz", "Jxy", "Jyz", "Jzx", "wall's lack", "viscous scale",
    "apparent viscosity", "shear rate", "roughness x", "roughness y", "roughness z"
};

enum { TABLE = 4000 };
typedef struct oracle {
    int count, dimension, shape;
    double d, h, volume, box[3];
    int periodic[3];
    double w_scale, g_scale, rate;       /* lattice normalisation of W and of its gradient; sum of V F */
    double behind, moment_lattice;       /* what a lattice lacks at a wall, of a sum of 1 */
    double lambda[TABLE + 2], sigma[TABLE + 2];
    int along;                           /* not 0: eq. (7c), or with near (7b) */
    const int32_t *last_link;            /* >= 0: with it, NULL: all */
    int plane_count;
    tobi_plane plane[6];
    const uint8_t *fluid;
    double yield_stress[2], flow_index[2], creep_rate[2], smagorinsky[2];
    double rho0[2], nu[2], gravity[3], removed_gravity[3];
    double dt, alpha, beta, mean, smooth, filter, surface_limit, speed_cap;
    const float *coarse;
    double cells_per_metre[3];
    double tension[2], contact, band_depth;
    double stiffness, exponent, damping, relaxation, recovery, recovery_pressure;
    double isolated, sheet_limit, surface_gradient, core, push, background;
    tobi_reference reference, reference_before;
} oracle;

static double oracle_w(const oracle *o, double r) { return kernel_w(o->shape, o->dimension, o->h, r); }
static double oracle_f(const oracle *o, double r) { return kernel_f(o->shape, o->dimension, o->h, r); }

/* Integral of W over the plane (line in 2-D) at distance s, Simpson. */
static double plane_integral(const oracle *o, double s)
{
    enum { N = 400 };
    double sum = 0, end = sqrt(fmax(o->h*o->h - s*s, 0)), pi = acos(-1);
    for (int k = 0; k <= N; k++) {
        double a = end*k/N, w = oracle_w(o, sqrt(s*s + a*a))*(o->dimension == 3 ? 2*pi*a : 2);
        sum += w*(k == 0 || k == N ? 1 : k%2 ? 4 : 2);
    }
    return sum*end/(3*N);
}

/* Lattice sums: V W sums to one, V F x x to one; sigma(d/2) carries a uniform pressure exactly. */
static void oracle_normalise(oracle *o)
{
    int n = 5, nz = o->dimension == 3 ? n : 0;
    double w = 0, moment = 0, half = 0, behind = 0, all = 0, normal = 0, along = 0;
    o->volume = pow(o->d, o->dimension);
    for (int k = -nz; k <= nz; k++)
        for (int j = -n; j <= n; j++)
            for (int i = -n; i <= n; i++) {
                double r = o->d*sqrt(i*i + j*j + k*k), x = i*o->d;
                w += o->volume*oracle_w(o, r);
                if (i < 0) behind += o->volume*oracle_w(o, r);
                if (r == 0) continue;
                moment += o->volume*oracle_f(o, r)*x*x;
                all += o->volume*oracle_f(o, r);
                if (i <= 0) continue;
                half += o->volume*oracle_f(o, r)*x;
                normal += oracle_f(o, r)*x*x;
                along += oracle_f(o, r)*j*j*o->d*o->d;
            }
    o->w_scale = 1/w; o->behind = behind/w;
    o->g_scale = 1/moment; o->rate = all/moment;
    o->moment_lattice = (normal + (o->dimension - 1)*along)/(normal - along);
    for (int k = 0; k <= TABLE; k++) o->sigma[k] = plane_integral(o, o->h*k/TABLE);
    o->lambda[TABLE] = 0;
    for (int k = TABLE - 1; k >= 0; k--)
        o->lambda[k] = o->lambda[k + 1] + 0.5*o->h/TABLE*(o->sigma[k] + o->sigma[k + 1]);
    double scale = half*o->g_scale/plane_integral(o, 0.5*o->d);
    for (int k = 0; k <= TABLE; k++) o->sigma[k] *= scale;
}

static double look_up(const oracle *o, const double *table, double s)
{
    double at = fmax(s, 0)/o->h*TABLE;
    int k = (int)at;
    return k >= TABLE ? 0 : table[k] + (at - k)*(table[k + 1] - table[k]);
}

/* x_i - x_j with the nearest image; returns the distance. */
static double oracle_pair(const oracle *o, const row *s, int i, int j, double x[3])
{
    double r2 = 0;
    for (int a = 0; a < 3; a++) {
        x[a] = s[i][POS + a] - s[j][POS + a];
        if (o->periodic[a]) x[a] -= o->box[a]*nearbyint(x[a]/o->box[a]);
        r2 += x[a]*x[a];
    }
    return sqrt(r2);
}

#define EACH_NEIGHBOUR(o, s, i, j, x, r)                       \
    for (int j = 0; j < (o)->count; j++)                       \
        for (double x[3], r = oracle_pair(o, s, i, j, x), once_ = 1; once_ > 0; once_ = 0) \
            if (j != i && r < (o)->h)

static double wall_distance(const oracle *o, const row *s, int i, int k)
{
    const tobi_plane *p = &o->plane[k];
    return p->sign*(s[i][POS + p->axis] - p->at);
}

/* Eq. (4), (5): the fractions of the kernel that planes leave open multiply. */
static void oracle_walls(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double open = 1;
        for (int a = 0; a < 4; a++) out[i][WALL + a] = 0;
        for (int k = 0; k < o->plane_count; k++) {
            double g = look_up(o, o->sigma, wall_distance(o, in, i, k));
            for (int l = 0; l < o->plane_count; l++)
                if (l != k) g *= 1 - look_up(o, o->lambda, wall_distance(o, in, i, l));
            out[i][WALL + o->plane[k].axis] -= o->plane[k].sign*g;
            open *= 1 - look_up(o, o->lambda, wall_distance(o, in, i, k));
        }
        out[i][RHO] = 1 - open;
    }
}

/* Eq. (18), (19): the pressure of still water, a Hermite cubic between 0 and the straight line. */
static double pressure_of(const tobi_reference *w, const double *x, double shift)
{
    double s = shift - w->level, t = 0;
    for (int a = 0; a < 3; a++) s += w->down[a]*(x[a] - w->corner[a]);
    t = (s - w->cover)/w->ramp;
    double end = w->cover + w->ramp - w->rest;
    if (t > 1) return w->push*(s - w->rest);
    return t > 0 ? w->push*(end*(3*t*t - 2*t*t*t) + w->ramp*(t*t*t - t*t)) : 0;
}

static double find_reference_slope(const oracle *o, const double *x)
{
    const double step = 1e-5*o->d;
    return (pressure_of(&o->reference, x, step) - pressure_of(&o->reference, x, -step))/(2*step);
}

/* What of gravity it leaves, m/s2: less its slope over the density. */
static double felt_gravity(const oracle *o, const row *in, int i, int axis)
{
    const double slope = find_reference_slope(o, &in[i][POS]);
    return o->gravity[axis] - slope*o->reference.down[axis]/o->rho0[o->fluid[i]];
}

/* Eq. (5b) by its three points: nothing, a lattice at a wall, half a space. */
static double oracle_fill(const oracle *o, double share)
{
    double at = look_up(o, o->lambda, 0.5*o->d), slope = (0.5 - o->behind)/(0.5 - at);
    return share > 0.5 ? share : share < at ? o->behind*share/at : 0.5 - slope*(0.5 - share);
}

/* T x, with T of the row. */
static void tilt(const oracle *o, const row *in, int i, const double x[3], double out[3])
{
    static const int place[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    for (int a = 0; a < 3; a++) {
        out[a] = o->along ? 0 : x[a];
        for (int b = 0; o->along && b < 3; b++) out[a] += in[i][TENSOR + place[a][b]]*x[b];
    }
}

/* m becomes its inverse; returns its determinant. Gauss and Jordan. */
static double oracle_inverse(double m[3][3])
{
    double e[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, det = 1;
    for (int k = 0; k < 3; k++) {
        double pivot = m[k][k];
        det *= pivot;
        for (int c = 0; c < 3; c++) { m[k][c] /= pivot; e[k][c] /= pivot; }
        for (int r = 0; r < 3; r++) {
            double f = m[r][k];
            for (int c = 0; r != k && c < 3; c++) { m[r][c] -= f*m[k][c]; e[r][c] -= f*e[k][c]; }
        }
    }
    memcpy(m, e, sizeof e);
    return det;
}

/* Eq. (7c): (I - w n n^T) M^-1 with M the sum of V F x x^T and w what it lacks along the normal. */
static int oracle_renormalised(const oracle *o, const row *in, int i, const double n[3], double share,
                               double t[3][3])
{
    double m[3][3] = {{0}}, wall[3][3], across = 1, det;
    EACH_NEIGHBOUR(o, in, i, j, x, r)
        for (int a = 0; a < 9; a++) m[a/3][a%3] += o->volume*o->g_scale*oracle_f(o, r)*x[a/3]*x[a%3];
    if (o->dimension == 2) m[2][2] = 1;
    for (int a = 0; a < 9; a++) across -= n[a/3]*m[a/3][a%3]*n[a%3];
    det = oracle_inverse(m);
    for (int a = 0; a < 9; a++) wall[a/3][a%3] = (a%4 == 0) - across*fmin(50*share, 1)*n[a/3]*n[a%3];
    for (int a = 0; a < 9; a++) {
        t[a/3][a%3] = 0;
        for (int c = 0; c < 3; c++)
            t[a/3][a%3] += 0.5*(wall[a/3][c]*m[c][a%3] + m[a/3][c]*wall[c][a%3]);
    }
    for (int a = 0; a < 3; a++)
        if (!(t[a][a] > 0 && t[a][a] < 20)) return 0;
    return det > 1e-3;
}

/* Eq. (7c) in a full vessel; eq. (7b), n n^T + (I - n n^T)/(1 - L), beside bodies. */
static void oracle_tensor(const oracle *o, const row *in, row *out, int i, int open)
{
    double share = in[i][RHO], lack = fmin(oracle_fill(o, share), 0.45), size = 0;
    double n[3] = {0}, t[3][3] = {{0}};
    int walled = share > 0 && !(o->last_link && o->last_link[i] < 0);
    for (int c = 0; c < 3; c++) size += in[i][WALL + c]*in[i][WALL + c];
    for (int c = 0; c < 3; c++) n[c] = size > 0 ? in[i][WALL + c]/sqrt(size) : 0;
    if (o->last_link || open || !oracle_renormalised(o, in, i, n, share, t))
        for (int a = 0; a < 9; a++) {
            double across = n[a/3]*n[a%3], unit = a%4 == 0;
            t[a/3][a%3] = walled ? across + (unit - across)/(1 - lack) : unit;
        }
    if (o->dimension == 2) t[2][2] = 1;
    const double kept[6] = {t[0][0], t[1][1], t[2][2], t[0][1], t[1][2], t[2][0]};
    memcpy(&out[i][TENSOR], kept, sizeof kept);
    out[i][WALLED] = walled;
}

static void oracle_moment(const oracle *o, const row *in, row *out, int i);

/* 1: beyond doubt at a surface or on the rim of a cavity, 2: even beside walls. *even: neighbours are missing
   on all sides alike. */
static int oracle_open(const oracle *o, const row *in, int i, int *even)
{
    double div = o->dimension*in[i][RHO], slant[3], steep = 0;
    memcpy(slant, &in[i][WALL], sizeof slant);
    EACH_NEIGHBOUR(o, in, i, j, x, r)
        for (int a = 0; a < 3; a++) {
            double g = -o->volume*o->g_scale*oracle_f(o, r)*x[a];      /* V grad W */
            slant[a] += g;
            div -= g*x[a];
        }
    for (int a = 0; a < 3; a++) steep += slant[a]*slant[a];
    *even = sqrt(steep) < 0.5*o->surface_gradient;
    int sure = div < o->surface_limit && (div < o->sheet_limit || sqrt(steep) > o->surface_gradient);
    return sure ? 1 + (in[i][RHO] == 0 || div <= 0.7*o->dimension) : 0;
}

/* Eq. (3) and (9), the kernel mean of the pressure, the surface test. */
static void oracle_density(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++) {
        double ww = o->volume*o->w_scale, gg = o->volume*o->g_scale, share = in[i][RHO], own[3], rest = 0;
        double rho = ww*oracle_w(o, 0), mean = (rho + share)*in[i][PAYLOAD], div = o->dimension*share;
        double tilted[3];
        int even;
        const int open = oracle_open(o, in, i, &even);
        if (o->along) oracle_tensor(o, in, out, i, open == 2);
        if (o->along == 1) oracle_moment(o, in, out, i);
        for (int a = 0; a < 3; a++) own[a] = 2*in[i][WALL + a];
        EACH_NEIGHBOUR(o, in, i, j, x, r) {
            rho += ww*oracle_w(o, r);
            mean += ww*oracle_w(o, r)*in[j][PAYLOAD];
            tilt(o, (const row *)out, i, x, tilted);
            for (int a = 0; a < 3; a++) {
                double g = -gg*oracle_f(o, r)*x[a], own_g = -gg*oracle_f(o, r)*tilted[a];      /* V grad W */
                own[a] += own_g;
                rest += own_g*own_g;
                div -= g*x[a];
            }
        }
        mean /= rho + share;
        rho += oracle_fill(o, share);
        double e = rho - 1;
        out[i][RHO] = rho;
        out[i][MEAN] = mean;
        out[i][DIAG] = (own[0]*own[0] + own[1]*own[1] + own[2]*own[2] + rest)/o->rho0[o->fluid[i]];
        double still = pressure_of(&o->reference, &in[i][POS], 0), drop = 0;
        out[i][SURF] = div < o->surface_limit && still == 0 ? 1 + even : 0;
        if (share == 0 && out[i][SURF] == 0) out[i][PRES] += o->smooth*(mean - in[i][PAYLOAD]);
        e = e > 0 ? e : out[i][SURF] > 0 ? 0 : -e;
        t[0] += e;
        t[1] += out[i][SURF] > 0;
        t[2] += out[i][DIAG];
        t[3] += open > 0;
        for (int a = 0; a < 3; a++) drop += o->reference.down[a]*(in[i][POS + a] - o->reference.corner[a]);
        out[i][DROP] = open == 2 ? drop : 0;
        t[7] = fmax(t[7], out[i][DROP]);
        t[6] = fmax(t[6], e);
    }
}

static void laplacian(const oracle *o, const row *in, int i, int field, double l[3])
{
    l[0] = l[1] = l[2] = 0;
    EACH_NEIGHBOUR(o, in, i, j, x, r) {
        double f = o->volume*o->g_scale*oracle_f(o, r);
        (void)x;
        for (int a = 0; a < 3; a++) l[a] += f*(in[j][field + a] - in[i][field + a]);
    }
}

static void oracle_laplacian(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) laplacian(o, in, i, VEL, &out[i][ACC]), out[i][BAND] = 0;
}

/* Eq. (6b): 0 .. 1 by pressure, 1 from that of two spacings of depth on; none with (7b). */
static double wetness(const oracle *o, const row *in, int i)
{
    double g = sqrt(o->gravity[0]*o->gravity[0] + o->gravity[1]*o->gravity[1] + o->gravity[2]*o->gravity[2]);
    double p = in[i][PRES] + pressure_of(&o->reference, &in[i][POS], 0);
    if (o->along && in[i][WALLED] > 0) return 0;
    return fmin(fmax(p/(2*o->d*g*o->rho0[o->fluid[i]]), 0), 1);
}

/* u_tau^2/u of eq. (14) and (14b): the larger of nu/s and, by bisection of the law itself, that of
   u/u_tau = 8.3 (s u_tau/nu)^(1/7). */
static double wall_friction(double u, double s, double nu)
{
    double low = 0, high = u;
    if (!(u > 0)) return nu/s;
    for (int n = 0; n < 100; n++) {
        const double middle = 0.5*(low + high);
        if (8.3*pow(s*middle/nu, 1.0/7)*middle < u) low = middle;
        else high = middle;
    }
    return fmax(nu/s, low*low/u);
}

static double speed_along(const oracle *o, const row *in, int i, int plane)
{
    double square = 0;
    for (int a = 0; a < 3; a++)
        if (a != o->plane[plane].axis) square += pow(in[i][VEL + a] - o->plane[plane].velocity[a], 2);
    return sqrt(square);
}

/* Eq. (13), (14), (6). accel holds L v. */
static void oracle_kick(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double ll[3], add[3], nu = o->nu[o->fluid[i]];
        laplacian(o, in, i, ACC, ll);
        for (int a = 0; a < 3; a++)
            add[a] = felt_gravity(o, in, i, a) + 2*nu*in[i][ACC + a] - o->filter*ll[a];
        for (int k = 0; k < o->plane_count; k++) {
            double s = wall_distance(o, in, i, k);
            if (s >= o->h) continue;
            s = fmax(s, 0.25*o->d);
            double sigma = look_up(o, o->sigma, s);
            for (int a = 0; a < 3; a++)
                add[a] -= felt_gravity(o, in, i, a)*look_up(o, o->lambda, s)*
                          (a == o->plane[k].axis ? 1 : wetness(o, in, i));
            add[o->plane[k].axis] -= felt_gravity(o, in, i, o->plane[k].axis)*s*sigma;
            for (int a = 0; a < 3; a++)
                if (o->plane[k].no_slip && a != o->plane[k].axis)
                    add[a] -= 2*sigma*wall_friction(speed_along(o, in, i, k), s, nu)*
                              (in[i][VEL + a] - o->plane[k].velocity[a]);
        }
        for (int a = 0; a < 3; a++) out[i][VEL + a] += o->dt*add[a];
        out[i][WET] = wetness(o, in, i);
    }
}

static void oracle_kick_unfiltered(const oracle *o, const row *in, row *out, double *t)
{
    oracle without = *o;
    without.filter = 0;
    oracle_kick(&without, in, out, t);
}

/* Reaction of the pressure on planes, of the lift and of the friction. */
static void oracle_wall_force(const oracle *o, const row *in, row *out, double *t)
{
    (void)out;
    for (int i = 0; i < o->count; i++) {
        if (o->reference.push > 0) t[3] += find_reference_slope(o, &in[i][POS])/o->reference.push;
    }
    for (int i = 0; i < o->count; i++)
        for (int k = 0; k < o->plane_count; k++) {
            int axis = o->plane[k].axis;
            double s = wall_distance(o, in, i, k), g = look_up(o, o->sigma, s);
            if (s >= o->h) continue;
            for (int l = 0; l < o->plane_count; l++)
                if (l != k) g *= 1 - look_up(o, o->lambda, wall_distance(o, in, i, l));
            t[axis] -= 2*o->volume*(in[i][PRES] - in[i][CAPILLARY])*o->plane[k].sign*g;
            s = fmax(s, 0.25*o->d);
            double mass = o->volume*o->rho0[o->fluid[i]];
            t[axis] += mass*felt_gravity(o, in, i, axis)*s*look_up(o, o->sigma, s);
            for (int c = 0; c < 3; c++)
                t[c] += mass*felt_gravity(o, in, i, c)*look_up(o, o->lambda, s)*(c == axis ? 1 : in[i][WET]);
            if (!o->plane[k].no_slip) continue;
            for (int c = 0; c < 3; c++)
                if (c != axis)
                    t[c] += mass*2*look_up(o, o->sigma, s)*
                            wall_friction(speed_along(o, in, i, k), s, o->nu[o->fluid[i]])*
                            (in[i][VEL + c] - o->plane[k].velocity[c]);
        }
}

/* Eq. (12); capped speed, held 0.2 d from planes. */
static void oracle_advance(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++) {
        double speed2 = 0, slow = 1;
        for (int a = 0; a < 3; a++) speed2 += in[i][VEL + a]*in[i][VEL + a];
        t[7] = fmax(t[7], speed2);
        if (sqrt(speed2) > o->speed_cap) {
            slow = o->speed_cap/sqrt(speed2);
            t[4] += 1;
        }
        int lone = in[i][RHO] < o->volume*o->w_scale*oracle_w(o, 0) + 0.25;
        t[6] = fmax(t[6], speed2*slow*slow*(lone ? 0.4*0.4 : 1));
        for (int a = 0; a < 3; a++) {
            out[i][VEL + a] *= slow;
            out[i][POS + a] += o->dt*out[i][VEL + a] + o->dt*o->dt*in[i][ACC + a];
        }
        if (o->dimension == 2) out[i][POS + 2] = out[i][VEL + 2] = 0;
        for (int k = 0; k < o->plane_count; k++) {
            int a = o->plane[k].axis;
            double sign = o->plane[k].sign;
            if (sign*(out[i][POS + a] - o->plane[k].at) >= 0.2*o->d) continue;
            out[i][POS + a] = o->plane[k].at + sign*0.2*o->d;
            if (sign*out[i][VEL + a] >= 0) continue;
            t[0] += 1;
            t[1 + a] += o->volume*o->rho0[o->fluid[i]]*out[i][VEL + a];
            out[i][VEL + a] = 0;
        }
    }
}

/* Eq. (15): sum V grad W x (v_j - v_i). */
static void oracle_vorticity(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        for (int a = 0; a < 3; a++) out[i][ACC + a] = 0;
        EACH_NEIGHBOUR(o, in, i, j, x, r)
            for (int a = 0; a < 3; a++) {
                int b = (a + 1)%3, c = (a + 2)%3;
                double f = -o->volume*o->g_scale*oracle_f(o, r);
                out[i][ACC + a] += f*x[b]*(in[j][VEL + c] - in[i][VEL + c]);
                out[i][ACC + a] -= f*x[c]*(in[j][VEL + b] - in[i][VEL + b]);
            }
    }
}

#include "sph_pressure_oracle.h"
#include "sph_vessel_oracle.h"

/* e of eq. (23). */
static double density_error(const row *in, int i)
{
    const double e = in[i][RHO] - 1;
    return e > 0 ? fmin(e, 0.1) : in[i][SURF] > 0 ? 0 : fmax(e, -0.1);
}

/* Eq. (21), (21d), (22) of wcsph.md: Tait along the particle, and the damping of sound in the payload. */
static void oracle_tait(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++) {
        double rate = compression(o, in, i, VEL, in[i][FLUX]);
        double asked = (in[i][PRES] - o->recovery_pressure)/(o->exponent*o->stiffness);
        double more = o->recovery*(density_error(in, i) - asked);
        double p = in[i][PRES] + o->dt*o->exponent*(in[i][PRES] + o->stiffness)*(rate + more);
        double push = p + o->damping*rate;
        if (in[i][SURF] > 0) p = fmax(p, fmin(in[i][CAPILLARY], 0));
        if (in[i][SURF] > 0) push = fmax(push, fmin(in[i][CAPILLARY], 0));
        if (in[i][DIAG] <= o->isolated) p = push = 0;
        out[i][PRES] = p;
        out[i][DAMPED] = out[i][PAYLOAD] = push;
        t[0] += fabs(rate);
        t[1] += fabs(p);
        t[6] = fmax(t[6], fabs(rate));
    }
}

/* Eq. (23). */
static void oracle_relax(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double e = density_error(in, i);
        out[i][PAYLOAD] = in[i][DIAG] > o->isolated ? o->relaxation*e/(o->dt*o->dt*in[i][DIAG]) : 0;
    }
}

/* Without outlets nothing; with them: test_sph_oracle.c. */
static void oracle_relax_outlet(const oracle *o, const row *in, row *out, double *t)
{
    (void)o;
    (void)in;
    (void)out;
    (void)t;
}

/* Eq. (31), (32) of surface_tension.md. */
static void oracle_normal(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double size = 0;
        for (int c = 0; c < 3; c++) out[i][ACC + c] = in[i][WALL + c];
        EACH_NEIGHBOUR(o, in, i, j, x, r)
            for (int c = 0; c < 3; c++) out[i][ACC + c] -= o->volume*o->g_scale*oracle_f(o, r)*x[c];
        for (int c = 0; c < 3; c++) size += out[i][ACC + c]*out[i][ACC + c];
        double band = sqrt(size)/(2.5*o->surface_gradient) - 0.2;
        out[i][BAND] = in[i][SURF] > 0 ? fmax(band, 0) : 0;
    }
}

/* Eq. (33), (36). */
static void oracle_smooth_normal(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double n[3], size = 0, whole = oracle_w(o, 0)*in[i][BAND];
        for (int c = 0; c < 3; c++) n[c] = -whole*in[i][ACC + c];
        EACH_NEIGHBOUR(o, in, i, j, x, r)
            for (int c = 0; c < 3; c++) n[c] -= oracle_w(o, r)*in[j][BAND]*in[j][ACC + c];
        for (int c = 0; c < 3; c++) size += n[c]*n[c];
        for (int c = 0; c < 3; c++) n[c] = size > 0 ? n[c]/sqrt(size) : 0;
        for (int k = 0; k < o->plane_count && size > 0; k++) {
            int axis = o->plane[k].axis;
            double along = 1 - n[axis]*n[axis];
            if (wall_distance(o, in, i, k) >= 1.5*o->d || along <= 1e-6) continue;
            for (int c = 0; c < 3; c++) n[c] *= sin(o->contact)/sqrt(along);
            n[axis] = o->plane[k].sign*cos(o->contact);
        }
        for (int c = 0; c < 3; c++) out[i][NORMAL + c] = n[c];
        out[i][NORMAL_BAND] = in[i][BAND];
    }
}

/* Eq. (34), (35). */
static void oracle_curvature(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double turn = 0, area = 0, weight = 0, depth = 0, kappa = 0;
        EACH_NEIGHBOUR(o, in, i, j, x, r) {
            double own = 0, other = 0, b = in[j][NORMAL_BAND]*oracle_f(o, r);
            for (int c = 0; c < 3; c++) {
                own += in[i][NORMAL + c]*x[c];
                other += in[j][NORMAL + c]*x[c];
            }
            turn += b*(own - other);
            area += b*(r*r - pow((own + other)/2, 2));
            depth += b*(own + other)/2;
            weight += b;
        }
        if (area > 0 && in[i][NORMAL_BAND] > 0) {
            kappa = fmax(fmin(turn/area, 0.7/o->d), -0.7/o->d);
            kappa *= (o->dimension - 1)/(1 + kappa*(o->band_depth - depth/weight/2));
        }
        out[i][PAYLOAD] = kappa;
    }
}

/* Eq. (30), (37). */
static void oracle_tension(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double weight = 0, sum = 0, p;
        EACH_NEIGHBOUR(o, in, i, j, x, r) {
            double b = oracle_w(o, r)*in[j][NORMAL_BAND];
            weight += b;
            sum += b*in[j][PAYLOAD];
        }
        p = in[i][NORMAL_BAND] > 0 ? in[i][PAYLOAD] : weight > 0 ? sum/weight : 0;
        p *= o->tension[o->fluid[i]];
        out[i][CAPILLARY] = p;
        for (int c = 0; c < 3; c++) out[i][VEL + c] += o->dt*2*p*in[i][ACC + c]/o->rho0[o->fluid[i]];
    }
}

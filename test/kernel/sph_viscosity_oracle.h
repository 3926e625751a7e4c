/* Implicit viscosity (docs/theory/viscosity.md) for test_sph_oracle.c: sums over all pairs in double. */
#pragma once
#include "kernel/sph_oracle.h"

static double viscosity_of(const oracle *o, const row *in, int i)
{
    (void)o;
    return in[i][APPARENT];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int c = 0; c < 3; c++) out[c] = a[(c + 1)%3]*b[(c + 2)%3] - a[(c + 2)%3]*b[(c + 1)%3];
}

static double pair_weight(const oracle *o, const row *in, int i, int j, double r)
{
    const double a = viscosity_of(o, in, i), b = viscosity_of(o, in, j);
    return 4*o->volume*o->g_scale*oracle_f(o, r)*2*a*b/(a + b);
}

/* Distance from a no-slip plane in reach, 0: none; and sigma there. */
static double no_slip_distance(const oracle *o, const row *in, int i, int k, double *sigma)
{
    const double s = fmax(wall_distance(o, in, i, k), 0.25*o->d);
    if (!o->plane[k].no_slip || s >= o->h) return 0;
    *sigma = look_up(o, o->sigma, s);
    return s;
}

/* The sums of eq. (6b). */
static void oracle_strain(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        const double *w = &in[i][VISCOUS];
        double m[6] = {0}, g[3][3] = {{0}};
        EACH_NEIGHBOUR(o, in, i, j, x, r) {
            const double f = o->volume*o->g_scale*oracle_f(o, r);
            for (int a = 0; a < 3; a++) {
                m[a] += f*x[a]*x[a];
                m[3 + a] += f*x[a]*x[(a + 1)%3];
                for (int b = 0; b < 3; b++) g[a][b] += f*(w[a] - in[j][VISCOUS + a])*x[b];
            }
        }
        for (int k = 0; k < o->plane_count; k++) {
            const int c = o->plane[k].axis;
            double sigma, s = no_slip_distance(o, in, i, k, &sigma);
            if (!(s > 0)) continue;
            m[c] += sigma*s;
            for (int a = 0; a < 3; a++)
                g[a][c] += sigma*o->plane[k].sign*(w[a] - (double)o->plane[k].velocity[a]);
        }
        memcpy(&out[i][TURNING], m, sizeof m);
        out[i][LACK + 2] = out[i][LACK + 3] = 0;
        memcpy(&out[i][VISCOUS_DIRECTION], g[0], sizeof g[0]);
        memcpy(&out[i][VISCOUS_PRODUCT], g[1], sizeof g[1]);
        memcpy(&out[i][VISCOUS_RESIDUAL], g[2], sizeof g[2]);
    }
}

/* Eq. (6), (6b), by elimination. */
static void oracle_apparent(const oracle *o, const row *in, row *out, double *t)
{
    static const int place[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    (void)t;
    for (int i = 0; i < o->count; i++) {
        const double *m6 = &in[i][TURNING], least = 1e-4*(m6[0] + m6[1] + m6[2]) + 1e-30;
        const int f = o->fluid[i];
        double m[3][6], square = 0, trace = 0;
        for (int a = 0; a < 3; a++) {
            for (int b = 0; b < 3; b++) m[a][b] = m6[place[a][b]] + (a == b ? least : 0);
            m[a][3] = in[i][VISCOUS_DIRECTION + a];
            m[a][4] = in[i][VISCOUS_PRODUCT + a];
            m[a][5] = in[i][VISCOUS_RESIDUAL + a];
        }
        if (o->dimension == 2) m[2][2] = 1;
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                for (int c = 5; a != b && c >= a; c--) m[b][c] -= m[b][a]/m[a][a]*m[a][c];
        for (int a = 0; a < 3; a++) trace += m[a][3 + a]/m[a][a];
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) {
                const double mean = 0.5*(m[b][3 + a]/m[b][b] + m[a][3 + b]/m[a][a]);
                const double strain = mean - (a == b ? trace/3 : 0);
                square += 2*strain*strain;
            }
        const double faster = sqrt(square + o->creep_rate[f]*o->creep_rate[f]);
        const double eddy = o->rho0[f]*pow(o->smagorinsky[f]*o->d, 2)*sqrt(square);
        out[i][SHEAR_RATE] = sqrt(square);
        out[i][APPARENT] = o->nu[f]*o->rho0[f]*pow(faster, o->flow_index[f] - 1) +
                           o->yield_stress[f]/faster + eddy;
    }
}

/* J of the pairs, of sums of V F, and N of the planes. */
static void oracle_viscous_shape(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        const double share = 1/(4*viscosity_of(o, in, i));
        double j6[6] = {0}, n[3] = {0};
        memset(&out[i][SPREAD], 0, 8*sizeof(double));
        EACH_NEIGHBOUR(o, in, i, j, x, r) {
            const double f = share*pair_weight(o, in, i, j, r);
            for (int a = 0; a < 3; a++) {
                j6[a] += f*(r*r - x[a]*x[a]);
                j6[3 + a] -= f*x[a]*x[(a + 1)%3];
            }
            for (int a = 0; a < 3; a++) {
                const double even = o->volume*o->g_scale*oracle_f(o, r)*x[a];
                out[i][SPREAD + a] += even*x[a];
                out[i][SLANT + a] += even*x[(a + 1)%3];
            }
        }
        for (int k = 0; k < o->plane_count; k++) {
            double sigma, s = no_slip_distance(o, in, i, k, &sigma);
            if (s > 0) n[o->plane[k].axis] += s*sigma;
        }
        memcpy(&out[i][TURNING], j6, sizeof j6);
        out[i][LACK + 2] = 0;
        out[i][LACK + 3] = 0;
        for (int c = 0; c < 3; c++) {
            out[i][VISCOUS_DIRECTION + c] = n[c];
            out[i][VISCOUS_PRODUCT + c] = 0;
        }
    }
}

/* Eq. (3b): by the parts without trace of a sum of x x and of N, both xx, yy, zz, xy, yz, zx. */
static double find_lacks(const oracle *o, const double m[6], const double n[6])
{
    const double walls = n[0] + n[1] + n[2], all = m[0] + m[1] + m[2];
    double both = 0, square = 0;
    for (int c = 0; c < 6; c++) {
        const int diagonal = c < 3, inside = c < o->dimension || !diagonal;
        const double part = inside ? n[c] - diagonal*walls/o->dimension : 0;
        square += (diagonal ? 1 : 2)*part*part;
        both -= (diagonal ? 1 : 2)*part*(m[c] - diagonal*all/o->dimension);
    }
    if (!(walls > 0)) return 0;
    return square > 1e-4*walls*walls ? fmin(fmax(both/square, 0), 2) : 1;
}

static void eliminate(double m[3][4], double x[3])
{
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            for (int c = 3; a != b && c >= a; c--) m[b][c] -= m[b][a]/m[a][a]*m[a][c];
    for (int a = 0; a < 3; a++) x[a] = m[a][3]/m[a][a];
}

/* Where row a, column b stands in xx, yy, zz, xy, yz, zx. */
static const int six[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

/* scale m^-1, a column at a time. */
static void invert6(const double m[6], double scale, double out[6])
{
    for (int c = 0; c < 3; c++) {
        double rows[3][4], column[3];
        for (int k = 0; k < 3; k++) {
            for (int l = 0; l < 3; l++) rows[k][l] = m[six[k][l]];
            rows[k][3] = k == c ? scale : 0;
        }
        eliminate(rows, column);
        for (int k = 0; k < 3; k++) out[six[k][c]] = column[k];
    }
}

/* r, s of eq. (2c), the inverse of J with both; the root of beta s m/dim times A of (2b). */
static void oracle_viscous_close(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        const double *j = &in[i][TURNING], trace = 0.5*(j[0] + j[1] + j[2]);
        double n[6], m[6], bare[6], turning[6], fitted[6];
        for (int c = 0; c < 3; c++) {
            n[c] = in[i][VISCOUS_DIRECTION + c];
            n[3 + c] = in[i][VISCOUS_PRODUCT + c];
            bare[c] = in[i][SPREAD + c];
            bare[3 + c] = in[i][SLANT + c];
        }
        for (int c = 0; c < 6; c++) m[c] = (c < 3 ? trace : 0) - j[c];
        const double walls = n[0] + n[1] + n[2], even = bare[0] + bare[1] + bare[2], r = find_lacks(o, m, n);
        const double whole = (even + o->moment_lattice*find_lacks(o, bare, n)*walls)/o->dimension;
        const double scale = even > 0 ? 1/fmax(whole, 0.4) : 0;
        for (int c = 0; c < 6; c++)
            turning[c] = scale*j[c] + (c < 3 ? r*walls + 2e-6*trace : 0) - r*n[c];
        const double half = 0.5*(turning[0] + turning[1] + turning[2]), mean = half/o->dimension;
        for (int c = 0; c < 6; c++) fitted[c] = (c < 3 ? half + 0.3*mean : 0) - turning[c];
        if (o->dimension < 3) fitted[2] = 1;
        memset(&out[i][TURNING], 0, sizeof turning);
        memset(&out[i][FIT], 0, sizeof fitted);
        if (scale > 0) {
            invert6(turning, 1, &out[i][TURNING]);
            invert6(fitted, 1.3*scale*sqrt(8*mean/o->dimension), &out[i][FIT]);
        }
        if (o->dimension < 3) out[i][FIT + 2] = 0;
        out[i][LACK + 2] = r;
        out[i][LACK + 3] = out[i][PAYLOAD] = scale;
    }
}

/* Eq. (2), (2b), (3b). */
static void oracle_viscous_spin(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        const double share = 1/(4*viscosity_of(o, in, i)), *w = &in[i][VISCOUS], *fit = &in[i][FIT];
        double sum[3] = {0}, alpha = 0;
        EACH_NEIGHBOUR(o, in, i, j, x, r) {
            double difference[3], turn[3];
            const double f = share*pair_weight(o, in, i, j, r);
            for (int c = 0; c < 3; c++) difference[c] = w[c] - in[j][VISCOUS + c];
            cross(x, difference, turn);
            for (int c = 0; c < 3; c++) sum[c] += in[i][LACK + 3]*f*turn[c];
            for (int k = 0; k < 9; k++) alpha += f*difference[k/3]*fit[six[k/3][k%3]]*x[k%3];
        }
        for (int k = 0; k < o->plane_count; k++) {
            double sigma, slip[3], pulled[3], normal[3] = {0};
            if (!(no_slip_distance(o, in, i, k, &sigma) > 0)) continue;
            normal[o->plane[k].axis] = o->plane[k].sign;
            for (int c = 0; c < 3; c++) slip[c] = (double)o->plane[k].velocity[c] - w[c];
            cross(normal, slip, pulled);
            for (int c = 0; c < 3; c++) sum[c] -= in[i][LACK + 2]*sigma*pulled[c];
        }
        for (int a = 0; a < 3; a++) {
            out[i][ACC + a] = 0;
            for (int b = 0; b < 3; b++) out[i][ACC + a] += in[i][TURNING + six[a][b]]*sum[b];
            out[i][SPREAD + a] = alpha*fit[a];
            out[i][SLANT + a] = alpha*fit[3 + a];
        }
        out[i][BAND] = w[0]; out[i][SPREAD + 3] = w[1]; out[i][SLANT + 3] = w[2];
    }
}

/* Eq. (3): on i at w. */
static void plane_friction(const oracle *o, const row *in, int i, double force[3], double own[3])
{
    const double lack = in[i][LACK + 2];
    for (int k = 0; k < o->plane_count; k++) {
        double sigma, swung[3], normal[3] = {0};
        const double s = no_slip_distance(o, in, i, k, &sigma);
        if (!(s > 0)) continue;
        const double rate = 2*viscosity_of(o, in, i)*sigma/s;
        normal[o->plane[k].axis] = o->plane[k].sign;
        cross(&in[i][ACC], normal, swung);
        for (int c = 0; c < 3; c++) {
            if (c == o->plane[k].axis) continue;
            const double slip = (double)o->plane[k].velocity[c] - in[i][VISCOUS + c];
            force[c] += rate*((1 + 0.5*lack)*slip + lack*s*swung[c]);
            own[c] += rate*(1 + 0.5*lack);
        }
    }
}

/* Eq. (1), (3): the force per volume on i, w any field and accel its rotations; and what (3) and the first
   term of (1) are of w_i. */
static void viscous_force(const oracle *o, const row *in, int i, double force[3], double own[3])
{
    for (int c = 0; c < 3; c++) force[c] = own[c] = 0;
    EACH_NEIGHBOUR(o, in, i, j, x, r) {
        double spin[3], turn[3];
        const double f = pair_weight(o, in, i, j, r), a = 0.5*in[i][LACK + 3], b = 0.5*in[j][PAYLOAD];
        for (int c = 0; c < 3; c++) spin[c] = a*in[i][ACC + c] + b*in[j][ACC + c];
        cross(spin, x, turn);
        for (int c = 0; c < 3; c++) {
            double spread = 0;
            for (int k = 0; k < 3; k++)
                spread += (six[c][k] < 3 ? in[i][SPREAD + c] + in[j][SPREAD + c] :
                           in[i][SLANT + six[c][k] - 3] + in[j][SLANT + six[c][k] - 3])*x[k];
            force[c] += f*((a + b)*(in[j][VISCOUS + c] - in[i][VISCOUS + c]) + turn[c] - spread);
            own[c] += f*(a + b);
        }
    }
    plane_friction(o, in, i, force, own);
}

/* What the last term of (1) is of w_i, in direction c. */
static double own_spread(const oracle *o, const row *in, int i, int c)
{
    double all = 0, sum = 0;
    EACH_NEIGHBOUR(o, in, i, j, x, r) {
        double their = 0;
        for (int k = 0; k < 3; k++) {
            const double f = pair_weight(o, in, i, j, r)*x[k];
            their += f*in[j][FIT + six[c][k]];
            sum += f*in[i][FIT + six[c][k]];
        }
        all += their*their;
    }
    return (all + sum*sum)/(4*viscosity_of(o, in, i));
}

static void oracle_viscous_rows(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double force[3], own[3], rho = o->rho0[o->fluid[i]];
        viscous_force(o, in, i, force, own);
        for (int c = 0; c < 3; c++) {
            out[i][VISCOUS_RESIDUAL + c] = rho*(in[i][VEL + c] - in[i][VISCOUS + c]) + o->dt*force[c];
            out[i][VISCOUS_INVERSE + c] = 1/(rho + o->dt*(own[c] + own_spread(o, in, i, c)));
        }
    }
}

static void oracle_viscous_product(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double force[3], own[3];
        viscous_force(o, in, i, force, own);
        for (int c = 0; c < 3; c++)
            out[i][VISCOUS_PRODUCT + c] = o->rho0[o->fluid[i]]*in[i][VISCOUS + c] - o->dt*force[c];
    }
}

static void oracle_viscous_expect(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++)
        for (int c = 0; c < 3; c++)
            out[i][VISCOUS_EXPECTED + c] = in[i][VEL + c] - in[i][VISCOUS_EXPECTED + c];
}

static void oracle_viscous_measure(const oracle *o, const row *in, row *out, double *t)
{
    (void)out;
    for (int i = 0; i < o->count; i++)
        for (int c = 0; c < 3; c++) {
            const double r = in[i][VISCOUS_RESIDUAL + c];
            t[0] += r*r*in[i][VISCOUS_INVERSE + c];
            t[1] += pow(r/o->rho0[o->fluid[i]], 2);
            t[2] += pow(in[i][VEL + c], 2);
        }
}

static void oracle_viscous_turn(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++)
        for (int c = 0; c < 3; c++)
            out[i][VISCOUS_DIRECTION + c] = in[i][VISCOUS_INVERSE + c]*in[i][VISCOUS_RESIDUAL + c] +
                                            o->beta*in[i][VISCOUS_DIRECTION + c];
}

static void oracle_viscous_curve(const oracle *o, const row *in, row *out, double *t)
{
    (void)out;
    for (int i = 0; i < o->count; i++)
        for (int c = 0; c < 3; c++) t[0] += in[i][VISCOUS_DIRECTION + c]*in[i][VISCOUS_PRODUCT + c];
}

static void oracle_viscous_advance(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++)
        for (int c = 0; c < 3; c++) {
            out[i][VISCOUS + c] += o->alpha*in[i][VISCOUS_DIRECTION + c];
            out[i][VISCOUS_RESIDUAL + c] -= o->alpha*in[i][VISCOUS_PRODUCT + c];
        }
    oracle_viscous_measure(o, (const row *)out, out, t);
}

static void oracle_viscous_finish(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++) {
        for (int c = 0; c < 3; c++)
            out[i][VEL + c] = in[i][VISCOUS + c] + in[i][VISCOUS_RESIDUAL + c]/o->rho0[o->fluid[i]] -
                              in[i][VISCOUS_EXPECTED + c];
        double force[3] = {0}, own[3] = {0};
        plane_friction(o, in, i, force, own);
        for (int c = 0; c < 3; c++) t[c] -= o->dt*o->volume*force[c];
    }
}

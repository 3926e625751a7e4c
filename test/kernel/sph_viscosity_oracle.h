/* Implicit viscosity (docs/theory/viscosity.md) for test_sph_oracle.c: sums over all pairs in double. */
#pragma once
#include "kernel/sph_oracle.h"

static double viscosity_of(const oracle *o, const row *in, int i)
{
    (void)in;
    (void)i;
    return o->nu[0]*o->rho0[0];                       /* the rig has one viscosity where phases are absent */
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int c = 0; c < 3; c++) out[c] = a[(c + 1)%3]*b[(c + 2)%3] - a[(c + 2)%3]*b[(c + 1)%3];
}

static double pair_weight(const oracle *o, const row *in, int i, int j, double r)
{
    return 4*o->volume*o->g_scale*oracle_f(o, r)*0.5*(viscosity_of(o, in, i) + viscosity_of(o, in, j));
}

/* Eq. (2), by elimination. */
static void oracle_viscous_spin(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double m[3][4] = {{0}}, trace = 0, along = 0;
        EACH_NEIGHBOUR(o, in, i, j, x, r) {
            double w[3], turn[3];
            const double f = pair_weight(o, in, i, j, r);
            for (int c = 0; c < 3; c++) w[c] = in[i][VISCOUS + c] - in[j][VISCOUS + c];
            cross(x, w, turn);
            for (int a = 0; a < 3; a++) {
                m[a][3] += f*turn[a];
                for (int b = 0; b < 3; b++) m[a][b] += f*((a == b)*r*r - x[a]*x[b]);
            }
            for (int c = 0; c < 3; c++) along += f*w[c]*x[c];
            trace += f*r*r;
        }
        for (int a = 0; a < 3; a++) m[a][a] += 1e-6*trace;
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                for (int c = 3; a != b && c >= a; c--) m[b][c] -= m[b][a]/m[a][a]*m[a][c];
        for (int a = 0; a < 3; a++) out[i][ACC + a] = trace > 0 ? m[a][3]/m[a][a] : 0;
        out[i][BAND] = trace > 0 ? along/trace : 0;
    }
}

/* Eq. (1), (3): the force per volume on i, w any field and accel its rotations; and what that is of w_i. */
static void viscous_force(const oracle *o, const row *in, int i, int moving, double force[3], double own[3])
{
    for (int c = 0; c < 3; c++) force[c] = own[c] = 0;
    EACH_NEIGHBOUR(o, in, i, j, x, r) {
        double spin[3], turn[3];
        const double f = pair_weight(o, in, i, j, r);
        for (int c = 0; c < 3; c++) spin[c] = 0.5*(in[i][ACC + c] + in[j][ACC + c]);
        cross(spin, x, turn);
        for (int c = 0; c < 3; c++) {
            force[c] += f*(in[j][VISCOUS + c] - in[i][VISCOUS + c] + turn[c] -
                           8*(in[i][BAND] + in[j][BAND])*x[c]);
            own[c] += f;
        }
    }
    for (int k = 0; k < o->plane_count; k++) {
        const double s = fmax(wall_distance(o, in, i, k), 0.25*o->d);
        if (!o->plane[k].no_slip || s >= o->h) continue;
        const double rate = 2*viscosity_of(o, in, i)*look_up(o, o->sigma, s)/s;
        for (int c = 0; c < 3; c++) {
            if (c == o->plane[k].axis) continue;
            force[c] += rate*(moving*(double)o->plane[k].velocity[c] - in[i][VISCOUS + c]);
            own[c] += rate;
        }
    }
}

static void oracle_viscous_rows(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double force[3], own[3], rho = o->rho0[o->fluid[i]];
        viscous_force(o, in, i, 1, force, own);
        for (int c = 0; c < 3; c++) {
            out[i][VISCOUS_RESIDUAL + c] = rho*(in[i][VEL + c] - in[i][VISCOUS + c]) + o->dt*force[c];
            out[i][VISCOUS_INVERSE + c] = 1/(rho + o->dt*own[c]);
        }
    }
}

static void oracle_viscous_product(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double force[3], own[3];
        viscous_force(o, in, i, 0, force, own);
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
        for (int k = 0; k < o->plane_count; k++) {
            const double s = fmax(wall_distance(o, in, i, k), 0.25*o->d);
            if (!o->plane[k].no_slip || s >= o->h) continue;
            for (int c = 0; c < 3; c++)
                if (c != o->plane[k].axis)
                    t[c] += o->dt*o->volume*2*viscosity_of(o, in, i)*look_up(o, o->sigma, s)/s*
                            (in[i][VISCOUS + c] - (double)o->plane[k].velocity[c]);
        }
    }
}

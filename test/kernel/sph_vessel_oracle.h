/* The kernels of full vessels and of the reference pressure for sph_oracle.h, which includes this after what
   both use. */
#pragma once

/* Half a step times tr(grad v grad v), eq. (10d). */
static void oracle_midway(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double g[3][3] = {{0}}, sum = 0;
        EACH_NEIGHBOUR(o, in, i, j, x, r) {
            double own[3];
            double f = o->volume*o->g_scale*oracle_f(o, r);
            tilt(o, in, i, x, own);
            for (int a = 0; a < 9; a++) g[a/3][a%3] += f*own[a/3]*(in[i][VEL + a%3] - in[j][VEL + a%3]);
        }
        for (int a = 0; a < 9; a++) sum += g[a/3][a%3]*g[a%3][a/3];
        out[i][MIDWAY] = o->dt/2*sum;
    }
}

/* c of eq. (13b): M^-1 times the sum of V F x_ji. */
static void oracle_moment(const oracle *o, const row *in, row *out, int i)
{
    double m[3][3] = {{0}}, sum[3] = {0}, c[3], size = 0;
    EACH_NEIGHBOUR(o, in, i, j, x, r) {
        double f = o->volume*o->g_scale*oracle_f(o, r);
        for (int a = 0; a < 9; a++) m[a/3][a%3] += f*x[a/3]*x[a%3];
        for (int a = 0; a < 3; a++) sum[a] -= f*x[a];
    }
    if (o->dimension == 2) m[2][2] = 1;
    int exists = oracle_inverse(m) > 1e-3;
    for (int a = 0; a < 3; a++) {
        c[a] = exists ? m[a][0]*sum[0] + m[a][1]*sum[1] + m[a][2]*sum[2] : 0;
        size += c[a]*c[a];
    }
    double cut = fmin(1, 3/(o->h*fmax(sqrt(size), 1e-30)));
    for (int a = 0; a < 3; a++) out[i][MOMENT + a] = cut*c[a];
}

/* The weight of neighbour j in L' at i, eq. (13b). */
static double weigh_by_moment(const oracle *o, const row *in, int i, const double x[3], double r, double side)
{
    double c[3] = {in[i][MOMENT], in[i][MOMENT + 1], in[i][MOMENT + 2]};
    return o->volume*o->g_scale*oracle_f(o, r)*(1 + side*(c[0]*x[0] + c[1]*x[1] + c[2]*x[2]));
}

static void oracle_filter(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double all = 0;
        for (int a = 0; a < 3; a++) out[i][ACC + a] = 0;
        EACH_NEIGHBOUR(o, in, i, j, x, r) {
            all += o->volume*o->g_scale*oracle_f(o, r);
            for (int a = 0; a < 3; a++)
                out[i][ACC + a] += weigh_by_moment(o, in, i, x, r, 1)*(in[j][VEL + a] - in[i][VEL + a]);
        }
        out[i][BAND] = fmin(1, pow(1.15*o->rate/fmax(all, 1e-30), 1.5));
        for (int a = 0; a < 3; a++) out[i][ACC + a] *= out[i][BAND];
    }
}

/* R = -S L S L' v, S in the last component. */
static void oracle_filter_compare(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double ll[3];
        laplacian(o, in, i, ACC, ll);
        for (int a = 0; a < 3; a++) out[i][ROUGH + a] = -in[i][BAND]*ll[a];
    }
}

/* v -= dt k times the transpose of L', on R. */
static void oracle_filter_kick(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++)
        EACH_NEIGHBOUR(o, in, i, j, x, r)
            for (int a = 0; a < 3; a++)
                out[i][VEL + a] -= o->dt*o->filter*(weigh_by_moment(o, in, j, x, r, -1)*in[j][ROUGH + a] -
                                                    weigh_by_moment(o, in, i, x, r, 1)*in[i][ROUGH + a]);
}

/* Eq. (21c). */
static void oracle_rest(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        const double *x = &in[i][POS];
        double depth = -o->reference.level;
        for (int a = 0; a < 3; a++) depth += o->reference.down[a]*(x[a] - o->reference.corner[a]);
        double all = o->reference.push*fmax(depth, 0);
        out[i][PRES] = out[i][PAYLOAD] = all - pressure_of(&o->reference, x, 0);
    }
}

/* Eq. (21b): the reference at the particle's place before and after its way. */
static void oracle_carry(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        const double *x = &in[i][POS], *u = &in[i][VEL];
        const double slope = find_reference_slope(o, x),
                     gain = pressure_of(&o->reference, x, 0) - pressure_of(&o->reference_before, x, 0);
        double sink = 0;
        for (int a = 0; a < 3; a++)
            sink += (slope*o->reference.down[a] + o->rho0[o->fluid[i]]*o->removed_gravity[a])*u[a];
        out[i][PRES] -= gain + o->dt*sink;
    }
}

/* The kernels of the pressure equation for sph_oracle.h, which includes this after what both use. */
#pragma once

/* Eq. (8) for the payload. */
static void pressure_accel(const oracle *o, const row *in, int i, double a[3])
{
    double p = in[i][PAYLOAD];
    for (int c = 0; c < 3; c++) a[c] = 2*p*in[i][WALL + c];
    EACH_NEIGHBOUR(o, in, i, j, x, r) {
        double own[3], other[3];
        tilt(o, in, i, x, own);
        tilt(o, in, j, x, other);
        for (int c = 0; c < 3; c++)
            a[c] += (p*own[c] + in[j][PAYLOAD]*other[c])*-o->volume*o->g_scale*oracle_f(o, r);
    }
    for (int c = 0; c < 3; c++) a[c] /= -o->rho0[o->fluid[i]];
}

static void oracle_pressure_accel(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) pressure_accel(o, in, i, &out[i][ACC]);
}

static void oracle_pressure_kick(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++) {
        double a[3];
        pressure_accel(o, in, i, a);
        for (int c = 0; c < 3; c++) out[i][VEL + c] += o->dt*a[c];
        t[0] += o->rho0[o->fluid[i]]*sqrt(a[0]*a[0] + a[1]*a[1] + a[2]*a[2]);
    }
}

/* Eq. (12) over dt^2: the pressure acceleration with the background, and the core of pairs. */
static void oracle_shift(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double rho = o->rho0[0], b = 2*o->background;      /* all fluids shift alike */
        pressure_accel(o, in, i, &out[i][ACC]);
        for (int c = 0; c < 3; c++) out[i][ACC + c] -= b*in[i][WALL + c]/rho;
        EACH_NEIGHBOUR(o, in, i, j, x, r) {
            double overlap = fmax(o->core/(r + 1e-3*o->core) - 1, 0);
            for (int c = 0; c < 3; c++)
                out[i][ACC + c] += b*o->volume*o->g_scale*oracle_f(o, r)*x[c]/rho +
                                   o->push*overlap*x[c]/(o->dt*o->dt);
        }
    }
}

/* Eq. (7): C u; `flux` is G . u_wall. */
static double compression(const oracle *o, const row *in, int i, int field, double flux)
{
    double sum = -2*flux;
    for (int a = 0; a < 3; a++) sum += 2*in[i][WALL + a]*in[i][field + a];
    EACH_NEIGHBOUR(o, in, i, j, x, r) {
        double own[3];
        tilt(o, in, i, x, own);
        for (int a = 0; a < 3; a++)
            sum += -o->volume*o->g_scale*oracle_f(o, r)*own[a]*(in[i][field + a] - in[j][field + a]);
    }
    return sum;
}

/* Eq. (10g). */
static double compliance(const row *in, int i, double pressure)
{
    return in[i][SURF] == 2 && in[i][RHO] < 0.75 ? 0.05*in[i][DIAG]*pressure : 0;
}

/* Eq. (10), (10f). */
static void oracle_source(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++) {
        double s = (compression(o, in, i, VEL, in[i][FLUX]) + (o->along == 1 ? in[i][MIDWAY] : 0))/o->dt;
        if (in[i][SURF] == 2) s -= fmax(0, 1 - in[i][RHO])/(o->dt*o->dt);
        int active = in[i][DIAG] > o->isolated &&
                     (in[i][SURF] == 0 || s > 0 || in[i][PRES] > fmin(in[i][CAPILLARY], 0));
        out[i][PRE] = active ? 1/in[i][DIAG] : 0;
        out[i][RES] = active ? s : 0;
        out[i][PROD] = compliance(in, i, in[i][PRES]) - compression(o, in, i, ACC, 0);
        t[0] += out[i][RES]*out[i][RES]*out[i][PRE];
    }
}

static void oracle_product(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++) {
        out[i][PROD] = compliance(in, i, in[i][PAYLOAD]) - compression(o, in, i, ACC, 0);
        t[0] += out[i][PROD]*in[i][PAYLOAD];
        t[1] += out[i][PROD];
    }
}

/* The start of conjugate gradients: r, its norm, no change yet. */
static void begin_search(const row *in, row *out, int i, double r, int active, double *t)
{
    out[i][RES] = active ? r : 0;
    out[i][PRE] = active ? 1/in[i][DIAG] : 0;
    out[i][DELTA] = 0;
    t[0] += out[i][RES]*out[i][RES]*out[i][PRE];
    t[1] += fabs(out[i][RES]);
    t[2] += out[i][RES];
    t[6] = fmax(t[6], fabs(out[i][RES]));
}

static void oracle_warm_residual(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++)
        begin_search(in, out, i, in[i][RES] - in[i][PROD], in[i][PRE] > 0, t);
}

/* Eq. (11). */
static void oracle_density_residual(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++) {
        double e = in[i][RHO] - 1, surface = in[i][SURF];
        double pace = pressure_of(&o->reference, &in[i][POS], 0) > 0 ? 1 : 0.1;
        e = e >= 0 ? fmin(e, 0.1) : surface > 0 ? 0 : pace*fmax(e, -0.02);
        out[i][PRES] = 0;
        begin_search(in, out, i, e/(o->dt*o->dt), in[i][DIAG] > o->isolated && (surface == 0 || e > 0), t);
    }
}

static void oracle_cg_update(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++) {
        if (in[i][PRE] == 0) continue;
        out[i][DELTA] += o->alpha*in[i][PAYLOAD];
        out[i][RES] -= o->alpha*in[i][PROD];
        t[0] += out[i][RES]*out[i][RES]*in[i][PRE];
        t[1] += fabs(out[i][RES]);
        t[6] = fmax(t[6], fabs(out[i][RES]));
    }
}

/* Sum over the 4^dim nodes of the product of hat functions. */
static double oracle_coarse(const oracle *o, const row *in, int i)
{
    double sum = 0;
    for (int c = 0; c < (o->dimension == 3 ? 64 : 16); c++) {
        const int at[3] = {c%4, c/4%4, c/16};
        double hat = 1;
        for (int a = 0; a < o->dimension; a++) {
            double far = in[i][POS + a]*o->cells_per_metre[a] - at[a];
            if (o->periodic[a] && far > 2) far -= 4;
            hat *= fmax(0, 1 - fabs(far));
        }
        sum += hat*o->coarse[c];
    }
    return sum;
}

static void oracle_cg_direction(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++) {
        double z = in[i][RES]*in[i][PRE] + oracle_coarse(o, in, i);
        out[i][PAYLOAD] = in[i][PRE] > 0 ? z + o->beta*in[i][PAYLOAD] : 0;
        t[0] += out[i][PAYLOAD];
    }
}

static void oracle_center_direction(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) out[i][PAYLOAD] = in[i][PAYLOAD] - o->mean;
}

static void oracle_warm_start(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) {
        double gained = pressure_of(&o->reference, &in[i][POS], 0) -
                        pressure_of(&o->reference_before, &in[i][POS], 0);
        out[i][PRES] -= o->reference_before.push > 0 ? gained : 0;
        if (in[i][DIAG] <= o->isolated) out[i][PRES] = 0;
        else if (in[i][SURF] > 0) out[i][PRES] = fmax(out[i][PRES], fmin(in[i][CAPILLARY], 0));
        out[i][PAYLOAD] = out[i][PRES];
    }
}

static void oracle_center_residual(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++) begin_search(in, out, i, in[i][RES] - o->mean, in[i][PRE] > 0, t);
}

static void oracle_center_product(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++) {
        out[i][PROD] = in[i][PROD] - o->mean;
        t[0] += out[i][PROD]*in[i][PAYLOAD];
    }
}

static void oracle_hold(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++) {
        double p = in[i][PRES] + in[i][DELTA], least = fmin(in[i][CAPILLARY], 0);
        int pulls = in[i][SURF] > 0 && in[i][PRE] > 0 && p < least;
        out[i][PAYLOAD] = pulls ? least - p : 0;
        if (pulls) {
            out[i][DELTA] = least - in[i][PRES];
            out[i][PRE] = out[i][RES] = 0;
        }
        t[0] += out[i][PAYLOAD];
        t[1] += fabs(p);
    }
}

static void oracle_correct_pressure(const oracle *o, const row *in, row *out, double *t)
{
    for (int i = 0; i < o->count; i++) {
        double p = in[i][PRES] + in[i][DELTA];
        if (in[i][SURF] > 0) p = fmax(p, fmin(in[i][CAPILLARY], 0));
        out[i][PRES] = out[i][PAYLOAD] = p;
        t[0] += fabs(p)/o->rho0[o->fluid[i]];
        t[1] += p;
    }
}

static void oracle_center_pressure(const oracle *o, const row *in, row *out, double *t)
{
    (void)t;
    for (int i = 0; i < o->count; i++) out[i][PRES] = out[i][PAYLOAD] = in[i][PRES] - o->mean;
}

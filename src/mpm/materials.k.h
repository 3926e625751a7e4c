/* Stress of the materials, eight particles at once. Equation numbers: docs/theory/mlsmpm.md.
   E = F - I carries small strains without loss. Every material but neo-Hookean and liquid needs the principal
   stretches; they come from b = F F^T (a symmetric eigenproblem, by Jacobi's rotations), which is enough:
   no rotation of F is ever needed. */
#pragma once
#include "exec/series.h"
#include "mpm/view.h"

/* Symmetric tensors: xx, yy, zz, xy, yz, zx. */
enum { MPM_XX, MPM_YY, MPM_ZZ, MPM_XY, MPM_YZ, MPM_ZX };

/* J - 1 of F = I + E. */
TOBI_FN lane mpm_dilation(const lane e[9])
{
    lane minors = (e[0]*e[4] - e[1]*e[3]) + (e[4]*e[8] - e[5]*e[7]) + (e[0]*e[8] - e[2]*e[6]);
    lane det = e[0]*(e[4]*e[8] - e[5]*e[7]) - e[1]*(e[3]*e[8] - e[5]*e[6]) + e[2]*(e[3]*e[7] - e[4]*e[6]);
    return (e[0] + e[4] + e[8]) + (minors + det);
}

/* b - I = E + E^T + E E^T, eq. (5). */
TOBI_FN void mpm_finger(const lane e[9], lane b[6])
{
    b[MPM_XX] = 2.0f*e[0] + (e[0]*e[0] + e[1]*e[1] + e[2]*e[2]);
    b[MPM_YY] = 2.0f*e[4] + (e[3]*e[3] + e[4]*e[4] + e[5]*e[5]);
    b[MPM_ZZ] = 2.0f*e[8] + (e[6]*e[6] + e[7]*e[7] + e[8]*e[8]);
    b[MPM_XY] = (e[1] + e[3]) + (e[0]*e[3] + e[1]*e[4] + e[2]*e[5]);
    b[MPM_YZ] = (e[5] + e[7]) + (e[3]*e[6] + e[4]*e[7] + e[5]*e[8]);
    b[MPM_ZX] = (e[2] + e[6]) + (e[0]*e[6] + e[1]*e[7] + e[2]*e[8]);
}

/* One rotation of Jacobi's method: makes a[pq] zero. r is the third index's place, v the columns p and q. */
TOBI_FN void mpm_rotate(lane *app, lane *aqq, lane *apq, lane *apr, lane *aqr, lane vp[3], lane vq[3])
{
    lane d = *aqq - *app, two = 2.0f**apq;
    lane sign = lane_where_less(d, lane_set(0), lane_set(-1), lane_set(1));
    lane t = sign*two/(sign*d + lane_sqrt(d*d + two*two) + 1e-30f);
    lane c = 1.0f/lane_sqrt(1.0f + t*t), s = t*c;
    *app = *app - t**apq;
    *aqq = *aqq + t**apq;
    *apq = lane_set(0);
    lane pr = *apr, qr = *aqr;
    *apr = c*pr - s*qr;
    *aqr = s*pr + c*qr;
    for (int k = 0; k < 3; k++) {
        lane a = vp[k], b = vq[k];
        vp[k] = c*a - s*b;
        vq[k] = s*a + c*b;
    }
}

/* Eigenvalues of a into a[0..2], eigenvectors into v[number][component]. Four sweeps reach float
   precision. */
TOBI_FN void mpm_eigen(lane a[6], lane v[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) v[i][k] = lane_set(i == k ? 1.0f : 0.0f);
    for (int sweep = 0; sweep < 4; sweep++) {
        mpm_rotate(&a[MPM_XX], &a[MPM_YY], &a[MPM_XY], &a[MPM_ZX], &a[MPM_YZ], v[0], v[1]);
        mpm_rotate(&a[MPM_YY], &a[MPM_ZZ], &a[MPM_YZ], &a[MPM_XY], &a[MPM_ZX], v[1], v[2]);
        mpm_rotate(&a[MPM_XX], &a[MPM_ZZ], &a[MPM_ZX], &a[MPM_XY], &a[MPM_YZ], v[0], v[2]);
    }
}

/* The symmetric tensor with these principal values. */
TOBI_FN void mpm_compose(const lane value[3], lane v[3][3], lane out[6])
{
    static const int row_of[6] = {0, 1, 2, 0, 1, 2}, column_of[6] = {0, 1, 2, 1, 2, 0};
    for (int k = 0; k < 6; k++)
        out[k] = value[0]*v[0][row_of[k]]*v[0][column_of[k]] + value[1]*v[1][row_of[k]]*v[1][column_of[k]] +
                 value[2]*v[2][row_of[k]]*v[2][column_of[k]];
}

/* F <- (V diag(1 + g) V^T) F: principal stretches times 1 + g. */
TOBI_FN void mpm_stretch(lane e[9], const lane g[3], lane v[3][3])
{
    lane s[6];
    mpm_compose(g, v, s);
    const int at[3][3] = {{MPM_XX, MPM_XY, MPM_ZX}, {MPM_XY, MPM_YY, MPM_YZ}, {MPM_ZX, MPM_YZ, MPM_ZZ}};
    for (int c = 0; c < 3; c++) {
        lane f[3] = {e[c], e[3 + c], e[6 + c]}, sum[3];
        f[c] = f[c] + 1.0f;
        for (int r = 0; r < 3; r++) sum[r] = s[at[r][0]]*f[0] + s[at[r][1]]*f[1] + s[at[r][2]]*f[2];
        for (int r = 0; r < 3; r++) e[3*r + c] = e[3*r + c] + sum[r];
    }
}

/* The parameters of eight particles. */
typedef struct mpm_parameters {
    lane mu, lambda, bulk, viscosity, yield, hardening, compression, stretch, friction, strength, brittleness;
    lane friction_rise, inertial_scale;    /* the latter times the time step of the strain, sqrt(Pa) */
} mpm_parameters;

/* Kirchhoff stress of the neo-Hookean solid, eq. (6): mu (b - I) + lambda ln J I. */
TOBI_FN void mpm_neo_hookean(const lane e[9], const mpm_parameters *m, lane tau[6])
{
    lane b[6], p = m->lambda*lane_log1p(mpm_dilation(e));
    mpm_finger(e, b);
    for (int k = 0; k < 6; k++) tau[k] = m->mu*b[k];
    for (int k = 0; k < 3; k++) tau[k] = tau[k] + p;
}

/* A liquid keeps only its dilation, in e[0]: Tait's pressure with exponent 7 and Newton's shear, eq. (7). */
TOBI_FN void mpm_liquid(lane e[9], const lane gradient[9], const mpm_parameters *m, lane tau[6])
{
    lane dilation = mpm_dilation(e), J = dilation + 1.0f;
    lane p = m->bulk*(1.0f/7)*(lane_exp(-7.0f*lane_log1p(dilation)) - 1.0f);
    lane trace = (gradient[0] + gradient[4] + gradient[8])*(1.0f/3), shear = 2.0f*m->viscosity*J;
    for (int k = 0; k < 9; k++) e[k] = lane_set(0);
    e[0] = dilation;
    for (int k = 0; k < 3; k++) tau[k] = shear*(gradient[4*k] - trace) - p*J;
    tau[MPM_XY] = shear*0.5f*(gradient[1] + gradient[3]);
    tau[MPM_YZ] = shear*0.5f*(gradient[5] + gradient[7]);
    tau[MPM_ZX] = shear*0.5f*(gradient[2] + gradient[6]);
}

/* Fixed corotated, eq. (8), by principal stretches: 2 mu (s^2 - s) + lambda (J - 1) J. */
TOBI_FN void mpm_fixed_corotated(const lane s1[3], lane dilation, lane mu, lane lambda, lane value[3])
{
    lane p = lambda*dilation*(dilation + 1.0f);
    for (int k = 0; k < 3; k++) value[k] = 2.0f*mu*s1[k]*(s1[k] + 1.0f) + p;
}

/* Snow (Stomakhin et al. 2013), eq. (9): stretches stay within limits, what is cut off hardens. state: J
   of the plastic part, less 1. */
TOBI_FN void mpm_snow(const mpm_parameters *m, lane s1[3], lane g[3], lane *state, lane *harder)
{
    lane plastic = *state + 1.0f;
    for (int k = 0; k < 3; k++) {
        lane low = -1.0f*m->compression, kept = lane_where_less(s1[k], low, low, s1[k]);
        kept = lane_where_less(m->stretch, kept, m->stretch, kept);
        g[k] = (kept - s1[k])/(1.0f + s1[k]);
        plastic = plastic/(1.0f + g[k]);
        s1[k] = kept;
    }
    plastic = lane_where_less(plastic, lane_set(0.6f), lane_set(0.6f), plastic);
    plastic = lane_where_less(lane_set(20), plastic, lane_set(20), plastic);
    *state = plastic - 1.0f;
    lane power = m->hardening*(1.0f - plastic);
    *harder = lane_exp(lane_where_less(lane_set(2), power, lane_set(2), power));
}

/* Von Mises with linear hardening on Hencky strains h, eq. (10), by radial return. state: plastic strain. */
TOBI_FN void mpm_von_mises(const mpm_parameters *m, lane h[3], lane *state)
{
    lane mean = (h[0] + h[1] + h[2])*(1.0f/3), d[3], norm = lane_set(1e-30f);
    for (int k = 0; k < 3; k++) {
        d[k] = h[k] - mean;
        norm = norm + d[k]*d[k];
    }
    norm = lane_sqrt(norm);
    lane over = 2.0f*m->mu*norm - 0.81649658f*(m->yield + m->hardening**state);
    lane flow = lane_positive(over)/(2.0f*m->mu + 0.66666667f*m->hardening);
    for (int k = 0; k < 3; k++) h[k] = h[k] - d[k]*(flow/norm);
    *state = *state + 0.81649658f*flow;
}

/* Deviatoric strain that sand in flow loses, eq. (11c): tau solves tau = G (shear - rate dt) and
   tau = (mu_s + friction_rise x/(1 + x)) p, x = rate dt G/(inertial_scale sqrt(p)); of the two roots the one
   below `shear`. */
TOBI_FN lane mpm_inertial_flow(const mpm_parameters *m, lane trace, lane norm)
{
    const lane p = lane_positive(-1.0f*(m->lambda + 0.66666667f*m->mu)*trace), zero = lane_set(0);
    const lane shear = 1.4142135f*m->mu*norm, rest = 2.1213203f*m->friction*p;
    const lane most = rest + m->friction_rise*p, slow = m->inertial_scale*lane_sqrt(p);
    const lane sum = most + shear + slow, product = most*shear + rest*slow;
    const lane tau = 2.0f*product/(sum + lane_sqrt(lane_positive(sum*sum - 4.0f*product)) + 1e-30f);
    return lane_where_less(rest, shear, (shear - tau)/(1.4142135f*m->mu), zero);
}

/* Sand (Klar et al. 2016), eq. (11): Drucker and Prager's cone on Hencky strains h; apart it carries nothing.
   state: the expansion that was cut off, given back before it is compressed (Tampubolon et al. 2017). */
TOBI_FN void mpm_sand(const mpm_parameters *m, lane h[3], lane *state)
{
    lane trace = h[0] + h[1] + h[2] + *state, mean = trace*(1.0f/3), share = *state*(1.0f/3), d[3];
    lane norm = lane_set(1e-30f);
    for (int k = 0; k < 3; k++) {
        d[k] = h[k] + share - mean;
        norm = norm + d[k]*d[k];
    }
    norm = lane_sqrt(norm);
    lane flow = lane_positive(norm + (3.0f*m->lambda + 2.0f*m->mu)/(2.0f*m->mu)*trace*m->friction);
    lane zero = lane_set(0);
    flow = lane_where_less(zero, m->friction_rise, mpm_inertial_flow(m, trace, norm), flow);
    for (int k = 0; k < 3; k++) h[k] = lane_where_less(trace, zero, mean + d[k]*(1.0f - flow/norm), zero);
    *state = lane_where_less(trace, zero, zero, trace);
}

/* The materials that need principal stretches. Which of them a lane is says `model`. */
TOBI_FN void mpm_principal(lane e[9], const mpm_parameters *m, lane_int model, lane *state, lane tau[6])
{
    lane a[6], v[3][3], s1[3], h[3], g[3], value[3], mean_h;
    lane dilation = mpm_dilation(e), one = lane_set(1), zero = lane_set(0);
    mpm_finger(e, a);
    mpm_eigen(a, v);
    for (int k = 0; k < 3; k++) {
        lane b = lane_where_less(a[k], lane_set(-0.999f), lane_set(-0.999f), a[k]);
        s1[k] = b/(1.0f + lane_sqrt(1.0f + b));                      /* stretch - 1 */
        h[k] = 0.5f*lane_log1p(b);
    }
    lane_int snow = lane_set_int(TOBI_SNOW), mises = lane_set_int(TOBI_VON_MISES),
        sand = lane_set_int(TOBI_SAND);
    lane cold[3] = {s1[0], s1[1], s1[2]}, cold_g[3], cold_state = *state, harder;
    lane bent[3] = {h[0], h[1], h[2]}, bent_state = *state, loose[3] = {h[0], h[1], h[2]},
        loose_state = *state;
    mpm_snow(m, cold, cold_g, &cold_state, &harder);
    mpm_von_mises(m, bent, &bent_state);
    mpm_sand(m, loose, &loose_state);
    lane factor = lane_where_equal(model, snow, harder, one);
    lane kept = (1.0f + cold_g[0])*(1.0f + cold_g[1])*(1.0f + cold_g[2]);
    dilation = lane_where_equal(model, snow, (dilation + 1.0f)*kept - 1.0f, dilation);
    for (int k = 0; k < 3; k++) {
        s1[k] = lane_where_equal(model, snow, cold[k], s1[k]);
        lane log_new = lane_where_equal(model, mises, bent[k], lane_where_equal(model, sand, loose[k], h[k]));
        lane log_change = log_new - h[k];
        g[k] = lane_where_equal(model, snow, cold_g[k],
                                lane_where_less(log_change*log_change, lane_set(1e-30f), zero,
                                                lane_exp(log_change) - 1.0f));
        h[k] = log_new;
    }
    *state = lane_where_equal(model, snow, cold_state,
                              lane_where_equal(model, mises, bent_state,
                                               lane_where_equal(model, sand, loose_state, *state)));
    mpm_stretch(e, g, v);
    mpm_fixed_corotated(s1, dilation, m->mu*factor, m->lambda*factor, value);
    mean_h = h[0] + h[1] + h[2];
    for (int k = 0; k < 3; k++) {
        lane hencky = 2.0f*m->mu*h[k] + m->lambda*mean_h;            /* eq. (10) */
        value[k] = lane_where_equal(model, mises, hencky, lane_where_equal(model, sand, hencky, value[k]));
    }
    mpm_compose(value, v, tau);
}

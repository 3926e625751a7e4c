/* Solids that break: the damage law on top of the elastic ones, docs/theory/mlsmpm.md, eqs. (17) to (21).
   A particle is a mixture of an intact share 1 - D, which carries everything, and a cracked share D, which
   carries only what grains of the same material would: pressure, and shear by friction. */
#pragma once
#include "mpm/materials.k.h"

/* exp(x) - 1 without loss for small x, |x| < 80. */
TOBI_FN lane mpm_expm1(lane x)
{
    lane_int n = lane_to_int(x*1.44269504f +
                             lane_where_less(x, lane_set(0), lane_set(-0.5f), lane_set(0.5f)));
    lane r = (x - lane_from_int(n)*0.693359375f) + lane_from_int(n)*2.12194440e-4f;
    lane p = r*(1.0f + r*(0.5f + r*(0.16666667f + r*(0.041666668f + r*(0.0083333310f + r*0.0013888889f)))));
    lane scale = lane_from_bits((n + 127) << 23);
    return scale*p + (scale - 1.0f);
}

/* Principal stresses tau of the elastic models at stretches 1 + s, eqs. (6) and (8). log_ratio: ln J. */
TOBI_FN void mpm_elastic(const mpm_parameters *m, lane_int model, const lane s[3], lane log_ratio,
                         lane value[3])
{
    lane dilation = (s[0] + s[1] + s[2]) + (s[0]*s[1] + s[1]*s[2] + s[2]*s[0] + s[0]*s[1]*s[2]), fixed[3];
    lane_int neo = lane_set_int(TOBI_NEO_HOOKEAN);
    mpm_fixed_corotated(s, dilation, m->mu, m->lambda, fixed);
    for (int k = 0; k < 3; k++)
        value[k] = lane_where_equal(model, neo, m->mu*s[k]*(s[k] + 2.0f) + m->lambda*log_ratio, fixed[k]);
}

/* D that the largest stretch 1 + s and its Kirchhoff stress ask for, eq. (18). */
TOBI_FN lane mpm_damage(const mpm_parameters *m, lane s, lane tau)
{
    lane one = lane_set(1), nominal = tau/(1.0f + s), over = lane_positive(nominal - m->strength);
    lane opened = s*m->brittleness;                   /* of the crack strain at which nothing is left */
    lane share = over/lane_where_less(opened, one, nominal - m->strength*opened, one);
    return lane_where_less(opened, one, share, lane_where_less(lane_set(0), over, one, lane_set(0)));
}

/* Hencky strains h of the cracked share, tau_c of eq. (17): apart it has no shape, pressed it keeps the shape
   that friction holds. Its volume is kept up to e^2, at which faces have long lost sight of each other. */
TOBI_FN void mpm_cracked_strain(const mpm_parameters *m, const lane h[3], lane out[3])
{
    lane trace = h[0] + h[1] + h[2], mean = trace*(1.0f/3), d[3], norm = lane_set(1e-30f), zero = lane_set(0);
    for (int k = 0; k < 3; k++) {
        d[k] = h[k] - mean;
        norm = norm + d[k]*d[k];
    }
    norm = lane_sqrt(norm);
    lane flow = lane_positive(norm + (3.0f*m->lambda + 2.0f*m->mu)/(2.0f*m->mu)*trace*m->friction);
    lane cut = lane_positive(mean - 0.66666667f);
    for (int k = 0; k < 3; k++) out[k] = lane_where_less(trace, zero, h[k] - d[k]*(flow/norm), mean - cut);
}

/* Principal state of a breakable particle: stretches 1 + s of F, the same and stresses of the cracked share,
   stresses of the intact one. */
typedef struct mpm_crack {
    lane s[3], log[3], loose[3], loose_log[3], intact[3], cracked[3];
} mpm_crack;

TOBI_FN void mpm_find_crack(const mpm_parameters *m, lane_int model, const lane b[3], mpm_crack *c)
{
    for (int k = 0; k < 3; k++) {
        lane x = lane_where_less(b[k], lane_set(-0.999f), lane_set(-0.999f), b[k]);
        c->s[k] = x/(1.0f + lane_sqrt(1.0f + x));
        c->log[k] = 0.5f*lane_log1p(x);
    }
    lane zero = lane_set(0), ratio = c->log[0] + c->log[1] + c->log[2];
    mpm_elastic(m, model, c->s, ratio, c->intact);
    mpm_cracked_strain(m, c->log, c->loose_log);
    for (int k = 0; k < 3; k++) {
        lane flown = c->loose_log[k] - c->log[k];
        c->loose[k] = lane_where_less(flown*flown, lane_set(1e-30f), c->s[k], mpm_expm1(c->loose_log[k]));
    }
    mpm_elastic(m, model, c->loose, ratio, c->cracked);
    for (int k = 0; k < 3; k++) c->cracked[k] = lane_where_less(ratio, zero, c->cracked[k], zero);
}

/* Kirchhoff stress of breakable particles, eqs. (17), (18). state: D. Only what is broken for good flows. */
TOBI_RARE_FN void mpm_break(const mpm_parameters *m, const lane_int *model, lane e[9], lane *state,
                            lane tau[6])
{
    lane a[6], v[3][3], g[3], value[3], one = lane_set(1), zero = lane_set(0);
    mpm_crack c;
    mpm_finger(e, a);
    mpm_eigen(a, v);
    mpm_find_crack(m, *model, a, &c);
    lane most = c.s[0], stress = c.intact[0];
    for (int k = 1; k < 3; k++) {
        stress = lane_where_less(most, c.s[k], c.intact[k], stress);
        most = lane_where_less(most, c.s[k], c.s[k], most);
    }
    lane asked = mpm_damage(m, most, stress), D = lane_where_less(*state, asked, asked, *state);
    for (int k = 0; k < 3; k++) {
        value[k] = (1.0f - D)*c.intact[k] + D*c.cracked[k];
        g[k] = lane_where_less(D, one, zero, (c.loose[k] - c.s[k])/(1.0f + c.s[k]));
    }
    mpm_stretch(e, g, v);
    mpm_compose(value, v, tau);
    *state = D;
}

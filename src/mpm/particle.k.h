/* Eight particles side by side: their weights, their stress, what they give to the grid. */
#pragma once
#include "mpm/damage.k.h"

enum { MPM_WIDE = TOBI_LANES };

/* Beside the bits of the models in `present`: some solid breaks. Its model's own bit is not set for it. */
enum { MPM_BREAKS = 1 << 30 };

TOBI_FN uint32_t mpm_bit_of(const mpm_material *m)
{
    return m->strength > 0 ? (uint32_t)MPM_BREAKS : 1u << m->model;
}

/* Eight particles: where they stand in the tile and their weights. */
typedef struct mpm_stencil {
    int32_t first[MPM_WIDE];           /* node of the tile, the lowest of each                  */
    float   offset[3][MPM_WIDE];       /* cells, from that node: 1/2 to 3/2                      */
    float   weight[3][3][MPM_WIDE];    /* [axis][node]                                          */
    tobi_float4 along[8];              /* the weights of each particle along a row of nodes, and 0 */
} mpm_stencil;

/* Weights of quadratic B-splines, eq. (2). Places are clamped to the tile: they lie in it unless a particle
   strayed more than a cell or is no number, which ends the run (mlsmpm.c). */
TOBI_FN void mpm_find_stencil(const mpm_view *v, const mpm_block *b, int64_t i, const int dim, mpm_stencil *s)
{
    const double corner[3] = {(double)b->corner[0], (double)b->corner[1], (double)b->corner[2]};
    lane place[3], w[3];
    lane_int first = lane_set_int(0);
    lane_load_places(v->position + i, v->inverse_cell, corner, place);
    for (int a = 0; a < dim; a++) {
        lane x = place[a] + 0.5f, low = lane_set(0), high = lane_set(5.9999f);
        x = lane_where_less(x, high, x, high);
        x = lane_where_less(low, x, x, low);
        lane_int node = lane_to_int(x);
        lane f = x - lane_from_int(node) + 0.5f;
        lane p = 1.5f - f, q = f - 1.0f, r = f - 0.5f;
        w[0] = 0.5f*p*p;
        w[1] = 0.75f - q*q;
        w[2] = 0.5f*r*r;
        first = first*8 + node;
        __builtin_memcpy(s->offset[a], &f, sizeof f);
        for (int n = 0; n < 3; n++) __builtin_memcpy(s->weight[a][n], &w[n], sizeof w[n]);
    }
    lane_store_float4(s->along, 1, MPM_WIDE, w[0], w[1], w[2], lane_set(0));
    __builtin_memcpy(s->first, &first, sizeof first);
}

/* 8 rows 4 apart of four floats each: columns of eight matrices. */
TOBI_FN void mpm_load_columns(const tobi_columns *from, lane m[9], lane w[3])
{
    const int32_t j[8] = {0, 3, 6, 9, 12, 15, 18, 21};
    for (int c = 0; c < 3; c++) lane_load_float4(&from->c[c], j, &m[c], &m[3 + c], &m[6 + c], &w[c]);
}

TOBI_FN void mpm_store_columns(tobi_columns *to, int count, const lane m[9], const lane w[3])
{
    for (int c = 0; c < 3; c++) lane_store_float4(&to->c[c], 3, count, m[c], m[3 + c], m[6 + c], w[c]);
}

/* 1 if the eight particles from i on are of one solid. Rows are padded: they may be read past the end. */
TOBI_FN int mpm_is_uniform(const uint8_t *solid)
{
    int same = 1;
    for (int k = 1; k < MPM_WIDE; k++) same &= solid[k] == solid[0];
    return same;
}

TOBI_FN void mpm_gather_parameters(const mpm_view *v, int64_t i, int count, mpm_parameters *m, lane *keep,
                                   lane_int *model, uint32_t *present)
{
    const mpm_material *one = &v->material[v->solid[i]];
    float p[14][MPM_WIDE];
    int32_t number[MPM_WIDE];
    if (mpm_is_uniform(v->solid + i)) {
        *m = (mpm_parameters){lane_set(one->mu), lane_set(one->lambda), lane_set(one->bulk),
                              lane_set(one->viscosity), lane_set(one->yield), lane_set(one->hardening),
                              lane_set(one->compression), lane_set(one->stretch), lane_set(one->friction),
                              lane_set(one->strength), lane_set(one->brittleness),
                              lane_set(one->friction_rise),
                              lane_set(one->inertial_scale*v->strain_dt)};
        *keep = lane_set(one->keep);
        *model = lane_set_int(one->model);
        *present = mpm_bit_of(one);
        return;
    }
    *present = 0;
    for (int k = 0; k < MPM_WIDE; k++) {
        const mpm_material *a = k < count ? &v->material[v->solid[i + k]] : one;
        p[0][k] = a->mu; p[1][k] = a->lambda; p[2][k] = a->bulk; p[3][k] = a->viscosity;
        p[4][k] = a->yield; p[5][k] = a->hardening; p[6][k] = a->compression; p[7][k] = a->stretch;
        p[8][k] = a->friction; p[9][k] = a->keep; p[10][k] = a->strength;
        p[11][k] = a->brittleness; p[12][k] = a->friction_rise; p[13][k] = a->inertial_scale*v->strain_dt;
        number[k] = a->model;
        *present |= mpm_bit_of(a);
    }
    *m = (mpm_parameters){lane_load(p[0]), lane_load(p[1]), lane_load(p[2]), lane_load(p[3]), lane_load(p[4]),
                          lane_load(p[5]), lane_load(p[6]), lane_load(p[7]), lane_load(p[8]),
                          lane_load(p[10]), lane_load(p[11]), lane_load(p[12]), lane_load(p[13])};
    *keep = lane_load(p[9]);
    *model = lane_load_index(number);
}

/* F <- (I + dt grad v) F, eq. (4). */
TOBI_FN void mpm_deform(float dt, const lane gradient[9], lane e[9])
{
    for (int c = 0; c < 3; c++) {
        lane f[3] = {e[c], e[3 + c], e[6 + c]};
        for (int r = 0; r < 3; r++) {
            lane rate = gradient[3*r + c] +
                (gradient[3*r]*f[0] + gradient[3*r + 1]*f[1] + gradient[3*r + 2]*f[2]);
            e[3*r + c] = f[r] + dt*rate;
        }
    }
}

/* Kirchhoff stress of eight particles; brings their strain and plastic state up to date. */
TOBI_FN void mpm_find_stress(const mpm_parameters *m, lane_int model, uint32_t present,
                             const lane gradient[9], lane e[9], lane *state, lane tau[6])
{
    const uint32_t simple = 1u << TOBI_NEO_HOOKEAN | 1u << TOBI_LIQUID | 1u << TOBI_STATIONARY | MPM_BREAKS;
    for (int k = 0; k < 6; k++) tau[k] = lane_set(0);
    if (present == 1u << TOBI_NEO_HOOKEAN) {
        mpm_neo_hookean(e, m, tau);
        return;
    }
    lane part[6], kept[9];
    if (present & 1u << TOBI_NEO_HOOKEAN) {
        mpm_neo_hookean(e, m, part);
        lane_int is = lane_set_int(TOBI_NEO_HOOKEAN);
        for (int k = 0; k < 6; k++) tau[k] = lane_where_equal(model, is, part[k], tau[k]);
    }
    if (present & 1u << TOBI_LIQUID) {
        for (int k = 0; k < 9; k++) kept[k] = e[k];
        mpm_liquid(kept, gradient, m, part);
        lane_int is = lane_set_int(TOBI_LIQUID);
        for (int k = 0; k < 6; k++) tau[k] = lane_where_equal(model, is, part[k], tau[k]);
        for (int k = 0; k < 9; k++) e[k] = lane_where_equal(model, is, kept[k], e[k]);
    }
    if (present & ~simple) {
        lane plastic = *state;
        for (int k = 0; k < 9; k++) kept[k] = e[k];
        mpm_principal(kept, m, model, &plastic, part);
        const int numbers[4] = {TOBI_COROTATED, TOBI_VON_MISES, TOBI_SNOW, TOBI_SAND};
        for (int n = 0; n < 4; n++) {
            lane_int is = lane_set_int(numbers[n]);
            for (int k = 0; k < 6; k++) tau[k] = lane_where_equal(model, is, part[k], tau[k]);
            for (int k = 0; k < 9; k++) e[k] = lane_where_equal(model, is, kept[k], e[k]);
            *state = lane_where_equal(model, is, plastic, *state);
        }
    }
    if (present & MPM_BREAKS) {
        mpm_parameters copy = *m;            /* whose address may leave this function, so that m's need not */
        lane_int number = model;
        lane damage = *state, zero = lane_set(0);
        for (int k = 0; k < 9; k++) kept[k] = e[k];
        mpm_break(&copy, &number, kept, &damage, part);
        for (int k = 0; k < 6; k++) tau[k] = lane_where_less(zero, m->strength, part[k], tau[k]);
        for (int k = 0; k < 9; k++) e[k] = lane_where_less(zero, m->strength, kept[k], e[k]);
        *state = lane_where_less(zero, m->strength, damage, *state);
    }
}

/* What eight particles give their nodes, eq. (3): (base + columns times the distance from the lowest node)
   times the weight; and along each axis bend times 1, -2, 1 times the weights of the others, eq. (3b). */
typedef struct mpm_load {
    tobi_float4 base[8];               /* kg m/s at the lowest node, and the particle's mass      */
    tobi_float4 column[3][8];          /* kg m/s per cell                                         */
    tobi_float4 bend[3][8];            /* kg m/s; unset unless mpm_view.bent                      */
    tobi_float4 momentum[8];           /* kg m/s at the particle, and its mass                    */
} mpm_load;

/* What damping takes from the kinetic energy of the first `count` particles in this step, J. */
TOBI_FN double mpm_find_damping(const mpm_view *v, int count, const lane velocity[4], const lane c[9],
                                lane mass, lane keep)
{
    const float affine = v->affine_momentum ? 0.25f*v->cell*v->cell : 0;
    lane square = velocity[0]*velocity[0] + velocity[1]*velocity[1] + velocity[2]*velocity[2];
    float lost[MPM_WIDE];
    double sum = 0;
    for (int k = 0; k < 9; k++) square = square + affine*(c[k]*c[k]);
    square = 0.5f*mass*((1.0f - keep)*(1.0f + keep))*square;
    __builtin_memcpy(lost, &square, sizeof square);
    for (int k = 0; k < count; k++) sum += lost[k];
    return sum;
}

/* Stress and momentum, with axes as the stencil has them. */
TOBI_FN void mpm_store_load(const mpm_view *v, const mpm_stencil *at, const lane tau[6],
                            const lane gradient[9], const lane momentum[4], lane stress, lane carried,
                            const int dim, mpm_load *load)
{
    const int of[3][3] = {{MPM_XX, MPM_XY, MPM_ZX}, {MPM_XY, MPM_YY, MPM_YZ}, {MPM_ZX, MPM_YZ, MPM_ZZ}};
    const lane zero = lane_set(0);
    lane base[3] = {momentum[0], momentum[1], momentum[2]};
    for (int c = 0; c < dim; c++) {
        const lane offset = lane_load(at->offset[c]);
        lane column[3], bend[3];
        for (int r = 0; r < 3; r++) {
            column[r] = (stress*tau[of[r][c]] + carried*gradient[3*r + c])*v->cell;
            base[r] = base[r] - column[r]*offset;
        }
        lane_store_float4(load->column[c], 1, 8, column[0], column[1], column[2], zero);
        if (!v->bent) continue;
        const lane differ = 0.25f*(1.5f - offset)*(1.0f - offset)*(2.0f*offset - 1.0f)*v->cell;
        for (int r = 0; r < 3; r++) bend[r] = stress*tau[of[r][c]]*differ;
        lane_store_float4(load->bend[c], 1, 8, bend[0], bend[1], bend[2], zero);
    }
    lane_store_float4(load->base, 1, 8, base[0], base[1], base[2], momentum[3]);
    if (v->unstressed)
        lane_store_float4(load->momentum, 1, 8, momentum[0], momentum[1], momentum[2], momentum[3]);
}

/* V of eqs. (24) to (26): what a block's momentum is counted from, m/s, and 0. */
TOBI_FN tobi_float4 mpm_find_frame(const mpm_view *v, const mpm_block *b)
{
    const tobi_float4 u = v->velocity[b->begin];
    return (tobi_float4){u.x, u.y, u.z, 0};
}

/* frame: see mpm_reach. Returns the kinetic energy that damping takes, J. */
TOBI_FN double mpm_find_load(const mpm_view *v, int64_t i, int count, const mpm_stencil *at,
                             const tobi_float4 *frame, const int dim, mpm_load *load)
{
    const int32_t next[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    lane velocity[4], momentum[4], gradient[9], e[9], other[3], unused[3], tau[6], keep;
    lane_int model;
    uint32_t present;
    mpm_parameters m;
    lane_load_float4(v->velocity + i, next, &velocity[0], &velocity[1], &velocity[2], &velocity[3]);
    mpm_load_columns(v->affine + i, gradient, unused);
    mpm_load_columns(v->strain + i, e, other);
    mpm_gather_parameters(v, i, count, &m, &keep, &model, &present);
    mpm_deform(v->strain_dt, gradient, e);
    mpm_find_stress(&m, model, present, gradient, e, &other[1], tau);
    mpm_store_columns(v->strain + i, count, e, other);
    const lane mass = other[2], moving = mass*keep;
    for (int a = 0; a < 3; a++) momentum[a] = mass*(keep*velocity[a] - (&frame->x)[a]);
    momentum[3] = mass;
    mpm_store_load(v, at, tau, gradient, momentum,
                   other[0]*(float)(-4.0*v->dt*v->inverse_cell*v->inverse_cell),
                   v->affine_momentum ? moving : lane_set(0), dim, load);
    return v->damped ? mpm_find_damping(v, count, velocity, gradient, mass, keep) : 0;
}

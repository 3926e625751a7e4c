/* The transfers of MLS-MPM (Hu et al. 2018) with quadratic B-splines, docs/theory/mlsmpm.md.
   A block's particles are read eight at a time: their weights and stresses are computed side by side, then
   each adds to the 3 x 3 rows of nodes it feels, which stay in registers as long as the next particle has the
   same base node. Particles need not be in the order of their base nodes; that is only faster.
   Axes are (x, y, z), rows run along z; in 2-D they are (x, nothing, y). */
#pragma once
#include "exec/rows.h"
#include "mpm/materials.k.h"

enum { MPM_WIDE = TOBI_LANES };

/* Eight particles: where they stand in the tile and their weights. */
typedef struct mpm_stencil {
    int32_t first[MPM_WIDE];           /* node of the tile, the lowest of each                  */
    float   offset[3][MPM_WIDE];       /* cells, from that node: 1/2 to 3/2                      */
    float   weight[3][3][MPM_WIDE];    /* [axis][node]                                          */
} mpm_stencil;

/* Weights of quadratic B-splines, eq. (2). Places are clamped to the tile: they lie in it unless a particle
   strayed more than a cell, which ends the run (mlsmpm.c). */
TOBI_FN void mpm_find_stencil(const mpm_view *v, const mpm_block *b, int64_t i, int dim, mpm_stencil *s)
{
    float place[3][MPM_WIDE];
    lane_int first = lane_set_int(0);
    for (int k = 0; k < MPM_WIDE; k++) {
        const tobi_double3 *x = &v->position[i + k];
        place[0][k] = (float)(x->x*v->inverse_cell - b->corner[0]);
        place[1][k] = (float)(x->y*v->inverse_cell - b->corner[1]);
        place[2][k] = (float)(x->z*v->inverse_cell - b->corner[2]);
    }
    for (int a = 0; a < dim; a++) {
        lane x = lane_load(place[a]) + 0.5f, low = lane_set(0), high = lane_set(5.9999f);
        x = lane_where_less(x, low, low, lane_where_less(high, x, high, x));
        lane_int node = lane_to_int(x);
        lane f = x - lane_from_int(node) + 0.5f;
        lane p = 1.5f - f, q = f - 1.0f, r = f - 0.5f;
        lane w[3] = {0.5f*p*p, 0.75f - q*q, 0.5f*r*r};
        first = first*8 + node;
        __builtin_memcpy(s->offset[a], &f, sizeof f);
        for (int n = 0; n < 3; n++) __builtin_memcpy(s->weight[a][n], &w[n], sizeof w[n]);
    }
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

/* 1 if the eight particles from i on are of one solid. Rows are padded, so that they may be read past the end. */
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
    float p[10][MPM_WIDE];
    int32_t number[MPM_WIDE];
    if (mpm_is_uniform(v->solid + i)) {
        *m = (mpm_parameters){lane_set(one->mu), lane_set(one->lambda), lane_set(one->bulk),
                              lane_set(one->viscosity), lane_set(one->yield), lane_set(one->hardening),
                              lane_set(one->compression), lane_set(one->stretch), lane_set(one->friction)};
        *keep = lane_set(one->keep);
        *model = lane_set_int(one->model);
        *present = 1u << one->model;
        return;
    }
    *present = 0;
    for (int k = 0; k < MPM_WIDE; k++) {
        const mpm_material *a = k < count ? &v->material[v->solid[i + k]] : one;
        p[0][k] = a->mu; p[1][k] = a->lambda; p[2][k] = a->bulk; p[3][k] = a->viscosity;
        p[4][k] = a->yield; p[5][k] = a->hardening; p[6][k] = a->compression; p[7][k] = a->stretch;
        p[8][k] = a->friction; p[9][k] = a->keep;
        number[k] = a->model;
        *present |= 1u << a->model;
    }
    *m = (mpm_parameters){lane_load(p[0]), lane_load(p[1]), lane_load(p[2]), lane_load(p[3]), lane_load(p[4]),
                          lane_load(p[5]), lane_load(p[6]), lane_load(p[7]), lane_load(p[8])};
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
    const uint32_t simple = 1u << TOBI_NEO_HOOKEAN | 1u << TOBI_LIQUID | 1u << TOBI_STATIONARY;
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
}

/* What a particle gives its nodes: momentum + matrix (node - particle), times the weight; eq. (3). */
typedef struct mpm_load {
    tobi_float4 momentum[8];           /* kg m/s at the particle, and its mass                    */
    tobi_float4 matrix[3][8];          /* kg/s, columns                                           */
} mpm_load;

TOBI_FN void mpm_find_load(const mpm_view *v, int64_t i, int count, mpm_load *load)
{
    const int32_t next[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    lane velocity[4], gradient[9], e[9], other[3], unused[3], tau[6], keep;
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
    lane s = other[0]*(float)(-4.0*v->dt*v->inverse_cell*v->inverse_cell), mass = other[2];
    lane carried = v->affine_momentum ? mass*keep : lane_set(0);
    const int at[3][3] = {{MPM_XX, MPM_XY, MPM_ZX}, {MPM_XY, MPM_YY, MPM_YZ}, {MPM_ZX, MPM_YZ, MPM_ZZ}};
    for (int c = 0; c < 3; c++) {
        lane column[3];
        for (int r = 0; r < 3; r++) column[r] = s*tau[at[r][c]] + carried*gradient[3*r + c];
        lane_store_float4(load->matrix[c], 1, 8, column[0], column[1], column[2], lane_set(0));
    }
    lane moving = mass*keep;
    lane_store_float4(load->momentum, 1, 8, moving*velocity[0], moving*velocity[1], moving*velocity[2], mass);
}

TOBI_FN void mpm_add_rows(float *tile, int32_t first, row *sum, int dim)
{
    const int rows = dim == 3 ? 9 : 3;
    for (int r = 0; r < rows; r++) {
        float *at = tile + 4*(first + (dim == 3 ? 64*(r/3) + 8*(r%3) : 8*r));
        row_store(at, row_load(at) + sum[r]);
        sum[r] = row_set(0);
    }
}

/* One particle's momentum alone, without stress: FLIP's changes are measured against it. */
TOBI_FN void mpm_add_calm(tobi_float4 *tile, const mpm_stencil *s, int k, quad momentum, const int dim)
{
    const int last = dim - 1, rows = dim == 3 ? 3 : 1;
    quad along = {s->weight[last][0][k], s->weight[last][1][k], s->weight[last][2][k], 0};
    row x = row_repeat(momentum)*row_spread(along);
    for (int n = 0; n < 3; n++)
        for (int r = 0; r < rows; r++) {
            tobi_float4 *at = tile + s->first[k] + (dim == 3 ? 64*n + 8*r : 8*n);
            float w = dim == 3 ? s->weight[0][n][k]*s->weight[1][r][k] : s->weight[0][n][k];
            row_store(at, row_load(at) + x*row_set(w));
        }
}

/* Momentum and mass of a block's particles into its tile. */
TOBI_FN void mpm_scatter(const mpm_view *v, int64_t number, double *totals, const int dim)
{
    const mpm_block *b = &v->block[number];
    const int nodes = dim == 3 ? MPM_TILE_3D : MPM_TILE_2D, last = dim - 1, rows = dim == 3 ? 3 : 1;
    float *tile = (float *)(v->tile + number*(nodes + 8));
    row sum[9];
    int32_t cell = -1;
    const quad step = {0, 1, 2, 0};
    (void)totals;
    tobi_float4 *calm = v->old ? v->calm + number*(nodes + 8) : NULL;
    for (int n = 0; n < 4*(nodes + 8); n++) tile[n] = 0;
    for (int n = 0; calm && n < nodes + 8; n++) calm[n] = (tobi_float4){0, 0, 0, 0};
    for (int r = 0; r < 9; r++) sum[r] = row_set(0);
    for (int64_t i = b->begin; i < b->end; i += MPM_WIDE) {
        const int count = b->end - i < MPM_WIDE ? (int)(b->end - i) : MPM_WIDE;
        mpm_stencil s;
        mpm_load load;
        mpm_find_stencil(v, b, i, dim, &s);
        mpm_find_load(v, i, count, &load);
        for (int k = 0; k < count; k++) {
            if (calm) mpm_add_calm(calm, &s, k, quad_load(&load.momentum[k]), dim);
            if (s.first[k] != cell) {
                if (cell >= 0) mpm_add_rows(tile, cell, sum, dim);
                cell = s.first[k];
            }
            const quad unit = quad_set(v->cell);
            quad a0 = quad_load(&load.matrix[0][k])*unit, a1 = quad_load(&load.matrix[1][k])*unit,
                 a2 = quad_load(&load.matrix[last][k])*unit, base = quad_load(&load.momentum[k]);
            base = base - a0*quad_set(s.offset[0][k]);
            if (dim == 3) base = base - a1*quad_set(s.offset[1][k]);
            base = base - a2*quad_set(s.offset[last][k]);
            quad along = {s.weight[last][0][k], s.weight[last][1][k], s.weight[last][2][k], 0};
            row w = row_spread(along), d0 = row_repeat(a0)*w, d1 = row_repeat(a1)*w;
            row x = row_fma(row_repeat(a2), row_spread(step), row_repeat(base))*w;
            for (int n = 0; n < 3; n++) {
                row wx = row_set(s.weight[0][n][k]), t = x*wx, u = d1*wx;
                sum[rows*n] = dim == 3 ? row_fma(t, row_set(s.weight[1][0][k]), sum[rows*n]) : sum[rows*n] + t;
                if (dim == 3) {
                    t = t + u;
                    sum[3*n + 1] = row_fma(t, row_set(s.weight[1][1][k]), sum[3*n + 1]);
                    t = t + u;
                    sum[3*n + 2] = row_fma(t, row_set(s.weight[1][2][k]), sum[3*n + 2]);
                }
                x = x + d0;
            }
        }
    }
    if (cell >= 0) mpm_add_rows(tile, cell, sum, dim);
}

/* Nodes of a tile that belong to the node block at offset -1, 0 or 1 along an axis. */
TOBI_FN int mpm_span_first(int offset) { return offset < 0 ? 0 : offset == 0 ? 1 : 5; }
TOBI_FN int mpm_span_last(int offset) { return offset < 0 ? 0 : offset == 0 ? 4 : 7; }

/* Coulomb contact of a node with a plane, eq. (13); v becomes the velocity after. */
TOBI_FN void mpm_meet_plane(const mpm_plane *p, float v[3])
{
    float n[3], r[3], along = 0, slide = 0;
    for (int a = 0; a < 3; a++) {
        n[a] = (float)p->normal[a];
        r[a] = v[a] - p->velocity[a];
        along += n[a]*r[a];
    }
    if (p->kind == TOBI_WALL_NO_SLIP) {
        for (int a = 0; a < 3; a++) v[a] = p->velocity[a];
        return;
    }
    if (p->kind == TOBI_WALL_SEPARATE && along >= 0) return;
    for (int a = 0; a < 3; a++) {
        r[a] -= along*n[a];
        slide += r[a]*r[a];
    }
    slide = sqrtf(slide);
    float grip = p->kind == TOBI_WALL_SEPARATE ? -p->friction*along : 0;
    float left = slide > grip ? 1 - grip/(slide + 1e-30f) : 0;
    for (int a = 0; a < 3; a++) v[a] = p->velocity[a] + r[a]*left;
}

/* Sums the tiles over a block of nodes: momentum and mass. */
TOBI_FN void mpm_sum_tiles(const mpm_patch *g, const tobi_float4 *tiles, quad *sum, const int dim)
{
    const int nodes = dim == 3 ? MPM_NODES_3D : MPM_NODES_2D;
    const int tile_nodes = dim == 3 ? MPM_TILE_3D : MPM_TILE_2D;
    for (int n = 0; n < nodes; n++) sum[n] = quad_set(0);
    for (int o = 0; o < 27; o++) {
        if (g->cover[o] < 0) continue;
        /* From the tile's block this one lies at the opposite offset. */
        const tobi_float4 *tile = tiles + (int64_t)g->cover[o]*(tile_nodes + 8);
        const int ox = 1 - o/9, oy = 1 - o/3%3, oz = dim == 3 ? 1 - o%3 : 0;
        for (int x = mpm_span_first(ox); x <= mpm_span_last(ox); x++)
            for (int y = mpm_span_first(oy); y <= mpm_span_last(oy); y++) {
                const int row = (x - 1 - 4*ox)*4 + (y - 1 - 4*oy);
                if (dim == 2) sum[row] = sum[row] + quad_load(&tile[x*8 + y]);
                for (int z = mpm_span_first(oz); z <= mpm_span_last(oz) && dim == 3; z++) {
                    const int n = row*4 + (z - 1 - 4*oz);
                    sum[n] = sum[n] + quad_load(&tile[(x*8 + y)*8 + z]);
                }
            }
    }
}

/* Planes that node n of a block lies behind change its velocity u. */
TOBI_FN void mpm_meet_planes(const mpm_view *v, const mpm_patch *g, int n, float u[3], int dim)
{
    const int at[3] = {g->corner[0] + (dim == 3 ? n/16 : n/4), g->corner[1] + (dim == 3 ? n/4%4 : n%4),
                       dim == 3 ? g->corner[2] + n%4 : 0};
    for (int p = 0; p < v->plane_count; p++) {
        const mpm_plane *plane = &v->plane[p];
        double depth = plane->normal[0]*at[0] + plane->normal[1]*at[1] + plane->normal[2]*at[2] -
                       plane->offset*v->inverse_cell;
        if (depth < 1e-6) mpm_meet_plane(plane, u);
    }
}

/* Momentum of a block of nodes becomes velocity, eq. (12), which gravity and planes change.
   totals: 0..2 momentum given to the planes. */
TOBI_FN void mpm_collect(const mpm_view *v, int64_t number, double *totals, const int dim)
{
    const mpm_patch *g = &v->patch[number];
    const int nodes = dim == 3 ? MPM_NODES_3D : MPM_NODES_2D;
    const quad fall = {v->gravity[0]*v->dt, v->gravity[1]*v->dt, v->gravity[2]*v->dt, 0};
    tobi_float4 *node = v->node + number*nodes;
    quad sum[MPM_NODES_3D], calm[MPM_NODES_3D], given = quad_set(0);
    mpm_sum_tiles(g, v->tile, sum, dim);
    if (v->old) mpm_sum_tiles(g, v->calm, calm, dim);
    for (int n = 0; n < nodes; n++) {
        const float mass = sum[n][3], inverse = mass > 0 ? 1/mass : 0;
        quad u = sum[n]*quad_set(inverse);
        if (v->old) quad_store(&v->old[number*nodes + n], calm[n]*quad_set(inverse));
        if (mass > 0) u = u + fall;
        if (g->planes && mass > 0) {
            float after[3] = {u[0], u[1], u[2]};
            mpm_meet_planes(v, g, n, after, dim);
            quad change = {u[0] - after[0], u[1] - after[1], u[2] - after[2], 0};
            given = given + change*quad_set(mass);
            u = u - change;
        }
        u[3] = mass;
        quad_store(&node[n], u);
    }
    for (int a = 0; a < 3; a++) totals[a] += given[a];
}

/* The nodes around a block, from the node blocks into one tile. */
TOBI_FN void mpm_copy_tile(const tobi_float4 *node, const int32_t around[27], tobi_float4 *tile, int dim)
{
    for (int o = 0; o < 27; o++) {
        if (dim == 2 && o%3 != 1) continue;
        const int ox = o/9 - 1, oy = o/3%3 - 1, oz = dim == 3 ? o%3 - 1 : 0;
        const tobi_float4 *from = node + (int64_t)around[o]*(dim == 3 ? MPM_NODES_3D : MPM_NODES_2D);
        for (int x = mpm_span_first(ox); x <= mpm_span_last(ox); x++)
            for (int y = mpm_span_first(oy); y <= mpm_span_last(oy); y++) {
                if (dim == 2) {
                    tile[x*8 + y] = from[(x - 1 - 4*ox)*4 + (y - 1 - 4*oy)];
                    continue;
                }
                for (int z = mpm_span_first(oz); z <= mpm_span_last(oz); z++)
                    tile[(x*8 + y)*8 + z] = from[((x - 1 - 4*ox)*4 + (y - 1 - 4*oy))*4 + (z - 1 - 4*oz)];
            }
    }
}

/* Velocity and its gradient at a particle, from the 3 x 3 rows of nodes it feels; eq. (14). */
TOBI_FN void mpm_interpolate(const row *g, const mpm_stencil *s, int k, float scale, int dim, quad *velocity,
                             quad gradient[3])
{
    const int last = dim - 1;
    const quad step = {0, 1, 2, 0};
    row w[3], u[3], y[3];
    for (int n = 0; n < 3; n++) {
        w[n] = row_set(s->weight[0][n][k]);
        if (dim == 3) {
            row y1 = row_set(s->weight[1][1][k]), y2 = row_set(s->weight[1][2][k]), b = g[3*n + 1]*y1;
            u[n] = row_fma(g[3*n + 2], y2, row_fma(g[3*n], row_set(s->weight[1][0][k]), b));
            y[n] = row_fma(g[3*n + 2], y2 + y2, b);
        } else u[n] = g[n];
    }
    quad z = {s->weight[last][0][k], s->weight[last][1][k], s->weight[last][2][k], 0};
    row along = row_spread(z), m2 = u[2]*w[2], m12 = row_fma(u[1], w[1], m2);
    row t0 = row_fma(u[0], w[0], m12)*along, t1 = (m12 + m2)*along, t3 = t0*row_spread(step);
    quad v = row_fold(t0), factor = quad_set(scale);
    gradient[0] = factor*(row_fold(t1) - v*quad_set(s->offset[0][k]));
    gradient[1] = quad_set(0);
    gradient[2] = quad_set(0);
    if (dim == 3) {
        row t2 = row_fma(y[2], w[2], row_fma(y[1], w[1], y[0]*w[0]))*along;
        gradient[1] = factor*(row_fold(t2) - v*quad_set(s->offset[1][k]));
    }
    gradient[last] = factor*(row_fold(t3) - v*quad_set(s->offset[last][k]));
    *velocity = v;
}

TOBI_FN void mpm_load_rows(const tobi_float4 *tile, int32_t first, row *g, int dim)
{
    const int rows = dim == 3 ? 9 : 3;
    for (int r = 0; r < rows; r++) g[r] = row_load(tile + first + (dim == 3 ? 64*(r/3) + 8*(r%3) : 8*r));
}

/* 1 if a particle had to be brought back. */
TOBI_FN int mpm_keep_inside(tobi_double3 *x, const mpm_view *v, int dim)
{
    double *at = &x->x;
    const double *size = v->size;
    int out = 0;
    for (int a = 0; a < dim; a++) {
        if (at[a] >= 0 && at[a] <= size[a]) continue;
        if (!(v->held >> (2*a + (at[a] > size[a])) & 1)) continue;
        at[a] = at[a] > size[a] ? size[a] : 0;
        out = 1;
    }
    return out;
}

/* Velocities, their gradients and new positions of a block's particles.
   totals: 0 particles that had to be kept inside the domain, 6 largest speed squared, 7 largest way along an
   axis, m. */
TOBI_FN void mpm_gather(const mpm_view *v, int64_t number, double *totals, const int dim)
{
    const mpm_block *b = &v->block[number];
    const int beyond = dim == 3 ? MPM_TILE_3D : MPM_TILE_2D, flip = v->old != NULL;
    const float scale = (float)(4*v->inverse_cell), dt = v->dt;
    const quad home = {(float)b->corner[0], (float)b->corner[1], (float)b->corner[2], 0};
    /* Locals, because what is stored below could be the view for all the compiler knows. */
    tobi_float4 *const velocity = v->velocity;
    tobi_columns *const affine = v->affine;
    tobi_double3 *const position = v->position;
    tobi_float4 tile[MPM_TILE_3D + 8], old[MPM_TILE_3D + 8];
    row g[9] = {0}, h[9] = {0};
    quad far = quad_set(0);
    float fast = 0;
    int32_t cell = -1;
    int edge = 0;
    for (int a = 0; a < dim; a++) edge |= b->corner[a] < 2 || (b->corner[a] + 8)*(double)v->cell > v->size[a];
    mpm_copy_tile(v->node, b->around, tile, dim);
    if (flip) mpm_copy_tile(v->old, b->around, old, dim);
    for (int n = beyond; n < beyond + 8; n++)              /* what the last rows read beyond the tile */
        tile[n] = old[n] = (tobi_float4){0, 0, 0, 0};
    for (int64_t i = b->begin; i < b->end; i += MPM_WIDE) {
        const int count = b->end - i < MPM_WIDE ? (int)(b->end - i) : MPM_WIDE;
        mpm_stencil s;
        mpm_find_stencil(v, b, i, dim, &s);
        for (int k = 0; k < count; k++) {
            const mpm_material *material = &v->material[v->solid[i + k]];
            quad u, gradient[3];
            if (material->model == TOBI_STATIONARY) continue;
            if (s.first[k] != cell) {
                cell = s.first[k];
                mpm_load_rows(tile, cell, g, dim);
                if (flip) mpm_load_rows(old, cell, h, dim);
            }
            mpm_interpolate(g, &s, k, scale, dim, &u, gradient);
            position[i + k].x += (double)u[0]*dt;
            position[i + k].y += (double)u[1]*dt;
            if (dim == 3) position[i + k].z += (double)u[2]*dt;
            if (edge) totals[0] += mpm_keep_inside(&position[i + k], v, dim);
            far = quad_larger(far, u*u);
            if (flip) {
                quad before, unused[3], own = quad_load(&velocity[i + k])*quad_set(material->keep);
                mpm_interpolate(h, &s, k, scale, dim, &before, unused);
                u = u + quad_set(v->flip)*(own - before);
            }
            quad square = u*u;
            float speed2 = square[0] + square[1] + square[2];
            if (!(speed2 <= fast)) fast = speed2;          /* NaN stays */
            /* The force of a contact in this step is kept for the next, and only that long. */
            const float force = velocity[i + k].w;
            u[3] = force > 0 ? -force : 0;
            quad_store(&velocity[i + k], u);
            for (int c = 0; c < 3; c++) {
                gradient[c][3] = home[c];                  /* for mpm_grid_restore */
                quad_store(&affine[i + k].c[c], gradient[c]);
            }
        }
    }
    if (!(fast <= totals[6])) totals[6] = fast;
    for (int a = 0; a < 3; a++)
        if (sqrtf(far[a])*(double)dt > totals[7]) totals[7] = sqrtf(far[a])*(double)dt;
}

/* Kernels over blocks, as tobi_launch wants them. */
#define MPM_KERNEL(NAME, BODY, DIM)                                                                 \
    static void NAME(const void *view, int64_t begin, int64_t end, double *totals)                  \
    {                                                                                               \
        for (int64_t n = begin; n < end; n++) BODY((const mpm_view *)view, n, totals, DIM);         \
    }

/* The transfers of MLS-MPM (Hu et al. 2018) with quadratic B-splines, docs/theory/mlsmpm.md.
   A block's particles are read eight at a time: their weights and stresses are computed side by side, then
   each adds to the 3 x 3 rows of nodes it feels, which stay in registers as long as the next particle has the
   same base node. Particles need not be in the order of their base nodes; that is only faster.
   Axes are (x, y, z), rows run along z; in 2-D they are (x, nothing, y). */
#pragma once
#include "mpm/split.k.h"

TOBI_FN void mpm_clear(tobi_float4 *tile, int nodes)
{
    for (int n = 0; n < nodes; n++) tile[n] = (tobi_float4){0, 0, 0, 0};
}

TOBI_FN void mpm_add_rows(float *tile, int32_t first, row *sum, int dim)
{
    const int rows = dim == 3 ? 9 : 3;
    for (int r = 0; r < rows; r++) {
        float *at = tile + 4*(first + (dim == 3 ? 64*(r/3) + 8*(r%3) : 8*r));
        row_store(at, row_add(row_load(at), sum[r]));
        sum[r] = row_set(0);
    }
}

/* One particle's momentum alone, without stress: FLIP's changes are measured against it. */
TOBI_FN void mpm_add_calm(tobi_float4 *tile, const mpm_stencil *s, int k, quad momentum, const int dim)
{
    const int last = dim - 1, rows = dim == 3 ? 3 : 1;
    quad along = {s->weight[last][0][k], s->weight[last][1][k], s->weight[last][2][k], 0};
    row x = row_mul(row_repeat(momentum), row_spread(along));
    for (int n = 0; n < 3; n++)
        for (int r = 0; r < rows; r++) {
            tobi_float4 *at = tile + s->first[k] + (dim == 3 ? 64*n + 8*r : 8*n);
            float w = dim == 3 ? s->weight[0][n][k]*s->weight[1][r][k] : s->weight[0][n][k];
            row_store(at, row_add(row_load(at), row_mul(x, row_set(w))));
        }
}

/* The cleared tile of a block's twin, NULL = no twin. */
TOBI_FN tobi_float4 *mpm_twin_tile(const mpm_block *b, tobi_float4 *tiles, int nodes)
{
    if (b->twin < 0) return NULL;
    tobi_float4 *tile = tiles + (int64_t)b->twin*(nodes + 8);
    mpm_clear(tile, nodes + 8);
    return tile;
}

/* Momentum and mass of a block's particles into its tile. totals: 0 energy taken by damping, J. */
TOBI_FN void mpm_scatter(const mpm_view *v, int64_t number, double *totals, const int dim)
{
    const mpm_block *b = &v->block[number];
    const int nodes = dim == 3 ? MPM_TILE_3D : MPM_TILE_2D, last = dim - 1, rows = dim == 3 ? 3 : 1;
    float *tile = (float *)(v->tile + number*(nodes + 8));
    row sum[9];
    int32_t cell = -1;
    const quad step = {0, 1, 2, 0}, zero[3] = {quad_set(0), quad_set(0), quad_set(0)};
    tobi_float4 *calm = v->old ? v->calm + number*(nodes + 8) : NULL;      /* FLIP and XPIC */
    tobi_float4 *twin = mpm_twin_tile(b, v->tile, nodes);
    tobi_float4 *calm_twin = calm ? mpm_twin_tile(b, v->calm, nodes) : NULL;
    mpm_clear(v->tile + number*(nodes + 8), nodes + 8);
    if (calm) mpm_clear(calm, nodes + 8);
    const float *side = twin ? v->sides + (int64_t)b->sides*MPM_SIDES : NULL;
    for (int r = 0; r < 9; r++) sum[r] = row_set(0);
    for (int64_t i = b->begin; i < b->end; i += MPM_WIDE) {
        const int count = b->end - i < MPM_WIDE ? (int)(b->end - i) : MPM_WIDE;
        mpm_stencil s;
        mpm_load load;
        mpm_find_stencil(v, b, i, dim, &s);
        totals[0] += mpm_find_load(v, i, count, &load);
        for (int k = 0; k < count; k++) {
            uint32_t hidden = twin ? mpm_find_hidden(&v->cuts[i + k], side, s.first[k], dim) : 0;
            if (twin) v->hidden[i + k] = hidden;
            if (calm && hidden)
                mpm_add_split(calm, calm_twin, &s, k, hidden, quad_load(&load.momentum[k]), zero, dim);
            else if (calm)
                mpm_add_calm(calm, &s, k, quad_load(&load.momentum[k]), dim);
            const quad unit = quad_set(v->cell);
            quad a0 = quad_load(&load.matrix[0][k])*unit, a1 = quad_load(&load.matrix[1][k])*unit,
                 a2 = quad_load(&load.matrix[last][k])*unit, base = quad_load(&load.momentum[k]);
            base = base - a0*quad_set(s.offset[0][k]);
            if (dim == 3) base = base - a1*quad_set(s.offset[1][k]);
            base = base - a2*quad_set(s.offset[last][k]);
            if (hidden) {
                const quad columns[3] = {a0, a1, a2};
                mpm_add_split((tobi_float4 *)(void *)tile, twin, &s, k, hidden, base, columns, dim);
                continue;
            }
            if (s.first[k] != cell) {
                if (cell >= 0) mpm_add_rows(tile, cell, sum, dim);
                cell = s.first[k];
            }
            quad along = {s.weight[last][0][k], s.weight[last][1][k], s.weight[last][2][k], 0};
            row w = row_spread(along), d0 = row_mul(row_repeat(a0), w), d1 = row_mul(row_repeat(a1), w);
            row x = row_mul(row_fma(row_repeat(a2), row_spread(step), row_repeat(base)), w);
            for (int n = 0; n < 3; n++) {
                row wx = row_set(s.weight[0][n][k]), t = row_mul(x, wx), u = row_mul(d1, wx);
                row y0 = dim == 3 ? row_set(s.weight[1][0][k]) : row_set(1);
                sum[rows*n] = row_fma(t, y0, sum[rows*n]);
                if (dim == 3) {
                    t = row_add(t, u);
                    sum[3*n + 1] = row_fma(t, row_set(s.weight[1][1][k]), sum[3*n + 1]);
                    t = row_add(t, u);
                    sum[3*n + 2] = row_fma(t, row_set(s.weight[1][2][k]), sum[3*n + 2]);
                }
                x = row_add(x, d0);
            }
        }
    }
    if (cell >= 0) mpm_add_rows(tile, cell, sum, dim);
}

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

/* Adds row `at` of three tiles that follow along z, those that are there, to four nodes. */
TOBI_FN void mpm_add_row(const tobi_float4 *tiles, const int32_t cover[3], int at, quad to[4])
{
    const tobi_float4 *tile = tiles + at, *const before = tile + (int64_t)cover[0]*(MPM_TILE_3D + 8) + 5,
                      *const own = tile + (int64_t)cover[1]*(MPM_TILE_3D + 8) + 1,
                      *const after = tile + (int64_t)cover[2]*(MPM_TILE_3D + 8);
    if (cover[0] >= 0)
        for (int n = 0; n < 3; n++) to[n] = to[n] + quad_load(&before[n]);
    if (cover[1] >= 0)
        for (int n = 0; n < 4; n++) to[n] = to[n] + quad_load(&own[n]);
    if (cover[2] >= 0) to[3] = to[3] + quad_load(after);
}

/* Sums the tiles over a block of nodes: momentum and mass, in the order of `cover`. Counted from the node -4
   of a block, nodes 4 b .. 4 b + 3 are those of the block at offset b - 1; tiles begin at 3. */
TOBI_FN void mpm_sum_tiles(const mpm_patch *g, const tobi_float4 *tiles, quad *sum, const int dim)
{
    for (int x = 0; x < 4; x++)
        for (int y = 0; y < 4; y++) {
            quad *to = sum + (dim == 3 ? 16*x + 4*y : 4*x + y);
            for (int n = 0; n < (dim == 3 ? 4 : 1); n++) to[n] = quad_set(0);
            for (int pair = 0; pair < 4; pair++) {         /* of the tiles that reach this row, or side by side */
                const int ox = (x == 3) + (pair >> 1), oy = (y == 3) + (pair & 1);
                const int32_t *cover = g->cover + 9*ox + 3*oy;
                const int row = 8*(x + 5 - 4*ox) + (y + 5 - 4*oy);
                if (dim == 3) mpm_add_row(tiles, cover, 8*row, to);
                else if (cover[1] >= 0)
                    *to = *to + quad_load(&tiles[(int64_t)cover[1]*(MPM_TILE_2D + 8) + row]);
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
   totals: 0..2 momentum given to the planes, 3 work done on them. */
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
        if (v->old) {
            quad before = calm[n]*quad_set(inverse);
            if (v->wave) quad_store(&v->wave[number*nodes + n], before);
            quad_store(&v->old[number*nodes + n], v->wave ? before*quad_set(1 - v->order) : before);
        }
        if (mass > 0) u = u + fall;
        if (g->planes && mass > 0) {
            float after[3] = {u[0], u[1], u[2]};
            mpm_meet_planes(v, g, n, after, dim);
            quad change = {u[0] - after[0], u[1] - after[1], u[2] - after[2], 0};
            given = given + change*quad_set(mass);
            u = u - change;
            totals[3] += (double)mass*(change[0]*u[0] + change[1]*u[1] + change[2]*u[2]);
        }
        u[3] = mass;
        quad_store(&node[n], u);
    }
    for (int a = 0; a < 3; a++) totals[a] += given[a];
}

/* The nodes around a block, from the node blocks into one tile. Rows along z write a node too many, which the
   next row corrects; the last one reaches into the eight nodes beyond. */
TOBI_FN void mpm_copy_tile(const tobi_float4 *node, const int32_t around[27], tobi_float4 *tile, const int dim)
{
    for (int x = 3; x < 11; x++)                           /* from the node -4 of the block */
        for (int y = 3; y < 11; y++, tile += dim == 3 ? 8 : 1) {
            const int32_t *block = around + 9*(x/4) + 3*(y/4);
            const tobi_float4 *from = node + (dim == 3 ? 16*(x%4) + 4*(y%4) : 4*(x%4) + y%4);
            if (dim == 2) {
                *tile = from[(int64_t)block[1]*MPM_NODES_2D];
                continue;
            }
            tile[0] = from[(int64_t)block[0]*MPM_NODES_3D + 3];
            row_store(tile + 1, row_load(from + (int64_t)block[1]*MPM_NODES_3D));
            row_store(tile + 5, row_load(from + (int64_t)block[2]*MPM_NODES_3D));
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
            row y1 = row_set(s->weight[1][1][k]), y2 = row_set(s->weight[1][2][k]),
                b = row_mul(g[3*n + 1], y1);
            u[n] = row_fma(g[3*n + 2], y2, row_fma(g[3*n], row_set(s->weight[1][0][k]), b));
            y[n] = row_fma(g[3*n + 2], row_add(y2, y2), b);
        } else u[n] = g[n];
    }
    quad z = {s->weight[last][0][k], s->weight[last][1][k], s->weight[last][2][k], 0};
    row along = row_spread(z), m2 = row_mul(u[2], w[2]), m12 = row_fma(u[1], w[1], m2);
    row t0 = row_mul(row_fma(u[0], w[0], m12), along), t1 = row_mul(row_add(m12, m2), along);
    row t3 = row_mul(t0, row_spread(step));
    quad v = row_fold(t0), factor = quad_set(scale);
    gradient[0] = factor*(row_fold(t1) - v*quad_set(s->offset[0][k]));
    gradient[1] = quad_set(0);
    gradient[2] = quad_set(0);
    if (dim == 3) {
        row t2 = row_mul(row_fma(y[2], w[2], row_fma(y[1], w[1], row_mul(y[0], w[0]))), along);
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

/* The w of the velocity: the force of a contact in this step is kept for the next, and only that long. The
   w of the gradient: where the particle is at home, for mpm_grid_restore. */
TOBI_FN void mpm_store_motion(tobi_float4 *velocity, tobi_columns *affine, quad u, const quad gradient[3],
                              quad home)
{
    u[3] = velocity->w > 0 ? -velocity->w : 0;
    quad_store(velocity, u);
    for (int c = 0; c < 3; c++) {
        quad column = gradient[c];
        column[3] = home[c];
        quad_store(&affine->c[c], column);
    }
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
    tobi_float4 tile[MPM_TILE_3D + 8], old[MPM_TILE_3D + 8], twin[MPM_TILE_3D + 8], old_twin[MPM_TILE_3D + 8];
    const int split = b->twin >= 0;
    row g[9], h[9];
    quad far = quad_set(0);
    for (int r = 0; r < 9; r++) g[r] = h[r] = row_set(0);
    float fast = 0;
    int32_t cell = -1;
    int edge = 0;
    for (int a = 0; a < dim; a++) edge |= b->corner[a] < 2 || (b->corner[a] + 8)*(double)v->cell > v->size[a];
    mpm_copy_tile(v->node, b->around, tile, dim);
    if (flip) mpm_copy_tile(v->old, b->around, old, dim);
    if (split) mpm_copy_tile(v->node, v->block[b->twin].around, twin, dim);
    if (split && flip) mpm_copy_tile(v->old, v->block[b->twin].around, old_twin, dim);
    for (int n = beyond; n < beyond + 8; n++)              /* what the last rows read beyond the tile */
        tile[n] = old[n] = twin[n] = old_twin[n] = (tobi_float4){0, 0, 0, 0};
    for (int64_t i = b->begin; i < b->end; i += MPM_WIDE) {
        const int count = b->end - i < MPM_WIDE ? (int)(b->end - i) : MPM_WIDE;
        mpm_stencil s;
        mpm_find_stencil(v, b, i, dim, &s);
        for (int k = 0; k < count; k++) {
            const mpm_material *material = &v->material[v->solid[i + k]];
            quad u, gradient[3];
            if (material->model == TOBI_STATIONARY) continue;
            if (split && v->hidden[i + k]) {
                cell = -1;
                mpm_load_split(tile, twin, s.first[k], v->hidden[i + k], g, dim);
                if (flip) mpm_load_split(old, old_twin, s.first[k], v->hidden[i + k], h, dim);
            } else if (s.first[k] != cell) {
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
                quad before, unused[3], own = quad_load(&velocity[i + k])*quad_set(material->keep*v->own);
                mpm_interpolate(h, &s, k, scale, dim, &before, unused);
                u = u + quad_set(v->flip)*(own - before);
            }
            quad square = u*u;
            float speed2 = square[0] + square[1] + square[2];
            if (!(speed2 <= fast)) fast = speed2;          /* NaN stays */
            mpm_store_motion(&velocity[i + k], &affine[i + k], u, gradient, home);
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

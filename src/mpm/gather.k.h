/* Grid to particles: velocities, their gradients, new positions; blocks and rows as on the way there. */
#pragma once
#include "mpm/collect.k.h"

/* The nodes around a block, from the node blocks into one tile, less `frame`. Rows along z write a node too
   many, which the next row corrects; the last one reaches into the eight nodes beyond. */
TOBI_FN void mpm_copy_tile(const tobi_float4 *node, const int32_t around[27], quad frame, tobi_float4 *tile,
                           const int dim)
{
    const row frames = row_repeat(frame);
    for (int x = 3; x < 11; x++)                           /* from the node -4 of the block */
        for (int y = 3; y < 11; y++, tile += dim == 3 ? 8 : 1) {
            const int32_t *block = around + 9*(x/4) + 3*(y/4);
            const tobi_float4 *from = node + (dim == 3 ? 16*(x%4) + 4*(y%4) : 4*(x%4) + y%4);
            if (dim == 2) {
                quad_store(tile, quad_load(from + (int64_t)block[1]*MPM_NODES_2D) - frame);
                continue;
            }
            quad_store(tile, quad_load(from + (int64_t)block[0]*MPM_NODES_3D + 3) - frame);
            row_store(tile + 1, row_sub(row_load(from + (int64_t)block[1]*MPM_NODES_3D), frames));
            row_store(tile + 5, row_sub(row_load(from + (int64_t)block[2]*MPM_NODES_3D), frames));
        }
}

/* The same of a twin, of whose rows few carry anything: those that something reaches, and, since rows are
   read a node too far, the one after each. */
TOBI_FN void mpm_copy_reached(const tobi_float4 *node, const int32_t around[27], const mpm_reach *reach,
                              quad frame, tobi_float4 *tile, const int dim)
{
    const row frames = row_repeat(frame);
    const uint64_t some = mpm_all_rows(reach);
    for (uint64_t rows = some | some << 1; rows; rows &= rows - 1) {
        const int at = tobi_lowest_bit(rows), x = (at >> 3) + 3, y = (at & 7) + 3;  /* from the node -4 */
        const int32_t *block = around + 9*(x >> 2) + 3*(y >> 2);
        const tobi_float4 *from = node + (dim == 3 ? 16*(x & 3) + 4*(y & 3) : 4*(x & 3) + (y & 3));
        if (dim == 2) {
            quad_store(tile + at, quad_load(from + (int64_t)block[1]*MPM_NODES_2D) - frame);
            continue;
        }
        tobi_float4 *to = tile + 8*at;
        quad_store(to, quad_load(from + (int64_t)block[0]*MPM_NODES_3D + 3) - frame);
        row_store(to + 1, row_sub(row_load(from + (int64_t)block[1]*MPM_NODES_3D), frames));
        row_store(to + 5, row_sub(row_load(from + (int64_t)block[2]*MPM_NODES_3D), frames));
    }
}

TOBI_FN void mpm_load_rows(const tobi_float4 *tile, int32_t first, row *g, int dim)
{
    const int rows = dim == 3 ? 9 : 3;
    for (int r = 0; r < rows; r++) g[r] = row_load(tile + first + (dim == 3 ? 64*(r/3) + 8*(r%3) : 8*r));
}

/* Sums over the nodes that particle k feels, from their 3 x 3 rows: of the velocity, and of the velocity
   times the nodes' distance from the lowest along x, y and z. */
TOBI_FN row mpm_interpolate(const row *g, const mpm_stencil *s, int k, const int dim)
{
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
    row along = row_spread(quad_load(&s->along[k])), m2 = row_mul(u[2], w[2]), m12 = row_fma(u[1], w[1], m2);
    row t0 = row_mul(row_fma(u[0], w[0], m12), along), t1 = row_mul(row_add(m12, m2), along), t2 = row_set(0);
    if (dim == 3) t2 = row_mul(row_fma(y[2], w[2], row_fma(y[1], w[1], row_mul(y[0], w[0]))), along);
    const row t3 = row_mul(t0, row_spread(step));
    return dim == 3 ? row_fold_four(t0, t1, t2, t3) : row_fold_four(t0, t1, t3, t2);
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

/* The nodes around a block as its particles feel them, by velocity: velocity, and what replaces their own,
   both less what the block's momentum is counted from, eq. (26); XPIC's second is a difference as it is. */
typedef struct mpm_around {
    tobi_float4 now[MPM_VELOCITIES*(MPM_TILE_3D + 8)], old[MPM_VELOCITIES*(MPM_TILE_3D + 8)];
    tobi_float4 frame;
} mpm_around;

/* Tiles of all velocities from a layer of nodes, less `frame`. */
TOBI_FN void mpm_copy_tiles(const mpm_view *v, int64_t number, const tobi_float4 *node, quad frame,
                            tobi_float4 *tile, const int dim)
{
    const mpm_block *b = &v->block[number];
    for (int q = 0; q < 1 << b->levels; q++, tile += MPM_TILE_3D + 8) {
        const int64_t twin = b->twin + q - 1;
        if (q == 0) mpm_copy_tile(node, b->around, frame, tile, dim);
        else mpm_copy_reached(node, v->block[twin].around, &v->reach[twin], frame, tile, dim);
        mpm_clear(tile + (dim == 3 ? MPM_TILE_3D : MPM_TILE_2D), 8);   /* what the last rows read beyond */
    }
}

TOBI_FN void mpm_copy_nodes(const mpm_view *v, int64_t number, mpm_around *t, const int dim)
{
    const quad frame = quad_load(&v->reach[number].frame);
    quad_store(&t->frame, frame);
    mpm_copy_tiles(v, number, v->node, frame, t->now, dim);
    if (v->old) mpm_copy_tiles(v, number, v->old, frame*quad_set(v->own), t->old, dim);
}

/* Eight particles in motion. */
typedef struct mpm_motion {
    tobi_float4 turn[8];               /* 0, and where they stand between nodes along x, y, z      */
    tobi_float4 moved[8], speed[8];    /* m/s: what moves them, and what they keep                 */
    lane way2[3], speed2, wrong;       /* largest squares so far, and NaN if there was one         */
} mpm_motion;

TOBI_FN void mpm_begin_motion(mpm_motion *m)
{
    mpm_clear(m->moved, 8);
    mpm_clear(m->speed, 8);
    for (int a = 0; a < 3; a++) m->way2[a] = lane_set(0);
    m->speed2 = m->wrong = lane_set(0);
}

TOBI_FN void mpm_find_turn(const mpm_stencil *s, mpm_motion *m, const int dim)
{
    const lane zero = lane_set(0), z = dim == 3 ? lane_load(s->offset[2]) : zero;
    lane_store_float4(m->turn, 1, MPM_WIDE, zero, lane_load(s->offset[0]), lane_load(s->offset[1]), z);
}

/* Raises the largest squares by those of eight particles. */
TOBI_FN void mpm_note_speed(mpm_motion *m, const int plain)
{
    const int32_t next[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    lane u[4], square = lane_set(0);
    lane_load_float4(m->moved, next, &u[0], &u[1], &u[2], &u[3]);
    for (int a = 0; a < 3; a++) m->way2[a] = lane_where_less(m->way2[a], u[a]*u[a], u[a]*u[a], m->way2[a]);
    lane_load_float4(plain ? m->moved : m->speed, next, &u[0], &u[1], &u[2], &u[3]);
    square = u[0]*u[0] + u[1]*u[1] + u[2]*u[2];
    m->speed2 = lane_where_less(m->speed2, square, square, m->speed2);
    m->wrong = m->wrong + (square - square);
}

/* totals: 6 largest speed squared, infinite if one is no number, 7 largest way along an axis, m. */
TOBI_FN void mpm_end_motion(const mpm_motion *m, double dt, double *totals)
{
    for (int k = 0; k < MPM_WIDE; k++) {
        const float speed2 = lane_at(m->wrong, k) == 0 ? lane_at(m->speed2, k) : INFINITY;
        if (speed2 > totals[6]) totals[6] = speed2;
        for (int a = 0; a < 3; a++) {
            const double way = sqrtf(lane_at(m->way2[a], k))*dt;
            if (way > totals[7]) totals[7] = way;
        }
    }
}

/* The rows of nodes that a particle feels, kept for those after it that feel the same. */
typedef struct mpm_gathered {
    row g[9];
    int32_t first;
    mpm_hidden hidden;                 /* from the twins' tiles                                    */
} mpm_gathered;

TOBI_FN void mpm_begin_gathered(mpm_gathered *f)
{
    for (int r = 0; r < 9; r++) f->g[r] = row_set(0);
    f->first = -1;
    f->hidden = (mpm_hidden){{0}};
}

TOBI_FN void mpm_find_rows(const tobi_float4 *tile, int levels, int32_t first, const mpm_hidden *hidden,
                           mpm_gathered *f, const int dim)
{
    if (f->first == first && mpm_is_same(&f->hidden, hidden)) return;
    f->first = first;
    f->hidden = *hidden;
    if (mpm_is_hidden(hidden)) mpm_load_split(tile, levels, first, hidden, f->g, dim);
    else mpm_load_rows(tile, first, f->g, dim);
}

/* Particle i, k of eight: velocity, its gradient, eq. (14), and new position. levels: of the block.
   plain: no FLIP, no cuts. gathered: of `now` and `old`. The w of the velocity: the force
   of a contact in this step is kept for the next, and only that long. The w of the gradient: where the
   particle is at home, for mpm_grid_restore. */
TOBI_FN void mpm_move(const mpm_view *v, const mpm_around *t, const mpm_stencil *s, int k, int64_t i,
                      int levels, quad home, mpm_motion *m, mpm_gathered gathered[2], const int dim,
                      const int plain)
{
    const float scale = (float)(4*v->inverse_cell);
    const quad factor = {1, scale, scale, scale};
    tobi_double3 *const position = v->position + i;
    tobi_float4 *const velocity = v->velocity + i;
    row g[9];
    mpm_hidden hidden;
    if (plain) mpm_load_rows(t->now, s->first[k], g, dim);
    else {
        hidden = mpm_read_hidden(v, i, levels);
        mpm_find_rows(t->now, levels, s->first[k], &hidden, &gathered[0], dim);
    }
    row all = mpm_interpolate(plain ? g : gathered[0].g, s, k, dim);
    quad u = row_first(all);
    all = row_sub(all, row_mul(row_repeat(u), row_spread(quad_load(&m->turn[k]))));
    u = u + quad_load(&t->frame);
    row_store_others(v->affine + i, row_take_w(row_mul(all, row_spread(factor)), row_spread(home)));
    position->x += (double)u[0]*v->dt;
    position->y += (double)u[1]*v->dt;
    if (dim == 3) position->z += (double)u[2]*v->dt;
    quad_store(&m->moved[k], u);
    if (!plain && v->old) {
        const quad own = quad_load(velocity)*quad_set(v->material[v->solid[i]].keep*v->own) -
                         quad_load(&t->frame)*quad_set(v->own);
        mpm_find_rows(t->old, levels, s->first[k], &hidden, &gathered[1], dim);
        u = u + quad_set(v->flip)*(own - row_first(mpm_interpolate(gathered[1].g, s, k, dim)));
    }
    if (!plain) quad_store(&m->speed[k], u);
    u[3] = velocity->w > 0 ? -velocity->w : 0;
    quad_store(velocity, u);
}

/* Checkpoints read a particle's block there, see mpm_grid_restore. */
TOBI_FN void mpm_keep_base(const mpm_view *v, int64_t i, quad home)
{
    for (int c = 0; c < 3; c++) v->affine[i].c[c].w = home[1 + c];
}

TOBI_FN void mpm_move_block(const mpm_view *v, const mpm_block *b, const mpm_around *t, mpm_motion *m,
                            const int dim, const int plain)
{
    const quad home = {0, (float)b->corner[0], (float)b->corner[1], (float)b->corner[2]};
    mpm_gathered gathered[2];
    for (int n = 0; n < 2; n++) mpm_begin_gathered(&gathered[n]);
    for (int64_t i = b->begin; i < b->end; i += MPM_WIDE) {
        const int count = b->end - i < MPM_WIDE ? (int)(b->end - i) : MPM_WIDE;
        mpm_stencil s;
        mpm_find_stencil(v, b, i, dim, &s);
        mpm_find_turn(&s, m, dim);
        for (int k = 0; k < count; k++) {
            if (v->material[v->solid[i + k]].model == TOBI_STATIONARY) mpm_keep_base(v, i + k, home);
            else mpm_move(v, t, &s, k, i + k, b->levels, home, m, gathered, dim, plain);
        }
        mpm_note_speed(m, plain);
    }
}

/* Returns how many particles had to be brought back into the domain, in blocks at its sides. */
TOBI_FN int64_t mpm_keep_block_inside(const mpm_view *v, const mpm_block *b, const int dim)
{
    int edge = 0;
    int64_t kept = 0;
    for (int a = 0; a < dim; a++) edge |= b->corner[a] < 2 || (b->corner[a] + 8)*(double)v->cell > v->size[a];
    for (int64_t i = b->begin; i < b->end && edge; i++)
        if (v->material[v->solid[i]].model != TOBI_STATIONARY)
            kept += mpm_keep_inside(&v->position[i], v, dim);
    return kept;
}

/* Velocities, their gradients and new positions of a block's particles.
   totals: 0 particles that had to be kept inside the domain, 6 and 7 see mpm_end_motion. */
TOBI_FN void mpm_gather(const mpm_view *view, int64_t number, double *totals, const int dim)
{
    const mpm_view v = *view;      /* a copy, or every store could change it for all the compiler knows */
    const mpm_block *b = &v.block[number];
    mpm_around around;
    mpm_motion motion;
    mpm_copy_nodes(&v, number, &around, dim);
    mpm_begin_motion(&motion);
    if (!v.old && b->levels == 0) mpm_move_block(&v, b, &around, &motion, dim, 1);
    else mpm_move_block(&v, b, &around, &motion, dim, 0);
    totals[0] += (double)mpm_keep_block_inside(&v, b, dim);
    mpm_end_motion(&motion, v.dt, totals);
}

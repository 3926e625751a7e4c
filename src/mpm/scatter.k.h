/* Particles to grid, MLS-MPM (Hu et al. 2018) with quadratic B-splines, docs/theory/mlsmpm.md.
   A block's particles are read eight at a time: their weights and stresses are computed side by side, then
   each adds to the 3 x 3 rows of nodes it feels, which stay in registers as long as the next particle has the
   same base node. Particles need not be in the order of their base nodes; that is only faster.
   Axes are (x, y, z), rows run along z; in 2-D they are (x, nothing, y). */
#pragma once
#include "mpm/cut/split.k.h"

/* nodes: a multiple of four. */
TOBI_FN void mpm_clear(tobi_float4 *tile, int nodes)
{
    const row zero = row_set(0);
    for (int n = 0; n < nodes; n += 4) row_store(tile + n, zero);
}

/* The rows of nodes of one cell, as long as its particles follow one another and the same nodes are hidden
   from them. */
typedef struct mpm_cell {
    row sum[9];
    row across[3];                     /* 3-D: goes to the rows along y times 1, -2, 1            */
    int32_t first;                     /* node of the tile; -1 = none                             */
    mpm_hidden hidden;
} mpm_cell;

TOBI_FN void mpm_clear_cell(mpm_cell *c)
{
    for (int r = 0; r < 9; r++) c->sum[r] = row_set(0);
    for (int n = 0; n < 3; n++) c->across[n] = row_set(0);
    c->first = -1;
    c->hidden = (mpm_hidden){{0}};
}

/* The rows of a tile that something reaches. */
TOBI_FN uint64_t mpm_all_rows(const mpm_reach *reach)
{
    return reach->rows[0] | reach->rows[1] | reach->rows[2];
}

/* Notes the rows of the 3 x 3 x 3 nodes from `first` on. Returns those that are new. */
TOBI_FN uint64_t mpm_note_rows(mpm_reach *reach, int32_t first, const int dim)
{
    const uint64_t rows = UINT64_C(0x070707) << (dim == 3 ? first >> 3 : first);
    const uint64_t fresh = rows & ~mpm_all_rows(reach);
    const int z = dim == 3 ? first & 7 : 1;
    reach->rows[0] |= z >= 3 ? rows : 0;
    reach->rows[1] |= z <= 4 ? rows : 0;
    reach->rows[2] |= z == 0 ? rows : 0;
    return fresh;
}

/* Clears rows of a tile. */
TOBI_FN void mpm_clear_rows(tobi_float4 *tile, uint64_t rows, const int dim)
{
    for (; rows; rows &= rows - 1) {
        const int at = tobi_lowest_bit(rows)*(dim == 3 ? 8 : 1);
        if (dim == 2) tile[at] = (tobi_float4){0, 0, 0, 0};
        else mpm_clear(tile + at, 8);
    }
}

/* Adds the cell's sums to the tile, those of hidden nodes to the twins'. reach: of all; bent: eq. (3b). */
TOBI_FN void mpm_leave_cell(tobi_float4 *const *tile, int levels, mpm_cell *c, mpm_reach *reach,
                            const int dim, const int bent)
{
    if (c->first < 0) return;
    (void)mpm_note_rows(&reach[0], c->first, dim);
    for (int n = 0; n < 3 && dim == 3 && bent; n++) {
        c->sum[3*n] = row_add(c->sum[3*n], c->across[n]);
        c->sum[3*n + 1] = row_fma(c->across[n], row_set(-2), c->sum[3*n + 1]);
        c->sum[3*n + 2] = row_add(c->sum[3*n + 2], c->across[n]);
        c->across[n] = row_set(0);
    }
    if (levels > 0 && mpm_is_hidden(&c->hidden)) {
        for (int q = 1; q < 1 << levels; q++)
            if (mpm_part(&c->hidden, q, levels))
                mpm_clear_rows(tile[q], mpm_note_rows(&reach[q], c->first, dim), dim);
        mpm_leave_split(tile, levels, c->sum, c->first, &c->hidden, dim);
        for (int r = 0; r < 9; r++) c->sum[r] = row_set(0);
        return;
    }
    for (int r = 0; r < (dim == 3 ? 9 : 3); r++) {
        tobi_float4 *at = tile[0] + c->first + (dim == 3 ? 64*(r/3) + 8*(r%3) : 8*r);
        row_store(at, row_add(row_load(at), c->sum[r]));
        c->sum[r] = row_set(0);
    }
}

/* Adds particle k of eight to the sums. */
TOBI_FN void mpm_add_particle(mpm_cell *c, const mpm_stencil *s, const mpm_load *load, int k, const int dim,
                              const int bent)
{
    const int last = dim - 1, rows = dim == 3 ? 3 : 1;
    const quad step = {0, 1, 2, 0}, bow = {1, -2, 1, 0};
    const row w = row_spread(quad_load(&s->along[k])), zero = row_set(0);
    const row d0 = row_mul(row_repeat(quad_load(&load->column[0][k])), w),
              d1 = dim == 3 ? row_mul(row_repeat(quad_load(&load->column[1][k])), w) : w,
              b0 = bent ? row_mul(row_repeat(quad_load(&load->bend[0][k])), w) : zero,
              b1 = bent && dim == 3 ? row_mul(row_repeat(quad_load(&load->bend[1][k])), w) : zero,
              b2 = bent ? row_mul(b0, row_set(-2)) : zero;
    row x = row_mul(row_fma(row_repeat(quad_load(&load->column[last][k])), row_spread(step),
                            row_repeat(quad_load(&load->base[k]))), w);
    if (bent) x = row_fma(row_repeat(quad_load(&load->bend[last][k])), row_spread(bow), x);
    for (int n = 0; n < 3; n++) {
        row wx = row_set(s->weight[0][n][k]), u = row_mul(d1, wx), y0 = row_set(1);
        row t = bent ? row_fma(x, wx, n == 1 ? b2 : b0) : row_mul(x, wx);
        if (dim == 3) y0 = row_set(s->weight[1][0][k]);
        if (dim == 3 && bent) c->across[n] = row_fma(b1, wx, c->across[n]);
        c->sum[rows*n] = row_fma(t, y0, c->sum[rows*n]);
        if (dim == 3) {
            t = row_add(t, u);
            c->sum[3*n + 1] = row_fma(t, row_set(s->weight[1][1][k]), c->sum[3*n + 1]);
            t = row_add(t, u);
            c->sum[3*n + 2] = row_fma(t, row_set(s->weight[1][2][k]), c->sum[3*n + 2]);
        }
        x = row_add(x, d0);
    }
}

/* One particle's momentum alone, without stress: FLIP's changes are measured against it. */
TOBI_FN void mpm_add_unstressed(tobi_float4 *tile, const mpm_stencil *s, int k, quad momentum, const int dim)
{
    const int rows = dim == 3 ? 3 : 1;
    const row x = row_mul(row_repeat(momentum), row_spread(quad_load(&s->along[k])));
    for (int n = 0; n < 3; n++)
        for (int r = 0; r < rows; r++) {
            tobi_float4 *at = tile + s->first[k] + (dim == 3 ? 64*n + 8*r : 8*n);
            float w = dim == 3 ? s->weight[0][n][k]*s->weight[1][r][k] : s->weight[0][n][k];
            row_store(at, row_add(row_load(at), row_mul(x, row_set(w))));
        }
}

/* The cleared tile of block `number`, NULL = no such block. */
TOBI_FN tobi_float4 *mpm_clear_tile(tobi_float4 *tiles, int64_t number, const int dim)
{
    const int nodes = (dim == 3 ? MPM_TILE_3D : MPM_TILE_2D) + 8;
    if (!tiles || number < 0) return NULL;
    mpm_clear(tiles + number*nodes, nodes);
    return tiles + number*nodes;
}

/* Where a block's particles add to: tiles of each velocity. */
typedef struct mpm_targets {
    tobi_float4 *tile[MPM_VELOCITIES], *unstressed[MPM_VELOCITIES];      /* without stress; NULL with APIC */
    const float *side;                                         /* sides of the nodes at cuts       */
} mpm_targets;

/* Clears the tiles in `tiles` of a block and its twins. */
TOBI_FN void mpm_clear_tiles(const mpm_block *b, tobi_float4 *tiles, int64_t number, tobi_float4 **out,
                             const int dim)
{
    out[0] = mpm_clear_tile(tiles, number, dim);
    for (int q = 1; q < 1 << b->levels; q++) out[q] = mpm_clear_tile(tiles, b->twin + q - 1, dim);
}

/* own: the block's tile, in the making. Rows of the twins' tiles are cleared when something reaches them. */
TOBI_FN void mpm_find_targets(const mpm_view *v, int64_t number, tobi_float4 *own, mpm_targets *t,
                              const int dim)
{
    const mpm_block *b = &v->block[number];
    const int64_t nodes = (dim == 3 ? MPM_TILE_3D : MPM_TILE_2D) + 8;
    t->tile[0] = own;
    for (int q = 1; q < 1 << b->levels; q++) t->tile[q] = v->tile + (b->twin + q - 1)*nodes;
    mpm_clear_tiles(b, v->old ? v->unstressed : NULL, number, t->unstressed, dim);
    t->side = b->levels > 0 ? v->sides + (int64_t)b->sides*MPM_SIDES : NULL;
}

/* Where a block's particles add to: their tile alone, its twins too, and those of what feels no
   stress. */
enum { MPM_PLAIN, MPM_SPLIT, MPM_UNSTRESSED };

/* Returns the kinetic energy that damping takes, J. */
TOBI_FN double mpm_add_block(const mpm_view *v, const mpm_block *b, const mpm_targets *t, mpm_reach *reach,
                             const int dim, const int kind, const int bent)
{
    const quad zero[3] = {quad_set(0), quad_set(0), quad_set(0)};
    const int levels = kind == MPM_PLAIN ? 0 : b->levels;
    double taken = 0;
    mpm_cell cell;
    mpm_clear_cell(&cell);
    const tobi_float4 frame = reach->frame;
    for (int64_t i = b->begin; i < b->end; i += MPM_WIDE) {
        const int count = b->end - i < MPM_WIDE ? (int)(b->end - i) : MPM_WIDE;
        mpm_stencil s;
        mpm_load load;
        mpm_find_stencil(v, b, i, dim, &s);
        taken += mpm_find_load(v, i, count, &s, &frame, dim, &load);
        for (int k = 0; k < count; k++) {
            mpm_hidden hidden = {{0}};
            if (levels > 0) hidden = mpm_find_hidden(v, i + k, t->side, levels, s.first[k], dim);
            if (s.first[k] != cell.first || (levels > 0 && !mpm_is_same(&hidden, &cell.hidden))) {
                mpm_leave_cell(t->tile, levels, &cell, reach, dim, bent);
                cell.first = s.first[k];
                cell.hidden = hidden;
            }
            mpm_add_particle(&cell, &s, &load, k, dim, bent);
            if (kind != MPM_UNSTRESSED) continue;
            const quad momentum = quad_load(&load.momentum[k]);
            if (mpm_is_hidden(&hidden))
                mpm_add_split(t->unstressed, levels, &s, k, &hidden, momentum, zero, dim);
            else mpm_add_unstressed(t->unstressed[0], &s, k, momentum, dim);
        }
    }
    mpm_leave_cell(t->tile, levels, &cell, reach, dim, bent);
    return taken;
}

TOBI_FN double mpm_add_kind(const mpm_view *v, const mpm_block *b, const mpm_targets *t, mpm_reach *reach,
                            const int dim, const int bent)
{
    if (t->unstressed[0]) return mpm_add_block(v, b, t, reach, dim, MPM_UNSTRESSED, bent);
    if (b->levels > 0) return mpm_add_block(v, b, t, reach, dim, MPM_SPLIT, bent);
    return mpm_add_block(v, b, t, reach, dim, MPM_PLAIN, bent);
}

/* Copies the rows of a tile that something reaches. */
TOBI_FN void mpm_copy_rows(tobi_float4 *to, const tobi_float4 *tile, const mpm_reach *reach, const int dim)
{
    for (uint64_t rows = mpm_all_rows(reach); rows; rows &= rows - 1) {
        const int at = tobi_lowest_bit(rows)*(dim == 3 ? 8 : 1);
        if (dim == 2) to[at] = tile[at];
        for (int n = 0; n < 8 && dim == 3; n += 4) row_store(to + at + n, row_load(tile + at + n));
    }
}

/* Momentum and mass of a block's particles into its tile. totals: 0 energy taken by damping, J. */
TOBI_FN void mpm_scatter(const mpm_view *view, int64_t number, double *totals, const int dim)
{
    const mpm_view v = *view;      /* a copy, or every store could change it for all the compiler knows */
    const mpm_block *b = &v.block[number];
    const int nodes = (dim == 3 ? MPM_TILE_3D : MPM_TILE_2D) + 8;
    tobi_float4 tile[MPM_TILE_3D + 8];
    mpm_targets targets;
    mpm_reach reach[MPM_VELOCITIES] = {{{0, 0, 0}, {0, 0, 0, 0}}};     /* of the tile and its twins */
    mpm_clear(tile, nodes);
    mpm_find_targets(&v, number, tile, &targets, dim);
    for (int q = 0; q < 1 << b->levels; q++) reach[q].frame = mpm_find_frame(&v, b);
    totals[0] += v.bent ? mpm_add_kind(&v, b, &targets, reach, dim, 1) :
                          mpm_add_kind(&v, b, &targets, reach, dim, 0);
    v.reach[number] = reach[0];
    for (int q = 1; q < 1 << b->levels; q++) v.reach[b->twin + q - 1] = reach[q];
    mpm_copy_rows(v.tile + number*nodes, tile, &reach[0], dim);
}

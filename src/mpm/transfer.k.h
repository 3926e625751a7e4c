/* The transfers of MLS-MPM (Hu et al. 2018) with quadratic B-splines, docs/theory/mlsmpm.md.
   A block's particles are read eight at a time: their weights and stresses are computed side by side, then
   each adds to the 3 x 3 rows of nodes it feels, which stay in registers as long as the next particle has the
   same base node. Particles need not be in the order of their base nodes; that is only faster.
   Axes are (x, y, z), rows run along z; in 2-D they are (x, nothing, y). */
#pragma once
#include "mpm/split.k.h"

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
TOBI_FN void mpm_add_calm(tobi_float4 *tile, const mpm_stencil *s, int k, quad momentum, const int dim)
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
    tobi_float4 *tile[MPM_VELOCITIES], *calm[MPM_VELOCITIES];  /* calm: without stress; NULL with APIC */
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
    mpm_clear_tiles(b, v->old ? v->calm : NULL, number, t->calm, dim);
    t->side = b->levels > 0 ? v->sides + (int64_t)b->sides*MPM_SIDES : NULL;
}

/* Where a block's particles add to: their tile alone, its twins too, all targets. */
enum { MPM_PLAIN, MPM_SPLIT, MPM_CALM };

/* Returns the kinetic energy that damping takes, J. */
TOBI_FN double mpm_add_block(const mpm_view *v, const mpm_block *b, const mpm_targets *t, mpm_reach *reach,
                             const int dim, const int kind, const int bent)
{
    const quad zero[3] = {quad_set(0), quad_set(0), quad_set(0)};
    const int levels = kind == MPM_PLAIN ? 0 : b->levels;
    double taken = 0;
    mpm_cell cell;
    mpm_clear_cell(&cell);
    for (int64_t i = b->begin; i < b->end; i += MPM_WIDE) {
        const int count = b->end - i < MPM_WIDE ? (int)(b->end - i) : MPM_WIDE;
        mpm_stencil s;
        mpm_load load;
        mpm_find_stencil(v, b, i, dim, &s);
        taken += mpm_find_load(v, i, count, &s, dim, &load);
        for (int k = 0; k < count; k++) {
            mpm_hidden hidden = {{0}};
            if (levels > 0) hidden = mpm_find_hidden(v, i + k, t->side, levels, s.first[k], dim);
            if (s.first[k] != cell.first || (levels > 0 && !mpm_is_same(&hidden, &cell.hidden))) {
                mpm_leave_cell(t->tile, levels, &cell, reach, dim, bent);
                cell.first = s.first[k];
                cell.hidden = hidden;
            }
            mpm_add_particle(&cell, &s, &load, k, dim, bent);
            if (kind != MPM_CALM) continue;
            const quad momentum = quad_load(&load.momentum[k]);
            if (mpm_is_hidden(&hidden)) mpm_add_split(t->calm, levels, &s, k, &hidden, momentum, zero, dim);
            else mpm_add_calm(t->calm[0], &s, k, momentum, dim);
        }
    }
    mpm_leave_cell(t->tile, levels, &cell, reach, dim, bent);
    return taken;
}

TOBI_FN double mpm_add_kind(const mpm_view *v, const mpm_block *b, const mpm_targets *t, mpm_reach *reach,
                            const int dim, const int bent)
{
    if (t->calm[0]) return mpm_add_block(v, b, t, reach, dim, MPM_CALM, bent);
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
    mpm_reach reach[MPM_VELOCITIES] = {{{0, 0, 0}}};       /* of the tile and its twins */
    mpm_clear(tile, nodes);
    mpm_find_targets(&v, number, tile, &targets, dim);
    totals[0] += v.bent ? mpm_add_kind(&v, b, &targets, reach, dim, 1) :
                          mpm_add_kind(&v, b, &targets, reach, dim, 0);
    v.reach[number] = reach[0];
    for (int q = 1; q < 1 << b->levels; q++) v.reach[b->twin + q - 1] = reach[q];
    mpm_copy_rows(v.tile + number*nodes, tile, &reach[0], dim);
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

/* Rows x 8 + y of a tile that lie in the node blocks before, beside and behind its own along x, and y. */
TOBI_FN uint64_t mpm_rows_at(int x, int y)
{
    const uint64_t along[3] = {UINT64_C(0x0101010000000000), UINT64_C(0x0000000101010100), UINT64_C(1)},
                   across[3] = {UINT64_C(0xe0), UINT64_C(0x1e), UINT64_C(0x01)};
    return along[x]*across[y];
}

/* Sums the tiles over a block of nodes: momentum and mass, in the order of `cover`. Counted from the node -4
   of a block, nodes 4 b .. 4 b + 3 are those of the block at offset b - 1; tiles begin at 3. 0: there is
   nothing. */
TOBI_FN int mpm_sum_tiles(const mpm_view *v, const mpm_patch *g, const tobi_float4 *tiles, quad *sum,
                          const int dim)
{
    int any = 0;
    for (int n = 0; n < (dim == 3 ? MPM_NODES_3D : MPM_NODES_2D); n++) sum[n] = quad_set(0);
    for (int o = 0; o < 27; o++) {
        if (g->cover[o] < 0) continue;
        const int x = o/9, y = o/3%3, z = o%3, count = dim == 2 || z == 2 ? 1 : 3 + z;
        const tobi_float4 *tile = tiles + (int64_t)g->cover[o]*((dim == 3 ? MPM_TILE_3D : MPM_TILE_2D) + 8);
        uint64_t rows = v->reach[g->cover[o]].rows[z] & mpm_rows_at(x, y);
        any |= rows != 0;
        for (; rows; rows &= rows - 1) {
            const int row = tobi_lowest_bit(rows), at = 4*((row >> 3) + 4*x - 5) + (row & 7) + 4*y - 5;
            const tobi_float4 *from = dim == 3 ? tile + 8*row + (z == 0 ? 5 : z == 1 ? 1 : 0) : tile + row;
            quad *to = dim == 3 ? sum + 4*at + (z == 2 ? 3 : 0) : sum + at;
            for (int n = 0; n < count; n++) to[n] = to[n] + quad_load(from + n);
        }
    }
    return any;
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
    const quad fall = {v->fall[0], v->fall[1], v->fall[2], 0};
    tobi_float4 *node = v->node + number*nodes;
    quad sum[MPM_NODES_3D], calm[MPM_NODES_3D], given = quad_set(0);
    if (!mpm_sum_tiles(v, g, v->tile, sum, dim)) {
        mpm_clear(node, nodes);
        if (v->old) mpm_clear(v->old + number*nodes, nodes);
        if (v->wave) mpm_clear(v->wave + number*nodes, nodes);
        return;
    }
    if (v->old) mpm_sum_tiles(v, g, v->calm, calm, dim);
    for (int n = 0; n < nodes; n++) {
        const float mass = sum[n][3], divisor = mass > 0 ? mass : INFINITY;
        quad u = sum[n]/quad_set(divisor);
        if (v->old) {
            quad before = calm[n]/quad_set(divisor);
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
TOBI_FN void mpm_copy_tile(const tobi_float4 *node, const int32_t around[27], tobi_float4 *tile,
                           const int dim)
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

/* The same of a twin, of whose rows few carry anything: those that something reaches, and, since rows are
   read a node too far, the one after each. */
TOBI_FN void mpm_copy_reached(const tobi_float4 *node, const int32_t around[27], const mpm_reach *reach,
                              tobi_float4 *tile, const int dim)
{
    const uint64_t some = mpm_all_rows(reach);
    for (uint64_t rows = some | some << 1; rows; rows &= rows - 1) {
        const int at = tobi_lowest_bit(rows), x = (at >> 3) + 3, y = (at & 7) + 3;  /* from the node -4 */
        const int32_t *block = around + 9*(x >> 2) + 3*(y >> 2);
        const tobi_float4 *from = node + (dim == 3 ? 16*(x & 3) + 4*(y & 3) : 4*(x & 3) + (y & 3));
        if (dim == 2) {
            tile[at] = from[(int64_t)block[1]*MPM_NODES_2D];
            continue;
        }
        tobi_float4 *to = tile + 8*at;
        to[0] = from[(int64_t)block[0]*MPM_NODES_3D + 3];
        row_store(to + 1, row_load(from + (int64_t)block[1]*MPM_NODES_3D));
        row_store(to + 5, row_load(from + (int64_t)block[2]*MPM_NODES_3D));
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

/* The nodes around a block as its particles feel them, by velocity: velocity, and what replaces their own. */
typedef struct mpm_around {
    tobi_float4 now[MPM_VELOCITIES*(MPM_TILE_3D + 8)], old[MPM_VELOCITIES*(MPM_TILE_3D + 8)];
} mpm_around;

/* Tiles of all velocities from a layer of nodes. */
TOBI_FN void mpm_copy_tiles(const mpm_view *v, int64_t number, const tobi_float4 *node, tobi_float4 *tile,
                            const int dim)
{
    const mpm_block *b = &v->block[number];
    for (int q = 0; q < 1 << b->levels; q++, tile += MPM_TILE_3D + 8) {
        const int64_t twin = b->twin + q - 1;
        if (q == 0) mpm_copy_tile(node, b->around, tile, dim);
        else mpm_copy_reached(node, v->block[twin].around, &v->reach[twin], tile, dim);
        mpm_clear(tile + (dim == 3 ? MPM_TILE_3D : MPM_TILE_2D), 8);   /* what the last rows read beyond */
    }
}

TOBI_FN void mpm_copy_nodes(const mpm_view *v, int64_t number, mpm_around *t, const int dim)
{
    mpm_copy_tiles(v, number, v->node, t->now, dim);
    if (v->old) mpm_copy_tiles(v, number, v->old, t->old, dim);
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
typedef struct mpm_felt {
    row g[9];
    int32_t first;
    mpm_hidden hidden;                 /* from the twins' tiles                                    */
} mpm_felt;

TOBI_FN void mpm_begin_felt(mpm_felt *f)
{
    for (int r = 0; r < 9; r++) f->g[r] = row_set(0);
    f->first = -1;
    f->hidden = (mpm_hidden){{0}};
}

TOBI_FN void mpm_find_rows(const tobi_float4 *tile, int levels, int32_t first, const mpm_hidden *hidden,
                           mpm_felt *f, const int dim)
{
    if (f->first == first && mpm_is_same(&f->hidden, hidden)) return;
    f->first = first;
    f->hidden = *hidden;
    if (mpm_is_hidden(hidden)) mpm_load_split(tile, levels, first, hidden, f->g, dim);
    else mpm_load_rows(tile, first, f->g, dim);
}

/* Particle i, k of eight: velocity, its gradient, eq. (14), and new position. levels: of the block.
   plain: no FLIP, no cuts. felt: of `now` and `old`. The w of the velocity: the force
   of a contact in this step is kept for the next, and only that long. The w of the gradient: where the
   particle is at home, for mpm_grid_restore. */
TOBI_FN void mpm_move(const mpm_view *v, const mpm_around *t, const mpm_stencil *s, int k, int64_t i,
                      int levels, quad home, mpm_motion *m, mpm_felt felt[2], const int dim,
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
        mpm_find_rows(t->now, levels, s->first[k], &hidden, &felt[0], dim);
    }
    row all = mpm_interpolate(plain ? g : felt[0].g, s, k, dim);
    quad u = row_first(all);
    all = row_sub(all, row_mul(row_repeat(u), row_spread(quad_load(&m->turn[k]))));
    row_store_others(v->affine + i, row_take_w(row_mul(all, row_spread(factor)), row_spread(home)));
    position->x += (double)u[0]*v->dt;
    position->y += (double)u[1]*v->dt;
    if (dim == 3) position->z += (double)u[2]*v->dt;
    quad_store(&m->moved[k], u);
    if (!plain && v->old) {
        const quad own = quad_load(velocity)*quad_set(v->material[v->solid[i]].keep*v->own);
        mpm_find_rows(t->old, levels, s->first[k], &hidden, &felt[1], dim);
        u = u + quad_set(v->flip)*(own - row_first(mpm_interpolate(felt[1].g, s, k, dim)));
    }
    if (!plain) quad_store(&m->speed[k], u);
    u[3] = velocity->w > 0 ? -velocity->w : 0;
    quad_store(velocity, u);
}

TOBI_FN void mpm_move_block(const mpm_view *v, const mpm_block *b, const mpm_around *t, mpm_motion *m,
                            const int dim, const int plain)
{
    const quad home = {0, (float)b->corner[0], (float)b->corner[1], (float)b->corner[2]};
    mpm_felt felt[2];
    for (int n = 0; n < 2; n++) mpm_begin_felt(&felt[n]);
    for (int64_t i = b->begin; i < b->end; i += MPM_WIDE) {
        const int count = b->end - i < MPM_WIDE ? (int)(b->end - i) : MPM_WIDE;
        mpm_stencil s;
        mpm_find_stencil(v, b, i, dim, &s);
        mpm_find_turn(&s, m, dim);
        for (int k = 0; k < count; k++) {
            if (v->material[v->solid[i + k]].model == TOBI_STATIONARY) continue;
            mpm_move(v, t, &s, k, i + k, b->levels, home, m, felt, dim, plain);
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

/* Kernels over blocks, as tobi_launch wants them. */
#define MPM_KERNEL(NAME, BODY, DIM)                                                                 \
    static void NAME(const void *view, int64_t begin, int64_t end, double *totals)                  \
    {                                                                                               \
        for (int64_t n = begin; n < end; n++) BODY((const mpm_view *)view, n, totals, DIM);         \
    }

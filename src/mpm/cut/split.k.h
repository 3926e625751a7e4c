/* Nodes with several velocities, docs/theory/cutting.md: a particle exchanges with the second velocity of the
   nodes that lie across a cut from it, where cuts cross with that of its own piece, and with the first of all
   others. */
#pragma once
#include "mpm/cut/cuts.h"
#include "exec/rows.h"
#include "mpm/particle.k.h"

/* 1 for each of the three nodes of a row that the bits name, and for the fourth that carries nothing. */
TOBI_FN quad mpm_take(uint32_t bits)
{
    return (quad){(float)(bits & 1), (float)(bits >> 1 & 1), (float)(bits >> 2 & 1), 1};
}

/* Which of the nodes that feel a particle, whose lowest is `first`, have this side. */
TOBI_FN uint32_t mpm_match_sides(const float *side, int32_t first, float other, int dim)
{
    const int rows = dim == 3 ? 9 : 3;
    uint32_t found = 0;
    for (int r = 0; r < rows; r++) {
        const float *at = side + first + (dim == 3 ? 64*(r/3) + 8*(r%3) : 8*r);
        found |= quad_matches(quad_load(at), other) << 3*r;
    }
    return found;
}

/* Which of its velocities each node that feels a particle shows it: bit l of the number in level[l], see
   mpm_view.hidden. */
typedef struct mpm_hidden { uint32_t level[MPM_LEVELS]; } mpm_hidden;

TOBI_FN int mpm_is_hidden(const mpm_hidden *h)
{
    uint32_t any = 0;
    for (int l = 0; l < MPM_LEVELS; l++) any |= h->level[l];
    return any != 0;
}

TOBI_FN int mpm_is_same(const mpm_hidden *a, const mpm_hidden *b)
{
    uint32_t other = 0;
    for (int l = 0; l < MPM_LEVELS; l++) other |= a->level[l] ^ b->level[l];
    return other == 0;
}

/* The nodes that show velocity q, by its lowest bits. */
TOBI_FN uint32_t mpm_part(const mpm_hidden *h, int q, int levels)
{
    uint32_t part = MPM_HIDDEN;
    for (int l = 0; l < levels; l++) part &= q >> l & 1 ? h->level[l] : ~h->level[l];
    return part;
}

/* The number of the velocity that node n of those that feel the particle shows. */
TOBI_FN int mpm_number_at(const mpm_hidden *h, int n)
{
    int q = 0;
    for (int l = 0; l < MPM_LEVELS; l++) q |= (int)(h->level[l] >> n & 1) << l;
    return q;
}

/* As it was found in this step. */
TOBI_FN mpm_hidden mpm_read_hidden(const mpm_view *v, int64_t i, int levels)
{
    mpm_hidden h;
    for (int l = 0; l < MPM_LEVELS; l++) h.level[l] = l < levels ? v->hidden[l][i] & MPM_HIDDEN : 0;
    return h;
}

/* The nodes with a side that the particle is across from, by a cut or by the group of its solid. */
TOBI_FN uint32_t mpm_match_all(const mpm_view *v, int64_t i, const float *side, int32_t first, int dim)
{
    uint32_t found = 0;
    if (v->apart)
        found = mpm_match_sides(side, first, mpm_side_of(v->material[v->solid[i]].group), dim);
    for (int k = 0; v->cuts && k < TOBI_CUTS_EACH && v->cuts[i].c[k].w != 0; k++)
        found |= mpm_match_sides(side, first, -v->cuts[i].c[k].w, dim);
    return found;
}

/* The nodes whose cut the particle does not know and at which it is a neighbor of those across. apart:
   from the tile of the sides to those of the neighbors. */
TOBI_FN uint32_t mpm_match_neighbors(const mpm_view *v, int64_t i, const float *side, int64_t apart,
                                  int32_t first, int dim)
{
    uint32_t own = 0, neighbor = 0;
    for (int k = 0; v->cuts && k < TOBI_CUTS_EACH && v->cuts[i].c[k].w != 0; k++) {
        own |= mpm_match_sides(side, first, v->cuts[i].c[k].w, dim);
        for (int n = 1; n <= MPM_NEIGHBORS; n++)
            neighbor |= mpm_match_sides(side + n*apart, first, v->cuts[i].c[k].w, dim);
    }
    return neighbor & ~own;
}

/* The nodes across the cuts of every level from a particle, and those whose second velocity is its solid's.
   Found anew when its base node is another: masks are cleared whenever sides are found, so that it can only
   be one beside it, which parities tell apart. */
TOBI_FN mpm_hidden mpm_find_hidden(const mpm_view *v, int64_t i, const float *side, int levels, int32_t first,
                                   int dim)
{
    const uint32_t place = (8u | (first >> 4 & 4) | (first >> 2 & 2) | (first & 1))*(MPM_HIDDEN + 1u);
    mpm_hidden h = {{0}};
    if ((v->hidden[0][i] & ~(uint32_t)MPM_HIDDEN) == place) return mpm_read_hidden(v, i, levels);
    for (int l = 0; l < levels; l++) {
        uint32_t found = 0;
        for (int q = 0; q < 1 << l; q++) {
            const float *at = side + ((1 << l) - 1 + q)*MPM_SIDES;
            uint32_t across = mpm_match_all(v, i, at, first, dim);
            if (levels > 1)
                across |= mpm_match_neighbors(v, i, at, ((1 << levels) - 1)*MPM_SIDES, first, dim);
            found |= mpm_part(&h, q, l) & across;
        }
        h.level[l] = found;
        v->hidden[l][i] = l == 0 ? found | place : found;
    }
    return h;
}

/* Adds (base + column a times the distance along axis a, in nodes) times the weights to the nodes of one
   particle, each in the tile of the velocity it shows. */
TOBI_FN void mpm_add_split(tobi_float4 *const *tile, int levels, const mpm_stencil *s, int k,
                           const mpm_hidden *hidden, quad base, const quad column[3], const int dim)
{
    const int last = dim - 1, rows = dim == 3 ? 3 : 1;
    const quad step = {0, 1, 2, 0}, along = {s->weight[last][0][k], s->weight[last][1][k],
                                             s->weight[last][2][k], 0};
    const row w = row_spread(along), d0 = row_mul(row_repeat(column[0]), w),
              d1 = row_mul(row_repeat(column[1]), w);
    row x = row_mul(row_fma(row_repeat(column[last]), row_spread(step), row_repeat(base)), w);
    for (int n = 0; n < 3; n++) {
        row y = row_mul(x, row_set(s->weight[0][n][k]));
        const row turn = row_mul(d1, row_set(s->weight[0][n][k]));
        for (int r = 0; r < rows; r++) {
            const int32_t at = s->first[k] + (dim == 3 ? 64*n + 8*r : 8*n);
            const row value = dim == 3 ? row_mul(y, row_set(s->weight[1][r][k])) : y;
            for (int q = 0; q < 1 << levels; q++) {
                const uint32_t bits = mpm_part(hidden, q, levels) >> 3*(n*rows + r) & 7;
                if (bits)
                    row_store(tile[q] + at,
                              row_fma(value, row_spread(mpm_take(bits)), row_load(tile[q] + at)));
            }
            y = row_add(y, turn);
        }
        x = row_add(x, d0);
    }
}

/* Adds rows of sums to the nodes from `first` on, each in the tile of the velocity it shows. */
TOBI_FN void mpm_leave_split(tobi_float4 *const *tile, int levels, const row *sum, int32_t first,
                             const mpm_hidden *hidden, const int dim)
{
    for (int q = 0; q < 1 << levels; q++) {
        const uint32_t part = mpm_part(hidden, q, levels);
        for (int r = 0; part != 0 && r < (dim == 3 ? 9 : 3); r++) {
            tobi_float4 *at = tile[q] + first + (dim == 3 ? 64*(r/3) + 8*(r%3) : 8*r);
            const uint32_t bits = part >> 3*r & 7;
            if (bits) row_store(at, row_fma(sum[r], row_spread(mpm_take(bits)), row_load(at)));
        }
    }
}

/* The rows of nodes of one particle, each from the tile of the velocity it shows; the tiles follow one
   another. */
TOBI_FN void mpm_load_split(const tobi_float4 *tile, int levels, int32_t first, const mpm_hidden *hidden,
                            row *g, const int dim)
{
    uint32_t seen = 0;                 /* rows that have something                                */
    for (int q = 0; q < 1 << levels; q++, tile += MPM_TILE_3D + 8) {
        const uint32_t part = mpm_part(hidden, q, levels);
        for (int r = 0; part != 0 && r < (dim == 3 ? 9 : 3); r++) {
            const uint32_t bits = part >> 3*r & 7;
            if (!bits) continue;
            const row from = row_load(tile + first + (dim == 3 ? 64*(r/3) + 8*(r%3) : 8*r)),
                      take = row_spread(mpm_take(bits));
            g[r] = bits == 7 ? from : seen >> r & 1 ? row_fma(from, take, g[r]) : row_mul(from, take);
            seen |= 1u << r;
        }
    }
}

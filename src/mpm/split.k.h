/* Nodes with two velocities, docs/theory/cutting.md: a particle exchanges with the second velocity of the
   nodes that lie across a cut from it, and with the first of all others. */
#pragma once
#include "core/cuts.h"
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

/* The nodes across a cut from a particle, and those whose second velocity is its solid's: see
   mpm_view.hidden. Found anew when its base node is another: masks are cleared whenever sides are found, so
   that it can only be one beside it, which parities tell apart. */
TOBI_FN uint32_t mpm_find_hidden(const mpm_view *v, int64_t i, const float *side, int32_t first, int dim)
{
    const uint32_t place = (8u | (first >> 4 & 4) | (first >> 2 & 2) | (first & 1))*(MPM_HIDDEN + 1u);
    uint32_t hidden = v->hidden[i];
    if ((hidden & ~(uint32_t)MPM_HIDDEN) == place) return hidden & MPM_HIDDEN;
    hidden = 0;
    if (v->apart)
        hidden = mpm_match_sides(side, first, mpm_side_of(v->material[v->solid[i]].group), dim);
    for (int k = 0; v->cuts && k < TOBI_CUTS_EACH && v->cuts[i].c[k].w != 0; k++)
        hidden |= mpm_match_sides(side, first, -v->cuts[i].c[k].w, dim);
    v->hidden[i] = hidden | place;
    return hidden;
}

/* Adds (base + column a times the distance along axis a, in nodes) times the weights to the nodes of one
   particle: those hidden in the twin's tile. */
TOBI_FN void mpm_add_split(tobi_float4 *tile, tobi_float4 *twin, const mpm_stencil *s, int k, uint32_t hidden,
                           quad base, const quad column[3], const int dim)
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
            const uint32_t bits = hidden >> 3*(n*rows + r) & 7;
            const row value = dim == 3 ? row_mul(y, row_set(s->weight[1][r][k])) : y;
            if (bits == 0 || bits == 7) {
                tobi_float4 *to = (bits ? twin : tile) + at;
                row_store(to, row_add(value, row_load(to)));
            } else {
                const row first = row_spread(mpm_take(~bits)), second = row_spread(mpm_take(bits));
                row_store(tile + at, row_fma(value, first, row_load(tile + at)));
                row_store(twin + at, row_fma(value, second, row_load(twin + at)));
            }
            y = row_add(y, turn);
        }
        x = row_add(x, d0);
    }
}

/* Adds rows of sums to the nodes from `first` on: those hidden in the twin's tile. */
TOBI_FN void mpm_leave_split(tobi_float4 *tile, tobi_float4 *twin, const row *sum, int32_t first,
                             uint32_t hidden, const int dim)
{
    for (int r = 0; r < (dim == 3 ? 9 : 3); r++) {
        const int32_t at = first + (dim == 3 ? 64*(r/3) + 8*(r%3) : 8*r);
        const uint32_t bits = hidden >> 3*r & 7;
        const row own = row_spread(mpm_take(~bits)), other = row_spread(mpm_take(bits));
        if (bits != 7) row_store(tile + at, row_fma(sum[r], own, row_load(tile + at)));
        if (bits != 0) row_store(twin + at, row_fma(sum[r], other, row_load(twin + at)));
    }
}

/* The rows of nodes of one particle, those hidden from the twin's tile. */
TOBI_FN void mpm_load_split(const tobi_float4 *tile, const tobi_float4 *twin, int32_t first, uint32_t hidden,
                            row *g, const int dim)
{
    const int rows = dim == 3 ? 9 : 3;
    for (int r = 0; r < rows; r++) {
        const int32_t at = first + (dim == 3 ? 64*(r/3) + 8*(r%3) : 8*r);
        const uint32_t bits = hidden >> 3*r & 7;
        g[r] = row_load((bits == 7 ? twin : tile) + at);
        if (bits != 0 && bits != 7)
            g[r] = row_fma(row_load(twin + at), row_spread(mpm_take(bits)),
                           row_mul(g[r], row_spread(mpm_take(~bits))));
    }
}

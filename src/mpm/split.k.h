/* Nodes with two velocities, docs/theory/cutting.md: a particle exchanges with the second velocity of the
   nodes that lie across a cut from it, and with the first of all others. */
#pragma once
#include "core/cuts.h"
#include "exec/rows.h"
#include "mpm/particle.k.h"

/* Nodes of a tile that belong to the node block at offset -1, 0 or 1 along an axis. */
TOBI_FN int mpm_span_first(int offset) { return offset < 0 ? 0 : offset == 0 ? 1 : 5; }
TOBI_FN int mpm_span_last(int offset) { return offset < 0 ? 0 : offset == 0 ? 4 : 7; }

/* The sides of the nodes around a block, into a tile. */
TOBI_FN void mpm_copy_sides(const mpm_view *v, const mpm_block *b, float *tile, int dim)
{
    for (int o = 0; o < 27; o++) {
        if (dim == 2 && o%3 != 1) continue;
        const int ox = o/9 - 1, oy = o/3%3 - 1, oz = dim == 3 ? o%3 - 1 : 0;
        const float *from = v->side + (int64_t)b->around[o]*(dim == 3 ? MPM_NODES_3D : MPM_NODES_2D);
        for (int x = mpm_span_first(ox); x <= mpm_span_last(ox); x++)
            for (int y = mpm_span_first(oy); y <= mpm_span_last(oy); y++) {
                const int row = (x - 1 - 4*ox)*4 + (y - 1 - 4*oy);
                if (dim == 2) tile[x*8 + y] = from[row];
                for (int z = mpm_span_first(oz); z <= mpm_span_last(oz) && dim == 3; z++)
                    tile[(x*8 + y)*8 + z] = from[row*4 + (z - 1 - 4*oz)];
            }
    }
}

/* The nodes across a cut from a particle whose lowest node is `first`: see mpm_view.hidden. */
TOBI_FN uint32_t mpm_find_hidden(const tobi_columns *cuts, const float *side, int32_t first, int dim)
{
    uint32_t hidden = 0;
    for (int k = 0; k < TOBI_CUTS_EACH && cuts->c[k].w != 0; k++)
        for (int n = 0; n < (dim == 3 ? 27 : 9); n++) {
            const float *at = side + first + (dim == 3 ? 64*(n/9) + 8*(n/3%3) + n%3 : 8*(n/3) + n%3);
            hidden |= (uint32_t)(*at == -cuts->c[k].w) << n;
        }
    return hidden;
}

/* Adds (base + column a times the distance along axis a, in nodes) times the weights to the nodes of one
   particle: those hidden in the twin's tile. */
TOBI_FN void mpm_add_split(tobi_float4 *tile, tobi_float4 *twin, const mpm_stencil *s, int k, uint32_t hidden,
                           quad base, const quad column[3], const int dim)
{
    const int last = dim - 1, rows = dim == 3 ? 3 : 1;
    for (int x = 0, bit = 0; x < 3; x++)
        for (int y = 0; y < rows; y++) {
            const int32_t row = s->first[k] + (dim == 3 ? 64*x + 8*y : 8*x);
            const float w = dim == 3 ? s->weight[0][x][k]*s->weight[1][y][k] : s->weight[0][x][k];
            quad value = base + column[0]*quad_set((float)x);
            if (dim == 3) value = value + column[1]*quad_set((float)y);
            for (int z = 0; z < 3; z++, bit++) {
                tobi_float4 *to = (hidden >> bit & 1 ? twin : tile) + row + z;
                quad_store(to, quad_load(to) + value*quad_set(w*s->weight[last][z][k]));
                value = value + column[last];
            }
        }
}

/* The rows of nodes of one particle, those hidden from the twin's tile. */
TOBI_FN void mpm_load_split(const tobi_float4 *tile, const tobi_float4 *twin, int32_t first, uint32_t hidden,
                            row *g, const int dim)
{
    const int rows = dim == 3 ? 9 : 3;
    for (int r = 0; r < rows; r++) {
        const int32_t at = first + (dim == 3 ? 64*(r/3) + 8*(r%3) : 8*r);
        tobi_float4 mixed[4];
        for (int z = 0; z < 3; z++) mixed[z] = (hidden >> (3*r + z) & 1 ? twin : tile)[at + z];
        mixed[3] = (tobi_float4){0, 0, 0, 0};
        g[r] = row_load(mixed);
    }
}

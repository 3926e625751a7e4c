/* The nodes of one particle, by the block that it is at home in. Drawback: a block is looked for by bisection
   whenever the particle is not of the same as the one before. */
#include "mpm/feel.h"
#include "mpm/spline.h"
#include <string.h>

static const mpm_block *block_of(const mpm_grid *g, int64_t particle)
{
    int64_t low = 0, high = g->block_count - 1;
    while (low < high) {
        int64_t middle = (low + high + 1)/2;
        if (g->block[middle].begin <= particle) low = middle;
        else high = middle - 1;
    }
    return &g->block[low];
}

static void list_nodes(const mpm_grid *g, const mpm_felt *f, uint32_t *node)
{
    const int three = g->dimension == 3, nodes = three ? MPM_NODES_3D : MPM_NODES_2D;
    for (int n = 0; n < mpm_nodes_each(g); n++) {
        const int at[3] = {f->first[0] + (three ? n/9 : n/3), f->first[1] + (three ? n/3 : n)%3,
                           f->first[2] + (three ? n%3 : 0)};
        const int q = mpm_number_at(&f->hidden, n);
        const mpm_block *from = q ? &g->block[f->block->twin + q - 1] : f->block;
        const int64_t patch = from->around[((at[0] >> 2)*3 + (at[1] >> 2))*3 + (three ? at[2] >> 2 : 1)];
        const int row = (at[0] & 3)*4 + (at[1] & 3);
        node[n] = (uint32_t)(patch*nodes + (three ? row*4 + (at[2] & 3) : row));
    }
}

static int is_felt(const mpm_felt *f, const mpm_block *b, const int first[3], const mpm_hidden *hidden)
{
    return f->block == b && !memcmp(f->first, first, sizeof f->first) && mpm_is_same(&f->hidden, hidden);
}

void mpm_feel(const mpm_grid *g, const mpm_view *v, int64_t i, mpm_felt *last, uint32_t *node,
              double weight[3][3], int base[3])
{
    const mpm_block *b = last->block;
    if (!b || i < b->begin || i >= b->end) b = block_of(g, i);
    const mpm_hidden hidden = mpm_read_hidden(v, i, b->levels);
    int first[3] = {0, 0, 0};
    for (int a = 0; a < g->dimension; a++) {
        base[a] = (int)mpm_spline((&v->position[i].x)[a]*v->inverse_cell, weight[a]);
        first[a] = base[a] - b->corner[a] + 4;
    }
    if (is_felt(last, b, first, &hidden)) memcpy(node, last->node, (size_t)mpm_nodes_each(g)*sizeof *node);
    else {
        *last = (mpm_felt){ .block = b, .first = {first[0], first[1], first[2]}, .hidden = hidden };
        list_nodes(g, last, node);
    }
    last->node = node;
}

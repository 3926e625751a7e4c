#define TOBI_SCALAR_LANES 1
#include "mpm/touch.h"
#include "base/error.h"
#include "mpm/transfer.k.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SWEEPS = 8 };

void mpm_touch_free(mpm_touch *t)
{
    free(t->node);
    free(t->weight);
    free(t->crowd);
    memset(t, 0, sizeof *t);
}

static int nodes_each(const mpm_grid *g) { return g->dimension == 3 ? 27 : 9; }

static tobi_status reserve(mpm_touch *t, const mpm_grid *g, int64_t contacts, tobi_error *err)
{
    int64_t each = nodes_each(g), nodes = g->patch_count*(g->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D);
    if (contacts > t->room) {
        int64_t room = contacts + contacts/4 + 256;
        free(t->node);
        free(t->weight);
        t->node = malloc((size_t)(room*each)*sizeof *t->node);
        t->weight = malloc((size_t)(room*each)*sizeof *t->weight);
        t->room = t->node && t->weight ? room : 0;
        if (!t->room)
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld contacts", (long long)contacts);
    }
    if (nodes > t->node_room) {
        free(t->crowd);
        t->crowd = calloc((size_t)(nodes + nodes/8), sizeof *t->crowd);
        t->node_room = t->crowd ? nodes + nodes/8 : 0;
        if (!t->node_room)
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld nodes", (long long)nodes);
    }
    return TOBI_OK;
}

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

/* Place of a tile's node in the array of nodes. */
static int64_t place_of(const mpm_block *b, int dim, int32_t tile)
{
    int at[3] = {tile/64, tile/8%8, tile%8};
    if (dim == 2) { at[0] = tile/8; at[1] = tile%8; at[2] = 1; }
    int o = 0, n = 0;
    for (int a = 0; a < 3; a++) {
        o = o*3 + (at[a] + 3)/4;
        if (a < dim) n = n*4 + (at[a] + 3)%4;
    }
    return (int64_t)b->around[o]*(dim == 3 ? MPM_NODES_3D : MPM_NODES_2D) + n;
}

static void find_nodes(mpm_touch *t, const tobi_contacts *c, const mpm_grid *g, const mpm_view *v,
                       tobi_exec *x)
{
    const int dim = g->dimension, each = nodes_each(g);
    #pragma omp parallel for num_threads(x->threads)
    for (int64_t k = 0; k < c->count; k++) {
        const mpm_block *b = block_of(g, c->list[k].particle);
        mpm_stencil s;
        mpm_find_stencil(v, b, c->list[k].particle, dim, &s);
        for (int n = 0; n < each; n++) {
            int i = dim == 3 ? n/9 : n/3, j = dim == 3 ? n/3%3 : n%3, l = n%3;
            float w = s.weight[0][i][0]*s.weight[1][j][0];
            t->node[k*each + n] = place_of(b, dim, s.first[0] + (dim == 3 ? i*64 + j*8 + l : i*8 + j));
            t->weight[k*each + n] = dim == 3 ? w*s.weight[2][l][0] : w;
        }
    }
}

/* Rows of the matrix that turns impulses into velocities: their sums bound how strongly all contacts together
   move each, so that sweeps of all at once converge. */
static void find_mobility(mpm_touch *t, tobi_contacts *c, const mpm_grid *g, tobi_exec *x)
{
    const int64_t each = nodes_each(g);
    for (int64_t k = 0; k < c->count*each; k++) t->crowd[t->node[k]] = 0;
    for (int64_t k = 0; k < c->count*each; k++) t->crowd[t->node[k]] += t->weight[k];
    #pragma omp parallel for num_threads(x->threads)
    for (int64_t k = 0; k < c->count; k++) {
        double sum = 0;
        for (int64_t n = k*each; n < (k + 1)*each; n++)
            if (g->node[t->node[n]].w > 0) sum += t->weight[n]*t->crowd[t->node[n]]/g->node[t->node[n]].w;
        c->list[k].mobility = sum;
    }
}

static void read_velocities(const mpm_touch *t, tobi_contacts *c, const mpm_grid *g, tobi_exec *x)
{
    const int64_t each = nodes_each(g);
    #pragma omp parallel for num_threads(x->threads)
    for (int64_t k = 0; k < c->count; k++) {
        double u[3] = {0, 0, 0};
        for (int64_t n = k*each; n < (k + 1)*each; n++)
            for (int a = 0; a < 3; a++) u[a] += t->weight[n]*(&g->node[t->node[n]].x)[a];
        memcpy(c->list[k].velocity, u, sizeof u);
    }
}

/* Nodes are few along a surface; each is changed by many contacts, in the order of the list. */
static void add_impulses(const mpm_touch *t, const tobi_contacts *c, const mpm_grid *g)
{
    const int64_t each = nodes_each(g);
    for (int64_t k = 0; k < c->count; k++)
        for (int64_t n = k*each; n < (k + 1)*each; n++) {
            tobi_float4 *node = &g->node[t->node[n]];
            if (!(node->w > 0)) continue;
            for (int a = 0; a < 3; a++)
                (&node->x)[a] += (float)(t->weight[n]*c->list[k].change[a]/node->w);
        }
}

static tobi_status touch_body(mpm_touch *t, tobi_simulation *s, tobi_body *b, const mpm_grid *g,
                              const mpm_view *v, const tobi_contact_step *step, tobi_error *err)
{
    tobi_contacts *c = &s->contacts;
    TOBI_TRY(tobi_contact_find(c, &s->particles, b, step, &s->exec, err));
    if (c->count == 0) return TOBI_OK;
    TOBI_TRY(reserve(t, g, c->count, err));
    find_nodes(t, c, g, v, &s->exec);
    find_mobility(t, c, g, &s->exec);
    read_velocities(t, c, g, &s->exec);
    tobi_contact_aim(c, b, step, &s->exec);
    for (int sweep = 0; sweep <= SWEEPS; sweep++) {
        tobi_contact_sweep(c, b, step, sweep == 0, &s->exec);
        add_impulses(t, c, g);
        read_velocities(t, c, g, &s->exec);
    }
    return TOBI_OK;
}

tobi_status mpm_touch_bodies(mpm_touch *t, tobi_simulation *s, const mpm_grid *g, const mpm_view *v,
                             const tobi_contact_step *step, tobi_error *err)
{
    t->far = 0;
    s->info.contacts = 0;
    if (s->body_count == 0) return TOBI_OK;
    TOBI_TRY(tobi_contact_begin(&s->contacts, &s->particles, &s->exec, err));
    for (int k = 0; k < s->body_count; k++) {
        TOBI_TRY(touch_body(t, s, &s->bodies[k], g, v, step, err));
        s->info.contacts += tobi_contact_finish(&s->contacts, &s->particles, &s->bodies[k], step, &t->far,
                                                &s->exec);
    }
    return TOBI_OK;
}

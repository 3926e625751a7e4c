#define TOBI_SCALAR_LANES 1
#include "mpm/touch.h"
#include "base/error.h"
#include "mpm/transfer.k.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SWEEPS = 8 };

static void free_entries(mpm_touch *t)
{
    free(t->node); free(t->weight); free(t->key); free(t->key_scratch);
    free(t->order); free(t->order_scratch); free(t->begin);
    t->room = 0;
}

void mpm_touch_free(mpm_touch *t)
{
    free_entries(t);
    free(t->crowd);
    free(t->histogram);
    memset(t, 0, sizeof *t);
}

static int nodes_each(const mpm_grid *g) { return g->dimension == 3 ? 27 : 9; }

static tobi_status reserve_entries(mpm_touch *t, int64_t count, tobi_error *err)
{
    if (count <= t->room) return TOBI_OK;
    int64_t room = count + count/4 + 4096;
    free_entries(t);
    t->node = malloc((size_t)room*sizeof *t->node);
    t->weight = malloc((size_t)room*sizeof *t->weight);
    t->key = malloc((size_t)room*sizeof *t->key);
    t->key_scratch = malloc((size_t)room*sizeof *t->key_scratch);
    t->order = malloc((size_t)room*sizeof *t->order);
    t->order_scratch = malloc((size_t)room*sizeof *t->order_scratch);
    t->begin = malloc((size_t)(room + 1)*sizeof *t->begin);
    if (t->node && t->weight && t->key && t->key_scratch && t->order && t->order_scratch && t->begin) {
        t->room = room;
        return TOBI_OK;
    }
    free_entries(t);
    t->node = t->key = t->key_scratch = NULL;
    t->weight = NULL;
    t->order = t->order_scratch = NULL;
    t->begin = NULL;
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld contacts", (long long)count);
}

static tobi_status reserve(mpm_touch *t, const mpm_grid *g, int64_t contacts, const tobi_exec *x,
                           tobi_error *err)
{
    int64_t nodes = g->patch_count*(g->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D);
    t->count = contacts*nodes_each(g);
    TOBI_TRY(reserve_entries(t, t->count, err));
    if (!t->histogram) t->histogram = malloc((size_t)tobi_sort_histogram_size(x)*sizeof *t->histogram);
    if (nodes > t->node_room) {
        free(t->crowd);
        t->node_room = nodes + nodes/8;
        t->crowd = malloc((size_t)t->node_room*sizeof *t->crowd);
    }
    if (t->crowd && t->histogram) return TOBI_OK;
    t->node_room = 0;
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld nodes", (long long)nodes);
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
            t->node[k*each + n] = (uint32_t)place_of(b, dim, s.first[0] +
                                                     (dim == 3 ? i*64 + j*8 + l : i*8 + j));
            t->weight[k*each + n] = dim == 3 ? w*s.weight[2][l][0] : w;
        }
    }
}

/* Lists the entries of every node. */
static void sort_by_node(mpm_touch *t, const mpm_grid *g, tobi_exec *x)
{
    int64_t nodes = g->patch_count*(g->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D);
    memcpy(t->key, t->node, (size_t)t->count*sizeof *t->key);
    tobi_sort_by_key(x, t->count, (uint32_t)nodes, t->key, t->order, t->key_scratch, t->order_scratch,
                     t->histogram);
    t->touched = tobi_find_runs(x, t->count, t->key, 0, t->begin);
    t->begin[t->touched] = t->count;
}

/* Rows of the matrix that turns impulses into velocities: their sums bound how strongly all contacts together
   move each, so that sweeps of all at once converge. */
static void find_mobility(mpm_touch *t, tobi_contacts *c, const mpm_grid *g, tobi_exec *x)
{
    const int64_t each = nodes_each(g);
    #pragma omp parallel for num_threads(x->threads)
    for (int64_t n = 0; n < t->touched; n++) {
        float sum = 0;
        for (int64_t e = t->begin[n]; e < t->begin[n + 1]; e++) sum += t->weight[t->order[e]];
        t->crowd[t->key[t->begin[n]]] = sum;
    }
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

static void add_impulses(const mpm_touch *t, const tobi_contacts *c, const mpm_grid *g, tobi_exec *x)
{
    const int64_t each = nodes_each(g);
    #pragma omp parallel for num_threads(x->threads)
    for (int64_t n = 0; n < t->touched; n++) {
        tobi_float4 *node = &g->node[t->key[t->begin[n]]];
        double sum[3] = {0, 0, 0};
        if (!(node->w > 0)) continue;
        for (int64_t e = t->begin[n]; e < t->begin[n + 1]; e++) {
            const tobi_contact *k = &c->list[t->order[e]/each];
            for (int a = 0; a < 3; a++) sum[a] += t->weight[t->order[e]]*k->change[a];
        }
        for (int a = 0; a < 3; a++) (&node->x)[a] += (float)(sum[a]/node->w);
    }
}

static tobi_status touch_body(mpm_touch *t, tobi_simulation *s, tobi_body *b, const mpm_grid *g,
                              const mpm_view *v, const tobi_contact_step *step, tobi_error *err)
{
    tobi_contacts *c = &s->contacts;
    TOBI_TRY(tobi_contact_find(c, &s->particles, b, step, &s->exec, err));
    if (c->count == 0) return TOBI_OK;
    TOBI_TRY(reserve(t, g, c->count, &s->exec, err));
    find_nodes(t, c, g, v, &s->exec);
    sort_by_node(t, g, &s->exec);
    find_mobility(t, c, g, &s->exec);
    read_velocities(t, c, g, &s->exec);
    tobi_contact_aim(c, b, step, &s->exec);
    for (int sweep = 0; sweep <= SWEEPS; sweep++) {
        tobi_contact_sweep(c, b, step, sweep == 0, &s->exec);
        add_impulses(t, c, g, &s->exec);
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

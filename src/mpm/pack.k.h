/* Between contacts and nodes, four contacts at a time. Particles of one cell feel the same nodes, so that one
   read of a node serves four. A pack that writes to nodes must not run while another of the same nodes does:
   mpm_packs_visit sees to that. */
#pragma once
#include "exec/rows.h"

typedef struct mpm_pack {
    int32_t contact[4];                /* empty lanes repeat the first, with weights of 0          */
    int32_t used;                      /* lanes                                                    */
    int32_t count;                     /* nodes, a multiple of three                               */
    int64_t node, weight;              /* where its nodes begin; its weights, four for each node   */
} mpm_pack;

/* 1/kg: of a node, and times the sum of the weights there. */
typedef struct mpm_yield { float inverse, crowd; } mpm_yield;

typedef struct mpm_pack_view {
    const mpm_pack *TOBI_RESTRICT pack;
    const uint32_t *TOBI_RESTRICT node;
    const float *TOBI_RESTRICT weight;
    tobi_float4 *TOBI_RESTRICT velocity;   /* [nodes] m/s, and mass, kg                            */
    mpm_yield *TOBI_RESTRICT yield;        /* [nodes]                                              */
    tobi_float4 *TOBI_RESTRICT push;       /* [contacts] N s, to be put on the nodes               */
    tobi_float4 *TOBI_RESTRICT moving;     /* [contacts] m/s, w: 1/kg, see mpm_pack_answer         */
} mpm_pack_view;

/* Adds the weights up at the nodes. */
TOBI_FN void mpm_pack_crowd(const mpm_pack_view *v, int64_t number)
{
    const mpm_pack *p = &v->pack[number];
    const uint32_t *node = v->node + p->node;
    const float *weight = v->weight + p->weight;
    const int count = p->count;
    for (int n = 0; n < count; n++, weight += 4) {
        mpm_yield *y = &v->yield[node[n]];
        if (y->crowd == 0) y->inverse = v->velocity[node[n]].w > 0 ? 1/v->velocity[node[n]].w : 0;
        y->crowd += ((weight[0] + weight[1]) + (weight[2] + weight[3]))*y->inverse;
    }
}

/* Rows of the matrix that turns impulses into velocities: their sums bound how strongly all contacts together
   move each, so that sweeps of all at once converge. */
TOBI_FN void mpm_pack_answer(const mpm_pack_view *v, int64_t number)
{
    const mpm_pack *p = &v->pack[number];
    const uint32_t *node = v->node + p->node;
    const float *weight = v->weight + p->weight;
    const int count = p->count;
    quad sum = quad_set(0);
    for (int n = 0; n < count; n++, weight += 4)
        sum = sum + quad_load(weight)*quad_set(v->yield[node[n]].crowd);
    for (int k = 0; k < p->used; k++) v->moving[p->contact[k]].w = sum[k];
}

/* The sums are wanted empty by the next step. */
TOBI_FN void mpm_pack_forget(const mpm_pack_view *v, int64_t number)
{
    const mpm_pack *p = &v->pack[number];
    const uint32_t *node = v->node + p->node;
    const int count = p->count;
    for (int n = 0; n < count; n++) v->yield[node[n]].crowd = 0;
}

TOBI_FN void mpm_pack_read(const mpm_pack_view *v, int64_t number)
{
    const mpm_pack *p = &v->pack[number];
    const uint32_t *node = v->node + p->node;
    const float *weight = v->weight + p->weight;
    const int count = p->count;
    row u[3] = {row_set(0), row_set(0), row_set(0)};
    tobi_float4 out[4];
    for (int n = 0; n < count; n += 3)
        for (int k = 0; k < 3; k++)
            u[k] = row_fma(row_spread(quad_load(weight + 4*(n + k))),
                           row_repeat(quad_load(&v->velocity[node[n + k]])), u[k]);
    row_store(out, row_add(row_add(u[0], u[1]), u[2]));
    for (int k = 0; k < p->used; k++) v->moving[p->contact[k]] = out[k];
}

TOBI_FN void mpm_pack_push(const mpm_pack_view *v, int64_t number)
{
    const mpm_pack *p = &v->pack[number];
    const uint32_t *node = v->node + p->node;
    const float *weight = v->weight + p->weight;
    const int count = p->count;
    tobi_float4 in[4];
    for (int k = 0; k < 4; k++) in[k] = v->push[p->contact[k]];
    const row push = row_load(in);
    for (int n = 0; n < count; n++, weight += 4) {
        tobi_float4 *to = &v->velocity[node[n]];
        const quad sum = row_fold(row_mul(row_spread(quad_load(weight)), push));
        quad_store(to, quad_load(to) + sum*quad_set(v->yield[node[n]].inverse));
    }
}

#define MPM_PACK_KERNEL(NAME, BODY)                                                                 \
    static void NAME(const void *view, int64_t begin, int64_t end, double *totals)                  \
    {                                                                                               \
        (void)totals;                                                                               \
        for (int64_t n = begin; n < end; n++) BODY((const mpm_pack_view *)view, n);                 \
    }

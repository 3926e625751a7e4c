/* Between contacts and nodes, four contacts at a time. Particles of one cell feel the same nodes, so that one
   read of a node serves four. Every contact has two weights at a node, for what is along its normal and along
   the surface, eq. (2b), (2c) of docs/theory/contact.md. A pack that writes to nodes must not run while
   another of the same nodes does: mpm_packs_visit sees to that. */
#pragma once
#include "exec/rows.h"

typedef struct mpm_pack {
    int32_t contact[4];                /* empty lanes repeat the first, with weights of 0          */
    int32_t used;                      /* lanes                                                    */
    int32_t count;                     /* nodes, a multiple of three                               */
    int64_t node, weight;              /* where its nodes begin; its weights, twice four for each  */
} mpm_pack;

/* 1/kg: of a node, and times the sum of the weights there, of each kind. */
typedef struct mpm_response { float inverse, load[2]; } mpm_response;

typedef struct mpm_pack_view {
    const mpm_pack *TOBI_RESTRICT pack;
    const uint32_t *TOBI_RESTRICT node;
    const float *TOBI_RESTRICT weight;
    tobi_float4 *TOBI_RESTRICT velocity;   /* [nodes] m/s, and mass, kg                            */
    mpm_response *TOBI_RESTRICT response;  /* [nodes]                                              */
    tobi_float4 *TOBI_RESTRICT push;       /* [contacts][2] N s, to be put on the nodes            */
    tobi_float4 *TOBI_RESTRICT moving;     /* [contacts][2] m/s, w: 1/kg, see mpm_pack_answer      */
} mpm_pack_view;

TOBI_FN quad mpm_pack_size(quad a) { return quad_larger(a, quad_set(0) - a); }

/* Adds the sizes of the weights up at the nodes. */
TOBI_FN void mpm_pack_load(const mpm_pack_view *v, int64_t number)
{
    const mpm_pack *p = &v->pack[number];
    const uint32_t *node = v->node + p->node;
    const float *weight = v->weight + p->weight;
    const int count = p->count;
    for (int n = 0; n < count; n++, weight += 8) {
        mpm_response *y = &v->response[node[n]];
        const quad along = quad_load(weight), across = mpm_pack_size(quad_load(weight + 4));
        if (y->load[0] == 0) y->inverse = v->velocity[node[n]].w > 0 ? 1/v->velocity[node[n]].w : 0;
        y->load[0] += ((along[0] + along[1]) + (along[2] + along[3]))*y->inverse;
        y->load[1] += ((across[0] + across[1]) + (across[2] + across[3]))*y->inverse;
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
    quad along = quad_set(0), across = quad_set(0);
    for (int n = 0; n < count; n++, weight += 8) {
        const mpm_response *y = &v->response[node[n]];
        along = along + quad_load(weight)*quad_set(y->load[0]);
        across = across + mpm_pack_size(quad_load(weight + 4))*quad_set(y->load[1]);
    }
    for (int k = 0; k < p->used; k++) {
        v->moving[2*p->contact[k]].w = along[k];
        v->moving[2*p->contact[k] + 1].w = across[k];
    }
}

/* The sums are wanted empty by the next step. */
TOBI_FN void mpm_pack_forget(const mpm_pack_view *v, int64_t number)
{
    const mpm_pack *p = &v->pack[number];
    const uint32_t *node = v->node + p->node;
    const int count = p->count;
    for (int n = 0; n < count; n++) v->response[node[n]].load[0] = v->response[node[n]].load[1] = 0;
}

TOBI_FN void mpm_pack_read(const mpm_pack_view *v, int64_t number)
{
    const mpm_pack *p = &v->pack[number];
    const uint32_t *node = v->node + p->node;
    const float *weight = v->weight + p->weight;
    const int count = p->count;
    row u[2][3];
    tobi_float4 out[2][4];
    for (int k = 0; k < 3; k++) u[0][k] = u[1][k] = row_set(0);
    for (int n = 0; n < count; n += 3)
        for (int k = 0; k < 3; k++, weight += 8) {
            const row velocity = row_repeat(quad_load(&v->velocity[node[n + k]]));
            u[0][k] = row_fma(row_spread(quad_load(weight)), velocity, u[0][k]);
            u[1][k] = row_fma(row_spread(quad_load(weight + 4)), velocity, u[1][k]);
        }
    for (int m = 0; m < 2; m++) row_store(out[m], row_add(row_add(u[m][0], u[m][1]), u[m][2]));
    for (int k = 0; k < p->used; k++)
        for (int m = 0; m < 2; m++) v->moving[2*p->contact[k] + m] = out[m][k];
}

TOBI_FN void mpm_pack_push(const mpm_pack_view *v, int64_t number)
{
    const mpm_pack *p = &v->pack[number];
    const uint32_t *node = v->node + p->node;
    const float *weight = v->weight + p->weight;
    const int count = p->count;
    tobi_float4 in[2][4];
    for (int k = 0; k < 4; k++)
        for (int m = 0; m < 2; m++) in[m][k] = v->push[2*p->contact[k] + m];
    const row along = row_load(in[0]), across = row_load(in[1]);
    for (int n = 0; n < count; n++, weight += 8) {
        tobi_float4 *to = &v->velocity[node[n]];
        const quad sum = row_fold(row_fma(row_spread(quad_load(weight + 4)), across,
                                          row_mul(row_spread(quad_load(weight)), along)));
        quad_store(to, quad_load(to) + sum*quad_set(v->response[node[n]].inverse));
    }
}

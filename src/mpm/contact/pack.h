/* Contacts of a step packed by the nodes they feel, for the sweeps. */
#pragma once
#include "mpm/grid.h"
#include "mpm/kernels.h"
#include "mpm/contact/pack.k.h"

/* Contacts of particles of one block of the grid, or of the edge. */
typedef struct mpm_pack_run {
    int64_t first, end;                /* contacts                                                 */
    int64_t begin, last;               /* packs                                                    */
    int colour;                        /* those of one colour share no nodes                       */
} mpm_pack_run;

enum { MPM_PACK_COLOURS = 9,           /* one block in two along each axis, and the edge           */
       MPM_PACK_NODES = 216 };         /* of a contact at most: 27, each with up to 8 velocities   */

typedef struct mpm_packs {
    mpm_pack *pack;                    /* by colour                                                */
    mpm_pack_run *run;                 /* the same                                                 */
    float *weight;
    int64_t count, room, run_count, run_room, weight_count, weight_room;
    int64_t colour[MPM_PACK_COLOURS + 1];  /* where its runs begin                                 */
} mpm_packs;

/* What is packed: `each` nodes and pairs of weights of every contact, edge_each of those from edge_first
   on. */
typedef struct mpm_pack_entries {
    const uint32_t *node;
    const float *weight;
    int64_t contacts, edge_first, each, edge_each;
} mpm_pack_entries;

/* particle: of each contact before edge_first, in rising order. */
tobi_status mpm_packs_make(mpm_packs *p, const mpm_pack_entries *e, const int32_t *particle, size_t stride,
                           const mpm_grid *g, tobi_error *err);
/* Runs a kernel over all packs: in one order at each node, whatever the number of threads. */
void mpm_packs_visit(const mpm_packs *p, tobi_kernel kernel, const mpm_pack_view *view, int threads);
void mpm_packs_free(mpm_packs *p);

/* Nodes where cuts cross: the tree of cuts that parts them, and the pairs of velocities that may touch.
   docs/theory/cutting.md. */
#pragma once
#include "core/system.h"
#include "mpm/grid.h"
#include "mpm/cut/face.h"

struct mpm_cut;

typedef struct mpm_cross {
    uint64_t *doubt;                   /* [patches] bit n: cuts may cross at node n                */
    mpm_crossing *at;                  /* [count] by node                                          */
    mpm_pair *pair;                    /* [pair_count] of all, one after the other                 */
    int64_t count, room, pair_count, pair_room;
} mpm_cross;

/* Finds the nodes in doubt at which cuts cross, once c->side holds their roots, and notes the levels of their
   patches. */
tobi_status mpm_cross_find(struct mpm_cut *c, const tobi_exec *x, mpm_grid *g, const mpm_view *v,
                           tobi_error *err);
/* Room for count crossings, and for the pairs of those that there are. */
tobi_status mpm_cross_reserve(mpm_cross *c, int64_t count, tobi_error *err);
tobi_status mpm_cross_reserve_pairs(mpm_cross *c, tobi_error *err);
/* The pairs of a node, each without faces, with the numbers of its velocities for their places: the first
   is on the own side of the cut at which they part. */
void mpm_cross_pair(mpm_cross *c, const mpm_crossing *at);
/* Once twins are numbered: the places of the velocities of all pairs. */
void mpm_cross_place(mpm_cross *c, const mpm_grid *g);
/* The first crossing at or after a node. */
int64_t mpm_cross_first(const mpm_cross *c, int64_t node);
double mpm_cross_visit(mpm_cross *c, tobi_exec *x, tobi_float4 *node, double dt, mpm_visit what);
void mpm_cross_free(mpm_cross *c);

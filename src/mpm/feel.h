/* Which nodes a particle feels: their places in the array of all nodes. */
#pragma once
#include "mpm/grid.h"
#include "mpm/cut/split.k.h"

/* What decides which nodes a particle feels, and their list: particles of one cell on one side of a cut,
   which mostly follow one another, share it. */
typedef struct mpm_felt {
    const mpm_block *block;            /* NULL = none yet                                          */
    int first[3];                      /* the lowest node, from the node -4 of the block           */
    mpm_hidden hidden;
    const uint32_t *node;
} mpm_felt;

enum { MPM_FELT = 27 };                /* nodes that a particle feels at most                      */

static inline int mpm_nodes_each(const mpm_grid *g) { return g->dimension == 3 ? 27 : 9; }

/* Lists the nodes of particle i, in the order of x, y, z, and its weights along each axis. last: of the
   particle before, whose list is copied if it is the same; it becomes that of this one. Returns the lowest
   node along each axis in base, cells. */
void mpm_feel(const mpm_grid *g, const mpm_view *v, int64_t i, mpm_felt *last, uint32_t *node,
              double weight[3][3], int base[3]);

/* The sparse grid: blocks of particles in memory order, and the blocks of nodes around them. Its memory
   follows the material, not the domain. */
#pragma once
#include "exec/exec.h"
#include "core/particles.h"
#include "mpm/view.h"

typedef struct mpm_grid {
    int dimension;
    mpm_block *block;
    mpm_patch *patch;
    mpm_reach *reach;                  /* [block_room]                                            */
    uint32_t *block_key, *patch_key;   /* in rising order, for finding neighbours                */
    int64_t block_count, patch_count, block_room, patch_room;
    int64_t block_twins, patch_twins;  /* behind the others                                       */
    int     levels;                    /* of cuts at the nodes that most cut: mpm_patch.levels     */
    tobi_float4 *node, *old, *wave;    /* [patch_room][nodes]; see view.h                         */
    char *scratch;                     /* of the sort; the tiles in between                       */
    int64_t scratch_bytes;
    int64_t *histogram;
    int64_t *begin, begin_room;        /* scratch: where runs of equal keys begin                 */
    int low[3], count[3];              /* box of blocks that holds all, with one more around      */
    int layers;                        /* of node arrays: 1 APIC, 2 FLIP, 3 XPIC                  */
} mpm_grid;

/* An empty grid; blocks come with the particles. TOBI_NO_MEMORY. */
tobi_status mpm_grid_create(mpm_grid *g, int dimension, int layers, const tobi_exec *x, tobi_error *err);
void mpm_grid_free(mpm_grid *g);
int64_t mpm_grid_bytes(const mpm_grid *g);

/* Sorts the particles by the block and the cell of their base node and builds the blocks. */
tobi_status mpm_grid_sort(mpm_grid *g, tobi_particles *p, double inverse_cell, tobi_exec *x, tobi_error *err);
/* Builds the blocks of particles that are sorted: affine[i].c[a].w holds the corner of the block of each. */
tobi_status mpm_grid_restore(mpm_grid *g, tobi_particles *p, tobi_exec *x, tobi_error *err);
/* Room for block_twins and patch_twins behind the blocks, once they are counted. */
tobi_status mpm_grid_reserve_twins(mpm_grid *g, tobi_exec *x, tobi_error *err);
/* The block of nodes that has node `at` (cells from the domain's corner), -1 = none. */
int64_t mpm_grid_find_patch(const mpm_grid *g, const int at[3]);
/* Points the view at the blocks, nodes and tiles. */
void mpm_grid_bind(const mpm_grid *g, mpm_view *v);

/* Nodes where solids meet that are not bonded: which of them has the second velocity there, the normal and
   the gap between the two. docs/theory/contact.md. */
#pragma once
#include "mpm/grid.h"
#include "mpm/seam.h"

/* Cells that particles may move before the nodes with two velocities are found anew. */
#define MPM_MEET_STALE 0.1

enum { MPM_MIXED = -1 };
/* What is known of a block of particles: their group, MPM_MIXED if there are several; lowest and highest of
   their base nodes, cells from the domain's lower corner. */
typedef struct mpm_crowd { int group, low[3], high[3]; } mpm_crowd;

mpm_crowd mpm_meet_look(const mpm_view *v, const mpm_block *b, int dimension);
/* Finds the nodes of a patch where two groups meet. crowd: of each block. side, seam: of the patch's nodes;
   those with a side already keep it. Returns 1 if there are any. */
int mpm_meet_find(const mpm_grid *g, const mpm_view *v, const mpm_crowd *crowd, const mpm_patch *p,
                  float *side, mpm_seam *seam);

/* Nodes where solids meet that are not bonded: which of them has the second velocity there, the normal and
   the gap between the two. docs/theory/contact.md. */
#pragma once
#include "mpm/grid.h"
#include "mpm/seam.h"

/* The side of a node whose second velocity is that of a group of solids (mpm_material.group): beyond the
   numbers of cuts, in steps that float still tells apart. */
TOBI_FN float mpm_side_of(int group) { return 33554432.0f + 4.0f*(float)group; }

/* The group of all particles of a block, MPM_MIXED if there are several. */
enum { MPM_MIXED = -1 };
int mpm_meet_group(const mpm_view *v, const mpm_block *b);
/* Finds the nodes of a patch where two groups meet. group: of each block. side, seam: of the patch's nodes;
   those with a side already keep it. Returns 1 if there are any. */
int mpm_meet_find(const mpm_grid *g, const mpm_view *v, const int16_t *group, const mpm_patch *p, float *side,
                  mpm_seam *seam);

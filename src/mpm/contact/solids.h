/* Nodes where solids meet that are not bonded: which of them has the second velocity there, the normal and
   the gap between the two. docs/theory/contact.md. */
#pragma once
#include "mpm/grid.h"
#include "mpm/cut/face.h"

/* Cells that particles may move before the nodes with two velocities are found anew. */
#define MPM_SOLID_CONTACT_STALE 0.1

enum { MPM_MIXED = -1 };
/* What is known of a block of particles: their group, MPM_MIXED if there are several; lowest and highest of
   their base nodes, cells from the domain's lower corner. */
typedef struct mpm_extent { int group, low[3], high[3]; } mpm_extent;

/* The extent of one block. */
mpm_extent mpm_solid_contact_look(const mpm_view *v, const mpm_block *b, int dimension);
/* Finds the nodes of a patch where two groups meet. extent: of each block. side, cut face: of the patch's
   nodes; those with a side already keep it. Returns 1 if there are any. */
int mpm_solid_contact_find(const mpm_grid *g, const mpm_view *v, const mpm_extent *extent, const mpm_patch *p,
                  float *side, mpm_cut_face *cut_face);

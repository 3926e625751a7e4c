/* Particles that remember a cut vote on which nodes have two velocities, whose the first is, and how far
   apart the faces are there. docs/theory/cutting.md. */
#pragma once
#include "mpm/cut.h"

/* F of a particle now, what the last step left to do included. */
void mpm_vote_deformation(const mpm_view *v, int64_t i, double f[3][3]);
/* Lists the voters of a block of particles, and where the faces of their cuts are now. */
void mpm_vote_list(mpm_cut *c, const mpm_view *v, const mpm_block *b, int64_t number, int dimension);
/* Sides and seams of the nodes of a patch by the listed voters; returns whether any has two velocities. */
int mpm_vote_count(mpm_cut *c, const mpm_grid *g, const mpm_view *v, int64_t patch);

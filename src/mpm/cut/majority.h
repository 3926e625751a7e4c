/* Particles that remember a cut decide by majority which nodes have two velocities, whose the first is, and
   how far apart the faces are there. docs/theory/cutting.md. */
#pragma once
#include "exec/rows.h"
#include "mpm/cut/cut.h"
#include <math.h>

enum { MPM_MAJORITIES = 4 };                /* cuts that one node looks at                              */

/* What is heard at a node from the particles on one side of a cut: sums, by mass and weight, of places (m,
   from the corner of the block) with the weights themselves, and of normals with distances from the cut
   (m). */
typedef struct mpm_side_sums { quad place, face; } mpm_side_sums;

/* Of one cut, side 0 being +. */
typedef struct mpm_majority {
    mpm_side_sums side[2];
    float number, friction;            /* 0 = none; weighted                                       */
} mpm_majority;

static inline void mpm_majority_add_side(mpm_side_sums *to, float w, quad place, quad face)
{
    to->place = to->place + place*quad_set(w);
    to->face = to->face + face*quad_set(w);
}

/* mark: of the particle, with its side. */
static inline void mpm_majority_add(mpm_majority majorities[MPM_MAJORITIES], float mark, float w, quad place,
                                    quad face,
                                float friction)
{
    int k = 0;
    while (k < MPM_MAJORITIES && majorities[k].number != 0 && majorities[k].number != fabsf(mark)) k++;
    if (k == MPM_MAJORITIES) return;
    majorities[k].number = fabsf(mark);
    majorities[k].friction += w*friction;
    mpm_majority_add_side(&majorities[k].side[mark < 0], w, place, face);
}

/* Of the cuts that have both sides here the one that most know, since who does not know it may be put on
   the wrong side; of those the one whose lesser side weighs more. NULL = there are none. both: how many
   there are. */
static inline const mpm_majority *mpm_majority_pick(const mpm_majority majorities[MPM_MAJORITIES], int *both)
{
    const mpm_majority *best = NULL;
    float most = 0;
    for (int k = 0; k < MPM_MAJORITIES && majorities[k].number != 0; k++) {
        const mpm_side_sums *side = majorities[k].side;
        const float a = side[0].place[3], b = side[1].place[3], least = fminf(a, b);
        const float score = least + 100*(a + b);           /* 1 % who do not know outweigh the rest */
        if (!(least > 0)) continue;
        ++*both;
        if (score > most) { most = score; best = &majorities[k]; }
    }
    return best;
}

/* The side that outweighs. */
static inline int mpm_majority_own(const mpm_majority *v)
{
    return v->side[1].place[3] > v->side[0].place[3];
}

/* Normal and gap between two faces, both heard. */
mpm_face mpm_majority_measure(const mpm_side_sums *first, const mpm_side_sums *second);

/* F of a particle now, what the last step left to do included. */
void mpm_majority_deformation(const mpm_view *v, int64_t i, double f[3][3]);
/* Lists the members of a block of particles, and where the faces of their cuts are now. */
void mpm_majority_list(mpm_cut *c, const mpm_view *v, const mpm_block *b, int64_t number, int dimension);
/* Sides and cut faces of the nodes of a patch by the listed members, and where cuts may cross
   (mpm_cross.doubt); returns whether any has two velocities. */
int mpm_majority_count(mpm_cut *c, const mpm_grid *g, const mpm_view *v, int64_t patch);

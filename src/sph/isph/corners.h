/* Further mirrors of particles in concave corners of one body. */
#pragma once
#include "sph/boundary/boundary.h"
#include "sph/isph/view.h"

enum { ISPH_CORNER_FACES = 2 };      /* beside the first; in 2-D one                                */

/* The further mirrors of an entry of the links; the normal of the first becomes that of its face. Answers how
   many: 0 away from concave corners. */
int isph_corner_find(const struct tobi_system *s, const tobi_boundary_link *link,
                     const tobi_boundary_entry *e, isph_mirror *first, isph_mirror more[ISPH_CORNER_FACES]);

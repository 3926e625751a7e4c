/* Second mirrors of particles in concave corners of one body. */
#pragma once
#include "sph/boundary.h"
#include "sph/isph_view.h"

struct tobi_body;

/* Velocity of a place, m from the lower corner of the box, by those of the whole body. */
void isph_corner_turn(const struct tobi_body *b, const double place[3], const double u[6], double out[3]);
/* The second mirror of an entry of the links, `out`; the normal of the first becomes that of its face. 0: it
   has one face. */
int isph_corner_find(const struct tobi_system *s, const tobi_boundary_link *link,
                     const tobi_boundary_entry *e, isph_mirror *first, isph_mirror *out);

/* Second mirrors of particles in concave corners of one body. */
#pragma once
#include "sph/boundary.h"
#include "sph/isph_view.h"

/* The second mirror of an entry of the links, `out`; the normal of the first becomes that of its face. 0: it
   has one face. */
int isph_corner_find(const struct tobi_system *s, const tobi_boundary_link *link,
                     const tobi_boundary_entry *e, isph_mirror *first, isph_mirror *out);

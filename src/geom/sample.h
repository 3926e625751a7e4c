/* Points that stand for a body: lattice points inside it, and (surface.h) pieces of its surface. */
#pragma once
#include "geom/bvh.h"
#include "geom/quadrature.h"

/* Points of a cubic lattice of the given spacing (m) inside an oriented mesh (2-D: a square lattice
   inside its section with z = 0). The lattice is shifted so that count spacing^3 meets the volume and
   the points share centre and second moments with the body, which gives thin parts their due; where
   no shift of the upright lattice comes within 1 % (a box of 12.5 spacings), the lattice is turned.
   Points come ordered by x, y, z of the lattice. *points is malloc'ed and the caller's.
   bvh is not needed and may be NULL. Errors: TOBI_INVALID (spacing, no point fits), TOBI_NO_MEMORY. */
tobi_status tobi_sample_volume(const tobi_mesh *mesh, const tobi_bvh *bvh, double spacing, int dimension,
                               double (**points)[3], int64_t *count, tobi_error *err);

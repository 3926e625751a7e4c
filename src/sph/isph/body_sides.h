/* Images of a body's surface in the sides of the domain near a particle: behind a side the body goes on. */
#pragma once
#include "sph/boundary/boundary.h"
#include "sph/isph/view.h"

/* What the images of the points which a link's particle faces add to `steady` and `height` of its entry. */
void isph_body_sides_add(const isph_view *v, const struct tobi_system *s, const tobi_boundary_link *link,
                         tobi_boundary_entry *e);

/* Images of a body's surface in the sides of the domain near a particle: behind a side the body goes on. */
#pragma once
#include "sph/boundary.h"
#include "sph/isph_view.h"

/* The images in the sides within reach of a place: in one side, and in two or three that meet. */
typedef struct isph_body_sides {
    int images;
    double wall[27][3];              /* m: of the mirrored axes                                     */
    int mirrored[27][3];             /* 1: along this axis                                          */
} isph_body_sides;

isph_body_sides isph_body_sides_near(const struct tobi_system *s, const double x[3]);
/* The place in an image. */
void isph_body_sides_mirror(const isph_body_sides *sides, int image, double place[3]);
/* What the images of the points which a link's particle faces add to share and height of its entry. */
void isph_body_sides_add(const struct tobi_system *s, const tobi_boundary_link *link, double *share,
                         double *height);

/* What a plane wall is to a smoothing kernel. Kernels read it. */
#pragma once

enum { TOBI_PLANE_SAMPLES = 512 };

/* Functions of the distance s to a plane wall, tabulated over 0 <= s <= h.
     lambda(s)  kernel integral over the half space behind the plane
     sigma(s)   kernel integral over the plane = -dlambda/ds, 1/m */
typedef struct tobi_wall_table {
    float lambda[TOBI_PLANE_SAMPLES + 2];
    float sigma[TOBI_PLANE_SAMPLES + 2];
} tobi_wall_table;

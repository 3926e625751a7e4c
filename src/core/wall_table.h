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

/* One of them at that many samples' distance, 0 or more; 0 beyond h. */
static inline double tobi_wall_table_at(const float *table, double samples)
{
    if (samples >= TOBI_PLANE_SAMPLES) return 0;
    const int k = (int)samples;
    return table[k] + (samples - k)*((double)table[k + 1] - table[k]);
}

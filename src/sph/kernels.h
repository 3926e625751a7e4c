/* The table of SPH kernels for one instruction set and one smoothing kernel. */
#pragma once
#include "exec/exec.h"
#include "sph/view.h"

typedef struct sph_kernels {
#define PAIR(K, SUMS, MAXIMA, DOC) tobi_kernel K;
#define FOR(K, SUMS, MAXIMA, DOC) tobi_kernel K;
#define COUPLE FOR
#define IMAGE PAIR
#define ISPH FOR
#include "sph/kernels.def"
#undef PAIR
#undef FOR
#undef COUPLE
#undef IMAGE
#undef ISPH
} sph_kernels;

/* shape: TOBI_SHAPE_*; isa: exec's level. Static data, never NULL. */
const sph_kernels *sph_kernels_for(int isa, int shape);

extern const sph_kernels sph_kernels_v2[2], sph_kernels_v3[2], sph_kernels_v4[2];

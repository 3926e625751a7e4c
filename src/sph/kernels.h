/* The table of SPH kernels for one instruction set and one smoothing kernel. */
#pragma once
#include "exec/exec.h"
#include "sph/view.h"

typedef struct sph_kernels {
#define PAIR(K, SUMS, MAXIMA, DOC) tobi_kernel K;
#define FOR(K, SUMS, MAXIMA, DOC) tobi_kernel K;
#define COUPLE FOR
#define PHASES PAIR
#define PHASE FOR
#define SCALARS PAIR
#define SCALAR FOR
#define IMAGE PAIR
#define RARE FOR
#define ISPH FOR
#include "sph/kernels.def"
#undef PAIR
#undef FOR
#undef COUPLE
#undef PHASES
#undef PHASE
#undef SCALARS
#undef SCALAR
#undef IMAGE
#undef RARE
#undef ISPH
} sph_kernels;

/* shape: TOBI_SHAPE_*; isa: exec's level. Static data, never NULL. */
const sph_kernels *sph_kernels_for(int isa, int shape);

/* Two smoothing kernels have a table each; the others share the last one, which reads the view's shape. */
enum { SPH_TABLES = 3 };
static inline int sph_table_of(int shape) { return shape < SPH_TABLES - 1 ? shape : SPH_TABLES - 1; }

extern const sph_kernels sph_kernels_v2[SPH_TABLES], sph_kernels_v3[SPH_TABLES], sph_kernels_v4[SPH_TABLES];

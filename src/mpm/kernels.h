/* The kernels of the material point method for one instruction set and dimension. */
#pragma once
#include "exec/exec.h"
#include "mpm/view.h"

#define BLOCK(K, SUMS, MAXIMA, DOC) tobi_kernel K;
#define PACK(K, SUMS, MAXIMA, DOC)
typedef struct mpm_kernels {
#include "mpm/kernels.def"
} mpm_kernels;
#undef BLOCK
#undef PACK

/* Over packs of contacts (mpm/contact/pack.k.h). */
#define BLOCK(K, SUMS, MAXIMA, DOC)
#define PACK(K, SUMS, MAXIMA, DOC) tobi_kernel K;
typedef struct mpm_pack_kernels {
#include "mpm/kernels.def"
} mpm_pack_kernels;
#undef BLOCK
#undef PACK

/* isa: exec's level. Static data, never NULL. */
const mpm_kernels *mpm_kernels_for(int isa, int dimension);
const mpm_pack_kernels *mpm_pack_kernels_for(int isa);

extern const mpm_kernels mpm_kernels_v2[2], mpm_kernels_v3[2], mpm_kernels_v4[2];
extern const mpm_pack_kernels mpm_pack_kernels_v2, mpm_pack_kernels_v3, mpm_pack_kernels_v4;

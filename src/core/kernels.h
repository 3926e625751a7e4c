/* The table of this room's kernels for one instruction set. */
#pragma once
#include "exec/exec.h"

typedef struct tobi_core_kernels {
#define CELLS(K, SUMS, MAXIMA, DOC) tobi_kernel K;
#define SEARCH CELLS
#include "core/kernels.def"
#undef CELLS
#undef SEARCH
} tobi_core_kernels;

/* isa: exec's level. Static data, never NULL. */
const tobi_core_kernels *tobi_core_kernels_for(int isa);

extern const tobi_core_kernels tobi_core_kernels_v2, tobi_core_kernels_v3, tobi_core_kernels_v4;

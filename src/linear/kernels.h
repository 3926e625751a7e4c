/* The table of this room's kernels for one instruction set. */
#pragma once
#include "exec/exec.h"

typedef struct tobi_linear_kernels {
#define VECTOR(K, SUMS, MAXIMA, DOC) tobi_kernel K;
#define GRID(K, SUMS, MAXIMA, DOC) tobi_kernel K;
#include "linear/kernels.def"
#undef VECTOR
#undef GRID
} tobi_linear_kernels;

/* isa: exec's level. Static data, never NULL. */
const tobi_linear_kernels *tobi_linear_kernels_for(int isa);

extern const tobi_linear_kernels tobi_linear_kernels_v2, tobi_linear_kernels_v3, tobi_linear_kernels_v4;

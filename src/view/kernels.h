/* The table of this room's kernels for one instruction set. */
#pragma once
#include "exec/exec.h"

typedef struct tobi_view_kernels {
#define SURFACE(K, SUMS, MAXIMA, DOC) tobi_kernel K;
#include "view/kernels.def"
#undef SURFACE
} tobi_view_kernels;

/* isa: exec's level. Static data, never NULL. */
const tobi_view_kernels *tobi_view_kernels_for(int isa);

extern const tobi_view_kernels tobi_view_kernels_v2, tobi_view_kernels_v3, tobi_view_kernels_v4;

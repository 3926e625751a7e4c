/* Chooses among the tables of kernels that isa_sph.c made, one per instruction set and smoothing
   kernel. Drawback: a third smoothing kernel is a third table of everything. */
#include "sph/kernels.h"

const sph_kernels *sph_kernels_for(int isa, int shape)
{
#if defined(__x86_64__)
    if (isa >= 4) return &sph_kernels_v4[shape];
    if (isa == 3) return &sph_kernels_v3[shape];
#endif
    (void)isa;
    return &sph_kernels_v2[shape];
}

/* Chooses among the tables of kernels that isa_sph.c made, one per instruction set and smoothing
   kernel. Drawback: a smoothing kernel with loops of its own is a further table of everything. */
#include "sph/kernels.h"

const sph_kernels *sph_kernels_for(int isa, int shape)
{
    const int k = sph_table_of(shape);
#if defined(__x86_64__)
    if (isa >= 4) return &sph_kernels_v4[k];
    if (isa == 3) return &sph_kernels_v3[k];
#endif
    (void)isa;
    return &sph_kernels_v2[k];
}

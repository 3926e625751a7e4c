/* Chooses among the tables of kernels that isa_mpm.c made, one per instruction set. Drawback: the
   choice is made once, when a simulation begins. */
#include "mpm/kernels.h"

const mpm_kernels *mpm_kernels_for(int isa, int dimension)
{
#if defined(__x86_64__)
    if (isa >= 4) return &mpm_kernels_v4[dimension == 3];
    if (isa == 3) return &mpm_kernels_v3[dimension == 3];
#endif
    (void)isa;
    return &mpm_kernels_v2[dimension == 3];
}

const mpm_pack_kernels *mpm_pack_kernels_for(int isa)
{
#if defined(__x86_64__)
    if (isa >= 4) return &mpm_pack_kernels_v4;
    if (isa == 3) return &mpm_pack_kernels_v3;
#endif
    (void)isa;
    return &mpm_pack_kernels_v2;
}

/* Chooses among the tables of kernels that isa_mpm.c made, one per instruction set. Drawback: the
   choice is made once, when a simulation begins. */
#include "mpm/kernels.h"

const mpm_kernels *mpm_kernels_for(int isa, int dimension)
{
    return &(*TOBI_TABLE_OF(isa, mpm_kernels))[dimension == 3];
}

const mpm_pack_kernels *mpm_pack_kernels_for(int isa) { return TOBI_TABLE_OF(isa, mpm_pack_kernels); }

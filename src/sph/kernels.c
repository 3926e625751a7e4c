/* Chooses among the tables of kernels that isa_sph.c made, one per instruction set and smoothing
   kernel. Drawback: a smoothing kernel with loops of its own is a further table of everything. */
#include "sph/kernels.h"

const sph_kernels *sph_kernels_for(int isa, int shape)
{
    return &(*TOBI_TABLE_OF(isa, sph_kernels))[sph_table_of(shape)];
}

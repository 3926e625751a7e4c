/* The kernels of the material point method for one instruction set and dimension. */
#pragma once
#include "exec/exec.h"
#include "mpm/view.h"

typedef struct mpm_kernels {
    tobi_kernel scatter;               /* over particle blocks                                    */
    tobi_kernel collect;               /* over node blocks                                        */
    tobi_kernel gather;                /* over particle blocks                                    */
    tobi_kernel filter;                /* over particle blocks, XPIC                              */
    tobi_kernel filter_nodes;          /* over node blocks                                        */
    tobi_kernel scatter_calm;          /* over particle blocks; these three to measure transfers  */
    tobi_kernel energy_calm, energy_nodes;   /* over node blocks                                  */
} mpm_kernels;

/* Over packs of contacts (mpm/pack.k.h). */
typedef struct mpm_pack_kernels { tobi_kernel crowd, answer, forget, read, push; } mpm_pack_kernels;

/* isa: exec's level. Static data, never NULL. */
const mpm_kernels *mpm_kernels_for(int isa, int dimension);
const mpm_pack_kernels *mpm_pack_kernels_for(int isa);

extern const mpm_kernels mpm_kernels_v2[2], mpm_kernels_v3[2], mpm_kernels_v4[2];
extern const mpm_pack_kernels mpm_pack_kernels_v2, mpm_pack_kernels_v3, mpm_pack_kernels_v4;

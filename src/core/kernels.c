/* Chooses among the tables of kernels that isa_core.c made, as linear/kernels.c does. */
#include "core/kernels.h"

const tobi_core_kernels *tobi_core_kernels_for(int isa)
{
#if defined(__x86_64__)
    if (isa >= 4) return &tobi_core_kernels_v4;
    if (isa == 3) return &tobi_core_kernels_v3;
#endif
    (void)isa;
    return &tobi_core_kernels_v2;
}

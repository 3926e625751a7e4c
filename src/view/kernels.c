/* Chooses among the tables of kernels that isa_view.c made, one per instruction set, as the other rooms do.
   Drawback: a kernel that nobody wants wider is compiled three times too. */
#include "view/kernels.h"

const tobi_view_kernels *tobi_view_kernels_for(int isa)
{
#if defined(__x86_64__)
    if (isa >= 4) return &tobi_view_kernels_v4;
    if (isa == 3) return &tobi_view_kernels_v3;
#endif
    (void)isa;
    return &tobi_view_kernels_v2;
}

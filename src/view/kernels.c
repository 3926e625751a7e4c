/* Chooses among the tables of kernels that isa_view.c made, one per instruction set, as the other rooms do.
   Drawback: a kernel that nobody wants wider is compiled three times too. */
#include "view/kernels.h"

const tobi_view_kernels *tobi_view_kernels_for(int isa) { return TOBI_TABLE_OF(isa, tobi_view_kernels); }

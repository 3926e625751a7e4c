/* Chooses among the tables of kernels that isa_linear.c made, one per instruction set: an address in a view
   or a switch per call would do as well, but so the choice is made once per solve. Drawback: a kernel that
   nobody wants wider is compiled three times too. */
#include "linear/kernels.h"

const tobi_linear_kernels *tobi_linear_kernels_for(int isa)
{
    return TOBI_TABLE_OF(isa, tobi_linear_kernels);
}

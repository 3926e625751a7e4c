/* Chooses among the tables of kernels that isa_core.c made, as linear/kernels.c does. */
#include "core/kernels.h"

const tobi_core_kernels *tobi_core_kernels_for(int isa) { return TOBI_TABLE_OF(isa, tobi_core_kernels); }

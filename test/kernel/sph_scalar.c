/* The SPH kernels with lanes of one number, what CUDA compiles. The oracles share these objects: they take
   long to compile. */
#define TOBI_SCALAR_LANES
#define TOBI_ISA scalar
#include "sph/isa_sph.c"

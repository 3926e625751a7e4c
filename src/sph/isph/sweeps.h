/* A fixed number of sweeps of the pressure equation, from the last pressure: docs/theory/eisph.md. */
#pragma once
#include "sph/isph/solve.h"

/* Square of the speed at which n sweeps spread pressure, times (dt/d)^2 and the row sum of the lattice,
   eq. (E.6). */
double isph_sweeps_reach(int count, int pseudo);
/* Does m->sweeps on the rows in the view. The report has the residual before the last sweep. */
tobi_linear_report isph_sweep_all(isph_solver *m, int singular);

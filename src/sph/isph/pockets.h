/* Closed pockets of isph: liquid without a free surface in a world that has one elsewhere. */
#pragma once
#include "linear/solve.h"
#include "sph/isph/solve.h"

/* Marks the rows of each pocket, in which the matrix has a constant that it does not see: the answers of
   bodies and solids, by `apply`, included. Returns their number; if there are any, the solution is that of
   the last step again. */
int isph_pockets_find(isph_solver *m, const tobi_linear_system *system);
/* Takes the mean of each pocket out of y; user: the solver. */
void isph_pockets_center(void *user, double *y);

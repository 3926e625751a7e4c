/* A multigrid preconditioner of the pressure equation.

   The pressure operator is close to -(1/rho) Laplace p. Conjugate gradients with its diagonal need
   iterations that grow with the depth of the water in particles; adding P B P^T, with B one V-cycle for
   the same equation on a coarse grid, keeps them nearly flat (Bramble, Pasciak & Xu, Math. Comp. 55
   (1990) 1). A cell of the grid is two neighbour cells wide; P interpolates linearly from its corners,
   so that it adds nothing at the scale of particles, where the operator is weak. B is symmetric and
   fixed, so conjugate gradients stay what they are. Any error here costs iterations, never the result. */
#pragma once
#include "core/system.h"

enum { SPH_GRID_LEVELS = 16 };

/* Nodes x + n[0] (y + n[1] z) with the seven-point finite-volume stencil. */
typedef struct sph_grid {
    int n[3];
    float *value, *source;       /* u and f of B u = f                                          */
    float *face[3];              /* weight between a node and the next along each axis          */
    float *inverse;              /* 1/diagonal, 0 where nothing is to be solved                 */
} sph_grid;

typedef struct sph_multigrid {
    int levels, periodic[3], dimension;
    int cells[3];                /* of the finest grid                                          */
    double per_metre[3];         /* cells per metre                                             */
    float (*corner)[8];          /* [cells] sums of a cell's particles, by corner               */
    sph_grid grid[SPH_GRID_LEVELS];
    float *memory;
} sph_multigrid;

/* Memory for the cells of a simulation; TOBI_NO_MEMORY. */
tobi_status sph_multigrid_create(sph_multigrid *m, const tobi_system *s, tobi_error *err);
void sph_multigrid_free(sph_multigrid *m);
/* Weights for the particles of this step. A particle is solved for where precondition > 0; surface marks
   where pressure is near 0. conductance: 1/(rho V). */
void sph_multigrid_set(sph_multigrid *m, const tobi_system *s, double conductance);
/* u = B P^T residual, left in grid[0].value; returns residual . P u. */
double sph_multigrid_apply(sph_multigrid *m, const tobi_system *s);

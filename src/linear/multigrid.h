/* A multigrid preconditioner for equations close to -c Laplace p = f whose unknowns are points in cells.

   The points' values meet on a coarse grid: P interpolates linearly from the corners of grid cells, each
   `wide` point cells wide, and B is one cycle for the same equation on the grid. P B P^T is symmetric,
   positive and fixed, so conjugate gradients stay what they are; any error here costs iterations, never the
   result. Two ways to use it:
   - added to the diagonal (Bramble, Pasciak & Xu, Math. Comp. 55 (1990) 1): tobi_multigrid_apply. For
     operators that are weak at the scale of points (DFSPH: wide = 2, V-cycle).
   - between two sweeps of damped Jacobi on the points (Brandt, Math. Comp. 31 (1977) 333):
     tobi_multigrid_cycle. For compact Laplacians (wide = 1, W-cycle); two products with the matrix.
   The grid computes in float, points in float or double. */
#pragma once
#include "base/error.h"
#include "exec/exec.h"
#include "linear/grid.h"
#include "linear/solve.h"

enum { TOBI_GRID_LEVELS = 16 };

typedef struct tobi_multigrid {
    tobi_cell_points points;         /* of the last tobi_multigrid_set                              */
    int levels, wide, visits;
    int cells[3];                    /* of the finest grid                                          */
    double per_metre[3];             /* cells per metre                                             */
    float (*corner)[8];              /* [cells] sums of a cell's points, by corner                  */
    tobi_grid_level grid[TOBI_GRID_LEVELS];
    float *memory;
} tobi_multigrid;

/* What the grid's equation is made of. */
typedef struct tobi_grid_weights {
    double strength;                 /* c of A p ~ -c Laplace p                                     */
    double volume;                   /* m3 (m2 in 2-D) of a point where they lie densely            */
    const double *share;             /* of that c at each point, 0 to 1; NULL: all of it            */
    const float *active;             /* a point is solved for where > 0; NULL: all are              */
    /* what a row has beside -c Laplace: a surface where p = 0, or a fixed value nearby             */
    const uint8_t *marked;           /* a point that is marked (1) has `hold` of it; or             */
    double hold;
    const double *excess;            /* each point its own, the sum of its row; both NULL: nothing  */
} tobi_grid_weights;

/* Bytes of a grid over these cells, which it takes no memory for; as tobi_multigrid_create. */
int64_t tobi_multigrid_plan_bytes(const tobi_cell_points *p, int wide);
/* Memory for a grid over these cells; start, position and count may still be unknown. visits: of a level per
   cycle of the next finer one, 1: V-cycle, 2: W-cycle. TOBI_NO_MEMORY. */
tobi_status tobi_multigrid_create(tobi_multigrid *m, const tobi_cell_points *p, int wide, int visits,
                                  tobi_error *err);
void tobi_multigrid_free(tobi_multigrid *m);
/* Allocated. */
int64_t tobi_multigrid_bytes(const tobi_multigrid *m);

/* Weights for points in the cells of tobi_multigrid_create. The arrays of w are not read later. */
void tobi_multigrid_set(tobi_multigrid *m, tobi_exec *x, const tobi_cell_points *p,
                        const tobi_grid_weights *w);

/* u = B P^T r, where active > 0 (NULL: everywhere), left in grid[0].value; returns r . P u. */
double tobi_multigrid_apply(tobi_multigrid *m, tobi_exec *x, const float *r, const float *active);

/* z = one symmetric cycle for A z = r: Jacobi, grid, Jacobi. inverse: 1/diagonal of A, 0 = row left out;
   damping: about 0.7; scratch: room for the rows. */
void tobi_multigrid_cycle(tobi_multigrid *m, tobi_exec *x, const tobi_linear_system *a, const double *inverse,
                          double damping, double *scratch, double *z, const double *r);

/* The grid's values, for tobi_grid_value. */
tobi_grid_values tobi_multigrid_values(const tobi_multigrid *m);

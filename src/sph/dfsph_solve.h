/* The pressure equations of dfsph: its state, and the solve. */
#pragma once
#include "core/system.h"
#include "linear/multigrid.h"
#include "sph/kernels.h"
#include "sph/state.h"
#include "sph/undo.h"

typedef struct dfsph {
    sph_state common;             /* comes first                                                 */
    tobi_dfsph_def def;
    sph_view view;
    const sph_kernels *kernel;
    tobi_multigrid grid;
    sph_undo undo;
    /* survives a restart; vessel: SPH_VESSEL_*; last: drops of the free surface, still water, openings, m */
    struct { double speed, head, dt, vessel, low, level, open; } memory;
    /* of the step at hand */
    double motion_dt;             /* step that motion alone allows, s                            */
    double diagonal;              /* mean diagonal of the operator                               */
} dfsph;

/* A run of conjugate gradients on A p = s. */
typedef struct dfsph_solve {
    double tolerance;             /* on the mean of |r| dt^2                                     */
    double relative_tolerance;    /* on |r|/|s|                                                  */
    double source;                /* |s|^2 in the norm of the diagonal                           */
    double nothing;               /* mean |r| dt^2 so small that no iteration is due             */
    int min, max;
    int grid;                     /* 1: with the multigrid preconditioner                        */
    int coupled;                  /* 1: bodies that move by forces answer the pressure           */
    int constant_free;            /* 1: a constant pressure does nothing and is left out         */
    /* results */
    int iterations, converged;
    double error, relative;       /* mean |r| dt^2; |r|/|s|                                      */
    double worst;                 /* max |r|, 1/s2                                               */
    double head;                  /* twice the mean |p|/rho, m2/s2: the bottom of a pool           */
} dfsph_solve;

/* Over all particles; totals: TOBI_TOTALS sums of the kernel, or NULL. */
void dfsph_launch(tobi_system *s, dfsph *m, tobi_kernel k, double *totals);
/* Of bodies and soft solids that move, to the product of the operator; t: its sums, or NULL. */
void dfsph_add_answers(tobi_system *s, double *t);
/* Solves from the state that a residual kernel left. start: its sums |r|^2/diagonal, |r|, sum r. */
void dfsph_solve_pressure(tobi_system *s, dfsph *m, const double *start, dfsph_solve *q);

/* What the solvers share: vectors launched by exec, and the loop of starts from true residuals. */
#pragma once
#include "linear/kernels.h"
#include "linear/solve.h"

typedef struct tobi_linear_run {
    tobi_exec *exec;
    const tobi_linear_kernels *kernel;
    const tobi_linear_system *a;
    const tobi_linear_settings *settings;
    const double *b;
    double *x;
    double *r;                 /* the true residual at the start of a round, then the solver's own  */
    double *work;              /* the solver's other vectors                                        */
    double norm;               /* |r|                                                               */
    double goal;               /* |r| at which to end                                               */
    int broken;                /* the round could not compute its next step                         */
    tobi_linear_report report;
} tobi_linear_run;

/* Improves x from r, |r| = norm, until its estimate of |r| is below the goal, tobi_run_ends, or `broken`. */
typedef void (*tobi_linear_round)(tobi_linear_run *run);

/* Rounds until the true residual is small enough, or more of them are of no use. `work` begins with r. */
tobi_linear_report tobi_linear_solve(tobi_linear_run *run, tobi_linear_round round);
/* 1: enough iterations, or `stop`. */
int tobi_run_ends(tobi_linear_run *run);

/* x . y; y = a x; |y += a x|^2; |y = x + a y|^2; the mean out of y, if the system is singular. */
double tobi_run_dot(const tobi_linear_run *run, const double *x, const double *y);
void tobi_run_scale(const tobi_linear_run *run, double *y, double a, const double *x);
double tobi_run_add(const tobi_linear_run *run, double *y, double a, const double *x);
double tobi_run_blend(const tobi_linear_run *run, double *y, const double *x, double a);
void tobi_run_center(const tobi_linear_run *run, double *y);
/* y = A x and z = M r, without mean if the system is singular. */
void tobi_run_apply(const tobi_linear_run *run, double *y, const double *x);
void tobi_run_precondition(const tobi_linear_run *run, double *z, const double *r);

/* Krylov solvers for A x = b in double precision.

   Every answer is judged by the true residual |b - A x|/|b|, computed afresh: where a solver's own estimate
   has drifted from it, the solver starts again from the true one. Nothing is allocated: the caller lends
   the workspace. Sums run in exec's fixed order, so that the result does not depend on the number of
   threads, as long as `apply` and `precondition` do not either. */
#pragma once
#include "exec/exec.h"

typedef struct tobi_linear_system {
    int64_t rows;
    int singular;          /* 1: A 1 = 0 and A^T 1 = 0. The mean is taken from b, x has none        */
    void *user;            /* for the functions below                                               */
    void (*apply)(void *user, double *y, const double *x);                 /* y = A x               */
    void (*precondition)(void *user, double *z, const double *r);          /* z ~ A^-1 r; NULL: z = r */
    void (*center)(void *user, double *y);   /* for other constants of A: takes them out; NULL: none */
    int (*stop)(void *user);               /* asked once per iteration, 1 = give up; NULL: never    */
} tobi_linear_system;

typedef enum tobi_linear_status {
    TOBI_LINEAR_CONVERGED,
    TOBI_LINEAR_LIMIT,         /* so many iterations did not suffice                                */
    TOBI_LINEAR_STAGNATED,     /* a fresh start from the true residual gains less than 1 %          */
    TOBI_LINEAR_BROKEN_DOWN,   /* no step can be computed: for cg, A or M is not positive definite;
                                  for all, M gives no finite numbers                                */
    TOBI_LINEAR_NOT_FINITE,    /* b, or A times the start, has numbers that are not finite          */
    TOBI_LINEAR_STOPPED        /* `stop` said so                                                    */
} tobi_linear_status;

typedef struct tobi_linear_settings {
    double tolerance;          /* on |b - A x|/|b|                                                  */
    int max;                   /* iterations                                                        */
    int restart;               /* gmres: directions kept, at least 1                                */
} tobi_linear_settings;

typedef struct tobi_linear_report {
    tobi_linear_status status;
    int iterations;
    int fresh;                 /* starts from a true residual, the first included                   */
    double residual;           /* true |b - A x|/|b| of the x returned; 0 where b = 0               */
} tobi_linear_report;

/* x holds the start and receives the last iterate; it is left alone where the status is NOT_FINITE at the
   start. Exec is reserved for the rows. work: as many doubles as the function before says.
   cg: A and M symmetric positive definite; one product per iteration. */
int64_t tobi_cg_work(int64_t rows);
tobi_linear_report tobi_cg(tobi_exec *exec, const tobi_linear_system *a, const tobi_linear_settings *s,
                           const double *b, double *x, double *work);
/* The same iteration over vectors that only the caller knows, of any type and place, so that he may fuse the
   work on them. From a residual r; all return what the step needs: */
typedef struct tobi_cg_steps {
    int (*ends)(void *user);                         /* 1: r is small enough, or enough is done     */
    double (*precondition)(void *user);              /* z = M r: r . z                              */
    void (*turn)(void *user, double beta);           /* q = z + beta q; beta 0: what q was is void  */
    double (*apply)(void *user);                     /* A q: q . A q                                */
    void (*advance)(void *user, double alpha);       /* x += alpha q, r -= alpha A q                */
} tobi_cg_steps;
/* 0: it ended; 1: broken down, see TOBI_LINEAR_BROKEN_DOWN. */
int tobi_cg_iterate(const tobi_cg_steps *steps, void *user);

/* Any A: two products per iteration. */
int64_t tobi_bicgstab_work(int64_t rows);
tobi_linear_report tobi_bicgstab(tobi_exec *exec, const tobi_linear_system *a, const tobi_linear_settings *s,
                                 const double *b, double *x, double *work);
/* Any A: one product per iteration, restart + 2 vectors. */
int64_t tobi_gmres_work(int64_t rows, int restart);
tobi_linear_report tobi_gmres(tobi_exec *exec, const tobi_linear_system *a, const tobi_linear_settings *s,
                              const double *b, double *x, double *work);

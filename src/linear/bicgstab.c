/* BiCGStab (van der Vorst, SIAM J. Sci. Stat. Comput. 13 (1992) 631) with the preconditioner on the right,
   so that r is the residual of A x = b. A breakdown ends the round; the next begins with a new shadow
   residual. Drawback: the residual may rise on the way, and x is the last iterate, not the best. */
#include "linear/run.h"
#include <math.h>

/* r0 . r so small beside |r0| |r|, that the next direction would be round-off. */
static const double ORTHOGONAL = 1e-14;

typedef struct vectors { double *r0, *p, *v, *y, *t; } vectors;

/* The step along p: half of an iteration. rho = r0 . r */
static double step_along(tobi_linear_run *run, const vectors *w, double rho)
{
    tobi_run_precondition(run, w->y, w->p);
    tobi_run_apply(run, w->v, w->y);
    const double alpha = rho/tobi_run_dot(run, w->r0, w->v);
    run->broken = !isfinite(alpha) || !isfinite(tobi_run_dot(run, w->y, w->y));
    if (run->broken) return 0;
    tobi_run_add(run, run->x, alpha, w->y);
    run->norm = sqrt(tobi_run_add(run, run->r, -alpha, w->v));
    return alpha;
}

/* The step that makes the residual smallest; returns its length. */
static double step_down(tobi_linear_run *run, const vectors *w)
{
    tobi_run_precondition(run, w->y, run->r);
    tobi_run_apply(run, w->t, w->y);
    const double omega = tobi_run_dot(run, w->t, run->r)/tobi_run_dot(run, w->t, w->t);
    run->broken = !isfinite(omega) || omega == 0 || !isfinite(tobi_run_dot(run, w->y, w->y));
    if (run->broken) return 0;
    tobi_run_add(run, run->x, omega, w->y);
    run->norm = sqrt(tobi_run_add(run, run->r, -omega, w->t));
    return omega;
}

static void run_round(tobi_linear_run *run)
{
    const int64_t n = run->a->rows;
    double *m = run->work;
    const vectors w = {m, m + n, m + 2*n, m + 3*n, m + 4*n};
    double start = run->norm, rho = start*start;
    tobi_run_scale(run, w.r0, 1, run->r);
    tobi_run_scale(run, w.p, 1, run->r);
    while (run->norm > run->goal && !tobi_run_ends(run)) {
        const double alpha = step_along(run, &w, rho);
        if (run->broken) return;
        run->report.iterations++;
        if (!(run->norm > run->goal)) return;
        const double omega = step_down(run, &w);
        if (run->broken) return;
        const double next = tobi_run_dot(run, w.r0, run->r), beta = next/rho*(alpha/omega);
        run->broken = !(fabs(next) > ORTHOGONAL*start*run->norm) || !isfinite(beta);
        if (run->broken) return;
        tobi_run_add(run, w.p, -omega, w.v);
        tobi_run_blend(run, w.p, run->r, beta);
        rho = next;
    }
}

int64_t tobi_bicgstab_work(int64_t rows) { return 6*rows; }

tobi_linear_report tobi_bicgstab(tobi_exec *exec, const tobi_linear_system *a, const tobi_linear_settings *s,
                                 const double *b, double *x, double *work)
{
    tobi_linear_run run = {.exec = exec, .a = a, .settings = s, .b = b, .x = x, .r = work,
                           .work = work + a->rows};
    return tobi_linear_solve(&run, run_round);
}

/* The frame of all solvers: a solver is a round that starts from a true residual and stops by its own
   estimate; here the estimate is replaced by the truth and judged. So drift, breakdown and restarts are one
   thing. Drawback: a round forgets its directions, and one product per round goes into the check. */
#include "linear/run.h"
#include "linear/vectors.k.h"
#include <math.h>

/* What a round must leave of the residual at most, else further rounds are of no use. */
static const double GAIN = 0.99;

static double launch(const tobi_linear_run *run, tobi_kernel kernel, double *y, const double *x, double a,
                     int sums)
{
    const tobi_vectors_view v = {y, x, a};
    double totals[TOBI_TOTALS];
    tobi_launch(run->exec, kernel, &v, 0, run->a->rows, sums ? totals : NULL);
    return sums ? totals[0] : 0;
}

double tobi_run_dot(const tobi_linear_run *run, const double *x, const double *y)
{
    return launch(run, run->kernel->vector_dot, (double *)y, x, 0, 1);
}

void tobi_run_scale(const tobi_linear_run *run, double *y, double a, const double *x)
{
    launch(run, run->kernel->vector_scale, y, x, a, 0);
}

double tobi_run_add(const tobi_linear_run *run, double *y, double a, const double *x)
{
    return launch(run, run->kernel->vector_add, y, x, a, 1);
}

double tobi_run_blend(const tobi_linear_run *run, double *y, const double *x, double a)
{
    return launch(run, run->kernel->vector_blend, y, x, a, 1);
}

void tobi_run_center(const tobi_linear_run *run, double *y)
{
    if (run->a->center) run->a->center(run->a->user, y);
    if (!run->a->singular || run->a->rows == 0) return;
    const double sum = launch(run, run->kernel->vector_sum, y, NULL, 0, 1);
    launch(run, run->kernel->vector_shift, y, NULL, sum/(double)run->a->rows, 0);
}

void tobi_run_apply(const tobi_linear_run *run, double *y, const double *x)
{
    run->a->apply(run->a->user, y, x);
    tobi_run_center(run, y);
}

void tobi_run_precondition(const tobi_linear_run *run, double *z, const double *r)
{
    if (run->a->precondition) run->a->precondition(run->a->user, z, r);
    else tobi_run_scale(run, z, 1, r);
    tobi_run_center(run, z);
}

int tobi_run_ends(tobi_linear_run *run)
{
    if (run->report.iterations >= run->settings->max) return 1;
    if (run->a->stop && run->a->stop(run->a->user)) run->report.status = TOBI_LINEAR_STOPPED;
    return run->report.status == TOBI_LINEAR_STOPPED;
}

/* r = b - A x, and |r|. */
static double find_residual(tobi_linear_run *run)
{
    tobi_run_apply(run, run->r, run->x);
    tobi_run_blend(run, run->r, run->b, -1);
    tobi_run_center(run, run->r);
    return sqrt(tobi_run_dot(run, run->r, run->r));
}

/* |b|, without its mean if the system is singular. */
static double measure_source(tobi_linear_run *run)
{
    tobi_run_scale(run, run->r, 1, run->b);
    tobi_run_center(run, run->r);
    return sqrt(tobi_run_dot(run, run->r, run->r));
}

/* 1: the solve is over, for the reason in the report; last: the residual before the round just run. */
static int judge(tobi_linear_run *run, double last)
{
    tobi_linear_report *q = &run->report;
    if (!isfinite(run->norm)) q->status = TOBI_LINEAR_NOT_FINITE;
    else if (run->norm <= run->goal) q->status = TOBI_LINEAR_CONVERGED;
    else if (q->status == TOBI_LINEAR_STOPPED) return 1;
    else if (q->iterations >= run->settings->max) q->status = TOBI_LINEAR_LIMIT;
    else if (!(run->norm <= GAIN*last))
        q->status = run->broken ? TOBI_LINEAR_BROKEN_DOWN : TOBI_LINEAR_STAGNATED;
    else return 0;
    return 1;
}

tobi_linear_report tobi_linear_solve(tobi_linear_run *run, tobi_linear_round round)
{
    tobi_linear_report *q = &run->report;
    *q = (tobi_linear_report){.status = TOBI_LINEAR_LIMIT};
    run->kernel = tobi_linear_kernels_for(run->exec->isa);
    const double source = measure_source(run);
    run->goal = run->settings->tolerance*source;
    if (!(source > 0) && isfinite(source)) {                /* b = 0: the answer is known */
        tobi_run_scale(run, run->x, 0, run->b);
        q->status = TOBI_LINEAR_CONVERGED;
        return *q;
    }
    double last = INFINITY;
    run->norm = isfinite(source) ? find_residual(run) : source;
    while (!judge(run, last)) {
        q->fresh++;
        last = run->norm;
        run->broken = 0;
        round(run);
        tobi_run_center(run, run->x);
        run->norm = find_residual(run);
    }
    q->residual = run->norm/source;
    return *q;
}

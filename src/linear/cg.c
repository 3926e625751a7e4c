/* Preconditioned conjugate gradients (Hestenes & Stiefel 1952; Saad, Iterative Methods, alg. 9.1), once as
   steps over vectors that others hold, and with them for vectors of doubles: three, z shares its memory with
   A q. Drawback: two sums per iteration that wait for each other. */
#include "linear/run.h"
#include <math.h>

int tobi_cg_iterate(const tobi_cg_steps *steps, void *user)
{
    double last = 0;
    while (!steps->ends(user)) {
        const double rz = steps->precondition(user);
        if (!(rz > 0) || !isfinite(rz)) return 1;
        steps->turn(user, last > 0 ? rz/last : 0);
        last = rz;
        const double qq = steps->apply(user);
        if (!(qq > 0) || !isfinite(qq) || !isfinite(rz/qq)) return 1;
        steps->advance(user, rz/qq);
    }
    return 0;
}

static double *direction(const tobi_linear_run *run) { return run->work; }
static double *product(const tobi_linear_run *run) { return run->work + run->a->rows; }

static int ends(void *user)
{
    tobi_linear_run *run = user;
    return run->norm <= run->goal || tobi_run_ends(run);
}

static double precondition(void *user)
{
    const tobi_linear_run *run = user;
    tobi_run_precondition(run, product(run), run->r);
    return tobi_run_dot(run, run->r, product(run));
}

static void turn(void *user, double beta)
{
    const tobi_linear_run *run = user;
    if (beta > 0) tobi_run_blend(run, direction(run), product(run), beta);
    else tobi_run_scale(run, direction(run), 1, product(run));
}

static double apply(void *user)
{
    const tobi_linear_run *run = user;
    tobi_run_apply(run, product(run), direction(run));
    return tobi_run_dot(run, direction(run), product(run));
}

static void advance(void *user, double alpha)
{
    tobi_linear_run *run = user;
    tobi_run_add(run, run->x, alpha, direction(run));
    run->norm = sqrt(tobi_run_add(run, run->r, -alpha, product(run)));
    run->report.iterations++;
}

static void run_round(tobi_linear_run *run)
{
    static const tobi_cg_steps steps = { ends, precondition, turn, apply, advance };
    run->broken = tobi_cg_iterate(&steps, run);
}

int64_t tobi_cg_work(int64_t rows) { return 3*rows; }

tobi_linear_report tobi_cg(tobi_exec *exec, const tobi_linear_system *a, const tobi_linear_settings *s,
                           const double *b, double *x, double *work)
{
    tobi_linear_run run = {.exec = exec, .a = a, .settings = s, .b = b, .x = x, .r = work,
                           .work = work + a->rows};
    return tobi_linear_solve(&run, run_round);
}

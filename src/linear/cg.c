/* Preconditioned conjugate gradients (Hestenes & Stiefel 1952; Saad, Iterative Methods, alg. 9.1). Three
   vectors: z shares its memory with A s. Drawback: two sums per iteration that wait for each other. */
#include "linear/run.h"
#include <math.h>

static void run_round(tobi_linear_run *run)
{
    const int64_t n = run->a->rows;
    double *s = run->work, *z = s + n, *q = z, last = 0;
    while (run->norm > run->goal && !tobi_run_ends(run)) {
        tobi_run_precondition(run, z, run->r);
        const double rz = tobi_run_dot(run, run->r, z);
        run->broken = !(rz > 0) || !isfinite(rz);
        if (run->broken) return;
        if (last > 0) tobi_run_blend(run, s, z, rz/last);
        else tobi_run_scale(run, s, 1, z);
        last = rz;
        tobi_run_apply(run, q, s);
        const double sq = tobi_run_dot(run, s, q);
        run->broken = !(sq > 0) || !isfinite(sq) || !isfinite(rz/sq);
        if (run->broken) return;
        tobi_run_add(run, run->x, rz/sq, s);
        run->norm = sqrt(tobi_run_add(run, run->r, -rz/sq, q));
        run->report.iterations++;
    }
}

int64_t tobi_cg_work(int64_t rows) { return 3*rows; }

tobi_linear_report tobi_cg(tobi_exec *exec, const tobi_linear_system *a, const tobi_linear_settings *s,
                           const double *b, double *x, double *work)
{
    tobi_linear_run run = {.exec = exec, .a = a, .settings = s, .b = b, .x = x, .r = work,
                           .work = work + a->rows};
    return tobi_linear_solve(&run, run_round);
}

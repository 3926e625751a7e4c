/* GMRES(m) (Saad & Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856) with the preconditioner on the right and
   modified Gram-Schmidt; a round is one restart. Drawback: m + 2 vectors, and iteration j costs j sums that
   wait for each other. */
#include "linear/run.h"
#include <math.h>
#include <string.h>

/* A direction that is round-off of the vector it was taken from. */
static const double NOTHING = 1e-15;

typedef struct krylov {
    int m;
    int64_t n;
    double *v, *z;                       /* directions v + k n, k = 0..m; M v                        */
    double *h, *cosine, *sine, *g, *y;   /* h + j (m + 1): column j of H, turned upper triangular    */
} krylov;

static krylov divide(const tobi_linear_run *run)
{
    const int m = run->settings->restart;
    const int64_t n = run->a->rows;
    krylov k = {.m = m, .n = n, .v = run->work, .z = run->work + (m + 1)*n};
    k.h = k.z + n;
    k.cosine = k.h + (int64_t)m*(m + 1);
    k.sine = k.cosine + m;
    k.y = k.sine + m;
    k.g = k.y + m;
    return k;
}

/* v_{j+1} = A M v_j made orthogonal to all before, and its column of H; 0: nothing of it is left. */
static int extend(tobi_linear_run *run, const krylov *q, int j)
{
    double *next = q->v + (j + 1)*q->n, *h = q->h + (int64_t)j*(q->m + 1);
    tobi_run_precondition(run, q->z, q->v + j*q->n);
    tobi_run_apply(run, next, q->z);
    double left = tobi_run_dot(run, next, next);
    const double whole = sqrt(left);
    for (int k = 0; k <= j; k++) {
        h[k] = tobi_run_dot(run, next, q->v + k*q->n);
        left = tobi_run_add(run, next, -h[k], q->v + k*q->n);
    }
    h[j + 1] = sqrt(left);
    run->broken = !isfinite(whole) || !isfinite(h[j + 1]);
    if (run->broken || !(h[j + 1] > NOTHING*whole)) return 0;
    tobi_run_scale(run, next, 1/h[j + 1], next);
    return 1;
}

/* Turns column j, and the right side with it, so that H stays triangular; returns the residual's norm. */
static double turn(const krylov *q, int j)
{
    double *h = q->h + (int64_t)j*(q->m + 1);
    for (int k = 0; k < j; k++) {
        const double upper = h[k];
        h[k] = q->cosine[k]*upper + q->sine[k]*h[k + 1];
        h[k + 1] = q->cosine[k]*h[k + 1] - q->sine[k]*upper;
    }
    const double length = hypot(h[j], h[j + 1]);
    q->cosine[j] = length > 0 ? h[j]/length : 1;
    q->sine[j] = length > 0 ? h[j + 1]/length : 0;
    h[j] = length;
    q->g[j + 1] = -q->sine[j]*q->g[j];
    q->g[j] *= q->cosine[j];
    return fabs(q->g[j + 1]);
}

/* x += M V y with H y = g. */
static void add_answer(tobi_linear_run *run, const krylov *q, int columns)
{
    for (int j = columns - 1; j >= 0; j--) {
        double sum = q->g[j];
        for (int k = j + 1; k < columns; k++) sum -= q->h[(int64_t)k*(q->m + 1) + j]*q->y[k];
        q->y[j] = sum/q->h[(int64_t)j*(q->m + 1) + j];
        if (!isfinite(q->y[j])) run->broken = 1;
    }
    if (run->broken || columns == 0) return;
    tobi_run_scale(run, q->v, q->y[0], q->v);
    for (int j = 1; j < columns; j++) tobi_run_add(run, q->v, q->y[j], q->v + j*q->n);
    tobi_run_precondition(run, q->z, q->v);
    run->broken = !isfinite(tobi_run_dot(run, q->z, q->z));
    if (!run->broken) tobi_run_add(run, run->x, 1, q->z);
}

static void run_round(tobi_linear_run *run)
{
    const krylov q = divide(run);
    int j = 0, more = 1;
    memset(q.g, 0, (size_t)(q.m + 1)*sizeof *q.g);
    q.g[0] = run->norm;
    tobi_run_scale(run, q.v, 1/run->norm, q.v);
    while (more && j < q.m && run->norm > run->goal && !tobi_run_ends(run)) {
        more = extend(run, &q, j);
        if (run->broken) break;
        run->norm = turn(&q, j);
        if (!(q.h[(int64_t)j*(q.m + 1) + j] > 0)) {       /* A M takes v_j to what is there already */
            run->broken = 1;
            break;
        }
        j++;
        run->report.iterations++;
    }
    const int broken = run->broken;
    run->broken = 0;
    add_answer(run, &q, j);
    run->broken |= broken;
}

int64_t tobi_gmres_work(int64_t rows, int restart)
{
    return (restart + 2)*rows + (int64_t)restart*(restart + 1) + 4*(int64_t)restart + 1;
}

tobi_linear_report tobi_gmres(tobi_exec *exec, const tobi_linear_system *a, const tobi_linear_settings *s,
                              const double *b, double *x, double *work)
{
    tobi_linear_run run = {.exec = exec, .a = a, .settings = s, .b = b, .x = x, .r = work, .work = work};
    return tobi_linear_solve(&run, run_round);
}

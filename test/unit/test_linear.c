/* The Krylov solvers against elimination on small dense systems: what they claim is checked with sums of the
   test's own, and what cannot be solved is answered by a status. */
#include "linear/solve.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { MOST = 64, GUARD = 16 };
enum { CG, BICGSTAB, GMRES };

typedef struct dense {
    int n;
    double a[MOST][MOST], inverse[MOST];
    int calls, stop_after, poison;        /* poison: M answers NaN from that call on, 0 = never */
} dense;

static uint64_t seed;
static double random_unit(void)           /* -1..1 */
{
    seed = seed*6364136223846793005u + 1442695040888963407u;
    return (double)(seed >> 11)/4503599627370496.0 - 1;
}

static void apply(void *user, double *y, const double *x)
{
    const dense *d = user;
    for (int i = 0; i < d->n; i++) {
        y[i] = 0;
        for (int j = 0; j < d->n; j++) y[i] += d->a[i][j]*x[j];
    }
}

static void jacobi(void *user, double *z, const double *r)
{
    dense *d = user;
    d->calls++;
    for (int i = 0; i < d->n; i++) z[i] = d->poison && d->calls >= d->poison ? NAN : d->inverse[i]*r[i];
}

static int stop(void *user)
{
    dense *d = user;
    return d->stop_after-- <= 0;
}

/* |b - A x|/|b| in long double; of a singular system without means. */
static double true_residual(const dense *d, int singular, const double *b, const double *x)
{
    long double r[MOST], mean = 0, mean_b = 0, rr = 0, bb = 0;
    for (int i = 0; i < d->n; i++) {
        r[i] = b[i];
        for (int j = 0; j < d->n; j++) r[i] -= (long double)d->a[i][j]*x[j];
        mean += singular ? r[i]/d->n : 0;
        mean_b += singular ? (long double)b[i]/d->n : 0;
    }
    for (int i = 0; i < d->n; i++) {
        rr += (r[i] - mean)*(r[i] - mean);
        bb += (b[i] - mean_b)*(b[i] - mean_b);
    }
    return (double)sqrtl(rr/bb);
}

/* Gauss with pivots; a singular system gets 1 1^T added, which leaves the answer without mean. */
static void eliminate(const dense *d, int singular, const double *b, double *x)
{
    static long double a[MOST][MOST + 1];
    const int n = d->n;
    long double mean = 0;
    for (int i = 0; i < n; i++) mean += singular ? (long double)b[i]/n : 0;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) a[i][j] = d->a[i][j] + (singular ? 1 : 0);
        a[i][n] = b[i] - mean;
    }
    for (int k = 0; k < n; k++) {
        int p = k;
        for (int i = k; i < n; i++) if (fabsl(a[i][k]) > fabsl(a[p][k])) p = i;
        for (int j = 0; j <= n; j++) {
            const long double t = a[k][j];
            a[k][j] = a[p][j];
            a[p][j] = t;
        }
        for (int i = 0; i < n; i++)
            for (int j = n; i != k && j >= k; j--) a[i][j] -= a[i][k]/a[k][k]*a[k][j];
    }
    for (int i = 0; i < n; i++) x[i] = (double)(a[i][n]/a[i][i]);
}

static void finish(dense *d)
{
    for (int i = 0; i < d->n; i++) d->inverse[i] = 1/d->a[i][i];
}

/* B B^T + 1, rows scaled apart. */
static void fill_positive(dense *d, int n)
{
    static double b[MOST][MOST];
    memset(d, 0, sizeof *d);
    d->n = n;
    seed = 3;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) b[i][j] = random_unit();
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            for (int k = 0; k < n; k++) d->a[i][j] += b[i][k]*b[j][k];
            d->a[i][j] = (d->a[i][j] + (i == j))*(1 + i%5)*(1 + j%5);
        }
    finish(d);
}

/* Convection and diffusion on a line, with noise: no symmetry, eigenvalues on the right. */
static void fill_lopsided(dense *d, int n)
{
    memset(d, 0, sizeof *d);
    d->n = n;
    seed = 4;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            d->a[i][j] = (i == j ? 2.5 : j == i + 1 ? -0.4 : j == i - 1 ? -1.7 : 0) + 0.02*random_unit();
    finish(d);
}

/* A ring: rows and columns sum to 0; wind > 0 takes the symmetry. */
static void fill_ring(dense *d, int n, double wind)
{
    memset(d, 0, sizeof *d);
    d->n = n;
    for (int i = 0; i < n; i++) {
        d->a[i][i] = 2;
        d->a[i][(i + 1)%n] = -1 + wind;
        d->a[i][(i + n - 1)%n] = -1 - wind;
    }
    finish(d);
}

typedef struct outcome { tobi_linear_report report; double x[MOST]; } outcome;

static tobi_linear_report call(int solver, tobi_exec *x, const tobi_linear_system *a,
                               const tobi_linear_settings *s, const double *b, double *p, double *work)
{
    if (solver == CG) return tobi_cg(x, a, s, b, p, work);
    return solver == BICGSTAB ? tobi_bicgstab(x, a, s, b, p, work) : tobi_gmres(x, a, s, b, p, work);
}

static int64_t work_of(int solver, int64_t n, int restart)
{
    return solver == CG ? tobi_cg_work(n) : solver == BICGSTAB ? tobi_bicgstab_work(n)
                                                               : tobi_gmres_work(n, restart);
}

/* Solves from `start` (NULL: zero) within a workspace that ends in guards. */
static outcome solve_with(int solver, dense *d, tobi_linear_system a, tobi_linear_settings s, const double *b,
                          const double *start)
{
    tobi_exec x;
    outcome o = {.report = {0}};
    const int64_t n = work_of(solver, d->n, s.restart);
    double *work = malloc((size_t)(n + GUARD)*sizeof *work);
    a.rows = d->n;
    a.user = d;
    a.apply = apply;
    for (int64_t k = 0; k < n + GUARD; k++) work[k] = k < n ? NAN : 12345;
    if (start) memcpy(o.x, start, (size_t)d->n*sizeof *start);
    assert_int_equal(tobi_exec_init(&x, 1, NULL), TOBI_OK);
    o.report = call(solver, &x, &a, &s, b, o.x, work);
    for (int k = 0; k < GUARD; k++) assert_true(work[n + k] == 12345);
    free(work);
    tobi_exec_free(&x);
    return o;
}

static void fill_source(int n, double *b)
{
    seed = 9;
    for (int i = 0; i < n; i++) b[i] = random_unit() + 0.5;
}

/* Converges to the answer of elimination, and says what is true of its residual. */
static void check_solves(int solver, dense *d, int singular, int preconditioned)
{
    double b[MOST], exact[MOST], size = 0;
    fill_source(d->n, b);
    eliminate(d, singular, b, exact);
    for (int i = 0; i < d->n; i++) size = fmax(size, fabs(exact[i]));
    const tobi_linear_system a = {.singular = singular, .precondition = preconditioned ? jacobi : NULL};
    const tobi_linear_settings s = {.tolerance = 1e-11, .max = 400, .restart = 25};
    const outcome o = solve_with(solver, d, a, s, b, NULL);
    const double residual = true_residual(d, singular, b, o.x);
    assert_int_equal(o.report.status, TOBI_LINEAR_CONVERGED);
    assert_true(o.report.iterations > 3 && o.report.residual <= 1e-11);
    assert_true(fabs(residual - o.report.residual) <= 1e-14 + 1e-3*residual);
    for (int i = 0; i < d->n; i++) assert_true(fabs(o.x[i] - exact[i]) <= 1e-7*size);
    /* from the answer nothing is left to do */
    const outcome again = solve_with(solver, d, a, s, b, o.x);
    assert_int_equal(again.report.status, TOBI_LINEAR_CONVERGED);
    assert_int_equal(again.report.iterations, 0);
    assert_memory_equal(again.x, o.x, (size_t)d->n*sizeof(double));
}

static void solves_what_elimination_solves(void **state)
{
    static dense d;
    (void)state;
    for (int solver = CG; solver <= GMRES; solver++)
        for (int m = 0; m < 2; m++) {
            fill_positive(&d, 40);
            if (solver == CG || m) check_solves(solver, &d, 0, m);
            fill_lopsided(&d, 50);
            if (solver != CG) check_solves(solver, &d, 0, m);
            fill_ring(&d, 37, 0);
            check_solves(solver, &d, 1, m);
            fill_ring(&d, 37, 0.3);
            if (solver != CG) check_solves(solver, &d, 1, m);
        }
}

/* The mean of a ring of 20 rows. */
static void center_ring(void *user, double *y)
{
    double mean = 0;
    (void)user;
    for (int i = 0; i < 20; i++) mean += y[i]/20;
    for (int i = 0; i < 20; i++) y[i] -= mean;
}

/* A ring and rows that are not singular, joined by nothing: no answer, but for the mean of the ring's
   source. */
static void takes_out_other_constants(void **state)
{
    static dense d;
    double b[MOST], within[MOST];
    (void)state;
    fill_ring(&d, 20, 0);
    d.n = 37;
    for (int i = 20; i < 37; i++) d.a[i][i] = 2 + i%5;
    for (int i = 20; i < 36; i++) d.a[i][i + 1] = d.a[i + 1][i] = -0.5;
    finish(&d);
    fill_source(37, b);
    memcpy(within, b, sizeof within);
    center_ring(NULL, within);
    for (int solver = CG; solver <= GMRES; solver++) {
        tobi_linear_system a = {.precondition = jacobi};
        const tobi_linear_settings s = {.tolerance = 1e-11, .max = 400, .restart = 25};
        assert_int_not_equal(solve_with(solver, &d, a, s, b, NULL).report.status, TOBI_LINEAR_CONVERGED);
        a.center = center_ring;
        const outcome o = solve_with(solver, &d, a, s, b, NULL);
        double mean = 0;
        for (int i = 0; i < 20; i++) mean += o.x[i]/20;
        assert_int_equal(o.report.status, TOBI_LINEAR_CONVERGED);
        assert_true(true_residual(&d, 0, within, o.x) <= 2e-11);
        assert_true(fabs(mean) < 1e-12);
    }
}

/* A start that is far off costs digits: the estimate drifts and is replaced, and the goal is reached. */
static void replaces_a_drifted_residual(void **state)
{
    static dense d;
    double b[MOST], far[MOST];
    (void)state;
    fill_positive(&d, 40);
    fill_source(40, b);
    for (int i = 0; i < 40; i++) far[i] = 1e8*random_unit();
    for (int solver = CG; solver <= GMRES; solver++) {
        const tobi_linear_system a = {.precondition = jacobi};
        const tobi_linear_settings s = {.tolerance = 1e-11, .max = 2000, .restart = 40};
        const outcome o = solve_with(solver, &d, a, s, b, far);
        const double residual = true_residual(&d, 0, b, o.x);
        assert_int_equal(o.report.status, TOBI_LINEAR_CONVERGED);
        assert_true(o.report.fresh > 1);
        assert_true(residual <= 1.01e-11);
        assert_true(fabs(residual - o.report.residual) <= 1e-14 + 1e-3*residual);
    }
}

static void ends_where_no_digits_are_left(void **state)
{
    static dense d;
    double b[MOST];
    (void)state;
    fill_positive(&d, 40);
    fill_source(40, b);
    for (int solver = CG; solver <= GMRES; solver++) {
        const tobi_linear_system a = {.precondition = jacobi};
        const tobi_linear_settings s = {.tolerance = 1e-19, .max = 5000, .restart = 40};
        const outcome o = solve_with(solver, &d, a, s, b, NULL);
        assert_int_equal(o.report.status, TOBI_LINEAR_STAGNATED);
        assert_true(o.report.residual > 1e-19 && o.report.residual < 1e-12);
        assert_true(true_residual(&d, 0, b, o.x) < 1e-12);
    }
}

static void limits_and_stops(void **state)
{
    static dense d;
    double b[MOST], zero[MOST] = {0}, start[MOST];
    (void)state;
    fill_positive(&d, 40);
    fill_source(40, b);
    for (int i = 0; i < 40; i++) start[i] = 1;
    for (int solver = CG; solver <= GMRES; solver++) {
        const tobi_linear_settings s = {.tolerance = 1e-11, .max = 7, .restart = 5};
        tobi_linear_system a = {.precondition = jacobi};
        outcome o = solve_with(solver, &d, a, s, b, NULL);
        assert_int_equal(o.report.status, TOBI_LINEAR_LIMIT);
        assert_int_equal(o.report.iterations, 7);
        assert_true(fabs(o.report.residual/true_residual(&d, 0, b, o.x) - 1) < 1e-9);
        a.stop = stop;
        d.stop_after = 3;
        o = solve_with(solver, &d, a, s, b, NULL);
        assert_int_equal(o.report.status, TOBI_LINEAR_STOPPED);
        assert_int_equal(o.report.iterations, 3);
        assert_true(fabs(o.report.residual/true_residual(&d, 0, b, o.x) - 1) < 1e-9);
        a.stop = NULL;
        o = solve_with(solver, &d, a, s, zero, start);
        assert_int_equal(o.report.status, TOBI_LINEAR_CONVERGED);
        assert_memory_equal(o.x, zero, 40*sizeof(double));
    }
}

static void breaks_down_in_words(void **state)
{
    static dense d;
    const double b[3] = {1, 1, 1};
    const tobi_linear_system plain = {0};
    const tobi_linear_settings s = {.tolerance = 1e-10, .max = 50, .restart = 2};
    (void)state;
    memset(&d, 0, sizeof d);
    d.n = 2;
    d.a[0][0] = 1;
    d.a[1][1] = -1;                                             /* not definite */
    assert_int_equal(solve_with(CG, &d, plain, s, b, NULL).report.status, TOBI_LINEAR_BROKEN_DOWN);
    memset(d.a, 0, sizeof d.a);
    d.a[0][1] = 1;
    d.a[1][0] = -1;                                             /* A r is orthogonal to r */
    const outcome o = solve_with(BICGSTAB, &d, plain, s, b, NULL);
    assert_int_equal(o.report.status, TOBI_LINEAR_BROKEN_DOWN);
    assert_true(o.report.residual == 1 && o.x[0] == 0 && o.x[1] == 0);
    assert_int_equal(solve_with(GMRES, &d, plain, s, b, NULL).report.status, TOBI_LINEAR_CONVERGED);
    memset(d.a, 0, sizeof d.a);                                 /* A = 0 */
    assert_int_equal(solve_with(GMRES, &d, plain, s, b, NULL).report.status, TOBI_LINEAR_BROKEN_DOWN);
    d.n = 3;                                                    /* a ring shift: two directions never do */
    d.a[0][1] = d.a[1][2] = d.a[2][0] = 1;
    const double one[3] = {1, 0, 0};
    const outcome g = solve_with(GMRES, &d, plain, s, one, NULL);
    assert_int_equal(g.report.status, TOBI_LINEAR_STAGNATED);
    assert_true(g.report.residual == 1);
}

static void answers_what_is_not_finite(void **state)
{
    static dense d;
    double b[MOST], bad[MOST], start[MOST] = {0};
    (void)state;
    for (int solver = CG; solver <= GMRES; solver++)
        for (int k = 0; k < 2; k++) {
            const double wrong = k ? INFINITY : NAN;
            const tobi_linear_settings s = {.tolerance = 1e-11, .max = 100, .restart = 20};
            const tobi_linear_system a = {.precondition = jacobi};
            fill_positive(&d, 40);
            fill_source(40, b);
            memcpy(bad, b, sizeof bad);
            bad[17] = wrong;
            outcome o = solve_with(solver, &d, a, s, bad, NULL);
            assert_int_equal(o.report.status, TOBI_LINEAR_NOT_FINITE);
            for (int i = 0; i < 40; i++) assert_true(o.x[i] == 0);
            start[5] = wrong;
            o = solve_with(solver, &d, a, s, b, start);
            assert_int_equal(o.report.status, TOBI_LINEAR_NOT_FINITE);
            d.a[3][4] = wrong;
            o = solve_with(solver, &d, a, s, b, NULL);
            assert_int_equal(o.report.status, TOBI_LINEAR_NOT_FINITE);
            fill_positive(&d, 40);
            d.poison = 4;
            o = solve_with(solver, &d, a, s, b, NULL);
            assert_int_equal(o.report.status, TOBI_LINEAR_BROKEN_DOWN);
            for (int i = 0; i < 40; i++) assert_true(isfinite(o.x[i]));
        }
}

/* A long chain with wind, for sums over many blocks. */
typedef struct chain { int64_t n; double wind; } chain;
static void apply_chain(void *user, double *y, const double *x)
{
    const chain *c = user;
    for (int64_t i = 0; i < c->n; i++)
        y[i] = (2.01 + 0.5*(double)(i%7))*x[i] - (i ? (1 + c->wind)*x[i - 1] : 0) -
               (i + 1 < c->n ? (1 - c->wind)*x[i + 1] : 0);
}

static void same_bits_on_threads(void **state)
{
    enum { N = 20000 };
    static double x[3][N], b[N];
    static const int threads[3] = {1, 2, 4};
    (void)state;
    seed = 21;
    for (int i = 0; i < N; i++) b[i] = random_unit();
    for (int solver = CG; solver <= GMRES; solver++) {
        chain c = {N, solver == CG ? 0 : 0.4};
        const tobi_linear_system a = {.rows = N, .user = &c, .apply = apply_chain};
        const tobi_linear_settings s = {.tolerance = 1e-10, .max = 300, .restart = 10};
        double *work = malloc((size_t)work_of(solver, N, 10)*sizeof *work);
        memset(x, 0, sizeof x);
        for (int k = 0; k < 3; k++) {
            tobi_exec e;
            assert_int_equal(tobi_exec_init(&e, threads[k], NULL), TOBI_OK);
            assert_int_equal(tobi_exec_reserve(&e, N, NULL), TOBI_OK);
            assert_int_equal(call(solver, &e, &a, &s, b, x[k], work).status, TOBI_LINEAR_CONVERGED);
            tobi_exec_free(&e);
        }
        assert_memory_equal(x[0], x[1], sizeof x[0]);
        assert_memory_equal(x[0], x[2], sizeof x[0]);
        free(work);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solves_what_elimination_solves),
        cmocka_unit_test(takes_out_other_constants),
        cmocka_unit_test(replaces_a_drifted_residual),
        cmocka_unit_test(ends_where_no_digits_are_left),
        cmocka_unit_test(limits_and_stops),
        cmocka_unit_test(breaks_down_in_words),
        cmocka_unit_test(answers_what_is_not_finite),
        cmocka_unit_test(same_bits_on_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

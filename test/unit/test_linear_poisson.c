/* Conjugate gradients with the cell multigrid on compact Laplacians over jittered particles: as many
   iterations for 300 layers as for 10, and the same bits on any number of threads. */
#include "unit/poisson_rig.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>

static poisson q;

/* |b - A x|/|b| with sums of the test's own; without means where nothing holds the pressure. */
static double true_residual(void)
{
    const int64_t n = q.p.count;
    double *y = malloc((size_t)n*sizeof *y);
    long double mean_b = 0, mean_r = 0, rr = 0, bb = 0;
    poisson_apply(&q, y, q.x);
    for (int64_t i = 0; i < n && q.system.singular; i++) {
        mean_b += q.b[i]/(long double)n;
        mean_r += (q.b[i] - (long double)y[i])/(long double)n;
    }
    for (int64_t i = 0; i < n; i++) {
        const long double r = q.b[i] - (long double)y[i] - mean_r, b = q.b[i] - mean_b;
        rr += r*r;
        bb += b*b;
    }
    free(y);
    return (double)sqrtl(rr/bb);
}

static void make(int dimension, int wide, int deep, int closed, int threads)
{
    const int n[3] = {wide, dimension == 3 ? wide : deep, deep};
    poisson_seed = 5;
    assert_int_equal(poisson_fill(&q, dimension, n, closed, threads), TOBI_OK);
    poisson_assemble(&q);
    assert_int_equal(poisson_make_grid(&q, NULL), TOBI_OK);
    poisson_set_grid(&q);
}

static tobi_linear_report solve(int kind)
{
    const tobi_linear_report r = poisson_solve(&q, kind, 1e-6, 5000);
    const int products = q.products;
    const double residual = true_residual();
    assert_int_equal(r.status, TOBI_LINEAR_CONVERGED);
    assert_true(residual <= 1e-6 && fabs(r.residual/residual - 1) < 1e-6);
    if (kind == POISSON_CYCLE) assert_true(products <= 4*r.iterations);
    return r;
}

/* Iterations of multigrid and of the diagonal alone at these depths. */
static void check_depths(int dimension, int wide, const int *depth, int count, int most)
{
    int least = most, worst = 0, first = 0, last = 0;
    for (int k = 0; k < count; k++) {
        make(dimension, wide, depth[k], 0, 2);
        const int grid = solve(POISSON_CYCLE).iterations, jacobi = solve(POISSON_JACOBI).iterations;
        printf("%d-D, %d wide, %d layers: %d iterations, with the diagonal alone %d\n", dimension, wide,
               depth[k], grid, jacobi);
        least = grid < least ? grid : least;
        worst = grid > worst ? grid : worst;
        first = k ? first : jacobi;
        last = jacobi;
        poisson_drop(&q);
    }
    assert_true(worst <= most && 10*worst <= 13*least);
    assert_true(last > 1.5*first);                /* the systems do get harder with the depth */
}

static void as_many_iterations_at_any_depth_2d(void **state)
{
    static const int depth[] = {10, 30, 100, 300};
    (void)state;
    check_depths(2, 30, depth, 4, 13);
}

static void as_many_iterations_at_any_depth_3d(void **state)
{
    static const int depth[] = {10, 20, 40};
    (void)state;
    check_depths(3, 16, depth, 3, 14);
}

/* The grid does not know of a wall thinner than its cells: that costs iterations, not the answer. */
static void a_thin_wall_costs_iterations(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        make(dimension, dimension == 3 ? 20 : 60, dimension == 3 ? 20 : 60, 0, 2);
        const int without = solve(POISSON_CYCLE).iterations;
        q.wall = 0.6*q.box.size[dimension - 1];
        tobi_launch(&q.exec, TOBI_HOST(poisson_rows, 0, 0), &q, 0, q.p.count, NULL);
        poisson_set_grid(&q);
        const int with = solve(POISSON_CYCLE).iterations;
        printf("%d-D, a thin wall: %d iterations, %d without\n", dimension, with, without);
        assert_true(with <= 3*without);
        poisson_drop(&q);
    }
}

/* Nothing holds the pressure: a constant is free, and the answer has none. */
static void closed_box(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        double sum = 0, size = 0;
        make(dimension, dimension == 3 ? 14 : 60, dimension == 3 ? 14 : 60, 1, 2);
        for (int64_t i = 0; i < q.p.count; i++) {
            q.excess[i] = 0;                      /* gates that disorder opened a little */
            q.b[i] += 3/q.d;                      /* not in the range: the mean is not asked for */
        }
        q.system.singular = 1;
        poisson_set_grid(&q);
        assert_true(solve(POISSON_CYCLE).iterations <= 16);
        for (int64_t i = 0; i < q.p.count; i++) {
            sum += q.x[i];
            size += fabs(q.x[i]);
        }
        assert_true(fabs(sum) <= 1e-12*size);
        poisson_drop(&q);
    }
}

/* u . M v = v . M u > 0, and M is linear whatever the size of the residual. */
static void the_cycle_is_symmetric(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        make(dimension, dimension == 3 ? 12 : 50, dimension == 3 ? 15 : 60, 0, 1);
        const int64_t n = q.p.count;
        double *m = malloc((size_t)(4*n)*sizeof *m), *u = m, *v = m + n, *mu = m + 2*n, *mv = m + 3*n;
        double uv = 0, vu = 0, uu = 0;
        q.kind = POISSON_CYCLE;
        for (int64_t i = 0; i < n; i++) u[i] = poisson_random();
        for (int64_t i = 0; i < n; i++) v[i] = poisson_random();
        poisson_precondition(&q, mu, u);
        poisson_precondition(&q, mv, v);
        for (int64_t i = 0; i < n; i++) {
            uv += u[i]*mv[i];
            vu += v[i]*mu[i];
            uu += u[i]*mu[i];
        }
        assert_true(uu > 0);
        assert_true(fabs(uv - vu) <= 1e-6*uu);
        for (int64_t i = 0; i < n; i++) u[i] *= 0x1p-400;
        poisson_precondition(&q, mv, u);
        for (int64_t i = 0; i < n; i++) assert_true(mv[i] == 0x1p-400*mu[i]);
        free(m);
        poisson_drop(&q);
    }
}

static void same_bits_on_threads(void **state)
{
    static const int threads[] = {1, 2, 4};
    double *kept = NULL;
    (void)state;
    for (int k = 0; k < 3; k++) {
        make(2, 240, 240, 0, threads[k]);         /* nodes enough for shared sweeps */
        assert_true(q.grid.grid[0].n[0]*q.grid.grid[0].n[1] > 8000);
        solve(POISSON_CYCLE);
        const size_t bytes = (size_t)q.p.count*sizeof *q.x;
        if (kept) assert_memory_equal(q.x, kept, bytes);
        else kept = memcpy(malloc(bytes), q.x, bytes);
        poisson_drop(&q);
    }
    free(kept);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_many_iterations_at_any_depth_2d),
        cmocka_unit_test(as_many_iterations_at_any_depth_3d),
        cmocka_unit_test(a_thin_wall_costs_iterations),
        cmocka_unit_test(closed_box),
        cmocka_unit_test(the_cycle_is_symmetric),
        cmocka_unit_test(same_bits_on_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* The preconditioner is a symmetric positive operator, the same on any number of threads. */
#include "core/system.h"
#include "sph/state.h"
#include "core/smoothing.k.h"
#include "linear/multigrid.h"
#include "sph/kernels.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

typedef struct pool { tobi_simulation sim; tobi_system s; tobi_multigrid m; double d; } pool;

static uint64_t seed;
static double random_unit(void)
{
    seed = seed*6364136223846793005u + 1442695040888963407u;
    return (double)(seed >> 11)/9007199254740992.0;
}

/* A jittered pool of n layers each way in a box a third higher; one side pair periodic. */
static void fill(pool *p, int dimension, int n, int threads)
{
    static tobi_error err;
    tobi_system *s = &p->s;
    const double lower[3] = {-1, 2, 0};
    const int periodic[3] = {0, 1, 0};
    double upper[3];
    memset(p, 0, sizeof *p);
    p->d = 0.01;
    for (int a = 0; a < 3; a++) upper[a] = lower[a] + p->d*(a + 1 == dimension ? n*4/3 : n);
    assert_int_equal(tobi_exec_init(&p->sim.exec, threads, &err), TOBI_OK);
    tobi_smoothing_init(&s->smoothing, TOBI_SHAPE_WENDLAND, dimension, p->d, 2);
    tobi_box_init(&s->box, dimension, lower, upper, periodic, s->smoothing.h);
    int64_t count = dimension == 3 ? (int64_t)n*n*n : (int64_t)n*n;
    assert_int_equal(tobi_particles_create(&s->particles, &sph_field_list, 0, count, &err), TOBI_OK);
    assert_int_equal(tobi_cells_create(&s->cells, &s->box, s->smoothing.h, &s->particles, &p->sim.exec, &err),
                     TOBI_OK);
    tobi_particles_stage(&s->particles, SPH_SOLVE);
    assert_int_equal(tobi_exec_reserve(&p->sim.exec, count, &err), TOBI_OK);
    seed = 11;
    for (int64_t i = 0; i < count; i++) {
        int64_t at[3] = {i%n, i/n%n, i/n/n};
        for (int a = 0; a < dimension; a++)
            (&s->particles.position[i].x)[a] = p->d*((double)at[a] + 0.5 + 0.3*(random_unit() - 0.5));
    }
    s->particles.count = count;
    tobi_cells_sort(&s->cells, &s->box, &s->particles, sph_fields_of(&s->particles)->pressure, &p->sim.exec);
    for (int64_t i = 0; i < count; i++) {
        const double *x = &s->particles.position[i].x;
        sph_fields_of(&s->particles)->surface[i] = x[dimension - 1] > p->d*(n - 1);
        sph_fields_of(&s->particles)->precondition[i] = sph_fields_of(&s->particles)->surface[i] ? 0 : 1e-3f;
    }
    const tobi_cell_points points = tobi_cells_points(&s->cells, &s->box, &s->particles);
    const tobi_grid_weights w = {.strength = 1e-3,
                                 .volume = s->smoothing.volume,
                                 .active = sph_fields_of(&s->particles)->precondition,
                                 .marked = sph_fields_of(&s->particles)->surface,
                                 .hold = 1e-3/(p->d*p->d)};
    assert_int_equal(tobi_multigrid_create(&p->m, &points, 2, 1, &err), TOBI_OK);
    tobi_multigrid_set(&p->m, &p->sim.exec, &points, &w);
}

static void drop(pool *p)
{
    tobi_multigrid_free(&p->m);
    tobi_cells_free(&p->s.cells);
    tobi_particles_free(&p->s.particles);
    tobi_exec_free(&p->sim.exec);
}

/* q = z alone: r/diagonal + P u for the residual at hand. */
static void direction(pool *p)
{
    sph_view v;
    memset(&v, 0, sizeof v);
    v.residual = sph_fields_of(&p->s.particles)->residual;
    v.precondition = sph_fields_of(&p->s.particles)->precondition;
    v.record = p->s.cells.record;
    v.position = p->s.particles.position;
    v.coarse = tobi_multigrid_values(&p->m);
    tobi_launch(&p->sim.exec, sph_kernels_for(p->sim.exec.isa, TOBI_SHAPE_WENDLAND)->sph_cg_direction, &v, 0,
                p->s.particles.count, NULL);
}

static double apply(pool *p)
{
    const sph_fields *f = sph_fields_of(&p->s.particles);
    return tobi_multigrid_apply(&p->m, &p->sim.exec, f->residual, f->precondition);
}

static void random_residual(pool *p)
{
    const sph_fields *f = sph_fields_of(&p->s.particles);
    for (int64_t i = 0; i < p->s.particles.count; i++)
        f->residual[i] = f->precondition[i] > 0 ? (float)(random_unit() - 0.3) : 0;
}

static void symmetric_and_positive(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        pool p;
        fill(&p, dimension, dimension == 3 ? 21 : 90, 1);
        int64_t n = p.s.particles.count;
        float *a = malloc((size_t)n*sizeof *a), *za = malloc((size_t)n*sizeof *za);
        random_residual(&p);
        memcpy(a, sph_fields_of(&p.s.particles)->residual, (size_t)n*sizeof *a);
        double energy = apply(&p), jacobi = 0, whole = 0, ab = 0, ba = 0;
        direction(&p);
        for (int64_t i = 0; i < n; i++) {
            za[i] = p.s.cells.record[i].w;
            jacobi += (double)a[i]*a[i]*sph_fields_of(&p.s.particles)->precondition[i];
            whole += (double)a[i]*za[i];
        }
        assert_true(energy > 0);
        assert_true(fabs(whole - jacobi - energy) <= 1e-4*whole);      /* P is the transpose of P^T */
        random_residual(&p);
        apply(&p);
        direction(&p);
        for (int64_t i = 0; i < n; i++) {
            ab += (double)sph_fields_of(&p.s.particles)->residual[i]*za[i];
            ba += (double)a[i]*p.s.cells.record[i].w;
        }
        assert_true(fabs(ab - ba) <= 1e-4*fabs(ab));
        free(a);
        free(za);
        drop(&p);
    }
}

static void same_bits_on_threads(void **state)
{
    (void)state;
    pool one, four;
    fill(&one, 3, 48, 1);       /* large enough for shared sweeps */
    fill(&four, 3, 48, 4);
    random_residual(&one);
    memcpy(sph_fields_of(&four.s.particles)->residual, sph_fields_of(&one.s.particles)->residual,
           (size_t)one.s.particles.count*sizeof(float));
    double a = apply(&one), b = apply(&four);
    assert_memory_equal(&a, &b, sizeof a);
    const int *n = one.m.grid[0].n;
    assert_memory_equal(one.m.grid[0].value, four.m.grid[0].value,
                        (size_t)n[0]*(size_t)n[1]*(size_t)n[2]*sizeof(float));
    drop(&one);
    drop(&four);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(symmetric_and_positive),
        cmocka_unit_test(same_bits_on_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

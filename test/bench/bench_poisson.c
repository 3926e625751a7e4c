/* The cost of the compact Laplacian's solve:
   bench_poisson DIMENSION DEEP WIDE [TOLERANCE [THREADS [JACOBI]]]
   Prints rows, iterations, products per iteration, milliseconds per iteration, and what the set-up of the
   grid takes of set-up and solve; with JACOBI = 1 the same with the diagonal alone.
   OMP_WAIT_POLICY=passive, or waiting threads count as processor time. */
#include "unit/poisson_rig.h"
#include <stdio.h>
#include <time.h>

/* Processor seconds of all threads. */
static double processor(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}

static void measure(poisson *q, int kind, const char *name, double tolerance)
{
    const double wall = tobi_clock(), start = processor();
    if (kind == POISSON_CYCLE) poisson_set_grid(q);
    const double set = processor(), wall_set = tobi_clock();
    const tobi_linear_report r = poisson_solve(q, kind, tolerance, 20000);
    const double end = processor(), wall_end = tobi_clock();
    printf("%-10s rows %lld  status %d  iterations %d  residual %.1e  products/iteration %.1f  "
           "ms/iteration %.2f (processor %.2f)\n           solve %.3f s (processor %.3f s)  "
           "set-up %.3f s, %.1f %% of both\n", name, (long long)q->p.count, (int)r.status, r.iterations,
           r.residual, (double)q->products/r.iterations, 1e3*(wall_end - wall_set)/r.iterations,
           1e3*(end - set)/r.iterations, wall_end - wall_set, end - set, wall_set - wall,
           100*(set - start)/(end - start));
}

int main(int argc, char **argv)
{
    static poisson q;
    if (argc < 4) {
        fprintf(stderr, "usage: bench_poisson DIMENSION DEEP WIDE [TOLERANCE [THREADS [JACOBI]]]\n");
        return 2;
    }
    const int dimension = atoi(argv[1]), deep = atoi(argv[2]), wide = atoi(argv[3]);
    const int n[3] = {wide, dimension == 3 ? wide : deep, deep};
    const double tolerance = argc > 4 ? atof(argv[4]) : 1e-6;
    if (poisson_fill(&q, dimension, n, 0, argc > 5 ? atoi(argv[5]) : 0) != TOBI_OK) return 1;
    poisson_assemble(&q);
    if (poisson_make_grid(&q, NULL) != TOBI_OK) return 1;
    for (int k = 0; k < 2; k++) measure(&q, POISSON_CYCLE, "multigrid", tolerance);
    if (argc > 6 && atoi(argv[6])) measure(&q, POISSON_JACOBI, "jacobi", tolerance);
    poisson_drop(&q);
    return 0;
}

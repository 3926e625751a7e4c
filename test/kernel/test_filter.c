/* The filter (13b) of docs/theory/dfsph.md in disorder, at its full strength: the share that it takes of the
   velocities it takes most of. Above 2 it would feed them. */
#pragma GCC diagnostic ignored "-Wunused-function"     /* the rig has the oracles of all kernels */
#include "sph/kernels.h"
#include "sph/state.h"
#include "kernel/sph_rig.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <cmocka.h>

/* Velocities over the root of the sum of their squares; that root. */
static double scale_velocities(rig *g)
{
    double sum = 0;
    for (int64_t i = 0; i < g->p.count; i++)
        for (int a = 0; a < 3; a++) sum += pow((&g->p.velocity[i].x)[a], 2);
    const double size = sqrt(sum);
    for (int64_t i = 0; i < g->p.count; i++)
        for (int a = 0; a < 3; a++) (&g->p.velocity[i].x)[a] /= (float)size;
    return size;
}

/* By power iteration. */
static double largest_share(int dimension, double support, double jitter)
{
    rig_case k = {dimension, TOBI_SHAPE_WENDLAND, support, {0, 0, 0}, 1, 1, jitter, 0, 1};
    rig g;
    double share = 0;
    tobi_error err;
    assert_int_equal(rig_create(&g, &k, 2, &err), 0);
    const sph_kernels *table = sph_kernels_for(g.exec.isa, k.shape);
    const int64_t n = g.p.count;
    tobi_launch(&g.exec, table->sph_walls, &g.view, 0, n, NULL);
    tobi_launch(&g.exec, table->sph_density, &g.view, 0, n, NULL);
    g.view.dt = 1;
    g.view.filter = (float)(1/pow(g.c.shortest, 3));
    scale_velocities(&g);
    for (int step = 0; step < 200; step++) {
        tobi_float4 *before = malloc((size_t)n*sizeof *before);
        memcpy(before, g.p.velocity, (size_t)n*sizeof *before);
        tobi_launch(&g.exec, table->sph_filter, &g.view, 0, n, NULL);
        tobi_launch(&g.exec, table->sph_filter_compare, &g.view, 0, n, NULL);
        tobi_launch(&g.exec, table->sph_filter_kick, &g.view, 0, n, NULL);
        for (int64_t i = 0; i < n; i++)
            for (int a = 0; a < 3; a++)
                (&g.p.velocity[i].x)[a] = (&before[i].x)[a] - (&g.p.velocity[i].x)[a];
        free(before);
        share = scale_velocities(&g);
    }
    rig_free(&g);
    return share;
}

static void the_filter_never_feeds(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++)
        for (int s = 0; s < 3; s++)
            for (int j = 0; j < 4; j++) {
                const double support = 2 + 0.5*s, jitter = 0.1*j;
                const double share = largest_share(dimension, support, jitter);
                printf("%d-D, support %.1f d, jitter %.1f: at most %.3f is taken\n", dimension, support,
                       jitter, share);
                if (j == 0 && !(fabs(share - 1) < 0.05)) fail_msg("on the lattice it is 1");
                if (!(share < 2)) fail_msg("it feeds");
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(the_filter_never_feeds) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

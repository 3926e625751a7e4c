/* Eq. (1) to (2c) of docs/theory/viscosity.md in disorder and at free surfaces: what a liquid takes from a
   flow that is linear in space and keeps its volume. */
#pragma GCC diagnostic ignored "-Wunused-function"     /* the rig has the oracles of all kernels */
#include "sph/kernels.h"
#include "sph/state.h"
#include "kernel/sph_rig.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <cmocka.h>

/* Rows: grad w, 1/s. */
static const double shear[3][3] = {{0, 1, 0}, {0, 0, 0}, {0, 0, 0}},
                    thread[2][3][3] = {{{1, 0, 0}, {0, -1, 0}, {0, 0, 0}},
                                       {{-0.5, 0, 0}, {0, 1, 0}, {0, 0, -0.5}}},
                    turning[3][3] = {{0, -1, 0}, {1, 0, 0}, {0, 0, 0}};

/* Power that viscosity takes from the flow, W; in 2-D per metre. */
static double find_power(rig *g, const double flow[3][3])
{
    const sph_kernels *table = sph_kernels_for(g->exec.isa, g->view.shape);
    const sph_fields *f = sph_fields_of(&g->p);
    const int64_t n = g->p.count;
    double power = 0;
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++) {
            const double *x = &g->p.position[i].x;
            (&f->viscous_velocity[i].x)[a] = (float)(flow[a][0]*x[0] + flow[a][1]*x[1] + flow[a][2]*x[2]);
        }
    g->view.viscous.operand = f->viscous_velocity;
    g->view.viscous.moving = 0;
    g->view.dt = 1;
    tobi_launch(&g->exec, table->sph_viscous_shape, &g->view, 0, n, NULL);
    tobi_launch(&g->exec, table->sph_viscous_close, &g->view, 0, n, NULL);
    tobi_launch(&g->exec, table->sph_viscous_spin, &g->view, 0, n, NULL);
    tobi_launch(&g->exec, table->sph_viscous_product, &g->view, 0, n, NULL);
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++) {
            const double w = (&f->viscous_velocity[i].x)[a];
            power += g->c.volume*w*((&f->viscous_product[i].x)[a] - 1000*w);
        }
    return power;
}

/* 2 mu D:D V of all particles. */
static double theory(const rig *g, const double flow[3][3])
{
    double square = 0;
    for (int k = 0; k < 9; k++) square += pow(0.5*(flow[k/3][k%3] + flow[k%3][k/3]), 2);
    return 2*(double)g->view.dynamic*square*g->c.volume*(double)g->p.count;
}

/* A block with nothing around it. */
static void try_block(int dimension, double support, double jitter)
{
    rig_case k = {dimension, TOBI_SHAPE_WENDLAND, support, {0, 0, 0}, 1, 1, jitter, 0, 0};
    rig g;
    tobi_error err;
    assert_int_equal(rig_create(&g, &k, 2, &err), 0);
    g.view.plane_count = 0;
    g.view.dynamic = 1000;
    g.view.viscous.apparent = NULL;
    g.view.phase = NULL;
    const double sheared = find_power(&g, shear)/theory(&g, shear),
                 drawn = find_power(&g, thread[dimension - 2])/theory(&g, thread[dimension - 2]),
                 turned = find_power(&g, turning)/theory(&g, shear);
    printf("%d-D, support %.1f d, jitter %.1f: power over theory: ", dimension, support, jitter);
    printf("sheared %.3f, drawn out %.3f, turned %.1e\n", sheared, drawn, turned);
    if (!(fabs(sheared - 1) < 0.05)) fail_msg("sheared");
    if (!(fabs(drawn - 1) < 0.05)) fail_msg("drawn out");
    if (!(fabs(turned) < 3e-5)) fail_msg("turned");
    rig_free(&g);
}

static void linear_flows_lose_what_theory_says(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++)
        for (int s = 0; s < 2; s++)
            for (int j = 0; j < 4; j++) try_block(dimension, 2 + 0.5*s, 0.1*j);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(linear_flows_lose_what_theory_says) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

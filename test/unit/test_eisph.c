/* What eisph promises at rest, of its step, and of bodies that move by forces. */
#include "tobiuo/tobiuo.h"
#include "calls.h"
#include "core/smoothing.k.h"
#include "sph/isph/isph.h"
#include <math.h>
#include <cmocka.h>

enum { COUNT = 450 };
static const double SPACING = 0.01, DEEP = 0.15;

/* A pool 30 spacings wide and 15 deep. */
static tobi_world *make_pool(const tobi_eisph_def *def, const char *method, double still)
{
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    w.method = method;
    w.dimension = 2;
    w.gravity[1] = -9.81;
    w.gravity[2] = 0;
    w.domain_max[0] = 0.3;
    w.domain_max[1] = 0.3;
    w.spacing = SPACING;
    w.end_time = 10;
    OK(tobi_world_create(&w, def, &world, &err));
    fill.box_max[0] = 0.3;
    fill.box_max[1] = DEEP;
    fill.velocity[0] = still;
    OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
    return world;
}

/* The first step is solved, later ones do their sweeps; half a second later the pool is at rest and presses
   its floor with its weight, but for what sound of ten times the fall allows. */
static void a_pool_stays_at_rest(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        tobi_step_info info;
        tobi_eisph_def def = tobi_default_eisph_def();
        double p[COUNT], x[3*COUNT], most = 0;
        def.iteration = k > 0 ? TOBI_ITERATION_PSEUDO_TIME : TOBI_ITERATION_JACOBI;
        def.sweeps = k == 0 ? 1 : k == 1 ? 4 : 0;
        tobi_world *world = make_pool(&def, "eisph", 0);
        OK(tobi_world_step(world, 0, &info, &err));
        assert_true(info.divergence_converged && info.divergence_iterations > 4);
        while (tobi_world_time(world) < 0.5) {
            OK(tobi_world_step(world, 0, &info, &err));
            if (def.sweeps > 0) assert_int_equal(info.divergence_iterations, def.sweeps);
            else
                assert_in_range(info.divergence_iterations, 10, 60);
        }
        OK(tobi_world_read(world, TOBI_FLUID, "pressure", p, COUNT, &err));
        OK(tobi_world_read(world, TOBI_FLUID, "position", x, COUNT, &err));
        for (int i = 0; i < COUNT; i++) most = fmax(most, fabs(p[i] - 9810*(DEEP - x[3*i + 1])));
        if (!(most < 0.02*9810*DEEP)) fail_msg("case %d: pressure off by %g Pa", k, most);
        if (!(info.speed_max < 0.05*sqrt(9.81*DEEP))) fail_msg("case %d: %g m/s", k, info.speed_max);
        tobi_world_destroy(world);
    }
}

/* n sweeps of jacobi allow sqrt(n) times the step of one, those in pseudo-time about 0.7 n times. */
static void sweeps_allow_longer_steps(void **state)
{
    double dt[2][2];
    (void)state;
    for (int k = 0; k < 4; k++) {
        tobi_step_info info;
        tobi_eisph_def def = tobi_default_eisph_def();
        def.sound_speed = 100;
        def.sweeps = k%2 ? 9 : 1;
        def.iteration = k/2;
        tobi_world *world = make_pool(&def, "eisph", 0);
        for (int n = 0; n < 2; n++) OK(tobi_world_step(world, 0, &info, &err));
        dt[k/2][k%2] = info.dt;
        tobi_world_destroy(world);
    }
    assert_true(fabs(dt[0][1]/dt[0][0] - 3) < 1e-6);
    assert_true(fabs(dt[1][0]/dt[0][0] - 1) < 1e-6);
    assert_in_range((int)(10*dt[1][1]/dt[1][0]), 55, 65);
}

/* A box of a twentieth of the water's density, let go under it, rises with its added mass once the sound of
   its start has faded, and no step throws it: the sweeps hold its answer. */
static void a_light_body_answers_the_sweeps(void **state)
{
    (void)state;
    tobi_world *world = make_pool(NULL, "eisph", 0);
    tobi_body_def body = tobi_default_body_def();
    tobi_body_info info = { 0 };
    tobi_step_info step;
    body.name = "box";
    body.box_min[0] = 0.1; body.box_max[0] = 0.2;
    body.box_min[1] = 0.05; body.box_max[1] = 0.11;
    body.dynamics = TOBI_FREE;
    body.density = 50;
    OK(tobi_world_add_body(world, &body, &err));
    for (int n = 0; n < 100; n++) {
        const double before = info.velocity[1];
        OK(tobi_world_step(world, 0, &step, &err));
        OK(tobi_world_body(world, 0, &info));
        const double rate = (info.velocity[1] - before)/step.dt;
        if (n > 15 && !(rate > 0.2*9.81 && rate < 9.81)) fail_msg("step %d: %g m/s2", n, rate);
    }
    tobi_world_destroy(world);
}

/* Kernels that fall off sooner get a wider support, as by isph. */
static void the_support_follows_the_kernel(void **state)
{
    (void)state;
    for (int kernel = 0; kernel < TOBI_SHAPES; kernel++) {
        tobi_isph_def solved = tobi_default_isph_def();
        tobi_eisph_def swept = tobi_default_eisph_def();
        int shape[2];
        double support[2];
        solved.kernel = swept.kernel = kernel;
        tobi_isph.smoothing(&solved, 0, &shape[0], &support[0]);
        tobi_eisph.smoothing(&swept, 0, &shape[1], &support[1]);
        assert_true(shape[1] == kernel && support[1] == support[0]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pool_stays_at_rest),
        cmocka_unit_test(sweeps_allow_longer_steps),
        cmocka_unit_test(a_light_body_answers_the_sweeps), cmocka_unit_test(the_support_follows_the_kernel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

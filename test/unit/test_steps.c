/* How steps meet the times that are asked for: the last ones are equal, and no more than it takes. */
#include "calls.h"
#include "world/world.h"
#include <math.h>

static void numbers(void **state)
{
    (void)state;
    assert_true(tobi_simulation_fit_dt(0.25, 0) == 0.25);                /* no time is asked for */
    assert_true(tobi_simulation_fit_dt(0.25, 0.2) == 0.2);
    assert_true(tobi_simulation_fit_dt(0.25, 0.25*(1 + 1e-12)) == 0.25*(1 + 1e-12));
    assert_true(tobi_simulation_fit_dt(0.25, 0.3) == 0.15);
    assert_true(tobi_simulation_fit_dt(0.25, 1.1) == 1.1/5);
    assert_true(tobi_simulation_fit_dt(0.25, 2) == 0.25);
    assert_true(tobi_simulation_fit_dt(0.25, 2.1) == 0.25);             /* far away it does not count */
}

/* A step shorter than the one before tells another pressure (decision 111). */
static void steps_to_a_time_are_equal(void **state)
{
    (void)state;
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def water = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *w;
    def.method = "dfsph";
    def.dimension = 2;
    def.gravity[2] = 0;
    def.spacing = 0.02;
    def.domain_max[0] = def.domain_max[1] = 0.2;
    def.gravity[1] = -9.81;
    def.time_step_max = 0.003;
    water.name = "water";
    fill.box_max[0] = 0.2;
    fill.box_max[1] = 0.1;
    OK(tobi_world_create(&def, NULL, &w, &err));
    OK(tobi_world_add_fluid(w, &water, &fill, 1, &err));
    for (int k = 1; k <= 12; k++) {
        OK(tobi_world_step(w, 0.01*ceil(k/4.0 - 1e-9) - w->sim.time, NULL, &err));
        if (!(fabs(w->sim.dt - 0.0025) < 1e-12)) fail_msg("step %d has %.9g s, not 0.0025", k, w->sim.dt);
    }
    assert_true(fabs(w->sim.time - 0.03) < 1e-12);
    tobi_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers),
        cmocka_unit_test(steps_to_a_time_are_equal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

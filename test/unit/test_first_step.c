/* Without gravity nothing bounds the step of liquid at rest. What sets off within it is seen before it comes:
   a body that is back after its period, gravity that swings, the frame of a tank, pressures at outlets. */
#include "calls.h"
#include "tobiuo/motion.h"
#include "tobiuo/tobiuo.h"
#include <math.h>
#include <string.h>

/* A box of 0.4 x 0.4 m of water without gravity, full or with air above. */
static tobi_world *make_box(const char *method, double top)
{
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    tobi_fluid_def water = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    w.method = method;
    w.dimension = 2;
    w.gravity[0] = w.gravity[1] = w.gravity[2] = 0;
    w.domain_max[0] = 0.4;
    w.domain_max[1] = top;
    w.spacing = 0.02;
    w.end_time = 10;
    w.threads = 1;
    OK(tobi_world_create(&w, NULL, &world, &err));
    fill.box_max[0] = fill.box_max[1] = 0.4;
    OK(tobi_world_add_fluid(world, &water, &fill, 1, &err));
    return world;
}

/* Steps without a bound from outside to t; the longest of them, s. */
static double find_longest(tobi_world *world, double t)
{
    tobi_step_info info = { 0 };
    double longest = 0;
    while (info.time < t) {
        OK(tobi_world_step(world, 0, &info, &err));
        longest = fmax(longest, info.dt);
    }
    return longest;
}

/* It moves as 0.05 sin(4 pi t), with a ramp: once it came to a step of 1 s, two periods. */
static void a_body_that_swings_is_seen(void **state)
{
    static const char *const methods[] = { "isph", "dfsph" };
    (void)state;
    for (int k = 0; k < 4; k++) {
        const double hurry = k < 2 ? 1 : 1000;             /* a period of 0.5 s, or of 0.5 ms */
        tobi_world *world = make_box(methods[k%2], 0.4);
        tobi_body_def disc = tobi_default_body_def();
        tobi_motion *motion;
        OK(tobi_motion_oscillation((double[3]){ 1, 0, 0 }, 0.05, 2*hurry, 0, &motion, &err));
        OK(tobi_motion_set_times(motion, 0, INFINITY, 0.5/hurry, &err));
        disc.name = "disc";
        disc.sphere_centre[0] = disc.sphere_centre[1] = 0.2;
        disc.sphere_radius = 0.06;
        disc.motion = tobi_motion_positions;
        disc.motion_user = motion;
        disc.motion_rigid = 1;
        OK(tobi_world_add_body(world, &disc, &err));
        assert_true(find_longest(world, 1/hurry) < 0.2/hurry);
        tobi_world_destroy(world);
        tobi_motion_free(motion);
    }
}

/* Steps of 8 and 10 s once ended the run: the liquid was faster than anything until then explained. */
static void gravity_that_swings_is_seen(void **state)
{
    static const char *const methods[] = { "isph", "dfsph" };
    (void)state;
    for (int k = 0; k < 8; k++) {
        tobi_world *world = make_box(methods[k%2], k/2%2 ? 0.4 : 0.6);
        tobi_gravity_def swing = tobi_default_gravity_def();
        swing.amplitude[0] = 1;
        swing.period = 1;
        swing.ramp = k/4;
        OK(tobi_world_set_gravity_in_time(world, &swing, &err));
        assert_true(find_longest(world, 0.5) < 0.3);
        tobi_world_destroy(world);
    }
}

static void a_frame_that_swings_is_seen(void **state)
{
    static const char *const methods[] = { "isph", "dfsph" };
    (void)state;
    for (int k = 0; k < 4; k++) {
        tobi_world *world = make_box(methods[k%2], k/2%2 ? 0.4 : 0.6);
        tobi_motion *motion;
        OK(tobi_motion_oscillation((double[3]){ 1, 0, 0 }, 0.05, 2, 0, &motion, &err));
        OK(tobi_motion_set_times(motion, 0, INFINITY, 0.5, &err));
        OK(tobi_world_set_frame(world, tobi_motion_positions, motion, &err));
        assert_true(find_longest(world, 0.5) < 0.06);
        tobi_world_destroy(world);
        tobi_motion_free(motion);
    }
}

/* A pipe at rest between two outlets; 1000 Pa over it once met a step of 10 s. */
static void pressures_at_outlets_are_seen(void **state)
{
    static const char *const methods[] = { "isph", "dfsph", "eisph" };
    (void)state;
    for (int k = 0; k < 3; k++) {
        tobi_world *world = make_box(methods[k], 0.4);
        for (int end = 0; end < 2; end++) {
            tobi_outlet_def o = tobi_default_outlet_def();
            o.name = end ? "out" : "in";
            o.centre[0] = end ? 0.26 : 0.14;
            o.centre[1] = 0.2;
            o.normal[0] = end ? 1 : -1;
            o.width = 0.4;
            o.pressure = end ? 0 : 1000;
            OK(tobi_world_add_outlet(world, &o, &err));
        }
        assert_true(find_longest(world, 0.1) < 0.03);
        tobi_world_destroy(world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_body_that_swings_is_seen),
        cmocka_unit_test(gravity_that_swings_is_seen),
        cmocka_unit_test(a_frame_that_swings_is_seen),
        cmocka_unit_test(pressures_at_outlets_are_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

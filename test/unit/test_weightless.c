/* Without gravity nothing but bodies says how fast liquid may be: what rests, and what a spring stirs. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>
#include "scene_text.h"

static tobi_world *start(const char *method, double height, const char *more)
{
    char text[1400];
    tobi_world *world;
    tobi_error err = { 0 };
    snprintf(text, sizeof text, "{ \"method\": \"%s\", \"dimension\": 2, \"gravity\": [0, 0], "
             "\"domain\": { \"min\": [0, 0], \"max\": [0.4, 0.3] }, \"spacing\": 0.01, \"end_time\": 1, %s "
             "\"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"box\": { \"min\": [0, 0], "
             "\"max\": [0.4, %g] } } ] } ] }", method, more, height);
    if (start_scene(text, &world, &err) != TOBI_OK) fail_msg("%s", err.text);
    return world;
}

static const char *const methods[] = { "dfsph", "wcsph", "isph", "eisph" };

/* Rounding moves it by 1e-10 m/s: that is no runaway. */
static void liquid_that_nothing_drives_rests(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        tobi_error err = { 0 };
        tobi_world *world = start(methods[k], 0.15, "");
        tobi_step_info info = { 0 };
        for (double t = 0; t < 0.2; t += 0.05)
            if (tobi_world_advance(world, t + 0.05, &info, &err) != TOBI_OK)
                fail_msg("%s: %s", methods[k], err.text);
        assert_true(info.speed_max < 1e-6);
        tobi_world_destroy(world);
    }
}

/* A block on a spring stops at each turn of its way, and the water that it stirred does not. */
static void water_swings_on_when_a_body_turns(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        tobi_error err = { 0 };
        tobi_world *world = start(methods[k], 0.3, "\"bodies\": [ { \"name\": \"block\", \"density\": 3000, "
            "\"dynamics\": \"free\", \"box\": { \"min\": [0.1, 0.12], \"max\": [0.16, 0.18] } } ], "
            "\"lines\": [ { \"name\": \"spring\", \"body\": \"block\", \"stiffness\": 2000, \"length\": 0.1, "
            "\"point\": [0.13, 0.15], \"to\": [0.35, 0.15] } ], ");
        tobi_step_info info = { 0 };
        if (tobi_world_advance(world, 0.35, &info, &err) != TOBI_OK) fail_msg("%s: %s", methods[k], err.text);
        print_message("%s: %g m/s, %g J\n", methods[k], info.speed_max, info.kinetic_energy);
        assert_true(info.kinetic_energy > 0.5 && info.kinetic_energy < 0.5*2000*0.12*0.12);
        tobi_world_destroy(world);
    }
}

/* The speed of bodies is known when their step begins: then those of a motor rest still. */
static void a_motor_starts_in_water_at_rest(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        tobi_error err = { 0 };
        tobi_world *world = start(methods[k], 0.3, "\"bodies\": [ { \"name\": \"head\", "
            "\"dynamics\": \"free\", \"box\": { \"min\": [0.1, 0.12], \"max\": [0.18, 0.18] } }, "
            "{ \"name\": \"tail\", \"dynamics\": \"free\", "
            "\"box\": { \"min\": [0.18, 0.12], \"max\": [0.26, 0.18] } } ], \"joints\": [ { "
            "\"name\": \"neck\", \"body\": \"tail\", \"to_body\": \"head\", \"point\": [0.18, 0.15], "
            "\"motor\": { \"angle\": 0, \"amplitude\": 20, \"period\": 0.5, \"ramp\": 0.5 } } ], ");
        tobi_step_info info = { 0 };
        if (tobi_world_advance(world, 0.3, &info, &err) != TOBI_OK) fail_msg("%s: %s", methods[k], err.text);
        print_message("%s: %g m/s, %g J\n", methods[k], info.speed_max, info.kinetic_energy);
        assert_true(info.speed_max > 0.02 && info.speed_max < 1);
        tobi_world_destroy(world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(liquid_that_nothing_drives_rests),
        cmocka_unit_test(water_swings_on_when_a_body_turns),
        cmocka_unit_test(a_motor_starts_in_water_at_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

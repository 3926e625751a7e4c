/* Water under what stands on a floor (decision 131): a box feels its buoyancy, and the floor the opposite. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>
#include "scene_text.h"

static void must(tobi_status status, const tobi_error *err)
{
    if (status != TOBI_OK) fail_msg("%s", err->text);
}

/* 2-D, water 0.3 m deep, a box of 0.1 m by `top` on the floor. */
static tobi_world *start(const char *method, double top, const char *more)
{
    char text[2000];
    tobi_error err = { 0 };
    tobi_world *w;
    snprintf(text, sizeof text, "{ \"method\": \"%s\", \"dimension\": 2, \"spacing\": 0.01,"
             "\"end_time\": 9, \"domain\": { \"min\": [0, 0], \"max\": [0.6, 0.4] }, \"gravity\": [0, -9.81],"
             "\"bodies\": [ { \"name\": \"block\","
             "\"box\": { \"min\": [0.25, 0], \"max\": [0.35, %g] }%s } ],"
             "\"fluids\": [ { \"name\": \"water\", \"density\": 1000, \"viscosity\": 1e-3,"
             "\"fill\": [ { \"box\": { \"min\": [0, 0], \"max\": [0.6, 0.3] } } ] } ] }", method, top, more);
    must(start_scene(text, &w, &err), &err);
    return w;
}

static void step_to(tobi_world *w, double end)
{
    tobi_error err = { 0 };
    tobi_step_info info = { 0 };
    while (info.time < end) must(tobi_world_step(w, 0, &info, &err), &err);
}

static tobi_body_info block_of(const tobi_world *w)
{
    tobi_body_info info;
    assert_int_equal(tobi_world_body(w, 0, &info), TOBI_OK);
    return info;
}

static const double WIDE = 0.1, HIGH = 0.1, DEPTH = 0.3, WEIGHT = 1000*9.81;      /* m, N/m3 */

/* `isph` held the box down, and pressed the floor beneath it too. off: of the floor; that of eisph is up to
   4 % off without bodies (decision 51). */
static void stands(const char *method, double top, double off)
{
    tobi_world *w = start(method, top, "");
    step_to(w, 0.05);
    const double buoyancy = WEIGHT*WIDE*fmin(top, DEPTH), force = block_of(w).pressure_force[1];
    const tobi_step_info *info = tobi_world_info(w);
    const double floor = -info->wall_force[1]/(info->weight + buoyancy);
    print_message("%s, box %g m high: %g of its buoyancy, floor %g\n", method, top, force/buoyancy, floor);
    if (fabs(force/buoyancy - 1) > 0.02) fail_msg("force %g N, buoyancy %g N", force, buoyancy);
    if (fabs(floor - 1) > off) fail_msg("the floor bears %g of water and buoyancy", floor);
    tobi_world_destroy(w);
}

/* The floor of a vessel is as that of the domain; there the box was held down. Its outside is dry. */
static void boxes_stand_in_vessels(void **state)
{
    (void)state;
    static const struct { const char *method; double off; } run[] = {
        { "isph", 0.005 }, { "eisph", 0.02 }, { "dfsph", 0.01 }, { "wcsph", 0.01 } };
    for (int k = 0; k < 4; k++) {
        char text[2000];
        tobi_error err = { 0 };
        tobi_world *w;
        tobi_body_info tank;
        snprintf(text, sizeof text, "{ \"method\": \"%s\", \"dimension\": 2, \"spacing\": 0.01,"
                 "\"end_time\": 9, \"domain\": { \"min\": [-0.1, -0.1], \"max\": [0.7, 0.5] },"
                 "\"bodies\": [ { \"name\": \"block\", \"box\": {"
                 "\"min\": [0.25, 0], \"max\": [0.35, 0.1] } },"
                 "{ \"name\": \"tank\", \"vessel\": true, \"outline\": {"
                 "\"points\": [[0, 0], [0.6, 0], [0.6, 0.4], [0, 0.4]] } } ],"
                 "\"fluids\": [ { \"name\": \"water\", \"fill\": ["
                 "{ \"vessel\": \"tank\", \"level\": 0.3 } ] } ] }",
                 run[k].method);
        must(start_scene(text, &w, &err), &err);
        step_to(w, 0.05);
        const double buoyancy = WEIGHT*WIDE*HIGH, force = block_of(w).pressure_force[1];
        assert_int_equal(tobi_world_body(w, 1, &tank), TOBI_OK);
        const double floor = -tank.pressure_force[1]/(WEIGHT*0.6*DEPTH);
        print_message("%s, in a vessel: %g of its buoyancy, floor %g\n", run[k].method, force/buoyancy,
                      floor);
        if (fabs(force/buoyancy - 1) > 0.02) fail_msg("force %g N, buoyancy %g N", force, buoyancy);
        if (fabs(floor - 1) > run[k].off)
            fail_msg("the floor bears %g of water and buoyancy", floor);
        tobi_world_destroy(w);
    }
}

static void boxes_stand(void **state)
{
    (void)state;
    const char *methods[] = { "isph", "eisph", "dfsph", "wcsph" };
    const double off[] = { 0.005, 0.02, 0.01, 0.01 };
    for (int k = 0; k < 4; k++) {
        stands(methods[k], 0.1, off[k]);
        stands(methods[k], 0.38, off[k]);
    }
}

/* Then the water above presses it, and no buoyancy lifts it. */
static void sealed_boxes_are_pressed(void **state)
{
    (void)state;
    const char *methods[] = { "isph", "eisph", "dfsph", "wcsph" };
    for (int k = 0; k < 4; k++) {
        tobi_world *w = start(methods[k], HIGH, ", \"sealed\": true");
        step_to(w, 0.05);
        const double force = -block_of(w).pressure_force[1]/(WEIGHT*WIDE*(DEPTH - HIGH));
        print_message("%s: %g of the weight of the water above a sealed box\n", methods[k], force);
        assert_true(fabs(force - 1) < 0.02);
        tobi_world_destroy(w);
    }
}

/* Lighter than water it rises, heavier it rests with the rest of its weight. `isph` held both down. */
static void blocks_are_free(void **state)
{
    (void)state;
    tobi_world *light = start("isph", HIGH, ", \"dynamics\": \"free\", \"density\": 600");
    tobi_world *heavy = start("isph", HIGH, ", \"dynamics\": \"free\", \"density\": 2000");
    step_to(light, 0.3);
    step_to(heavy, 0.15);
    const double rise = block_of(light).position[1] - 0.5*HIGH;
    const double bears = block_of(heavy).contact_force[1]/(WEIGHT*WIDE*HIGH);
    print_message("a light block rises by %g m in 0.3 s; the floor bears %g of a heavy one's rest\n",
                  rise, bears);
    assert_true(rise > 0.05);
    assert_true(fabs(bears - 1) < 0.02);
    tobi_world_destroy(light);
    tobi_world_destroy(heavy);
}

/* Under a ceiling that water does not reach, and on a dry floor, a gap is dry. */
static void dry_gaps_do_not_press(void **state)
{
    (void)state;
    tobi_world *w = start("isph", HIGH, ", \"translation\": [0, 0.3]");
    step_to(w, 0.05);
    const double force = block_of(w).pressure_force[1];
    print_message("a box below the ceiling: %g N\n", force);
    assert_true(fabs(force) < 0.02*WEIGHT*WIDE*HIGH);
    tobi_world_destroy(w);
}

/* A vessel on a floor that is dry: its water rests on it alone. The water within counted as one around it,
   and lifted it. */
static void a_vessel_stands_in_the_dry(void **state)
{
    static const char *const methods[] = { "dfsph", "wcsph", "isph" };
    (void)state;
    for (int k = 0; k < 3; k++) {
        char text[900];
        snprintf(text, sizeof text,
                 "{ \"method\": \"%s\", \"threads\": 1, \"spacing\": 0.02, \"end_time\": 1,"
                 "\"domain\": { \"min\": [-0.1, -0.1, -0.04], \"max\": [0.3, 0.3, 0.3] },"
                 "\"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"vessel\": \"tank\","
                 "\"level\": 0.1 } ] } ], \"bodies\": [ { \"name\": \"tank\", \"vessel\": true,"
                 "\"box\": { \"min\": [0, 0, 0], \"max\": [0.2, 0.2, 0.2] }, \"open_side\": [0, 0, 1] } ] }",
                 methods[k]);
        tobi_error err = { 0 };
        tobi_step_info info;
        tobi_world *w;
        must(start_scene(text, &w, &err), &err);
        must(tobi_world_advance(w, 0.05, &info, &err), &err);
        const tobi_body_info tank = block_of(w);
        print_message("%s: a tank of %.4g N of water bears %.4g N\n", methods[k], info.weight,
                      -tank.pressure_force[2]);
        assert_true(fabs(-tank.pressure_force[2]/info.weight - 1) < 0.01);
        tobi_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_stand), cmocka_unit_test(boxes_stand_in_vessels),
        cmocka_unit_test(a_vessel_stands_in_the_dry),
        cmocka_unit_test(sealed_boxes_are_pressed),
        cmocka_unit_test(blocks_are_free),
        cmocka_unit_test(dry_gaps_do_not_press),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

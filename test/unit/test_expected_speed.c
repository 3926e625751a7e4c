/* Where the colours of the speed end in two dimensions: energies of pools against their formulas, pistons
   that part pools, and scenes whose speed nothing but the fall through the domain tells. */
#include "scene_text.h"
#include "tobiuo/drawing.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

/* Before the start and after it: pictures of results are those of the run. */
static double expect(const char *gravity, const char *water, const char *rest)
{
    char text[2000];
    tobi_error err = { 0 };
    tobi_scene *scene = NULL;
    tobi_world *w = NULL;
    tobi_looks looks;
    double speed[2] = { 0 };
    snprintf(text, sizeof text, "{ \"dimension\": 2, \"method\": \"isph\", \"spacing\": 0.05, "
             "\"end_time\": 10, \"domain\": { \"min\": [0, 0], \"max\": [4, 2] }, \"gravity\": [%s], "
             "\"fluids\": [ { \"name\": \"water\", \"fill\": [ %s ] } ] %s }", gravity, water, rest);
    if (tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, &err) != TOBI_OK ||
        tobi_scene_build(scene, &w, &err) != TOBI_OK) fail_msg("%s", err.text);
    for (int k = 0; k < 2; k++) {
        if (k == 1 && tobi_world_start(w, &err) != TOBI_OK) fail_msg("%s", err.text);
        if (tobi_world_looks(w, &looks, &err) != TOBI_OK) fail_msg("%s", err.text);
        speed[k] = looks.speed;
        tobi_looks_free(&looks);
    }
    assert_true(speed[0] == speed[1]);
    tobi_world_destroy(w);
    tobi_scene_free(scene);
    return speed[0];
}

/* x upwards to two digits. */
static double two_digits(double x)
{
    const double unit = pow(10, floor(log10(x)) - 1);
    return unit*ceil(x/unit);
}

#define DOWN "0, -9.81"
#define BOX(x0, y0, x1, y1) "{ \"box\": { \"min\": [" #x0 ", " #y0 "], \"max\": [" #x1 ", " #y1 "] } }"

static void a_pool_that_becomes_level(void **state)
{
    (void)state;
    const double g = 9.81;
    const double dam = 0.5*g*(1 - 0.25);      /* J/kg: 1 m by 1 m, then 4 m by 0.25 m */
    assert_float_equal(expect(DOWN, BOX(0, 0, 1, 1), ""), two_digits(1.7*sqrt(2*dam)), 1e-9);
    const double slope = 4*1/g;               /* m, from end to end of the plane that is level */
    const double slosh = g*slope*slope/24;    /* g times the mean of eta^2/2 over a depth of 1 m */
    assert_float_equal(expect("1, -9.81", BOX(0, 0, 4, 1), ""), two_digits(1.7*sqrt(2*slosh)), 1e-9);
    const double fall = 0.5*sqrt(2*g*2);
    assert_float_equal(expect(DOWN, BOX(0, 0, 4, 1), ""), two_digits(0.1*fall), 1e-9);
    const double drop = g*(1.5 - 1 - 0.5*0.5/4);       /* above the level */
    assert_float_equal(expect(DOWN, BOX(0, 0, 4, 1) ", " BOX(1, 1.5, 1.5, 2), ""),
                       two_digits(sqrt(2*drop)), 1e-9);
}

#define BODY(box, rest) ", \"bodies\": [ { \"name\": \"b\", \"box\": { " box " }, " rest " } ]"
#define POST "\"min\": [0.4, 0], \"max\": [0.5, 1.5]"
#define SURGE(extra) "\"motion\": { \"surge\": { \"amplitude\": 0.1, \"period\": 2 } }" extra

static void bodies_move_it_and_part_it(void **state)
{
    (void)state;
    const double fall = 0.5*sqrt(2*9.81*2), surge = 1.5*0.1*acos(-1);
    const char *water = BOX(0.5, 0, 4, 1);
    assert_float_equal(expect(DOWN, water, BODY(POST, SURGE())), two_digits(surge), 1e-9);
    assert_float_equal(expect(DOWN, water, BODY(POST, "\"friction\": \"slip\"")), two_digits(0.1*fall), 1e-9);
    /* A gate goes away; a short post is flowed over: the water gets to the left of both. */
    assert_true(expect(DOWN, water, BODY(POST, "\"absent\": { \"from\": 1 }")) > 2*0.1*fall);
    assert_true(expect(DOWN, water, BODY("\"min\": [0.4, 0], \"max\": [0.5, 0.5]",
                                         "\"friction\": \"slip\"")) > 2*0.1*fall);
    assert_true(expect(DOWN, water, BODY(POST, "\"motion\": { \"sway\": { \"amplitude\": 1, "
                                         "\"period\": 40 } }")) > 2*0.1*fall);
    /* A block that falls into a pool. */
    assert_float_equal(expect(DOWN, BOX(0, 0, 4, 1), BODY("\"min\": [1, 1.4], \"max\": [1.4, 1.8]",
                       "\"dynamics\": \"free\", \"density\": 500")), two_digits(sqrt(2*9.81*0.4)), 1e-9);
}

static void others_fall_through_the_domain(void **state)
{
    (void)state;
    const double fall = 0.5*sqrt(2*9.81*2);
    const char *pool = BOX(0, 0, 4, 1);
    assert_float_equal(expect(DOWN, pool, ", \"frame\": { \"surge\": { \"amplitude\": 0.1, "
                              "\"period\": 2 } }"), fall, 1e-9);
    assert_float_equal(expect("0, 0", BOX(0, 0, 4, 2), ""), 0, 0);
    /* A stirrer in a vessel is faster than that: its rim, 0.2 m from the axis, at 40 pi/s. */
    const char *vessel = ", \"bodies\": [ { \"name\": \"v\", \"vessel\": true, "
        "\"sphere\": { \"centre\": [2, 1], \"radius\": 0.8 } }, { \"name\": \"s\", \"sphere\": { \"centre\": "
        "[2, 1], \"radius\": 0.2 }, \"motion\": { \"rotation\": { \"centre\": [2, 1], \"rate\": %d } } } ]";
    char bodies[400];
    snprintf(bodies, sizeof bodies, vessel, 7200);
    assert_float_equal(expect(DOWN, BOX(1.5, 0.4, 2.5, 0.8), bodies), two_digits(1.5*0.2*40*acos(-1)), 1e-9);
    snprintf(bodies, sizeof bodies, vessel, 36);
    assert_float_equal(expect(DOWN, BOX(1.5, 0.4, 2.5, 0.8), bodies), fall, 1e-9);
    assert_float_equal(expect("0, 0", "{ \"box\": { \"min\": [0, 0], \"max\": [1, 1] }, "
                              "\"velocity\": [3, 4] }", ""), 5, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pool_that_becomes_level),
        cmocka_unit_test(bodies_move_it_and_part_it),
        cmocka_unit_test(others_fall_through_the_domain),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

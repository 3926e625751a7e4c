/* Flows that are faster than fall, bodies and inlets alone: narrow places, pressure in a pipe, a limit of the
   user's own. Levels and pressures of 0, and other zeros of scenes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "scene_text.h"
#include "world/world.h"

static void must(tobi_status status, const tobi_error *err)
{
    if (status != TOBI_OK) fail_msg("%s", err->text);
}

#define CHANNEL "\"dimension\": 2, \"threads\": 1, \"spacing\": 0.02, \"end_time\": 1, \"gravity\": [0, 0]," \
    "\"domain\": { \"min\": [0, 0], \"max\": [1, 0.2] }, \"fluids\": [ { \"name\": \"water\"," \
    "\"fill\": [ { \"box\": { \"min\": [0, 0], \"max\": [1, 0.2] } } ] } ],"

/* Through the channel; %s: more of the outlet. Ends the scene. */
#define THROUGH "\"inlets\": [ { \"name\": \"in\", \"centre\": [0.15, 0.1], \"normal\": [1, 0]," \
    "\"width\": 0.2, \"speed\": 0.5, \"ramp\": 0.2 } ], \"outlets\": [ { \"name\": \"out\"," \
    "\"centre\": [0.85, 0.1], \"normal\": [1, 0], \"width\": 0.2%s } ] }"

/* A hole of a fifth of the width: the water there is five times as fast as at the inlet, and not slowed. */
static void test_narrow(void **state)
{
    static const char *const limits[] = { "", "\"speed_limit\": 30," };
    (void)state;
    for (int k = 0; k < 2; k++) {
        char text[2000];
        tobi_error err = { 0 };
        tobi_step_info info;
        tobi_world *w;
        snprintf(text, sizeof text, "{ \"method\": \"isph\", %s %s"
                 "\"bodies\": [ { \"name\": \"a\", \"box\": { \"min\": [0.4, 0], \"max\": [0.5, 0.08] } },"
                 "{ \"name\": \"b\", \"box\": { \"min\": [0.4, 0.12], \"max\": [0.5, 0.2] } } ],"
                 THROUGH, CHANNEL, limits[k], ", \"pressure\": 4000");
        must(start_scene(text, &w, &err), &err);
        for (double t = 0.05; t < (SANITIZED ? 0.11 : 0.31); t += 0.05) {
            must(tobi_world_advance(w, t, &info, &err), &err);
            assert_int_equal(info.capped, 0);
        }
        assert_true(SANITIZED || info.speed_max > 2);     /* 2.5 by continuity; it is still narrower behind */
        tobi_world_destroy(w);
    }
}

/* A piston in a tube of 0.2 m: the method, more of its motion, more bodies. */
#define PISTON "{ \"method\": \"%s\", \"dimension\": 2, \"threads\": 1, \"spacing\": 0.02, \"end_time\": 1," \
    "\"gravity\": [0, 0], \"domain\": { \"min\": [0, 0], \"max\": [1.4, 0.2] }, \"fluids\": [" \
    "{ \"name\": \"water\", \"fill\": [ { \"box\": { \"min\": [0.1, 0], \"max\": [0.8, 0.2] } } ] } ]," \
    "\"bodies\": [ { \"name\": \"piston\", \"box\": { \"min\": [0, 0], \"max\": [0.1, 0.2] }," \
    "\"motion\": { \"translation\": { \"velocity\": [0.5, 0, 0]%s } } } %s ] }"

static const char nozzle[] = ", { \"name\": \"a\", \"box\": { \"min\": [0.8, 0], \"max\": [0.9, 0.08] } },"
    "{ \"name\": \"b\", \"box\": { \"min\": [0.8, 0.12], \"max\": [0.9, 0.2] } }";

static void press(const char *method, const char *ramp, const char *end, double until, tobi_step_info *info)
{
    char text[2000];
    tobi_error err = { 0 };
    tobi_scene *scene;      /* has the motion */
    tobi_world *w = NULL;
    snprintf(text, sizeof text, PISTON, method, ramp, end);
    must(tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, &err), &err);
    must(tobi_scene_build(scene, &w, &err), &err);
    for (double t = 0.02; t < until + 0.01; t += 0.02) {
        must(tobi_world_advance(w, t, info, &err), &err);
        if (t > 0.1) assert_int_equal(info->capped, 0);      /* the cap follows the piston, a step late */
    }
    tobi_world_destroy(w);
    tobi_scene_free(scene);
}

/* A piston pushes water out of a fifth of its width: a jet of 2.5 m/s or more, which is not slowed. */
static void test_piston(void **state)
{
    static const char *const methods[] = { "isph", "wcsph", "dfsph" };
    static const char *const ramps[] = { "", ", \"ramp\": 0.1" };
    (void)state;
    for (int k = 0; k < 6; k++) {
        tobi_step_info info;
        press(methods[k/2], ramps[k%2], nozzle, SANITIZED ? 0.06 : 0.3, &info);
        print_message("%s%s: %g m/s, density off by %g\n", methods[k/2], ramps[k%2], info.speed_max,
                      info.density_error_mean);
        if (SANITIZED) continue;
        assert_true(info.speed_max > 2.5);
        if (k/2 != 1) assert_true(info.density_error_mean < 0.01);
    }
}

/* Nothing but the piston's acceleration presses the water in an open tube: steps of dfsph resolve that. */
static void test_open_tube(void **state)
{
    tobi_step_info info;
    (void)state;
    press("dfsph", ", \"ramp\": 0.1", "", 0.12, &info);
    assert_true(info.density_error_mean < 0.005);
    assert_true(info.speed_max > 0.49 && info.speed_max < 0.6);
}

/* A full pipe is told what its method makes of it, unless it keeps the pipe full. */
static void test_full_pipes(void **state)
{
    static const struct { const char *method, *outlet, *note; } cases[] = {
        { "isph", "", "full pipe gets cavities" }, { "isph", ", \"pressure\": 500", NULL },
        { "wcsph", ", \"pressure\": 500", NULL },
        { "dfsph", ", \"pressure\": 500", "dfsph crowds or loses liquid" } };
    (void)state;
    for (int k = 0; k < 4; k++) {
        char text[2000];
        tobi_error err = { 0 };
        tobi_world *w;
        int told = 0;
        snprintf(text, sizeof text, "{ \"method\": \"%s\", %s" THROUGH,
                 cases[k].method, CHANNEL, cases[k].outlet);
        must(start_scene(text, &w, &err), &err);
        for (int n = 0; tobi_world_note(w, n); n++)
            told |= cases[k].note ? strstr(tobi_world_note(w, n), cases[k].note) != NULL
                                  : strstr(tobi_world_note(w, n), "full pipe") != NULL;
        assert_int_equal(told, cases[k].note != NULL);
        tobi_world_destroy(w);
    }
}

/* Nothing but a pressure of 2000 Pa moves the water, at most at sqrt(2 p/rho) = 2 m/s. */
static void test_pressure(void **state)
{
    static const char *const methods[] = { "isph", "wcsph", "dfsph" };
    (void)state;
    for (int k = 0; k < 3; k++) {
        char text[2000];
        tobi_error err = { 0 };
        tobi_step_info info;
        tobi_world *w;
        snprintf(text, sizeof text, "{ \"method\": \"%s\", %s"
                 "\"outlets\": [ { \"name\": \"a\", \"centre\": [0.2, 0.1], \"normal\": [-1, 0],"
                 "\"width\": 0.2, \"pressure\": 2000 }, { \"name\": \"b\", \"centre\": [0.8, 0.1],"
                 "\"normal\": [1, 0], \"width\": 0.2, \"pressure\": 0 } ] }", methods[k], CHANNEL);
        must(start_scene(text, &w, &err), &err);
        must(tobi_world_advance(w, 0.2, &info, &err), &err);
        assert_true(info.speed_max > 0.2 && info.speed_max < 2.2);
        tobi_world_destroy(w);
    }
}

/* 0 is a level as any other: water up to it rests. */
static void test_level_zero(void **state)
{
    const char *text = "{ \"method\": \"isph\", \"dimension\": 2, \"threads\": 1, \"spacing\": 0.02,"
        "\"end_time\": 1, \"domain\": { \"min\": [0, -0.2], \"max\": [1, 0.1] },"
        "\"fluids\": [ { \"name\": \"water\","
        "\"fill\": [ { \"box\": { \"min\": [0, -0.2], \"max\": [1, 0] } } ] } ],"
        "\"outlets\": [ { \"name\": \"out\", \"centre\": [0.85, -0.05], \"normal\": [1, 0],"
        "\"width\": 0.3, \"level\": 0 } ] }";
    tobi_error err = { 0 };
    tobi_step_info info;
    tobi_world *w;
    (void)state;
    must(start_scene(text, &w, &err), &err);
    must(tobi_world_advance(w, 0.1, &info, &err), &err);       /* what lies beyond the buffer is gone */
    const double held = info.mass_held;
    must(tobi_world_advance(w, SANITIZED ? 0.2 : 1, &info, &err), &err);
    assert_true(fabs(info.mass_held - held) < 0.03*held);
    tobi_world_destroy(w);
}

/* What begins at 0 is not what never begins. */
static void test_written_zeros(void **state)
{
    static const struct { const char *key, *says; } cases[] = {
        { "\"absent\": { \"from\": 0 }", "absent.from: is 0, allowed is 1e-12 to 1e9 s, or \"never\"" },
        { "\"motion\": { \"translation\": { \"velocity\": [1, 0, 0], \"stop\": 0 } }",
          "stop: is 0, allowed is 1e-12 to 1e9 s, or \"never\"" },
        { "\"opacity\": 0", "opacity: is 0, allowed is 0.01 to 1, or \"automatic\"" } };
    (void)state;
    for (int k = 0; k < 3; k++) {
        char text[2000];
        tobi_error err = { 0 };
        tobi_world *w;
        snprintf(text, sizeof text, "{ %s \"bodies\": [ { \"name\": \"a\", \"box\": { \"min\": [0.4, 0.05],"
                 "\"max\": [0.5, 0.15] }, %s } ] }", CHANNEL, cases[k].key);
        assert_int_equal(start_scene(text, &w, &err), TOBI_INVALID);
        if (!strstr(err.text, cases[k].says)) fail_msg("%s", err.text);
    }
}

/* A block that falls flat on the floor throws jets to its sides, twice as fast as it fell: they are flow, and
   are not slowed. */
static void test_flat_fall(void **state)
{
    const char *text = "{ \"dimension\": 2, \"threads\": 1, \"spacing\": 0.01, \"end_time\": 1,"
        "\"domain\": { \"min\": [0, 0], \"max\": [0.6, 1.2] }, \"fluids\": [ { \"name\": \"water\","
        "\"fill\": [ { \"box\": { \"min\": [0.2, 0.8], \"max\": [0.4, 1] } } ] } ] }";
    const double end = sqrt(2*0.8/9.81) + 0.02;
    double fastest = 0;
    tobi_error err = { 0 };
    tobi_step_info info = { 0 };
    tobi_world *w;
    (void)state;
    must(start_scene(text, &w, &err), &err);
    while (tobi_world_time(w) < end) {
        must(tobi_world_step(w, 0, &info, &err), &err);
        assert_int_equal(info.capped, 0);
        fastest = fmax(fastest, info.speed_max);
    }
    assert_true(fastest > 1.7*sqrt(2*9.81*0.8));
    tobi_world_destroy(w);
}

/* A place in a 2-D scene has two components, also where a word may stand for it. */
static void test_flat_seed(void **state)
{
    const char *text = "{ \"dimension\": 2, \"spacing\": 0.02, \"end_time\": 1,"
        "\"domain\": { \"min\": [-0.1, -0.1], \"max\": [0.5, 0.5] }, \"fluids\": [ { \"name\": \"water\","
        "\"fill\": [ { \"vessel\": \"cup\", \"level\": 0.2, \"seed\": [0.2, 0.1] } ] } ],"
        "\"bodies\": [ { \"name\": \"cup\", \"vessel\": true,"
        "\"box\": { \"min\": [0, 0], \"max\": [0.4, 0.4] } } ] }";
    tobi_error err = { 0 };
    tobi_world *w;
    (void)state;
    must(start_scene(text, &w, &err), &err);
    assert_int_equal(tobi_world_info(w)->fluid_particles, 200);
    tobi_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_narrow), cmocka_unit_test(test_piston), cmocka_unit_test(test_open_tube),
        cmocka_unit_test(test_full_pipes), cmocka_unit_test(test_pressure),
        cmocka_unit_test(test_level_zero), cmocka_unit_test(test_flat_fall),
        cmocka_unit_test(test_written_zeros), cmocka_unit_test(test_flat_seed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

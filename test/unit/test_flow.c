/* Velocities from place to place at the start: the script, its mistakes, and what a scene makes of it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "rigid/script.h"
#include "scene/scene.h"
#include "tobiuo/tobiuo.h"

static char folder[64], script[96], path[96];

static void write_script(const char *text)
{
    FILE *file = fopen(script, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/tobiuo_flow_XXXXXX");
    if (!mkdtemp(folder)) return 1;
    snprintf(script, sizeof script, "%s/flow.lua", folder);
    snprintf(path, sizeof path, "%s/scene.json", folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    unlink(script);
    return rmdir(folder);
}

static tobi_status ask(const char *text, double velocity[3], tobi_error *err)
{
    const double place[1][3] = { { 1, 2, 3 } };
    tobi_script *s;
    write_script(text);
    TOBI_TRY(tobi_script_load_within(script, "{\"k\": 10}", TOBI_FLOW_SCRIPT, 0.2, &s, err));
    tobi_status status = tobi_script_flow(s, 1, place, (double (*)[3])velocity, err);
    tobi_script_free(s);
    return status;
}

static void a_script_answers_velocities(void **state)
{
    (void)state;
    double v[3];
    tobi_error err;
    tobi_script *none;
    assert_int_equal(tobi_script_load("a.lua", NULL, (tobi_script_role)7, &none, &err), TOBI_INVALID);
    assert_string_equal(err.text, "script a.lua: there is no role 7");
    assert_int_equal(ask("function velocity(x, y, z) return params.k*x, y - z, x*y*z end", v, &err), TOBI_OK);
    assert_true(v[0] == 10 && v[1] == -1 && v[2] == 6);
    static const struct { const char *text, *part; } bad[] = {
        { "function deform(x, y, z, t) return x, y, z end", "define function velocity(x, y, z)" },
        { "function velocity(x) return oops, 0, 0 end", "flow.lua:1: unknown name 'oops' (at 1 2 3 m)" },
        { "function velocity(x, y) return x, y end", "velocity must return three numbers (at 1 2 3 m)" },
        { "function velocity() return 0/0, 0, 0 end", "velocity returned a number that is not finite" },
        { "function velocity(", "flow.lua:1:" },
        { "function velocity() while true do end end", "endless" },
    };
    for (size_t k = 0; k < sizeof bad/sizeof *bad; k++) {
        assert_int_equal(ask(bad[k].text, v, &err), TOBI_SCRIPT);
        if (!strstr(err.text, bad[k].part)) fail_msg("<%s>, expected <%s>", err.text, bad[k].part);
    }
}

static const char scene_text[] =
    "{ \"dimension\": 2, \"domain\": { \"min\": [-1, -1], \"max\": [1, 1] }, \"gravity\": [0, 0],\n"
    "  \"spacing\": 0.1, \"end_time\": 1,\n"
    "  \"fluids\": [ { \"name\": \"water\", \"fill\": [ {\n"
    "      \"box\": { \"min\": [-1, -1], \"max\": [1, 1] },\n"
    "      \"velocity\": [1, 0, 0],\n"
    "      \"flow\": { \"script\": \"flow.lua\", \"params\": { \"k\": 2 } } } ] } ] }";

static tobi_status parse(const char *text, tobi_scene **scene, tobi_error *err)
{
    return tobi_scene_parse(path, text, strlen(text), NULL, scene, NULL, err);
}

/* The flow is added to the velocity of the region, in the scene's coordinates. */
static void a_scene_starts_with_it(void **state)
{
    (void)state;
    tobi_scene *scene, *again;
    tobi_world *world;
    tobi_error err = { 0 };
    write_script("function velocity(x, y, z) return params.k*y, -params.k*x, 5 end");
    if (parse(scene_text, &scene, &err)) fail_msg("%s", err.text);
    char *resolved = tobi_scene_resolved(scene);
    if (parse(resolved, &again, &err)) fail_msg("%s", err.text);
    assert_string_equal(again->fluids[0].fills[0].flow_def.script, script);
    tobi_scene_free(again);
    free(resolved);

    if (tobi_scene_build(scene, &world, &err) || tobi_world_start(world, &err)) fail_msg("%s", err.text);
    static double x[400][3], v[400][3];
    if (tobi_world_read(world, TOBI_FLUID, "position", x[0], 400, &err) ||
        tobi_world_read(world, TOBI_FLUID, "velocity", v[0], 400, &err)) fail_msg("%s", err.text);
    for (int i = 0; i < 400; i++) {
        assert_true(fabs(v[i][0] - 1 - 2*x[i][1]) < 1e-5 && fabs(v[i][1] + 2*x[i][0]) < 1e-5);
        assert_true(v[i][2] == 0);
    }
    tobi_world_destroy(world);
    tobi_scene_free(scene);
}

static void a_failing_flow_stops_the_start(void **state)
{
    (void)state;
    tobi_scene *scene;
    tobi_world *world;
    tobi_error err = { 0 };
    write_script("function velocity(x, y, z) if y > 0 then error('no') end return 0, 0, 0 end");
    if (parse(scene_text, &scene, &err)) fail_msg("%s", err.text);
    if (tobi_scene_build(scene, &world, &err)) fail_msg("%s", err.text);
    assert_int_equal(tobi_world_start(world, &err), TOBI_SCRIPT);
    assert_non_null(strstr(err.text, "flow.lua:1: no (at -0.95 0.05 0 m)"));
    tobi_world_destroy(world);
    tobi_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_script_answers_velocities),
        cmocka_unit_test(a_scene_starts_with_it),
        cmocka_unit_test(a_failing_flow_stops_the_start),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

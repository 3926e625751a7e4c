/* What the world refuses of a scene has file, line and column of the key that is to blame. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "tobiuo/scene.h"

/* A tank of water with a block and a bowl; what is wrong stands from line 4 on. */
static tobi_scene *parse(const char *rest)
{
    char text[2000];
    tobi_error err = { 0 };
    tobi_scene *scene;
    snprintf(text, sizeof text,
             "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": 0.05, \"end_time\": 1,\n"
             "\"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"box\": { \"min\": [0, 0, 0],\n"
             "\"max\": [1, 1, 0.2] } } ] } ],\n%s }", rest);
    if (tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, &err) != TOBI_OK)
        fail_msg("%s", err.text);
    return scene;
}

static void expect_start(const char *text, const char *begin)
{
    if (strncmp(text, begin, strlen(begin)) != 0) fail_msg("%s\ndoes not begin with\n%s", text, begin);
}

static void a_comma_too_many_is_named(void **state)
{
    (void)state;
    static const char *const wrong[] = { "{ \"a\": 1, // b\n}", "{ \"a\": [1, ] }", "{ \"a\": [1 }" };
    for (int k = 0; k < 3; k++) {
        tobi_report *report = NULL;
        tobi_scene *scene;
        tobi_error err = { 0 };
        const char *text = wrong[k];
        assert_int_not_equal(tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, &report, &err), 0);
        assert_int_equal(strstr(tobi_report_line(report, 0), "remove the comma before it") != NULL, k < 2);
        tobi_report_free(report);
    }
}

static void a_column_of_a_probe_is_told_as_keys(void **state)
{
    (void)state;
    static const char text[] =
        "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": 0.1, \"end_time\": 1,\n"
        "\"fluids\": [],"
        "\"probes\": [ { \"name\": \"p\", \"position\": [0, 0, 0] } ],\n"
        "\"references\": [ { \"file\": \"/\", \"column\": \"p_pressure\" } ] }";
    tobi_report *report = NULL;
    tobi_scene *scene;
    tobi_error err = { 0 };
    assert_int_not_equal(tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, &report, &err), 0);
    int told = 0;
    for (int k = 0; k < tobi_report_count(report); k++)
        told |= strstr(tobi_report_line(report, k), "references[0].column: \"p_pressure\" is of a probe: "
                       "write \"probe\": \"p\", \"column\": \"pressure\"") != NULL;
    assert_true(told);
    tobi_report_free(report);
}

#define BOX "\"box\": { \"min\": [0.4, 0.4, 0.4], \"max\": [0.6, 0.6, 0.6] }"

static void keys_are_named(void **state)
{
    (void)state;
    static const struct { const char *rest, *begin; } wrong[] = {
        { "\"bodies\": [ { \"name\": \"b\",\n\"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1.1] } } ]",
          "s.json:5:1: bodies[0].box: body 'b' sticks out of the domain: a vertex is at z = 1.1 m" },
        { "\"bodies\": [ { \"name\": \"b\", " BOX ",\n"
          "\"dynamics\": \"free\", \"absent\": { \"from\": 1 } } ]",
          "s.json:5:21: bodies[0].absent: body 'b': only a prescribed body" },
        { "\"damping_zones\": [ { \"box\": { \"min\": [0, 0, 0],\n\"max\": [1, 1, 0] }, \"rate\": 1 } ]",
          "s.json:5:1: damping_zones[0].box.max: the box of a damping zone" },
        { "\"outlets\": [ { \"name\": \"o\", \"normal\": [1, 0, 0], \"radius\": 0.9,\n"
          "\"centre\": [0.5, 0.5, 0.5] } ]",
          "s.json:5:1: outlets[0].centre: outlet 'o' reaches out of the domain" },
    };
    for (size_t k = 0; k < sizeof wrong/sizeof *wrong; k++) {
        tobi_scene *scene = parse(wrong[k].rest);
        tobi_world *w;
        tobi_error err = { 0 };
        assert_int_not_equal(tobi_scene_build(scene, &w, &err), TOBI_OK);
        expect_start(err.text, wrong[k].begin);
        assert_string_equal(err.key, "");
        tobi_scene_free(scene);
    }
}

/* Known only when the world starts: a level that no vessel holds. */
static void the_start_names_keys(void **state)
{
    (void)state;
    char text[2000];
    tobi_error err = { 0 };
    tobi_scene *scene;
    tobi_world *w;
    snprintf(text, sizeof text,
             "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": 0.05, \"end_time\": 1,\n"
             "\"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"vessel\": \"tub\",\n"
             "\"level\": 0.1 } ] } ],\n"
             "\"bodies\": [ { \"name\": \"tub\", \"vessel\": true, " BOX " } ] }");
    if (tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, &err) != TOBI_OK)
        fail_msg("%s", err.text);
    assert_int_equal(tobi_scene_build(scene, &w, &err), TOBI_OK);
    assert_int_not_equal(tobi_world_start(w, &err), TOBI_OK);
    assert_string_equal(err.key, "fluids[0].fill[0].level");
    tobi_scene_place_error(scene, &err);
    expect_start(err.text, "s.json:3:1: fluids[0].fill[0].level: fluid 'water': fill[0] finds nothing");
    tobi_scene_place_error(scene, &err);                 /* once is enough */
    expect_start(err.text, "s.json:3:1: fluids[0]");
    assert_null(strstr(err.text + 10, "s.json"));
    tobi_scene_place_error(NULL, &err);
    tobi_world_destroy(w);
    tobi_scene_free(scene);
}

/* And a motion that leaves the plane, which only its steps show. */
static void the_start_names_motions(void **state)
{
    (void)state;
    static const char text[] =
        "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [1, 1] }, \"spacing\": 0.05,\n"
        "\"end_time\": 1, \"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"box\": { \"min\": [0.2, 0],\n"
        "\"max\": [1, 0.5] } } ] } ], \"bodies\": [ { \"name\": \"b\", \"box\": { \"min\": [0, 0],\n"
        "\"max\": [0.2, 1] }, \"motion\": { \"translation\": { \"velocity\": [0, 0, 1] } } } ] }";
    tobi_error err = { 0 };
    tobi_scene *scene;
    tobi_world *w;
    assert_int_equal(tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, &err), TOBI_OK);
    assert_int_equal(tobi_scene_build(scene, &w, &err), TOBI_OK);
    assert_int_equal(tobi_world_start(w, &err), TOBI_INVALID);
    tobi_scene_place_error(scene, &err);
    expect_start(err.text, "s.json:4:20: bodies[0].motion: body 'b': its motion shifts a point by");
    tobi_world_destroy(w);
    tobi_scene_free(scene);
}

static void rounding_is_no_breach(void **state)
{
    (void)state;
    tobi_scene *scene = parse("\"bodies\": [ { \"name\": \"b\", \"box\": { \"min\": [0, 0, -1e-13], "
                              "\"max\": [0.1, 1, 1] } } ]");
    tobi_world *w;
    tobi_error err = { 0 };
    assert_int_equal(tobi_scene_build(scene, &w, &err), TOBI_OK);
    assert_int_equal(tobi_world_advance(w, 0.01, NULL, &err), TOBI_OK);
    tobi_world_destroy(w);
    tobi_scene_free(scene);
}

/* The first key stays: that of the call that knows most. */
static void keys_of_errors(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    assert_int_equal(tobi_at_key(&err, tobi_fail(&err, TOBI_IO, "x"), "fill[%d]", 3), TOBI_IO);
    assert_string_equal(err.key, "fill[3]");
    tobi_at_key(&err, TOBI_IO, "other");
    assert_string_equal(err.key, "fill[3]");
    tobi_fail(&err, TOBI_IO, "y");
    assert_string_equal(err.key, "");
    assert_int_equal(tobi_at_key(&err, TOBI_OK, "none"), TOBI_OK);
    assert_string_equal(err.key, "");
    assert_int_equal(tobi_at_key(NULL, TOBI_IO, "none"), TOBI_IO);
}

/* What a world keeps of a name is the whole of it: lines find the body. */
static void names_have_room(void **state)
{
    (void)state;
    static const char rest[] =
        "\"bodies\": [ { \"name\": \"%1$.*2$s\", \"sphere\": { \"centre\": [0.5, 0.5, 0.5],\n"
        "\"radius\": 0.2 }, \"density\": 500, \"dynamics\": \"free\" } ],\n"
        "\"lines\": [ { \"name\": \"rope\", \"body\": \"%1$.*2$s\", \"point\": [0.5, 0.5, 0.7],\n"
        "\"to\": [0.5, 0.5, 0.9], \"stiffness\": 10 } ]";
    char name[65], text[1000];
    memset(name, 'n', 64);
    tobi_world *w;
    tobi_scene *scene;
    tobi_error err = { 0 };
    snprintf(text, sizeof text, rest, name, 63);
    scene = parse(text);
    if (tobi_scene_build(scene, &w, &err) != TOBI_OK) fail_msg("%s", err.text);
    tobi_world_destroy(w);
    tobi_scene_free(scene);
    static const char fluid[] =
        "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": 0.1, \"end_time\": 1,\n"
        "\"fluids\": [ { \"name\": \"%.64s\", \"fill\": [] } ] }";
    snprintf(text, sizeof text, fluid, name);
    assert_int_not_equal(tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, &err), TOBI_OK);
    if (!strstr(err.text, "fluids[0].name: is not usable as a name: 1 to 63 letters"))
        fail_msg("%s", err.text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_comma_too_many_is_named),
        cmocka_unit_test(a_column_of_a_probe_is_told_as_keys),
        cmocka_unit_test(keys_are_named),
        cmocka_unit_test(the_start_names_keys), cmocka_unit_test(the_start_names_motions),
        cmocka_unit_test(rounding_is_no_breach),
        cmocka_unit_test(keys_of_errors),
        cmocka_unit_test(names_have_room),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Parameter files of Python programs: what is read, what parameters.py of the program that cuts an
   apple becomes, what is refused and where. */
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
#include "scene/python.h"
#include "scene/scene.h"

#define SEED TOBI_SOURCE_DIR "/test/scenes/taichi/parameters.py"

static char *convert(const char *text)
{
    tobi_report *report = tobi_report_create();
    tobi_error err = { 0 };
    char *json = NULL;
    tobi_status status = tobi_python_to_json("p.py", text, strlen(text), &json, report, &err);
    if (status != TOBI_OK) print_error("%s\n", tobi_report_line(report, 0));
    assert_int_equal(status, TOBI_OK);
    tobi_report_free(report);
    return json;
}

/* The text must become this JSON, blanks aside. */
static void becomes(const char *text, const char *expected)
{
    char *json = convert(text);
    size_t n = 0;
    for (size_t i = 0; json[i]; i++)
        if (json[i] != ' ' && json[i] != '\n') json[n++] = json[i];
    json[n] = '\0';
    assert_string_equal(json, expected);
    free(json);
}

static void values(void **state)
{
    (void)state;
    becomes("", "{}");
    becomes("import a\nfrom b import c # d\na = 1", "{\"a\":1}");
    becomes("a=1;b=2.5", "{\"a\":1,\"b\":2.5}");
    becomes("a = 3 - 1 - 1\nb = 2*3 + 4*-a\nc = 1/4\nd = -2**2\ne = 2**3**2\nf = (1 + 2)*3",
            "{\"a\":1,\"b\":2,\"c\":0.25,\"d\":-4,\"e\":512,\"f\":9}");
    becomes("a = (1, 2,)\nb = (1,)\nc = ()\nd = [1, [2]]\ne = 1, 2\nf = +.5e1",
            "{\"a\":[1,2],\"b\":[1],\"c\":[],\"d\":[1,[2]],\"e\":[1,2],\"f\":5}");
    becomes("a = {'x': 1, \"y\": {}, 'z': True}\nb = None\nc = False",
            "{\"a\":{\"x\":1,\"y\":{},\"z\":true},\"b\":null,\"c\":false}");
    becomes("a = 'it\\'s # no comment' # one\nb = \"\\\\\"", "{\"a\":\"it's#nocomment\",\"b\":\"\\\\\"}");
    becomes("a = 'x'\nb = a\na_1 = 2", "{\"a\":\"x\",\"b\":\"x\",\"a_1\":2}");
    becomes("\xEF\xBB\xBF" "a = [1, # one\n  2]   # two\n", "{\"a\":[1,2]}");
    /* Tails of comments that wrapped. */
    becomes("a = 1 # 座\n  標系\nb = 2 # c\n  CAD 系\n系\nc = 3", "{\"a\":1,\"b\":2,\"c\":3}");
}

/* Lines stay lines, and columns columns where there is room. */
static void places(void **state)
{
    (void)state;
    char *json = convert("# one\na   = 1\n\nb = { 'x':   1,\n      'y': 2 }\n");
    assert_string_equal(json, "{\n\"a\":  1,\n\n\"b\":{ \"x\":   1,\n      \"y\": 2}}");
    free(json);
}

static void mistakes(void **state)
{
    (void)state;
    static const struct { const char *text, *told; } cases[] = {
        { "a = ", "p.py:1:5: expected a value: a number, a text, ( ), [ ], { } or a name given above" },
        { "a = 1\nb = c", "p.py:2:5: the name \"c\" is given nowhere above" },
        { "a = [1]\nb = a", "p.py:2:5: a is a list or dict; values refer to numbers and texts only" },
        { "a = np.pi", "p.py:1:5: np...: calls, members and entries are not read; write the number" },
        { "a = max(1)", "p.py:1:5: max(..: calls" },
        { "a = 1\nb = a[0]", "p.py:2:5: a[..: calls" },
        { "a = 1 2", "p.py:1:7: expected the end of the line" },
        { "a = [1 2]", "p.py:1:8: expected , or ]" },
        { "a = (1", "p.py:1:7: expected , or )" },
        { "a = {'x' 1}", "p.py:1:10: expected : behind the key \"x\"" },
        { "a = {x: 1}", "p.py:1:6: expected a key, a text in quotes, or }" },
        { "a = {'x': 1 'y': 2}", "p.py:1:13: expected , or } in the dict" },
        { "a = 'x", "p.py:1:5: a text does not end in its line" },
        { "a = 'x\\n'", "p.py:1:7: a \\ in a text is not read, but for \\\\, \\' and \\\"" },
        { "a = '\xFF'", "p.py:1:5: a text is not UTF-8" },
        { "a = 0x10", "p.py:1:5: numbers are decimal here" },
        { "a = 1_000", "\"1_000\" is no number" },
        { "a = 1e999", "p.py:1:5: the number is too large" },
        { "a = 1/0", "p.py:1:6: the result is no finite number" },
        { "a = 'x' + 1", "p.py:1:9: + is read between numbers only" },
        { "a = 7 // 2", "p.py:1:8: the operators are + - * / **" },
        { "if a:\n  b = 1", "p.py:1:1: is not read; a parameter file has lines NAME = VALUE, and" },
        { "a == 1", "p.py:1:1: is not read" },
        { "a = 1\n  b = 1", "p.py:2:3: is indented; a parameter file has no blocks" },
        { "a = [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[", "more than 30 values within each other" },
    };
    for (size_t k = 0; k < sizeof cases/sizeof *cases; k++) {
        tobi_report *report = tobi_report_create();
        tobi_error err = { 0 };
        char *json = NULL;
        size_t size = strlen(cases[k].text);
        assert_int_equal(tobi_python_to_json("p.py", cases[k].text, size, &json, report, &err), TOBI_INVALID);
        assert_null(json);
        if (!strstr(tobi_report_line(report, 0), cases[k].told))
            fail_msg("\"%s\": %s", cases[k].text, tobi_report_line(report, 0));
        tobi_report_free(report);
    }
}

/* All are told at once. */
static void several_mistakes(void **state)
{
    (void)state;
    const char text[] = "a = [1, 2\nb = 1\nc = 1 1\nd = 3\ne = x\n";
    tobi_report *report = tobi_report_create();
    char *json;
    assert_int_equal(tobi_python_to_json("p.py", text, strlen(text), &json, report, NULL), TOBI_INVALID);
    assert_int_equal(tobi_report_total(report), 3);
    tobi_report_free(report);
}

static void near(const double v[3], double x, double y, double z)
{
    assert_true(fabs(v[0] - x) < 1e-12 && fabs(v[1] - y) < 1e-12 && fabs(v[2] - z) < 1e-12);
}

static void the_apple_of_the_users(void **state)
{
    (void)state;
    tobi_scene *scene;
    tobi_error err = { 0 };
    if (tobi_scene_load(SEED, NULL, &scene, NULL, &err) != TOBI_OK) fail_msg("%s", err.text);
    const tobi_world_def *w = tobi_scene_world_def(scene);
    assert_string_equal(w->method, "mlsmpm");
    near(w->domain_min, 0, 0, 0);
    near(w->domain_max, 0.6, 0.6, 0.6);
    near(w->gravity, 0, 0, -9.81);
    assert_true(w->spacing == 0.6/256 && w->end_time == 2 && w->time_step == 0);
    assert_int_equal(w->wall_min[2], TOBI_WALL_SEPARATE);
    assert_true(fabs(tobi_scene_output_def(scene)->interval - 0.002) < 1e-15);
    assert_int_equal(scene->solid_count, 1);
    const tobi_solid_def *apple = &scene->solids[0].def;
    assert_true(apple->mass == 0.2 && apple->youngs_modulus == 1e6 && apple->poissons_ratio == 0.3);
    near(scene->solids[0].fills[0].def.translation, 0.3, 0.3, 0.075);
    assert_int_equal(scene->body_count, 1);
    const tobi_body_def *knife = &scene->bodies[0].def;
    assert_int_equal(knife->dynamics, TOBI_CONTROLLED);
    near(knife->translation, 0.4, 0.3, 0.24);
    assert_true(knife->mass == 0.2 && knife->restitution == 0.1 && knife->friction_coefficient == 0.3);
    assert_true(knife->air_resistance == 1 && knife->blade && knife->edge_resistance == 250);
    assert_string_equal(knife->locked, "turn");
    const char *table = tobi_scene_import_table(scene);
    assert_non_null(strstr(table, "-> output.interval = 0.002 s"));
    assert_non_null(strstr(table, "-> solids[0].mass = 0.2 kg"));
    assert_non_null(strstr(table, "8 times too much"));
    assert_null(strstr(table, "The water"));

    /* The knife: 600 N/s times t down, then a tenth of it along -y up to 1 m/s, at its height. */
    tobi_control_input in = { .time = 0.5, .phase = 1, .position = { 0.4, 0.3, 0.15 } };
    tobi_control_output out = { .phase = 1 };
    assert_int_equal(knife->control(knife->control_user, &in, &out, &err), TOBI_OK);
    near(out.force, 0, 0, -300);
    in.position[2] = 0.1 - 0.0480277;                      /* the origin at 0.1 m */
    assert_int_equal(knife->control(knife->control_user, &in, &out, &err), TOBI_OK);
    near(out.force, 0, -30, 0);
    assert_int_equal(out.phase, 2);
    assert_string_equal(out.hold, "z");
    in.velocity[1] = -1;
    in.phase = 2;
    assert_int_equal(knife->control(knife->control_user, &in, &out, &err), TOBI_OK);
    near(out.force, 0, 0, 0);
    tobi_scene_free(scene);
}

/* Replaces a part of the seed's file and must hear of it. */
static void refuse(const char *old, const char *new, const char *told)
{
    static const char path[] = TOBI_SOURCE_DIR "/test/scenes/taichi/parameters.py";
    char text[8000];
    FILE *file = fopen(path, "rb");
    size_t size = fread(text, 1, sizeof text - 500, file);
    fclose(file);
    text[size] = '\0';
    char *at = strstr(text, old);
    assert_non_null(at);
    memmove(at + strlen(new), at + strlen(old), strlen(at + strlen(old)) + 1);
    memcpy(at, new, strlen(new));
    tobi_scene *scene;
    tobi_error err = { 0 };
    assert_int_equal(tobi_scene_parse(path, text, strlen(text), NULL, &scene, NULL, &err), TOBI_INVALID);
    if (!strstr(err.text, told)) fail_msg("%s without %s", err.text, told);
}

static void bad_files(void **state)
{
    (void)state;
    refuse("Resolution = 128", "Resolution = 2",
           "parameters.py:5:14: Resolution: is 2, allowed is 8 to 4096");
    refuse("myu = 0.3", "muy = 0.3", "muy: unknown key");
    refuse("knife = {", "knive = {", "knife: is missing: a dict with fileName, translation and mass");
    refuse("\"mass\": 0.2,", "\"mass\": 0,", "apple.mass: is 0, allowed is greater than 0 kg");
    refuse("knife2.obj", "knife3.obj",
           "knife.fileName: cannot find the mesh \"scenes/apple_cut_seed/knife3.obj\"");
    refuse("scenes/apple_cut_seed/knife2.obj", "README.md", "knife.fileName: ");
    refuse("\"COGx\": [0, 0, 0]", "\"COGx\": [0, 0, 0.1]",
           "knife.COGx: is [0, 0, 0.1]; only [0, 0, 0] is known, translation places the knife");
    /* What only the native scene finds out is told at the old key. */
    refuse("SimulationTime = 2.0", "SimulationTime = 1e9",
           "parameters.py:10:15: VTUinterval (here output.interval): is 0.002 s and makes more than");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values), cmocka_unit_test(places), cmocka_unit_test(mistakes),
        cmocka_unit_test(several_mistakes), cmocka_unit_test(the_apple_of_the_users),
        cmocka_unit_test(bad_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Motions in scenes: by words, in lists, and what is wrong with them. */
#include "tobiuo/motion.h"
#include "tobiuo/scene.h"
#include "scene/scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A tank with a block that moves by the text. */
static char *make(int dimension, const char *motion)
{
    static const char *const frames[] = {
        "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [1, 1] }, \"spacing\": 0.1,\n"
        "\"end_time\": 1, \"gravity\": [0, -9.81],\n"
        "\"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"box\": { \"min\": [0, 0],"
        "\"max\": [1, 1] } } ] } ],\n"
        "\"bodies\": [ { \"name\": \"b\", \"box\": { \"min\": [0, 0], \"max\": [0.5, 0.5] },\n"
        "\"motion\": %s } ] }",
        "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": 0.1,\n\"end_time\": 1,\n"
        "\"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"box\": { \"min\": [0, 0, 0],\n"
        "\"max\": [1, 1, 1] } } ] } ], \"bodies\": [ { \"name\": \"b\", \"box\": { \"min\": [0, 0, 0],\n"
        "\"max\": [0.5, 0.5, 0.5] }, \"motion\": %s } ] }" };
    char *text = malloc(4000);
    snprintf(text, 4000, frames[dimension - 2], motion);
    return text;
}

static tobi_scene *load(const char *text)
{
    tobi_scene *scene;
    tobi_error err = { 0 };
    if (tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, &err) != TOBI_OK)
        fail_msg("%s", err.text);
    return scene;
}

static const double *place_at(tobi_scene *scene, double t, const double rest[3])
{
    static double p[1][3];
    assert_int_equal(tobi_motion_positions(scene->bodies[0].motion, t, 1,
                                           (const double (*)[3])(const void *)rest, p, NULL), TOBI_OK);
    return p[0];
}

static void words_are_degrees_of_freedom(void **state)
{
    (void)state;
    static const char *const words[] = { "surge", "sway", "heave", "roll", "pitch", "yaw" };
    const double rest[3] = { 0.3, 0.4, 0.5 };
    for (int k = 0; k < 6; k++) {
        char text[200];
        snprintf(text, sizeof text, "{ \"%s\": { \"amplitude\": 0.2, \"period\": 1.6, \"phase\": 30%s } }",
                 words[k], k < 3 ? "" : ", \"center\": [0.1, 0.1, 0.1]");
        char *scene_text = make(3, text);
        tobi_scene *scene = load(scene_text);
        for (double t = 0; t < 4; t += 0.3) {
            const double s = 0.2*sin(2*M_PI*t/1.6 + M_PI/6), angle = s*M_PI/180;
            const int a = k%3, b = (a + 1)%3, c = (a + 2)%3;
            const double *p = place_at(scene, t, rest);
            assert_true(fabs(p[a] - rest[a] - (k < 3 ? s : 0)) < 1e-14);
            const double y = rest[b] - 0.1, z = rest[c] - 0.1;
            assert_true(fabs(p[b] - (k < 3 ? rest[b] : 0.1 + y*cos(angle) - z*sin(angle))) < 1e-14);
            assert_true(fabs(p[c] - (k < 3 ? rest[c] : 0.1 + y*sin(angle) + z*cos(angle))) < 1e-14);
        }
        tobi_scene_free(scene);
        free(scene_text);
    }
}

/* A list: the roll about its centre, then the rest; the resolved scene has the same motion. */
static void lists_are_sums(void **state)
{
    (void)state;
    const double rest[3] = { 1, 2, 3 };
    char *text = make(3, "[ { \"sway\": { \"amplitude\": 0.5, \"period\": 2, \"ramp\": 1 } },\n"
                         "{ \"roll\": { \"center\": [0, 0, 1], \"amplitude\": 90, \"period\": 4,\n"
                         "\"phase\": 90 } },\n"
                         "{ \"translation\": { \"velocity\": [1, 0, 0], \"start\": 2, \"stop\": 3 } } ]");
    tobi_scene *scene = load(text);
    const double *p = place_at(scene, 0, rest);
    assert_true(fabs(p[0] - 1) < 1e-14 && fabs(p[1] + 2) < 1e-14 && fabs(p[2] - 3) < 1e-14);
    assert_true(fabs(place_at(scene, 2.5, rest)[0] - 1.5) < 1e-14);
    assert_true(fabs(place_at(scene, 9.0, rest)[0] - 2) < 1e-14);
    char *resolved = tobi_scene_resolved(scene);
    tobi_scene *second = load(resolved);
    for (double t = 0; t < 5; t += 0.3) {
        double kept[3];
        memcpy(kept, place_at(scene, t, rest), sizeof kept);
        assert_memory_equal(kept, place_at(second, t, rest), sizeof kept);
    }
    free(resolved);
    tobi_scene_free(second);
    tobi_scene_free(scene);
    free(text);
}

static void expect(int dimension, const char *motion, const char *line)
{
    char *text = make(dimension, motion);
    tobi_scene *scene = NULL;
    tobi_report *report = NULL;
    tobi_error err = { 0 };
    const tobi_status status = tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, &report, &err);
    assert_int_equal(status, TOBI_INVALID);
    assert_int_equal(tobi_report_count(report), 1);
    if (!strstr(tobi_report_line(report, 0), line))
        fail_msg("<%s>, expected <%s>", tobi_report_line(report, 0), line);
    tobi_report_free(report);
    free(text);
}

static void mistakes_are_told(void **state)
{
    (void)state;
    expect(2, "[]", "s.json:5:11: bodies[0].motion: has 0 motions, allowed are 1 to 16");
    expect(2, "[ { \"heave\": { \"amplitude\": 1, \"period\": 1 } } ]",
           "s.json:5:15: bodies[0].motion[0].heave: leaves the plane of a 2-D scene, which has surge, sway");
    expect(2, "{ \"rate\": 3 }", "motion.rate: unknown key; it belongs into the object of rotation");
    expect(2, "{ \"roll\": { \"amplitude\": 1, \"period\": 1 } }", "leaves the plane");
    expect(2, "{ \"pitch\": { \"amplitude\": 1, \"period\": 1 } }", "leaves the plane");
    expect(2, "{ \"sway\": { \"amplitude\": 1 } }", "bodies[0].motion.sway.period: is missing");
    expect(3, "[ { \"translation\": { \"velocity\": [1, 0, 0],\n"
              "\"start\": 3, \"stop\": 4, \"ramp\": 0.6 } } ]",
           "bodies[0].motion[0].translation: motion: from start 3 s to stop 4 s there is no time for two");
    expect(3, "[ { \"yaw\": { \"amplitude\": 1, \"period\": 0 } } ]", "bodies[0].motion[0].yaw.period: is 0");
    expect(3, "[ 3 ]", "bodies[0].motion[0]: is a number, must be an object");
    expect(3, "{ \"heave\": { \"amplitude\": 1, \"period\": 1 },\n"
              "\"sway\": { \"amplitude\": 1, \"period\": 1 } }",
           "must have exactly one of");
}

/* m: of a piston in a scene with that gravity. */
static double stroke(const char *gravity, const char *own)
{
    const double rest[3] = { 0.3, 0.4, 0 };
    char text[1000];
    snprintf(text, sizeof text,
             "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [1, 1] }, \"spacing\": 0.1,"
             "\"end_time\": 1, %s \"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"box\": "
             "{ \"min\": [0.5, 0], \"max\": [1, 0.5] } } ] } ], \"bodies\": [ { \"name\": \"b\", \"box\": "
             "{ \"min\": [0.3, 0], \"max\": [0.5, 1] }, \"motion\": { \"piston\": { \"depth\": 0.5, %s"
             "\"regular\": { \"height\": 0.01, \"period\": 1.5 } } } } ] }", gravity, own);
    tobi_scene *scene = load(text);
    const double way = place_at(scene, 0.3, rest)[0] - rest[0];
    tobi_scene_free(scene);
    return way;
}

/* The theory of a wave maker has the gravity of its scene. */
static void wave_makers_know_gravity(void **state)
{
    (void)state;
    const double earth = stroke("", "\"gravity\": 9.81,"), moon = stroke("", "\"gravity\": 1.62,");
    assert_true(fabs(earth - moon) > 0.2*fabs(earth));
    assert_true(stroke("", "") == earth);
    assert_true(stroke("\"gravity\": [0, -9.81],", "") == earth);
    assert_true(stroke("\"gravity\": [0, -1.62],", "") == moon);
    assert_true(stroke("\"gravity\": [0, -1.62],", "\"gravity\": 9.81,") == earth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_are_degrees_of_freedom),
        cmocka_unit_test(lists_are_sums),
        cmocka_unit_test(mistakes_are_told),
        cmocka_unit_test(wave_makers_know_gravity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

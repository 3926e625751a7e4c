/* Regions that share a place are refused where one is an outline or a mesh; regions that touch are not. */
#include "tobiuo/scene.h"
#include "tobiuo/tobiuo.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <string.h>

#define TRIANGLE "{ \"outline\": { \"points\": [[0.5, 0], [1.5, 0], [1.5, 0.5]], \"to\": 0.4 } }"
/* above the triangle */
#define ABOVE "{ \"outline\": { \"points\": [[0.5, 0], [1.5, 0.5], [0.5, 0.5]], \"to\": 0.4 } }"
/* over its slope by a third of a spacing */
#define NEARLY "{ \"outline\": { \"points\": [[0.5, -0.015], [1.5, 0.485], [0.5, 0.5]], \"to\": 0.4 } }"
#define MESH                                                                                             \
    "{ \"mesh\": \"" TOBI_SOURCE_DIR "/test/meshes/sphere.obj\", \"scale\": 0.2,"                     \
    " \"translation\": [1.3, 0.2, %s] }"

/* In both dimensions, a box 2 m wide and long: 3-D 0.4 m deep in y. */
static tobi_status start(int dimension, const char *matter, tobi_error *err)
{
    char text[2000];
    snprintf(text, sizeof text, "{ \"dimension\": %d, \"method\": \"%s\", \"domain\": { \"min\": [0, 0, 0],"
             " \"max\": [2, %s] }, \"spacing\": 0.05, \"end_time\": 1, %s }", dimension,
             strstr(matter, "solids") ? "mlsmpm" : "dfsph", dimension == 2 ? "1, 1" : "0.4, 1", matter);
    tobi_scene *scene = NULL;
    tobi_world *world = NULL;
    tobi_status status = tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, err);
    if (status == TOBI_OK) status = tobi_scene_build(scene, &world, err);
    if (status == TOBI_OK) status = tobi_world_start(world, err);
    tobi_world_destroy(world);
    tobi_scene_free(scene);
    return status;
}

#define FLUID(fills) "\"fluids\": [ { \"name\": \"w\", \"fill\": [ " fills " ] } ]"
#define FLUIDS(one, other)                                                                               \
    "\"fluids\": [ { \"name\": \"w\", \"fill\": [ " one " ] },"                                        \
    " { \"name\": \"oil\", \"density\": 900, \"fill\": [ " other " ] } ]"
#define SOLIDS(one, other)                                                                               \
    "\"solids\": [ { \"name\": \"a\", \"youngs_modulus\": 1e5, \"fill\": [ " one " ] },"               \
    " { \"name\": \"b\", \"youngs_modulus\": 1e5, \"fill\": [ " other " ] } ]"
#define BOX(low, high) "{ \"box\": { \"min\": [1.2, " low ", 0], \"max\": [1.4, " high ", 0.2] } }"

static void refused(int dimension, const char *matter, const char *why)
{
    tobi_error err = { 0 };
    assert_int_equal(start(dimension, matter, &err), TOBI_INVALID);
    if (!strstr(err.text, why)) fail_msg("\"%s\" lacks \"%s\"", err.text, why);
}

static void taken(int dimension, const char *matter)
{
    tobi_error err = { 0 };
    if (start(dimension, matter, &err) != TOBI_OK) fail_msg("%s", err.text);
}

static void regions_do_not_overlap(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        refused(dimension, FLUID(TRIANGLE ", " TRIANGLE),
                "fluid 'w': fill[1] overlaps fill[0] of 'w': both have");
        refused(dimension, FLUID(TRIANGLE ", " BOX("0", "0.2")), "fill[1] overlaps fill[0]");
        refused(dimension, FLUID(BOX("0", "0.2") ", " TRIANGLE), "fill[1] overlaps fill[0]");
        refused(dimension, SOLIDS(TRIANGLE, BOX("0", "0.2")), "solid 'b': fill[0] overlaps fill[0] of 'a'");
        taken(dimension, FLUID(TRIANGLE ", " ABOVE));
        taken(dimension, FLUID(TRIANGLE ", " NEARLY));
        taken(dimension, SOLIDS(ABOVE, TRIANGLE));
        taken(dimension, FLUIDS(TRIANGLE, BOX("0", "0.2")));
    }
    char text[1000];
    snprintf(text, sizeof text, FLUID(TRIANGLE ", " MESH), "0.2");
    refused(3, text, "fill[1] overlaps fill[0]");
    snprintf(text, sizeof text, FLUID(TRIANGLE ", " MESH), "0.8");
    taken(3, text);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(regions_do_not_overlap) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

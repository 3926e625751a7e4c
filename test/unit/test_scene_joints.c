/* Mistakes in hinges and guides of a scene, each with its place; what a scene with both resolves to. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scene/report.h"
#include "scene/scene.h"

#define SCENE_3D(bodies) \
    "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": 0.1, \"end_time\": 1," \
    "  \"fluids\": [ { \"name\": \"w\"," \
    "    \"fill\": [ { \"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 0.3] } } ] } ]," \
    "  \"bodies\": [ " bodies " ] }"
#define SCENE_2D(bodies) \
    "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [1, 1] }, \"spacing\": 0.1," \
    "  \"end_time\": 1, \"fluids\": [ { \"name\": \"w\"," \
    "    \"fill\": [ { \"box\": { \"min\": [0, 0], \"max\": [1, 0.3] } } ] } ]," \
    "  \"bodies\": [ " bodies " ] }"
#define BODY_3D(more) \
    "{ \"name\": \"b\", \"box\": { \"min\": [0.4, 0.4, 0.5], \"max\": [0.6, 0.6, 0.9] }, " more " }"
#define BODY_2D(more) "{ \"name\": \"b\", \"box\": { \"min\": [0.4, 0.5], \"max\": [0.6, 0.9] }, " more " }"
#define FREE "\"dynamics\": \"free\", "

static const struct { const char *scene, *mistake; } wrong[] = {
    { SCENE_3D(BODY_3D("\"hinge\": { \"point\": [0, 0, 1], \"axis\": [0, 1, 0] }")),
      "bodies[0].hinge.point: is for free and controlled bodies" },
    { SCENE_3D(BODY_3D(FREE "\"hinge\": { \"point\": [0, 0, 1] }")), "bodies[0].hinge: must have an axis" },
    { SCENE_3D(BODY_3D(FREE "\"hinge\": { \"axis\": [0, 1, 0] }")),
      "bodies[0].hinge: must have a point on its axis" },
    { SCENE_3D(BODY_3D(FREE "\"hinge\": { \"point\": [0, 0, 1], \"axis\": [0, 0, 0] }")),
      "bodies[0].hinge.axis: is zero, must have a direction" },
    { SCENE_3D(BODY_3D(FREE "\"hinge\": { \"point\": [0, 0, 1], \"axis\": [0, 1, 0], \"lower\": 5 }")),
      "bodies[0].hinge.lower: is 5, must be 0 or below: the body starts at 0" },
    { SCENE_3D(BODY_3D(FREE "\"guide\": { \"axis\": [0, 0, 1], \"upper\": -0.1 }")),
      "bodies[0].guide.upper: is -0.1, must be 0 or above: the body starts at 0" },
    { SCENE_3D(BODY_3D(FREE "\"guide\": { \"axis\": [0, 0, 1] }, \"locked\": \"turn\"")),
      "bodies[0].locked: is for bodies without a hinge or guide" },
    { SCENE_3D(BODY_3D(FREE "\"guide\": { \"axis\": [0, 0, 1] }, "
                            "\"hinge\": { \"point\": [0, 0, 1], \"axis\": [0, 1, 0] }")),
      "bodies[0].guide: and hinge exclude each other" },
    { SCENE_2D(BODY_2D(FREE "\"hinge\": { \"point\": [0, 1], \"axis\": [1, 0] }")),
      "bodies[0].hinge.axis: must be along z in a 2-D scene" },
    { SCENE_2D(BODY_2D(FREE "\"guide\": { \"axis\": [0, 0, 1] }")),
      "bodies[0].guide.axis: is 1 in z, must be 0 in a 2-D scene" },
};

static void every_mistake_is_told(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof wrong/sizeof *wrong; k++) {
        tobi_scene *scene;
        tobi_report *report;
        tobi_error err = { 0 };
        const char *text = wrong[k].scene;
        int found = 0;
        assert_int_equal(tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, &report, &err),
                         TOBI_INVALID);
        for (int i = 0; i < tobi_report_count(report); i++)
            found += strstr(tobi_report_line(report, i), wrong[k].mistake) != NULL;
        if (found != 1)
            fail_msg("%d times: %s; first is %s", found, wrong[k].mistake, tobi_report_line(report, 0));
        tobi_report_free(report);
    }
}

static void a_resolved_scene_is_the_same(void **state)
{
    (void)state;
    const char *texts[] = { SCENE_2D(BODY_2D(FREE "\"hinge\": { \"point\": [0.5, 0.9], \"damping\": 3 }")),
                            SCENE_3D(BODY_3D(FREE "\"guide\": { \"axis\": [0, 0, 2], \"lower\": -0.1 }")) };
    for (int k = 0; k < 2; k++) {
        tobi_scene *scene, *again;
        tobi_report *report;
        tobi_error err = { 0 };
        if (tobi_scene_parse("s.json", texts[k], strlen(texts[k]), NULL, &scene, &report, &err) != TOBI_OK)
            fail_msg("%s", tobi_report_line(report, 0));
        tobi_report_free(report);
        assert_true(k ? scene->bodies[0].def.guide_axis[2] == 2 : scene->bodies[0].def.hinge_axis[2] == 1);
        char *resolved = tobi_scene_resolved(scene);
        assert_true((strstr(resolved, "\"hinge\"") != NULL) == !k);
        assert_true((strstr(resolved, "\"guide\"") != NULL) == k);
        if (tobi_scene_parse("r.json", resolved, strlen(resolved), NULL, &again, &report, &err) != TOBI_OK)
            fail_msg("%s", tobi_report_line(report, 0));
        tobi_report_free(report);
        char *twice = tobi_scene_resolved(again);
        assert_string_equal(resolved, twice);
        free(resolved);
        free(twice);
        tobi_scene_free(scene);
        tobi_scene_free(again);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_mistake_is_told),
        cmocka_unit_test(a_resolved_scene_is_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

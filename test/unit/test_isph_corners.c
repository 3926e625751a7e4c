/* Water of isph in a tank that is one body: its corners are closed, as those between sides of the domain. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "scene/scene.h"
#include "world/world.h"

#define VESSEL "\"bodies\": [ { \"name\": \"tank\", \"vessel\": true, \"box\": { \"min\": [0, 0],"  \
               "\"max\": [0.5, 0.4] } } ],"

static void must(tobi_status status, const tobi_error *err)
{
    if (status != TOBI_OK) fail_msg("%s", err->text);
}

/* The largest |div v|, 1/s, of water that sways for a while with the longest steps. */
static double sway(double low, double high, double top, const char *bodies)
{
    char text[2000];
    double most = 0;
    tobi_error err = { 0 };
    tobi_scene *scene;
    tobi_step_info info;
    tobi_world *w;
    snprintf(text, sizeof text, "{ \"method\": \"isph\", \"dimension\": 2, \"spacing\": 0.005,"
             "\"end_time\": 1, \"time_step\": 0.0055, \"domain\": { \"min\": [%g, %g], \"max\": [%g, %g] },"
             "%s \"fluids\": [ { \"name\": \"water\", \"viscosity\": 0, \"fill\": [ { \"box\": { \"min\":"
             "[0, 0], \"max\": [0.5, 0.2] } } ] } ], \"frame\": { \"surge\": { \"amplitude\": 0.005, "
             "\"period\": 1, \"ramp\": 1 } } }", low, low, high, top, bodies);
    must(tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, &err), &err);
    must(tobi_scene_build(scene, &w, &err), &err);
    must(tobi_world_start(w, &err), &err);
    for (int k = 0; k < 40; k++) {
        must(tobi_world_step(w, 0, &info, &err), &err);
        most = fmax(most, info.divergence_max);
    }
    tobi_world_destroy(w);
    tobi_scene_free(scene);
    return most;
}

/* 17 1/s with one plane per particle and body, and a tank that boils later on. */
static void corners_of_a_vessel(void **state)
{
    (void)state;
    const double sides = sway(0, 0.5, 0.4, ""), vessel = sway(-0.2, 0.7, 0.6, VESSEL);
    print_message("|div v| at most %g 1/s in a vessel, %g between sides\n", vessel, sides);
    if (!(vessel < 2*sides + 0.5)) fail_msg("|div v| %g 1/s in a vessel, %g between sides", vessel, sides);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(corners_of_a_vessel) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Water of isph in a tank that is one body: its corners are closed, as those between sides of the domain.
   Around a box on the floor: its edges and vertices are no free surface. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "scene/scene.h"
#include "sph/isph/verbs.h"
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

/* 17 1/s with one plane per particle and body, and a tank that boils later on; 0.47 without images in two. */
static void corners_of_a_vessel(void **state)
{
    (void)state;
    const double sides = sway(0, 0.5, 0.4, ""), vessel = sway(-0.2, 0.7, 0.6, VESSEL);
    print_message("|div v| at most %g 1/s in a vessel, %g between sides\n", vessel, sides);
    if (!(vessel < 2*sides + 0.1)) fail_msg("|div v| %g 1/s in a vessel, %g between sides", vessel, sides);
}

/* Started; the caller frees both. */
static tobi_world *make_world(const char *text, tobi_scene **scene)
{
    tobi_error err = { 0 };
    tobi_world *w;
    must(tobi_scene_parse("s.json", text, strlen(text), NULL, scene, NULL, &err), &err);
    must(tobi_scene_build(*scene, &w, &err), &err);
    must(tobi_world_start(w, &err), &err);
    return w;
}

/* Of a cube of 0.1 m, a vessel with water 0.06 m deep. */
static tobi_world *make_cube(tobi_scene **scene)
{
    const char *text = "{ \"method\": \"isph\", \"spacing\": 0.01, \"end_time\": 1,"
                       "\"domain\": { \"min\": [-0.05, -0.05, -0.05], \"max\": [0.15, 0.15, 0.15] },"
                       "\"bodies\": [ { \"name\": \"tank\", \"vessel\": true,"
                       "\"box\": { \"min\": [0, 0, 0], \"max\": [0.1, 0.1, 0.1] } } ],"
                       "\"fluids\": [ { \"name\": \"water\","
                       "\"fill\": [ { \"vessel\": \"tank\", \"level\": 0.06 } ] } ] }";
    return make_world(text, scene);
}

/* A plane for every wall within reach; beyond it none. */
static void planes_of_a_vessel(void **state)
{
    tobi_error err = { 0 };
    tobi_scene *scene;
    tobi_world *w = make_cube(&scene);
    int seen[4] = { 0 };
    (void)state;
    const tobi_system *s = &w->system[0];
    must(s->method->begin(&w->system[0], &err), &err);
    const isph_view *v = &((const isph *)s->state)->solver.view;
    for (int64_t i = 0; i < s->particles.count; i++) {
        const tobi_double3 *p = &s->particles.position[i];
        const double x[3] = { p->x + s->box.lower[0], p->y + s->box.lower[1], p->z + s->box.lower[2] };
        int near = 0, within = 0, planes = 0;
        for (int a = 0; a < 3; a++) {
            const double away = fmin(x[a], 0.1 - x[a]);
            near += away < 0.7*s->smoothing.h;
            within += away < s->smoothing.h;
        }
        for (int32_t k = v->last_link[i]; k >= 0; k = v->mirror[k].previous) planes++;
        if (planes < near || planes > within)
            fail_msg("%d planes at %g %g %g, %d to %d walls", planes, x[0], x[1], x[2], near, within);
        seen[planes]++;
    }
    for (int k = 0; k < 4; k++) assert_true(seen[k] > 0);
    tobi_world_destroy(w);
    tobi_scene_free(scene);
}

/* m/s: the largest speed of water at rest after those steps; ends the world. */
static double speed_at_rest(tobi_world *w, tobi_scene *scene, int steps)
{
    tobi_error err = { 0 };
    tobi_step_info info = { 0 };
    for (int k = 0; k < steps; k++) must(tobi_world_step(w, 0, &info, &err), &err);
    tobi_world_destroy(w);
    tobi_scene_free(scene);
    return info.speed_max;
}

/* 0.74 m/s without images in two and three faces at once. */
static void water_rests_in_a_vessel(void **state)
{
    tobi_scene *scene;
    tobi_world *w = make_cube(&scene);
    (void)state;
    const double most = speed_at_rest(w, scene, 30);
    print_message("water at rest in a vessel moves at %g m/s\n", most);
    if (!(most < 0.01)) fail_msg("water at rest in a vessel moves at %g m/s", most);
}

/* 0.26 m/s where its vertices count as a free surface. */
static void water_rests_around_a_box_on_the_floor(void **state)
{
    const char *text = "{ \"method\": \"isph\", \"spacing\": 0.02, \"end_time\": 1,"
                       "\"domain\": { \"min\": [0, 0, 0], \"max\": [0.4, 0.4, 0.4] },"
                       "\"bodies\": [ { \"name\": \"post\","
                       "\"box\": { \"min\": [0.14, 0.14, 0], \"max\": [0.26, 0.26, 0.14] } } ],"
                       "\"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"box\": {"
                       "\"min\": [0, 0, 0], \"max\": [0.4, 0.4, 0.3] } } ] } ] }";
    tobi_scene *scene;
    tobi_world *w = make_world(text, &scene);
    (void)state;
    const double most = speed_at_rest(w, scene, 30);
    print_message("water at rest around a box on the floor moves at %g m/s\n", most);
    if (!(most < 0.02)) fail_msg("water at rest around a box on the floor moves at %g m/s", most);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(corners_of_a_vessel),
                                        cmocka_unit_test(planes_of_a_vessel),
                                        cmocka_unit_test(water_rests_in_a_vessel),
                                        cmocka_unit_test(water_rests_around_a_box_on_the_floor) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

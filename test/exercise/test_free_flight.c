/* The exercise method in all that the product does with a method: scene, fields, restart, mistakes. */
#include "unit/calls.h"
#include "tobiuo/run.h"
#include "tobiuo/scene.h"
#include "world/methods.h"
#include "base/param.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static const char text[] =
    "{ \"method\": \"free_flight\", \"spacing\": 0.1, \"end_time\": 1, \"free_flight\": { \"drag\": 0 },"
    "  \"domain\": { \"min\": [0, 0, 0], \"max\": [10, 1, 1] },"
    "  \"fluids\": [ { \"name\": \"shot\", \"density\": 1000, \"fill\": [ { \"velocity\": [3, 0, 4],"
    "      \"box\": { \"min\": [0, 0, 0], \"max\": [0.5, 0.5, 0.5] } } ] } ],"
    "  \"output\": { \"fields\": [\"velocity\", \"path\"] } }";

static tobi_world *make(tobi_scene **scene)
{
    tobi_world *world;
    OK(tobi_scene_parse("shot.json", text, strlen(text), NULL, scene, NULL, &err));
    OK(tobi_scene_build(*scene, &world, &err));
    OK(tobi_world_start(world, &err));
    return world;
}

static void particles_fly_on_parabolas(void **state)
{
    tobi_scene *scene;
    tobi_world *world = make(&scene);
    const int64_t count = tobi_world_count(world, TOBI_FLUID);
    double *before = malloc((size_t)count*3*sizeof *before), *after = malloc((size_t)count*3*sizeof *after);
    const double t = 0.8;
    (void)state;
    OK(tobi_world_read(world, TOBI_FLUID, "position", before, count, &err));
    while (tobi_world_time(world) < t) OK(tobi_world_step(world, t - tobi_world_time(world), NULL, &err));
    OK(tobi_world_read(world, TOBI_FLUID, "position", after, count, &err));
    for (int64_t i = 0; i < count; i++) {
        assert_true(fabs(after[3*i] - before[3*i] - 3*t) < 1e-5);
        assert_true(fabs(after[3*i + 2] - before[3*i + 2] - (4*t - 0.5*9.81*t*t)) < 1e-5);
    }
    OK(tobi_world_read(world, TOBI_FLUID, "path", after, count, &err));
    for (int64_t i = 0; i < count; i++) assert_true(after[i] > 3*t && after[i] < 5*t + 0.5*9.81*t*t);
    free(before);
    free(after);
    tobi_world_destroy(world);
    tobi_scene_free(scene);
}

static void restart_goes_on_with_the_same_bits(void **state)
{
    tobi_scene *scene, *same;
    tobi_world *world = make(&scene), *again = make(&same);
    (void)state;
    for (int k = 0; k < 5; k++) OK(tobi_world_step(world, 0, NULL, &err));
    OK(tobi_world_save(world, "free_flight.h5", &err));
    OK(tobi_world_load(again, "free_flight.h5", &err));
    for (int k = 0; k < 5; k++) OK(tobi_world_step(world, 0, NULL, &err));
    for (int k = 0; k < 5; k++) OK(tobi_world_step(again, 0, NULL, &err));
    assert_true(tobi_world_hash(world) == tobi_world_hash(again));
    tobi_world_destroy(world);
    tobi_world_destroy(again);
    tobi_scene_free(scene);
    tobi_scene_free(same);
}

static void mistakes_are_told(void **state)
{
    char wrong[sizeof text];
    tobi_scene *scene;
    (void)state;
    strcpy(wrong, text);
    memcpy(strstr(wrong, "drag"), "dreg", 4);
    REFUSED(tobi_scene_parse("shot.json", wrong, strlen(wrong), NULL, &scene, NULL, &err), TOBI_INVALID,
            "did you mean \"drag\"");
    assert_non_null(tobi_method_table("free_flight"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(particles_fly_on_parabolas),
        cmocka_unit_test(restart_goes_on_with_the_same_bits),
        cmocka_unit_test(mistakes_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

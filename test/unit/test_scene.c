/* Good scenes: what is read, overridden, made explicit and built. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scene/scene.h"
#include "tobiuo/scene.h"

#define FISH TOBI_SOURCE_DIR "/scenes/flying_fish/scene.json"

static tobi_scene *parse(const char *text, const char *const *overrides)
{
    tobi_scene *scene;
    tobi_report *report;
    tobi_error err = { 0 };
    tobi_status status =
        tobi_scene_parse("memory.json", text, strlen(text), overrides, &scene, &report, &err);
    if (status != TOBI_OK) print_error("%s\n", err.text);
    assert_int_equal(status, TOBI_OK);
    assert_null(report);
    return scene;
}

static const char small[] =
    "\xEF\xBB\xBF# a comment with \" and {\n"
    "{ // another\n"
    "  \"domain\": { \"min\": [-1, -2, -3], \"max\": [1, 2, 3],\n"
    "    \"walls\": { \"x\": \"periodic\", \"y\": [\"slip\", \"no-slip\"] } },\n"
    "  \"spacing\": 0.1, \"end_time\": 2, \"time_step\": \"adaptive\", \"threads\": 3,\n"
    "  \"dfsph\": { \"support\": 3, \"kernel\": \"cubic-spline\" },\n"
    "  \"fluids\": [ { \"name\": \"\xE6\xB0\xB4 # no comment\",\n"
    "    \"fill\": [ { \"box\": { \"min\": [-1, -2, -3], \"max\": [1, 2, 0] }, \"velocity\": [1, "
    "0, 0] },\n"
    "              { \"box\": { \"min\": [-1, -2, 0], \"max\": [1, 2, 1] } } ] } ],\n"
    "  \"output\": { \"fields\": [\"velocity\", \"density\"], \"compression\": \"lz4\", "
    "\"surfaces\": false }\n"
    "}\n";

static void reads_what_is_written(void **state)
{
    (void)state;
    tobi_scene *scene = parse(small, NULL);
    const tobi_world_def *w = tobi_scene_world_def(scene);
    assert_true(w->domain_min[2] == -3 && w->domain_max[1] == 2 && w->spacing == 0.1 &&
                w->end_time == 2);
    assert_true(w->wall_min[0] == TOBI_WALL_PERIODIC && w->wall_max[0] == TOBI_WALL_PERIODIC);
    assert_true(w->wall_min[1] == TOBI_WALL_SLIP && w->wall_max[1] == TOBI_WALL_NO_SLIP);
    assert_true(w->wall_min[2] == TOBI_WALL_SLIP && w->time_step == 0 && w->threads == 3);
    assert_true(w->gravity[2] == -9.81 && w->cfl == 0.4);
    const tobi_dfsph_def *d = scene->method_def;
    assert_true(d->support == 3 && d->kernel == TOBI_KERNEL_CUBIC_SPLINE &&
                d->density_tolerance == 5e-4);
    assert_int_equal(scene->fluid_count, 1);
    assert_string_equal(scene->fluids[0].def.name, "\xE6\xB0\xB4 # no comment");
    assert_int_equal(scene->fluids[0].fill_count, 2);
    assert_true(scene->fluids[0].fills[0].def.velocity[0] == 1 &&
                scene->fluids[0].def.density == 1000);
    const tobi_output_def *o = tobi_scene_output_def(scene);
    assert_string_equal(o->fields, "velocity,density");
    assert_true(o->compression == TOBI_COMPRESS_LZ4 && o->surfaces == 0);
    assert_string_equal(tobi_scene_name(scene), "memory");
    tobi_scene_free(scene);
}

static void overrides_win_and_are_checked(void **state)
{
    (void)state;
    const char *overrides[] = { "spacing=.05",
                                "dfsph.kernel=wendland-c2",
                                "fluids[0].fill[1].velocity=[0, 0, -2]",
                                "fluids[0].name=oil",
                                "fluids.oil.viscosity=0.1",
                                "domain.walls.z=no-slip",
                                "dfsph.support=4",
                                "dfsph.support=2.5",
                                "output.fields=velocity,pressure",
                                "output.frames=true",
                                "method=dfsph",
                                NULL };
    tobi_scene *scene = parse(small, overrides);
    const tobi_world_def *w = tobi_scene_world_def(scene);
    const tobi_dfsph_def *d = scene->method_def;
    assert_true(w->spacing == 0.05 && w->wall_min[2] == TOBI_WALL_NO_SLIP &&
                w->wall_max[2] == TOBI_WALL_NO_SLIP);
    assert_true(d->kernel == TOBI_KERNEL_WENDLAND_C2 && d->support == 2.5);
    assert_string_equal(scene->fluids[0].def.name, "oil");
    assert_true(scene->fluids[0].def.viscosity == 0.1 &&
                scene->fluids[0].fills[1].def.velocity[2] == -2);
    assert_string_equal(scene->output.fields, "velocity,pressure");
    assert_int_equal(scene->output.frames, 1);
    tobi_scene_free(scene);
}

static const char plane[] = "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [1, 1] }, "
                            "\"spacing\": 0.1, \"end_time\": 1,\n"
                            "  \"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"box\": { "
                            "\"min\": [0, 0], \"max\": [1, 0.5] } } ] } ] }";

static void two_dimensions_take_two_numbers(void **state)
{
    (void)state;
    tobi_scene *scene = parse(plane, NULL);
    const tobi_world_def *w = tobi_scene_world_def(scene);
    assert_true(w->dimension == 2 && w->domain_max[0] == 1 && w->domain_max[2] == 0);
    assert_true(w->gravity[0] == 0 && w->gravity[1] == -9.81 && w->gravity[2] == 0);
    tobi_scene_free(scene);
    const char *overrides[] = { "gravity=[0.5, 0]", NULL };
    scene = parse(plane, overrides);
    w = tobi_scene_world_def(scene);
    assert_true(w->gravity[0] == 0.5 && w->gravity[1] == 0 && w->gravity[2] == 0);
    tobi_scene_free(scene);
    const char *cut[] = { "output.picture.clip_normal=[0, 0, 1]", NULL };
    tobi_report *report = NULL;
    tobi_error err = { 0 };
    scene = NULL;
    assert_true(tobi_scene_parse("s.json", plane, strlen(plane), cut, &scene, &report, &err) != TOBI_OK);
    assert_null(scene);
    assert_non_null(report);
    assert_non_null(strstr(tobi_report_line(report, 0), "points out of the plane of the 2-D scene"));
    tobi_report_free(report);
}

/* Every number and word of two scenes is the same. */
static void compare_scenes(const tobi_scene *a, const tobi_scene *b)
{
    const char *method = a->world.method;
    tobi_world_def world = b->world;
    assert_string_equal(method, world.method);
    world.method = method;
    assert_memory_equal(&a->world, &world, sizeof world);
    assert_memory_equal(a->method_def, b->method_def, a->method->size);
    assert_int_equal(a->fluid_count, b->fluid_count);
    for (int i = 0; i < a->fluid_count; i++) {
        assert_true(a->fluids[i].def.viscosity == b->fluids[i].def.viscosity);
        assert_string_equal(a->fluids[i].def.name, b->fluids[i].def.name);
        assert_int_equal(a->fluids[i].fill_count, b->fluids[i].fill_count);
        for (int j = 0; j < a->fluids[i].fill_count; j++) {
            const tobi_fill_def *x = &a->fluids[i].fills[j].def, *y = &b->fluids[i].fills[j].def;
            assert_memory_equal(x->box_min, y->box_min, sizeof x->box_min);
            assert_memory_equal(x->box_max, y->box_max, sizeof x->box_max);
            assert_memory_equal(x->velocity, y->velocity, sizeof x->velocity);
        }
    }
    assert_int_equal(a->body_count, b->body_count);
    for (int i = 0; i < a->body_count; i++) {
        const tobi_body_def *x = &a->bodies[i].def, *y = &b->bodies[i].def;
        assert_string_equal(x->mesh, y->mesh);
        assert_memory_equal(x->scale, y->scale,
                            offsetof(tobi_body_def, motion) - offsetof(tobi_body_def, scale));
        assert_true(x->motion == y->motion && x->motion_rigid == y->motion_rigid);
    }
    assert_true(a->output.interval == b->output.interval &&
                a->output.compression == b->output.compression);
    assert_string_equal(a->output.fields, b->output.fields);
}

/* A motion that is handed on must move points to the same bits. */
static void compare_motions(const tobi_scene *a, const tobi_scene *b)
{
    const double rest[3][3] = { { 0.31, 0.15, 0.24 },
                                { 0.26, 0.22, 0.241 },
                                { 0.22, 0.153, 0.239 } };
    double x[3][3], y[3][3];
    for (int step = 0; step < 8; step++) {
        double t = 0.1*step + 0.013;
        assert_int_equal(tobi_motion_positions(a->bodies[0].motion, t, 3, rest, x, NULL), TOBI_OK);
        assert_int_equal(tobi_motion_positions(b->bodies[0].motion, t, 3, rest, y, NULL), TOBI_OK);
        assert_memory_equal(x, y, sizeof x);
    }
    assert_true(x[0][0] != rest[0][0]);
}

static void resolved_gives_the_same_scene(void **state)
{
    (void)state;
    const char *overrides[] = { "spacing=0.0081234567890123",
                                "time_step=1e-5",
                                "cfl=0.1",
                                "gravity=[1e-300,-0.0,3]",
                                "bodies.fish.scale=0.9",
                                "bodies[0].motion.params.freq=7.3",
                                NULL };
    tobi_scene *first, *second;
    tobi_error err = { 0 };
    assert_int_equal(tobi_scene_load(FISH, overrides, &first, NULL, &err), TOBI_OK);
    char *text = tobi_scene_resolved(first);
    assert_non_null(text);
    assert_non_null(
        strstr(text, "\"density_tolerance\": 0.0005")); /* defaults are explicit, and short */
    assert_non_null(strstr(text, "\"spacing\": 0.0081234567890123"));
    assert_int_equal(
        tobi_scene_parse("/elsewhere/resolved.json", text, strlen(text), NULL, &second, NULL, &err),
        TOBI_OK);
    compare_scenes(first, second);
    compare_motions(first, second);
    char *again = tobi_scene_resolved(second);
    assert_string_equal(text, again);
    tobi_scene_free(first);
    tobi_scene_free(second);
    free(text);
    free(again);

    first = parse(plane, NULL);
    text = tobi_scene_resolved(first);
    second = parse(text, NULL);
    compare_scenes(first, second);
    tobi_scene_free(first);
    tobi_scene_free(second);
    free(text);
}

static void every_shipped_scene_loads(void **state)
{
    (void)state;
    static const char *const names[] = { "flying_fish",      "dam_break",  "dam_break_2d",
                                         "hydrostatic_tank", "poiseuille", "towed_sphere",
                                         "apple_cut",        "apple_cut_seed", "slicing",
                                         "wedge_split",      "cheese_wire",    "twisted_knife",
                                         "knife_leaves",     "carrot",         "apple_quarters" };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char path[1024];
        tobi_scene *scene;
        tobi_error err = { 0 };
        snprintf(path, sizeof path, "%s/scenes/%s/scene.json", TOBI_SOURCE_DIR, names[i]);
        tobi_status status = tobi_scene_load(path, NULL, &scene, NULL, &err);
        if (status != TOBI_OK) print_error("%s\n", err.text);
        assert_int_equal(status, TOBI_OK);
        assert_string_equal(tobi_scene_name(scene), names[i]);
        tobi_scene_free(scene);
    }
}

static void the_fish_is_the_described_one(void **state)
{
    (void)state;
    tobi_scene *scene;
    assert_int_equal(tobi_scene_load(FISH, NULL, &scene, NULL, NULL), TOBI_OK);
    const tobi_world_def *w = tobi_scene_world_def(scene);
    assert_true(w->spacing == 0.004 && w->end_time == 0.8 && w->domain_max[0] == 0.6);
    assert_true(scene->bodies[0].def.spacing == 0.002 &&
                scene->bodies[0].def.translation[2] == 0.24);
    assert_int_equal(scene->bodies[0].def.motion_rigid, 0);
    json_t *lag = json_object_get(scene->bodies[0].motion_def[0].params, "lagAngle");
    assert_true(json_number_value(lag) == 80);
    const tobi_fill_def *fill = &scene->fluids[0].fills[0].def;
    assert_true(fill->box_max[2] == 0.19 && fill->box_min[0] == 0);
    tobi_scene_free(scene);
}

static void motions_by_numbers(void **state)
{
    (void)state;
    const char *overrides[] = { "bodies.fish.motion={\"oscillation\": {\"direction\": [0, 0, 2], "
                                "\"amplitude\": 0.5, \"frequency\": 1, "
                                "\"phase\": 90}}",
                                NULL };
    tobi_scene *scene;
    tobi_error err = { 0 };
    tobi_status status = tobi_scene_load(FISH, overrides, &scene, NULL, &err);
    if (status != TOBI_OK) print_error("%s\n", err.text);
    assert_int_equal(status, TOBI_OK);
    assert_int_equal(scene->bodies[0].def.motion_rigid, 1);
    const double rest[1][3] = { { 1, 2, 3 } };
    double moved[1][3];
    assert_int_equal(
        scene->bodies[0].def.motion(scene->bodies[0].def.motion_user, 0, 1, rest, moved, NULL),
        TOBI_OK);
    assert_true(moved[0][0] == 1 && moved[0][2] > 3.4999 && moved[0][2] < 3.5001);
    char *text = tobi_scene_resolved(scene);
    assert_non_null(strstr(text, "\"oscillation\""));
    assert_non_null(strstr(text, "\"phase\": 90.0"));
    free(text);
    tobi_scene_free(scene);
}

static void colours_boxes_and_a_camera(void **state)
{
    (void)state;
    const char *overrides[] = { "fluids[0].color=[1, 2, 255]",
                                "fluids[0].visible=false",
                                "bodies=[{\"name\": \"b\", \"color\": \"automatic\", "
                                "\"box\": { \"min\": [0, 0, 0], "
                                "\"max\": [0.5, 0.5, 0.5] }, \"translation\": [0.1, 0, 0] }]",
                                "output.camera={\"position\": [3, 3, 3], \"angle\": 30}",
                                NULL };
    tobi_scene *scene = parse(small, NULL);
    assert_true(scene->fluids[0].def.color[0] == -1 && scene->output.view.angle == 0);
    tobi_scene_free(scene);
    scene = parse(small, overrides);
    const tobi_fluid_def *fluid = &scene->fluids[0].def;
    assert_true(fluid->color[0] == 1 && fluid->color[2] == 255 && fluid->visible == 0);
    assert_true(scene->bodies[0].def.color[0] == -1 && scene->bodies[0].def.box_max[2] == 0.5);
    assert_true(scene->output.view.position[1] == 3 && scene->output.view.angle == 30);
    char *text = tobi_scene_resolved(scene);
    assert_non_null(strstr(text, "\"color\": \"automatic\""));
    assert_non_null(strstr(text, "\"color\": [1.0, 2.0, 255.0]"));
    tobi_scene *again = parse(text, NULL);
    char *second = tobi_scene_resolved(again);
    assert_string_equal(text, second);
    free(second);
    free(text);
    tobi_scene_free(again);

    tobi_world *world;
    tobi_body_info info;
    assert_int_equal(tobi_scene_build(scene, &world, NULL), TOBI_OK);
    assert_int_equal(tobi_world_body(world, 0, &info), TOBI_OK);
    assert_true(info.volume > 0.1249999 && info.volume < 0.1250001);
    assert_true(info.position[0] > 0.3499999 && info.position[0] < 0.3500001);
    tobi_world_destroy(world);
    tobi_scene_free(scene);
}

static void a_box_is_a_rectangle_in_2d(void **state)
{
    (void)state;
    const char *overrides[] = { "bodies=[{\"name\": \"b\", \"box\": { \"min\": [0.2, 0.2], "
                                "\"max\": [0.5, 0.4] } }]",
                                NULL };
    tobi_scene *scene = parse(plane, overrides);
    tobi_world *world;
    tobi_body_info info;
    assert_int_equal(tobi_scene_build(scene, &world, NULL), TOBI_OK);
    assert_int_equal(tobi_world_body(world, 0, &info), TOBI_OK);
    assert_true(info.volume > 0.0599999 && info.volume < 0.0600001);
    tobi_world_destroy(world);
    tobi_scene_free(scene);
}

static void builds_a_world(void **state)
{
    (void)state;
    tobi_scene *scene;
    tobi_world *world;
    tobi_error err = { 0 };
    const char *overrides[] = { "spacing=0.02", NULL };
    assert_int_equal(tobi_scene_load(FISH, overrides, &scene, NULL, &err), TOBI_OK);
    tobi_status status = tobi_scene_build(scene, &world, &err);
    if (status != TOBI_OK) print_error("%s\n", err.text);
    assert_int_equal(status, TOBI_OK);
    assert_int_equal(tobi_world_body_count(world), 1);
    assert_string_equal(tobi_world_body_name(world, 0), "fish");
    tobi_world_destroy(world);
    tobi_scene_free(scene);
}

static void describe_tells_units_defaults_and_ranges(void **state)
{
    (void)state;
    char *text = tobi_scene_describe("dfsph");
    assert_non_null(strstr(text, "support\n"));
    assert_non_null(strstr(text, "2 to 4 spacings"));
    assert_non_null(strstr(text, "default: 0.0005"));
    free(text);
    text = tobi_scene_describe("motion");
    assert_non_null(strstr(text, "degrees/s"));
    free(text);
    text = tobi_scene_describe("fill");
    assert_non_null(strstr(text, "tobiuo describe flow"));
    free(text);
    text = tobi_scene_describe("flow");
    assert_non_null(strstr(text, "velocity(x, y, z)"));
    free(text);
    text = tobi_scene_describe(NULL);
    assert_non_null(strstr(text, "dfsph"));
    free(text);
    text = tobi_scene_describe("scene");
    assert_non_null(strstr(text, "| `spacing` | number | m | **required** | 1e-7 to 1e5 m |"));
    free(text);
    text = tobi_scene_describe("schema");
    assert_non_null(strstr(text, "\"additionalProperties\": false"));
    free(text);
    assert_null(tobi_scene_describe("nonsense"));
    assert_null(tobi_scene_describe(""));
}

static void expect_description(const char *word, const char *text, const char *not_this)
{
    char *told = tobi_scene_describe(word);
    assert_non_null(told);
    assert_non_null(strstr(told, text));
    if (not_this) assert_null(strstr(told, not_this));
    free(told);
}

static void describe_finds_any_key_field_or_column(void **state)
{
    (void)state;
    expect_description("camera", "  camera.look_at\n", "interval");
    expect_description("output.camera", "  camera.look_at\n", NULL);
    expect_description("viscosity", "fluid: ", "density");
    expect_description("walls", "  domain.walls.x[0]\n", "domain.min");
    expect_description("frequency", "Hz", NULL);
    expect_description("fill", "tobiuo describe flow", NULL);
    expect_description("vorticity", "3 components, unit 1/s", NULL);
    expect_description("mean_pressure_force_z", "bodies.csv, unit N\n      Mean of pressure_force", NULL);
    expect_description("history", "density_error_mean", "orientation_w");
    expect_description("probes", "level", NULL);
    expect_description("tables", "# Tables of a run", NULL);
    expect_description("shear", "  tractions\n      Write the pressure and the shear", "  interval\n");
    expect_description("rectangle", "flow: column of probes.csv, unit m3/s", NULL);
    assert_null(tobi_scene_describe("hea"));
    const char *slips[][2] = { { "camra", "camera" }, { "histroy", "history" }, { "viscocity", "viscosity" },
                               { "dfshp", "dfsph" }, { "vorticty", "vorticity" } };
    for (size_t k = 0; k < sizeof slips/sizeof *slips; k++) {
        assert_null(tobi_scene_describe(slips[k][0]));
        char *near = tobi_scene_suggest(slips[k][0]);
        assert_string_equal(near, slips[k][1]);
        free(near);
    }
    assert_null(tobi_scene_suggest("elephant"));
}

/* resolved.json is whole or not written: every allocation of jansson fails once. */
static long left;
static void *scarce(size_t size) { return left-- == 0 ? NULL : malloc(size); }

static void resolved_is_whole_or_nothing(void **state)
{
    (void)state;
    tobi_scene *scene;
    tobi_error err = { 0 };
    assert_int_equal(tobi_scene_load(FISH, NULL, &scene, NULL, &err), TOBI_OK);
    char *expected = tobi_scene_resolved(scene);
    int refused = 0;
    json_set_alloc_funcs(scarce, free);
    for (long n = 0; n == 0 || left < 0; n++) {      /* until none was left to fail */
        left = n;
        char *got = tobi_scene_resolved(scene);
        if (got) assert_string_equal(got, expected);
        refused += !got;
        free(got);
    }
    json_set_alloc_funcs(malloc, free);
    assert_true(refused > 100);
    free(expected);
    tobi_scene_free(scene);
}

static void suggestions(void **state)
{
    (void)state;
    static const char *const words[] = { "spacing", "support", "end_time", "velocity" };
    assert_string_equal(tobi_suggest("Spacing", words, 4), "spacing");
    assert_string_equal(tobi_suggest("end-time", words, 4), "end_time");
    assert_string_equal(tobi_suggest("velcoity", words, 4), "velocity");
    assert_null(tobi_suggest("particleRadius", words, 4));
    assert_null(tobi_suggest("", words, 4));
    assert_null(tobi_suggest("x", words, 4));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_what_is_written),
        cmocka_unit_test(overrides_win_and_are_checked),
        cmocka_unit_test(two_dimensions_take_two_numbers),
        cmocka_unit_test(resolved_gives_the_same_scene),
        cmocka_unit_test(resolved_is_whole_or_nothing),
        cmocka_unit_test(every_shipped_scene_loads),
        cmocka_unit_test(the_fish_is_the_described_one),
        cmocka_unit_test(motions_by_numbers),
        cmocka_unit_test(colours_boxes_and_a_camera),
        cmocka_unit_test(a_box_is_a_rectangle_in_2d),
        cmocka_unit_test(builds_a_world),
        cmocka_unit_test(describe_tells_units_defaults_and_ranges),
        cmocka_unit_test(describe_finds_any_key_field_or_column),
        cmocka_unit_test(suggestions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

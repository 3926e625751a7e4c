/* Scenes with solids, good and bad. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scene/scene.h"
#include "world/world.h"

static const char start[] =
    "{ \"method\": \"mlsmpm\", \"domain\": { \"min\": [-1, -1, -1], \"max\": [1, 1, 1] },\n"
    "\"spacing\": 0.1, \"end_time\": 1,\n";
static const char ball[] = "\"fill\": [ { \"sphere\": { \"centre\": [0, 0, 0], \"radius\": 0.5 } } ]";

#define BOX(low, high) "\"box\": { \"min\": " low ", \"max\": " high " }"
#define SPHERE(centre, radius) "\"sphere\": { \"centre\": " centre ", \"radius\": " radius " }"

/* A scene with one solid of these lines, and `rest` after it. */
static char *make(const char *solid, const char *rest)
{
    static char text[4096];
    snprintf(text, sizeof text, "%s\"solids\": [ { \"name\": \"it\",\n%s\n} ]\n%s }", start, solid, rest);
    return text;
}

static tobi_scene *parse(const char *text)
{
    tobi_scene *scene;
    tobi_report *report;
    tobi_error err = { 0 };
    if (tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, &report, &err) != TOBI_OK)
        fail_msg("%s", err.text);
    return scene;
}

/* The one mistake of a scene, at this place and with this text in it. */
static void refuse(const char *text, const char *place, const char *part)
{
    tobi_scene *scene;
    tobi_report *report;
    tobi_error err = { 0 };
    tobi_status status = tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, &report, &err);
    assert_int_equal(status, TOBI_INVALID);
    if (tobi_report_count(report) != 1 || !strstr(err.text, part) || strncmp(err.text, place, strlen(place)))
        fail_msg("%d mistakes: %s\nexpected at %s: %s", tobi_report_count(report), err.text, place, part);
    tobi_report_free(report);
}

static void scenes_have_solids(void **state)
{
    (void)state;
    const char rest[] = ", \"output\": { \"fields\": [\"usual\", \"stress\"], \"grid\": true },\n"
                        "\"mlsmpm\": { \"cfl\": 0.3 }";
    tobi_scene *scene =
        parse(make("\"model\": \"sand\", \"mass\": 500, \"friction_angle\": 35, \"color\": [1, 2, 3],\n"
                   "\"fill\": [ { " BOX("[0, 0, 0]", "[0.5, 0.5, 0.5]") ", \"spin\": [0, 0, 2] },\n"
                   "{ " SPHERE("[-0.5, 0, 0]", "0.4") ", \"velocity\": [1, 0, 0] } ]", rest));
    assert_int_equal(scene->solid_count, 1);
    assert_int_equal(scene->fluid_count, 0);
    const tobi_solid_def *def = &scene->solids[0].def;
    assert_true(def->model == TOBI_SAND && def->mass == 500 && def->friction_angle == 35);
    assert_true(def->color[1] == 2);
    assert_true(scene->solids[0].fills[0].def.spin[2] == 2 && scene->solids[0].fills[1].def.radius == 0.4);
    tobi_world *world;
    tobi_error err = { 0 };
    tobi_solid_info info;
    if (tobi_scene_build(scene, &world, &err) != TOBI_OK) fail_msg("%s", err.text);
    assert_int_equal(tobi_world_solid_count(world), 1);
    assert_int_equal(tobi_world_solid(world, 1, &info), TOBI_NOT_FOUND);
    assert_int_equal(tobi_world_solid(world, 0, &info), TOBI_OK);
    double volume = 0.125 + 4*acos(-1)/3*0.064;
    assert_string_equal(info.name, "it");
    assert_true(fabs(info.mass - 500) < 1e-9 && fabs(info.density - 500/volume) < 1e-9*info.density);
    assert_true(fabs((double)info.particles - volume/1e-3) < 2);
    /* The ball starts at 1 m/s; sound and particles cross 0.3 of a cell of 0.2 m. */
    double slower = 1/tobi_world_stable_step(world) - 1/info.time_step;
    assert_true(info.time_step > 0 && fabs(slower - 1/(0.3*0.2)) < 1e-9*slower);
    /* Made explicit and read again: the same state. */
    char *text = tobi_scene_resolved(scene);
    assert_non_null(strstr(text, "\"friction_angle\": 35"));
    assert_null(strstr(text, "yield_stress"));
    assert_null(strstr(text, "\"fluids\""));
    tobi_scene *again = parse(text);
    char *second = tobi_scene_resolved(again);
    assert_string_equal(text, second);
    tobi_world *other;
    assert_int_equal(tobi_scene_build(again, &other, &err), TOBI_OK);
    assert_int_equal(tobi_world_step(world, 0, NULL, &err), TOBI_OK);
    assert_int_equal(tobi_world_step(other, 0, NULL, &err), TOBI_OK);
    assert_true(tobi_world_hash(world) == tobi_world_hash(other));
    assert_int_equal(tobi_world_solid(world, 0, &info), TOBI_OK);
    assert_int_equal(info.particles, tobi_world_count(world, TOBI_FLUID));
    free(text);
    free(second);
    tobi_world_destroy(world);
    tobi_world_destroy(other);
    tobi_scene_free(scene);
    tobi_scene_free(again);
}

static void a_long_time_step_is_told(void **state)
{
    (void)state;
    tobi_scene *scene = parse(make(ball, ", \"time_step\": 0.1"));
    tobi_world *world;
    tobi_error err = { 0 };
    assert_int_equal(tobi_scene_build(scene, &world, &err), TOBI_OK);
    assert_int_equal(tobi_world_start(world, &err), TOBI_OK);
    const char *note = tobi_world_note(world, 0);
    assert_non_null(note);
    assert_non_null(strstr(note, "0.1 s is longer than the"));
    tobi_step_info info;
    assert_int_equal(tobi_world_step(world, 0, &info, &err), TOBI_OK);
    assert_true(info.dt <= tobi_world_stable_step(world));
    double parts = 0.1/info.dt;
    assert_true(fabs(parts - round(parts)) < 1e-9*parts);
    tobi_world_destroy(world);
    tobi_scene_free(scene);
}

/* Only of liquids, and what to write instead. */
static void liquids_are_told(void **state)
{
    (void)state;
    for (int liquid = 0; liquid < 2; liquid++) {
        char text[200];
        snprintf(text, sizeof text, "%s%s", liquid ? "\"model\": \"liquid\", " : "", ball);
        tobi_scene *scene = parse(make(text, ""));
        tobi_world *world;
        tobi_error err = { 0 };
        assert_int_equal(tobi_scene_build(scene, &world, &err), TOBI_OK);
        assert_int_equal(tobi_world_start(world, &err), TOBI_OK);
        const char *note = tobi_world_note(world, 0);
        assert_int_equal(note != NULL, liquid);
        if (note) assert_ptr_equal(strstr(note, "solid 'it': a liquid of mlsmpm does not keep its "), note);
        if (note) assert_non_null(strstr(note, "write it into fluids, with dfsph or isph, beside the "));
        assert_null(tobi_world_note(world, 1));
        tobi_world_destroy(world);
        tobi_scene_free(scene);
    }
}

/* A body in the middle of the ball: what it takes away is told. */
static void bodies_in_solids_are_told(void **state)
{
    (void)state;
    tobi_scene *scene = parse(make(ball, ", \"bodies\": [ { \"name\": \"b\", "
                                         BOX("[0, 0, 0]", "[0.2, 0.2, 0.2]") " } ]"));
    tobi_world *world;
    tobi_error err = { 0 };
    assert_int_equal(tobi_scene_build(scene, &world, &err), TOBI_OK);
    assert_null(tobi_world_note(world, 0));
    assert_int_equal(tobi_world_start(world, &err), TOBI_OK);
    const char *note = tobi_world_note(world, 0);
    assert_non_null(note);
    assert_non_null(strstr(note, "solid 'it': 8 particles that would start inside bodies were cut out"));
    tobi_world_destroy(world);
    tobi_scene_free(scene);
}

/* A solid of which nothing is left is no solid; one smaller than a spacing has one particle. */
static void solids_without_particles_are_refused(void **state)
{
    (void)state;
    tobi_scene *scene = parse(make(ball, ", \"bodies\": [ { \"name\": \"b\", "
                                         BOX("[-0.6, -0.6, -0.6]", "[0.6, 0.6, 0.6]") " } ]"));
    tobi_world *world;
    tobi_error err = { 0 };
    assert_int_equal(tobi_scene_build(scene, &world, &err), TOBI_OK);
    assert_int_equal(tobi_world_start(world, &err), TOBI_INVALID);
    if (!strstr(err.text, "no particles at all in solid 'it': of the 552 that it would start with, 552 lie "
                          "inside bodies, 0 behind planes, 0 inside solids and 0 outside"))
        fail_msg("%s", err.text);
    tobi_world_destroy(world);
    tobi_scene_free(scene);
    scene = parse(make("\"fill\": [ { " SPHERE("[0, 0, 0]", "0.01") " } ]", ""));
    int64_t particles, bodies, bytes;
    assert_int_equal(tobi_scene_build(scene, &world, &err), TOBI_OK);
    assert_int_equal(tobi_world_estimate(world, &particles, &bodies, &bytes, &err), TOBI_OK);
    assert_int_equal(particles, 1);
    tobi_world_destroy(world);
    tobi_scene_free(scene);
}

static void bad_solids_are_refused_in_words(void **state)
{
    (void)state;
    char text[2048];
    snprintf(text, sizeof text, "\"mass\": 0, %s", ball);
    refuse(make(text, ""), "s.json:4:9: solids[0].mass: ",
           "is 0, allowed is 1e-30 to 1e30 kg, or \"by density\"");
    snprintf(text, sizeof text, "\"mass\": \"by density\", %s", ball);
    tobi_scene_free(parse(make(text, "")));
    refuse(make(ball, ", \"bodies\": [ { \"name\": \"b\", \"mass\": 0,\n"
                      BOX("[-1, -1, -1]", "[0, 0, -0.6]") " } ]"),
           "s.json:6:38: bodies[0].mass: ", "is 0, allowed is 1e-30 to 1e30 kg, or \"by density\"");
    refuse(make("\"density\": 1000, \"mass\": 2, \"fill\": [ { " SPHERE("[0, 0, 0]", "0.5") " } ]", ""),
           "s.json:4:18: solids[0].mass: ", "given beside density");
    snprintf(text, sizeof text, "\"model\": \"liquid\", \"youngs_modulus\": 1e5, %s", ball);
    refuse(make(text, ""), "s.json:4:20: solids[0].youngs_modulus: ",
           "is nothing that this model knows; it has density or mass, bulk_modulus, viscosity, damping");
    snprintf(text, sizeof text, "\"poissons_ratio\": 0.5, %s", ball);
    refuse(make(text, ""), "s.json:4:19: solids[0].poissons_ratio: ", "is 0.5, allowed is -0.99 to 0.495");
    snprintf(text, sizeof text, "\"youngs_modulus\": 0, %s", ball);
    refuse(make(text, ""), "s.json:4:19: solids[0].youngs_modulus: ", "is 0, allowed is 1e-6 to 1e15 Pa");
    snprintf(text, sizeof text, "\"surface_friction\": -1, %s", ball);
    refuse(make(text, ""), "s.json:4:21: solids[0].surface_friction: ", "is -1, allowed is 0 to 1000");
    snprintf(text, sizeof text, "\"bonded\": 0, %s", ball);
    refuse(make(text, ""), "s.json:4:11: solids[0].bonded: ", "is a number, must be true or false");
    snprintf(text, sizeof text, "\"model\": \"liquid\", \"surface_friction\": 0.1, %s", ball);
    refuse(make(text, ""), "s.json:4:20: solids[0].surface_friction: ", "is nothing that this model knows");
    /* 2 G/f (E/f + 0.66)/1.5 = 1e-3 x 100.66/1.5 */
    snprintf(text, sizeof text, "\"strength\": 1e4,\n\"fracture_energy\": 5, %s", ball);
    refuse(make(text, ""), "s.json:4:1: solids[0].strength: ",
           "needs cells smaller than 0.06711 m, they have 0.2 m");
    snprintf(text, sizeof text, "\"fracture_energy\": 5, %s", ball);
    refuse(make(text, ""), "s.json:4:1: solids[0].fracture_energy: ", "needs a strength greater than 0 Pa");
    snprintf(text, sizeof text, "%s\"solids\": [ { \"name\": \"a\", %s }, { \"name\": \"a\",\n"
             "\"fill\": [ { " BOX("[0.6, 0, 0]", "[1, 1, 1]") " } ] } ] }", start, ball);
    refuse(text, "s.json:3:", "\"a\" is already the name of solids[0]");
}

static void bad_regions_are_refused_in_words(void **state)
{
    (void)state;
    const char two[] = "\"fill\": [ { " SPHERE("[0, 0, 0]", "0.5") " },\n"
                       "{ " BOX("[%s, %s, -0.1]", "[0.6, 0.6, 0.1]") " } ]";
    char text[2048];
    refuse(make("\"fill\": []", ""), "s.json:4:9: solids[0].fill: ",
           "a list of the regions this solid fills");
    refuse(make("\"fill\": [ { \"sphere\": { \"radius\": 0.5 } } ]", ""),
           "s.json:4:23: solids[0].fill[0].sphere.centre: ", "is missing: a sphere has centre and radius");
    refuse(make("\"fill\": [ { " SPHERE("[0, 0, 0]", "0") " } ]", ""),
           "s.json:4:56: solids[0].fill[0].sphere.radius: ", "must be greater than 0 m");
    refuse(make("\"fill\": [ { " SPHERE("[0, 0, 0.6]", "0.5") " } ]", ""),
           "s.json:4:23: solids[0].fill[0].sphere: ",
           "reaches from 0.1 to 1.1 m in z, the domain only from -1 to 1 m");
    refuse(make("\"fill\": [ { " SPHERE("[0, 0, 0]", "0.5") ", \"mesh\": \"a.obj\" } ]", ""),
           "s.json:4:11: solids[0].fill[0]: ",
           "must have one of box, sphere, mesh, outline and vessel, it has several");
    refuse(make("\"fill\": [ { " SPHERE("[0, 0, 0]", "0.5") ",\n\"rotation\": { \"angle\": 3 } } ]", ""),
           "s.json:4:11: solids[0].fill[0]: ", "scale, rotation and translation belong to a mesh");
    refuse(make("\"fill\": [ { \"mesh\": \"" TOBI_SOURCE_DIR "/test/meshes/box.obj\",\n"
                "\"rotation\": { \"axis\": [0, 0, 0] } } ]", ""),
           "s.json:5:23: solids[0].fill[0].rotation.axis: ", "is zero, must have a direction");
    snprintf(text, sizeof text, two, "0.3", "0.3");
    refuse(make(text, ""), "s.json:5:1: solids[0].fill[1]: ", "overlaps the sphere solids[0].fill[0]");
    snprintf(text, sizeof text, two, "0.36", "0.36");        /* boxes overlap, box and sphere do not */
    tobi_scene_free(parse(make(text, "")));
    snprintf(text, sizeof text, "{ \"method\": \"mlsmpm\", \"dimension\": 2,\n"
             "\"domain\": { \"min\": [-1, -1], \"max\": [1, 1] }, \"spacing\": 0.1, \"end_time\": 1,\n"
             "\"solids\": [ { \"name\": \"a\",\n"
             "\"fill\": [ { " SPHERE("[0, 0]", "0.5") ", \"spin\": [1, 0, 0] } ] } ] }");
    refuse(text, "s.json:4:68: solids[0].fill[0].spin: ", "must be about z in a 2-D scene");
}

/* Fluids with mlsmpm, solids with the others, and what only one of them has. */
static void methods_refuse_what_they_do_not_know(void **state)
{
    (void)state;
    const char fluid[] = "\"fluids\": [ { \"name\": \"w\", \"fill\": [ { " BOX("[0, 0, 0]", "[1, 1, 1]")
                         " } ] } ]";
    const char plain[] = "{ \"domain\": { \"min\": [-1, -1, -1], \"max\": [1, 1, 1] }, \"spacing\": 0.1, "
                         "\"end_time\": 1,\n";
    char text[2048];
    snprintf(text, sizeof text, "%s%s }", start, fluid);
    refuse(text, "s.json:3:11: fluids: ", "mlsmpm takes no fluids; write a solid of \"model\": \"liquid\"");
    snprintf(text, sizeof text, "%s\"bodies\": [] }", start);
    refuse(text, "s.json:1:1: solids: ",
           "is missing or empty: a scene of mlsmpm needs at least one solid or body");
    refuse(make(ball, ", \"probes\": [ { \"name\": \"p\", \"position\": [0, 0, 0] } ]"),
           "s.json:6:13: probes: ", "mlsmpm has no probes");
    refuse(make(ball, ", \"output\": { \"fields\": [\"vorticity\"] }"), "s.json:6:25: output.fields: ",
           "there is no field \"vorticity\"; allowed are position, velocity, pressure");
    snprintf(text, sizeof text, "%s\"solids\": [ { \"name\": \"a\", %s } ] }", plain, ball);
    refuse(text, "s.json:1:1: fluids: ", "is missing or empty: dfsph needs at least one fluid; the "
           "method of solids alone is mlsmpm");
    snprintf(text, sizeof text, "%s%s, \"output\": {\n\"grid\": true } }", plain, fluid);
    refuse(text, "s.json:3:9: output.grid: ", "dfsph has no grid; mlsmpm has one");
    refuse(make(ball, ", \"output\": { \"tractions\": true }"), "s.json:6:28: output.tractions: ",
           "mlsmpm has no fluid that presses on bodies");
    snprintf(text, sizeof text, "{ \"method\": \"mlsmpm\", \"domain\": { \"min\": [-1, -1, -1], \"max\": [1, "
           "1, 1],\n"
             "\"walls\": { \"x\": \"periodic\" } }, \"spacing\": 0.1, \"end_time\": 1,\n\"solids\": [ { "
                    "\"name\": "
             "\"a\", %s } ] }", ball);
    refuse(text, "s.json:2:17: domain.walls.x: ", "is periodic, which mlsmpm does not know");
    snprintf(text, sizeof text, "{ \"domain\": { \"min\": [-1, -1, -1], \"max\": [1, 1, 1],\n"
             "\"walls\": { \"z\": [\"open\", \"slip\"] } }, \"spacing\": 0.1, \"end_time\": 1,\n%s }", fluid);
    refuse(text, "s.json:2:17: domain.walls.z: ", "is open, which only mlsmpm knows");
    snprintf(text, sizeof text, "{ \"method\": \"mlsmpm\", \"dimension\": 2, \"domain\": { \"min\": [-1, "
           "-1], \"max\": "
             "[1, 1] },\n\"spacing\": 0.1, \"end_time\": 1, \"solids\": [ { \"name\": \"a\",\n\"fill\": [ { "
                    "\"sphere\": "
             "{ \"centre\": [0, 0], \"radius\": 0.5 }, \"spin\": [1, 0, 0] } ] } ] }");
    refuse(text, "s.json:3:68: solids[0].fill[0].spin: ", "must be about z in a 2-D scene");
}

/* Keys that mlsmpm would read past. */
static void useless_keys_are_refused(void **state)
{
    (void)state;
    refuse(make(ball, ",\n\"cfl\": 0.2"), "s.json:7:1: cfl: ", "mlsmpm has its own, mlsmpm.cfl");
    const char plane[] = ", \"planes\": [ { \"point\": [0, 0, -1], \"normal\": [0, 0, 1], \"kind\": \"%s\",\n"
                         "\"friction\": 0.3 } ]";
    char text[512];
    snprintf(text, sizeof text, plane, "slip");
    refuse(make(ball, text), "s.json:7:1: planes[0].friction: ", "kind separate, this one is slip");
    snprintf(text, sizeof text, plane, "no-slip");
    refuse(make(ball, text), "s.json:7:1: planes[0].friction: ", "kind separate, this one is no-slip");
    snprintf(text, sizeof text, plane, "separate");
    tobi_scene_free(parse(make(ball, text)));
    const char domain[] = "{ \"method\": \"mlsmpm\", \"domain\": { \"min\": [-1, -1, -1], "
                          "\"max\": [1, 1, 1],\n\"friction\": 0.3, \"walls\": { \"x\": [\"slip\", "
                          "\"%s\"] } },\n"
                          "\"spacing\": 0.1, \"end_time\": 1, \"solids\": [ { \"name\": \"it\", %s } ] }";
    char scene[1024];
    snprintf(scene, sizeof scene, domain, "no-slip", ball);
    refuse(scene, "s.json:2:1: domain.friction: ", "no side in domain.walls is one");
    snprintf(scene, sizeof scene, domain, "separate", ball);
    tobi_scene_free(parse(scene));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scenes_have_solids),
        cmocka_unit_test(a_long_time_step_is_told),
        cmocka_unit_test(liquids_are_told),
        cmocka_unit_test(bodies_in_solids_are_told),
        cmocka_unit_test(solids_without_particles_are_refused),
        cmocka_unit_test(useless_keys_are_refused),
        cmocka_unit_test(bad_solids_are_refused_in_words),
        cmocka_unit_test(bad_regions_are_refused_in_words),
        cmocka_unit_test(methods_refuse_what_they_do_not_know),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Scenes of the Taichi program: what they become, what is told about them, what is refused. */
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
#include "base/plain.h"
#include "calls.h"
#include "geom/mesh.h"
#include "scene/scene.h"
#include "base/param.h"

#define OLD TOBI_SOURCE_DIR "/test/scenes/taichi/"

static tobi_scene *load(const char *path, const char *const *overrides)
{
    tobi_scene *scene;
    tobi_error err = { 0 };
    tobi_status status = tobi_scene_load(path, overrides, &scene, NULL, &err);
    if (status != TOBI_OK) print_error("%s\n", err.text);
    assert_int_equal(status, TOBI_OK);
    return scene;
}

static tobi_scene *parse(const char *text)
{
    tobi_scene *scene;
    tobi_error err = { 0 };
    tobi_status status =
        tobi_scene_parse("old.json", text, strlen(text), NULL, &scene, NULL, &err);
    if (status != TOBI_OK) print_error("%s\n", err.text);
    assert_int_equal(status, TOBI_OK);
    return scene;
}

static void assert_vector(const double v[3], double x, double y, double z)
{
    assert_true(fabs(v[0] - x) < 1e-12 && fabs(v[1] - y) < 1e-12 && fabs(v[2] - z) < 1e-12);
}

static double param(const tobi_scene *scene, const char *key)
{
    return json_number_value(json_object_get(scene->bodies[0].motion_def[0].params, key));
}

static void the_flying_fish_of_the_users(void **state)
{
    (void)state;
    tobi_scene *scene = load(OLD "fish.json", NULL);
    const tobi_world_def *w = tobi_scene_world_def(scene);
    assert_string_equal(w->method, "dfsph");
    assert_string_equal(tobi_scene_name(scene), "fish");
    assert_vector(w->domain_min, 0, 0, 0);
    assert_vector(w->domain_max, 0.6, 0.3, 0.6);
    assert_vector(w->gravity, 0, 0, -9.81);
    assert_true(w->spacing == 0.004 && w->time_step == 5e-5 && w->end_time == 0.8);
    assert_int_equal(scene->fluid_count, 1);
    assert_true(scene->fluids[0].def.density == 1000 && scene->fluids[0].def.viscosity == 2);
    assert_vector(scene->fluids[0].def.color, 50, 100, 200);
    assert_vector(scene->fluids[0].fills[0].def.box_min, 0.008, 0.008, 0.008);
    assert_vector(scene->fluids[0].fills[0].def.box_max, 0.592, 0.292, 0.19);
    assert_int_equal(scene->body_count, 1);
    const tobi_body_def *fish = &scene->bodies[0].def;
    assert_string_equal(fish->name, "fishbodyWithWing");
    assert_true(fish->spacing == 0.002 && fish->density == 1000 && fish->rotation_angle == 0);
    assert_vector(fish->translation, 0.3, 0.15, 0.24);
    assert_vector(fish->color, 255, 255, 255);
    assert_non_null(strstr(fish->mesh, "flying_fish/meshes/fish.obj"));
    assert_true(param(scene, "lagAngle") == 72 && param(scene, "freq") == 10 &&
                param(scene, "LEPos") == 0.06);
    const json_t *params = scene->bodies[0].motion_def[0].params;
    assert_int_equal(json_array_size(json_object_get(params, "swimmingPosition")), 3);
    const tobi_output_def *o = tobi_scene_output_def(scene);
    assert_true(o->interval == 20*5e-5 && o->frames == 1 && o->ply == 0 && o->obj == 0);
    tobi_scene_free(scene);
}

/* A misspelt mesh must not become the shipped fish in silence. */
static void a_run_notes_the_shipped_fish(void **state)
{
    (void)state;
    const char *overrides[] = { "spacing=0.02", "bodies[0].spacing=0.02", NULL, NULL, NULL };
    for (int right = 0; right < 2; right++) {
        tobi_world *world;
        if (right) overrides[3] = "bodies[0].scale=0.05";
        if (right) overrides[2] = "bodies[0].mesh=" TOBI_SOURCE_DIR "/test/meshes/wedge.obj";
        tobi_scene *scene = load(OLD "fish.json", overrides);
        OK(tobi_scene_build(scene, &world, &err));
        const char *note;
        int found = 0;
        for (int i = 0; (note = tobi_world_note(world, i)); i++)
            found |= strstr(note, "body 'fishbodyWithWing': there is no mesh ") &&
                     strstr(note, "the fish that comes with Tobiuo is taken");
        assert_int_equal(found, !right);
        tobi_world_destroy(world);
        tobi_scene_free(scene);
    }
}

/* A list of numbers becomes a property of several objects, wherever they are. */
static void the_table_tells_what_became_invisible(void **state)
{
    (void)state;
    static const struct { const char *numbers, *says; } cases[] = {
        { "[3, 1]", "-> fluids[1].visible = false, bodies[0].visible = false\n" },
        { "[0]", "-> fluids[0].visible = false\n" },
        { "[9]", "-> nothing\n    no object has one of these numbers\n" },
        { "[]", "-> nothing\n" },
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        char text[1000];
        snprintf(text, sizeof text,
                 "{ \"Configuration\": { \"domainEnd\": [1, 1, 1], \"gravitation\": [0, 0, -9],"
                 " \"particleRadius\": 0.1, \"invisibleObjects\": %s }, \"FluidBlocks\": ["
                 " { \"objectId\": 0, \"start\": [0, 0, 0], \"end\": [0.4, 1, 0.4], \"color\": [0, 0, 9] },"
                 " { \"objectId\": 1, \"start\": [0.6, 0, 0], \"end\": [1, 1, 0.4], \"color\": [9, 0, 0] } ],"
                 " \"RigidBlocks\": [ { \"objectId\": 3, \"start\": [0.4, 0, 0.5], \"end\": [0.6, 1, 0.8],"
                 " \"isDynamic\": false } ] }", cases[i].numbers);
        tobi_scene *scene = parse(text);
        if (!strstr(tobi_scene_import_table(scene), cases[i].says))
            fail_msg("no '%s' in\n%s", cases[i].says, tobi_scene_import_table(scene));
        tobi_scene_free(scene);
    }
}

/* What the table must say, key by key. */
static void the_table_tells_every_key(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "-> spacing = 0.004 m", "-> fluids[0].viscosity = 2.0 Pa s", "2000 times water", "not N/m",
        "boundaryHandlingMethod", "never did anything", "-> output.interval = 0.001 s", "0.002 m2/s",
        "the fish that comes with Tobiuo is taken", "RigidBodies[0].pitchAngle", "lagAngle",
        "-> bodies[0].motion.params.relax = 0.2 s", "Configuration.simulationMethod", "(not given)",
    };
    tobi_scene *scene = load(OLD "fish.json", NULL);
    const char *table = tobi_scene_import_table(scene);
    for (size_t i = 0; i < sizeof lines/sizeof *lines; i++) {
        if (!strstr(table, lines[i])) print_error("no '%s' in\n%s", lines[i], table);
        assert_non_null(strstr(table, lines[i]));
    }
    tobi_scene_free(scene);
    scene = load(TOBI_SOURCE_DIR "/scenes/dam_break/scene.json", NULL);
    assert_null(tobi_scene_import_table(scene));
    tobi_scene_free(scene);
}

static void blocks_with_their_own_values(void **state)
{
    (void)state;
    const char *overrides[] = { "spacing=0.05", "fluids[0].viscosity=0.5", "fluids[1].viscosity=0.5",
                                "fluids[0].name=first", NULL };
    tobi_scene *scene = load(OLD "blocks_y_up.json", overrides);
    assert_true(tobi_scene_world_def(scene)->spacing == 0.05);       /* overrides are native */
    assert_vector(tobi_scene_world_def(scene)->gravity, 0, -9.81, 0);
    assert_int_equal(scene->fluid_count, 2);                         /* one per colour */
    assert_int_equal(scene->fluids[0].fill_count, 2);
    assert_int_equal(scene->fluids[1].fill_count, 1);
    assert_true(scene->fluids[0].def.viscosity == 0.5 && scene->fluids[1].def.viscosity == 0.5);
    assert_string_equal(scene->fluids[0].def.name, "first");
    assert_string_not_equal(scene->fluids[1].def.name, "first");
    const tobi_fill_def *fill = &scene->fluids[0].fills[0].def;
    assert_vector(fill->box_min, 0, 0, 0);
    assert_vector(fill->box_max, 0.2, 0.4, 0.4);
    assert_vector(fill->velocity, 0, -1, 0);
    assert_vector(scene->fluids[1].def.color, 200, 100, 50);
    assert_true(tobi_scene_output_def(scene)->ply == 1);
    tobi_scene_free(scene);
}

static void rigid_blocks_are_boxes(void **state)
{
    (void)state;
    tobi_scene *scene = load(OLD "rigid_blocks.json", NULL);
    tobi_world *world;
    tobi_body_info info;
    const tobi_body_def *body = &scene->bodies[0].def;
    assert_null(body->mesh);
    assert_string_equal(body->name, "block_7");
    assert_vector(body->box_min, 0.55, 0.02, 0.1);
    assert_vector(body->box_max, 0.65, 0.22, 0.3);
    assert_true(body->visible == 0 && body->density == 2000 && body->spacing == 0.02);
    assert_true(scene->fluids[0].def.visible == 1 && scene->output.obj == 1);
    /* viscosity was not given: the old program's own 0.01 m2/s */
    assert_true(fabs(scene->fluids[0].def.viscosity - 10) < 1e-12);
    assert_int_equal(tobi_scene_build(scene, &world, NULL), TOBI_OK);
    assert_int_equal(tobi_world_body(world, 0, &info), TOBI_OK);
    assert_true(fabs(info.volume - 0.1*0.2*0.2) < 1e-12 && fabs(info.mass - 8) < 1e-9);
    assert_true(fabs(info.position[1] - 0.12) < 1e-12);
    tobi_world_destroy(world);
    tobi_scene_free(scene);
}

/* Dynamic bodies are free ones: a box and a mesh fall, the box enters the water. */
static void the_water_moves_dynamic_bodies(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "RigidBodies[0].isDynamic", "-> bodies[0].dynamics = \"free\"", "1000 kg/m3 is taken",
        "-> bodies[1].dynamics = \"free\"", "-> bodies[1].velocity = [0.0, -1.5, 0.0] m/s",
        "of the centre of mass at the start", "-> bodies[1].density = 400.0 kg/m3",
    };
    tobi_scene *scene = load(OLD "falling_box.json", NULL);
    for (size_t i = 0; i < sizeof lines/sizeof *lines; i++)
        assert_non_null(strstr(tobi_scene_import_table(scene), lines[i]));
    assert_null(strstr(tobi_scene_import_table(scene), "never moved by it"));
    assert_int_equal(scene->body_count, 2);
    assert_true(scene->bodies[0].def.dynamics == TOBI_FREE && scene->bodies[1].def.dynamics == TOBI_FREE);
    assert_true(scene->bodies[1].def.density == 400);
    assert_vector(scene->bodies[1].def.velocity, 0, -1.5, 0);
    tobi_world *world;
    tobi_body_info before, after;
    OK(tobi_scene_build(scene, &world, &err));
    OK(tobi_world_start(world, &err));
    OK(tobi_world_body(world, 1, &before));
    for (int i = 0; i < 20; i++) OK(tobi_world_step(world, 0, NULL, &err));
    OK(tobi_world_body(world, 1, &after));
    double fallen = before.position[1] - after.position[1];
    assert_true(fallen > 0.01 && fallen < 0.03);                      /* 0.03 m without the water */
    assert_true(after.velocity[1] > -1.4 && after.velocity[1] < 0);
    OK(tobi_world_body(world, 0, &after));
    assert_true(fabs(after.velocity[1] + 9.81*0.02) < 1e-3);          /* free fall above the water */
    tobi_world_destroy(world);
    tobi_scene_free(scene);
}

static const char body_text[] =
    "{ \"Configuration\": { \"domainEnd\": [9, 9, 9], \"particleRadiusFluid\": 0.25,\n"
    "  \"gravitation\": [0, -9.81, 0] %s },\n"
    "  \"FluidBlocks\": [ { \"start\": [0, 0, 0], \"end\": [9, 1, 9] } ],\n"
    "  \"RigidBodies\": [ { \"objectId\": 3,\n"
    "    \"geometryFile\": \"" TOBI_SOURCE_DIR "/test\\\\meshes/wedge.obj\",\n"
    "    \"translation\": [4, 5, 6], \"scale\": [1, 2, 0.5], \"rotationAxis\": [1, 2, -1], %s } ] }";

static const char *make(const char *configuration, const char *body)
{
    static char text[4096];
    snprintf(text, sizeof text, body_text, configuration, body);
    return text;
}

/* Rodrigues' rotation about the mean of the scaled vertices, then the translation, as the old program did. */
static void turn_as_before(const tobi_mesh *mesh, double angle, int64_t i, double out[3])
{
    const double s[3] = { 1, 2, 0.5 }, t[3] = { 4, 5, 6 }, n = 1/sqrt(6), k[3] = { n, 2*n, -n };
    double c[3] = { 0 }, v[3];
    for (int64_t j = 0; j < mesh->vertex_count; j++)
        for (int a = 0; a < 3; a++) c[a] += s[a]*mesh->vertices[j][a]/(double)mesh->vertex_count;
    for (int a = 0; a < 3; a++) v[a] = s[a]*mesh->vertices[i][a] - c[a];
    double dot = k[0]*v[0] + k[1]*v[1] + k[2]*v[2], co = cos(angle), si = sin(angle);
    for (int a = 0; a < 3; a++) {
        int b = (a + 1)%3, d = (a + 2)%3;
        out[a] = v[a]*co + (k[b]*v[d] - k[d]*v[b])*si + k[a]*dot*(1 - co) + c[a] + t[a];
    }
}

static void a_turn_is_about_the_mean_of_the_vertices(void **state)
{
    (void)state;
    tobi_scene *scene = parse(make("", "\"rotationAngle\": 35"));
    const tobi_body_def *d = &scene->bodies[0].def;
    tobi_mesh raw, placed;
    assert_int_equal(tobi_mesh_read(d->mesh, &raw, NULL), TOBI_OK);
    assert_int_equal(tobi_mesh_copy(&raw, &placed, NULL), TOBI_OK);
    assert_int_equal(tobi_mesh_transform(&placed, d->scale, d->rotation_axis, d->rotation_angle,
                                         d->translation, NULL), TOBI_OK);
    double moved = 0;
    for (int64_t i = 0; i < raw.vertex_count; i++) {
        double expected[3];
        turn_as_before(&raw, 35*3.14159265358979323846/180, i, expected);
        for (int a = 0; a < 3; a++) assert_true(fabs(placed.vertices[i][a] - expected[a]) < 1e-9);
        moved = fmax(moved, fabs(d->translation[0] - 4));
    }
    assert_true(moved > 1e-3);       /* the correction is one */
    tobi_mesh_free(&raw);
    tobi_mesh_free(&placed);
    tobi_scene_free(scene);
}

static void the_clock(void **state)
{
    (void)state;
    tobi_scene *scene = parse(make("", "\"rotationAngle\": 0"));
    assert_true(scene->world.end_time == 5 && scene->world.time_step == 0 && scene->output.interval == 0.01);
    assert_non_null(strstr(tobi_scene_import_table(scene), "5 s are taken"));
    assert_vector(scene->bodies[0].def.translation, 4, 5, 6);
    tobi_scene_free(scene);
    scene = parse(make(", \"timeStepSize\": 0.004, \"numberOfStepsPerRenderUpdate\": 3, \"simEndFrame\": 100,"
                       "\"cameraPosition\": [9, 9, 9], \"cameraFov\": 20", "\"rotationAngle\": 0"));
    assert_true(fabs(scene->world.end_time - 1.2) < 1e-12 && scene->world.time_step == 0.004);
    assert_true(fabs(scene->output.interval - 0.012) < 1e-15 && scene->output.view.angle == 20);
    assert_vector(scene->output.view.look_at, 4.5, 4.5, 4.5);
    tobi_scene_free(scene);
}

/* WCSPH takes the constants of the Tait equation, which DFSPH has not, and moves bodies as well. */
static void the_other_solver(void **state)
{
    (void)state;
    tobi_scene *scene = parse(make(", \"simulationMethod\": 0, \"stiffness\": 40000, \"exponent\": 5",
                                   "\"isDynamic\": true"));
    assert_true(scene->bodies[0].def.dynamics == TOBI_FREE);
    char *resolved = tobi_scene_resolved(scene);
    assert_non_null(strstr(resolved, "\"stiffness\": 40000.0"));
    assert_non_null(strstr(resolved, "\"exponent\": 5.0"));
    free(resolved);
    tobi_scene_free(scene);
}

static void wrapped_comments(void **state)
{
    (void)state;
    tobi_scene *scene = parse("{ \"Configuration\": { \"domainEnd\": [1, 1, 1],   # \xE9\xA0\x98\n"
                              "   false \xE5\x9F\x9F\n\n"
                              "\xE7\xBD\xAE.\n"
                              "  \"particleRadius\": 0.05, \"gravitation\": [0, 0, -9.81] }, # \xE6\xB0\xB4\n"
                              "  \"FluidBlocks\": [ { \"start\": [0, 0, 0], \"end\": [1, 1, 0.5] } ] }\n");
    assert_true(scene->world.spacing == 0.1);
    tobi_scene_free(scene);
}

/* --- mistakes ----------------------------------------------------------------------------- */

static void expect(const char *text, const char *const *overrides, const char *const *lines)
{
    tobi_scene *scene;
    tobi_report *report;
    tobi_error err = { 0 };
    tobi_status status =
        tobi_scene_parse("old.json", text, strlen(text), overrides, &scene, &report, &err);
    assert_int_equal(status, TOBI_INVALID);
    int i = 0;
    for (; lines[i]; i++) {
        const char *line = tobi_report_line(report, i);
        if (!line || !strstr(line, lines[i]))
            print_error("line %d is\n  %s\nwanted\n  %s\n", i, line ? line : "(nothing)", lines[i]);
        assert_true(line && strstr(line, lines[i]));
    }
    if (tobi_report_line(report, i)) print_error("too much: %s\n", tobi_report_line(report, i));
    assert_int_equal(tobi_report_count(report), i);
    tobi_report_free(report);
}
#define EXPECT(text, ...) expect(text, NULL, (const char *const[]){ __VA_ARGS__, NULL })

/* What the old program never read does not keep its scene from running. */
static void other_keys_are_told(void **state)
{
    (void)state;
    tobi_scene *scene = parse(
        "{ \"Configuration\": { \"domainEnd\": [1, 1, 1], \"gravitation\": [0, -9.81, 0],\n"
        "\"particleRadius\": 0.05, \"author\": \"N. N.\" },\n"
        "\"FluidBlocks\": [ { \"start\": [0, 0, 0], \"end\": [1, 1, 0.5], \"remark\": 1 } ] }");
    const char *table = tobi_scene_import_table(scene);
    assert_non_null(strstr(table, "Configuration.author"));
    assert_non_null(strstr(table, "FluidBlocks[0].remark"));
    assert_non_null(strstr(table, "not known: the Taichi program passes over it"));
    tobi_scene_free(scene);
}

static void mistakes_of_the_configuration(void **state)
{
    (void)state;
    EXPECT("{ \"Configuration\": { } }",
           "old.json:1:1: FluidBlocks: is missing or empty",
           "old.json:1:20: Configuration.domainEnd: is missing",
           "old.json:1:20: Configuration.gravitation: is missing",
           "old.json:1:20: Configuration.particleRadius: is missing");
    EXPECT("{ \"Configuration\": 3, \"FluidBlocks\": { }, \"RigidBodys\": [],\n"
           " \"Emitters\": [], \"FluidBodies\": [], \"weather\": 1 }",
           "Configuration: is a number, must be an object", "particleRadius: is missing",
           "FluidBlocks: is an object, must be a list", "did you mean \"RigidBodies\"?",
           "Emitters: emitters, which add fluid", "FluidBodies: water in the shape of a mesh",
           "weather: unknown key; a scene of the Taichi program has");
    EXPECT("{ \"Configuration\": { \"domainEnd\": [1, 1, 1], \"gravitation\": [0, 0, 0],\n"
           "\"particleRadius\": 0.1, \"particleRadiusFLuid\": 0.1, \"simulationMethod\": 3,\n"
           "\"invisibleObjects\": [1, \"fish\"], \"densty0\": 1, \"exportPly\": 1, \"viscosity\": -1 },\n"
           "\"FluidBlocks\": [ { \"start\": [0, 0, 0], \"end\": [1, 1, 1], \"colr\": [0, 0, 0] } ] }",
           "old.json:2:47: Configuration.particleRadiusFLuid: says the same as particleRadius",
           "old.json:2:72: Configuration.simulationMethod: is 3; there are 0 (WCSPH) and 4 (DFSPH)",
           "Configuration.invisibleObjects[1]: is a text, must be an objectId",
           "Configuration.densty0: unknown key; did you mean \"density0\"?",
           "Configuration.exportPly: is a number, must be true or false",
           "Configuration.viscosity: is -1, allowed is at least 0 m2/s",
           "FluidBlocks[0].colr: unknown key; did you mean \"color\"?");
    EXPECT("{ \"Configuration\": { \"domainEnd\": [1, 1, 1], \"gravitation\": [0, 0, 0],\n"
           "\"particleRadius\": 0.1, \"invisibleObjects\": 3 }, \"FluidBlocks\": [] }",
           "Configuration.invisibleObjects: is a number, must be a list", "FluidBlocks: is missing or empty");
}

static void blocks_of_another_material(void **state)
{
    (void)state;
    EXPECT("{ \"Configuration\": { \"domainEnd\": [1, 1, 1], \"gravitation\": [0, 0, 0],\n"
           "\"particleRadius\": 0.1 },\n"
           "\"FluidBlocks\": [ { \"start\": [0, 0, 0], \"end\": [0.4, 1, 1] },\n"
           "  { \"start\": [0.6, 0, 0], \"end\": [1, 1, 1], \"density\": 80 } ] }",
           "old.json:4:56: FluidBlocks[1].density (here fluids[1].density): is 80 kg/m3 and that of "
           "fluid 'fluid_0' is 1000 kg/m3: 1 : 12.5; dfsph computes fluids up to 1 : 10");
}

static void mistakes_of_bodies(void **state)
{
    (void)state;
    EXPECT(make("", "\"fishLength\": 0.2, \"fishWidth\": 0.1, \"LEPos\": 0.1, \"wingspan\": 0.1,\n"
                    "\"wingchord\": 1, \"waveLength\": 1, \"freq\": 1, \"amplitude\": 1, \"relax\": 1,\n"
                    "\"startPosition\": [0, 0, 0], \"swimmingPosition\": [0, 0, 0], \"pitchAngle\": 3,\n"
                    "\"isDynamic\": true"),
           "RigidBodies[0].isDynamic: is true, but the keys from fishLength to pitchAngle say how");
    EXPECT(make("", "\"fishLength\": 0.2, \"fishWidth\": 0.1, \"LEPos\": 0.1, \"wingspan\": 0.1,\n"
                    "\"wingchord\": 1, \"waveLength\": 1, \"freq\": 1, \"amplitude\": 1, \"relax\": 1,\n"
                    "\"startPosition\": [0, 0, 0], \"pitchAngle\": 3"),
           "RigidBodies[0].swimmingPosition: is missing: a swimming fish needs all of its keys");
    EXPECT(make("", "\"rotationAngle\": \"x\", \"density\": 0"),
           "RigidBodies[0].rotationAngle: is the text \"x\"",
           "RigidBodies[0].density: is 0, allowed is greater than 0");
    EXPECT("{ \"Configuration\": { \"domainEnd\": [1, 1, 1], \"gravitation\": [0, 0, 0],\n"
           "\"particleRadius\": 0.1, \"simulationMethod\": 0 },\n"
           "\"FluidBlocks\": [ { \"start\": [0, 0, 0], \"end\": [1, 1, 1] } ],\n"
           "\"RigidBodies\": [ { }, { \"geometryFile\": \"\" }, { \"geometryFile\": 3 } ],\n"
           "\"RigidBlocks\": [ { \"start\": [0, 0, 0], \"end\": [1, 1, 1] } ] }",
           "RigidBodies[0].geometryFile: is missing", "RigidBodies[1].geometryFile: is empty",
           "RigidBodies[2].geometryFile: is a number");
}

/* Found in the native scene, told at the old key. */
static void later_mistakes(void **state)
{
    (void)state;
    static const char text[] =
        "{ \"Configuration\": { \"domainEnd\": [1, 1, 1], \"gravitation\": [0, 0, -9],\n"
        "\"particleRadius\": 0.1, \"timeStepSize\": 1e-9 },\n"
        "\"FluidBlocks\": [ { \"start\": [0, 0, 0], \"end\": [1, 1, 2] },\n"
        " { \"start\": [0, 0, 0], \"end\": [0.5, 0, 1], \"color\": [1, 2, 3] } ],\n"
        "\"RigidBodies\": [ { \"geometryFile\": \"nowhere/at_all.obj\" } ],\n"
        "\"RigidBlocks\": [ { \"start\": [0, 0, 0], \"end\": [1, 0, 1] } ] }";
    EXPECT(text, "output.interval): is 1e-09 s and makes more than",
           "(here time_step): is 1e-09 s and makes 5e+09 steps until end_time, 5 s; allowed are up to",
           "old.json:3:18: FluidBlocks[0] (here fluids[0].fill[0].box): reaches from 0 to 2 m in z",
           "old.json:4:2: FluidBlocks[1] (here fluids[1].fill[0].box): min is 0 and max is 0 in y",
           "old.json:5:36: RigidBodies[0].geometryFile (here bodies[0].mesh): cannot find",
           "old.json:6:18: RigidBlocks[0] (here bodies[1].box): min is 0 and max is 0 in y");
    const char *overrides[] = { "spacing=-1", "fluids[0].colr=3", NULL };
    expect("{ \"Configuration\": { \"domainEnd\": [1, 1, 1], \"gravitation\": [0, 0, -9],\n"
           "\"particleRadius\": 0.1 }, \"FluidBlocks\": [ { \"start\": [0, 0, 0], \"end\": [1, 1, 1] } ] }",
           overrides, (const char *const[]){ "--set spacing=-1: spacing: is -1",
                                             "--set fluids[0].colr=3: fluids[0].colr: unknown key", NULL });
}

static void a_tail_that_is_not_clear(void **state)
{
    (void)state;
    EXPECT("{ \"Configuration\": { \"domainEnd\": [1, 1, 1],\n  \xE5\x9F\x9F\n } }",
           "if this line belongs to the comment before it, put # in front");
    EXPECT("{ \"domain\": { # \xE9\xA0\x98\n \xE5\x9F\x9F\n } }",
           "if this line belongs to the comment before it, put # in front");
    EXPECT("{ \"Configuration\": { \"domainEnd\": [1, 1, 1], # \xE5\x9F\x9F\n"
           "  \xE5\x9F\x9F \"density0\": 1 } }",
           "not valid JSON");
}

/* --- the written scene -------------------------------------------------------------------- */

static void a_written_scene_is_the_same(void **state)
{
    (void)state;
    static const char *const names[] = { OLD "fish.json", OLD "blocks_y_up.json", OLD "rigid_blocks.json" };
    char folder[] = "/tmp/tobi_import_XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/new.json", folder);
    for (int i = 0; i < 3; i++) {
        char *table;
        tobi_error err = { 0 };
        tobi_status status = tobi_scene_import(names[i], path, i > 0, &table, NULL, &err);
        if (status != TOBI_OK) print_error("%s\n", err.text);
        assert_int_equal(status, TOBI_OK);
        assert_non_null(strstr(table, "Configuration.domainEnd"));
        assert_int_equal(i == 0, strstr(table, "flying_fish/motion.lua. To move the new scene") != NULL);
        free(table);
        tobi_scene *old = load(names[i], NULL), *new = load(path, NULL);
        assert_null(tobi_scene_import_table(new));
        char *a = tobi_scene_resolved(old), *b = tobi_scene_resolved(new);
        assert_string_equal(a, b);
        free(a);
        free(b);
        tobi_scene_free(old);
        tobi_scene_free(new);
    }
    char *table;
    tobi_error err = { 0 };
    assert_int_equal(tobi_scene_import(names[0], path, 0, &table, NULL, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "exists; nothing was changed"));
    assert_int_equal(tobi_scene_import(path, path, 1, &table, NULL, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "native scene already"));
    assert_int_equal(tobi_scene_import("nowhere.json", path, 1, &table, NULL, &err), TOBI_NOT_FOUND);
    assert_int_equal(tobi_scene_import(names[0], "/nowhere/new.json", 1, &table, NULL, &err), TOBI_IO);
    assert_null(table);
    unlink(path);
    assert_int_equal(symlink(names[0], path), 0);      /* which is never written through */
    assert_int_equal(tobi_scene_import(names[0], path, 1, &table, NULL, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "is what the scene is read from; choose another name"));
    unlink(path);
    rmdir(folder);
}

/* A scene and its mesh may move together: nothing in the new file names the folder they lie in. */
static void paths_below_the_new_scene_are_relative(void **state)
{
    (void)state;
    char folder[] = "/tmp/tobi_import_XXXXXX", old[64], mesh[64], new[64];
    static const char scene[] =
        "{ \"Configuration\": { \"domainEnd\": [3, 3, 3], \"particleRadius\": 0.1,\n"
        "  \"gravitation\": [0, 0, -9] },\n"
        "\"FluidBlocks\": [ { \"start\": [0, 0, 0], \"end\": [1, 1, 1] } ],\n"
        "\"RigidBodies\": [ { \"objectId\": 1, \"geometryFile\": \"wedge.obj\",\n"
        "  \"translation\": [1.5, 1.5, 1.5] } ] }";
    assert_non_null(mkdtemp(folder));
    snprintf(old, sizeof old, "%s/old.json", folder);
    snprintf(new, sizeof new, "%s/new.json", folder);
    snprintf(mesh, sizeof mesh, "%s/wedge.obj", folder);
    FILE *file = fopen(old, "w");
    assert_non_null(file);
    fputs(scene, file);
    fclose(file);
    char *table, *text;
    size_t size;
    OK(tobi_plain_read(TOBI_SOURCE_DIR "/test/meshes/wedge.obj", "mesh", 0, &text, &size, &err));
    file = fopen(mesh, "w");
    assert_non_null(file);
    assert_true(fwrite(text, 1, size, file) == size && fclose(file) == 0);
    free(text);
    OK(tobi_scene_import(old, new, 0, &table, NULL, &err));
    assert_non_null(strstr(table, "-> bodies[0].mesh = \"wedge.obj\"\n"));
    OK(tobi_plain_read(new, "scene", 0, &text, &size, &err));
    assert_non_null(strstr(text, "-> bodies[0].mesh = \"wedge.obj\"\n"));
    assert_null(strstr(text, folder));
    assert_null(strstr(table, "Absolute path"));
    tobi_scene_free(load(new, NULL));
    free(text);
    free(table);
    unlink(old);
    unlink(new);
    unlink(mesh);
    assert_int_equal(rmdir(folder), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_flying_fish_of_the_users),
        cmocka_unit_test(a_run_notes_the_shipped_fish),
        cmocka_unit_test(the_table_tells_every_key),
        cmocka_unit_test(the_table_tells_what_became_invisible),
        cmocka_unit_test(blocks_with_their_own_values),
        cmocka_unit_test(rigid_blocks_are_boxes),
        cmocka_unit_test(the_water_moves_dynamic_bodies),
        cmocka_unit_test(a_turn_is_about_the_mean_of_the_vertices),
        cmocka_unit_test(the_clock),
        cmocka_unit_test(the_other_solver),
        cmocka_unit_test(wrapped_comments),
        cmocka_unit_test(other_keys_are_told),
        cmocka_unit_test(mistakes_of_the_configuration),
        cmocka_unit_test(blocks_of_another_material),
        cmocka_unit_test(mistakes_of_bodies),
        cmocka_unit_test(later_mistakes),
        cmocka_unit_test(a_tail_that_is_not_clear),
        cmocka_unit_test(a_written_scene_is_the_same),
        cmocka_unit_test(paths_below_the_new_scene_are_relative),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Keys that nothing would read: told with their place, taken where they count, left out of resolved.json. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scene/scene.h"

/* A scene of a method with a body; further lines of the world, of the domain, of the body, of the fluid or
   solid. */
typedef struct lines { const char *method, *world, *domain, *body, *matter; } lines;

static void make(const lines *l, char *text, size_t size)
{
    const int solids = strcmp(l->method, "mlsmpm") == 0;
    snprintf(text, size,
             "{ \"method\": \"%s\", \"spacing\": 0.1, \"end_time\": 1, %s\n"
             "\"domain\": { \"min\": [0, 0, 0], \"max\": [2, 2, 2]%s,\n"
             "\"walls\": { \"x\": \"separate\" } },\n"
             "\"%s\": [ { \"name\": \"a\"%s, \"fill\": [ { \"sphere\": { \"centre\": [1, 1, 1], "
             "\"radius\": 0.3 } } ] } ],\n"
             "\"bodies\": [ { \"name\": \"b\", \"box\": { \"min\": [1.5,1,1], \"max\": [2,2,2] }%s } ] }\n",
             l->method, l->world, l->domain, solids ? "solids" : "fluids",
             l->matter, l->body);
}

static int has_key(const char *resolved, const char *key)
{
    char quoted[60];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    return strstr(resolved, quoted) != NULL;
}

/* Parses; the first mistake, or "" and whether resolved.json has the key. Both texts are the caller's. */
static char *first_mistake(const lines *l, const char *key, int *resolved)
{
    char text[2000], *line, *again;
    tobi_scene *scene, *second;
    tobi_report *report = NULL;
    tobi_error err = { 0 };
    make(l, text, sizeof text);
    if (tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, &report, &err) != TOBI_OK) {
        line = strdup(tobi_report_line(report, 0));
        assert_int_equal(tobi_report_count(report), 1);
        tobi_report_free(report);
        return line;
    }
    again = tobi_scene_resolved(scene);
    *resolved = has_key(again, key);
    if (tobi_scene_parse("r.json", again, strlen(again), NULL, &second, NULL, &err) != TOBI_OK)
        fail_msg("resolved.json is refused: %s", err.text);
    tobi_scene_free(second);
    tobi_scene_free(scene);
    free(again);
    return strdup("");
}

typedef struct row { const char *key; lines bad, good; const char *place, *why; } row;

#define FREE ", \"dynamics\": \"free\""
#define IN_WORLD(text, bad, good) { bad, text, "", "", "" }, { good, text, "", "", "" }
#define IN_DOMAIN(text, bad, good) { bad, "", text, "", "" }, { good, "", text, "", "" }
#define IN_BODY(text, bad, good) { bad, "", "", text, "" }, { good, "", "", text, "" }
#define MOVES(key_, value) \
    { key_, { "mlsmpm", "", "", ", \"" key_ "\": " value, "" },               \
      { "mlsmpm", "", "", FREE ", \"" key_ "\": " value, "" },                \
      "s.json:5:", "bodies[0]." key_ ": is for free and controlled bodies, this one is prescribed" }
#define CUTS(key_, value) \
    { key_, { "mlsmpm", "", "", ", \"" key_ "\": " value, "" },                                              \
      { "mlsmpm", "", "", ", \"blade\": true, \"" key_ "\": " value, "" }, "s.json:5:",  \
      "bodies[0]." key_ ": is for a blade, which this body is not" }
#define MAKER(table, waves) ", \"motion\": { \"" table "\": { \"depth\": 1, " waves " } }"
#define WAVES(key_, table, path, bad, good, why) \
    { key_, { "dfsph", "", "", MAKER(table, bad), "" }, \
      { "dfsph", "", "", MAKER(table, good), "" }, "s.json:5:", \
      "bodies[0].motion." table "." path ": " why }
#define SWELL "\"regular\": { \"height\": 0.1, \"period\": 2 }"
#define SEA(more) "\"irregular\": { \"height\": 0.1, \"peak_period\": 2" more " }"
#define CREST "\"solitary\": { \"height\": 0.1 }"
#define SAND ", \"model\": \"sand\""
#define RISES(key_, value) \
    { key_, { "mlsmpm", "", "", "", SAND ", \"" key_ "\": " value },                                     \
      { "mlsmpm", "", "", "", SAND ", \"friction_rise\": 0.2, \"" key_ "\": " value }, "s.json:4:",     \
      "solids[0]." key_ ": is for a friction_rise, which this solid has not" }

static const row rows[] = {
    { "cfl", IN_WORLD("\n\"cfl\": 0.2,", "mlsmpm", "wcsph"), "s.json:2:1: cfl: ", "mlsmpm has its own" },
    { "implicit_viscosity", IN_WORLD("\n\"implicit_viscosity\": true,", "mlsmpm", "wcsph"),
      "s.json:2:1: implicit_viscosity: ", "is for liquids of the SPH methods" },
    { "contact_angle", IN_DOMAIN(", \"contact_angle\": 60", "mlsmpm", "dfsph"), "s.json:2:",
      "domain.contact_angle: is for liquids of the SPH methods" },
    { "nothing", IN_DOMAIN(", \"friction\": 0.5", "dfsph", "mlsmpm"), "s.json:2:",
      "domain.friction: is for solids of mlsmpm" },
    { "nothing", IN_BODY(", \"friction\": \"no-slip\"", "mlsmpm", "dfsph"), "s.json:5:",
      "bodies[0].friction: is for liquids of the SPH methods" },
    { "contact_angle", IN_BODY(", \"contact_angle\": 60", "mlsmpm", "wcsph"), "s.json:5:",
      "bodies[0].contact_angle: is for liquids of the SPH methods" },
    { "flip", { "mlsmpm", "\"mlsmpm\": {\n\"flip\": 0.9 },", "", "", "" },
      { "mlsmpm", "\"mlsmpm\": { \"transfer\": \"flip\", \"flip\": 0.9 },", "", "", "" },
      "s.json:2:1: mlsmpm.flip: ", "is for \"transfer\": \"flip\"" },
    { "xpic_order", { "mlsmpm", "\"mlsmpm\": {\n\"xpic_order\": 3 },", "", "", "" },
      { "mlsmpm", "\"mlsmpm\": { \"transfer\": \"xpic\", \"xpic_order\": 3 },", "", "", "" },
      "s.json:2:1: mlsmpm.xpic_order: ", "is for \"transfer\": \"xpic\"" },
    { "restart", { "isph", "\"isph\": {\n\"restart\": 9 },", "", "", "" },
      { "isph", "\"isph\": { \"solver\": \"gmres\", \"restart\": 9 },", "", "", "" },
      "s.json:2:1: isph.restart: ", "is for \"solver\": \"gmres\"" },
    { "iteration", { "eisph", "\"eisph\": {\n\"iteration\": \"pseudo-time\" },", "", "", "" },
      { "eisph", "\"eisph\": { \"iteration\": \"pseudo-time\", \"sweeps\": 0 },", "", "", "" },
      "s.json:2:1: eisph.iteration: ", "one sweep of that is one of jacobi" },
    MOVES("velocity", "[1, 0, 0]"), MOVES("angular_velocity", "[1, 0, 0]"), MOVES("force", "[1, 0, 0]"),
    MOVES("torque", "[1, 0, 0]"), MOVES("air_resistance", "1"), MOVES("locked", "\"x\""),
    CUTS("edge_resistance", "200"), CUTS("edge_angle", "50"), CUTS("edge_start", "[1, 1, 1]"),
    CUTS("edge_end", "[1, 1, 1]"), RISES("grain_diameter", "1e-4"), RISES("inertial_number", "0.3"),
    { "open_side", { "dfsph", "", "", ", \"open_side\": [0, 0, 1]", "" },
      { "dfsph", "", "", ", \"vessel\": true, \"open_side\": [0, 0, 1]", "" }, "s.json:5:",
      "bodies[0].open_side: is for a vessel, which this body is not" },
    { "density", { "dfsph", "", "", ", \"density\": 500, \"mass\": 3", "" },
      { "dfsph", "", "", ", \"mass\": 3", "" }, "s.json:5:",
      "bodies[0].density: is given beside mass; one of them is enough" },
    { "wall_thickness", { "dfsph", "", "", ", \"wall_thickness\": 0.1", "" },
      { "dfsph", "", "", ", \"vessel\": true, \"wall_thickness\": 0.1", "" }, "s.json:5:",
      "bodies[0].wall_thickness: is for a vessel, which this body is not" },
    { "friction_angle", { "mlsmpm", "", "", "", ", \"friction_angle\": 20" },
      { "mlsmpm", "", "", "", SAND ", \"friction_angle\": 20" }, "s.json:4:",
      "solids[0].friction_angle: is for a strength, which this solid has not" },
    WAVES("peakedness", "piston", "irregular.peakedness",
          SEA(", \"spectrum\": \"pierson-moskowitz\", \"peakedness\": 2"), SEA(", \"peakedness\": 2"),
          "is for irregular waves of the spectrum jonswap"),
    WAVES("components", "piston", "irregular.components", SWELL ", \"irregular\": { \"components\": 9 }",
          SEA(", \"components\": 9"), "is for irregular waves"),
    WAVES("phase", "flap", "regular.phase", "\"hinge\": [1, 1, 0], \"regular\": { \"phase\": 9 }, " SEA(""),
          "\"hinge\": [1, 1, 0], \"regular\": { \"height\": 0.1, \"period\": 2, \"phase\": 9 }",
          "is for regular waves, which have a regular.height"),
    WAVES("ramp", "piston", "ramp", CREST ", \"ramp\": 1", SWELL ", \"ramp\": 1",
          "is for waves that go on; a solitary wave rises by itself"),
    WAVES("start", "piston", "start", "\"absorb\": true, \"start\": 1", CREST ", \"start\": 1",
          "is for waves of its own"),
};

static void test_keys(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof rows/sizeof *rows; k++) {
        const row *r = &rows[k];
        int resolved = 0;
        char *line = first_mistake(&r->bad, r->key, &resolved);
        if (strncmp(line, r->place, strlen(r->place)) != 0 || !strstr(line, r->why))
            fail_msg("%s: '%s' instead of '%s ... %s'", r->key, line, r->place, r->why);
        free(line);
        line = first_mistake(&r->good, r->key, &resolved);
        if (line[0]) fail_msg("%s is refused where it counts: %s", r->key, line);
        if (strcmp(r->key, "nothing") != 0 && !resolved) fail_msg("resolved.json lacks %s", r->key);
        free(line);
    }
}

/* With its defaults alone a scene resolves to what no check refuses, and to nothing unread. */
static void test_resolved(void **state)
{
    (void)state;
    static const struct { const char *method, *key; int has; } resolved[] = {
        { "mlsmpm", "contact_angle", 0 }, { "dfsph", "contact_angle", 1 }, { "mlsmpm", "flip", 0 },
        { "mlsmpm", "locked", 0 },        { "mlsmpm", "edge_angle", 0 },   { "wcsph", "restitution", 1 },
        { "dfsph", "restitution", 1 },    { "mlsmpm", "velocity", 1 },     /* of the fill */
        { "mlsmpm", "angular_velocity", 0 }, { "mlsmpm", "friction_angle", 0 },
    };
    for (size_t k = 0; k < sizeof resolved/sizeof *resolved; k++) {
        const lines plain = { resolved[k].method, "", "", "", "" };
        int has = 0;
        char *line = first_mistake(&plain, resolved[k].key, &has);
        assert_string_equal(line, "");
        if (has != resolved[k].has) fail_msg("%s, %s: %d", resolved[k].method, resolved[k].key, has);
        free(line);
    }
}

/* Sections of other methods wait for another run; a wrong value comes first. */
static void test_what_is_let_be(void **state)
{
    (void)state;
    const lines waits = { "dfsph", "\"mlsmpm\": { \"flip\": 0.9 },", "", "", "" };
    const lines wrong = { "mlsmpm", "", "", ", \"dynamics\": \"fre\", \"velocity\": [1, 0, 0]", "" };
    int unused;
    char *line = first_mistake(&waits, "x", &unused);
    assert_string_equal(line, "");
    free(line);
    line = first_mistake(&wrong, "x", &unused);
    assert_non_null(strstr(line, "bodies[0].dynamics"));
    free(line);
}

/* A camera without an angle stands nowhere: the view fits the domain. A slice needs a plane. */
static void test_views(void **state)
{
    (void)state;
    static const struct { const char *output, *told; } cases[] = {
        { "\"camera\": { \"position\": [1, 2, 3] }", "output.camera.position: is for a camera.angle" },
        { "\"camera\": { \"look_at\": [1, 2, 3] }", "output.camera.look_at: is for a camera.angle" },
        { "\"picture\": { \"slice\": 0.1 }",
          "output.picture.slice: is for a picture.clip_normal; without one nothing is cut off" },
        { "\"picture\": { \"clip_point\": [1, 2, 3] }",
          "output.picture.clip_point: is for a picture.clip_normal" },
        { "\"picture\": { \"min\": 5 }", "output.picture.min: picture.min 5 is not below picture.max 0" },
        { "\"picture\": { \"max\": -5 }", "output.picture.max: picture.min 0 is not below picture.max -5" },
        { "\"picture\": { \"min\": -5 }", "" },
        { "\"views\": [ { \"name\": \"v\", \"camera\": { \"position\": [1, 2, 3] } } ]",
          "output.views[0].camera.position: is for a camera.angle; without one the view fits the domain" },
        { "\"camera\": { \"position\": [1, 2, 3], \"angle\": 30 }", "" },
    };
    for (size_t k = 0; k < sizeof cases/sizeof *cases; k++) {
        char world[200];
        int unused;
        snprintf(world, sizeof world, "\"output\": { %s },", cases[k].output);
        const lines l = { "dfsph", world, "", "", "" };
        char *line = first_mistake(&l, "position", &unused);
        if (cases[k].told[0] ? !strstr(line, cases[k].told) : line[0]) fail_msg("case %zu: %s", k, line);
        free(line);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_keys), cmocka_unit_test(test_resolved), cmocka_unit_test(test_what_is_let_be),
        cmocka_unit_test(test_views),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Bad scenes: every class of mistake with its place, all at once, and input made to break the reader. */
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

static tobi_report *fail_text(const char *text, size_t size, const char *const *overrides)
{
    tobi_scene *scene;
    tobi_report *report;
    tobi_error err = { 0 };
    tobi_status status = tobi_scene_parse("s.json", text, size, overrides, &scene, &report, &err);
    assert_int_equal(status, TOBI_INVALID);
    assert_int_equal(err.status, TOBI_INVALID);
    assert_null(scene);
    assert_non_null(report);
    assert_true(tobi_report_count(report) > 0);
    assert_true(strncmp(err.text, tobi_report_line(report, 0), 200) == 0 || strchr(err.text, '\n'));
    return report;
}

/* Checks the lines of a report in order: each must begin with the first and contain the second text. */
typedef struct expected { const char *begin, *contains; } expected;

static void check_report(const char *text, const char *const *overrides, const expected *lines,
                         int count)
{
    tobi_report *report = fail_text(text, strlen(text), overrides);
    for (int i = 0; i < tobi_report_count(report); i++) {
        const char *line = tobi_report_line(report, i);
        if (i < count && strncmp(line, lines[i].begin, strlen(lines[i].begin)) == 0 &&
            strstr(line, lines[i].contains)) continue;
        print_error("line %d is\n  %s\nexpected\n  %s ... %s\n", i, line,
                    i < count ? lines[i].begin : "(nothing)", i < count ? lines[i].contains : "");
        fail();
    }
    assert_int_equal(tobi_report_count(report), count);
    tobi_report_free(report);
}

#define CHECK(text, ...)                                                          \
    do {                                                                          \
        const expected lines_[] = { __VA_ARGS__ };                                \
        check_report(text, NULL, lines_, (int)(sizeof lines_/sizeof lines_[0]));  \
    } while (0)

/* A scene with holes: %s inside the object of the world, of the fluid, and after the fluids. */
static char *make(const char *world, const char *fluid, const char *rest)
{
    static char text[4096];
    snprintf(text, sizeof text,
             "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"end_time\": 1,\n"
             "%s\n"
             "\"fluids\": [ { \"name\": \"water\",\n"
             "%s\n"
             "} ]\n"
             "%s }", world, fluid, rest);
    return text;
}

static const char spacing[] = "\"spacing\": 0.1,";
static const char box[] = "\"fill\": [ { \"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 0.5] } } ]";

static void unknown_keys(void **state)
{
    (void)state;
    CHECK(make("\"spacng\": 0.1, \"spacing\": 0.1, \"colour_of_sky\": 1,", box, ""),
          { "s.json:2:1: spacng: ", "unknown key; did you mean \"spacing\"?" },
          { "s.json:2:32: colour_of_sky: ", "allowed here: method, dimension, domain, gravity" });
    CHECK(make(spacing,
               "\"Viscosity \": 1, \"viscocity\": 2, \"fill\": [ { \"box\": { \"min\": [0,0,0],\n"
               "  \"max\": [1,1,0.5], \"centre\": 1 }, \"velcoity\": [0,0,0] } ]",
               ""),
          { "s.json:4:1: fluids[0].Viscosity : ", "did you mean \"viscosity\"" },
          { "s.json:4:18: fluids[0].viscocity: ", "did you mean \"viscosity\"" },
          { "s.json:5:21: fluids[0].fill[0].box.centre: ", "allowed here: min, max" },
          { "s.json:5:36: fluids[0].fill[0].velcoity: ", "did you mean \"velocity\"" });
    CHECK(make(spacing, box, ",\"eisph\": { \"filter\": 1 }, \"isph\": { \"sweeps\": 3 }"),
          { "s.json:6:13: eisph.filter: ", "to dfsph (filter), wcsph (filter), isph (filter); allowed" },
          { "s.json:6:38: isph.sweeps: ", "it belongs to eisph (sweeps); allowed" });
    CHECK(make(spacing, box, ",\"dfsph\": { \"suport\": 3 }, \"domain.min\": 3"),
          { "s.json:6:13: dfsph.suport: ", "did you mean \"support\"" },
          { "s.json:6:28: domain.min: ", "unknown key" });
    CHECK(make("\"spacing\": 0.1, \"walls\": 1, \"interv\": 1, \"interval\": 1, \"refer\": [],", box, ""),
          { "s.json:2:17: walls: ", "unknown key; it belongs to the top level (domain.walls); allowed" },
          { "s.json:2:29: interv: ", "unknown key; allowed" },
          { "s.json:2:42: interval: ", "it belongs to output (interval); allowed here: method" },
          { "s.json:2:57: refer: ", "did you mean \"references\"" });
}

static void wrong_types(void **state)
{
    (void)state;
    CHECK(
        make("\"spacing\": \"0.1\",", box,
             ",\n\"gravity\": 9.81, \"threads\": 1.5, \"time_step\": \"adaptiv\",\n"
             "\"dfsph\": [], \"output\": { \"surfaces\": 1, \"fields\": { }, \"compression\": 3 }"),
        { "s.json:2:12: spacing: ", "is the text \"0.1\", must be a number (1e-7 to 1e5 m)" },
        { "s.json:7:12: gravity: ", "is a number, must be a list of 3 numbers" },
        { "s.json:7:29: threads: ", "must be a whole number (0 to 4096, or \"all\")" },
        { "s.json:7:47: time_step: ",
          "is the text \"adaptiv\", must be a number (1e-12 to 1e9 s, or \"adaptive\")" },
        { "s.json:8:10: dfsph: ", "is a list, must be an object" },
        { "s.json:8:38: output.surfaces: ", "is a number, must be true or false" },
        { "s.json:8:51: output.fields: ", "is an object, must be a list of names" },
        { "s.json:8:71: output.compression: ",
          "is a number, allowed is none, zlib, lz4 or ascii" });
    CHECK(make("\"spacing\": 0.1, \"gravity\": [0, 0],", "\"fill\": { }", ", \"bodies\": 3"),
          { "s.json:2:28: gravity: ", "has 2 entries, must be a list of 3 numbers" },
          { "s.json:4:9: fluids[0].fill: ", "is an object, must be a list" },
          { "s.json:6:13: bodies: ", "is a number, must be a list" });
    CHECK(make("\"spacing\": 0.1, \"gravity\": [0, \"x\", null],", box, ", \"method\": true"),
          { "s.json:2:32: gravity[1]: ", "is the text \"x\", must be a number" },
          { "s.json:2:37: gravity[2]: ", "is null, must be a number" },
          { "s.json:6:13: method: ", "is true or false, must be a name" });
}

static void values_out_of_range(void **state)
{
    (void)state;
    CHECK(
        make(
            "\"spacing\": -0.1,",
            "\"density\": 0, \"viscosity\": -1e-3,\n"
            "\"fill\": [ { \"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 0.5] } } ]",
            ", \"dfsph\": { \"support\": 9, \"kernel\": \"cubic\", \"density_iterations_min\": 5,\n"
            "\"density_iterations_max\": 4 }, \"dimension\": 4, \"cfl\": 1e300"),
        { "s.json:2:12: spacing: ", "is -0.1, allowed is 1e-7 to 1e5 m" },
        { "s.json:4:12: fluids[0].density: ", "is 0, allowed is 1e-6 to 1e9 kg/m3" },
        { "s.json:4:28: fluids[0].viscosity: ", "is -0.001, allowed is 0 to 1e9 Pa s" },
        { "s.json:7:25: dfsph.support: ", "is 9, allowed is 2 to 4 spacings" },
        { "s.json:7:38: dfsph.kernel: ", "is \"cubic\", allowed is wendland-c2, cubic-spline" },
        { "s.json:7:73: dfsph.density_iterations_min: ",
          "must not be above density_iterations_max, 4" },
        { "s.json:8:45: dimension: ", "is 4, allowed is 2 to 3" },
        { "s.json:8:55: cfl: ", "is 1e+300, allowed is 1e-4 to 1" });
}

static void missing_keys(void **state)
{
    (void)state;
    CHECK("{ }",
          { "s.json:1:1: domain.min: is missing", "Lower corner" },
          { "s.json:1:1: domain.max: is missing", "" },
          { "s.json:1:1: spacing: is missing (1e-7 to 1e5 m)", "" },
          { "s.json:1:1: end_time: is missing (0 to 1e9 s)", "" },
          { "s.json:1:1: fluids: is missing or empty", "" });
    CHECK("{ \"domain\": {\n \"min\": [0,0,0] }, \"spacing\": 1, \"end_time\": 1,\n"
          " \"fluids\": [ { }, 3 ],\n"
          " \"bodies\": [ { \"motion\": { } } ] }",
          { "s.json:1:13: domain.max: is missing", "Upper corner" },
          { "s.json:3:14: fluids[0].name: is missing", "" },
          { "s.json:3:14: fluids[0].fill: is missing or empty", "" },
          { "s.json:3:19: fluids[1]: is a number, must be an object", "" },
          { "s.json:4:14: bodies[0].name: is missing", "" },
          { "s.json:4:14: bodies[0]: ", "knife, outline and terrain; it has none" },
          { "s.json:4:26: bodies[0].motion: must have exactly one of script", "it has 0" });
}

static void duplicates(void **state)
{
    (void)state;
    CHECK(make("\"spacing\": 0.1,\n\"spac\\u0069ng\": 0.1,", box,
               ", \"output\": { \"frames\": true,\n\"frames\": true }"),
          { "s.json:3:1: spacing: ", "duplicate key, already given in line 2" },
          { "s.json:8:1: output.frames: ", "duplicate key, already given in line 7" });
    CHECK(
        "{ \"domain\": { \"min\": [0,0,0], \"max\": [1,1,1] }, \"spacing\": 0.1, \"end_time\": 1,\n"
        "\"fluids\": [ { \"name\": \"a\", \"fill\": [ { \"box\": { \"min\": [0,0,0], \"max\": "
        "[1,1,0.5] } } ] },\n"
        "{ \"name\": \"a\", \"fill\": [ { \"box\": { \"min\": [0,0,0.4], \"max\": [1,1,1] } },\n"
        "{ \"box\": { \"min\": [0,0,0.9], \"max\": [1,1,1] } } ] } ] }",
        { "s.json:3:11: fluids[1].name: ", "\"a\" is already the name of fluids[0]" },
        { "s.json:4:1: fluids[1].fill[1]: ", "overlaps the box fluids[1].fill[0]" });
}

static void domain_and_regions(void **state)
{
    (void)state;
    CHECK("{ \"domain\": { \"min\": [0,1,0], \"max\": [1,\n1,-1],\n \"walls\": { \"x\": "
          "[\"periodic\", \"slip\"],\n"
          "\"y\": [\"slip\"], \"z\": \"periodc\" } }, \"spacing\": 0.1, \"end_time\": 1,\n"
          "\"fluids\": [ { \"name\": \"a\", \"fill\": [ { \"mesh\": \"none.stl\", \"box\": { } }, "
          "{ } ] } ] }",
          { "s.json:2:1: domain.max[1]: ", "is 1 in y, must be greater than domain.min there, 1" },
          { "s.json:2:3: domain.max[2]: ", "is -1 in z" },
          { "s.json:3:18: domain.walls.x: ", "is periodic on one side only" },
          { "s.json:4:6: domain.walls.y: ", "has 1 entries, must have 2" },
          { "s.json:4:21: domain.walls.z: ", "did you mean \"periodic\"?" },
          { "s.json:5:48: fluids[0].fill[0].mesh: ", "cannot find" },
          { "s.json:5:74: fluids[0].fill[1]: ",
            "must have one of box, sphere, mesh, outline and vessel, it has none" });
    CHECK(make(spacing,
               "\"fill\": [ { \"box\": { \"min\": [0, 0.5, -0.1], \"max\": [1, 0.5, 0.5] } },\n"
               "{ \"box\": { \"min\": [0, 0, 0] } },\n"
               "{ \"box\": { \"min\": [0, 0, 0.9], \"max\": [1, 1, 1] }, \"mesh\": \"a.obj\" },\n"
               "{ \"box\": { \"min\": [0, 0, 0.6], \"max\": [1, 1, 0.7] }, \"scale\": 2 } ]",
               ""),
          { "s.json:4:20: fluids[0].fill[0].box: ", "must be greater" },
          { "s.json:4:20: fluids[0].fill[0].box: ",
            "reaches from -0.1 to 0.5 m in z, the domain only from 0 to 1 m" },
          { "s.json:5:10: fluids[0].fill[1].box.max: ", "is missing" },
          { "s.json:6:1: fluids[0].fill[2]: ", "mesh, outline and vessel, it has several" },
          { "s.json:7:1: fluids[0].fill[3]: ", "scale, rotation and translation belong to a mesh" });
    CHECK(make("\"spacing\": 3,", box, ", \"output\": { \"interval\": 1e-9 }"),
          { "s.json:2:12: spacing: ", "is 3 m, the domain has only 1 m in x" },
          { "s.json:2:12: spacing: ", "in y" }, { "s.json:2:12: spacing: ", "in z" },
          { "s.json:6:27: output.interval: ", "more than 1000000 outputs" });
}

static void bodies_and_motions(void **state)
{
    (void)state;
    CHECK(make(spacing, box,
               ", \"method\": \"dfsp\", \"bodies\": [\n"
               "{ \"name\": \"../x\", \"mesh\": \"no.obj\", \"scale\": [1, 0, 1], \"rotation\": { "
               "\"angel\": 3 } },\n"
               "{ \"name\": \"water\", \"mesh\": \"\", \"motion\": { \"script\": \"no.lua\", "
               "\"params\": 3 } },\n"
               "{ \"name\": \"b\", \"mesh\": \"/\", \"motion\": { \"rotation\": { \"centr\": [0, "
               "0, 0] } } },\n"
               "{ \"name\": \"c\", \"mesh\": \"/\", \"motion\": { \"script\": \"no.lua\", "
               "\"speed\": 3 } },\n"
               "{ \"name\": \"d\", \"mesh\": \"/\", \"motion\": { \"script\": \"no.lua\" } } ],\n"
               "\"output\": { \"fields\": [\"presure\", 3] }"),
          { "s.json:6:13: method: ", "there is no method \"dfsp\"; did you mean \"dfsph\"?" },
          { "s.json:7:11: bodies[0].name: ", "is not usable as a name" },
          { "s.json:7:27: bodies[0].mesh: ", "cannot find" },
          { "s.json:7:50: bodies[0].scale[1]: ", "is 0, allowed is 1e-6 to 1e6" },
          { "s.json:7:71: bodies[0].rotation.angel: ", "did you mean \"angle\"?" },
          { "s.json:8:11: bodies[1].name: ", "already the name of fluids[0]" },
          { "s.json:8:28: bodies[1].mesh: ", "is empty" },
          { "s.json:8:74: bodies[1].motion.params: ", "is a number, must be an object" },
          { "s.json:9:24: bodies[2].mesh: ", "is not a file" },
          { "s.json:9:53: bodies[2].motion.rotation.centre: is missing", "" },
          { "s.json:9:53: bodies[2].motion.rotation.rate: is missing", "" },
          { "s.json:9:55: bodies[2].motion.rotation.centr: ", "did you mean \"centre\"?" },
          { "s.json:10:24: bodies[3].mesh: ", "is not a file" },
          { "s.json:10:61: bodies[3].motion.speed: ", "allowed here: script, params" },
          { "s.json:11:24: bodies[4].mesh: ", "is not a file" },
          { "s.json:11:51: bodies[4].motion.script: ", "no.lua" },
          { "s.json:12:23: output.fields: ",
            "there is no field \"presure\"; did you mean \"pressure\"?" },
          { "s.json:12:35: output.fields[1]: ", "is a number, must be a name" });
}

static void rules_between_values(void **state)
{
    (void)state;
    CHECK("{ \"dimension\": 2, \"domain\": {\"min\":[0,0],\"max\":[1,1],\"walls\":{\"z\":\"no-slip\"}},\n"
          "\"spacing\": 0.1, \"end_time\": 1, \"gravity\": [0, -9.81, 1],\n"
          "\"dfsph\": { \"divergence_iterations_min\": 9, \"divergence_iterations_max\": 3 },\n"
          "\"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"box\": { \"min\": [0, 0], \"max\": [1, 1] },\n"
          "\"velocity\": [0, 0, 1] } ] } ],\n"
          "\"output\": { \"surface\": { \"write\": true, \"fields\": [\"sped\"] } } }",
          { "s.json:1:67: domain.walls.z: ", "is of 3-D" }, { "s.json:2:43: gravity: ", "is 1 m/s2 in z" },
          { "s.json:3:41: dfsph.divergence_iterations_min: ",
            "is 9, must not be above divergence_iterations_max, 3" },
          { "s.json:4:38: fluids[0].fill[0]: ", "moves in z, which a 2-D scene does not have" },
          { "s.json:6:24: output.surface: ", "is of 3-D scenes only" },
          { "s.json:6:51: output.surface.fields: ", "there is no field \"sped\"" });
    CHECK(make(spacing, box,
               ", \"bodies\": [\n"
               "{ \"name\": \"b\", \"mesh\": \"/\", \"rotation\": { \"axis\": [0, 0, 0] } },\n"
               "{ \"name\": \"b\", \"mesh\": \"/\" } ]"),
          { "s.json:7:24: bodies[0].mesh: ", "/ is not a file" },
          { "s.json:7:51: bodies[0].rotation.axis: ", "is zero, must have a direction" },
          { "s.json:8:11: bodies[1].name: ", "\"b\" is already the name of bodies[0]" },
          { "s.json:8:24: bodies[1].mesh: ", "/ is not a file" });
    CHECK("{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1], \"walls\": { \"z\": \"no-slip\" },\n"
          "\"wall_velocity\": { \"x\": [[0, 1, 0], [0, 0, 0]], \"z\": [[0, 0, 1], [1, 0, 0]] } },\n"
          "\"spacing\": 0.1, \"end_time\": 1, \"fluids\": [ { \"name\": \"w\", \"fill\": [\n"
          "{ \"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] } } ] } ], \"probes\": [\n"
          "{ \"name\": \"p\", \"position\": [0, 0, 2] }, { \"name\": \"p\", \"position\": [0, 0, 1] } ] }",
          { "s.json:2:26: domain.wall_velocity.x[0]: ", "moves a side that is not no-slip" },
          { "s.json:2:55: domain.wall_velocity.z[0]: ", "is not along the side: z must be 0" },
          { "s.json:5:28: probes[0].position: ", "is 2 m in z, the domain reaches from 0 to 1 m" },
          { "s.json:5:51: probes[1].name: ", "\"p\" is already the name of probes[0]" });
    CHECK("{ \"domain\": 3, \"spacing\": 1, \"end_time\": 1, \"fluids\": 2 }",
          { "s.json:1:13: domain: ", "is a number, must be an object { ... }" },
          { "s.json:1:13: domain.min: ", "is missing" },
          { "s.json:1:13: domain.max: ", "is missing" },
          { "s.json:1:55: fluids: ", "is a number, must be a list [ { ... } ]" });
}

static void references_to_nothing(void **state)
{
    (void)state;
    CHECK(make(spacing, box,
               ", \"probes\": [ { \"name\": \"p\", \"position\": [0, 0, 0] } ], \"references\": [\n"
               "{ \"file\": \"/\", \"column\": \"kinetic_enrgy\" },\n"
               "{ \"file\": \"no.csv\", \"column\": \"pressure\", \"body\": \"b\", \"probe\": \"p\" },\n"
               "{ \"file\": \"no.csv\", \"column\": \"level\", \"probe\": \"p\", \"label\": \"a\\nb\" },\n"
               "{ \"column\": 3, \"probe\": \"q\", \"x_scale\": 0, \"y\": 4 } ]"),
          { "s.json:7:11: references[0].file: ", "/ is not a file" },
          { "s.json:7:26: references[0].column: ",
            "no column \"kinetic_enrgy\" in history.csv (one of bodies.csv or probes.csv needs body or "
            "probe); did you mean \"kinetic_energy\"?" },
          { "s.json:8:1: references[1]: ", "has a body and a probe, must have at most one of them" },
          { "s.json:8:11: references[1].file: ", "cannot find" },
          { "s.json:8:51: references[1].body: ", "there is no body \"b\"" },
          { "s.json:9:11: references[2].file: ", "cannot find" },
          { "s.json:9:31: references[2].column: ", "no column \"level\" in a point of probes.csv" },
          { "s.json:9:63: references[2].label: ", "must be 1 to 200 characters in one line" },
          { "s.json:10:1: references[3].file: ", "is missing" },
          { "s.json:10:13: references[3].column: ", "is a number, must be a name" },
          { "s.json:10:25: references[3].probe: ", "there is no probe \"q\"" },
          { "s.json:10:41: references[3].x_scale: ", "is 0, allowed is 1e-30 to 1e30" },
          { "s.json:10:49: references[3].y: ", "is a number, must be a text" });
}

static void names_are_no_formulas(void **state)
{
    char rest[] = ", \"probes\": [ { \"name\": \"=1\", \"position\": [0,0,0] } ]", *first = strchr(rest, '=');
    (void)state;
    for (const char *c = "=+-@"; (*first = *c) != 0; c++)
        CHECK(make(spacing, box, rest),
              { "s.json:6:25: probes[0].name: ", "none of . + - = @ in front and" });
}

static void motions_one_at_a_time(void **state)
{
    (void)state;
    static const char mesh[] = TOBI_SOURCE_DIR "/test/meshes/box.obj";
    static const struct { const char *motion, *begin, *contains; } cases[] = {
        { "3", "motion: ", "is a number, must be an object { ... }" },
        { "{ \"rotatoin\": { } }", "motion.rotatoin: ", "did you mean \"rotation\"?" },
        { "{ \"quantum\": { } }", "motion.quantum: ",
          "unknown key; allowed here: script, translation, rotation, oscillation" },
        { "{ \"type\": \"yaw\" }", "motion.type: ", "a motion is a key of its own: \"yaw\": { ... }" },
        { "{ \"translation\": { \"velocity\": [1, 0, 0] }, \"params\": { } }", "motion.params: ",
          "params belong to a script; translation takes none" },
        { "{ \"translation\": { }, \"rotation\": { } }", "motion: ", "must have exactly one of" },
        { "{ \"translation\": 3 }", "motion.translation: ", "is a number, must be an object" },
        { "{ \"rotation\": { \"center\": [0, 0, 0], \"axis\": [0, 0, 0], \"rate\": 1 } }",
          "motion.rotation: ", "must not be zero" },
        { "{ \"script\": \"/\" }", "motion.script: ", "/: is a directory; only plain files are read" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char rest[1024], text[4096];
        snprintf(rest, sizeof rest,
                 ", \"bodies\": [ { \"name\": \"b\", \"mesh\": \"%s\", \"motion\": %s } ]", mesh,
                 cases[i].motion);
        snprintf(text, sizeof text, "%s", make(spacing, box, rest));
        tobi_report *report = fail_text(text, strlen(text), NULL);
        const char *line = tobi_report_line(report, 0);
        if (!strstr(line, cases[i].begin) || !strstr(line, cases[i].contains))
            fail_msg("%s without %s%s", line, cases[i].begin, cases[i].contains);
        assert_int_equal(tobi_report_count(report), 1);
        tobi_report_free(report);
    }
}

static void too_much(void **state)
{
    (void)state;
    char text[8192] = "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": 1, "
                      "\"end_time\": 1, \"fluids\": [";
    for (int i = 0; i < 65; i++) strcat(text, i ? ", { }" : "{ }");
    strcat(text, "] }");
    CHECK(text, { "s.json:1:92: fluids: ", "has 65 entries, allowed are 8" });

    tobi_scene *scene;
    tobi_error err = { 0 };
    FILE *file = fopen("large.json", "wb");
    assert_int_equal(fseek(file, TOBI_SOURCE_LIMIT, SEEK_SET), 0);
    fputc(' ', file);
    fclose(file);
    assert_int_equal(tobi_scene_load("large.json", NULL, &scene, NULL, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "scene large.json: has 16777217 bytes; allowed are at most 16777216"));
    remove("large.json");
}

static void boxes_colours_and_the_camera(void **state)
{
    (void)state;
    CHECK(make(spacing, "\"color\": [0, 300, -1], \"visible\": 1,\n"
                        "\"fill\": [ { \"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 0.5] } } ]",
               ", \"bodies\": [\n"
               "{ \"name\": \"a\", \"color\": \"red\",\n"
               "\"box\": { \"min\": [0, 0, 0], \"max\": [1, 0, 1] } },\n"
               "{ \"name\": \"b\", \"box\": { \"min\": [0, 0, 0] } },\n"
               "{ \"name\": \"c\", \"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] },\n"
               "\"mesh\": \"no.obj\" } ],\n"
               "\"output\": { \"camera\": { \"position\": [1, 1, 1],\n"
               "\"look_at\": [1, 1, 1], \"angle\": 30 },\n"
               "\"picture\": { \"follow\": \"d\", \"field\": \"velocty\" } }"),
          { "s.json:4:14: fluids[0].color[1]: ", "is 300, allowed is 0 to 255 RGB, or \"speed\"" },
          { "s.json:4:19: fluids[0].color[2]: ", "is -1, allowed is 0 to 255" },
          { "s.json:4:35: fluids[0].visible: ", "must be true or false" },
          { "s.json:8:25: bodies[0].color: ", "is the text \"red\", must be a list of 3 numbers" },
          { "s.json:9:8: bodies[0].box: ", "min is 0 and max is 0 in y, max must be greater" },
          { "s.json:10:23: bodies[1].box: ", "must have two corners, min and max" },
          { "s.json:11:1: bodies[2]: ", "it has several" },
          { "s.json:12:9: bodies[2].mesh: ", "cannot find" },
          { "s.json:14:32: output.camera.angle: ", "needs a camera.position that is not" },
          { "s.json:15:24: output.picture.follow: ", "\"d\" is no body of the scene" },
          { "s.json:15:38: output.picture.field: ", "there is no field \"velocty\"" });
}

static void overrides_name_themselves(void **state)
{
    (void)state;
    const char *overrides[] = {
        "spacing=-1", "nonsense", "fluids[3].density=1", "fluids.oil.density=1",
        "fluids.water.fill.zero.velocity=[1, 0, 0]", "fluids.water.fill.1.velocity=[1, 0, 0]",
        "spacing.deep=1", "dfsph.suport=3", "fluids.water.viscosity=thick", "[0]=1", "a..b=1", "=1",
        "fluids[=1", "method=\xFF", "solids[0].x=1", "fluid[0].x=1", "a.b[0].c=1", "lines.rope.x=1",
        "output.camra.angle=9", "output.camera.angle=9", NULL };
    const expected lines[] = {
        { "--set nonsense: ", "must be path=value" },
        { "--set fluids[3].density=1: ", "there is no entry [3], the list has 1" },
        { "--set fluids.oil.density=1: ", "no entry is named \"oil\"; there are water" },
        { "--set fluids.water.fill.zero.velocity=[1, 0, 0]: ",
          "no entry is named \"zero\"; the only entry has no name, write [0]" },
        { "--set fluids.water.fill.1.velocity=[1, 0, 0]: ", "there is no entry [1], the list has 1" },
        { "--set spacing.deep=1: ", "nothing below this value" },
        { "--set [0]=1: ", "stands where a key must stand" },
        { "--set a..b=1: ", "must be path=value" },
        { "--set =1: ", "must be path=value" },
        { "--set fluids[=1: ", "must be path=value" },
        { "--set method=\xFF: ", "the value is not UTF-8" },
        { "--set solids[0].x=1: ", "there is no list \"solids\"" },
        { "--set fluid[0].x=1: ", "there is no list \"fluid\"; did you mean \"fluids\"?" },
        { "--set a.b[0].c=1: ", "there is no list \"b\"" },
        { "--set lines.rope.x=1: ", "there is no list \"lines\"" },
        { "--set spacing=-1: spacing: ", "is -1, allowed is 1e-7 to 1e5 m" },
        { "--set dfsph.suport=3: dfsph.suport: ", "did you mean \"support\"?" },
        { "--set fluids.water.viscosity=thick: fluids[0].viscosity: ", "is the text \"thick\"" },
        { "--set output.camra.angle=9: output.camra: unknown key", "did you mean \"camera\"?" },
        { "--set output.camera.angle=9: output.camera.angle: ", "needs a camera.position" },
    };
    check_report(make(spacing, box, ""), overrides, lines, sizeof lines/sizeof lines[0]);
}

static void check_syntax(const char *text, size_t size, const char *begin)
{
    tobi_report *report = fail_text(text, size, NULL);
    if (strncmp(tobi_report_line(report, 0), begin, strlen(begin)) != 0) {
        print_error("%s\nexpected %s\n", tobi_report_line(report, 0), begin);
        fail();
    }
    assert_int_equal(tobi_report_count(report), 1);
    tobi_report_free(report);
}

#define SYNTAX(text, begin) check_syntax(text, sizeof(text) - 1, begin)

static void syntax(void **state)
{
    (void)state;
    SYNTAX("", "s.json:1:");
    SYNTAX("# only a comment\n// here", "s.json:2:");
    SYNTAX("[1, 2]", "s.json:1:1: a scene must be an object");
    SYNTAX("{\n\"a\": 1,\n\"b\" 2 }", "s.json:3:5: not valid JSON: ':' expected");
    SYNTAX("{ \"a\": [1, 2 }", "s.json:1:14: not valid JSON");
    SYNTAX("{ \"a\": \"unfinished }", "s.json:1:");
    SYNTAX("{ \"a\": 1e999 }", "s.json:1:12: not valid JSON: real number overflow");
    SYNTAX("{ \"a\": 99999999999999999999999999 }", "s.json:1:");
    SYNTAX("{ \"a\": NaN }", "s.json:1:");
    SYNTAX("{\n \"a\": \"\xFF\xFE\" }",
           "s.json:2:7: not valid JSON: unable to decode byte 0xff near '\"'; a scene must be "
           "saved as UTF-8");
    SYNTAX("\xFF\xFE{\0 \0}\0", "s.json:1:1: the file is in UTF-16; a scene must be saved as UTF-8");
    SYNTAX("\xFE\xFF\0{\0 \0}", "s.json:1:1: the file is in UTF-16");
    SYNTAX("{\0 \0}\0", "s.json:1:1: the file is in UTF-16");
    SYNTAX("\0{\0 \0}", "s.json:1:1: the file is in UTF-16");
    SYNTAX("{ \"a\": \"\\u0000\" }", "s.json:1:");
    SYNTAX("{ \"a\": 1 }\0{ }", "s.json:1:");
    SYNTAX("{ } x", "s.json:1:");
}

static void truncated_anywhere(void **state)
{
    (void)state;
    char text[4096];
    snprintf(text, sizeof text, "%s",
             make(spacing, box, ", \"output\": { \"fields\": [\"vel\\u006fcity\"] } # end"));
    for (size_t n = 0; n + 8 < strlen(text); n++) tobi_report_free(fail_text(text, n, NULL));
}

/* Any single byte replaced: an answer, never a crash. Sanitizer builds make this sharp. */
static void damaged_anywhere(void **state)
{
    (void)state;
    static const char bytes[] = "\"{}[]:,#/\\-1e\0\x80\xFF";
    char text[4096];
    int good = 0, bad = 0;
    snprintf(text, sizeof text, "%s",
             make(spacing, box, ", \"output\": { \"fields\": [\"vel\\u006fcity\"] }"));
    size_t size = strlen(text);
    for (size_t i = 0; i < size; i++) {
        char kept = text[i];
        for (size_t k = 0; k < sizeof bytes; k++) {
            tobi_scene *scene;
            tobi_report *report;
            text[i] = bytes[k];
            tobi_status status =
                tobi_scene_parse("s.json", text, size, NULL, &scene, &report, NULL);
            assert_true((status == TOBI_OK) == (scene != NULL) &&
                        (status == TOBI_OK) == (report == NULL));
            assert_true(status == TOBI_OK || status == TOBI_INVALID);
            good += status == TOBI_OK;
            bad += status != TOBI_OK;
            tobi_scene_free(scene);
            tobi_report_free(report);
        }
        text[i] = kept;
    }
    assert_true(bad > 1000 && good > 50);
}

static void deep_and_wide(void **state)
{
    (void)state;
    size_t depth = 100000;
    char *text = malloc(2*depth + 100);
    size_t n = (size_t)sprintf(text, "{ \"a\": ");
    memset(text + n, '[', depth);
    memset(text + n + depth, ']', depth);
    strcpy(text + n + 2*depth, " }");
    check_syntax(text, strlen(text), "s.json:1:");
    n = (size_t)sprintf(text, "{ \"a\": ");            /* as deep as the parser allows */
    memset(text + n, '[', 2000);
    memset(text + n + 2000, ']', 2000);
    strcpy(text + n + 4000, " }");
    tobi_report_free(fail_text(text, strlen(text), NULL));
    free(text);

    int keys = 100000;
    text = malloc((size_t)keys*20);
    n = (size_t)sprintf(text, "{");
    for (int i = 0; i < keys; i++) n += (size_t)sprintf(text + n, "\"k%d\": 1,\n", i/2);
    strcpy(text + n, "\"x\": \"\\u001b[31m\" }");
    tobi_report *report = fail_text(text, strlen(text), NULL);
    int count = tobi_report_count(report);
    assert_int_equal(count, TOBI_REPORT_LIMIT + 1);
    assert_non_null(strstr(tobi_report_line(report, count - 1), "more mistakes"));
    tobi_report_free(report);
    free(text);
}

static void control_characters_stay_out_of_messages(void **state)
{
    (void)state;
    char *text = make("\"spacing\": 0.1, \"\\u001b[31m\": 1,", box, "");
    tobi_report *report = fail_text(text, strlen(text), NULL);
    assert_null(strchr(tobi_report_line(report, 0), 27));
    tobi_report_free(report);
}

static void files_that_are_none(void **state)
{
    (void)state;
    tobi_scene *scene;
    tobi_report *report;
    tobi_error err = { 0 };
    assert_int_equal(tobi_scene_load("no/such/scene.json", NULL, &scene, &report, &err), TOBI_NOT_FOUND);
    assert_non_null(strstr(err.text, "no/such/scene.json"));
    assert_null(scene);
    assert_null(report);
    assert_int_equal(tobi_scene_load(TOBI_SOURCE_DIR, NULL, &scene, &report, &err), TOBI_IO);
    assert_int_equal(tobi_scene_load("no/such", NULL, &scene, NULL, NULL), TOBI_NOT_FOUND);
    tobi_scene_free(NULL);
    tobi_report_free(NULL);
    assert_int_equal(tobi_report_count(NULL), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unknown_keys),
        cmocka_unit_test(wrong_types),
        cmocka_unit_test(values_out_of_range),
        cmocka_unit_test(missing_keys),
        cmocka_unit_test(duplicates),
        cmocka_unit_test(domain_and_regions),
        cmocka_unit_test(bodies_and_motions),
        cmocka_unit_test(rules_between_values),
        cmocka_unit_test(references_to_nothing),
        cmocka_unit_test(names_are_no_formulas),
        cmocka_unit_test(motions_one_at_a_time),
        cmocka_unit_test(too_much),
        cmocka_unit_test(boxes_colours_and_the_camera),
        cmocka_unit_test(overrides_name_themselves),
        cmocka_unit_test(syntax),
        cmocka_unit_test(truncated_anywhere),
        cmocka_unit_test(damaged_anywhere),
        cmocka_unit_test(deep_and_wide),
        cmocka_unit_test(control_characters_stay_out_of_messages),
        cmocka_unit_test(files_that_are_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

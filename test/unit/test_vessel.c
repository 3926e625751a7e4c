/* Vessels: walls for surfaces, what they hold up to a level, and what is refused in words. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "geom/massprops.h"
#include "geom/vessel.h"
#include "scene/scene.h"
#include "world/world.h"

static const double corner[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 },
                                     { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 }, { 1, 1, 1 } };
/* A unit cube; the last two triangles are its lid. */
static const int32_t side[12][3] = { { 0, 2, 1 }, { 1, 2, 3 }, { 0, 1, 4 }, { 1, 5, 4 },
                                     { 2, 6, 3 }, { 3, 6, 7 }, { 0, 4, 2 }, { 2, 4, 6 },
                                     { 1, 3, 5 }, { 3, 7, 5 }, { 4, 5, 6 }, { 5, 7, 6 } };

static tobi_mesh make_box(int triangles)
{
    tobi_mesh m;
    tobi_error err = { 0 };
    assert_int_equal(tobi_mesh_build("box", 8, corner, triangles, side, &m, &err), TOBI_OK);
    return m;
}

static const double shut[3];

static double make_vessel(tobi_mesh *m, double thickness, int dimension)
{
    tobi_error err = { 0 };
    tobi_massprops props;
    if (tobi_mesh_make_vessel(m, thickness, 0.1, shut, dimension, "box", &err) != TOBI_OK)
        fail_msg("%s", err.text);
    assert_int_equal(tobi_massprops_volume(m, &props, &err), TOBI_OK);
    return props.volume;
}

static void test_walls(void **state)
{
    (void)state;
    tobi_mesh closed = make_box(12), open = make_box(10);
    assert_float_equal(make_vessel(&closed, 0, 3), 1.2*1.2*1.2 - 1, 1e-9);
    assert_non_null(strstr(closed.notes, "it has no walls of its own: they lie outside of it, 0.1 m thick; "
                           "it is closed all round"));
    assert_null(strstr(closed.notes, "hollow"));
    /* a mesh with walls of its own stays as it is, unless they are asked for */
    assert_float_equal(make_vessel(&closed, 0, 3), 1.2*1.2*1.2 - 1, 1e-9);
    assert_int_equal(closed.triangle_count, 24);
    assert_null(strstr(closed.notes, "hollow"));
    assert_float_equal(make_vessel(&open, 0.05, 3), 1.1*1.1*1.05 - 1, 1e-9);
    assert_null(strstr(open.notes, "closed all round"));
    assert_float_equal(make_vessel(&open, 0, 3), 1.1*1.1*1.05 - 1, 1e-9);
    tobi_mesh_free(&closed);
    tobi_mesh_free(&open);
}

/* A cube without one side is that which was read without it; what has no such side is refused. */
static void test_open_sides(void **state)
{
    (void)state;
    static const double up[3] = { 0, 0, 2 }, left[3] = { -1, 0, 0 }, slanted[3] = { 1, 1, 0 };
    tobi_error err = { 0 };
    tobi_massprops props;
    for (int k = 0; k < 2; k++) {
        tobi_mesh m = make_box(12);
        assert_int_equal(tobi_mesh_make_vessel(&m, 0, 0.1, k ? up : left, 3, "box", &err), TOBI_OK);
        assert_int_equal(tobi_massprops_volume(&m, &props, &err), TOBI_OK);
        assert_float_equal(props.volume, 1.2*1.2*1.1 - 1, 1e-9);
        assert_null(strstr(m.notes, "closed all round"));
        assert_int_equal(tobi_mesh_make_vessel(&m, 0, 0.1, up, 3, "box", &err), TOBI_INVALID);
        if (!strstr(err.text, "open_side is for an inner surface; this mesh has walls of its own"))
            fail_msg("%s", err.text);
        tobi_mesh_free(&m);
    }
    tobi_mesh m = make_box(12);
    assert_int_equal(tobi_mesh_make_vessel(&m, 0, 0.1, slanted, 3, "box", &err), TOBI_INVALID);
    if (!strstr(err.text, "open_side [1, 1, 0]: no flat side lies farthest that way"))
        fail_msg("%s", err.text);
    tobi_mesh_free(&m);
}

/* A channel in 2-D has its ends too: a floor and two sides alone do not say where their inside is. */
static void test_channel(void **state)
{
    (void)state;
    static const double at[8][3] = { { 0, 0, -1 }, { 0.3, 0, -1 }, { 0.3, 0, 1 }, { 0, 0, 1 },
                                     { 0, 0.2, -1 }, { 0.3, 0.2, -1 }, { 0.3, 0.2, 1 }, { 0, 0.2, 1 } };
    static const int32_t channel[6][3] = { { 0, 1, 2 }, { 0, 2, 3 }, { 0, 3, 7 },
                                           { 0, 7, 4 }, { 1, 5, 6 }, { 1, 6, 2 } };
    tobi_mesh m;
    tobi_error err = { 0 };
    assert_int_equal(tobi_mesh_build("channel", 8, at, 6, channel, &m, &err), TOBI_OK);
    assert_int_equal(tobi_mesh_make_vessel(&m, 0, 0.1, shut, 2, "channel", &err), TOBI_INVALID);
    if (!strstr(err.text, "A vessel is open at its top alone, also in 2-D")) fail_msg("%s", err.text);
    tobi_mesh_free(&m);
}

static const char *path;
#define HALF "{ \"vessel\": \"cup\", \"level\": 0.5 }"

/* The cube without a lid; holed: the wall at x = 1 is a frame around a hole from 0.4 to 0.6. */
static void write_mesh(const char *name, int holed)
{
    FILE *f = fopen(name, "w");
    assert_non_null(f);
    for (int k = 0; k < 8; k++) fprintf(f, "v %g %g %g\n", corner[k][0], corner[k][1], corner[k][2]);
    fprintf(f, "v 1 0.4 0.4\nv 1 0.6 0.4\nv 1 0.6 0.6\nv 1 0.4 0.6\n");
    for (int t = 0; t < (holed ? 8 : 10); t++)
        fprintf(f, "f %d %d %d\n", side[t][0] + 1, side[t][1] + 1, side[t][2] + 1);
    const int outer[4] = { 2, 4, 8, 6 };
    for (int k = 0; holed && k < 4; k++) {
        const int a = outer[k], b = outer[(k + 1)%4], c = 9 + k, d = 9 + (k + 1)%4;
        fprintf(f, "f %d %d %d\nf %d %d %d\n", a, b, d, a, d, c);
    }
    fclose(f);
}

/* Two such cubes side by side. */
static void write_two(const char *name)
{
    FILE *f = fopen(name, "w");
    assert_non_null(f);
    for (int k = 0; k < 16; k++)
        fprintf(f, "v %g %g %g\n", corner[k%8][0] + (k < 8 ? 0 : 1.5), corner[k%8][1], corner[k%8][2]);
    for (int t = 0; t < 20; t++) {
        const int first = t < 10 ? 1 : 9;
        fprintf(f, "f %d %d %d\n", side[t%10][0] + first, side[t%10][1] + first, side[t%10][2] + first);
    }
    fclose(f);
}

/* resolved.json, from which runs are resumed and drawn, is a scene again, and the same. */
static void read_again(const tobi_scene *scene)
{
    tobi_error err = { 0 };
    tobi_scene *again;
    char *text = tobi_scene_resolved(scene);
    if (tobi_scene_parse("resolved.json", text, strlen(text), NULL, &again, NULL, &err) != TOBI_OK)
        fail_msg("%s", err.text);
    char *twice = tobi_scene_resolved(again);
    assert_string_equal(text, twice);
    free(text);
    free(twice);
    tobi_scene_free(again);
}

static tobi_status start(const char *bodies, const char *fill, const char *more, tobi_world **w,
                         tobi_error *err)
{
    char text[3000];
    tobi_scene *scene;
    *w = NULL;
    snprintf(text, sizeof text, "{ \"domain\": { \"min\": [-1, -1, -1], \"max\": [2.5, 2, 2] }, %s\n"
             "\"spacing\": 0.1, \"end_time\": 1, \"fluids\": [ { \"name\": \"water\", \"fill\": [ %s ] } ], "
             "\"bodies\": [ %s ] }",
             more, fill, bodies);
    TOBI_TRY(tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, err));
    tobi_status status = tobi_scene_build(scene, w, err);
    if (status == TOBI_OK) status = tobi_world_start(*w, err);
    if (status == TOBI_OK) read_again(scene);
    tobi_scene_free(scene);
    return status;
}

static int64_t fill(const char *bodies, const char *fill)
{
    tobi_world *w;
    tobi_error err = { 0 };
    if (start(bodies, fill, "", &w, &err) != TOBI_OK) fail_msg("%s", err.text);
    const int64_t count = tobi_world_count(w, TOBI_FLUID);
    tobi_world_destroy(w);
    return count;
}

static void refuse(const char *bodies, const char *fill, const char *more, const char *words)
{
    tobi_world *w;
    tobi_error err = { 0 };
    assert_int_equal(start(bodies, fill, more, &w, &err), TOBI_INVALID);
    if (!strstr(err.text, words)) fail_msg("%s\nexpected: %s", err.text, words);
    tobi_world_destroy(w);
}

static char cup[300], holed[300], box[300];

static void test_levels(void **state)
{
    (void)state;
    assert_int_equal(fill(cup, HALF), 500);
    assert_int_equal(fill(box, "{ \"vessel\": \"box\", \"level\": 0.5 }"), 500);
    assert_int_equal(fill(box, "{ \"vessel\": \"box\", \"level\": 3 }"), 1000);
    assert_int_equal(fill(holed, "{ \"vessel\": \"cup\", \"level\": 0.3 }"), 300);
    const int64_t ball = fill("{ \"name\": \"ball\", \"vessel\": true, \"sphere\": { \"centre\": [0, 0, 0], "
                              "\"radius\": 0.75 } }", "{ \"vessel\": \"ball\", \"level\": 0 }");
    assert_in_range(ball, 840, 928);          /* 2/3 pi 0.75^3/0.001 = 884 */
}

/* Two cups, and a seed. */
static void test_compartments(void **state)
{
    (void)state;
    char two[700];
    snprintf(two, sizeof two, "%s, { \"name\": \"other\", \"vessel\": true, \"mesh\": \"%s/cup.obj\", "
             "\"translation\": [1.3, 0, 0] }", cup, path);
    assert_int_equal(fill(two, "{ \"vessel\": \"cup\", \"level\": 0.5 }, { \"vessel\": \"other\", "
                          "\"level\": 0.3 }"), 800);
    assert_int_equal(fill(cup, "{ \"vessel\": \"cup\", \"level\": 0.5, \"seed\": [0.5, 0.5, 0.1] }"), 500);
    refuse(cup, "{ \"vessel\": \"cup\", \"level\": 0.5, \"seed\": [1.7, 0.5, 0.1] }", "",
           "fill[0] finds nothing to fill in vessel 'cup' below a level of 0.5 m at the seed");
}

/* Bulkheads that are bodies of their own part a box into rooms of 0.4 and 0.5 m; one that moves, too. */
static void test_bulkheads(void **state)
{
    (void)state;
    static const char left[] = "{ \"vessel\": \"box\", \"level\": 0.5, \"seed\": [0.1, 0.5, 0.1] }";
    static const char right[] = "{ \"vessel\": \"box\", \"level\": 0.3, \"seed\": [0.9, 0.5, 0.1] }";
    char parted[700], both[300];
    for (int moves = 0; moves < 2; moves++) {
        snprintf(parted, sizeof parted, "%s, { \"name\": \"bulkhead\", \"box\": { \"min\": [0.4, 0, 0], "
                 "\"max\": [0.5, 1, 0.6] } %s }", box, moves ? ", \"motion\": { \"translation\": "
                 "{ \"velocity\": [0, 0, 1], \"start\": 0.5 } }" : "");
        assert_int_equal(fill(parted, left), 4*10*5);
        assert_int_equal(fill(parted, right), 5*10*3);
        snprintf(both, sizeof both, "%s, %s", left, right);
        assert_int_equal(fill(parted, both), 4*10*5 + 5*10*3);
    }
    /* without a seed all of the vessel, but for the bulkhead */
    assert_int_equal(fill(parted, "{ \"vessel\": \"box\", \"level\": 0.5 }"), 9*10*5);
    /* over a bulkhead that is too low the rooms are one */
    snprintf(parted, sizeof parted, "%s, { \"name\": \"sill\", \"box\": { \"min\": [0.4, 0, 0], "
             "\"max\": [0.5, 1, 0.2] } }", box);
    refuse(parted, both, "", "no wall that reaches above both levels parts the seeds");
}

/* A plug in the hole of a cup, or a gate before it, holds the liquid; a mug in a cup that leaks does not. */
static void test_closed_holes(void **state)
{
    static const char level[] = "{ \"vessel\": \"cup\", \"level\": 0.7 }";
    static const struct { const char *min, *max; int count; } closes[] = {
        { "[1, 0.4, 0.4]", "[1.2, 0.6, 0.6]", 700 }, { "[1.2, 0.3, 0.3]", "[1.3, 0.7, 0.7]", 700 + 2*2*2 },
        { "[1.15, 0.3, 0.3]", "[1.3, 0.7, 0.7]", 700 + 2*2 } };        /* rows of the cup, not of all */
    char bodies[700];
    (void)state;
    for (int k = 0; k < 3; k++) {
        snprintf(bodies, sizeof bodies, "%s, { \"name\": \"gate\", \"box\": { \"min\": %s, \"max\": %s } "
                 "}", holed, closes[k].min, closes[k].max);
        assert_int_equal(fill(bodies, level), closes[k].count);
    }
    snprintf(bodies, sizeof bodies, "%s, { \"name\": \"mug\", \"box\": { \"min\": [0.2, 0.2, 0.2], \"max\": "
             "[0.6, 0.6, 0.9] }, \"vessel\": true, \"wall_thickness\": 0.1, \"open_side\": [0, 0, 1] }",
             holed);
    refuse(bodies, level, "", "vessel 'cup' holds liquid up to");
}

/* A block of ice, half in the water of a cup: the water starts around it. */
static void test_solid_inside(void **state)
{
    (void)state;
    tobi_world *w;
    tobi_error err = { 0 };
    if (start(cup, HALF, "\"solids\": [ { \"name\": \"ice\", \"fill\": [ { \"box\": { "
              "\"min\": [0.3, 0.3, 0.3], \"max\": [0.6, 0.6, 0.6] } } ] } ],", &w, &err) != TOBI_OK)
        fail_msg("%s", err.text);
    assert_int_equal(w->system[0].particles.count, 500 - 3*3*2);
    tobi_world_destroy(w);
}

/* Walls whose outside lies on cells of the search: no liquid begins in them. */
static void test_walls_on_cells(void **state)
{
    (void)state;
    tobi_scene *scene;
    tobi_world *w;
    tobi_error err = { 0 };
    static const char text[] =
        "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [0.6, 0.4] }, \"spacing\": 0.01, "
        "\"end_time\": 1, \"fluids\": [ { \"name\": \"water\", "
        "\"fill\": [ { \"vessel\": \"tank\", \"level\": 0.2 } ] } ], "
        "\"bodies\": [ { \"name\": \"tank\", \"vessel\": true, "
        "\"box\": { \"min\": [0.1, 0.05], \"max\": [0.4, 0.3] } } ] }";
    assert_int_equal(tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, &err), TOBI_OK);
    assert_int_equal(tobi_scene_build(scene, &w, &err), TOBI_OK);
    if (tobi_world_start(w, &err) != TOBI_OK) fail_msg("%s", err.text);
    assert_int_equal(w->system[0].particles.count, 30*15);
    tobi_world_destroy(w);
    tobi_scene_free(scene);
}

/* Particles of two fluids; `second` is the fill of the later one. */
static void fill_two(const char *bodies, const char *first, const char *second, int64_t count[2])
{
    tobi_world *w;
    tobi_error err = { 0 };
    char fills[1000];
    snprintf(fills, sizeof fills, "%s ] }, { \"name\": \"oil\", \"fill\": [ %s", first, second);
    if (start(bodies, fills, "", &w, &err) != TOBI_OK) fail_msg("%s", err.text);
    const tobi_particles *p = &w->system[0].particles;
    count[0] = count[1] = 0;
    for (int64_t i = 0; i < p->count; i++) count[p->fluid[i]]++;
    tobi_world_destroy(w);
}

/* A later fluid takes the place of an earlier one in vessels too: boxes and vessels, in each order. */
static void test_later_fluids(void **state)
{
    (void)state;
    static const char small[] = "{ \"box\": { \"min\": [0.2, 0.2, 0.2], \"max\": [0.4, 0.4, 0.4] } }";
    static const char low[] = "{ \"vessel\": \"cup\", \"level\": 0.2 }";
    static const char deep[] = "{ \"vessel\": \"bowl\", \"level\": 0.3 }";
    char bowl[400], two[700];
    int64_t n[2];
    fill_two(cup, HALF, small, n);
    assert_true(n[0] == 500 - 8 && n[1] == 8);
    fill_two(cup, HALF, low, n);
    assert_true(n[0] == 300 && n[1] == 200);
    /* a cup of oil in a pool, whose water is left in none of it */
    fill_two(cup, "{ \"box\": { \"min\": [-1, -1, -1], \"max\": [2.5, 2, 0.5] } }", HALF, n);
    assert_true(n[0] == 35*30*15 - 14*14*7 && n[1] == 500);
    /* a round bowl: what lies in its box but not in it stays */
    snprintf(bowl, sizeof bowl, "{ \"name\": \"bowl\", \"vessel\": true, \"sphere\": { \"centre\": "
             "[0, 0, 0], \"radius\": 0.75 } }");
    fill_two(bowl, "{ \"box\": { \"min\": [-1, -1, -1], \"max\": [2.5, 2, 0] } }",
             "{ \"vessel\": \"bowl\", \"level\": 0 }", n);
    assert_in_range(n[1], 840, 928);
    assert_in_range(n[0], 35*30*10 - 1850, 35*30*10 - 1700);   /* less 2/3 pi 0.95^3/0.001 = 1796 */
    fill_two(bowl, deep, "{ \"vessel\": \"bowl\", \"level\": 0 }", n);
    assert_in_range(n[1], 840, 928);
    const int64_t alone = fill(bowl, deep);          /* and some that had room along the wall */
    assert_in_range(n[0] + n[1], alone, alone + alone/50);
    /* every compartment comes before what is written after it */
    snprintf(two, sizeof two, "{ \"name\": \"cup\", \"vessel\": true, \"mesh\": \"%s/two.obj\", "
             "\"translation\": [-0.3, 0, 0] }", path);
    fill_two(two, HALF, "{ \"box\": { \"min\": [1.5, 0.2, 0.2], \"max\": [1.7, 0.4, 0.4] } }", n);
    assert_true(n[0] == 1000 - 8 && n[1] == 8);
}

static void test_mistakes(void **state)
{
    char ball[300];
    (void)state;
    refuse(cup, "{ \"vessel\": \"cup\", \"level\": 1.4 }", "",
           "the level of fill[0] is 1.4 m, and vessel 'cup' holds liquid up to");
    refuse(cup, "{ \"vessel\": \"cup\", \"level\": 9 }", "", "and vessel 'cup' holds liquid up to 1 m only");
    refuse(holed, "{ \"vessel\": \"cup\", \"level\": 0.7 }", "",
           "runs out over a rim or through a hole near (");
    refuse(cup, "{ \"vessel\": \"cup\", \"level\": -1 }", "", "finds nothing to fill in vessel 'cup'");
    refuse(cup, "{ \"vessel\": \"cup\" }", "", "level: is missing: a vessel is filled up to a level");
    refuse(cup, "{ \"vessel\": \"mug\", \"level\": 0.5 }", "", "\"mug\" is no body of the scene");
    refuse("{ \"name\": \"cup\", \"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] } }",
           HALF, "", "\"cup\" is no vessel: bodies[0] needs");
    refuse(cup, HALF, "\"gravity\": [0, 0, 0],", "without gravity nothing is up");
    refuse(cup, HALF ", { \"box\": { \"min\": [0.2, 0.2, 0.2], \"max\": [0.4, 0.4, 0.4] } }", "",
           "overlaps another region, fill[1] of fluid 'water', at (");
    snprintf(ball, sizeof ball, "{ \"name\": \"cup\", \"vessel\": true, \"sphere\": { \"centre\": [0, 0, 0], "
             "\"radius\": 0.75 } }");
    refuse(ball, "{ \"vessel\": \"cup\", \"level\": 0.5 }, { \"vessel\": \"cup\", \"level\": 0.2 }", "",
           "overlaps another region, fill[0] of fluid 'water', at (");
    refuse(cup, "{ \"vessel\": \"cup\", \"level\": 0.5, \"mesh\": \"cup.obj\" }", "",
           "must have one of box, sphere, mesh, outline and vessel, it has several");
    refuse(cup, "{ \"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] },\n\"level\": 0.5 }", "",
           "s.json:3:1: fluids[0].fill[0].level: is for a vessel; this region has its shape");
    refuse(cup, "{ \"sphere\": { \"centre\": [0, 0, 0], \"radius\": 0.3 }, \"seed\": [0, 0, 0] }", "",
           "fluids[0].fill[0].seed: is for a vessel");
}

static void test_wrong_calls(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    tobi_world_def def = tobi_default_world_def();
    tobi_world *w;
    def.domain_max[0] = def.domain_max[1] = def.domain_max[2] = 1;
    def.spacing = 0.1;
    def.end_time = 1;
    assert_int_equal(tobi_world_create(&def, NULL, &w, &err), TOBI_OK);
    tobi_fluid_def water = tobi_default_fluid_def();
    tobi_fill_def in = tobi_default_fill_def();
    in.vessel = "none";
    assert_int_equal(tobi_world_add_fluid(w, &water, &in, 1, &err), TOBI_OK);
    assert_int_equal(tobi_world_start(w, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "fill[0] fills 'none', which is no body"));
    tobi_world_destroy(w);
}

int main(void)
{
    static char name[] = "/tmp/tobiuo_vessel_XXXXXX";
    char file[100];
    path = mkdtemp(name);
    snprintf(file, sizeof file, "%s/cup.obj", path);
    write_mesh(file, 0);
    snprintf(cup, sizeof cup, "{ \"name\": \"cup\", \"vessel\": true, \"mesh\": \"%s\" }", file);
    snprintf(file, sizeof file, "%s/holed.obj", path);
    write_mesh(file, 1);
    snprintf(file, sizeof file, "%s/two.obj", path);
    write_two(file);
    snprintf(file, sizeof file, "%s/holed.obj", path);
    snprintf(holed, sizeof holed, "{ \"name\": \"cup\", \"vessel\": true, \"mesh\": \"%s\" }", file);
    snprintf(box, sizeof box, "{ \"name\": \"box\", \"vessel\": true, \"box\": { \"min\": [0, 0, 0], "
             "\"max\": [1, 1, 1] } }");
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_channel), cmocka_unit_test(test_walls),       cmocka_unit_test(test_levels),
        cmocka_unit_test(test_open_sides),
        cmocka_unit_test(test_compartments), cmocka_unit_test(test_bulkheads),
        cmocka_unit_test(test_closed_holes),     cmocka_unit_test(test_mistakes),
        cmocka_unit_test(test_solid_inside), cmocka_unit_test(test_walls_on_cells),
        cmocka_unit_test(test_later_fluids),
        cmocka_unit_test(test_wrong_calls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Bodies by an outline: area and centre against the formula of the polygon, in 2-D and 3-D, of any sense of
   turn; what is refused. */
#include "tobiuo/scene.h"
#include "tobiuo/tobiuo.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "empty_world.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static tobi_body_def of(const char *points)
{
    tobi_body_def b = tobi_default_body_def();
    b.name = "bed";
    b.outline.points = points;
    b.outline.from = 0.5, b.outline.to = 1.25;
    return b;
}

/* A star whose n corners lie on two circles about (1, 1): concave; its area. */
static double write_star(char *text, size_t size, int n, int backwards)
{
    size_t used = 0;
    for (int k = 0; k < n; k++) {
        const double angle = 2*M_PI*(backwards ? n - k : k)/n, r = k%2 ? 0.8 : 0.3;
        used += (size_t)snprintf(text + used, size - used, "%s%.17g,%.17g", k ? " " : "", 1 + r*cos(angle),
                                 1 + r*sin(angle));
    }
    return 0.5*n*0.8*0.3*sin(2*M_PI/n);
}

static void expect(int dimension, int axis, const char *points, double area, double u, double v)
{
    static const int plane[3][2] = { { 0, 2 }, { 0, 1 }, { 1, 2 } }, along[3] = { 1, 2, 0 };
    tobi_error err;
    tobi_body_info info;
    tobi_world *world = make_empty_world(dimension, 0.05, 2);
    tobi_body_def b = of(points);
    b.outline.axis = axis;
    if (tobi_world_add_body(world, &b, &err) != TOBI_OK) fail_msg("%s", err.text);
    assert_int_equal(tobi_world_body(world, 0, &info), TOBI_OK);
    const double length = dimension == 2 ? 1 : 0.75;
    const int *p = dimension == 2 ? plane[1] : plane[axis];
    assert_true(fabs(info.volume/(area*length) - 1) < 1e-9);
    assert_true(fabs(info.position[p[0]] - u) < 1e-9 && fabs(info.position[p[1]] - v) < 1e-9);
    if (dimension == 3) assert_true(fabs(info.position[along[axis]] - 0.875) < 1e-9);
    tobi_world_destroy(world);
}

static void polygons_have_their_area(void **state)
{
    (void)state;
    char star[20000];
    for (int dimension = 2; dimension <= 3; dimension++)
        for (int axis = 0; axis < 3; axis++) {
            expect(dimension, axis, "0.5,0 1.5,0 0.5,0.6", 0.3, 0.5 + 1/3.0, 0.2);
            expect(dimension, axis, "0.5,0.6 1.5,0 0.5,0", 0.3, 0.5 + 1/3.0, 0.2);
            /* an L, with points on straight sides, a repeated one, a spike and the first again at the end */
            expect(dimension, axis,
                   "0,0 0.5,0 1,0 1,0 1,0.5 0.5,0.5 0.5,0.75 0.5,1 0.5,1.5 0.5,1 0,1 0,0", 0.75,
                   (0.5*0.5 + 0.25*0.25)/0.75, (0.5*0.25 + 0.25*0.75)/0.75);
            for (int n = 6; n <= 400; n *= 4) {
                const double area = write_star(star, sizeof star, n, axis == 1);
                expect(dimension, axis, star, area, 1, 1);
            }
        }
}

/* A comb: every corner of its teeth but two is no ear at first. */
static void a_comb_has_its_area(void **state)
{
    (void)state;
    char text[4000] = "0,0 1.95,0";
    for (int k = 19; k >= 0; k--)
        snprintf(text + strlen(text), sizeof text - strlen(text), " %.17g,1 %.17g,1 %.17g,0.1 %.17g,0.1",
                 0.1*k + 0.05, 0.1*k, 0.1*k, k > 0 ? 0.1*k - 0.05 : 0.0);
    /* 1.95 by 0.1, and 20 teeth of 0.05 by 0.9 */
    const double area = 1.95*0.1 + 20*0.05*0.9;
    const double v = (1.95*0.1*0.05 + 20*0.05*0.9*0.55)/area;
    expect(2, 0, text, area, 0.975, v);
    expect(3, 2, text, area, 0.975, v);
}

static void a_line_fills_down_to_its_base(void **state)
{
    (void)state;
    tobi_error err;
    tobi_body_info info;
    char path[] = "/tmp/outlineXXXXXX";
    FILE *file = fdopen(mkstemp(path), "w");
    fputs("\xef\xbb\xbfstation;z [cm];x [mm]\n# surveyed\n1;0;500\n2; 20 ;1000\n\n3;\"60\";2000\n", file);
    fclose(file);
    for (int from_file = 0; from_file < 2; from_file++) {
        tobi_world *world = make_empty_world(3, 0.05, 2);
        tobi_body_def b = of(from_file ? NULL : "0.5,0 1,0.2 2,0.6");
        b.outline.file = from_file ? path : NULL;
        b.outline.base = 0;
        if (tobi_world_add_body(world, &b, &err) != TOBI_OK) fail_msg("%s", err.text);
        assert_int_equal(tobi_world_body(world, 0, &info), TOBI_OK);
        assert_true(fabs(info.volume/(0.75*(0.05 + 0.4)) - 1) < 1e-9);
        tobi_world_destroy(world);
    }
    remove(path);
}

/* Water in a triangle, turned by a quarter. Its slope goes through particles of the lattice, which are left
   out: 20*19/2 of 200 are there. */
static void regions_are_filled(void **state)
{
    (void)state;
    tobi_error err;
    for (int dimension = 2; dimension <= 3; dimension++) {
        char text[800];
        snprintf(text, sizeof text, "{ \"dimension\": %d,\n"
                 "\"domain\": { \"min\": [0, 0, 0], \"max\": [2, 2, 2] },\n"
                 "\"spacing\": 0.05, \"end_time\": 1, \"fluids\": [ { \"name\": \"water\", \"fill\": [ {\n"
                 "\"outline\": { \"points\": [[0, 0], [1, 0], [0, 1]], \"axis\": \"z\", \"to\": 0.5 },\n"
                 "\"translation\": [1.5, 0.5, 0.5], \"rotation\": { \"angle\": 90 } } ] } ] }", dimension);
        tobi_scene *scene = NULL;
        tobi_world *world = NULL;
        if (tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, &err) != TOBI_OK ||
            tobi_scene_build(scene, &world, &err) != TOBI_OK || tobi_world_start(world, &err) != TOBI_OK)
            fail_msg("%s", err.text);
        const double count = (double)tobi_world_count(world, TOBI_FLUID);
        assert_true(count == (dimension == 2 ? 190 : 1900));
        double *at = malloc((size_t)count*3*sizeof *at);
        assert_int_equal(tobi_world_read(world, TOBI_FLUID, "position", at, (int64_t)count*3, &err), TOBI_OK);
        for (int64_t k = 0; k < (int64_t)count; k++) {
            const double x = 1.5 - at[3*k], y = at[3*k + 1] - 0.5;
            assert_true(x > 0 && y > 0 && x + y < 1);
        }
        free(at);
        tobi_world_destroy(world);
        tobi_scene_free(scene);
    }
    tobi_scene *scene = NULL;
    const char both[] = "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [2, 2] },"
        "\"spacing\": 0.05, \"end_time\": 1, \"fluids\": [ { \"name\": \"water\", \"fill\": [ {"
        "\"outline\": {"
        "\"points\": [[0, 0], [1, 0], [0, 1]], \"file\": \"bed.csv\" } } ] } ] }";
    assert_int_equal(tobi_scene_parse("s.json", both, strlen(both), NULL, &scene, NULL, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "bed.csv"));
    tobi_scene_free(scene);
}

static void refused(const char *points, double base, const char *why)
{
    tobi_error err;
    tobi_world *world = make_empty_world(3, 0.05, 2);
    tobi_body_def b = of(points);
    b.outline.base = base;
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_INVALID);
    if (!strstr(err.text, why)) fail_msg("\"%s\" lacks \"%s\"", err.text, why);
    tobi_world_destroy(world);
}

static void wrong_outlines_are_refused(void **state)
{
    (void)state;
    const double none = TOBI_NO_PLACE;
    refused("0,0 1,0", none, "its outline has 2 points; at least 3 are needed");
    refused("0,0 1,0 2,0", none, "its outline has no area");
    refused("0,0 1,1 1,0 0,1", none,
            "crosses itself: the side from (0, 0) to (1, 1) m meets that from (1, 0) to (0, 1) m");
    refused("0,0 1,0 1,1 0.5,0 0,1", none, "crosses itself");
    refused("0,0 1;0 1,1", none, "its outline: \"1;0 1,1\" is no point; points are like");
    refused("0,0 1,0 nan,1", none, "is no point");
    refused("0,0 1,0.2 1,0.4", 0, "with a base points go to the right, but (1, 0.4) m follows (1, 0.2) m");
    refused("0,0.1 1,0.2", 0.15, "the point (0, 0.1) m lies below the base, 0.15 m");
    refused("1,1", 0, "1 points; a line above a base has at least 2");
    tobi_error err;
    tobi_world *world = make_empty_world(3, 0.05, 2);
    tobi_body_def b = of("0,0 1,0 0,1");
    b.outline.to = 0.5;
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "goes from 0.5 to 0.5 m along y; to must be greater than from"));
    b.outline.to = 1, b.outline.file = "bed.csv";
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "has points and a file; it may have one"));
    b.outline.file = NULL, b.sphere_radius = 0.1;
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "a knife, an outline or a terrain"));
    tobi_world_destroy(world);
}

static void too_many_points_are_refused(void **state)
{
    (void)state;
    char *text = malloc(70000*40);
    for (int count = 5001; count <= 70000; count += 64999) {
        size_t used = 0;
        for (int k = 0; k < count; k++)
            used += (size_t)sprintf(text + used, "%s%.9g,%.9g", k ? " " : "", 1 + 0.5*cos(2*M_PI*k/count),
                                    1 + 0.5*sin(2*M_PI*k/count));
        refused(text, TOBI_NO_PLACE, count == 5001 ? "has 5001 points; at most 5000 are allowed"
                                                   : "more than 65536 points");
    }
    free(text);
}

static void wrong_tables_are_refused(void **state)
{
    (void)state;
    static const struct { const char *table, *why; } cases[] = {
        { "", "is empty" },
        { "x,y\n0,0\n", "1: the first line names no column z; it must name x and z" },
        { "x [ft],z\n0,0\n", "1: the unit of column x is not known; allowed are [m], [cm], [mm] or none" },
        { "x,z,x\n0,0,0\n", "1: column x is there twice" },
        { "x,z\n0,0\n1,high\n", "3: \"high\" is no finite number" },
        { "x,z\n0,0,,\n0,5,1,5\n", "3: the row has more than the 2 columns of the first line; is a comma" },
        { "x,z\n0\n", "2: the row has fewer columns than the first line" },
    };
    tobi_error err;
    char path[] = "/tmp/outlineXXXXXX";
    FILE *made = fdopen(mkstemp(path), "w");
    fclose(made);
    for (size_t k = 0; k < sizeof cases/sizeof *cases; k++) {
        FILE *file = fopen(path, "w");
        fputs(cases[k].table, file);
        fclose(file);
        tobi_world *world = make_empty_world(3, 0.05, 2);
        tobi_body_def b = of(NULL);
        b.outline.file = path;
        assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_INVALID);
        if (!strstr(err.text, cases[k].why)) fail_msg("\"%s\" lacks \"%s\"", err.text, cases[k].why);
        tobi_world_destroy(world);
    }
    remove(path);
    tobi_world *world = make_empty_world(3, 0.05, 2);
    tobi_body_def b = of(NULL);
    b.outline.file = path;
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_NOT_FOUND);
    b.outline.file = ".";         /* a folder */
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_IO);
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(polygons_have_their_area), cmocka_unit_test(a_comb_has_its_area),
        cmocka_unit_test(a_line_fills_down_to_its_base),
        cmocka_unit_test(regions_are_filled), cmocka_unit_test(wrong_outlines_are_refused),
        cmocka_unit_test(too_many_points_are_refused), cmocka_unit_test(wrong_tables_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Bodies by a grid of heights: volume against the sum over cells, both kinds of files; what is refused. */
#include "tobiuo/scene.h"
#include "tobiuo/tobiuo.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "empty_world.h"
#include "geom/terrain.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char path[] = "/tmp/terrainXXXXXX";

static tobi_status add(const char *file, double base, tobi_body_info *info, tobi_error *err)
{
    tobi_world *world = make_empty_world(3, 0.1, 4);
    tobi_body_def b = tobi_default_body_def();
    b.name = "bed";
    b.terrain_file = path;
    b.terrain_base = base;
    FILE *out = fopen(path, "w");
    fputs(file, out);
    fclose(out);
    const tobi_status status = tobi_world_add_body(world, &b, err);
    if (status == TOBI_OK) assert_int_equal(tobi_world_body(world, 0, info), TOBI_OK);
    tobi_world_destroy(world);
    return status;
}

static void expect(const char *file, double base, double volume, double x, double y)
{
    tobi_error err;
    tobi_body_info info;
    if (add(file, base, &info, &err) != TOBI_OK) fail_msg("%s", err.text);
    assert_true(fabs(info.volume/volume - 1) < 1e-9);
    assert_true(fabs(info.position[0] - x) < 1e-9 && fabs(info.position[1] - y) < 1e-9);
}

/* A plane has its volume whatever the grid; an even one its middle. */
static void grids_have_their_volume(void **state)
{
    (void)state;
    expect("ncols 2\nnrows 1\nxllcorner 0.5\nyllcorner 1\ncellsize 0.5\nNODATA_value -9999\n0.5 0.5\n", 0,
           0.25, 1, 1.25);
    expect("NCOLS 1\nNROWS 2\nXLLCENTER 1\nYLLCENTER 1\nCELLSIZE 1\n0.5\n0.5\n", 0.25, 0.5, 1, 1.5);
    /* a mark of UTF-8, keys in another order, no data as GDAL writes it for some */
    expect("\xef\xbb\xbfnrows 2\r\nncols 1\r\ncellsize 1\r\nxllcenter 1\r\nyllcenter 1\r\n"
           "NODATA_value nan\r\n0.5\r\n0.5\r\n", 0.25, 0.5, 1, 1.5);
    /* levels 3 in the north, 1 in the south: 2 x 4 m, with level strips of half a cell at both ends */
    tobi_error err;
    tobi_body_info info;
    assert_int_equal(add("ncols 1\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 2\n3\n1\n", 0, &info, &err),
                     TOBI_OK);
    assert_true(fabs(info.volume/(2*(1*1 + 2*2 + 1*3)) - 1) < 1e-9);
    assert_true(info.position[1] > 2);             /* the north is y */
    /* the plane z = 1 + x/2 + y over 0 to 2 and 0 to 1, in any order, unevenly */
    expect("z [cm];y;x\n100;0;0\n250;0.5;2\n150;0.5;0\n200;0;2\n300;1;2\n200;1;0\n"
           "250;1;1\n150;0;1\n200;0.5;1\n", 0, 4, 13/12.0, 13/24.0);
}

/* The plane z = 1 + x/8 + y/4, of lines `way` apart from a corner on. */
static char *make_plane(double corner, double way, int n)
{
    char *text = malloc((size_t)(n*n)*60 + 100), *at = text + sprintf(text, "x,y,z\n");
    for (int k = 0; k < n*n; k++) {
        const double x = corner + way*(k%n), y = corner + way*(k/n);
        at += sprintf(at, "%.9g,%.9g,%.9g\n", x, y, 1 + x/8 + y/4);
    }
    return text;
}

/* The domain is 4 m wide. */
static void expect_plane(double corner, double way, int n, const char *note, double volume)
{
    tobi_error err;
    char *text = make_plane(corner, way, n);
    tobi_body_def b = tobi_default_body_def();
    tobi_world *world = make_empty_world(3, 0.1, 4);
    tobi_body_info info;
    FILE *out = fopen(path, "w");
    fputs(text, out);
    fclose(out);
    b.name = "bed", b.terrain_file = path;
    if (tobi_world_add_body(world, &b, &err) != TOBI_OK) fail_msg("%s", err.text);
    tobi_world_body(world, 0, &info);
    if (fabs(info.volume/volume - 1) > 1e-9) fail_msg("%.12g m3, not %.12g", info.volume, volume);
    char all[600] = "";
    const char *one;
    for (int k = 0; (one = tobi_world_note(world, k)); k++)
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s\n", one);
    if (note ? !strstr(all, note) : strstr(all, "its terrain") != NULL) fail_msg("'%s'", all);
    tobi_world_destroy(world);
    free(text);
}

static void surveys_are_cut_to_the_domain(void **state)
{
    (void)state;
    expect_plane(0, 0.5, 9, NULL, 16*(1 + 3*2.0/8));
    expect_plane(1, 0.5, 5, NULL, 4*(1 + 3*2.0/8));
    expect_plane(-0.25, 0.5, 19, "reaches beyond the domain: 10 x 10 of its 19 x 19 lines are used",
                 16*(1 + 3*2.0/8));
    expect_plane(-0.5, 0.5, 6, "5 x 5 of its 6 x 6 lines", 4*(1 + 3*1.0/8));
    expect_plane(-0.75, 60, 2, "2 x 2 of its 2 x 2 lines", 16*(1 + 3*2.0/8));
}

/* At the spacing of 0.1 m; means of planes lie on them, the outer lines stay. */
static void fine_grids_are_thinned(void **state)
{
    (void)state;
    expect_plane(1, 0.025, 41, NULL, 1 + 3*1.5/8);
    expect_plane(1, 0.02, 51, "one line in 2 along x and in 2 along y is kept", 1 + 3*1.5/8);
    expect_plane(1, 0.01, 100, "one line in 5 along x and in 5 along y", 0.99*0.99*(1 + 3*1.495/8));
    expect_plane(-0.015, 0.01, 102, "; its terrain is finer", 0.995*0.995*(1 + 3*0.4975/8));
}

/* One number that rises has all its weight in the mean. */
static void what_is_thinned_stays_on_the_mean(void **state)
{
    double x[11], y[2] = { 0, 10 }, z[22] = { 0 };
    tobi_terrain t = { x, y, z, 11, 2 };
    int64_t factor[2];
    (void)state;
    for (int k = 0; k < 11; k++) x[k] = k;
    z[5] = 4, z[16] = 4;
    tobi_terrain_thin(&t, (double[]){ 5, 5 }, factor);
    assert_true(factor[0] == 2 && factor[1] == 1 && t.nx == 6 && t.ny == 2);
    const double expected[] = { 0, 0, 1, 1, 0, 0 }, place[] = { 0, 2, 4, 6, 8, 10 };
    for (int k = 0; k < 12; k++) assert_true(fabs(t.z[k] - expected[k%6]) < 1e-14);
    for (int k = 0; k < 6; k++) assert_true(fabs(t.x[k] - place[k]) < 1e-14);
}

static void surveys_may_be_turned(void **state)
{
    tobi_error err;
    tobi_body_def b = tobi_default_body_def();
    tobi_body_info info;
    char *text = make_plane(-8, 1, 17);
    FILE *out = fopen(path, "w");
    (void)state;
    fputs(text, out);
    fclose(out);
    b.name = "bed", b.terrain_file = path;
    b.rotation_axis[2] = -1, b.rotation_angle = 90;      /* x' = y, y' = -x */
    b.scale[0] = 0.5, b.scale[1] = 2;
    b.translation[0] = b.translation[1] = 2;
    tobi_world *world = make_empty_world(3, 0.1, 4);
    if (tobi_world_add_body(world, &b, &err) != TOBI_OK) fail_msg("%s", err.text);
    tobi_world_body(world, 0, &info);
    assert_true(fabs(info.volume - 4*4) < 1e-6);
    assert_true(fabs(info.position[0] - 13/6.0) < 1e-6 && fabs(info.position[1] - 5/3.0) < 1e-6);
    tobi_world_destroy(world);
    world = make_empty_world(3, 0.1, 4);
    b.translation[0] = 40;
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "body 'bed': its terrain reaches from -8 to 8 m in x and from -8 to 8 m "
                           "in y of its file, the domain there from -4 to 4 m and from -20 to -18 m"));
    tobi_world_destroy(world);
    world = make_empty_world(3, 0.1, 4);
    b.translation[0] = 2, b.rotation_angle = 80;         /* so it is not cut: it is -2 m high in a corner */
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "its terrain is -2 m high at x = -8, y = -8 m"));
    tobi_world_destroy(world);
    free(text);
}

static void refused(const char *file, const char *why)
{
    tobi_error err;
    tobi_body_info info;
    assert_int_equal(add(file, 0, &info, &err), TOBI_INVALID);
    if (!strstr(err.text, why)) fail_msg("\"%s\" lacks \"%s\"", err.text, why);
}

#define HEAD "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n"

static void wrong_files_are_refused(void **state)
{
    (void)state;
    refused(HEAD, "there are no heights");
    refused("ncols 2\nrows 2\n1 1\n", "\"rows\" is no key of an ESRI ASCII grid with its number");
    refused("ncols 2\nnrows two\n1 1\n", "\"nrows\" is no key");
    refused("ncols 2\nnrows 2\nxllcorner 0\ncellsize 1\n1 1\n1 1\n",
            "needs ncols, nrows, cellsize, xllcorner or");
    refused("ncols 2.5\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 1\n",
            "ncols is 2.5 and nrows 2; allowed");
    refused("ncols 1e4\nnrows 1e4\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 1\n", "and 4000000 heights");
    refused("ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 0\n1 1\n",
            "cellsize is 0, must be above 0");
    refused(HEAD "1 1\n1 1\n1 1\n", "more follows after the 2 times 2 heights of ncols and nrows");
    refused(HEAD "1 1\n1\n", "row 2, column 2 holds no height");
    refused(HEAD "1 high\n1 1\n", "row 1, column 2 holds no height");
    refused(HEAD "1 1\n-9999 1\n", "row 2, column 1 has no data (-9999)");
    refused(HEAD "nodata_value 7\n7 1\n1 1\n", "row 1, column 1 has no data (7)");
    refused(HEAD "1 1\n1 0\n",
            "its terrain is 0 m high at x = 1.5, y = 0 m, which is not above its base, 0 m");
    refused("x,y,z\n0,0,1\n1,0,1\n0,1,1\n", "3 points are no lattice: x has 2 different values and y 2");
    refused("x,y,z\n0,0,1,5\n1,0,1,5\n0,1,1,5\n1,1,1,5\n", "2: the row has more than the 3 columns");
    refused("x,y,z\n0,0,1\n1,0,1\n", "2 points are no lattice");
    refused("x,y,z\n0,0,1\n1,0,1\n0,1,1\n0,1,1\n", "the point x = 0, y = 1 m is there twice");
    refused("x,y\n0,0\n", "names no column z; it must name x, y and z");
    tobi_error err;
    tobi_world *world = make_empty_world(2, 0.1, 4);
    tobi_body_def b = tobi_default_body_def();
    b.name = "bed";
    b.terrain_file = path;
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_UNSUPPORTED);
    assert_non_null(strstr(err.text, "a 2-D scene has no terrain; an outline with a base is a bed there"));
    tobi_world_destroy(world);
    world = make_empty_world(3, 0.1, 4);
    b.terrain_file = "/nowhere/bed.asc";
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_NOT_FOUND);
    assert_non_null(strstr(err.text, "body 'bed': its terrain: /nowhere/bed.asc: "));
    tobi_world_destroy(world);
}

static int make_file(void **state)
{
    (void)state;
    FILE *file = fdopen(mkstemp(path), "w");
    return file ? fclose(file) : -1;
}

static int remove_file(void **state)
{
    (void)state;
    return remove(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(grids_have_their_volume),
                                        cmocka_unit_test(surveys_are_cut_to_the_domain),
                                        cmocka_unit_test(fine_grids_are_thinned),
                                        cmocka_unit_test(what_is_thinned_stays_on_the_mean),
                                        cmocka_unit_test(surveys_may_be_turned),
                                        cmocka_unit_test(wrong_files_are_refused) };
    return cmocka_run_group_tests(tests, make_file, remove_file);
}

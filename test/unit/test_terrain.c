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
                                        cmocka_unit_test(wrong_files_are_refused) };
    return cmocka_run_group_tests(tests, make_file, remove_file);
}

/* PLY and OBJ: read back byte by byte, and what a full or missing folder gives. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "io/exchange.h"

static const double points[4][3] = { { 0, 0, 0 }, { 1.5, 0, 0 }, { 0, -2, 0 }, { 0, 0, 1e-3 } };
static const int32_t triangles[2][3] = { { 0, 2, 1 }, { 3, 0, 1 } };

static size_t read_back(const char *path, char *bytes, size_t room)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t n = fread(bytes, 1, room - 1, file);
    bytes[n] = '\0';
    fclose(file);
    unlink(path);
    return n;
}

static void ply_holds_the_points(void **state)
{
    (void)state;
    static const char head[] = "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
                               "property float y\nproperty float z\nend_header\n";
    char bytes[1024];
    assert_int_equal(tobi_ply_write("points.ply", 4, points, NULL), TOBI_OK);
    assert_int_equal(read_back("points.ply", bytes, sizeof bytes), strlen(head) + 48);
    assert_memory_equal(bytes, head, strlen(head));
    for (int i = 0; i < 12; i++) {
        float x;
        memcpy(&x, bytes + strlen(head) + 4*i, 4);
        assert_true(x == (float)points[i/3][i%3]);
    }
    assert_int_equal(tobi_ply_write("none.ply", 0, NULL, NULL), TOBI_OK);
    read_back("none.ply", bytes, sizeof bytes);
    assert_non_null(strstr(bytes, "vertex 0\n"));
}

static void obj_holds_the_surface(void **state)
{
    (void)state;
    char bytes[1024];
    assert_int_equal(tobi_obj_write("surface.obj", 4, points, 2, triangles, NULL), TOBI_OK);
    read_back("surface.obj", bytes, sizeof bytes);
    assert_string_equal(bytes, "v 0 0 0\nv 1.5 0 0\nv 0 -2 0\nv 0 0 0.001\nf 1 3 2\nf 4 1 2\n");
}

static void failures_have_a_text(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    assert_int_equal(tobi_ply_write("/nowhere/points.ply", 4, points, &err), TOBI_IO);
    assert_non_null(strstr(err.text, "/nowhere/points.ply"));
    assert_int_equal(tobi_obj_write("/dev/full/surface.obj", 4, points, 2, triangles, &err), TOBI_IO);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ply_holds_the_points),
        cmocka_unit_test(obj_holds_the_surface),
        cmocka_unit_test(failures_have_a_text),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

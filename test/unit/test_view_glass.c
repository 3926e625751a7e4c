/* Bodies like glass: what is nearer shows more, whatever the order of bodies and triangles. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "tobiuo/picture.h"

enum { SIDE = 96, SHEETS = 12 };

/* A square across y, which the image covers with one of its halves: red or blue. */
typedef struct sheet {
    double vertex[4][3];
    int32_t triangle[2][3];
    float uv[2][3][2];
} sheet;

static sheet make_sheet(double y, int blue, int turned)
{
    static const int corner[2][3] = { { 0, 1, 2 }, { 0, 2, 3 } };
    sheet s;
    for (int k = 0; k < 4; k++) {
        s.vertex[k][0] = k == 1 || k == 2 ? 1 : 0, s.vertex[k][1] = y, s.vertex[k][2] = k/2;
    }
    for (int t = 0; t < 2; t++)
        for (int k = 0; k < 3; k++) {
            s.triangle[t][k] = corner[t][turned ? 2 - k : k];
            s.uv[t][k][0] = blue ? 0.75f : 0.25f, s.uv[t][k][1] = 0.5f;
        }
    return s;
}

static tobi_image *make_image(void)
{
    enum { WIDE = 64, HIGH = 8 };
    static uint8_t rgb[HIGH][WIDE][3];
    tobi_image *image;
    tobi_error err = { 0 };
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++) {
            rgb[y][x][0] = x < WIDE/2 ? 230 : 20, rgb[y][x][1] = 20, rgb[y][x][2] = x < WIDE/2 ? 20 : 230;
        }
    assert_int_equal(tobi_image_make(WIDE, HIGH, &rgb[0][0][0], &image, &err), TOBI_OK);
    return image;
}

static void draw(const sheet *s, int count, const tobi_image *image, int from_behind, int threads,
                 uint8_t rgb[SIDE][SIDE][3])
{
    tobi_picture f = tobi_default_picture();
    tobi_picture_mesh mesh[SHEETS];
    tobi_error err = { 0 };
    for (int k = 0; k < count; k++)
        mesh[k] = (tobi_picture_mesh){ .vertex_count = 4, .vertices = s[k].vertex, .triangle_count = 2,
                                       .triangles = s[k].triangle, .transparency = 0.3f, .image = image,
                                       .uv = s[k].uv };
    f.width = f.height = SIDE, f.threads = threads;
    f.has_camera = 1;
    for (int a = 0; a < 3; a++) f.box_max[a] = 1, f.eye[a] = f.target[a] = 0.5;
    f.eye[1] = from_behind ? 4 : -3;
    f.meshes = mesh, f.mesh_count = count;
    if (tobi_picture_draw(&f, &rgb[0][0][0], &err)) fail_msg("%s", err.text);
}

/* The pane of one body has another image on its rear side: from each side its own is in front. */
static void what_is_near_shows_more(void **state)
{
    (void)state;
    static uint8_t one[SIDE][SIDE][3], two[SIDE][SIDE][3];
    tobi_image *image = make_image();
    for (int order = 0; order < 2; order++)
        for (int behind = 0; behind < 2; behind++) {
            const sheet red = make_sheet(0.4, 0, 0), blue = make_sheet(0.5, 1, 1);
            const sheet pair[2] = { order ? blue : red, order ? red : blue };
            draw(pair, 2, image, behind, 1, one);
            draw(pair, 2, image, behind, 2, two);
            assert_memory_equal(one, two, sizeof one);
            /* on the side of the diagonals and on them */
            for (int k = -16; k <= 16; k++) {
                const uint8_t *p = one[SIDE/2 + k][SIDE/2 + k/2];
                const int near = p[behind ? 2 : 0], far = p[behind ? 0 : 2];
                if (near < far + 40) fail_msg("near %d, far %d at %d", near, far, k);
                if (far < 60) fail_msg("what is far is not seen: %d", far);
            }
        }
    tobi_image_free(image);
}

/* More sheets than layers are kept: a picture all the same, the same for any number of threads. */
static void many_sheets(void **state)
{
    (void)state;
    static uint8_t one[SIDE][SIDE][3], two[SIDE][SIDE][3];
    sheet s[SHEETS];
    tobi_image *image = make_image();
    for (int k = 0; k < SHEETS; k++) s[k] = make_sheet(0.1 + 0.07*k, k > 0, k & 1);
    draw(s, SHEETS, image, 0, 1, one);
    draw(s, SHEETS, image, 0, 2, two);
    assert_memory_equal(one, two, sizeof one);
    const uint8_t *p = one[SIDE/2][SIDE/2 + 5];
    assert_true(p[0] > p[2] + 40);
    tobi_image_free(image);
}

/* The surface of water at a pane goes in and out of it: the pane is before the water all the same. */
static void water_at_a_pane(void **state)
{
    (void)state;
    enum { N = 16 };
    static double position[N*N*N][3];
    static uint8_t rgb[2][SIDE][SIDE][3];
    tobi_picture f = tobi_default_picture();
    tobi_error err = { 0 };
    for (int i = 0; i < N*N*N; i++)
        for (int a = 0, k = i; a < 3; a++, k /= N) position[i][a] = (k%N + 0.5)/N;
    f.positions = position, f.particle_count = N*N*N, f.radius = 0.5/N;
    f.width = f.height = SIDE, f.threads = 1;
    f.has_camera = 1;
    for (int a = 0; a < 3; a++) f.box_max[a] = 1, f.eye[a] = f.target[a] = 0.5;
    f.eye[1] = -3;
    for (int k = 0; k < 2; k++) {
        const sheet s = make_sheet((k - 0.5)*0.6/N, 0, 0);
        const tobi_picture_mesh pane = { .vertex_count = 4, .vertices = s.vertex, .triangle_count = 2,
                                         .triangles = s.triangle, .transparency = 0.3f,
                                         .color = { 0.9f, 0.1f, 0.1f } };
        f.meshes = &pane, f.mesh_count = 1;
        if (tobi_picture_draw(&f, &rgb[k][0][0][0], &err)) fail_msg("%s", err.text);
    }
    for (int y = SIDE/2 - 8; y < SIDE/2 + 8; y++)
        for (int c = 0; c < 3; c++) assert_true(abs(rgb[0][y][SIDE/2][c] - rgb[1][y][SIDE/2][c]) <= 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_near_shows_more),
        cmocka_unit_test(many_sheets),
        cmocka_unit_test(water_at_a_pane),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

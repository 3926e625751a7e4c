/* Pictures when memory ends: the n-th allocation fails, for every n. It is told, nothing is left. */
#define _GNU_SOURCE 1
#include "calls.h"
#include "failing_memory.h"
#include "tobiuo/picture.h"
#include <malloc.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { SIDE = 8, N = SIDE*SIDE*SIDE, W = 64, H = 48 };

static double position[N][3], velocity[N][3];
static float value[N];
static uint8_t opaque[N];
static int32_t group[N];
static unsigned char rgb[3*W*H];

/* Water on the left, two solids on the right, one lone drop. */
static void fill(void)
{
    for (int i = 0; i < N; i++) {
        position[i][0] = (i%SIDE + 0.5)/SIDE;
        position[i][1] = (i/SIDE%SIDE + 0.5)/SIDE;
        position[i][2] = (i/SIDE/SIDE + 0.5)/SIDE*0.5;
        velocity[i][0] = value[i] = (float)(i%SIDE)/SIDE;
        opaque[i] = i%SIDE >= SIDE/2;
        group[i] = i/SIDE%SIDE >= SIDE/2;
    }
    position[0][2] = 0.9;
}

static tobi_status draw(const tobi_picture *p, tobi_error *err) { return tobi_picture_draw(p, rgb, err); }

static void try_all(const tobi_picture *p)
{
    tobi_error err = { 0 };
    assert_int_equal(draw(p, &err), TOBI_OK);
    const long before = allocations;
    assert_int_equal(draw(p, &err), TOBI_OK);
    const long needed = allocations - before;
    assert_true(needed > 5);
    for (long n = 1; n <= needed; n++) {
        /* A leak leaves bytes each time; the allocator keeps up to seven of a size, fontconfig now and then
           some. */
        int is_clean = 0;
        for (int turn = 0; turn < 20 && !is_clean; turn++) {
            const size_t in_use = mallinfo2().uordblks;
            allocations = 0, fail_at = n;
            const tobi_status status = draw(p, &err);
            fail_at = 0;
            if (status != TOBI_NO_MEMORY) fail_msg("allocation %ld: status %d, %s", n, (int)status, err.text);
            is_clean = mallinfo2().uordblks <= in_use;
        }
        if (!is_clean) fail_msg("allocation %ld: bytes are left", n);
    }
}

static double look(const void *user, const double x[3], float uv[2])
{
    (void)user;
    uv[0] = (float)x[0], uv[1] = (float)x[1];
    return 0;
}

static void look_flat(const void *user, const double corner[3][3], float uv[3][2])
{
    for (int k = 0; k < 3; k++) look(user, corner[k], uv[k]);
}

/* Images on a body and on the solids, made and shown. */
static void try_images(tobi_picture *p, const tobi_picture_mesh *mesh)
{
    static const float uv[4][3][2] = { { { 0, 0 }, { 1, 0 }, { 0, 1 } } };
    static const uint8_t pixels[4*4*3];
    static int16_t skin[N];
    tobi_error err = { 0 };
    tobi_image *image = NULL;
    tobi_picture_mesh textured = *mesh;
    const long before = allocations;
    assert_int_equal(tobi_image_make(4, 4, pixels, &image, &err), TOBI_OK);
    const long needed = allocations - before;
    tobi_image_free(image);
    for (long n = 1; n <= needed; n++) {
        allocations = 0, fail_at = n;
        assert_int_equal(tobi_image_make(4, 4, pixels, &image, &err), TOBI_NO_MEMORY);
        fail_at = 0;
        assert_null(image);
    }
    assert_int_equal(tobi_image_make(4, 4, pixels, &image, &err), TOBI_OK);
    const tobi_picture_skin one = { .image = image, .look = look, .look_flat = look_flat, .depth = 1 };
    textured.image = image, textured.uv = uv;
    p->meshes = &textured, p->skins = &one, p->skin_count = 1, p->skin = skin;
    p->rest = (const double (*)[3])position;
    try_all(p);
    p->meshes = mesh, p->skins = NULL, p->skin_count = 0, p->skin = NULL, p->rest = NULL;
    tobi_image_free(image);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    static const double corner[4][3] = { { 0.2, 0.2, 0.1 }, { 0.4, 0.2, 0.1 }, { 0.2, 0.4, 0.1 },
                                         { 0.2, 0.2, 0.8 } };
    static const int32_t side[4][3] = { { 0, 2, 1 }, { 0, 1, 3 }, { 0, 3, 2 }, { 1, 2, 3 } };
    const tobi_picture_mesh mesh = { 4, corner, 4, side, { 0.9f, 0.1f, 0.1f }, 0, 0, NULL, NULL };
    tobi_picture p = tobi_default_picture();
    fill();
    p.width = W, p.height = H, p.threads = 1;
    for (int k = 0; k < 3; k++) p.box_max[k] = 1;
    p.particle_count = N, p.positions = position, p.values = value, p.radius = 0.5/SIDE;
    p.velocities = velocity, p.opaque = opaque, p.group = group, p.axes = 1, p.label = "speed [m/s]";
    p.flow = velocity, p.streamlines = 4;
    p.palette = tobi_color_map("viridis", &p.palette_count);
    p.meshes = &mesh, p.mesh_count = 1;
    try_all(&p);
    p.look = TOBI_LOOK_PARTICLES;
    try_all(&p);
    p.look = TOBI_LOOK_NATURAL;
    try_images(&p, &mesh);
    p.look = TOBI_LOOK_PARTICLES;
    p.dimension = 2;
    try_all(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(every_allocation_may_fail) };
    return cmocka_run_group_tests_name("view/picture failures", tests, NULL, NULL);
}

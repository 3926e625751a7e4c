/* Surfaces when memory ends: the n-th allocation fails, for every n. It is told, nothing is left. */
#define _GNU_SOURCE 1
#include "calls.h"
#include "failing_memory.h"
#include "surface_rig.h"
#include <malloc.h>
#include <unistd.h>

static double look(const void *user, const double x[3], float uv[2])
{
    (void)user;
    uv[0] = (float)x[0], uv[1] = (float)x[1];
    return x[2] - 0.03;      /* half of it is inside */
}

static void look_flat(const void *user, const double corner[3][3], float uv[3][2])
{
    for (int k = 0; k < 3; k++) look(user, corner[k], uv[k]);
}

/* With an image on it. */
static tobi_status make_skinned(const tobi_surface_def *d, tobi_surface **s, tobi_error *err)
{
    static const uint8_t pixels[2*2*3];
    static tobi_picture_skin skin = { .look = look, .look_flat = look_flat };
    tobi_image *image;
    int16_t *of = calloc((size_t)d->particle_count, sizeof *of);
    if (!of) return err->status = TOBI_NO_MEMORY;
    tobi_status status = tobi_image_make(2, 2, pixels, &image, err);
    skin.image = image;
    const tobi_surface_skins skins = { &skin, 1, of, d->positions };
    if (status == TOBI_OK) status = tobi_surface_make_skinned(d, &skins, s, err);
    if (status == TOBI_OK) status = tobi_surface_write("f.glb", *s, err);
    tobi_image_free(image);
    free(of);
    return status;
}

static tobi_status make_and_write(const rig_points *p, tobi_error *err)
{
    static double spacing[7*6*5];
    const tobi_surface_field field = { "place", 3, &p->position[0][0] };
    tobi_surface_def d = tobi_default_surface();
    tobi_surface *s = NULL;
    tobi_surface_movie *movie = NULL;
    d.particle_count = p->count, d.positions = (const double (*)[3])p->position;
    d.spacing = 0.01, d.threads = 1, d.smoothing = 2;
    d.fields = &field, d.field_count = 1;
    tobi_status status = tobi_surface_make(&d, &s, err);
    if (status == TOBI_OK) status = tobi_surface_write("f.ply", s, err);
    if (status == TOBI_OK) status = tobi_surface_write("f.vtp", s, err);
    if (status == TOBI_OK)
        status = tobi_surface_movie_create("f.glb", 2, (const double[3]){ 0, 1, 0 }, &movie, err);
    if (status == TOBI_OK) status = tobi_surface_movie_add(movie, 0, s, 0, 0, 1, err);
    if (status == TOBI_OK) status = tobi_surface_movie_finish(movie, err);
    tobi_surface_movie_free(movie);
    tobi_surface_free(s);
    s = NULL;
    d.spacings = spacing;                   /* two passes that become one mesh */
    for (int64_t i = 0; i < p->count; i++) spacing[i] = i > 0 ? 0.01 : 0.02;
    if (status == TOBI_OK) status = make_skinned(&d, &s, err);
    tobi_surface_free(s);
    return status;
}

static void test_every_allocation(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    rig_points p = rig_box((int[3]){ 7, 6, 5 }, (double[3]){ 0, 0, 0 }, 0.01, 0.5);
    p.position[0][0] = 1;                   /* a drop */
    assert_int_equal(make_and_write(&p, &err), TOBI_OK);
    const long before = allocations;
    assert_int_equal(make_and_write(&p, &err), TOBI_OK);
    const long needed = allocations - before;
    assert_true(needed > 40);
    for (long n = 1; n <= needed; n++) {
        size_t left = 0;
        for (int turn = 0; turn < 12; turn++) {      /* a leak grows in each; what malloc keeps does not */
            const size_t in_use = mallinfo2().uordblks;
            allocations = 0, fail_at = n;
            const tobi_status status = make_and_write(&p, &err);
            fail_at = 0;
            if (status != TOBI_NO_MEMORY && status != TOBI_OK)
                fail_msg("allocation %ld: status %d, %s", n, (int)status, err.text);
            const size_t now = mallinfo2().uordblks;
            if (turn == 0 || left > 0) left = now > in_use ? now - in_use : 0;
        }
        if (left > 0) fail_msg("allocation %ld: %zu bytes are left", n, left);
        const char *const parts[] = { "f.ply.part", "f.vtp.part", "f.glb.part" };
        for (int k = 0; k < 3; k++) assert_int_equal(access(parts[k], F_OK), -1);
    }
    unlink("f.ply"), unlink("f.vtp"), unlink("f.glb");
    free(p.position);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_every_allocation) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

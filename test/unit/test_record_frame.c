/* Pictures of what a blade has cut: each piece has its tint, the faces of the cut their colour. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "solid_rig.h"
#include "mpm/particle_fields.h"
#include "mpm/cut/cuts.h"
#include "tobiuo/run.h"
#include "world/world.h"

typedef struct image { int width, height; unsigned char *pixel; } image;

/* The picture of a plane block, 20 by 20 particles around the middle of the domain. A cut goes down from the
   middle of its top; a length of 0.5 cuts it through. */
static image take_picture(double length)
{
    char folder[] = "/tmp/tobiuo_frame_XXXXXX", path[100];
    solid_setup s = solid_default(2, 0.05, 3);
    tobi_output_def output = tobi_default_output_def();
    tobi_run *run;
    for (int a = 0; a < 2; a++) {
        s.fill.box_min[a] = 1;
        s.fill.box_max[a] = 2;
    }
    for (int a = 0; a < 3; a++) s.solid.color[a] = a == 0 ? 200 : 30;
    tobi_world *world = solid_world(&s);
    OK(tobi_world_start(world, &err));
    tobi_particles *p = &world->system[0].particles;
    mpm_fields *f = mpm_fields_of(p);
    p->needs |= MPM_NEED_BLADES;
    f->cuts = calloc((size_t)p->capacity + 16, sizeof *f->cuts);       /* as scenes with blades have it */
    assert_true(f->cuts && p->count == 400);
    for (int64_t i = 0; i < p->count; i++)
        if (f->rest[i].y > 2 - 2*length)
            f->cuts[i].c[0] = (tobi_float4){ f->rest[i].x - 1.5f, 0, 0, f->rest[i].x > 1.5f ? 1 : -1 };
    world->fresh = 0;                   /* the cuts were made behind its back */
    assert_non_null(mkdtemp(folder));
    output.frames = 1;
    OK(tobi_run_create(world, &output, folder, 1, NULL, &run, &err));
    snprintf(path, sizeof path, "%s/frames/frame_000000.png", folder);
    png_image png = { .version = PNG_IMAGE_VERSION };
    assert_true(png_image_begin_read_from_file(&png, path));
    png.format = PNG_FORMAT_RGB;
    image i = { (int)png.width, (int)png.height, malloc(PNG_IMAGE_SIZE(png)) };
    assert_true(i.pixel && png_image_finish_read(&png, NULL, i.pixel, 0, NULL));
    double seconds;
    assert_int_equal(tobi_run_pictures(run, &seconds), 1);
    assert_true(seconds > 0 && seconds < 60 && tobi_run_pictures(run, NULL) == 1);
    tobi_run_free(run);
    tobi_world_destroy(world);
    snprintf(path, sizeof path, "rm -r %s", folder);
    assert_int_equal(system(path), 0);
    return i;
}

static const unsigned char *at(const image *i, int x, int y) { return i->pixel + 3*(y*i->width + x); }
static int sum_of(const unsigned char *p) { return p[0] + p[1] + p[2]; }

/* The block, which is red: its left and upper end, and its size. */
static void find_block(const image *i, int *left, int *top, int *size)
{
    int right = 0;
    *left = *top = i->width;
    for (int y = 0; y < i->height; y++)
        for (int x = 0; x < i->width; x++) {
            const unsigned char *p = at(i, x, y);
            if (p[0] < 2*p[1]) continue;
            if (x < *left) *left = x;
            if (y < *top) *top = y;
            if (x > right) right = x;
        }
    *size = right + 1 - *left;
    assert_true(*size > 100);
}

/* Of 200 points of the block at these shares of its width and height: how many differ, and are paler. */
static void compare(const image *a, const image *b, double x0, double x1, double y0, double y1, int *differ,
                    int *paler)
{
    int left, top, size;
    find_block(a, &left, &top, &size);
    *differ = *paler = 0;
    for (int k = 0; k < 200; k++) {
        const int x = left + (int)(size*(x0 + (x1 - x0)*(k%10 + 0.5)/10));
        const int y = top + (int)(size*(y0 + (y1 - y0)*(k/10 + 0.5)/20));
        *differ += memcmp(at(a, x, y), at(b, x, y), 3) != 0;
        *paler += sum_of(at(b, x, y)) > sum_of(at(a, x, y)) + 60;
    }
}

static void pieces_and_faces_have_colours(void **state)
{
    (void)state;
    int differ, paler;
    const image whole = take_picture(0), half = take_picture(0.25), parted = take_picture(0.5);
    compare(&whole, &parted, 0.05, 0.4, 0.05, 0.95, &differ, &paler);      /* the first piece */
    assert_int_equal(differ, 0);
    compare(&whole, &parted, 0.6, 0.95, 0.05, 0.95, &differ, &paler);      /* the second */
    assert_int_equal(differ, 200);
    compare(&whole, &parted, 0.46, 0.54, 0.05, 0.95, &differ, &paler);     /* the faces */
    assert_true(paler > 190);
    compare(&whole, &half, 0.05, 0.45, 0.05, 0.95, &differ, &paler);       /* not cut through: one piece */
    assert_int_equal(differ, 0);
    compare(&whole, &half, 0.56, 0.95, 0.05, 0.95, &differ, &paler);
    assert_int_equal(differ, 0);
    compare(&whole, &half, 0.46, 0.54, 0.05, 0.45, &differ, &paler);
    assert_true(paler > 190);
    compare(&whole, &half, 0.46, 0.54, 0.6, 0.95, &differ, &paler);
    assert_int_equal(differ, 0);
    free(whole.pixel);
    free(half.pixel);
    free(parted.pixel);
}

static void wrong_names_are_refused(void **state)
{
    (void)state;
    solid_setup s = solid_default(2, 0.05, 3);
    tobi_output_def output = tobi_default_output_def();
    tobi_run *run;
    tobi_error err = { 0 };
    s.fill.box_min[0] = s.fill.box_min[1] = 1;
    s.fill.box_max[0] = s.fill.box_max[1] = 2;
    tobi_world *world = solid_world(&s);
    output.view.follow = "nobody";
    tobi_status status = tobi_run_create(world, &output, "unmade", 1, NULL, &run, &err);
    assert_int_equal(status, TOBI_INVALID);
    assert_string_equal(err.text, "output.picture.follow: there is no body 'nobody'");
    output.view.follow = NULL;
    output.view.field = "colour";
    status = tobi_run_create(world, &output, "unmade", 1, NULL, &run, &err);
    assert_int_equal(status, TOBI_INVALID);
    assert_string_equal(err.text, "output.picture.field: there is no field 'colour' of mlsmpm");
    assert_int_not_equal(access("unmade", F_OK), 0);
    tobi_world_destroy(world);
}

static void refuse(tobi_world *world, const tobi_output_def *output, const char *words)
{
    tobi_run *run;
    tobi_error err = { 0 };
    assert_int_equal(tobi_run_create(world, output, "unmade", 1, NULL, &run, &err), TOBI_INVALID);
    assert_string_equal(err.text, words);
}

static void views_have_names_of_their_own(void **state)
{
    (void)state;
    solid_setup s = solid_default(2, 0.05, 3);
    tobi_view_def views[2];
    tobi_output_def output = tobi_default_output_def();
    s.fill.box_min[0] = s.fill.box_min[1] = 1;
    s.fill.box_max[0] = s.fill.box_max[1] = 2;
    tobi_world *world = solid_world(&s);
    for (int k = 0; k < 2; k++) {
        tobi_param_defaults(&tobi_view_table, &views[k]);
        views[k].name = "side";
    }
    output.view_count = 9;
    refuse(world, &output, "output.views: has 9 entries, allowed are 0 to 8");
    output.views = views;
    output.view_count = 2;
    refuse(world, &output, "output.views[1].name: 'side' is taken");
    views[1].name = "a/b";
    refuse(world, &output, "output.views[1].name: is no name of files");
    views[1].name = "frame";
    refuse(world, &output, "output.views[1].name: 'frame' is taken");
    views[1].name = "top";
    views[1].follow = "nobody";
    refuse(world, &output, "output.views[1].picture.follow: there is no body 'nobody'");
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(pieces_and_faces_have_colours),
                                        cmocka_unit_test(wrong_names_are_refused),
                                        cmocka_unit_test(views_have_names_of_their_own) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Lines and letters over pixels, cut off at the edges; a picture in memory is that of the file. */
#define _GNU_SOURCE 1
#include "tobiuo/overlay.h"
#include "tobiuo/picture.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <png.h>
#include <unistd.h>
#include <cmocka.h>

enum { W = 64, H = 32 };
static const uint8_t white[3] = { 255, 255, 255 };
static uint8_t pixels[H + 2][W][3];      /* a row of guards above and below */
static tobi_overlay over = { &pixels[1][0][0], W, H, NULL };

static long sum_of(int from, int to)
{
    long sum = 0;
    for (int y = from; y < to; y++)
        for (int x = 0; x < W; x++) sum += pixels[y][x][1];
    return sum;
}

static void boxes_and_lines_stay_inside(void **state)
{
    (void)state;
    memset(pixels, 0, sizeof pixels);
    tobi_overlay_box(&over, 10, 4, 3, 2, white, 1);
    assert_int_equal(sum_of(1, H + 1), 6*255);
    assert_int_equal(pixels[1 + 5][12][0], 255);
    tobi_overlay_box(&over, -5, -5, 200, 200, white, 0.5f);
    assert_int_equal(pixels[1][0][0], 128);
    tobi_overlay_line(&over, -50, -9, 90, 77, 9, white);
    tobi_overlay_line(&over, NAN, 0, 1, 1, 1, white);
    tobi_overlay_text(&over, 50, 2, 40, "ABC\x80~", white);
    tobi_overlay_text(&over, -20, 31, 12, "g_|", white);
    assert_int_equal(sum_of(0, 1) + sum_of(H + 1, H + 2), 0);
}

static void lines_are_as_thick_as_asked(void **state)
{
    (void)state;
    memset(pixels, 0, sizeof pixels);
    tobi_overlay_line(&over, 10, 16, 50, 16, 4, white);
    assert_true(labs(sum_of(1, H + 1) - (long)(255*(40*4 + 3.14159*4))) < 255*6);
}

static void text_is_as_wide_as_said(void **state)
{
    (void)state;
    memset(pixels, 0, sizeof pixels);
    const float wide = tobi_overlay_text(&over, 4, 20, 9, "10.5 m", white);
    assert_float_equal(wide, tobi_overlay_text_width(&over, 9, "10.5 m"), 1e-4);
    assert_true(sum_of(1, H + 1) > 255*20);
    for (int y = 1; y <= H; y++)
        for (int x = 5 + (int)wide; x < W; x++) assert_int_equal(pixels[y][x][1], 0);
}

static void a_picture_in_memory_is_that_of_the_file(void **state)
{
    (void)state;
    const double positions[2][3] = { { 0.3, 0.5, 0.2 }, { 0.6, 0.5, 0.2 } };
    tobi_picture f = tobi_default_picture();
    tobi_error err;
    char path[] = "/tmp/tobi_overlay_XXXXXX";
    f.width = 80;
    f.height = 60;
    f.dimension = 3;
    for (int a = 0; a < 3; a++) f.box_max[a] = 1;
    f.positions = positions;
    f.particle_count = 2;
    f.radius = 0.1;
    uint8_t *rgb = malloc(80*60*3), *read = malloc(80*60*3);
    close(mkstemp(path));
    assert_int_equal(tobi_picture_draw(&f, rgb, &err), TOBI_OK);
    assert_int_equal(tobi_picture_write(path, &f, &err), TOBI_OK);
    png_image image = { .version = PNG_IMAGE_VERSION };
    assert_true(png_image_begin_read_from_file(&image, path));
    image.format = PNG_FORMAT_RGB;
    assert_true(png_image_finish_read(&image, NULL, read, 0, NULL));
    assert_memory_equal(rgb, read, 80*60*3);
    assert_int_equal(tobi_picture_draw(&f, NULL, &err), TOBI_INVALID);
    assert_int_equal(tobi_picture_draw(NULL, rgb, &err), TOBI_INVALID);
    f.width = 3;
    assert_int_equal(tobi_picture_draw(&f, rgb, &err), TOBI_INVALID);
    unlink(path);
    free(rgb);
    free(read);
}

/* One dark disc behind all: around the colour bar it is made lighter, so that dark letters show there. */
static void scales_show_on_dark_water(void **state)
{
    (void)state;
    enum { ACROSS = 320, DOWN = 180 };
    const double position[1][3] = { { 0.5, 0.5, 0 } };
    const float slow[1] = { 0 };
    tobi_picture f = tobi_default_picture();
    tobi_error err;
    uint8_t *bare = malloc(ACROSS*DOWN*3), *with = malloc(ACROSS*DOWN*3);
    f.width = ACROSS, f.height = DOWN, f.dimension = 2;
    f.box_max[0] = f.box_max[1] = 1;
    f.positions = position, f.values = slow, f.particle_count = 1, f.radius = 9, f.value_max = 1;
    assert_int_equal(tobi_picture_draw(&f, bare, &err), TOBI_OK);
    f.label = "speed [m/s]";
    assert_int_equal(tobi_picture_draw(&f, with, &err), TOBI_OK);
    const int beside = 3*(DOWN/2*ACROSS + (int)(0.92*ACROSS)), far = 3*(DOWN/2*ACROSS + ACROSS/2);
    assert_true(bare[beside] < 60 && with[beside] > 150);
    assert_memory_equal(bare + far, with + far, 3);
    free(bare);
    free(with);
}

static int green_of(float value)
{
    enum { ACROSS = 160, DOWN = 90 };
    static const double position[1][3] = { { 0.5, 0.5, 0 } };
    static uint8_t pixel[3*ACROSS*DOWN];
    tobi_error err;
    tobi_picture f = tobi_default_picture();
    f.width = ACROSS, f.height = DOWN, f.dimension = 2;
    f.box_max[0] = f.box_max[1] = 1;
    f.positions = position, f.values = &value, f.particle_count = 1, f.radius = 9, f.value_max = 1;
    assert_int_equal(tobi_picture_draw(&f, pixel, &err), TOBI_OK);
    return pixel[3*(DOWN/2*ACROSS + ACROSS/2) + 1];
}

/* A wave at a tenth of the largest speed differs from water at rest, and 0.8 from 1. */
static void slow_water_differs_from_water_at_rest(void **state)
{
    (void)state;
    const int rest = green_of(0), slow = green_of(0.1f), fast = green_of(0.8f), fastest = green_of(1);
    print_message("green %d, %d, %d, %d\n", rest, slow, fast, fastest);
    assert_true(slow > rest + 45 && fast > slow && fastest > fast + 10);
}

/* Japanese letters come from another font than Latin ones; without any font nothing is drawn. */
static void letters_of_two_fonts_stand_in_a_row(void **state)
{
    (void)state;
    const tobi_overlay none = { &pixels[1][0][0], W, H, NULL };
    memset(pixels, 0, sizeof pixels);
    assert_float_equal(tobi_overlay_text(&none, 4, 20, 9, "10.5 m", white), 0, 0);
    assert_int_equal(sum_of(0, H + 2), 0);
    assert_true(tobi_letters_have(over.letters, "speed [m/s]"));
    assert_false(tobi_letters_have(over.letters, "a\xf4\x8f\xbf\xbd"));      /* U+10FFFD is nobody's */
    print_message("font: %s\n", tobi_letters_font(over.letters));
    if (!tobi_letters_have(over.letters, "\xe5\x9c\xa7")) skip();
    const float both = tobi_overlay_text_width(&over, 9, "m\xe5\x9c\xa7m");
    const float latin = tobi_overlay_text_width(&over, 9, "m");
    assert_float_equal(both, 2*latin + tobi_overlay_text_width(&over, 9, "\xe5\x9c\xa7"), 1e-4);
    assert_true(both > 2*9);
    assert_true(tobi_overlay_text(&over, 20, 20, 9, "\xe5\x9c\xa7", white) > 9);
    assert_true(sum_of(1, H + 1) > 255*20);
}

int main(void)
{
    over.letters = tobi_letters_open();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_and_lines_stay_inside), cmocka_unit_test(lines_are_as_thick_as_asked),
        cmocka_unit_test(scales_show_on_dark_water),
        cmocka_unit_test(slow_water_differs_from_water_at_rest),
        cmocka_unit_test(text_is_as_wide_as_said), cmocka_unit_test(letters_of_two_fonts_stand_in_a_row),
        cmocka_unit_test(a_picture_in_memory_is_that_of_the_file),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    tobi_letters_close(over.letters);
    return failed;
}

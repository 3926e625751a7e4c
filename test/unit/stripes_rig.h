/* A picture of six stripes that tests put on bodies and solids, and which of them a pixel shows. */
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <png.h>
#include "tobiuo/run.h"

/* Six stripes of one colour each, 60 pixels wide. */
static const uint8_t stripe[6][3] = { { 230, 20, 20 }, { 20, 200, 20 }, { 20, 20, 230 },
                                      { 220, 220, 20 }, { 220, 20, 220 }, { 20, 220, 220 } };

static inline void write_stripes(const char *path)
{
    enum { W = 360, H = 40 };
    static uint8_t rgb[H][W][3];
    png_image image = { .version = PNG_IMAGE_VERSION, .width = W, .height = H, .format = PNG_FORMAT_RGB };
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) memcpy(rgb[y][x], stripe[x/60], 3);
    assert_true(png_image_write_to_file(&image, path, 0, rgb, 0, NULL));
}

/* The stripe that a colour is of, by its direction; -1: gray, a core. */
static inline int find_stripe(const uint8_t *rgb)
{
    double best = 0, size = sqrt((double)rgb[0]*rgb[0] + rgb[1]*rgb[1] + rgb[2]*rgb[2]);
    int found = -1;
    const int most = rgb[0] > rgb[1] ? rgb[0] > rgb[2] ? rgb[0] : rgb[2] : rgb[1] > rgb[2] ? rgb[1] : rgb[2];
    const int least = rgb[0] < rgb[1] ? rgb[0] < rgb[2] ? rgb[0] : rgb[2] : rgb[1] < rgb[2] ? rgb[1] : rgb[2];
    if (most - least < 30) return -1;
    for (int k = 0; k < 6; k++) {
        double dot = 0, own = 0;
        for (int c = 0; c < 3; c++) {
            dot += (double)rgb[c]*stripe[k][c];
            own += (double)stripe[k][c]*stripe[k][c];
        }
        if (dot/(size*sqrt(own)) > best) best = dot/(size*sqrt(own)), found = k;
    }
    return found;
}

static inline void add_field(tobi_world *w, tobi_moment *m, const char *name, int components)
{
    tobi_moment_field *f = &m->fields[m->field_count++];
    tobi_error err = { 0 };
    *f = (tobi_moment_field){ strdup(name), components,
                              calloc((size_t)(m->count*components), sizeof(double)) };
    if (tobi_world_read(w, TOBI_FLUID, name, f->values, m->count*components, &err)) fail_msg("%s", err.text);
}

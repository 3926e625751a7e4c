/* Images on skins: an image and its halves, quarters ..., and the colour at a place of it. Inline, because
   the loops over pixels are compiled once per instruction set. */
#pragma once
#include "view/draw.h"

enum { IMAGE_LEVELS = 15, IMAGE_MOST_PIXELS = 8192, IMAGE_WHY = 200 };

/* What a decoder makes: pixels of three bytes, rows from the top, the caller's to free; or why not. */
typedef struct image_pixels {
    char why[IMAGE_WHY];
    int width, height;
    uint8_t *rgb;
} image_pixels;
bool image_is_jpeg(const unsigned char *data, size_t size);
bool image_read_jpeg(const unsigned char *data, size_t size, image_pixels *out);

struct tobi_image {
    int users;                   /* atomic                                                         */
    int levels;
    int width[IMAGE_LEVELS], height[IMAGE_LEVELS];
    uint8_t *rgb[IMAGE_LEVELS];  /* sRGB, rows from the top                                        */
    float linear[256];           /* of a byte                                                      */
};

/* A colour that stands for an image: its place in it and, below 0, its number. */
static inline vec image_mark(const float uv[2], int number)
{
    return (vec){ uv[0], uv[1], -1 - (float)number };
}
static inline bool is_image_mark(float z) { return z < -0.5f; }
static inline int image_number(float z) { return (int)(-z - 0.5f); }

/* Level whose pixels are not much smaller than those of the picture; square: pixels of the image, squared,
   on one of the picture. */
static inline int image_level(const tobi_image *image, float square)
{
    int level = 0;
    for (; square > 2 && level + 1 < image->levels; level++) square *= 0.25f;
    return level;
}

static inline int image_wrap(int i, int n)
{
    return i < 0 ? n - 1 : i >= n ? 0 : i;
}

static inline vec image_pixel(const tobi_image *image, int level, int x, int y)
{
    const uint8_t *p = image->rgb[level] + 3*((int64_t)y*image->width[level] + x);
    return (vec){ image->linear[p[0]], image->linear[p[1]], image->linear[p[2]] };
}

/* Between the four pixels around; v rises from the lower edge. Repeats. */
static inline vec image_color(const tobi_image *image, int level, float u, float v)
{
    const int w = image->width[level], h = image->height[level];
    u = clampf(u, -1e6f, 1e6f), v = clampf(1 - v, -1e6f, 1e6f);
    u -= (float)(int)u, v -= (float)(int)v;
    u = u < 0 ? u + 1 : u, v = v < 0 ? v + 1 : v;
    const float x = u*(float)w - 0.5f, y = v*(float)h - 0.5f;
    const int i = (int)(x + 1) - 1, j = (int)(y + 1) - 1;
    const float s = x - (float)i, t = y - (float)j;
    const int i0 = image_wrap(i, w), i1 = image_wrap(i + 1, w);
    const int j0 = image_wrap(j, h), j1 = image_wrap(j + 1, h);
    return vec_mix(vec_mix(image_pixel(image, level, i0, j0), image_pixel(image, level, i1, j0), s),
                   vec_mix(image_pixel(image, level, i0, j1), image_pixel(image, level, i1, j1), s), t);
}

/* Converts to sRGB and writes by libpng, whose errors jump. Drawback: compression is on one thread. */
#define _GNU_SOURCE 1
#include "view/draw.h"
#include "base/file.h"
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <zlib.h>

enum { CURVE = 4096 };

static void put_bytes(png_structp png, png_bytep data, png_size_t bytes)
{
    tobi_file_write(png_get_io_ptr(png), data, bytes);
}

static void put_nothing(png_structp png) { (void)png; }

static void stay_silent(png_structp png, png_const_charp text) { (void)png, (void)text; }

static void leave(png_structp png, png_const_charp text)
{
    (void)text;
    png_longjmp(png, 1);
}

/* libpng leaves by longjmp, so nothing here may live in a register across it. Of one filter and runs
   alone: about as small as at libpng's own choice, and twice as quick. */
static bool encode(tobi_file *file, int width, int height, int channels, unsigned char *bytes)
{
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, leave, stay_silent);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!info || setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_set_write_fn(png, file, put_bytes, put_nothing);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, 8,
                 channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_compression_level(png, 1);
    png_set_compression_strategy(png, Z_RLE);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_write_info(png, info);
    for (int y = 0; y < height; y++) png_write_row(png, bytes + (size_t)y*(size_t)width*(size_t)channels);
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    return true;
}

typedef struct encoding {
    const canvas *c;
    unsigned char *bytes;
    int channels;
    unsigned char curve[CURVE];      /* of linear light the sRGB value */
} encoding;

enum { STRIP = 256 };            /* pixels whose places on the curve are found together */

static void encode_rows(const void *view, int64_t begin, int64_t end)
{
    const encoding *e = view;
    const int64_t last = end*e->c->width;
    int32_t at[3*STRIP];
    for (int64_t first = begin*e->c->width; first < last; first += STRIP) {
        const int n = (int)(last - first < STRIP ? last - first : STRIP);
        const float *linear = &e->c->color[first].x;
        TOBI_SIMD
        for (int k = 0; k < 3*n; k++) {
            const float in = linear[k] > 0 ? linear[k] : 0;
            at[k] = (int32_t)((in < 1 ? in : 1)*(CURVE - 1) + 0.5f);
        }
        unsigned char *to = e->bytes + e->channels*first;
        for (int k = 0; k < n; k++, to += e->channels) {
            for (int m = 0; m < 3; m++) to[m] = e->curve[at[3*k + m]];
            if (e->channels == 4) to[3] = (unsigned char)(255*e->c->alpha[first + k] + 0.5f);
        }
    }
}

/* Dither-free sRGB; 4096 steps of the curve are finer than 8 bits except in the darkest tones. */
void view_encode_colors(const canvas *c, int channels, unsigned char *bytes)
{
    encoding e = { c, bytes, channels, { 0 } };
    for (int k = 0; k < CURVE; k++) {
        float l = (float)k/(CURVE - 1), s = l <= 0.0031308f ? 12.92f*l : 1.055f*powf(l, 1/2.4f) - 0.055f;
        e.curve[k] = (unsigned char)(255*s + 0.5f);
    }
    tobi_loop(c->threads, c->height, 0, encode_rows, &e);
}

tobi_status view_write_png(const char *path, const canvas *c, tobi_error *err)
{
    const int channels = c->alpha ? 4 : 3;
    unsigned char *bytes = malloc((size_t)c->width*(size_t)c->height*(size_t)channels);
    if (!bytes) return tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", path);
    view_encode_colors(c, channels, bytes);
    tobi_file file;
    tobi_status status = tobi_file_open(&file, path, err);
    if (status == TOBI_OK) {
        if (encode(&file, c->width, c->height, channels, bytes)) {
            status = tobi_file_commit(&file, err);
        } else {
            tobi_file_abandon(&file);
            status = tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", path);
        }
    }
    free(bytes);
    return status;
}

/* Averages samples to pixels, converts to sRGB, and writes by libpng, whose errors jump. Drawback:
   compression is on one thread. */
#define _GNU_SOURCE 1
#include "view/draw.h"
#include "base/file.h"
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>

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

/* libpng leaves by longjmp, so nothing here may live in a register across it. */
static bool encode(tobi_file *file, int width, int height, unsigned char *bytes)
{
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, leave, stay_silent);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!info || setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_set_write_fn(png, file, put_bytes, put_nothing);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_compression_level(png, 4);
    png_write_info(png, info);
    for (int y = 0; y < height; y++) png_write_row(png, bytes + (size_t)y*(size_t)width*3);
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    return true;
}

static unsigned char encode_channel(const unsigned char *curve, float linear)
{
    return curve[(int)(clampf(linear, 0, 1)*(CURVE - 1) + 0.5f)];
}

/* Dither-free sRGB; 4096 steps of the curve are finer than 8 bits except in the darkest tones. */
static void encode_colors(const image *i, unsigned char *bytes)
{
    unsigned char curve[CURVE];
    for (int k = 0; k < CURVE; k++) {
        float l = (float)k/(CURVE - 1), s = l <= 0.0031308f ? 12.92f*l : 1.055f*powf(l, 1/2.4f) - 0.055f;
        curve[k] = (unsigned char)(255*s + 0.5f);
    }
    for (size_t k = 0; k < (size_t)i->width*(size_t)i->height; k++) {
        bytes[3*k] = encode_channel(curve, i->color[k].x);
        bytes[3*k + 1] = encode_channel(curve, i->color[k].y);
        bytes[3*k + 2] = encode_channel(curve, i->color[k].z);
    }
}

tobi_status view_write_png(const char *path, const image *i, tobi_error *err)
{
    unsigned char *bytes = malloc((size_t)i->width*(size_t)i->height*3);
    if (!bytes) return tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", path);
    encode_colors(i, bytes);
    tobi_file file;
    tobi_status status = tobi_file_open(&file, path, err);
    if (status == TOBI_OK) {
        if (encode(&file, i->width, i->height, bytes)) {
            status = tobi_file_commit(&file, err);
        } else {
            tobi_file_abandon(&file);
            status = tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", path);
        }
    }
    free(bytes);
    return status;
}

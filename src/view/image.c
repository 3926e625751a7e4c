/* Images for skins: PNG by libpng, whose errors jump, JPEG by jpeg.c; and halved until one pixel is
   left. Halves are means of linear light. Drawback: a third more memory than the image alone, in bytes, not
   in floats. */
#define _GNU_SOURCE 1
#include "view/image.h"
#include "base/plain.h"
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

void tobi_image_free(tobi_image *image)
{
    if (!image || __atomic_sub_fetch(&image->users, 1, __ATOMIC_ACQ_REL) > 0) return;
    for (int k = 0; k < IMAGE_LEVELS; k++) free(image->rgb[k]);
    free(image);
}

tobi_image *tobi_image_share(tobi_image *image)
{
    if (image) __atomic_add_fetch(&image->users, 1, __ATOMIC_RELAXED);
    return image;
}

static uint8_t to_byte(const float *linear, float value)
{
    int low = 0, high = 255;
    while (high - low > 1) {
        const int middle = (low + high)/2;
        if (linear[middle] <= value) low = middle;
        else high = middle;
    }
    return (uint8_t)(value - linear[low] < linear[high] - value ? low : high);
}

/* A pixel is the mean of up to four; of an odd edge the last pixel counts twice. */
static bool halve(tobi_image *m, int level)
{
    const int w = m->width[level - 1], h = m->height[level - 1];
    const int across = m->width[level] = w > 1 ? w/2 : 1, down = m->height[level] = h > 1 ? h/2 : 1;
    const uint8_t *from = m->rgb[level - 1];
    uint8_t *to = m->rgb[level] = malloc((size_t)across*(size_t)down*3);
    if (!to) return false;
    for (int y = 0; y < down; y++)
        for (int x = 0; x < across; x++) {
            const int x1 = 2*x + 1 < w ? 2*x + 1 : w - 1, y1 = 2*y + 1 < h ? 2*y + 1 : h - 1;
            const int at[4] = { 2*y*w + 2*x, 2*y*w + x1, y1*w + 2*x, y1*w + x1 };
            for (int c = 0; c < 3; c++) {
                float sum = 0;
                for (int k = 0; k < 4; k++) sum += m->linear[from[3*(int64_t)at[k] + c]];
                to[3*((int64_t)y*across + x) + c] = to_byte(m->linear, 0.25f*sum);
            }
        }
    return true;
}

/* rgb becomes the image's, on failure too. */
static tobi_status make(int width, int height, uint8_t *rgb, tobi_image **out, tobi_error *err)
{
    tobi_image *m = *out = rgb ? calloc(1, sizeof *m) : NULL;
    if (!m) {
        free(rgb);
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for an image of %d x %d pixels", width, height);
    }
    m->users = 1;
    m->rgb[0] = rgb;
    m->width[0] = width, m->height[0] = height;
    for (int k = 0; k < 256; k++) m->linear[k] = to_linear((float)k/255);
    for (m->levels = 1; m->width[m->levels - 1] > 1 || m->height[m->levels - 1] > 1; m->levels++)
        if (!halve(m, m->levels)) {
            tobi_image_free(m);
            *out = NULL;
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for an image of %d x %d pixels", width, height);
        }
    return TOBI_OK;
}

tobi_status tobi_image_make(int width, int height, const uint8_t *rgb, tobi_image **image, tobi_error *err)
{
    TOBI_NEED(image, "the place for the image");
    *image = NULL;
    TOBI_NEED(rgb, "its pixels");
    if (width < 1 || height < 1 || width > IMAGE_MOST_PIXELS || height > IMAGE_MOST_PIXELS)
        return tobi_fail(err, TOBI_INVALID, "an image of %d x %d pixels, allowed are 1 to %d", width, height,
                         IMAGE_MOST_PIXELS);
    const size_t bytes = (size_t)width*(size_t)height*3;
    uint8_t *copy = malloc(bytes);
    if (copy) memcpy(copy, rgb, bytes);
    return make(width, height, copy, image, err);
}

typedef struct source { const unsigned char *data; size_t left; } source;

static void get_bytes(png_structp png, png_bytep data, png_size_t bytes)
{
    source *from = png_get_io_ptr(png);
    if (bytes > from->left) png_error(png, tr("it ends early"));
    memcpy(data, from->data, bytes);
    from->data += bytes, from->left -= bytes;
}

static void stay_silent(png_structp png, png_const_charp text) { (void)png, (void)text; }

static void leave(png_structp png, png_const_charp text)
{
    image_pixels *d = png_get_error_ptr(png);
    snprintf(d->why, sizeof d->why, "%s", text);
    png_longjmp(png, 1);
}

/* Anything that PNG has becomes three bytes a pixel; what is transparent is seen before white. */
static void decode(png_structp png, png_infop info, image_pixels *d)
{
    const png_color_16 white = { .red = 255, .green = 255, .blue = 255, .gray = 255 };
    png_read_info(png, info);
    d->width = (int)png_get_image_width(png, info);
    d->height = (int)png_get_image_height(png, info);
    png_set_scale_16(png);
    png_set_expand(png);
    png_set_gray_to_rgb(png);
    png_set_background(png, &white, PNG_BACKGROUND_GAMMA_SCREEN, 0, 1);
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    const size_t row = (size_t)d->width*3;
    if (png_get_rowbytes(png, info) != row) png_error(png, tr("it has no colours that are known"));
    d->rgb = malloc(row*(size_t)d->height);
    if (!d->rgb) png_error(png, tr("no memory for its pixels"));
    for (int pass = 0; pass < passes; pass++)
        for (int y = 0; y < d->height; y++) png_read_row(png, d->rgb + row*(size_t)y, NULL);
}

/* libpng leaves by longjmp, so nothing here may live in a register across it. */
static bool read_png(source *from, image_pixels *d)
{
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, d, leave, stay_silent);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!info || setjmp(png_jmpbuf(png))) {
        png_destroy_read_struct(&png, &info, NULL);
        if (!d->why[0]) snprintf(d->why, sizeof d->why, tr("no memory"));
        return false;
    }
    png_set_user_limits(png, IMAGE_MOST_PIXELS, IMAGE_MOST_PIXELS);
    png_set_read_fn(png, from, get_bytes);
    decode(png, info, d);
    png_destroy_read_struct(&png, &info, NULL);
    return true;
}

tobi_status tobi_image_read(const char *path, tobi_image **image, tobi_error *err)
{
    char *text;
    size_t size;
    image_pixels d = { .width = 0 };
    TOBI_NEED(image, "the place for the image");
    *image = NULL;
    TOBI_NEED(path, "the path");
    TOBI_TRY(tobi_plain_read(path, tr("texture"), (int64_t)1 << 30, &text, &size, err));
    const unsigned char *data = (const unsigned char *)text;
    source from = { data, size };
    const bool jpeg = image_is_jpeg(data, size);
    if (!jpeg && (size < 8 || png_sig_cmp(data, 0, 8) != 0)) {
        free(text);
        return tobi_fail(err, TOBI_INVALID, "texture '%s' is no PNG or JPEG file", path);
    }
    const bool good = jpeg ? image_read_jpeg(data, size, &d) : read_png(&from, &d);
    free(text);
    if (good) return make(d.width, d.height, d.rgb, image, err);
    free(d.rgb);
    return tobi_fail(err, TOBI_INVALID, "texture '%s' cannot be read: %s", path, d.why);
}

void tobi_image_color(const tobi_image *image, const float uv[2], float rgb[3])
{
    if (!image || !uv || !rgb) return;
    const vec color = image_color(image, 0, uv[0], uv[1]);
    const float linear[3] = { color.x, color.y, color.z };
    for (int c = 0; c < 3; c++) rgb[c] = (float)to_byte(image->linear, linear[c])/255;
}

void tobi_image_size(const tobi_image *image, int *width, int *height, const uint8_t **rgb)
{
    if (width) *width = image ? image->width[0] : 0;
    if (height) *height = image ? image->height[0] : 0;
    if (rgb) *rgb = image ? image->rgb[0] : NULL;
}

/* A picture sheet: a dozen moments of a run, small, beside each other in one PNG. Pixels are averages in
   sRGB, which darkens fine light lines a little; that is not seen at this size. */
#define _GNU_SOURCE
#include "app.h"
#include <errno.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { COLUMNS = 4, MOMENTS = 12, CELL = 320, GAP = 4 };       /* pixels */

typedef struct sheet {
    pictures row;                       /* of the run             */
    int cells, columns, cell_height;
    png_image image;
    png_bytep pixels;                   /* owned                  */
} sheet;

/* The picture of an output as RGB, a transparent one on white. Returns 1, or 0 and image->message; *pixels is
   the caller's. */
static int read_picture(const char *path, png_image *image, png_bytep *pixels)
{
    static const png_color white = { 255, 255, 255 };
    *image = (png_image){ .version = PNG_IMAGE_VERSION };
    *pixels = NULL;
    if (png_image_begin_read_from_file(image, path)) {
        image->format = PNG_FORMAT_RGB;
        *pixels = malloc(PNG_IMAGE_SIZE(*image) + 1);
        if (*pixels && png_image_finish_read(image, &white, *pixels, 0, NULL)) return 1;
    }
    if (!*image->message) snprintf(image->message, sizeof image->message, "out of memory");
    png_image_free(image);
    free(*pixels);
    *pixels = NULL;
    return 0;
}

int is_damaged(const char *path)
{
    png_image image;
    png_bytep pixels;
    const int whole = read_picture(path, &image, &pixels);
    free(pixels);
    return !whole;
}

/* Averages the picture into the cell whose corner is at (x0, y0). */
static void shrink(const sheet *s, const png_image *from, png_const_bytep pixels, unsigned x0, unsigned y0)
{
    for (unsigned y = 0; y < (unsigned)s->cell_height; y++)
        for (unsigned x = 0; x < CELL; x++) {
            const unsigned left = x*from->width/CELL, top = y*from->height/(unsigned)s->cell_height;
            unsigned right = (x + 1)*from->width/CELL, bottom = (y + 1)*from->height/(unsigned)s->cell_height;
            unsigned sum[3] = { 0 };
            if (right == left) right++;
            if (bottom == top) bottom++;
            for (unsigned v = top; v < bottom; v++)
                for (unsigned u = left; u < right; u++)
                    for (unsigned k = 0; k < 3; k++) sum[k] += pixels[3*((size_t)v*from->width + u) + k];
            const unsigned n = (right - left)*(bottom - top);
            for (unsigned k = 0; k < 3; k++)
                s->pixels[3*((size_t)(y0 + y)*s->image.width + x0 + x) + k] = (png_byte)((sum[k] + n/2)/n);
        }
}

/* The first picture says how high a cell is. */
static int lay_out(sheet *s, const png_image *first)
{
    s->cells = s->row.count < MOMENTS ? (int)s->row.count : MOMENTS;
    s->columns = s->cells < COLUMNS ? s->cells : COLUMNS;
    s->cell_height = (int)(((double)first->height*CELL)/first->width + 0.5);
    if (s->cell_height < 1) s->cell_height = 1;
    const int rows = (s->cells + s->columns - 1)/s->columns;
    s->image = (png_image){ .version = PNG_IMAGE_VERSION, .format = PNG_FORMAT_RGB,
                            .width = (png_uint_32)(s->columns*(CELL + GAP) - GAP),
                            .height = (png_uint_32)(rows*(s->cell_height + GAP) - GAP) };
    s->pixels = malloc(PNG_IMAGE_SIZE(s->image));
    if (!s->pixels) return complain("out of memory");
    memset(s->pixels, 255, PNG_IMAGE_SIZE(s->image));
    return 0;
}

static int draw_cell(sheet *s, const char *dir, const char *view, int cell)
{
    const int64_t ways = s->cells > 1 ? (s->row.end - s->row.first - 1)*cell/(s->cells - 1) : 0;
    const int64_t number = shown_picture(dir, view, &s->row, s->row.first + ways);
    png_image image;
    png_bytep pixels;
    char *path = frame_path(dir, view, number);
    if (!path) return complain("out of memory");
    int code = 0;
    if (!read_picture(path, &image, &pixels))
        code = complain("cannot read %s: %s; delete it, and tobiuo movie draws it anew from the results",
                        path, image.message);
    if (code == 0 && cell == 0) code = lay_out(s, &image);
    if (code == 0)
        shrink(s, &image, pixels, (unsigned)(cell%s->columns*(CELL + GAP)),
               (unsigned)(cell/s->columns*(s->cell_height + GAP)));
    free(pixels);
    free(path);
    return code;
}

int is_transparent(const char *path)
{
    png_image image = { .version = PNG_IMAGE_VERSION };
    const int alpha = png_image_begin_read_from_file(&image, path) && image.format & PNG_FORMAT_FLAG_ALPHA;
    png_image_free(&image);
    return alpha;
}

int make_sheet(const char *dir, const char *view, const char *out)
{
    sheet s = { .row = find_pictures(dir, view), .cells = 1, .columns = 1 };
    char *part = NULL;
    int code = 0;
    if (s.row.count == 0) return complain("%s has no pictures", dir);
    for (int k = 0; code == 0 && k < s.cells; k++) code = draw_cell(&s, dir, view, k);
    if (code == 0 && asprintf(&part, "%s.part", out) < 0) code = complain("out of memory");
    errno = 0;
    if (code == 0 && !png_image_write_to_file(&s.image, part, 0, s.pixels, 0, NULL))
        code = complain("cannot write %s: %s", out, errno ? tr(strerror(errno)) : s.image.message);
    if (code == 0 && rename(part, out) != 0) code = complain("cannot write %s: %s", out, tr(strerror(errno)));
    if (code != 0 && part) unlink(part);
    free(part);
    free(s.pixels);
    return code;
}

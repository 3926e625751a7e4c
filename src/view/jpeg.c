/* JPEG files by libjpeg, whose errors jump: baseline and progressive, gray or in colours. Drawback: those for
   print, in four inks, are refused. */
#define _GNU_SOURCE 1
#include "view/image.h"
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <jpeglib.h>
#include <jerror.h>

typedef struct trouble {
    struct jpeg_error_mgr manager;       /* first: libjpeg hands back its address */
    jmp_buf back;
    char *why;
} trouble;

static void leave(j_common_ptr jpeg)
{
    trouble *t = (trouble *)(void *)jpeg->err;
    char text[JMSG_LENGTH_MAX];
    t->manager.format_message(jpeg, text);
    snprintf(t->why, IMAGE_WHY, "%s", text);
    longjmp(t->back, 1);
}

/* A file that is cut off is filled up with gray and a warning; here that is a mistake. */
static void hear(j_common_ptr jpeg, int level)
{
    if (level < 0 && jpeg->err->msg_code == JWRN_JPEG_EOF) leave(jpeg);
}

static void stay_silent(j_common_ptr jpeg) { (void)jpeg; }

static void decode(struct jpeg_decompress_struct *jpeg, image_pixels *out)
{
    jpeg_read_header(jpeg, TRUE);
    if (jpeg->num_components > 3) {
        snprintf(out->why, IMAGE_WHY, tr("it has %d inks, as for print; allowed are gray and RGB"),
                 jpeg->num_components);
        longjmp(((trouble *)(void *)jpeg->err)->back, 1);
    }
    if (jpeg->image_width > IMAGE_MOST_PIXELS || jpeg->image_height > IMAGE_MOST_PIXELS)
        ERREXIT1(jpeg, JERR_IMAGE_TOO_BIG, IMAGE_MOST_PIXELS);
    jpeg->out_color_space = JCS_RGB;
    jpeg_start_decompress(jpeg);
    out->width = (int)jpeg->output_width;
    out->height = (int)jpeg->output_height;
    const size_t row = 3*(size_t)out->width;
    out->rgb = malloc(row*(size_t)out->height);
    if (!out->rgb) ERREXIT1(jpeg, JERR_OUT_OF_MEMORY, 0);
    while (jpeg->output_scanline < jpeg->output_height) {
        JSAMPROW line = out->rgb + row*jpeg->output_scanline;
        jpeg_read_scanlines(jpeg, &line, 1);
    }
    jpeg_finish_decompress(jpeg);
}

bool image_is_jpeg(const unsigned char *data, size_t size)
{
    return size > 3 && data[0] == 0xff && data[1] == 0xd8 && data[2] == 0xff;
}

/* libjpeg leaves by longjmp, so nothing here may live in a register across it. */
bool image_read_jpeg(const unsigned char *data, size_t size, image_pixels *out)
{
    struct jpeg_decompress_struct jpeg;
    trouble t = { .why = out->why };
    jpeg.err = jpeg_std_error(&t.manager);
    t.manager.error_exit = leave;
    t.manager.emit_message = hear;
    t.manager.output_message = stay_silent;
    jpeg.mem = NULL;                     /* nothing to destroy before jpeg_create_decompress has it */
    if (setjmp(t.back)) {
        jpeg_destroy_decompress(&jpeg);
        return false;
    }
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, data, size);
    decode(&jpeg, out);
    jpeg_destroy_decompress(&jpeg);
    return true;
}

/* Converts to sRGB and writes PNG by zlib: libpng filters a row at a time and takes longer. Drawback:
   compression is on one thread. */
#include "view/draw.h"
#include "base/file.h"
#define ZLIB_CONST
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { CURVE = 4096 };

static void put_number(unsigned char *to, size_t n)
{
    for (int k = 0; k < 4; k++) to[k] = (unsigned char)(n >> (24 - 8*k));
}

/* A chunk: length, type, content, check sum of the latter two. */
static void put_chunk(tobi_file *file, const char *type, const unsigned char *data, size_t bytes)
{
    unsigned char head[8], sum[4];
    put_number(head, bytes);
    memcpy(head + 4, type, 4);
    uLong check = crc32(0, head + 4, 4);
    if (bytes > 0) check = crc32(check, data, (uInt)bytes);      /* without data it begins anew */
    put_number(sum, check);
    tobi_file_write(file, head, sizeof head);
    if (bytes > 0) tobi_file_write(file, data, bytes);
    tobi_file_write(file, sum, sizeof sum);
}

/* Rows with the filter Sub: each byte less the one of the pixel before. */
static void filter_rows(const unsigned char *from, int64_t row, int height, int channels, unsigned char *to)
{
    for (int y = 0; y < height; y++, from += row, to += row + 1) {
        to[0] = 1;
        for (int x = 0; x < channels; x++) to[x + 1] = from[x];
        for (int64_t x = channels; x < row; x++) to[x + 1] = (unsigned char)(from[x] - from[x - channels]);
    }
}

/* Of one filter and runs alone: about as small as at a library's own choice, and twice as quick. Pieces of
   `room` bytes are as many chunks. */
static bool put_image(tobi_file *file, const unsigned char *filtered, size_t bytes)
{
    enum { ROOM = 1 << 18 };
    unsigned char *out = malloc(ROOM);
    z_stream z = { .next_in = filtered };
    bool ok = out && deflateInit2(&z, 1, Z_DEFLATED, 15, 8, Z_RLE) == Z_OK;
    for (int state = ok ? Z_OK : Z_STREAM_END; state != Z_STREAM_END;) {
        const size_t most = 1 << 30;
        if (z.avail_in == 0) z.avail_in = (uInt)(bytes < most ? bytes : most), bytes -= z.avail_in;
        z.next_out = out, z.avail_out = ROOM;
        state = deflate(&z, bytes > 0 ? Z_NO_FLUSH : Z_FINISH);
        if (z.avail_out < ROOM) put_chunk(file, "IDAT", out, ROOM - z.avail_out);
    }
    if (ok) deflateEnd(&z);
    free(out);
    return ok;
}

/* The format of ISO/IEC 15948; false: no memory. */
static bool encode(tobi_file *file, int width, int height, int channels, const unsigned char *bytes)
{
    static const unsigned char signature[8] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' }, perceptual[1];
    const int64_t row = (int64_t)width*channels;
    const size_t size = (size_t)((row + 1)*height);
    unsigned char head[13] = { [8] = 8, [9] = channels == 4 ? 6 : 2 };      /* bits, with or without alpha */
    unsigned char *filtered = malloc(size);
    if (!filtered) return false;
    put_number(head, (size_t)width);
    put_number(head + 4, (size_t)height);
    filter_rows(bytes, row, height, channels, filtered);
    tobi_file_write(file, signature, sizeof signature);
    put_chunk(file, "IHDR", head, sizeof head);
    put_chunk(file, "sRGB", perceptual, sizeof perceptual);
    const bool ok = put_image(file, filtered, size);
    put_chunk(file, "IEND", NULL, 0);
    free(filtered);
    return ok;
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

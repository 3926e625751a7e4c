/* Converts to sRGB and writes PNG (ISO/IEC 15948) of one filter, Paeth's, many bytes at once, which zlib
   compresses (decisions/0092). Drawback: compression is on one thread. */
#define _GNU_SOURCE 1
#include "view/draw.h"
#include "base/file.h"
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { CURVE = 4096 };

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

static void put_number(uint8_t to[4], uint32_t n)
{
    for (int k = 0; k < 4; k++) to[k] = (uint8_t)(n >> (24 - 8*k));
}

/* A chunk: length, type, content, check sum of the latter two. */
static void put_chunk(tobi_file *file, const char *type, const uint8_t *data, size_t bytes)
{
    uint8_t head[8], sum[4];
    put_number(head, (uint32_t)bytes);
    memcpy(head + 4, type, 4);
    uLong check = crc32(0, head + 4, 4);
    if (bytes > 0) check = crc32(check, data, (uInt)bytes);      /* without data it begins anew */
    put_number(sum, (uint32_t)check);
    tobi_file_write(file, head, sizeof head);
    tobi_file_write(file, data, bytes);
    tobi_file_write(file, sum, sizeof sum);
}

/* The stream of zlib in one chunk. Of a filtered picture only runs repeat; longer searches take several
   times as long. Returns 0 without memory. */
static int put_image(tobi_file *file, uint8_t *filtered, size_t bytes)
{
    z_stream z = { .next_in = filtered, .avail_in = (uInt)bytes };
    if (deflateInit2(&z, 1, Z_DEFLATED, MAX_WBITS, MAX_MEM_LEVEL, Z_RLE) != Z_OK) return 0;
    const uLong room = deflateBound(&z, (uLong)bytes);
    uint8_t *out = malloc(room);
    z.next_out = out;
    z.avail_out = (uInt)room;
    const int whole = out && deflate(&z, Z_FINISH) == Z_STREAM_END;
    if (whole) put_chunk(file, "IDAT", out, (size_t)z.total_out);
    deflateEnd(&z);
    free(out);
    return whole;
}

static int put_picture(tobi_file *file, const canvas *c, int channels, uint8_t *filtered)
{
    static const uint8_t signature[8] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' }, perceptual[1];
    uint8_t head[13] = { [8] = 8, [9] = channels == 4 ? 6 : 2 };      /* bits, with or without alpha */
    put_number(head, (uint32_t)c->width);
    put_number(head + 4, (uint32_t)c->height);
    tobi_file_write(file, signature, sizeof signature);
    put_chunk(file, "IHDR", head, sizeof head);
    put_chunk(file, "sRGB", perceptual, sizeof perceptual);
    const int whole = put_image(file, filtered, ((size_t)c->width*(size_t)channels + 1)*(size_t)c->height);
    put_chunk(file, "IEND", NULL, 0);
    return whole;
}

tobi_status view_write_png(const char *path, const canvas *c, tobi_error *err)
{
    const int channels = c->alpha ? 4 : 3;
    const size_t row = (size_t)c->width*(size_t)channels, rows = (size_t)c->height;
    uint8_t *bytes = malloc(row*rows), *filtered = malloc((row + 1)*rows);
    tobi_status status = bytes && filtered ? TOBI_OK
        : tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", path);
    if (status == TOBI_OK) {
        const filtering view = { bytes, filtered, (int64_t)row, channels };
        tobi_file file;
        view_encode_colors(c, channels, bytes);
        tobi_loop(c->threads, c->height, 0, c->kernels->filter_rows, &view);
        status = tobi_file_open(&file, path, err);
        if (status == TOBI_OK) {
            const int whole = put_picture(&file, c, channels, filtered);
            if (whole) status = tobi_file_commit(&file, err);
            else status = tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", path);
            if (!whole) tobi_file_abandon(&file);
        }
    }
    free(bytes);
    free(filtered);
    return status;
}

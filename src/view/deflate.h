/* The deflate format (RFC 1951) for filtered rows of pictures: zeros in a row and single bytes, no other
   repeats, so that it is several times as quick as a general compressor. Drawback: bytes that are not the
   differences of a picture are hardly compressed. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    DEFLATE_BLOCK = 1 << 17,                 /* bytes of a call at most; each has its own code */
    DEFLATE_ROOM = 2*DEFLATE_BLOCK + 1024    /* bytes that it writes at most                   */
};

typedef struct deflater {
    uint64_t bits;                           /* that wait for their byte to be full            */
    int held;                                /* how many: 0 to 7 between calls                 */
    uint16_t token[DEFLATE_BLOCK + 8];
} deflater;

/* Begins all zero. Returns how many bytes it wrote to `out`; the last block fills its last byte. */
size_t view_deflate(deflater *d, const uint8_t *bytes, size_t count, bool last, uint8_t *out);

/* What view/deflate.c writes, zlib reads: runs of every length, codes at their limit, bytes of chance. A
   picture's file is what libpng reads elsewhere (test_view_overlay). */
#define _GNU_SOURCE 1
#include "view/deflate.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#include <cmocka.h>

/* Compresses in blocks of this size, reads by zlib, compares; returns the compressed bytes. */
static size_t go_and_return(const uint8_t *bytes, size_t count, size_t block)
{
    const size_t blocks = count/block + 1;
    uint8_t *packed = malloc(blocks*DEFLATE_ROOM), *back = malloc(count + 1);
    deflater *d = calloc(1, sizeof *d);
    size_t written = 0;
    assert_true(packed && back && d);
    for (size_t at = 0; at < count; at += block) {
        const size_t rest = count - at;
        const size_t more = view_deflate(d, bytes + at, rest < block ? rest : block, rest <= block,
                                         packed + written);
        assert_true(more <= DEFLATE_ROOM);
        written += more;
    }
    z_stream z = { .next_in = packed, .avail_in = (uInt)written,
                   .next_out = back, .avail_out = (uInt)count + 1 };
    assert_int_equal(inflateInit2(&z, -15), Z_OK);
    assert_int_equal(inflate(&z, Z_FINISH), Z_STREAM_END);
    assert_int_equal(z.total_out, count);
    assert_int_equal(z.avail_in, 0);
    assert_memory_equal(back, bytes, count);
    inflateEnd(&z);
    free(packed);
    free(back);
    free(d);
    return written;
}

static void runs_of_every_length(void **state)
{
    (void)state;
    uint8_t bytes[1200];
    for (size_t zeros = 0; zeros < 1100; zeros++) {
        memset(bytes, 0, sizeof bytes);
        bytes[0] = bytes[zeros + 1] = 7;
        go_and_return(bytes, zeros + 2, DEFLATE_BLOCK);
        go_and_return(bytes, zeros + 1, DEFLATE_BLOCK);
        go_and_return(bytes + 1, zeros + 1, DEFLATE_BLOCK);
    }
}

static void blocks_of_any_size(void **state)
{
    (void)state;
    enum { N = 3*DEFLATE_BLOCK + 5 };
    uint8_t *bytes = calloc(N, 1);
    for (int k = 0; k < N; k++) bytes[k] = (uint8_t)(k%97 < 60 ? 0 : k*k%11);
    go_and_return(bytes, N, DEFLATE_BLOCK);
    go_and_return(bytes, N, 4096);
    go_and_return(bytes, 2*DEFLATE_BLOCK, DEFLATE_BLOCK);
    for (size_t n = 1; n < 40; n++) go_and_return(bytes, 200, n);
    memset(bytes, 0, N);
    assert_true(go_and_return(bytes, N, DEFLATE_BLOCK) < N/258*5/8 + 4*160);      /* 5 bits a run */
    free(bytes);
}

/* The most that a block can need: no byte is rarer than another. */
static void chance_does_not_grow(void **state)
{
    (void)state;
    enum { N = 2*DEFLATE_BLOCK };
    uint8_t *bytes = malloc(N);
    uint32_t seed = 1;
    for (int k = 0; k < N; k++) bytes[k] = (uint8_t)((seed = 1664525*seed + 1013904223) >> 24);
    assert_true(go_and_return(bytes, N, DEFLATE_BLOCK) < N + N/100);
    free(bytes);
}

/* Counts of Fibonacci make the deepest tree: 23 bits, which the format does not allow. */
static void codes_are_not_too_long(void **state)
{
    (void)state;
    uint8_t *bytes = malloc(DEFLATE_BLOCK);
    size_t n = 0, one = 1, two = 1;
    for (int value = 1; n + one <= DEFLATE_BLOCK; value++) {
        memset(bytes + n, value, one);
        n += one;
        const size_t next = one + two;
        one = two, two = next;
    }
    assert_true(n > 100000);
    go_and_return(bytes, n, DEFLATE_BLOCK);
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(runs_of_every_length),
        cmocka_unit_test(blocks_of_any_size),
        cmocka_unit_test(chance_does_not_grow),
        cmocka_unit_test(codes_are_not_too_long),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

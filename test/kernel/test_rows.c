/* Rows on a machine without fused multiply-add against the C library's fmaf. Tests are compiled for the
   plain architecture, which on x86-64 is such a machine; elsewhere row_fma is fmaf itself. */
#include "exec/rows.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <float.h>
#include <cmocka.h>

enum { RANDOM_ROWS = 200000 };

static uint64_t draw(uint64_t *state)       /* splitmix64 */
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30)*0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27)*0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static uint32_t bits(float a)
{
    uint32_t b;
    __builtin_memcpy(&b, &a, sizeof b);
    return b;
}

static void compare(const float *a, const float *b, const float *c)
{
    float got[16];
    const row r = row_fma(row_load(a), row_load(b), row_load(c));
    row_store(got, r);
    for (int k = 0; k < 16; k++) {
        const float want = fmaf(a[k], b[k], c[k]);
        if (isnan(want) ? !isnan(got[k]) : bits(got[k]) != bits(want))
            fail_msg("%a * %a + %a = %a, not %a", a[k], b[k], c[k], want, got[k]);
    }
}

static void every_triple_of_hard_values(void **state)
{
    static const float hard[] = {
        0, 1, 1 + FLT_EPSILON, 1 - FLT_EPSILON/2, 1.5f, 3, 0x1p12f + 1, 0x1.000002p-24f, 0x1p-24f,
        0x1p-25f, 0x1p24f, 0x1.fffffep23f, 0x1p-75f, 0x1.8p-75f, 0x1.000002p-75f, FLT_TRUE_MIN,
        3*FLT_TRUE_MIN, FLT_MIN - FLT_TRUE_MIN, FLT_MIN, FLT_MIN + FLT_TRUE_MIN, 0x1.555556p-2f,
        FLT_MAX, FLT_MAX/2, 0x1p127f, INFINITY, NAN,
    };
    enum { N = sizeof hard/sizeof *hard };
    float v[3][16];
    int k = 0;
    (void)state;
    for (int n = 0; n < 8*N*N*N; n++) {
        const int sign = n & 7, i = n/8%N, j = n/8/N%N, l = n/8/N/N;
        v[0][k] = sign & 1 ? -hard[i] : hard[i];
        v[1][k] = sign & 2 ? -hard[j] : hard[j];
        v[2][k] = sign & 4 ? -hard[l] : hard[l];
        if (++k == 16 || n + 1 == 8*N*N*N) compare(v[0], v[1], v[2]), k = 0;
    }
}

/* Significands of few bits and sums about as large as `exponent` says: half of the results lie half way
   between two floats, or so near to it that double does not tell. */
static void fill_row(uint64_t *seed, int exponent, float v[3][16])
{
    for (int k = 0; k < 16; k++) {
        const uint64_t r = draw(seed), s = draw(seed);
        const int few = (int)(r & 15), shift = (int)(r >> 4 & 31) - 15, far = (int)(r >> 9 & 63) - 31;
        const float a = (float)((s & 0xffffff) >> few | 1);
        const float b = (float)((s >> 24 & 0xffffff) >> (few ^ 8) | 1);
        const float c = (float)((r >> 40) >> (r >> 20 & 15) | 1);
        v[0][k] = ldexpf(r >> 15 & 1 ? -a : a, shift);
        v[1][k] = ldexpf(r >> 16 & 1 ? -b : b, exponent - shift);
        v[2][k] = ldexpf(r >> 17 & 1 ? -c : c, exponent + far);
    }
}

static void random_values(void **state)
{
    static const int exponents[] = {0, -40, -150, -168, -174, -190, 80, 104};
    uint64_t seed = 1;
    float v[3][16];
    (void)state;
    for (int n = 0; n < RANDOM_ROWS; n++) {
        fill_row(&seed, exponents[n & 7], v);
        compare(v[0], v[1], v[2]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_triple_of_hard_values),
        cmocka_unit_test(random_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

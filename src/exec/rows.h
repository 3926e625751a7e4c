/* Rows of a grid: three neighbouring nodes of four floats, and a fourth that carries nothing, so that a row
   is one wide register on the largest machines and two or four on the others. A quad is one node. Sums of a
   row run in one order on every instruction set. */
#pragma once
#include "exec/portable.h"
#include <stddef.h>

#if defined(__CUDACC__)

struct quad { float v[4]; __host__ __device__ float &operator[](int k) { return v[k]; }
              __host__ __device__ float operator[](int k) const { return v[k]; } };
struct row { float v[16]; };
TOBI_FN quad quad_set(float a) { quad q = {{a, a, a, a}}; return q; }
TOBI_FN quad operator+(quad a, quad b) { for (int k = 0; k < 4; k++) a.v[k] += b.v[k]; return a; }
TOBI_FN quad operator-(quad a, quad b) { for (int k = 0; k < 4; k++) a.v[k] -= b.v[k]; return a; }
TOBI_FN quad operator*(quad a, quad b) { for (int k = 0; k < 4; k++) a.v[k] *= b.v[k]; return a; }
TOBI_FN quad operator/(quad a, quad b) { for (int k = 0; k < 4; k++) a.v[k] /= b.v[k]; return a; }
TOBI_FN quad quad_larger(quad a, quad b)
{
    for (int k = 0; k < 4; k++) a.v[k] = a.v[k] > b.v[k] ? a.v[k] : b.v[k];
    return a;
}
TOBI_FN row row_set(float a) { row r; for (int k = 0; k < 16; k++) r.v[k] = a; return r; }
TOBI_FN row row_add(row a, row b) { for (int k = 0; k < 16; k++) a.v[k] += b.v[k]; return a; }
TOBI_FN row row_mul(row a, row b) { for (int k = 0; k < 16; k++) a.v[k] *= b.v[k]; return a; }
TOBI_FN row row_fma(row a, row b, row c)
{
    for (int k = 0; k < 16; k++) a.v[k] = fmaf(a.v[k], b.v[k], c.v[k]);
    return a;
}
TOBI_FN row row_repeat(quad a) { row r; for (int k = 0; k < 16; k++) r.v[k] = a.v[k & 3]; return r; }
TOBI_FN row row_spread(quad a) { row r; for (int k = 0; k < 16; k++) r.v[k] = a.v[k >> 2]; return r; }
TOBI_FN quad row_fold(row a)
{
    quad q;
    for (int k = 0; k < 4; k++) q.v[k] = (a.v[k] + a.v[k + 8]) + (a.v[k + 4] + a.v[k + 12]);
    return q;
}
TOBI_FN row row_sub(row a, row b) { for (int k = 0; k < 16; k++) a.v[k] -= b.v[k]; return a; }
TOBI_FN row row_fold_four(row a, row b, row c, row d)
{
    const quad f[4] = {row_fold(a), row_fold(b), row_fold(c), row_fold(d)};
    for (int k = 0; k < 16; k++) a.v[k] = f[k >> 2].v[k & 3];
    return a;
}
TOBI_FN quad row_first(row a) { quad q; for (int k = 0; k < 4; k++) q.v[k] = a.v[k]; return q; }
TOBI_FN row row_take_w(row a, row w) { for (int k = 3; k < 16; k += 4) a.v[k] = w.v[k]; return a; }
TOBI_FN void row_store_others(void *p, row r) { __builtin_memcpy(p, r.v + 4, 12*sizeof(float)); }

#else

#if defined(__SSE2__)
#  include <immintrin.h>
#endif
#pragma GCC diagnostic ignored "-Wpsabi"
typedef float quad __attribute__((vector_size(16)));
TOBI_FN quad quad_set(float a) { return (quad){a, a, a, a}; }
TOBI_FN quad quad_larger(quad a, quad b)
{
    typedef int32_t mask __attribute__((vector_size(16)));
    mask m = a > b;
    return (quad)(((mask)a & m) | ((mask)b & ~m));
}

/* a b + c is rounded once, which saves a third of the work on x86-64-v3 and v4. Older machines have no
   such instruction; they get the same bits from some twenty others. */
#if defined(__AVX512F__)

typedef float row __attribute__((vector_size(64)));
TOBI_FN row row_set(float a) { return (row)_mm512_set1_ps(a); }
TOBI_FN row row_add(row a, row b) { return a + b; }
TOBI_FN row row_mul(row a, row b) { return a*b; }
TOBI_FN row row_fma(row a, row b, row c)
{
    return (row)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c);
}
/* (a, a, a, a); gcc 12 goes through memory without the intrinsic */
TOBI_FN row row_repeat(quad a) { return (row)_mm512_broadcast_f32x4((__m128)a); }
/* (a0 a0 a0 a0, a1 .., a2 .., a3 ..) */
TOBI_FN row row_spread(quad a)
{
    const __m512i order = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
    return (row)_mm512_permutexvar_ps(order, _mm512_castps128_ps512((__m128)a));
}
/* The sum of the four nodes: (0 + 2) + (1 + 3). */
TOBI_FN quad row_fold(row a)
{
    __m256 s = _mm256_add_ps(_mm512_castps512_ps256((__m512)a), _mm512_extractf32x8_ps((__m512)a, 1));
    return (quad)_mm_add_ps(_mm256_castps256_ps128(s), _mm256_extractf128_ps(s, 1));
}
TOBI_FN row row_sub(row a, row b) { return a - b; }
/* Four such sums side by side. */
TOBI_FN row row_fold_four(row a, row b, row c, row d)
{
    const __m512 p = (__m512)a, q = (__m512)b, r = (__m512)c, s = (__m512)d;
    __m512 e = _mm512_add_ps(_mm512_shuffle_f32x4(p, q, 0x44), _mm512_shuffle_f32x4(p, q, 0xee));
    __m512 f = _mm512_add_ps(_mm512_shuffle_f32x4(r, s, 0x44), _mm512_shuffle_f32x4(r, s, 0xee));
    return (row)_mm512_add_ps(_mm512_shuffle_f32x4(e, f, 0x88), _mm512_shuffle_f32x4(e, f, 0xdd));
}
TOBI_FN quad row_first(row a) { return (quad)_mm512_castps512_ps128((__m512)a); }
/* a, but the last float of each node from w */
TOBI_FN row row_take_w(row a, row w) { return (row)_mm512_mask_mov_ps((__m512)a, 0x8888, (__m512)w); }
/* All nodes but the first, at p. */
TOBI_FN void row_store_others(void *p, row r)
{
    _mm512_mask_storeu_ps((float *)p - 4, 0xfff0, (__m512)r);
}

#else

/* Parts by hand: a vector wider than the registers would live in memory. */
#if defined(__AVX__)
enum { ROW_PARTS_ = 2 };
typedef float row_part_ __attribute__((vector_size(32)));
TOBI_FN row_part_ row_part_set_(float a) { return (row_part_){a, a, a, a, a, a, a, a}; }
#else
enum { ROW_PARTS_ = 4 };
typedef quad row_part_;
TOBI_FN row_part_ row_part_set_(float a) { return quad_set(a); }
#endif
typedef struct row { row_part_ part[ROW_PARTS_]; } row;

#if defined(__SSE2__) && !defined(__FMA__)
TOBI_FN __m128d row_low_(quad a) { return _mm_cvtps_pd((__m128)a); }
TOBI_FN __m128d row_high_(quad a) { return _mm_cvtps_pd(_mm_movehl_ps((__m128)a, (__m128)a)); }
TOBI_FN quad row_narrow_(__m128d low, __m128d high)
{
    return (quad)_mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high));
}
/* Two of a b + c in double, rounded to odd: of the two neighbours the one with an odd last bit.
   Rounding that again, to float, is rounding once (Boldo & Melquiond 2008, IEEE Trans. Comput. 57). */
TOBI_FN __m128d row_fma_odd_(__m128d a, __m128d b, __m128d c)
{
    typedef uint64_t word __attribute__((vector_size(16)));
    const __m128d p = a*b, s = p + c, q = s - p;                    /* p is exact */
    const __m128d error = (p - (s - q)) + (c - q);                  /* Knuth's sum */
    const word magnitude = (word)error & (word){INT64_MAX, INT64_MAX};
    const word inexact = (word)((__m128d)magnitude > (__m128d){0, 0}) >> 63;    /* 0 where s is infinite */
    const word below = ((word)error ^ (word)s) >> 63 & inexact;     /* nearer to 0 than s */
    return (__m128d)(((word)s - below) | inexact);
}
TOBI_RARE_FN void row_fma_exactly_(const quad *a, const quad *b, const quad *c, quad *sum)
{
    for (int k = 0; k < 4; k++)
        sum[k] = row_narrow_(row_fma_odd_(row_low_(a[k]), row_low_(b[k]), row_low_(c[k])),
                             row_fma_odd_(row_high_(a[k]), row_high_(b[k]), row_high_(c[k])));
}
/* a b + c by way of double. Rounding twice is wrong only where the sum in double is half way between
   two floats, or the float is subnormal: there `doubt` is not 0. */
TOBI_FN quad row_fma_twice_(quad a, quad b, quad c, __m128i *doubt)
{
    const __m128d low = row_low_(a)*row_low_(b) + row_low_(c);
    const __m128d high = row_high_(a)*row_high_(b) + row_high_(c);
    const quad sum = row_narrow_(low, high);
    const __m128i last = (__m128i)_mm_shuffle_ps((__m128)low, (__m128)high, _MM_SHUFFLE(2, 0, 2, 0));
    const __m128i half = _mm_cmpeq_epi32(last & _mm_set1_epi32(0x1fffffff), _mm_set1_epi32(0x10000000));
    const __m128i twice = _mm_add_epi32((__m128i)sum, (__m128i)sum);            /* no sign, 0 stays 0 */
    const __m128i small = _mm_cmplt_epi32(_mm_add_epi32(twice, _mm_set1_epi32(INT32_MAX)),
                                          _mm_set1_epi32(INT32_MIN + 0x02000000));
    *doubt |= half | small;
    return sum;
}
TOBI_FN row row_fma(row a, row b, row c)
{
    row sum;
    __m128i doubt = _mm_setzero_si128();
    for (int k = 0; k < 4; k++) sum.part[k] = row_fma_twice_(a.part[k], b.part[k], c.part[k], &doubt);
    if (__builtin_expect(_mm_movemask_epi8(doubt) != 0, 0))
        row_fma_exactly_(a.part, b.part, c.part, sum.part);
    return sum;
}
#else
TOBI_FN row row_fma(row a, row b, row c)
{
    for (int k = 0; k < ROW_PARTS_; k++)
#if defined(__FMA__)
        a.part[k] = (row_part_)_mm256_fmadd_ps((__m256)a.part[k], (__m256)b.part[k], (__m256)c.part[k]);
#else
        for (int n = 0; n < 4; n++) a.part[k][n] = fmaf(a.part[k][n], b.part[k][n], c.part[k][n]);
#endif
    return a;
}
#endif
TOBI_FN row row_set(float a)
{
    row r;
    for (int k = 0; k < ROW_PARTS_; k++) r.part[k] = row_part_set_(a);
    return r;
}
TOBI_FN row row_add(row a, row b)
{
    for (int k = 0; k < ROW_PARTS_; k++) a.part[k] = a.part[k] + b.part[k];
    return a;
}
TOBI_FN row row_sub(row a, row b)
{
    for (int k = 0; k < ROW_PARTS_; k++) a.part[k] = a.part[k] - b.part[k];
    return a;
}
TOBI_FN row row_mul(row a, row b)
{
    for (int k = 0; k < ROW_PARTS_; k++) a.part[k] = a.part[k]*b.part[k];
    return a;
}
#if defined(__AVX__)
TOBI_FN row row_repeat(quad a)
{
    row_part_ h = __builtin_shufflevector(a, a, 0, 1, 2, 3, 0, 1, 2, 3);
    row r = {{h, h}};
    return r;
}
TOBI_FN row row_spread(quad a)
{
    row r = {{__builtin_shufflevector(a, a, 0, 0, 0, 0, 1, 1, 1, 1),
              __builtin_shufflevector(a, a, 2, 2, 2, 2, 3, 3, 3, 3)}};
    return r;
}
TOBI_FN quad row_fold(row a)
{
    row_part_ s = a.part[0] + a.part[1];
    return __builtin_shufflevector(s, s, 0, 1, 2, 3) + __builtin_shufflevector(s, s, 4, 5, 6, 7);
}
TOBI_FN row_part_ row_fold_two_(row a, row b)
{
    row_part_ p = a.part[0] + a.part[1], q = b.part[0] + b.part[1];
    return __builtin_shufflevector(p, q, 0, 1, 2, 3, 8, 9, 10, 11) +
           __builtin_shufflevector(p, q, 4, 5, 6, 7, 12, 13, 14, 15);
}
TOBI_FN row row_fold_four(row a, row b, row c, row d)
{
    row r = {{row_fold_two_(a, b), row_fold_two_(c, d)}};
    return r;
}
TOBI_FN quad row_first(row a) { return __builtin_shufflevector(a.part[0], a.part[0], 0, 1, 2, 3); }
TOBI_FN row row_take_w(row a, row w)
{
    for (int k = 0; k < 2; k++)
        a.part[k] = __builtin_shufflevector(a.part[k], w.part[k], 0, 1, 2, 11, 4, 5, 6, 15);
    return a;
}
TOBI_FN void row_store_others(void *p, row r)
{
    quad second = __builtin_shufflevector(r.part[0], r.part[0], 4, 5, 6, 7);
    __builtin_memcpy(p, &second, sizeof second);
    __builtin_memcpy((float *)p + 4, &r.part[1], sizeof r.part[1]);
}
#else
TOBI_FN row row_repeat(quad a)
{
    row r = {{a, a, a, a}};
    return r;
}
TOBI_FN row row_spread(quad a)
{
    row r = {{quad_set(a[0]), quad_set(a[1]), quad_set(a[2]), quad_set(a[3])}};
    return r;
}
TOBI_FN quad row_fold(row a) { return (a.part[0] + a.part[2]) + (a.part[1] + a.part[3]); }
TOBI_FN row row_fold_four(row a, row b, row c, row d)
{
    row r = {{row_fold(a), row_fold(b), row_fold(c), row_fold(d)}};
    return r;
}
TOBI_FN quad row_first(row a) { return a.part[0]; }
TOBI_FN row row_take_w(row a, row w)
{
    for (int k = 0; k < 4; k++) a.part[k] = __builtin_shufflevector(a.part[k], w.part[k], 0, 1, 2, 7);
    return a;
}
TOBI_FN void row_store_others(void *p, row r)
{
    for (int k = 1; k < 4; k++)
        __builtin_memcpy((float *)p + 4*(k - 1), &r.part[k], sizeof r.part[k]);
}
#endif

#endif
#endif

TOBI_FN quad quad_load(const void *p)
{
    quad q;
    __builtin_memcpy(&q, p, sizeof q);
    return q;
}
TOBI_FN void quad_store(void *p, quad q) { __builtin_memcpy(p, &q, sizeof q); }
/* Bit k: element k of the first three is b. */
TOBI_FN uint32_t quad_matches(quad a, float b)
{
#if defined(__AVX2__) && !defined(__CUDACC__)
    return (uint32_t)_mm_movemask_ps(_mm_cmpeq_ps((__m128)a, _mm_set1_ps(b))) & 7;
#else
    return (uint32_t)(a[0] == b) | (uint32_t)(a[1] == b) << 1 | (uint32_t)(a[2] == b) << 2;
#endif
}
#if defined(__AVX512F__) || defined(__CUDACC__)
TOBI_FN row row_load(const void *p)
{
    row r;
    __builtin_memcpy(&r, p, sizeof r);
    return r;
}
TOBI_FN void row_store(void *p, row r) { __builtin_memcpy(p, &r, sizeof r); }
#else
/* Part by part, or gcc 12 copies in small pieces and waits for them. */
TOBI_FN row row_load(const void *p)
{
    row r;
    for (int k = 0; k < ROW_PARTS_; k++)
        __builtin_memcpy(&r.part[k], (const char *)p + (size_t)k*sizeof r.part[k], sizeof r.part[k]);
    return r;
}
TOBI_FN void row_store(void *p, row r)
{
    for (int k = 0; k < ROW_PARTS_; k++)
        __builtin_memcpy((char *)p + (size_t)k*sizeof r.part[k], &r.part[k], sizeof r.part[k]);
}
#endif

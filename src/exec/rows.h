/* Rows of a grid: three neighbouring nodes of four floats, and a fourth that carries nothing, so that a row
   is one wide register on the largest machines and two or four on the others. A quad is one node. Sums of a
   row run in one order on every instruction set. */
#pragma once
#include "exec/portable.h"

#if defined(__CUDACC__)

struct quad { float v[4]; __host__ __device__ float &operator[](int k) { return v[k]; }
              __host__ __device__ float operator[](int k) const { return v[k]; } };
struct row { float v[16]; };
TOBI_FN quad quad_set(float a) { quad q = {{a, a, a, a}}; return q; }
TOBI_FN quad operator+(quad a, quad b) { for (int k = 0; k < 4; k++) a.v[k] += b.v[k]; return a; }
TOBI_FN quad operator-(quad a, quad b) { for (int k = 0; k < 4; k++) a.v[k] -= b.v[k]; return a; }
TOBI_FN quad operator*(quad a, quad b) { for (int k = 0; k < 4; k++) a.v[k] *= b.v[k]; return a; }
TOBI_FN quad quad_larger(quad a, quad b)
{
    for (int k = 0; k < 4; k++) a.v[k] = a.v[k] > b.v[k] ? a.v[k] : b.v[k];
    return a;
}
TOBI_FN row row_set(float a) { row r; for (int k = 0; k < 16; k++) r.v[k] = a; return r; }
TOBI_FN row operator+(row a, row b) { for (int k = 0; k < 16; k++) a.v[k] += b.v[k]; return a; }
TOBI_FN row operator*(row a, row b) { for (int k = 0; k < 16; k++) a.v[k] *= b.v[k]; return a; }
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

#else

#pragma GCC diagnostic ignored "-Wpsabi"
typedef float quad __attribute__((vector_size(16)));
typedef float row  __attribute__((vector_size(64)));
typedef float row_half_ __attribute__((vector_size(32)));
TOBI_FN quad quad_set(float a) { return (quad){a, a, a, a}; }
TOBI_FN quad quad_larger(quad a, quad b)
{
    typedef int32_t mask __attribute__((vector_size(16)));
    mask m = a > b;
    return (quad)(((mask)a & m) | ((mask)b & ~m));
}
TOBI_FN row row_set(float a) { return (row){a, a, a, a, a, a, a, a, a, a, a, a, a, a, a, a}; }
/* a b + c, rounded once on machines that can (x86-64-v3 and v4), where it saves a third of the work. So rows
   give the same bits on AVX2 and AVX-512, and others on older machines. */
TOBI_FN row row_fma(row a, row b, row c)
{
#if defined(__AVX512F__)
    return (row)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c);
#elif defined(__FMA__)
    row r;
    for (int k = 0; k < 16; k += 8)
        _mm256_storeu_ps((float *)&r + k, _mm256_fmadd_ps(_mm256_loadu_ps((const float *)&a + k),
                                                          _mm256_loadu_ps((const float *)&b + k),
                                                          _mm256_loadu_ps((const float *)&c + k)));
    return r;
#else
    return a*b + c;
#endif
}
/* (a, a, a, a) */
TOBI_FN row row_repeat(quad a)
{
#if defined(__AVX512F__)
    return (row)_mm512_broadcast_f32x4((__m128)a);      /* gcc 12 goes through memory otherwise */
#else
    row_half_ h = __builtin_shufflevector(a, a, 0, 1, 2, 3, 0, 1, 2, 3);
    return __builtin_shufflevector(h, h, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#endif
}
/* (a0 a0 a0 a0, a1 .., a2 .., a3 ..) */
TOBI_FN row row_spread(quad a)
{
#if defined(__AVX512F__)
    const __m512i order = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
    return (row)_mm512_permutexvar_ps(order, _mm512_castps128_ps512((__m128)a));
#else
    row_half_ l = __builtin_shufflevector(a, a, 0, 0, 0, 0, 1, 1, 1, 1),
              h = __builtin_shufflevector(a, a, 2, 2, 2, 2, 3, 3, 3, 3);
    return __builtin_shufflevector(l, h, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#endif
}
/* The sum of the four nodes. */
TOBI_FN quad row_fold(row a)
{
    row_half_ l = __builtin_shufflevector(a, a, 0, 1, 2, 3, 4, 5, 6, 7),
              h = __builtin_shufflevector(a, a, 8, 9, 10, 11, 12, 13, 14, 15), s = l + h;
    return __builtin_shufflevector(s, s, 0, 1, 2, 3) + __builtin_shufflevector(s, s, 4, 5, 6, 7);
}

#endif

TOBI_FN quad quad_load(const void *p)
{
    quad q;
    __builtin_memcpy(&q, p, sizeof q);
    return q;
}
TOBI_FN void quad_store(void *p, quad q) { __builtin_memcpy(p, &q, sizeof q); }
TOBI_FN row row_load(const void *p)
{
    row r;
    __builtin_memcpy(&r, p, sizeof r);
    return r;
}
TOBI_FN void row_store(void *p, row r) { __builtin_memcpy(p, &r, sizeof r); }

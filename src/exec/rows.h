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

#else

#pragma GCC diagnostic ignored "-Wpsabi"
typedef float quad __attribute__((vector_size(16)));
TOBI_FN quad quad_set(float a) { return (quad){a, a, a, a}; }
TOBI_FN quad quad_larger(quad a, quad b)
{
    typedef int32_t mask __attribute__((vector_size(16)));
    mask m = a > b;
    return (quad)(((mask)a & m) | ((mask)b & ~m));
}

/* a b + c is rounded once on machines that can (x86-64-v3 and v4), where it saves a third of the work. So
   rows give the same bits on AVX2 and AVX-512, and others on older machines. */
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

TOBI_FN row_part_ row_part_fma_(row_part_ a, row_part_ b, row_part_ c)
{
#if defined(__FMA__)
    return (row_part_)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c);
#else
    return a*b + c;
#endif
}
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
TOBI_FN row row_mul(row a, row b)
{
    for (int k = 0; k < ROW_PARTS_; k++) a.part[k] = a.part[k]*b.part[k];
    return a;
}
TOBI_FN row row_fma(row a, row b, row c)
{
    for (int k = 0; k < ROW_PARTS_; k++) a.part[k] = row_part_fma_(a.part[k], b.part[k], c.part[k]);
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

/* The one header that knows which compiler reads a kernel, and how wide it computes.
   A kernel file (*.k.h) is plain arithmetic on `lane`: eight floats at once in the production build
   (GNU vectors), one float in CUDA and in the test oracles (TOBI_SCALAR_LANES). Eight lanes and one
   reduction tree on every instruction set, so that all of them give the same bits. */
#pragma once
#include <math.h>
#include <stdint.h>

#if defined(__CUDACC__)
#  define TOBI_FN static __host__ __device__ __forceinline__
#  define TOBI_RARE_FN static __host__ __device__ __noinline__
#  define TOBI_RESTRICT __restrict__
#elif defined(__cplusplus)
#  define TOBI_FN static inline __attribute__((always_inline))
#  define TOBI_RARE_FN static __attribute__((noinline, unused))
#  define TOBI_RESTRICT __restrict__
#else
#  define TOBI_FN static inline __attribute__((always_inline))
#  define TOBI_RARE_FN static __attribute__((noinline, unused))    /* kept out of loops that rarely call it */
#  define TOBI_RESTRICT restrict
#endif

/* Number of the lowest bit that is set; x not 0. */
TOBI_FN int tobi_lowest_bit(uint64_t x)
{
#if defined(__CUDA_ARCH__)
    return __ffsll((long long)x) - 1;
#else
    return __builtin_ctzll(x);
#endif
}

/* Adds to a count that all items share, and returns what it was. In which order items come is open. */
TOBI_FN int64_t tobi_fetch_add(int64_t *count, int64_t more)
{
#if defined(__CUDA_ARCH__)
    return (int64_t)atomicAdd((unsigned long long *)count, (unsigned long long)more);
#else
    return __atomic_fetch_add(count, more, __ATOMIC_RELAXED);
#endif
}

typedef struct tobi_float4 { float x, y, z, w; } tobi_float4;
/* Fixed-point position over the domain (see docs/decisions/0002) and one float for the pass. */
typedef struct tobi_record { int32_t x, y, z; float w; } tobi_record;
typedef struct tobi_double2 { double x, y; } tobi_double2;
typedef struct tobi_double3 { double x, y, z; } tobi_double3;
/* Three columns of a 3x3 matrix; the w of each column is free for a number that goes with it. */
typedef struct tobi_columns { tobi_float4 c[3]; } tobi_columns;

#if defined(__CUDACC__) || defined(__cplusplus) || defined(TOBI_SCALAR_LANES)

enum { TOBI_LANES = 1 };
typedef float lane;
typedef int32_t lane_int;
TOBI_FN lane lane_set(float a) { return a; }
TOBI_FN lane_int lane_load_index(const int32_t *p) { return *p; }
TOBI_FN lane_int lane_set_int(int32_t a) { return a; }
TOBI_FN lane lane_sqrt(lane a) { return sqrtf(a); }
TOBI_FN lane lane_from_int(lane_int a) { return (float)a; }
TOBI_FN lane lane_positive(lane a) { return a > 0 ? a : 0; }
TOBI_FN lane lane_where_equal(lane_int a, lane_int b, lane t, lane f) { return a == b ? t : f; }
TOBI_FN lane_int lane_to_int(lane a) { return (int32_t)a; }
TOBI_FN lane lane_where_less(lane a, lane b, lane t, lane f) { return a < b ? t : f; }
TOBI_FN unsigned lane_mask_less(lane a, lane b) { return a < b; }
TOBI_FN lane lane_from_bits(lane_int a)
{
    lane x;
    __builtin_memcpy(&x, &a, sizeof x);
    return x;
}
TOBI_FN lane_int lane_bits(lane a)
{
    lane_int x;
    __builtin_memcpy(&x, &a, sizeof x);
    return x;
}
TOBI_FN float lane_at(lane a, int k) { (void)k; return a; }
TOBI_FN int32_t lane_int_at(lane_int a, int k) { (void)k; return a; }
TOBI_FN lane lane_load(const float *p) { return *p; }
TOBI_FN void lane_store(float *p, lane a) { *p = a; }
TOBI_FN float lane_sum(lane a) { return a; }
TOBI_FN tobi_float4 lane_sum4(lane x, lane y, lane z, lane w)
{
    tobi_float4 sum = {x, y, z, w};
    return sum;
}
TOBI_FN void lane_store_float4(tobi_float4 *to, int stride, int count, lane x, lane y, lane z, lane w)
{
    (void)stride; (void)count;
    to->x = x; to->y = y; to->z = z; to->w = w;
}
TOBI_FN lane_int lane_sub_wrap(int32_t a, lane_int b) { return (int32_t)((uint32_t)a - (uint32_t)b); }
TOBI_FN void lane_load_places(const tobi_double3 *from, double scale, const double shift[3], lane place[3])
{
    place[0] = (float)(from->x*scale - shift[0]);
    place[1] = (float)(from->y*scale - shift[1]);
    place[2] = (float)(from->z*scale - shift[2]);
}
TOBI_FN void lane_load_float4(const tobi_float4 *base, const int32_t *j, lane *x, lane *y, lane *z, lane *w)
{
    tobi_float4 a = base[*j];
    *x = a.x; *y = a.y; *z = a.z; *w = a.w;
}
TOBI_FN void lane_load_record(const tobi_record *base, const int32_t *j, lane_int *x, lane_int *y,
                              lane_int *z, lane *w)
{
    tobi_record a = base[*j];
    *x = a.x; *y = a.y; *z = a.z; *w = a.w;
}

#else

#if defined(__AVX__)
#  include <immintrin.h>
#elif defined(__SSE2__)
#  include <emmintrin.h>
#endif
enum { TOBI_LANES = 8 };
#pragma GCC diagnostic ignored "-Wpsabi"   /* every lane function is inlined, no ABI is crossed */
typedef float   lane     __attribute__((vector_size(32)));
typedef int32_t lane_int __attribute__((vector_size(32)));
typedef float   lane_half_ __attribute__((vector_size(16)));
typedef int32_t lane_half_int_ __attribute__((vector_size(16)));

/* Where a register holds half a lane, gcc 12 takes comparisons, conversions and shuffles of whole lanes apart
   into single floats: there they are written for halves. */
#if !defined(__AVX__)
TOBI_FN lane_half_ lane_half_of_(lane a, int half)
{
    lane_half_ h;
    __builtin_memcpy(&h, (const char *)&a + 16*half, sizeof h);
    return h;
}
TOBI_FN lane_half_int_ lane_half_int_of_(lane_int a, int half)
{
    return (lane_half_int_)lane_half_of_((lane)a, half);
}
#endif

TOBI_FN lane lane_set(float a) { return (lane){a, a, a, a, a, a, a, a}; }
TOBI_FN lane_int lane_set_int(int32_t a) { return (lane_int){a, a, a, a, a, a, a, a}; }
TOBI_FN lane_int lane_load_index(const int32_t *p)
{
    lane_int v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
TOBI_FN lane lane_sqrt(lane a)
{
#if defined(__AVX__)
    return (lane)_mm256_sqrt_ps((__m256)a);
#elif defined(__SSE2__)
    lane_half_ l = __builtin_shufflevector(a, a, 0, 1, 2, 3), h = __builtin_shufflevector(a, a, 4, 5, 6, 7);
    l = (lane_half_)_mm_sqrt_ps((__m128)l);
    h = (lane_half_)_mm_sqrt_ps((__m128)h);
    return __builtin_shufflevector(l, h, 0, 1, 2, 3, 4, 5, 6, 7);
#else
    for (int k = 0; k < 8; k++) a[k] = sqrtf(a[k]);
    return a;
#endif
}
TOBI_FN lane lane_from_int(lane_int a)
{
#if defined(__AVX__)
    return __builtin_convertvector(a, lane);
#else
    lane r;
    for (int k = 0; k < 2; k++) {
        lane_half_ h = __builtin_convertvector(lane_half_int_of_(a, k), lane_half_);
        __builtin_memcpy((char *)&r + 16*k, &h, sizeof h);
    }
    return r;
#endif
}
/* All bits where a < b, */
TOBI_FN lane_int lane_less_(lane a, lane b)
{
#if defined(__AVX__)
    return a < b;
#else
    lane_int r;
    for (int k = 0; k < 2; k++) {
        lane_half_int_ h = lane_half_of_(a, k) < lane_half_of_(b, k);
        __builtin_memcpy((char *)&r + 16*k, &h, sizeof h);
    }
    return r;
#endif
}
/* and where a == b. */
TOBI_FN lane_int lane_equal_(lane_int a, lane_int b)
{
#if defined(__AVX__)
    return a == b;
#else
    lane_int r;
    for (int k = 0; k < 2; k++) {
        lane_half_int_ h = lane_half_int_of_(a, k) == lane_half_int_of_(b, k);
        __builtin_memcpy((char *)&r + 16*k, &h, sizeof h);
    }
    return r;
#endif
}
TOBI_FN lane lane_positive(lane a)
{
#if defined(__AVX__)
    return (lane)_mm256_max_ps((__m256)a, _mm256_setzero_ps());
#else
    return (lane)((lane_int)a & lane_less_(lane_set(0), a));
#endif
}
TOBI_FN lane lane_where_equal(lane_int a, lane_int b, lane t, lane f)
{
    lane_int m = lane_equal_(a, b);
    return (lane)(((lane_int)t & m) | ((lane_int)f & ~m));
}
TOBI_FN lane_int lane_to_int(lane a)                                                   /* towards 0 */
{
#if defined(__AVX__)
    return __builtin_convertvector(a, lane_int);
#else
    lane_int r;
    for (int k = 0; k < 2; k++) {
        lane_half_int_ h = __builtin_convertvector(lane_half_of_(a, k), lane_half_int_);
        __builtin_memcpy((char *)&r + 16*k, &h, sizeof h);
    }
    return r;
#endif
}
TOBI_FN lane lane_where_less(lane a, lane b, lane t, lane f)
{
    lane_int m = lane_less_(a, b);
    return (lane)(((lane_int)t & m) | ((lane_int)f & ~m));
}
/* Bit k: a < b in element k. */
TOBI_FN unsigned lane_mask_less(lane a, lane b)
{
    const lane_int m = lane_less_(a, b);
#if defined(__AVX__)
    return (unsigned)_mm256_movemask_ps((__m256)m);
#else
    unsigned bits = 0;
    for (int k = 0; k < 8; k++) bits |= (unsigned)(m[k] & 1) << k;
    return bits;
#endif
}
TOBI_FN lane lane_from_bits(lane_int a) { return (lane)a; }
TOBI_FN lane_int lane_bits(lane a) { return (lane_int)a; }
TOBI_FN float lane_at(lane a, int k) { return a[k]; }
TOBI_FN int32_t lane_int_at(lane_int a, int k) { return a[k]; }
TOBI_FN lane lane_load(const float *p)
{
    lane v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
TOBI_FN void lane_store(float *p, lane a) { __builtin_memcpy(p, &a, sizeof a); }
/* One tree on every machine: (0+4)+(2+6) + (1+5)+(3+7). */
TOBI_FN float lane_sum(lane a)
{
    lane_half_ b = __builtin_shufflevector(a, a, 0, 1, 2, 3) + __builtin_shufflevector(a, a, 4, 5, 6, 7);
    return (b[0] + b[2]) + (b[1] + b[3]);
}
/* Four sums at once, each by that tree. */
TOBI_FN tobi_float4 lane_sum4(lane x, lane y, lane z, lane w)
{
    const lane v[4] = {x, y, z, w};
    lane_half_ h[4], pair[2];
    for (int k = 0; k < 4; k++) {
        h[k] = __builtin_shufflevector(v[k], v[k], 0, 1, 2, 3);
        h[k] += __builtin_shufflevector(v[k], v[k], 4, 5, 6, 7);
    }
    for (int k = 0; k < 2; k++) {
        lane_half_ a = h[2*k], b = h[2*k + 1];
        pair[k] = __builtin_shufflevector(a, b, 0, 4, 1, 5) + __builtin_shufflevector(a, b, 2, 6, 3, 7);
    }
    lane_half_ sum = __builtin_shufflevector(pair[0], pair[1], 0, 1, 4, 5);
    sum += __builtin_shufflevector(pair[0], pair[1], 2, 3, 6, 7);
    tobi_float4 out;
    __builtin_memcpy(&out, &sum, sizeof out);
    return out;
}
/* a - b modulo 2^32: wraps around periodic sides. */
TOBI_FN lane_int lane_sub_wrap(int32_t a, lane_int b)
{
    typedef uint32_t lane_uint __attribute__((vector_size(32)));
    return (lane_int)((lane_uint)lane_set_int(a) - (lane_uint)b);
}
#if !defined(__AVX__)
TOBI_FN void lane_transpose_(lane_half_ a[4])
{
    lane_half_ p = __builtin_shufflevector(a[0], a[1], 0, 4, 1, 5);
    lane_half_ q = __builtin_shufflevector(a[2], a[3], 0, 4, 1, 5);
    lane_half_ r = __builtin_shufflevector(a[0], a[1], 2, 6, 3, 7);
    lane_half_ s = __builtin_shufflevector(a[2], a[3], 2, 6, 3, 7);
    a[0] = __builtin_shufflevector(p, q, 0, 1, 4, 5);
    a[1] = __builtin_shufflevector(p, q, 2, 3, 6, 7);
    a[2] = __builtin_shufflevector(r, s, 0, 1, 4, 5);
    a[3] = __builtin_shufflevector(r, s, 2, 3, 6, 7);
}
/* Loads eight 16-byte rows and transposes them into four lanes. */
TOBI_FN void lane_load_float4(const tobi_float4 *base, const int32_t *j, lane *x, lane *y, lane *z, lane *w)
{
    lane *const to[4] = {x, y, z, w};
    for (int half = 0; half < 2; half++) {
        lane_half_ a[4];
        for (int k = 0; k < 4; k++) __builtin_memcpy(&a[k], base + j[4*half + k], 16);
        lane_transpose_(a);
        for (int k = 0; k < 4; k++) __builtin_memcpy((char *)to[k] + 16*half, &a[k], 16);
    }
}
/* Transposes four lanes into rows to[0], to[stride], ..., the first `count` of eight. */
TOBI_FN void lane_store_float4(tobi_float4 *to, int stride, int count, lane x, lane y, lane z, lane w)
{
    for (int half = 0; half < 2; half++) {
        lane_half_ a[4] = {lane_half_of_(x, half), lane_half_of_(y, half), lane_half_of_(z, half),
                           lane_half_of_(w, half)};
        lane_transpose_(a);
        for (int k = 0; k < 4 && 4*half + k < count; k++)
            __builtin_memcpy(to + (int64_t)(4*half + k)*stride, &a[k], 16);
    }
}
/* Eight places times scale less shift, in double, then transposed: x, y and z. */
TOBI_FN void lane_load_places(const tobi_double3 *from, double scale, const double shift[3], lane place[3])
{
    float part[3][8];
    for (int k = 0; k < 8; k++)
        for (int a = 0; a < 3; a++) part[a][k] = (float)((&from[k].x)[a]*scale - shift[a]);
    __builtin_memcpy(place, part, sizeof part);
}
#else
/* Two 16-byte rows side by side. As integers: machines unpack these at twice the rate of floats. */
TOBI_FN lane_int lane_load_two_(const void *low, const void *high)
{
#if defined(__AVX2__)
    __m256i a = _mm256_castsi128_si256(_mm_loadu_si128(low));
    return (lane_int)_mm256_inserti128_si256(a, _mm_loadu_si128(high), 1);
#else
    typedef int32_t four __attribute__((vector_size(16)));
    four a, b;
    __builtin_memcpy(&a, low, 16);
    __builtin_memcpy(&b, high, 16);
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
#endif
}
/* Loads eight 16-byte rows and transposes them into four lanes. */
TOBI_FN void lane_load_float4(const tobi_float4 *base, const int32_t *j, lane *x, lane *y, lane *z, lane *w)
{
    lane_int r[4];
    for (int k = 0; k < 4; k++) r[k] = lane_load_two_(base + j[k], base + j[k + 4]);
    lane t0 = (lane)__builtin_shufflevector(r[0], r[1], 0, 8, 1, 9, 4, 12, 5, 13);
    lane t1 = (lane)__builtin_shufflevector(r[2], r[3], 0, 8, 1, 9, 4, 12, 5, 13);
    lane t2 = (lane)__builtin_shufflevector(r[0], r[1], 2, 10, 3, 11, 6, 14, 7, 15);
    lane t3 = (lane)__builtin_shufflevector(r[2], r[3], 2, 10, 3, 11, 6, 14, 7, 15);
    *x = __builtin_shufflevector(t0, t1, 0, 1, 8, 9, 4, 5, 12, 13);
    *y = __builtin_shufflevector(t0, t1, 2, 3, 10, 11, 6, 7, 14, 15);
    *z = __builtin_shufflevector(t2, t3, 0, 1, 8, 9, 4, 5, 12, 13);
    *w = __builtin_shufflevector(t2, t3, 2, 3, 10, 11, 6, 7, 14, 15);
}
/* Eight places times scale less shift, in double, then transposed: x, y and z. */
TOBI_FN void lane_load_places(const tobi_double3 *from, double scale, const double shift[3], lane place[3])
{
    typedef double four __attribute__((vector_size(32)));
    const double *s = shift;
    const four less[3] = {{s[0], s[1], s[2], s[0]}, {s[1], s[2], s[0], s[1]}, {s[2], s[0], s[1], s[2]}};
    const four by = {scale, scale, scale, scale};
    lane_half_ a[6];
    for (int k = 0; k < 6; k++) {
        four d;
        __builtin_memcpy(&d, (const char *)from + 32*k, sizeof d);
        a[k] = __builtin_convertvector(d*by - less[k%3], lane_half_);
    }
    lane p = __builtin_shufflevector(a[0], a[3], 0, 1, 2, 3, 4, 5, 6, 7);     /* x y z x, twice */
    lane q = __builtin_shufflevector(a[1], a[4], 0, 1, 2, 3, 4, 5, 6, 7);     /* y z x y */
    lane r = __builtin_shufflevector(a[2], a[5], 0, 1, 2, 3, 4, 5, 6, 7);     /* z x y z */
    lane t = __builtin_shufflevector(q, r, 2, 2, 9, 9, 6, 6, 13, 13);
    lane u = __builtin_shufflevector(p, q, 1, 1, 8, 8, 5, 5, 12, 12);
    lane w = __builtin_shufflevector(q, r, 3, 3, 10, 10, 7, 7, 14, 14);
    lane z = __builtin_shufflevector(p, q, 2, 2, 9, 9, 6, 6, 13, 13);
    place[0] = __builtin_shufflevector(p, t, 0, 3, 8, 10, 4, 7, 12, 14);
    place[1] = __builtin_shufflevector(u, w, 0, 2, 8, 10, 4, 6, 12, 14);
    place[2] = __builtin_shufflevector(z, r, 0, 2, 8, 11, 4, 6, 12, 15);
}
/* Transposes four lanes into rows to[0], to[stride], ..., the first `count` of eight. */
TOBI_FN void lane_store_float4(tobi_float4 *to, int stride, int count, lane x, lane y, lane z, lane w)
{
    lane a = __builtin_shufflevector(x, y, 0, 8, 1, 9, 4, 12, 5, 13);
    lane b = __builtin_shufflevector(x, y, 2, 10, 3, 11, 6, 14, 7, 15);
    lane c = __builtin_shufflevector(z, w, 0, 8, 1, 9, 4, 12, 5, 13);
    lane d = __builtin_shufflevector(z, w, 2, 10, 3, 11, 6, 14, 7, 15);
    lane r[4] = {__builtin_shufflevector(a, c, 0, 1, 8, 9, 4, 5, 12, 13),
                 __builtin_shufflevector(a, c, 2, 3, 10, 11, 6, 7, 14, 15),
                 __builtin_shufflevector(b, d, 0, 1, 8, 9, 4, 5, 12, 13),
                 __builtin_shufflevector(b, d, 2, 3, 10, 11, 6, 7, 14, 15)};
    for (int k = 0; k < 8 && k < count; k++)
        __builtin_memcpy(to + (int64_t)k*stride, (const float *)&r[k & 3] + 4*(k >> 2), 16);
}
#endif
TOBI_FN void lane_load_record(const tobi_record *base, const int32_t *j, lane_int *x, lane_int *y,
                              lane_int *z, lane *w)
{
    lane fx, fy, fz;
    lane_load_float4((const tobi_float4 *)(const void *)base, j, &fx, &fy, &fz, w);
    *x = (lane_int)fx; *y = (lane_int)fy; *z = (lane_int)fz;
}
#endif

/* Kernels launched over a range add into sums[0..5] and raise sums[6..7] (see exec.h). */
enum { TOBI_SUMS = 6, TOBI_MAXIMA = 2, TOBI_TOTALS = TOBI_SUMS + TOBI_MAXIMA };

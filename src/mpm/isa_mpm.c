/* Turns kernels.def into loops, compiled once per instruction set. */
#include "mpm/kernels.h"
#include "mpm/filter.k.h"
#include "mpm/contact/pack.k.h"

#define JOIN_(a, b) a##_##b
#define JOIN(a, b) JOIN_(a, b)

#define LOOP(NAME, ITEM)                                                                            \
    static void NAME(const void *view, int64_t begin, int64_t end, double *totals)                  \
    {                                                                                               \
        (void)totals;                                                                               \
        for (int64_t n = begin; n < end; n++) ITEM;                                                 \
    }
#define BLOCK(K, SUMS, MAXIMA, DOC)                                                                 \
    LOOP(K##_2d, mpm_##K((const mpm_view *)view, n, totals, 2))                                     \
    LOOP(K##_3d, mpm_##K((const mpm_view *)view, n, totals, 3))
#define PACK(K, SUMS, MAXIMA, DOC) LOOP(pack_##K, mpm_pack_##K((const mpm_pack_view *)view, n))
#include "mpm/kernels.def"
#undef BLOCK
#undef PACK

#define PACK(K, SUMS, MAXIMA, DOC)
const mpm_kernels JOIN(mpm_kernels, TOBI_ISA)[2] = {
    {
#define BLOCK(K, SUMS, MAXIMA, DOC) .K = {K##_2d, SUMS, MAXIMA},
#include "mpm/kernels.def"
#undef BLOCK
    },
    {
#define BLOCK(K, SUMS, MAXIMA, DOC) .K = {K##_3d, SUMS, MAXIMA},
#include "mpm/kernels.def"
#undef BLOCK
    },
};
#undef PACK

#define BLOCK(K, SUMS, MAXIMA, DOC)
#define PACK(K, SUMS, MAXIMA, DOC) .K = {pack_##K, SUMS, MAXIMA},
const mpm_pack_kernels JOIN(mpm_pack_kernels, TOBI_ISA) = {
#include "mpm/kernels.def"
};

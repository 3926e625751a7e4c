/* Neighbour lists, which every pass reads: a neighbour of row i is 16 bits. Rows of neighbouring cells lie
   close together, but for those in the next strip of cells (exec/strips.h). So up to 0x7fff it counts from
   row i - 0x4000, and from 0x8000 on from row far[i], which each row has for itself. Where rows are too far
   apart for that, `far` is NULL and the list has whole numbers. Drawback: every pass unpacks it
   again, a row before its pairs: unpacked group by group, each group would wait for its numbers. */
#pragma once
#include "exec/portable.h"
#if defined(__AVX2__)
#  include <immintrin.h>
#endif
#include <stddef.h>

enum { TOBI_LIST_OWN = 0x4000,       /* row i itself                                                    */
       TOBI_LIST_FAR = 0x8000,
       TOBI_LIST_LIMIT = 1024 };     /* neighbours of a row at most                                     */

/* Bytes of an entry. */
TOBI_FN size_t tobi_list_size(const int32_t *far) { return far ? sizeof(uint16_t) : sizeof(int32_t); }

/* Eight codes. They go by memory: gcc 12 would take single numbers out of the register, which costs more. */
#if defined(__AVX2__) && !defined(__CUDACC__) && !defined(__cplusplus)
TOBI_FN void list_unpack_eight(const uint16_t *code, int32_t near, int32_t more, int32_t *j)
{
    const __m256i c = _mm256_cvtepu16_epi32(_mm_loadu_si128((const __m128i *)(const void *)code));
    const __m256i far = _mm256_cmpgt_epi32(c, _mm256_set1_epi32(TOBI_LIST_FAR - 1));
    const __m256i all = _mm256_add_epi32(_mm256_add_epi32(c, _mm256_set1_epi32(near)),
                                         _mm256_and_si256(far, _mm256_set1_epi32(more - TOBI_LIST_FAR)));
    _mm256_storeu_si256((__m256i *)(void *)j, all);
    __asm__("" : "+m"(*(int32_t(*)[8])j));
}
#else
TOBI_FN void list_unpack_eight(const uint16_t *code, int32_t near, int32_t more, int32_t *j)
{
    for (int k = 0; k < 8; k++) j[k] = near + code[k] + (code[k] < TOBI_LIST_FAR ? 0 : more - TOBI_LIST_FAR);
}
#endif

/* `count` neighbours of row i from entry `at` on: where they are, or j, where they have been unpacked to. */
TOBI_FN const int32_t *tobi_list_load(const void *list, const int32_t *far, int64_t i, int64_t at, int count,
                                      int32_t *j)
{
    if (!far) return (const int32_t *)list + at;
    const uint16_t *code = (const uint16_t *)list + at;
    const int32_t near = (int32_t)i - TOBI_LIST_OWN, more = far[i] - near;
    if (count%8 == 0) {
        for (int k = 0; k < count; k += 8) list_unpack_eight(code + k, near, more, j + k);
        return j;
    }
    for (int k = 0; k < count; k++)
        j[k] = near + code[k] + (code[k] < TOBI_LIST_FAR ? 0 : more - TOBI_LIST_FAR);
    return j;
}

/* The same of one. */
TOBI_FN int32_t tobi_list_at(const void *list, const int32_t *far, int64_t i, int64_t at)
{
    int32_t j;
    return *tobi_list_load(list, far, i, at, 1, &j);
}

/* Packs n neighbours of row i to out and sets *far; 0: it cannot be done. */
TOBI_FN int tobi_list_pack(const int32_t *j, int n, int32_t i, int32_t *far, uint16_t *out)
{
    const int32_t near = i - TOBI_LIST_OWN;
    uint32_t all = 0;
    *far = near;
    for (int k = 0; k < n; k++) {
        const uint32_t c = (uint32_t)(j[k] - near);
        all |= c;
        out[k] = (uint16_t)c;
    }
    if (all < TOBI_LIST_FAR) return 1;
    int32_t least = INT32_MAX;
    for (int k = 0; k < n; k++)
        if ((uint32_t)(j[k] - near) >= TOBI_LIST_FAR && j[k] < least) least = j[k];
    *far = least;
    for (int k = 0; k < n; k++) {
        if ((uint32_t)(j[k] - near) < TOBI_LIST_FAR) continue;
        if (j[k] - least >= TOBI_LIST_FAR) return 0;
        out[k] = (uint16_t)(TOBI_LIST_FAR + (j[k] - least));
    }
    return 1;
}

/* The n-th allocation that the library, or the test itself, asks for fails. The address sanitizer, where it
   is in, tells what a failure has left. To be included by one file of a program. */
#pragma once
#include <stddef.h>

static long allocations, fail_at;      /* so many so far; the one that fails, 0 = none */

extern char __executable_start, etext;
#ifdef __SANITIZE_ADDRESS__
void *__interceptor_malloc(size_t), *__interceptor_calloc(size_t, size_t);
void *__interceptor_realloc(void *, size_t), *__interceptor_aligned_alloc(size_t, size_t);
#define GIVEN(name) __interceptor_##name
#else
void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);
#define __libc_aligned_alloc __libc_memalign
#define GIVEN(name) __libc_##name
#endif

static int fails(const void *caller)
{
    if ((const char *)caller < &__executable_start || (const char *)caller >= &etext) return 0;
    return ++allocations == fail_at;
}
#define FAILS fails(__builtin_return_address(0))

void *malloc(size_t n) { return FAILS ? NULL : GIVEN(malloc)(n); }
void *calloc(size_t n, size_t size) { return FAILS ? NULL : GIVEN(calloc)(n, size); }
void *realloc(void *p, size_t n) { return FAILS ? NULL : GIVEN(realloc)(p, n); }
void *aligned_alloc(size_t align, size_t n) { return FAILS ? NULL : GIVEN(aligned_alloc)(align, n); }

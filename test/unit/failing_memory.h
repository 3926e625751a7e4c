/* The n-th allocation that the library, or the test itself, asks for fails. Under the address sanitizer,
   which has its own, none does. To be included by one file of a program. */
#pragma once
#include <stddef.h>

static long allocations, fail_at;      /* so many so far; the one that fails, 0 = none */

#ifndef __SANITIZE_ADDRESS__
enum { ALLOCATIONS_FAIL = 1 };
extern char __executable_start, etext;
void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);

static int fails(const void *caller)
{
    if ((const char *)caller < &__executable_start || (const char *)caller >= &etext) return 0;
    return ++allocations == fail_at;
}
#define FAILS fails(__builtin_return_address(0))

void *malloc(size_t n) { return FAILS ? NULL : __libc_malloc(n); }
void *calloc(size_t n, size_t size) { return FAILS ? NULL : __libc_calloc(n, size); }
void *realloc(void *p, size_t n) { return FAILS ? NULL : __libc_realloc(p, n); }
void *aligned_alloc(size_t align, size_t n) { return FAILS ? NULL : __libc_memalign(align, n); }
#else
enum { ALLOCATIONS_FAIL = 0 };
#endif

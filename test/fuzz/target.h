/* What the fuzz targets share.

   A target is one file with LLVMFuzzerTestOneInput. With clang (preset `fuzz`) libFuzzer drives it;
   in every other build replay.c hands it the files of corpus/<target>/ and it is an ordinary test.
   A target ends the process (abort) when a promise of the library is broken; sanitizers do the rest. */
#pragma once
#define _GNU_SOURCE 1
#include "base/error.h"
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* A broken promise. */
#define PROMISE(condition)                                                              \
    do {                                                                                \
        if (!(condition)) {                                                             \
            fprintf(stderr, "%s:%d: broken promise: %s\n", __FILE__, __LINE__, #condition); \
            abort();                                                                    \
        }                                                                               \
    } while (0)

/* A failing call has a status and a text; a passing one needs none. */
static inline int passed(tobi_status status, const tobi_error *err)
{
    if (status != TOBI_OK) PROMISE(err->status == status && err->text[0]);
    return status == TOBI_OK;
}

/* The bytes as a file that lives in memory; path takes 64 characters. close() releases it. */
static inline int make_file(const void *data, size_t size, char *path)
{
    int fd = memfd_create("fuzz", MFD_CLOEXEC);
    PROMISE(fd >= 0 && write(fd, data, size) == (ssize_t)size);
    snprintf(path, 64, "/proc/self/fd/%d", fd);
    return fd;
}

/* Reads fixed pieces from the input; zeros when it has ended. */
typedef struct reader { const uint8_t *data; size_t left; } reader;

static inline void take(reader *r, void *out, size_t bytes)
{
    size_t n = bytes < r->left ? bytes : r->left;
    memset(out, 0, bytes);
    if (n) memcpy(out, r->data, n);
    r->data += n;
    r->left -= n;
}

static inline uint8_t take_byte(reader *r)
{
    uint8_t byte;
    take(r, &byte, 1);
    return byte;
}

/* Filling a tobi_error, and returning early from a failed call. */
#pragma once
#include "tobiuo/base.h"
#include <stdarg.h>

/* Writes status and formatted text into err (NULL is fine) and returns status. */
tobi_status tobi_fail(tobi_error *err, tobi_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* What a public call cannot do without: a NULL there is a mistake of the calling program, told as one. */
#define TOBI_NEED(pointer, name)                                                                   \
    do {                                                                                           \
        if (!(pointer)) return tobi_fail(err, TOBI_INVALID, "%s: %s is NULL", __func__, name);     \
    } while (0)

#define TOBI_TRY(call)                                  \
    do {                                                \
        tobi_status try_status_ = (call);               \
        if (try_status_ != TOBI_OK) return try_status_; \
    } while (0)

/* Filling a tobi_error, and returning early from a failed call. */
#pragma once
#include "tobiuo/base.h"
#include <stdarg.h>

/* Writes status and formatted text into err (NULL is fine) and returns status. */
tobi_status tobi_fail(tobi_error *err, tobi_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#define TOBI_TRY(call)                                  \
    do {                                                \
        tobi_status try_status_ = (call);               \
        if (try_status_ != TOBI_OK) return try_status_; \
    } while (0)

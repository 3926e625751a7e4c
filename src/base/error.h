/* Filling a tobi_error, and returning early from a failed call. */
#pragma once
#include "tobiuo/base.h"
#include "base/language.h"
#include <stdarg.h>

/* Writes status and formatted text into err (NULL is fine) and returns status. */
tobi_status tobi_fail(tobi_error *err, tobi_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Says which key of the definition the failure `status` is about, unless that is known; returns status. */
tobi_status tobi_at_key(tobi_error *err, tobi_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

enum { TOBI_NOTE = 700 };        /* bytes: room of a note, in any language */
enum { TOBI_EXCERPT = 16 };      /* bytes */

/* A piece of a file that may not be what it was taken for, short enough to stand in a message: its first
   bytes, those that are no plain characters as '?', and dots where it goes on. */
typedef struct tobi_short_text { char text[TOBI_EXCERPT + 4]; } tobi_short_text;
tobi_short_text tobi_excerpt(const char *text);

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

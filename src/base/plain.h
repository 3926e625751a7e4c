/* Opening files that a user names: only plain ones, only up to a size. */
#pragma once
#include "base/error.h"
#include <stdio.h>

/* Opens the file at `path` for reading. `what` is what the caller takes it for ("keyframes"); with the path
   it begins every message. limit: bytes, 0 = any size. *size may be NULL.
   TOBI_NOT_FOUND no such file; TOBI_IO unreadable, or not a plain file; TOBI_INVALID too large. */
tobi_status tobi_plain_open(const char *path, const char *what, int64_t limit, FILE **file, int64_t *size,
                            tobi_error *err);

/* The whole file as a text of `size` bytes and a zero byte behind them; the caller frees it. */
tobi_status tobi_plain_read(const char *path, const char *what, int64_t limit, char **text, size_t *size,
                            tobi_error *err);

/* SHA-256 of a file (FIPS 180-4), as the program sha256sum prints it. */
#pragma once
#include "base/error.h"
#include <stdint.h>

enum { TOBI_SHA256_TEXT = 65 };       /* 64 digits and the zero byte */

/* The plain file at `path`: its digest, and its size in bytes. Errors: those of tobi_plain_open. */
tobi_status tobi_sha256_file(const char *path, char digest[TOBI_SHA256_TEXT], int64_t *size, tobi_error *err);

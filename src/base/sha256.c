/* SHA-256 of a file, by libmd. */
#include "base/sha256.h"
#include "base/plain.h"
#include <sha2.h>

_Static_assert(TOBI_SHA256_TEXT == SHA256_DIGEST_STRING_LENGTH, "room for the digits");

tobi_status tobi_sha256_file(const char *path, char digest[TOBI_SHA256_TEXT], int64_t *size, tobi_error *err)
{
    unsigned char buffer[1 << 14];
    SHA2_CTX state;
    FILE *file;
    TOBI_TRY(tobi_plain_open(path, tr("file"), 0, &file, NULL, err));
    SHA256Init(&state);
    *size = 0;
    for (size_t n; (n = fread(buffer, 1, sizeof buffer, file)) > 0; *size += (int64_t)n)
        SHA256Update(&state, buffer, n);
    const int failed = ferror(file);
    fclose(file);
    if (failed) return tobi_fail(err, TOBI_IO, "%s: cannot be read to its end", path);
    SHA256End(&state, digest);
    return TOBI_OK;
}

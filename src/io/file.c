#define _GNU_SOURCE 1
#include "io/file.h"
#include <errno.h>
#include <locale.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

char *tobi_file_part_name(const char *path)
{
    size_t length = strlen(path);
    char *part = malloc(length + 6);
    if (part) {
        memcpy(part, path, length);
        memcpy(part + length, ".part", 6);
    }
    return part;
}

static void release(tobi_file *file)
{
    free(file->path);
    free(file->part);
    if (file->plain) freelocale(file->plain);
    *file = (tobi_file){ 0 };
}

tobi_status tobi_file_open(tobi_file *file, const char *path, tobi_error *err)
{
    *file = (tobi_file){ .path = strdup(path), .part = tobi_file_part_name(path),
                         .plain = newlocale(LC_ALL_MASK, "C", (locale_t)0) };
    if (!file->path || !file->part || !file->plain) {
        release(file);
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", path);
    }
    file->handle = fopen(file->part, "wb");
    if (!file->handle) {
        int code = errno;
        release(file);
        return tobi_fail(err, TOBI_IO, "cannot write %s: %s", path, strerror(code));
    }
    return TOBI_OK;
}

static void note_failure(tobi_file *file)
{
    if (!file->error) file->error = errno ? errno : EIO;
}

void tobi_file_write(tobi_file *file, const void *data, size_t bytes)
{
    if (file->error || bytes == 0) return;
    errno = 0;
    if (fwrite(data, 1, bytes, file->handle) != bytes) note_failure(file);
}

void tobi_file_print(tobi_file *file, const char *format, ...)
{
    if (file->error) return;
    /* The host program may have set a locale with decimal commas; this thread leaves it for a moment. */
    locale_t before = uselocale(file->plain);
    va_list args;
    va_start(args, format);
    errno = 0;
    if (vfprintf(file->handle, format, args) < 0) note_failure(file);
    va_end(args);
    uselocale(before);
}

off_t tobi_file_tell(tobi_file *file)
{
    if (file->error) return 0;
    off_t at = ftello(file->handle);
    if (at < 0) note_failure(file);
    return at < 0 ? 0 : at;
}

void tobi_file_patch(tobi_file *file, off_t at, const void *data, size_t bytes)
{
    if (file->error) return;
    if (fseeko(file->handle, at, SEEK_SET) != 0) note_failure(file);
    tobi_file_write(file, data, bytes);
    if (!file->error && fseeko(file->handle, 0, SEEK_END) != 0) note_failure(file);
}

tobi_status tobi_file_commit(tobi_file *file, tobi_error *err)
{
    errno = 0;
    if (fclose(file->handle) != 0) note_failure(file);
    if (!file->error && rename(file->part, file->path) != 0) note_failure(file);
    tobi_status status = TOBI_OK;
    if (file->error) {
        status = tobi_fail(err, TOBI_IO, "cannot write %s: %s", file->path, strerror(file->error));
        remove(file->part);
    }
    release(file);
    return status;
}

void tobi_file_abandon(tobi_file *file)
{
    if (!file->handle) return;
    fclose(file->handle);
    remove(file->part);
    release(file);
}

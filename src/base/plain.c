/* Opening files that a user names.

   A FIFO would keep the reader waiting, a device such as /dev/zero would feed it without end, so both
   are refused before they are opened: opening a device can already act. The look is repeated on the
   open file, since somebody may have put another one in its place, and O_NONBLOCK keeps that from
   waiting. Drawback: what a shell offers as a pipe, <(command), is refused too. */
#define _GNU_SOURCE 1
#include "base/plain.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *name_kind(mode_t mode)
{
    if (S_ISDIR(mode)) return tr("a directory");
    if (S_ISFIFO(mode)) return tr("a pipe");
    return S_ISSOCK(mode) ? tr("a socket") : tr("a device");
}

static tobi_status fail_errno(const char *path, const char *what, int code, tobi_error *err)
{
    return tobi_fail(err, code == ENOENT || code == ENOTDIR ? TOBI_NOT_FOUND : TOBI_IO, "%s %s: %s", what,
                     path, tobi_reason(code));
}

static tobi_status judge(const char *path, const char *what, int64_t limit, const struct stat *info,
                         tobi_error *err)
{
    if (!S_ISREG(info->st_mode))
        return tobi_fail(err, TOBI_IO, "%s %s: is %s; only plain files are read", what, path,
                         name_kind(info->st_mode));
    if (limit > 0 && info->st_size > limit)
        return tobi_fail(err, TOBI_INVALID, "%s %s: has %lld bytes; allowed are at most %lld", what, path,
                         (long long)info->st_size, (long long)limit);
    return TOBI_OK;
}

tobi_status tobi_plain_open(const char *path, const char *what, int64_t limit, FILE **file, int64_t *size,
                            tobi_error *err)
{
    struct stat info;
    *file = NULL;
    if (!*path) return tobi_fail(err, TOBI_NOT_FOUND, "%s: its path is empty", what);
    if (stat(path, &info) != 0) return fail_errno(path, what, errno, err);
    TOBI_TRY(judge(path, what, limit, &info, err));
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (fd < 0 || fstat(fd, &info) != 0) {
        int code = errno;
        if (fd >= 0) close(fd);
        return fail_errno(path, what, code, err);
    }
    tobi_status status = judge(path, what, limit, &info, err);
    if (status == TOBI_OK && !(*file = fdopen(fd, "rb")))
        status = tobi_fail(err, TOBI_NO_MEMORY, "%s %s: no memory to open it", what, path);
    if (status != TOBI_OK) close(fd);
    else if (size) *size = info.st_size;
    return status;
}

tobi_status tobi_plain_read(const char *path, const char *what, int64_t limit, char **text, size_t *size,
                            tobi_error *err)
{
    FILE *file;
    int64_t bytes = 0;
    *text = NULL;
    *size = 0;
    TOBI_TRY(tobi_plain_open(path, what, limit, &file, &bytes, err));
    char *all = malloc((size_t)bytes + 1);
    size_t done = 0, n = 1;
    for (; all && n > 0 && done < (size_t)bytes; done += n)
        n = fread(all + done, 1, (size_t)bytes - done, file);
    fclose(file);
    if (all && done == (size_t)bytes) {
        all[done] = '\0';
        *text = all;
        *size = done;
        return TOBI_OK;
    }
    if (!all)
        return tobi_fail(err, TOBI_NO_MEMORY, "%s %s: no memory for %lld bytes", what, path,
                         (long long)bytes);
    free(all);
    return tobi_fail(err, TOBI_IO, "%s %s: cannot be read to its end", what, path);
}

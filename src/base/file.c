/* Writes beside the target and renames at the end; the error is kept until then. Drawback: a result
   takes its room on the disk twice for a moment. */
#define _GNU_SOURCE 1
#include "base/file.h"
#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *name_kind(mode_t mode)
{
    return S_ISDIR(mode) ? tr("folder") : S_ISLNK(mode) ? tr("symbolic link") : S_ISFIFO(mode) ? "FIFO"
         : S_ISSOCK(mode) ? tr("socket") : tr("device");
}

tobi_status tobi_file_check_target(const char *path, tobi_error *err)
{
    struct stat info;
    if (!*path) return tobi_fail(err, TOBI_INVALID, "cannot write a file: its path is empty");
    if (lstat(path, &info) != 0 || S_ISREG(info.st_mode)) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "cannot write %s: it is a %s; only a plain file is replaced", path,
                     name_kind(info.st_mode));
}

static char *name_part(const char *path)
{
    char *part = NULL;
    return asprintf(&part, "%s.part", path) < 0 ? NULL : part;
}

static void release(tobi_file *file)
{
    free(file->path);
    free(file->part);
    if (file->plain) freelocale(file->plain);
    *file = (tobi_file){ 0 };
}

/* A file of our own: whatever stands in its place, a link too, is removed and not followed. */
static FILE *open_part(const char *part)
{
    if (unlink(part) != 0 && errno != ENOENT) return NULL;
    int fd = open(part, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    FILE *handle = fd >= 0 ? fdopen(fd, "wb") : NULL;
    if (fd >= 0 && !handle) {
        close(fd);
        unlink(part);
    }
    return handle;
}

tobi_status tobi_file_open(tobi_file *file, const char *path, tobi_error *err)
{
    *file = (tobi_file){ 0 };
    TOBI_TRY(tobi_file_check_target(path, err));
    *file = (tobi_file){ .path = strdup(path), .part = name_part(path),
                         .plain = newlocale(LC_ALL_MASK, "C", (locale_t)0) };
    if (!file->path || !file->part || !file->plain) {
        release(file);
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", path);
    }
    file->handle = open_part(file->part);
    if (!file->handle) {
        int code = errno;
        release(file);
        return tobi_fail(err, TOBI_IO, "cannot write %s: %s", path, tobi_reason(code));
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

void tobi_file_sync(tobi_file *file)
{
    errno = 0;
    if (!file->error && (fflush(file->handle) != 0 || fsync(fileno(file->handle)) != 0)) note_failure(file);
    file->synced = 1;
}

/* The name is an entry of the folder. Some file systems cannot do that for folders: no failure. */
static void sync_folder(tobi_file *file)
{
    const char *slash = strrchr(file->path, '/');
    char *folder = strndup(slash ? file->path : ".", slash ? (size_t)(slash - file->path) + 1 : 1);
    int fd = folder ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    errno = fd < 0 ? EIO : 0;
    if (fd < 0 || (fsync(fd) != 0 && (errno == EIO || errno == ENOSPC))) note_failure(file);
    if (fd >= 0) close(fd);
    free(folder);
}

tobi_status tobi_file_commit(tobi_file *file, tobi_error *err)
{
    errno = 0;
    if (fclose(file->handle) != 0) note_failure(file);
    if (!file->error && rename(file->part, file->path) != 0) note_failure(file);
    if (file->error) remove(file->part);
    else if (file->synced) sync_folder(file);
    tobi_status status = TOBI_OK;
    if (file->error)
        status = tobi_fail(err, TOBI_IO, "cannot write %s: %s", file->path, tobi_reason(file->error));
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

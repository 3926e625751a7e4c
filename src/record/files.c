/* The directory of a run: making, locking, and knowing which files in it are ours.

   Ours is what matches the list of names below. Anything else in the directory is the user's and is
   never touched. The directory itself may be reached by a link; inside it no link is followed,
   because it may come from a stranger. Drawback: that is looked at when the run starts, so that a
   directory in which somebody else works at the same time is not safe. */
#define _GNU_SOURCE
#include "record/record.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <fnmatch.h>
#include <jansson.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#define SIX "[0-9][0-9][0-9][0-9][0-9][0-9]"

/* Folder, pattern. A file in work has ".part" behind its name. */
static const struct { const char *folder, *pattern; } ours[] = {
    { "", "resolved.json" }, { "", "inputs.json" }, { "", "summary.json" }, { "", "history.csv" },
    { "", "bodies.csv" }, { "", "solids.csv" }, { "", "probes.csv" }, { "", "lines.csv" },
    { "", "joints.csv" }, { "", "porous_zones.csv" }, { "", "scalars.csv" },
    { "", "*.pvd" },
    { "fluid", "fluid_" SIX "*.vtu" }, { "bodies", "bodies_" SIX "*.vtu" },
    { "grid", "grid_" SIX "*.vtu" }, { "surface", "surface_" SIX "*.vtp" },
    { "sample", "*_" SIX ".vti" }, { "sample", "*_mean.vti" }, { "sample", "*.pvd" }, { "sample", "*.csv" },
    { "foam", "foam_" SIX "*.vtp" }, { "tractions", "*_" SIX "*.vtp" },
    { "surfaces", "*_" SIX "*.vtp" }, { "surfaces", "*_" SIX "*.stl" },
    { "frames", "*_" SIX "*.png" }, { "ply", "fluid_" SIX "*.ply" }, { "obj", "*_" SIX "*.obj" },
    { "checkpoints", "checkpoint_*.h5" }, { "checkpoints", "checkpoint_*.json" },
};
static const char *const folders[] = { "", "fluid", "bodies", "grid", "surface", "surfaces", "foam", "sample",
                                      "tractions", "frames", "ply", "obj", "checkpoints", "nests" };

char *tobi_record_path(const char *dir, const char *format, ...)
{
    char name[512], *path = NULL;
    va_list args;
    va_start(args, format);
    vsnprintf(name, sizeof name, format, args);
    va_end(args);
    return asprintf(&path, "%s/%s", dir, name) < 0 ? NULL : path;
}

/* 0: not ours; 1: finished; 2: in work. */
static int classify(const char *folder, const char *name)
{
    char stem[300];
    size_t n = strlen(name);
    bool part = n > 5 && n < sizeof stem && strcmp(name + n - 5, ".part") == 0;
    snprintf(stem, sizeof stem, "%.*s", (int)(part ? n - 5 : n), name);
    for (size_t k = 0; k < sizeof ours / sizeof *ours; k++)
        if (strcmp(ours[k].folder, folder) == 0 && fnmatch(ours[k].pattern, stem, 0) == 0)
            return part ? 2 : 1;
    return 0;
}

static tobi_status make_parents(const char *dir, tobi_error *err)
{
    char *path = strdup(dir);
    if (!path) return tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    tobi_status status = TOBI_OK;
    for (char *p = path + 1;; p++) {
        if (*p != '/' && *p != '\0') continue;
        char end = *p;
        *p = '\0';
        if (mkdir(path, 0777) != 0 && errno != EEXIST) {
            status =
                tobi_fail(err, TOBI_IO, "cannot make the directory %s: %s", path, tobi_reason(errno));
            break;
        }
        *p = end;
        if (end == '\0') break;
    }
    free(path);
    return status;
}

static tobi_status check_folders(const char *dir, int fd, tobi_error *err)
{
    struct stat info, root;
    if (fstat(fd, &info) == 0 && stat("/", &root) == 0 && info.st_dev == root.st_dev &&
        info.st_ino == root.st_ino)
        return tobi_fail(err, TOBI_INVALID, "%s is the root of the file system: results need a directory of "
                         "their own", dir);
    for (size_t k = 1; k < sizeof folders / sizeof *folders; k++)
        if (fstatat(fd, folders[k], &info, AT_SYMLINK_NOFOLLOW) == 0 && S_ISLNK(info.st_mode))
            return tobi_fail(err, TOBI_INVALID, "%s/%s is a symbolic link: a run writes into plain folders "
                             "only (the directory %s itself may be a link)", dir, folders[k], dir);
    return TOBI_OK;
}

tobi_status tobi_record_open_dir(const char *dir, int *lock, tobi_error *err)
{
    if (!*dir) return tobi_fail(err, TOBI_INVALID, "the name of the output directory is empty");
    TOBI_TRY(make_parents(dir, err));
    int fd = open(dir, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0)
        return tobi_fail(err, TOBI_IO, "cannot open the directory %s: %s", dir, tobi_reason(errno));
    *lock = fd;
    TOBI_TRY(check_folders(dir, fd, err));
    if (faccessat(fd, ".", W_OK | X_OK, AT_EACCESS) != 0)
        return tobi_fail(err, TOBI_IO, "cannot write to the directory %s: %s", dir,
                         tobi_reason(errno));
    if (flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return tobi_fail(err, TOBI_IO, "%s: another run is writing to this directory", dir);
    return TOBI_OK;
}

/* Calls visit for each of our files in dir; stops at the first that returns false. Returns false if a
   folder that is there could not be listed. */
static bool visit_ours(const char *dir, bool (*visit)(void *user, const char *path, int kind),
                       void *user)
{
    bool going = true, complete = true;
    for (size_t k = 0; going && k < sizeof folders / sizeof *folders; k++) {
        char *folder = tobi_record_path(dir, "%s", folders[k]);
        DIR *list = folder ? opendir(folder) : NULL;
        const struct dirent *entry;
        if (!list && (!folder || (errno != ENOENT && errno != ENOTDIR))) complete = false;
        while (list && going && (entry = readdir(list))) {
            int kind = classify(folders[k], entry->d_name);
            char *path = kind ? tobi_record_path(folder, "%s", entry->d_name) : NULL;
            if (path) going = visit(user, path, kind);
            else if (kind) complete = false;
            free(path);
        }
        if (list) closedir(list);
        free(folder);
    }
    return complete;
}

static bool note_result(void *user, const char *path, int kind)
{
    (void)path;
    *(bool *)user |= kind == 1;
    return kind != 1;
}

static tobi_status fail_listing(const char *dir, tobi_error *err)
{
    return tobi_fail(err, TOBI_IO, "cannot list what is in %s; nothing was changed", dir);
}

tobi_status tobi_record_find_results(const char *dir, bool *found, tobi_error *err)
{
    *found = false;
    bool complete = visit_ours(dir, note_result, found);
    return complete || *found ? TOBI_OK : fail_listing(dir, err);
}

typedef struct clear_job { bool only_parts; tobi_status status; tobi_error *err; } clear_job;

static bool remove_one(void *user, const char *path, int kind)
{
    clear_job *job = user;
    if (job->only_parts && kind != 2) return true;
    if (unlink(path) == 0 || errno == ENOENT) return true;
    job->status = tobi_fail(job->err, TOBI_IO, "cannot remove %s: %s", path, tobi_reason(errno));
    return false;
}

tobi_status tobi_record_clear(const char *dir, bool only_parts, tobi_error *err)
{
    clear_job job = { only_parts, TOBI_OK, err };
    bool complete = visit_ours(dir, remove_one, &job);
    if (!complete && job.status == TOBI_OK)
        return tobi_fail(err, TOBI_IO, "cannot list all that is in %s", dir);
    if (job.status != TOBI_OK || only_parts) return job.status;
    for (size_t k = 1; k < sizeof folders / sizeof *folders; k++) {
        char *folder = tobi_record_path(dir, "%s", folders[k]);
        if (folder) rmdir(folder);      /* stays if the user keeps something in it */
        free(folder);
    }
    return TOBI_OK;
}

/* What the user keeps in the folder of a nest stays. */
static tobi_status clear_nest(const char *dir, const char *name, tobi_error *err)
{
    struct stat info;
    int lock = -1;
    char *path = tobi_record_path(dir, "nests/%s", name);
    if (!path) return tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    tobi_status status = TOBI_OK;
    if (lstat(path, &info) == 0 && S_ISDIR(info.st_mode)) {
        status = tobi_record_open_dir(path, &lock, err);
        if (status == TOBI_OK) status = tobi_record_clear(path, false, err);
        if (lock >= 0) close(lock);
        if (status == TOBI_OK) rmdir(path);
    }
    free(path);
    return status;
}

tobi_status tobi_record_clear_nests(const char *dir, const char *resolved, tobi_error *err)
{
    json_t *scene = resolved ? json_loads(resolved, 0, NULL) : NULL;
    const json_t *list = json_object_get(scene, "nests");
    tobi_status status = TOBI_OK;
    for (size_t k = 0; k < json_array_size(list) && status == TOBI_OK; k++) {
        const char *name = json_string_value(json_object_get(json_array_get(list, k), "name"));
        if (tobi_nest_name_fits(name)) status = clear_nest(dir, name, err);
    }
    json_decref(scene);
    return status;
}

tobi_status tobi_record_make_dir(const char *dir, const char *name, tobi_error *err)
{
    char *path = tobi_record_path(dir, "%s", name);
    if (!path) return tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    tobi_status status = make_parents(path, err);
    free(path);
    return status;
}

/* Whether dir is still the directory that the run has locked. */
static bool is_ours(const tobi_run *run)
{
    struct stat ours, there;
    return fstat(run->lock, &ours) == 0 && stat(run->dir, &there) == 0 && ours.st_dev == there.st_dev &&
           ours.st_ino == there.st_ino;
}

tobi_status tobi_record_keep_dir(tobi_run *run, tobi_error *err)
{
    tobi_status status = TOBI_OK;
    pthread_mutex_lock(&run->dir_lock);
    if (!is_ours(run)) {
        int fd = -1;
        status = tobi_record_open_dir(run->dir, &fd, err);
        if (fd >= 0) close(status == TOBI_OK ? run->lock : fd);
        if (status == TOBI_OK) run->lock = fd;
        run->lost_dir |= status == TOBI_OK;
    }
    if (status == TOBI_OK) status = tobi_series_folders(run, err);
    pthread_mutex_unlock(&run->dir_lock);
    return status;
}

bool tobi_record_is_folder_gone(const tobi_run *run)
{
    char *path = tobi_record_path(run->dir, "fluid");
    const bool gone = path && access(path, F_OK) != 0;
    free(path);
    return gone;
}

static int compare_descending(const void *a, const void *b)
{
    int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x < y) - (x > y);
}

int tobi_record_checkpoints(const char *dir, int64_t *steps, int limit)
{
    char *folder = tobi_record_path(dir, "checkpoints");
    DIR *list = folder ? opendir(folder) : NULL;
    const struct dirent *entry;
    int count = 0;
    if (!list && (!folder || errno != ENOENT)) count = -1;
    while (list && (entry = readdir(list))) {
        long long step;
        int end = 0;
        if (sscanf(entry->d_name, "checkpoint_%lld.h5%n", &step, &end) != 1) continue;
        if (end == 0 || entry->d_name[end] != '\0' || count == limit) continue;
        steps[count++] = step;
    }
    if (list) closedir(list);
    free(folder);
    if (count > 1) qsort(steps, (size_t)count, sizeof *steps, compare_descending);
    return count;
}

/* What a run takes of the disk and of the user's time, told before it starts. The time is that of the
   first steps, which is quick to measure; a flow that gets faster or finer later takes longer. */
#define _GNU_SOURCE
#include "app.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/statvfs.h>

/* Results beyond these are seldom meant: the largest of the shipped scenes takes 2 GB. */
static const double MOST_BYTES = 20e9, MOST_FILES = 1e6, MOST_OF_DISK = 0.5;

const char *bytes_text(double bytes, char *buffer)
{
    if (bytes < 1e9) snprintf(buffer, 32, "%.*f MB", bytes < 1e7, bytes * 1e-6);
    else snprintf(buffer, 32, "%.*f GB", bytes < 1e10, bytes * 1e-9);
    return buffer;
}

/* Bytes that are free where dir is or will be; infinite if that cannot be found out, or if nothing can be
   written there anyway, which the one who writes tells. */
static double free_bytes(const char *dir)
{
    struct statvfs disk;
    char *path = strdup(*dir ? dir : "."), *end;
    while (path && statvfs(path, &disk) != 0) {
        if (strcmp(path, ".") == 0 || strcmp(path, "/") == 0) break;
        if ((end = strrchr(path, '/'))) end[end == path] = '\0';
        else strcpy(path, ".");
    }
    const int known = path && statvfs(path, &disk) == 0 && disk.f_blocks > 0 &&    /* /proc has none */
                      !(disk.f_flag & ST_RDONLY);
    const double bytes = known ? (double)disk.f_bavail * (double)disk.f_frsize : INFINITY;
    free(path);
    return bytes;
}

char *size_objection(const tobi_run_size *size, const char *dir)
{
    const double left = free_bytes(dir);
    char bytes[32], room[32], free_text[64] = "", *text = NULL;
    if (size->bytes <= fmin(MOST_BYTES, MOST_OF_DISK * left) && size->files <= MOST_FILES) return NULL;
    if (isfinite(left)) snprintf(free_text, sizeof free_text, tr(", and %s are free"), bytes_text(left,
                                                                                                  room));
    const int length = asprintf(&text, tr("%lld outputs take about %s in %.7g files%s; make spacing or "
                                   "output.interval larger, output.fields fewer or output.compression "
                                   "zlib, or run with --force"), (long long)size->outputs,
                                bytes_text(size->bytes, bytes), size->files, free_text);
    return length < 0 ? strdup(tr("out of memory")) : text;
}

enum { MEASURED_STEPS = 100 };
static const double MEASURED_TIME = 0.7;    /* s */

tobi_status measure_steps(tobi_world *world, double end, int *steps, double *wall, double *step,
                          tobi_error *err)
{
    double first = 0, start = 0;
    *steps = 0;
    while (*steps < MEASURED_STEPS && tobi_world_time(world) < end) {
        tobi_status status = tobi_world_step(world, end - tobi_world_time(world), NULL, err);
        if (status != TOBI_OK) return status;
        if ((*steps)++ == 0) {
            first = wall_clock();
            start = tobi_world_time(world);
        } else if (wall_clock() - first > MEASURED_TIME) break;
    }
    *wall = (wall_clock() - first) / (*steps - 1);
    *step = (tobi_world_time(world) - start) / (*steps - 1);
    return TOBI_OK;
}

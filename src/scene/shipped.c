/* Where the shipped scenes are. An installation may be moved, so the search starts where this code itself
   was loaded from and goes up; the source tree of the build is the last resort. */
#define _GNU_SOURCE 1
#include "tobiuo/scene.h"
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char *find_in(const char *folder, const char *middle, const char *name)
{
    char *path = NULL, *found = NULL;
    if (asprintf(&path, "%s/%s/%s", folder, middle, name) < 0) return NULL;
    if (access(path, R_OK) == 0) found = realpath(path, NULL);
    free(path);
    return found;
}

/* In the folder of `file` and in those above it. */
static char *find_above(const char *file, const char *name)
{
    char *folder = realpath(file, NULL), *found = NULL, *slash;
    while (folder && !found && (slash = strrchr(folder, '/')) && slash > folder) {
        *slash = '\0';
        found = find_in(folder, "share/tobiuo/scenes", name);
        if (!found) found = find_in(folder, "scenes", name);
    }
    free(folder);
    return found;
}

char *tobi_scene_shipped(const char *name)
{
    static const char here = 0;
    Dl_info info;
    char *found = NULL;
    if (dladdr(&here, &info) && info.dli_fname) found = find_above(info.dli_fname, name);
    if (!found) found = find_above("/proc/self/exe", name);
#ifdef TOBI_SCENES
    if (!found) found = find_in(TOBI_SCENES, ".", name);
#endif
    return found;
}

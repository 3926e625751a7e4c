/* "Did you mean" for scenes and runs: what a path that leads nowhere may mean. Looked at are the folder that
   the path names and, for scenes, the shipped ones. Drawback: nothing below other folders is found. */
#define _GNU_SOURCE
#include "app.h"
#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char scene_mark[] = "scene.json", run_mark[] = "resolved.json";

/* Whether a folder is marked by a file: scenes by scene.json, runs by resolved.json. */
static int is_marked(const char *folder, const char *name, const char *mark)
{
    char *path = NULL;
    struct stat st;
    const char *dot = strrchr(name, '.');
    if (name[0] == '.') return 0;
    if (mark == scene_mark && dot && (strcmp(dot, ".json") == 0 || strcmp(dot, ".py") == 0)) return 1;
    int length = asprintf(&path, "%s/%s/%s", folder, name, mark);
    int found = length > 0 && stat(path, &st) == 0;
    if (length > 0) free(path);
    return found;
}

static int by_name(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

static char **list_marked(const char *folder, const char *mark, size_t *count)
{
    char **names = NULL;
    *count = 0;
    DIR *dir = opendir(folder);
    for (struct dirent *entry; dir && (entry = readdir(dir));) {
        if (!is_marked(folder, entry->d_name, mark)) continue;
        char **more = realloc(names, (*count + 1)*sizeof *more);
        if (!more || !(more[*count] = strdup(entry->d_name))) exit(complain("out of memory"));
        names = more;
        ++*count;
    }
    if (dir) closedir(dir);
    if (names) qsort(names, *count, sizeof *names, by_name);
    return names;
}

char **list_scenes(const char *folder, size_t *count) { return list_marked(folder, scene_mark, count); }

void free_names(char **names, size_t count)
{
    for (size_t k = 0; k < count; k++) free(names[k]);
    free(names);
}

char *relative_path(const char *path)
{
    char *here = getcwd(NULL, 0);
    size_t length = here ? strlen(here) : 0;
    int below = length > 1 && strncmp(path, here, length) == 0 && path[length] == '/';
    free(here);
    return strdup(below ? path + length + 1 : path);
}

static char *find_in(const char *folder, const char *shown, const char *name, const char *mark)
{
    size_t count;
    char **names = list_marked(folder, mark, &count), *found = NULL;
    const char *near = NULL;
    for (size_t k = 0; k < count; k++)
        if (strcmp(names[k], name) == 0) near = names[k];
    if (!near) near = tobi_suggest(name, (const char *const *)names, count);
    if (near && asprintf(&found, "%s%s%s", shown, *shown ? "/" : "", near) < 0) found = NULL;
    free_names(names, count);
    return found;
}

static char *find_beside(const char *path, const char *mark)
{
    char *copy = strdup(path);
    if (!copy) return NULL;
    for (size_t n = strlen(copy); n > 1 && copy[n - 1] == '/'; n--) copy[n - 1] = '\0';
    char *slash = strrchr(copy, '/');
    const char *name = slash ? slash + 1 : copy;
    if (slash) *slash = '\0';
    char *found = slash ? find_in(*copy ? copy : "/", copy, name, mark) : find_in(".", "", name, mark);
    free(copy);
    return found;
}

char *near_run(const char *path)
{
    char *found = find_beside(path, run_mark);
    const size_t n = found ? strlen(found) : 0;
    if (!found || strncmp(found, path, n) != 0 || path[n + strspn(path + n, "/")]) return found;
    free(found);                /* the path itself: a run, of which something else is missing */
    return NULL;
}

char *near_scene(const char *path)
{
    char *found = find_beside(path, scene_mark);
    char *shipped = found ? NULL : tobi_scene_shipped("."), *shown = shipped ? relative_path(shipped) : NULL;
    const char *slash = strrchr(path, '/');
    if (shown) found = find_in(shipped, shown, slash && slash[1] ? slash + 1 : path, scene_mark);
    free(shown);
    free(shipped);
    return found;
}

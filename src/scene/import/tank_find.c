/* Where the mesh lies that a path of another machine names: its last folders and its name are tried in each
   place, the longest ending first. Drawback: folders below these places are not searched. */
#define _GNU_SOURCE 1
#include "scene/import/tank.h"
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PLACES = 32 };
typedef struct places { char *folder[PLACES]; int count; } places;

static void add_place(places *p, const char *folder)
{
    char *whole = p->count < PLACES ? realpath(folder, NULL) : NULL;
    for (int k = 0; whole && k < p->count; k++)
        if (strcmp(p->folder[k], whole) == 0) {
            free(whole);
            whole = NULL;
        }
    if (whole) p->folder[p->count++] = whole;
}

static void list_places(places *p, const char *directory)
{
    char above[PATH_MAX], *slash;
    add_place(p, directory);
    add_place(p, ".");
    snprintf(above, sizeof above, "%s", directory);
    while ((slash = strrchr(above, '/')) && slash > above) {
        *slash = '\0';
        add_place(p, above);
    }
}

/* folder/path, absolute, if there is such a file. */
static char *look_in(const char *folder, const char *path)
{
    char *joined = NULL, *found = NULL;
    if (asprintf(&joined, "%s/%s", folder, path) < 0) return NULL;
    if (access(joined, F_OK) == 0) found = realpath(joined, NULL);
    free(joined);
    return found;
}

static char *write_places(const places *p)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    for (int k = 0; k < p->count; k++) fprintf(out, "%s%s", k ? ", " : "", p->folder[k]);
    return fclose(out) == 0 ? text : NULL;
}

/* The next shorter ending of a path, NULL behind its last; "." and ".." begin none. */
static const char *shorten(const char *ending)
{
    do {
        ending = strchr(ending, '/');
        if (ending) ending++;
    } while (ending && (*ending == '/' || strncmp(ending, "./", 2) == 0 || strncmp(ending, "../", 3) == 0));
    return ending && *ending ? ending : NULL;
}

char *tobi_tank_slashes(const char *path)
{
    char *plain = strdup(path);
    for (char *c = plain; c && *c; c++)
        if (*c == '\\') *c = '/';
    return plain;
}

char *tobi_tank_find(const char *directory, const char *given, char **list)
{
    places p = { .count = 0 };
    *list = NULL;
    char *path = tobi_tank_slashes(given);
    if (!path) return NULL;
    char *found = path[0] == '/' && access(path, F_OK) == 0 ? realpath(path, NULL) : NULL;
    list_places(&p, directory);
    for (const char *ending = path; ending && !found; ending = shorten(ending))
        for (int k = 0; k < p.count && !found && ending[0] != '/'; k++) found = look_in(p.folder[k], ending);
    if (!found) *list = write_places(&p);
    for (int k = 0; k < p.count; k++) free(p.folder[k]);
    free(path);
    return found;
}

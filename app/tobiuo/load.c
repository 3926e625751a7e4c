/* From the path on the command line to a scene. */
#define _GNU_SOURCE
#include "app.h"
#include <stdlib.h>
#include <sys/stat.h>

char *scene_path(const char *path)
{
    struct stat st;
    char *file = NULL;
    int directory = stat(path, &st) == 0 && S_ISDIR(st.st_mode);
    if (asprintf(&file, "%s%s", path, directory ? "/scene.json" : "") < 0)
        exit(complain("out of memory"));
    return file;
}

tobi_scene *load_scene(const char *path, overrides *set)
{
    tobi_scene *scene = NULL;
    tobi_report *report = NULL;
    tobi_error err = { 0 };
    char *file = scene_path(path);
    if (tobi_scene_load(file, (const char *const *)set->text, &scene, &report, &err) != TOBI_OK)
        complain_scene(report, &err);
    overrides_free(set);
    free(file);
    return scene;
}

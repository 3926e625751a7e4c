/* From the path on the command line to a scene. */
#define _GNU_SOURCE
#include "app.h"
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char *join(const char *path, const char *file)
{
    char *joined = NULL;
    if (asprintf(&joined, "%s%s", path, file) < 0) exit(complain("out of memory"));
    return joined;
}

char *scene_path(const char *path)
{
    struct stat st;
    if (stat(path, &st) != 0 || !S_ISDIR(st.st_mode)) return join(path, "");
    char *file = join(path, "/scene.json"), *setting = join(path, "/setting.json");
    const int old = access(file, F_OK) != 0 && access(setting, F_OK) == 0;
    free(old ? file : setting);
    return old ? setting : file;
}

char *import_path(const char *path)
{
    struct stat st;
    char *setting = join(path, "/setting.json");
    if (stat(path, &st) == 0 && S_ISDIR(st.st_mode) && access(setting, F_OK) == 0) return setting;
    free(setting);
    return scene_path(path);
}

/* A path that leads nowhere, with the scene that it may mean. Returns 0 if it leads somewhere. */
static int complain_nowhere(const char *path, const char *file)
{
    struct stat st;
    if (stat(file, &st) == 0) return 0;
    char *resolved = join(path, "/resolved.json");
    const int results = access(resolved, F_OK) == 0;
    char quoted[SHELL_WORD];
    if (results)
        complain("%s: holds the results of a run, and no scene.json; \"tobiuo resume %s\" goes on with that "
                 "run, and its scene is %s", path, shell_word(path, quoted), resolved);
    free(resolved);
    if (results) return 1;
    char *near = stat(path, &st) == 0 ? NULL : near_scene(path);
    if (near) complain("%s: there is no such scene; did you mean %s?", path, near);
    const int told = near != NULL;
    free(near);
    return told;
}

tobi_scene *load_scene(const char *path, overrides *set)
{
    tobi_scene *scene = NULL;
    tobi_report *report = NULL;
    tobi_error err = { 0 };
    char *file = scene_path(path);
    if (complain_nowhere(path, file)) scene = NULL;
    else if (tobi_scene_load(file, (const char *const *)set->text, &scene, &report, &err) != TOBI_OK)
        complain_scene(report, &err);
    overrides_free(set);
    free(file);
    return scene;
}

void say_changed_files(const tobi_scene *scene, const char *dir, const char *what)
{
    const char *path;
    for (int k = 0; (path = tobi_scene_file(scene, k)); k++) {
        int told = 0;
        for (int n = 0; n < k; n++) told |= strcmp(tobi_scene_file(scene, n), path) == 0;
        if (!told && tobi_scene_file_changed(scene, dir, k))
            complain("%s has changed since the run read it; %s goes on with it as it is now", path, what);
    }
}

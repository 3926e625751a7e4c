/* What pictures of finished runs need of their scene: its world is made, and let go before its first step.
   Drawback: meshes are read again. */
#define _GNU_SOURCE
#include "app.h"
#include "tobiuo/drawing.h"
#include <stdlib.h>
#include <unistd.h>

int find_looks(tobi_scene *scene, tobi_looks *looks)
{
    tobi_world *world = NULL;
    tobi_error err = { 0 };
    tobi_status status = tobi_scene_build(scene, &world, &err);
    if (status == TOBI_OK) status = tobi_world_looks(world, looks, &err);
    tobi_world_destroy(world);
    return status == TOBI_OK ? 0 : complain("%s", err.text);
}

int load_looks(const char *dir, const overrides *set, tobi_scene **scene, tobi_looks *looks)
{
    tobi_report *mistakes = NULL;
    tobi_error err = { 0 };
    char *path = NULL;
    if (asprintf(&path, "%s/resolved.json", dir) < 0) return complain("out of memory");
    if (access(path, F_OK) != 0) {
        free(path);
        return complain_run(dir, tr("there are no results of a run (no resolved.json)"));
    }
    const tobi_status status = tobi_scene_load(path, (const char *const *)set->text, scene, &mistakes, &err);
    free(path);
    if (status != TOBI_OK) return complain_scene(mistakes, &err);
    tobi_report_free(mistakes);
    say_changed_files(*scene, dir, tr("the drawing"));
    return find_looks(*scene, looks);
}

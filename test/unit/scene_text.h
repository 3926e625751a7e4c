/* A world that has started, from the text of a scene. */
#pragma once
#include "base/error.h"
#include "scene/scene.h"
#include "world/world.h"
#include <string.h>

/* *w is NULL, or what was built until the failure. */
static inline tobi_status start_scene(const char *text, tobi_world **w, tobi_error *err)
{
    tobi_scene *scene;
    *w = NULL;
    TOBI_TRY(tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, err));
    tobi_status status = tobi_scene_build(scene, w, err);
    if (status == TOBI_OK) status = tobi_world_start(*w, err);
    tobi_scene_free(scene);
    return status;
}

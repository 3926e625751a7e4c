/* What tests of nests share: a scene with its world, nests and run; a square body; a 2-D world of water. */
#pragma once
#include "calls.h"
#include "tobiuo/run.h"
#include "tobiuo/scene.h"
#include <string.h>

typedef struct nest_rig { tobi_scene *scene; tobi_world *world; tobi_nests *nests; tobi_run *run; } nest_rig;

/* Without nests yet. */
static inline tobi_status nest_rig_build(const char *text, nest_rig *a, tobi_error *err)
{
    *a = (nest_rig){ 0 };
    TOBI_TRY(tobi_scene_parse("scene.json", text, strlen(text), NULL, &a->scene, NULL, err));
    return tobi_scene_build(a->scene, &a->world, err);
}

static inline void nest_rig_drop(nest_rig *a)
{
    tobi_run_free(a->run);
    tobi_nests_free(a->nests);
    tobi_world_destroy(a->world);
    tobi_scene_free(a->scene);
}

/* Inlets and outlets in scenes. */
#pragma once
#include "scene/scene.h"

/* Into scene->inlets and outlets; mistakes go to the report of the binder. TOBI_NO_MEMORY. */
tobi_status tobi_openings_read(tobi_scene *scene, const tobi_binder *binder, const tobi_place *root);
/* Into a resolved scene; 1 without memory. */
int tobi_openings_write(const tobi_scene *scene, json_t *root);
void tobi_openings_clear(tobi_scene *scene);

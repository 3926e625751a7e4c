/* What is written about scenes, made from the tables that read them. Texts are owned by the caller;
   NULL when out of memory. */
#pragma once
#include "base/param.h"

/* "number", "vector", ...: what a user may write for a row. */
const char *tobi_manual_type(const tobi_param *row);

/* docs/scene.md. */
char *tobi_scene_manual(void);
/* docs/scene.schema.json: JSON Schema, draft-07. Comments must be taken out of a scene before a
   validator sees it; rules between several values are not in it. */
char *tobi_scene_schema(void);

/* The `control` of a body in a scene: a Lua file that answers a force and a torque. */
#pragma once
#include "rigid/script.h"
#include "scene/bind.h"

typedef struct tobi_control_def {
    const char *script;
    json_t *params;                /* borrowed from the scene, or NULL  */
} tobi_control_def;

extern const tobi_param_table tobi_control_table;

/* Reads the value of a body's `control`, reports its mistakes and loads the script: NULL with a line in
   the report when that fails. */
tobi_script *tobi_control_bind(const tobi_binder *binder, json_t *value, const tobi_place *place,
                               tobi_control_def *def);
/* As JSON, NULL when out of memory. */
json_t *tobi_control_write(const tobi_control_def *def);

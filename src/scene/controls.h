/* The programs of a scene that are not motions, Lua files: the `control` of a body, which answers a force
   and a torque, and the `flow` of a region, which answers a velocity. */
#pragma once
#include "tobiuo/motion.h"
#include "scene/bind.h"

typedef struct tobi_control_def {
    const char *script;
    json_t *params;                /* borrowed from the scene, or NULL  */
} tobi_control_def;

extern const tobi_param_table tobi_control_table, tobi_flow_table;

/* Reads the value of a `control` or `flow`, reports its mistakes and loads the script: NULL with a line in
   the report when that fails. */
tobi_script *tobi_control_bind(const tobi_binder *binder, tobi_script_role role, json_t *value,
                               const tobi_place *place, tobi_control_def *def);
/* As JSON, NULL when out of memory. */
json_t *tobi_control_write(tobi_script_role role, const tobi_control_def *def);

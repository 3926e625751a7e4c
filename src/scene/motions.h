/* The `motion` of a body in a scene: a script, keyframes, or translation, rotation, oscillation by
   numbers. */
#pragma once
#include "tobiuo/motion.h"
#include "scene/bind.h"

typedef struct tobi_translation_def { double velocity[3]; } tobi_translation_def;

typedef struct tobi_rotation_def { double center[3], axis[3], rate; } tobi_rotation_def;

typedef struct tobi_oscillation_def {
    double direction[3], amplitude, frequency, phase;
} tobi_oscillation_def;

typedef struct tobi_script_def { const char *script; } tobi_script_def;

typedef struct tobi_keyframes_def { const char *file; double pivot[3]; } tobi_keyframes_def;

/* One motion as the scene gives it. */
typedef struct tobi_motion_def {
    const tobi_param_table *table;     /* which of them; NULL = no motion                */
    union {
        tobi_script_def script;
        tobi_translation_def translation;
        tobi_rotation_def rotation;
        tobi_oscillation_def oscillation;
        tobi_keyframes_def keyframes;
    } as;
    json_t *params;                    /* of a script; borrowed from the scene, or NULL  */
} tobi_motion_def;

/* The tables by index, NULL past the end; the first is the script's. */
const tobi_param_table *tobi_motion_table(int index);

/* Reads the value of a body's `motion`, reports its mistakes and creates the motion: NULL with a
   line in the report when that fails. */
tobi_motion *tobi_motion_bind(const tobi_binder *binder, json_t *value, const tobi_place *place,
                              tobi_motion_def *def);
/* As JSON, NULL when out of memory or if there is no motion. */
json_t *tobi_motion_write(const tobi_motion_def *def);

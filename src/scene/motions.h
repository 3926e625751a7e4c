/* The `motion` of a body in a scene: a script, keyframes, motions by numbers, or a list of them. */
#pragma once
#include "tobiuo/motion.h"
#include "scene/bind.h"

/* When it is under way, see tobi_motion_set_times; stop 0 = never. */
typedef struct tobi_times_def { double start, stop, ramp; } tobi_times_def;

typedef struct tobi_translation_def { double velocity[3]; tobi_times_def times; } tobi_translation_def;

typedef struct tobi_rotation_def { double center[3], axis[3], rate; tobi_times_def times; } tobi_rotation_def;

typedef struct tobi_oscillation_def {
    double direction[3], amplitude, frequency, phase;
    tobi_times_def times;
} tobi_oscillation_def;

/* Of one of the six degrees of freedom of a ship. */
typedef struct tobi_degree_def {
    double center[3], amplitude, period, phase;
    tobi_times_def times;
} tobi_degree_def;

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
        tobi_degree_def degree;
        tobi_keyframes_def keyframes;
        tobi_wave_maker_def waves;
    } as;
    int dimension;                     /* of the scene                                   */
    double gravity;                    /* m/s2, its size in the scene                    */
    json_t *params;                    /* of a script; borrowed from the scene, or NULL  */
} tobi_motion_def;

/* The tables by index, NULL past the end; the first is the script's. */
const tobi_param_table *tobi_motion_table(int index);

/* So many motions of one body. */
enum { TOBI_MOTION_LIMIT = 16 };

/* Reads the value of a body's `motion`, reports its mistakes and creates the motion: NULL with a
   line in the report when that fails. def: TOBI_MOTION_LIMIT of them; those behind the last have no table. */
tobi_motion *tobi_motion_bind(const tobi_binder *binder, json_t *value, const tobi_place *place,
                              tobi_motion_def *def);
/* Whether one of them is a piston that absorbs waves. */
int tobi_motion_absorbs(const tobi_motion_def *def);
/* As JSON, NULL when out of memory or if there is no motion. */
json_t *tobi_motion_write(const tobi_motion_def *def);

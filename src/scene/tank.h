/* What a scene says about its tank as a whole. */
#pragma once
#include "scene/motions.h"
#include "tobiuo/tobiuo.h"

enum { TOBI_ZONES = 16 };

typedef struct tobi_scene_tank {
    tobi_gravity_def gravity;
    int changes;                   /* 1: gravity does                             */
    tobi_central_def central;      /* rate 0: there is none                       */
    tobi_motion_def frame_def[TOBI_MOTION_LIMIT];
    tobi_damping_def damping[TOBI_ZONES];
    int damping_count;
    tobi_porous_def porous[TOBI_POROUS_LIMIT];
    int porous_count;
    tobi_nest_def nests[TOBI_NEST_LIMIT];
    int nest_count;
    tobi_scalar_def scalars[TOBI_SCALAR_LIMIT];
    int scalar_count;
    tobi_scalar_value_def values[TOBI_SCALAR_VALUE_LIMIT];
    int value_count;
    tobi_motion *frame;            /* owned; NULL = at rest                       */
} tobi_scene_tank;

/* Reads it from the scene's object; mistakes are reported. */
void tobi_tank_bind(tobi_scene_tank *t, const tobi_binder *binder, json_t *scene, const tobi_place *root);
/* The calls that a program would make. */
tobi_status tobi_tank_build(const tobi_scene_tank *t, tobi_world *world, tobi_error *err);
/* Into the object of resolved.json; nonzero without memory. */
int tobi_tank_write(const tobi_scene_tank *t, json_t *root);
void tobi_tank_free(tobi_scene_tank *t);

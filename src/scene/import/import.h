/* Scenes of the Taichi program (SPH_Taichi and what was made from it): JSON with a `Configuration`,
   FluidBlocks, RigidBlocks and RigidBodies. They are translated into the native scene's JSON and then take
   the way of every scene, so that nothing below knows of them. The meaning of each old key was read in that
   program: https://github.com/erizmr/SPH_Taichi. */
#pragma once
#include "scene/bind.h"

/* One key of an old scene: how it is read, and what it becomes. */
typedef struct tobi_old_key {
    tobi_param param;         /* doc is the remark; unit NULL: a list that is not read by the table        */
    const char *becomes;      /* native key: "a.b" of the scene, ".a" of the native entry, "^a" of its fluid;
                                 NULL = nothing                                                            */
    const char *unit;         /* of the native key; NULL = that of the old one                             */
    const char *absent;       /* what is said if the key is missing; NULL = nothing                        */
} tobi_old_key;

typedef struct tobi_old_section {
    const char *name;         /* as in the file         */
    const tobi_old_key *keys; /* ended by a NULL key    */
    size_t size;              /* of the struct below    */
} tobi_old_section;

/* import.c: the one table of what the old keys mean. */
extern const tobi_old_section tobi_old_configuration, tobi_old_fluid_block, tobi_old_rigid_block,
    tobi_old_rigid_body;

typedef struct tobi_old_config {
    double domain_start[3], domain_end[3], radius, radius_rigid, density, gravitation[3];
    double time_step, stiffness, exponent, time, viscosity, tension;
    double camera_position[3], camera_look_at[3], camera_angle;
    int steps, method, boundary, frames, ply, obj, end_frame;
} tobi_old_config;

typedef struct tobi_old_block {
    double start[3], end[3], translation[3], scale[3], velocity[3], density, color[3];
    int object, dynamic;
} tobi_old_block;

typedef struct tobi_old_body {
    const char *file;
    double translation[3], axis[3], angle, scale[3], velocity[3], density, color[3];
    double length, width, lead, wingspan, wingchord, wave_length, freq, amplitude, relax, start[3], swim[3],
        pitch;
    int object, dynamic;
} tobi_old_body;

/* What became of one key. */
typedef struct tobi_old_row {
    char *from, *value, *path;
    char *paths;              /* several native values, told instead of that at `path`; NULL = one or none */
    const char *unit;
    char *remark;
} tobi_old_row;

/* A translation in work. */
typedef struct tobi_import {
    tobi_source *source;      /* borrowed; its root becomes the native scene at the end  */
    tobi_binder binder;
    json_t *native;
    tobi_old_config config;
    uint64_t given;           /* keys of Configuration: bits of its table                */
    tobi_old_row *rows;
    int row_count, row_room;
    json_t *stand_ins;        /* body name: mesh file that was named but is not there    */
    const char *closing;      /* lines below the table                                   */
    int no_memory;
} tobi_import;

/* Whether the root of a scene is one of these. */
int tobi_import_applies(const json_t *root);
/* Replaces the source's root by the native scene, so that mistakes found later name the old keys. *table:
   what became of each key, for people. *stand_ins: for bodies that got TOBI_STAND_IN, name: the mesh that the
   scene names. Both owned by the caller. TOBI_INVALID with the mistakes in the report. */
tobi_status tobi_import_translate(tobi_source *source, tobi_texts *texts, const char *directory,
                                  char **table, json_t **stand_ins);
/* The shipped mesh of a fish whose own is not there. */
#define TOBI_STAND_IN "flying_fish/meshes/fish.obj"

/* cut.c: the same for the parameter file of the program that cuts an apple (parameters.py). */
tobi_status tobi_import_translate_cut(tobi_source *source, tobi_texts *texts, const char *directory,
                                      char **table);

/* tank.c: the same for a setting.json of the tank program and the object files that it names. *object_files:
   their paths, owned by the caller. */
int tobi_import_tank_applies(const json_t *root);
tobi_status tobi_import_translate_tank(tobi_source *source, tobi_texts *texts, const char *directory,
                                       char **table, json_t **object_files);

/* Puts value, which it takes over, into an object of the native scene and returns it; NULL without memory,
   which is remembered. A NULL object is fine. */
json_t *tobi_import_set(tobi_import *im, json_t *object, const char *key, json_t *value);
json_t *tobi_import_real(double v);
json_t *tobi_import_vector(const double v[3]);

/* Reads an object by its section into def (section->size bytes); returns the keys given. */
uint64_t tobi_import_read(tobi_import *im, const tobi_old_section *section, json_t *object,
                          const tobi_place *place, void *def);
/* The object with the keys that the section has alone; lists: 1 = those too that its table does not read. A
   new reference; what is no object comes as it is, NULL as an object without keys. */
json_t *tobi_import_take_known(tobi_import *im, const tobi_old_section *section, json_t *object, int lists);
/* Whether a key of a section is among `given`. */
int tobi_import_has(const tobi_old_section *section, uint64_t given, const char *key);
/* Adds a row of the table for each key given and each that is told when absent. entry and fluid: the native
   paths that ".a" and "^a" start from. */
void tobi_import_note(tobi_import *im, const tobi_old_section *section, json_t *object,
                      const tobi_place *place, const char *entry, const char *fluid);
/* Keys that an old program passes over: the remark on one of them, NULL if none is known, and that on all
   others. */
typedef struct tobi_old_others {
    const char *(*remark)(const char *key);      /* NULL: no key is known */
    const char *unknown;
} tobi_old_others;
/* Adds a row for each key that the section does not have. A slip of the pen is a mistake instead. place: of
   the object in its file; shown: in the table. */
void tobi_import_note_others(tobi_import *im, const tobi_old_section *section, json_t *object,
                             const tobi_place *place, const tobi_place *shown, const tobi_old_others *others);
/* The two for objects of the Taichi program, as tobi_import_read and tobi_import_note. */
uint64_t tobi_import_read_taichi(tobi_import *im, const tobi_old_section *section, json_t *object,
                                 const tobi_place *place, void *def);
void tobi_import_note_taichi(tobi_import *im, const tobi_old_section *section, json_t *object,
                             const tobi_place *place, const char *entry, const char *fluid);
/* Adds one row: what became of `value` at the key; native: its path in the scene, NULL = nothing. */
void tobi_import_note_key(tobi_import *im, const tobi_old_key *key, json_t *value, const tobi_place *place,
                          const char *native);
/* Replaces what the newest row about `key` became: "bodies[0].visible = false, ..."; takes `paths` over. */
void tobi_import_tell(tobi_import *im, const char *key, char *paths);
/* Replaces the remark of the newest row about `key`. */
void tobi_import_remark(tobi_import *im, const char *key, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* table.c: tells later mistakes by their old keys, makes the native scene the source's root and writes
   the table. */
tobi_status tobi_import_finish(tobi_import *im, char **table);
void tobi_import_clear(tobi_import *im);

/* objects.c */
void tobi_import_fluids(tobi_import *im);
void tobi_import_bodies(tobi_import *im);
/* The absolute path of a mesh that an old scene names; NULL if it is nowhere (or memory was short, which
   is remembered). Owned by the caller. */
char *tobi_import_find_mesh(tobi_import *im, const char *path);
/* Names an entry by the stem, or stem_2, stem_3 where another of the two lists has it; what is no letter or
   digit becomes '_'. */
void tobi_import_name(tobi_import *im, const json_t *list, const json_t *other, json_t *entry,
                      const char *stem, size_t length);
/* Whether an object is in the list invisibleObjects. */
int tobi_import_hides(const tobi_import *im, int object);

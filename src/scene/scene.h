/* Inside of a tobi_scene: the definitions that its file makes, and what they borrow from. */
#pragma once
#include "scene/controls.h"
#include "scene/motions.h"
#include "scene/source.h"
#include "scene/tank.h"
#include "tobiuo/scene.h"

typedef struct tobi_scene_fill {
    tobi_fill_def def;
    tobi_bound bound;              /* rows of the fill table that the file gives  */
    tobi_control_def flow_def;
    tobi_script *flow;             /* owned; NULL = none                          */
} tobi_scene_fill;

typedef struct tobi_scene_fluid {
    tobi_fluid_def def;
    tobi_bound bound;              /* rows of the fluid table that the file gives */
    tobi_scene_fill *fills;
    int fill_count;
} tobi_scene_fluid;

typedef struct tobi_scene_solid {
    tobi_solid_def def;
    tobi_bound bound;              /* rows of the solid table that the file gives */
    tobi_scene_fill *fills;
    int fill_count;
} tobi_scene_solid;

typedef struct tobi_scene_body {
    tobi_body_def def;
    tobi_bound bound;              /* rows of the body table that the file gives  */
    tobi_motion_def motion_def[TOBI_MOTION_LIMIT];
    tobi_motion *motion;           /* owned; NULL = fixed                         */
    tobi_control_def control_def;
    tobi_script *control;          /* owned; NULL = not controlled                */
} tobi_scene_body;

struct tobi_scene {
    char *name;
    char *directory;               /* absolute                                    */
    tobi_source source;            /* for the places of what the world refuses    */
    json_t *root;                  /* owner of names                              */
    tobi_texts texts;              /* owner of paths and lists                    */
    tobi_world_def world;
    tobi_bound world_bound;
    const tobi_param_table *method;
    void *method_def;              /* method->size bytes                          */
    tobi_bound method_bound;
    tobi_mlsmpm_def solids_def;    /* of solids beside fluids                     */
    tobi_scene_fluid *fluids;
    int fluid_count;
    tobi_scene_solid *solids;
    int solid_count;
    tobi_scene_tank tank;
    tobi_scene_body *bodies;
    int body_count;
    tobi_plane_def *planes;
    tobi_bound *planes_bound;      /* which of their keys were good               */
    int plane_count;
    tobi_inlet_def *inlets;
    int inlet_count;
    tobi_outlet_def *outlets;
    int outlet_count;
    tobi_interface_def *interfaces;
    int interface_count;
    tobi_line_def *lines;
    int line_count;
    tobi_joint_def *joints;
    int joint_count;
    tobi_probe_def *probes;
    tobi_bound *probes_bound;
    int probe_count;
    tobi_output_def output;
    tobi_view_def *views;          /* of output, which points to them             */
    char *import_table;            /* what old keys became; NULL: it was native   */
    const char *import_program;    /* whose scene it was                          */
    json_t *stand_ins;             /* of a translated scene, see import.h         */
    json_t *object_files;          /* the same                                    */
    tobi_reference_def *references;
    int reference_count;
};

/* The absolute directory of a file that may not exist; owned by the caller. */
char *tobi_scene_find_directory(const char *path);
/* tobi_scene_load of a scene of another program; TOBI_INVALID if it is none. */
tobi_status tobi_scene_load_foreign(const char *path, tobi_scene **scene, tobi_report **report,
                                    tobi_error *err);

/* scene.c: whether solids stand beside fluids, which have another method. */
#define TOBI_METHOD_OF_SOLIDS "mlsmpm"
int tobi_scene_has_both(const tobi_scene *scene);
/* scene.c: the body of this name, NULL: there is none. */
const tobi_body_def *tobi_scene_find_body(const tobi_scene *scene, const char *name);
/* scene.c: the list of objects at the key of `place`, a part of `owner`. NULL if there is none; mistakes are
   reported. */
json_t *tobi_scene_list(const tobi_binder *binder, json_t *object, const tobi_place *place,
                        const char *owner);

/* scene.c: what a call answers that adds entry i of a list to the world; a refusal gets its place in the
   file. */
tobi_status tobi_scene_place_entry(tobi_scene *scene, const char *list, int i, tobi_status status,
                                   tobi_error *err);
/* nests.c: their names. */
void tobi_nests_check(const tobi_scene *scene, tobi_source *source);

/* lines.c: the key lines of the scene, which is `of`. */
tobi_status tobi_lines_bind(tobi_scene *scene, const tobi_binder *binder, const tobi_place *of);
void tobi_lines_check(const tobi_scene *scene, tobi_source *source);
/* The bodies that hold solids. clamps.c */
void tobi_clamps_check(const tobi_scene *scene, tobi_source *source);
json_t *tobi_lines_write_json(const tobi_scene *scene);      /* NULL: no memory */
/* joint_list.c: the same of the key joints. */
tobi_status tobi_joint_list_bind(tobi_scene *scene, const tobi_binder *binder, const tobi_place *of);
void tobi_joint_list_check(const tobi_scene *scene, tobi_source *source);
json_t *tobi_joint_list_write_json(const tobi_scene *scene);

/* joints.c: the hinge of a 2-D body has its axis along z; what is wrong with hinge and guide of a body. */
void tobi_joints_complete(const json_t *body, int dimension, tobi_body_def *def);
void tobi_joints_check(const tobi_scene *scene, tobi_source *source, int body, const tobi_place *entry);
void tobi_joints_check_motor(tobi_source *source, const tobi_motor_def *def, int slides,
                             const tobi_place *motor);

/* interfaces.c: the key interfaces of the scene, which is `of`; tobi_interfaces_write: 1 without memory. */
tobi_status tobi_interfaces_bind(tobi_scene *scene, const tobi_binder *binder, const tobi_place *of);
void tobi_interfaces_check(const tobi_scene *scene, tobi_source *source);
int tobi_interfaces_write(const tobi_scene *scene, json_t *root);

/* output.c: the key output of the scene, which is `of`. */
tobi_status tobi_output_bind(tobi_scene *scene, const tobi_binder *binder, const tobi_place *of);
void tobi_output_check(const tobi_scene *scene, tobi_source *source);
json_t *tobi_output_write(const tobi_scene *scene);      /* NULL: no memory */

/* references.c: reports columns, bodies, probes and files that are not there. */
void tobi_references_check(const tobi_scene *scene, tobi_source *source);

/* check_regions.c: the regions of one fluid or solid; boxes and spheres that would put particles on top of
   each other. */
void tobi_check_fills(const tobi_scene *scene, tobi_source *source, const tobi_place *owner,
                      const tobi_scene_fill *fills, int count);
void tobi_check_overlaps(const tobi_scene *scene, tobi_source *source);
/* check_probes.c; what the kind of a probe does not read is taken out of what its definition has become. */
void tobi_check_probes(const tobi_scene *scene, tobi_source *source);
void tobi_probe_drop_unread(const tobi_probe_def *def, json_t *object);
/* check.c: whether both corners are right; a file that the scene names; the name of an entry of a list of the
   scene, which no entry before it may have. */
int  tobi_check_has_domain(const tobi_scene *scene);
void tobi_check_name(const tobi_scene *scene, tobi_source *source, const tobi_place *entry);
void tobi_check_file(tobi_source *source, const tobi_place *place, const char *path);
/* check.c: an outline of a body or a region, by the place of its object. */
void tobi_check_outline(tobi_source *source, const tobi_place *outline, const tobi_outline_def *def,
                        int dimension);

/* unused.c: reports keys that are given and that nothing would read; takes them out of what the definition
   of a table has become, for resolved.json. def: of the body, solid or motion, NULL for other tables. Motions
   need no scene. */
void tobi_unused_check(const tobi_scene *scene, tobi_source *source);
void tobi_unused_check_motion(tobi_source *source, const tobi_param_table *table, const tobi_place *place,
                              const void *def, tobi_bound bound);
void tobi_unused_drop(const tobi_scene *scene, const tobi_param_table *table, const void *def,
                      json_t *object);

/* Reports what no table can see: corners, pairs of walls, regions, names, files. */
void tobi_scene_check(const tobi_scene *scene, tobi_source *source);

/* What can be set, and what goes together: for readers of scenes, editors and other languages.

   Every definition struct of types.h has a parameter table, the only place that says a member's name, unit,
   default, range and sentence. The scene reader, tobi_default_*, range checks, `tobiuo describe`,
   resolved.json and the documentation read these tables. Each method brings its own.

   Conventions of the rows:
   - A key with dots is a key of a nested object in a scene: "domain.min" is domain: { min: ... }.
   - "key[0]", "key[1]" are the entries of one list in a scene; one value alone stands for all.
   - TOBI_PARAM_TEXT: unit "name", "method" (the name of one), "path" (a file, looked up beside the
     scene), "names" (a list, of particle fields) or "text" (anything in one line).
   - Numbers: text, if set, is a word that stands for 0 ("adaptive", "all"), or for a default below the range
     where 0 is a value as any other. A written 0 has to be in the range.
   - TOBI_PARAM_VEC3: text, if set, is a word for the default, which may lie out of the range
     ("automatic" for a colour).
   - TOBI_PARAM_VEC3 that must be positive (a scale) may be written as one number. */
#ifndef TOBIUO_PARAMS_H
#define TOBIUO_PARAMS_H
#include "tobiuo/types.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum tobi_param_type {
    TOBI_PARAM_REAL,      /* double                                   */
    TOBI_PARAM_INT,       /* int                                      */
    TOBI_PARAM_BOOL,      /* int, 0 or 1                              */
    TOBI_PARAM_VEC3,      /* double[3]; 2 components allowed in 2-D   */
    TOBI_PARAM_CHOICE,    /* int, index into choices                  */
    TOBI_PARAM_TEXT       /* const char *                             */
} tobi_param_type;

typedef struct tobi_param {
    const char *key;             /* as written in a scene, e.g. "spacing"                         */
    tobi_param_type type;
    size_t offset;               /* of the member in its definition struct                       */
    double def[3];               /* default (first element for scalars; index for choices)       */
    double min, max;             /* allowed range per component, inclusive; NaN of texts         */
    int positive;                /* 1: a scene may not write 0                                   */
    int required;                /* 1: a scene must give it                                       */
    const char *unit;            /* "m", "Pa s", "1"                                              */
    const char *choices;         /* "slip|no-slip|periodic", NULL unless TOBI_PARAM_CHOICE        */
    const char *text;            /* default of TOBI_PARAM_TEXT; of others a word, see above       */
    const char *doc;             /* one sentence                                                  */
} tobi_param;

/* A named table, ended by a row with key NULL. */
typedef struct tobi_param_table {
    const char *name;            /* "world", "fluid", "dfsph", ...                                */
    const char *doc;
    size_t size;                 /* of the definition struct                                      */
    const tobi_param *rows;
} tobi_param_table;

TOBI_API extern const tobi_param_table tobi_world_table;
TOBI_API extern const tobi_param_table tobi_fluid_table;
TOBI_API extern const tobi_param_table tobi_interface_table;
TOBI_API extern const tobi_param_table tobi_solid_table;
TOBI_API extern const tobi_param_table tobi_fill_table;
TOBI_API extern const tobi_param_table tobi_body_table;
TOBI_API extern const tobi_param_table tobi_plane_table;
TOBI_API extern const tobi_param_table tobi_inlet_table;
TOBI_API extern const tobi_param_table tobi_outlet_table;
TOBI_API extern const tobi_param_table tobi_probe_table;
TOBI_API extern const tobi_param_table tobi_line_table;
TOBI_API extern const tobi_param_table tobi_joint_table;
TOBI_API extern const tobi_param_table tobi_output_table;
TOBI_API extern const tobi_param_table tobi_view_table;
TOBI_API extern const tobi_param_table tobi_reference_table;
TOBI_API extern const tobi_param_table tobi_gravity_table;
TOBI_API extern const tobi_param_table tobi_central_table;
TOBI_API extern const tobi_param_table tobi_damping_table;
TOBI_API extern const tobi_param_table tobi_porous_table;
TOBI_API extern const tobi_param_table tobi_nest_table;
TOBI_API extern const tobi_param_table tobi_scalar_table;
TOBI_API extern const tobi_param_table tobi_scalar_value_table;
/* Whether gravity can follow it, its file included. */
TOBI_API tobi_status tobi_gravity_check(const tobi_gravity_def *def, tobi_error *err);

/* The same of a motor, of a guide (slides 1), a slide (2) or a hinge; of one that is none, TOBI_OK. */
TOBI_API tobi_status tobi_motor_check(const tobi_motor_def *def, int slides, tobi_error *err);
/* Whether it gives anything of a motor. */
TOBI_API int tobi_motor_is_given(const tobi_motor_def *def);

/* Every table by index, those of methods among them; NULL past the end. */
TOBI_API const tobi_param_table *tobi_param_table_at(int index);
/* The parameters of a method by its name ("dfsph"), NULL if there is no such method. */
TOBI_API const tobi_param_table *tobi_method_table(const char *method);

/* What a method computes and knows. */
typedef struct tobi_method_info {
    const char *name, *doc;
    int solids;                  /* 1: it computes solids, 0: fluids                              */
    int planes;                  /* 1: it knows planes in the domain                              */
    int grid;                    /* 1: tobi_world_grid has its nodes                              */
} tobi_method_info;
/* 1, or 0 with all of *info zero if there is no method of this name. info may be NULL. */
TOBI_API int tobi_method_describe(const char *method, tobi_method_info *info);

/* Whether a tobi_model reads a row of the solid table; the material constants that it reads, "a, b". */
TOBI_API int  tobi_solid_uses(int model, const char *key);
TOBI_API void tobi_solid_list(int model, char *text, size_t size);

/* What may not be combined, said once: tobi_world_create and the calls that add something tell the first
   breach, tobi_rules_* all of them, each at its key. */
typedef struct tobi_rules {
    /* path: the key in the object of a scene, "domain.walls.x"; why: a status, and what is wrong with its
       value. */
    void (*tell)(void *user, const char *path, const tobi_error *why);
    void *user;
    int corners;                 /* 1: the corners of the domain are numbers to rely on           */
    int numbers;                 /* 1: so are all others                                          */
} tobi_rules;

/* method_def: the parameters of world->method, NULL = not known; rules that need a method do nothing where
   there is none of that name. */
TOBI_API void tobi_rules_world(const tobi_rules *rules, const tobi_world_def *world, const void *method_def);
/* Those of solids beside fluids; `solids`: their method's parameters. */
TOBI_API void tobi_rules_beside(const tobi_rules *rules, const tobi_world_def *world,
                                const tobi_mlsmpm_def *solids);
/* Those of a solid in such a world; keys are of the solid. */
TOBI_API void tobi_rules_solid(const tobi_rules *rules, const tobi_world_def *world, const void *method_def,
                               const tobi_solid_def *solid);

/* Those of a fluid beside another one, or alone: other NULL; openings: 1 where there are inlets or outlets.
   Keys are of the fluid. */
TOBI_API void tobi_rules_fluid(const tobi_rules *rules, const tobi_world_def *world,
                               const tobi_fluid_def *fluid, const tobi_fluid_def *other, int openings);

#ifdef __cplusplus
}
#endif
#endif

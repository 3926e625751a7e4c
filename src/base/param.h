/* One table per definition struct: the single place that says a member's name, unit, default and
   range. The scene reader, default_*(), range checks, `tobiuo describe`, resolved.json and the
   documentation read these tables. */
#pragma once
#include "base/error.h"
#include <stdbool.h>

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
    bool positive;               /* 0 is not allowed, even where a word stands for it            */
    bool required;               /* a scene must give it                                          */
    const char *unit;            /* "m", "Pa s", "1"                                              */
    const char *choices;         /* "slip|no-slip|periodic", NULL unless TOBI_PARAM_CHOICE        */
    const char *text;            /* default of TOBI_PARAM_TEXT; of others a word, see params.h    */
    const char *doc;             /* one sentence                                                  */
} tobi_param;

/* A named table, ended by a row with key NULL. */
typedef struct tobi_param_table {
    const char *name;            /* "world", "fluid", "dfsph", ...                                */
    const char *doc;
    size_t size;                 /* of the definition struct                                      */
    const tobi_param *rows;
} tobi_param_table;

/* Writes every default into def (size bytes, zeroed first). */
void tobi_param_defaults(const tobi_param_table *table, void *def);
/* Checks the ranges of every row; the first violation is described in err. */
tobi_status tobi_param_check(const tobi_param_table *table, const void *def, tobi_error *err);

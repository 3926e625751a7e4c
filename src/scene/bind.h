/* Fills a definition struct from a JSON object by its parameter table. No key of a scene is
   known here: the tables know them all. */
#pragma once
#include "scene/source.h"
#include "base/param.h"

/* Texts that must outlive the JSON they were made from. */
typedef struct tobi_texts { struct tobi_text_node *first; int failed; } tobi_texts;     /* 1: no memory */
void tobi_texts_free(tobi_texts *texts);
/* Keeps a malloc'd text and returns it; NULL, the text of a malloc that failed, is remembered in failed. */
char *tobi_texts_keep(tobi_texts *texts, char *text);

typedef struct tobi_binder {
    tobi_source *source;
    tobi_texts *texts;
    const char *directory;     /* absolute, where relative paths start             */
    int dimension;             /* 2: vectors may have two components               */
    double gravity;            /* m/s2, the size of the scene's                    */
} tobi_binder;

/* What an object gives: one bit per row of the table. */
typedef unsigned __int128 tobi_rows;
typedef struct tobi_bound {
    tobi_rows given;           /* its key is there       */
    tobi_rows good;             /* and its value is right */
} tobi_bound;

/* Binds object to def, which must hold the defaults. Keys listed in also (ended by NULL) belong to
   somebody else. Reports unknown keys, wrong types, values out of range and missing keys; members
   with a mistake keep their default. Names are borrowed from the JSON. */
tobi_bound tobi_bind(const tobi_binder *binder, const tobi_param_table *table, json_t *object,
                   const tobi_place *place, const char *const *also, void *def);
/* Whether the row `key` is among rows, which is one half of a tobi_bound. */
int tobi_bind_has(const tobi_param_table *table, tobi_rows rows, const char *key);

/* The allowed values of a row in words: "2 to 4 spacings", "greater than 0 m", "slip or no-slip".
 */
void tobi_bind_limits(const tobi_param *row, char *text, size_t size);
/* The same in the language of messages. */
void tobi_bind_say_limits(const tobi_param *row, char *text, size_t size);

/* The default of a row as text: "0.4", "[0, 0, -9.81]", "slip"; "required" if it has none. */
void tobi_bind_default(const tobi_param *row, char *text, size_t size);

/* "is a text", "is a number", ... */
const char *tobi_json_kind(const json_t *value);

/* The text of a scene: JSON with comments, and where things stand in it. jansson keeps no positions,
   so a place is found again by its path, scene/spots.h. */
#pragma once
#include "scene/report.h"
#include "scene/spots.h"
#include <jansson.h>

/* A way through a JSON value, from the leaf up to the root: a linked list on the stack. */
typedef struct tobi_place {
    const struct tobi_place *up;   /* NULL: this is the root          */
    const char *key;               /* key of an object, or NULL       */
    size_t index;                  /* entry of a list if key is NULL  */
} tobi_place;

/* Longest path that has a text; longer ones are cut. */
enum { TOBI_PATH_TEXT = 256, TOBI_SOURCE_LIMIT = 16*1024*1024 };

/* Values that came from the command line and not from the file. */
typedef struct tobi_override {
    char *text;                    /* "path=value", owned             */
    json_t *steps;                 /* list of keys and indices, to the first that was not there before */
} tobi_override;

/* A part of a translated scene: mistakes found in it are told at the old key. */
typedef struct tobi_origin {
    char *native, *old;            /* paths as texts                  */
    size_t offset;                 /* of the old value in the text    */
} tobi_origin;

typedef struct tobi_source {
    char *name;                    /* path as given, for messages     */
    char *text;                    /* comments blanked, NUL at end    */
    size_t size;
    tobi_spots spots;              /* of the text                     */
    int python;                    /* it was a parameter file of Python */
    json_t *root;                  /* an object                       */
    tobi_override *overrides;      /* those that were applied         */
    int override_count;
    struct tobi_origin *origins;   /* where the parts of a translated scene come from; first: all others */
    int origin_count;
    int translated;                /* places are those of the native scene, the text is the old one      */
    tobi_report *report;           /* borrowed                        */
} tobi_source;

/* Blanks comments, parses and reports duplicate keys. The text is copied. TOBI_INVALID if it is not
   a JSON object; the reason is in the report. Clear the source in any case. */
tobi_status tobi_source_parse(tobi_source *source, const char *name, const char *text, size_t size,
                              tobi_report *report, tobi_error *err);
void tobi_source_clear(tobi_source *source);

/* Reports a mistake: "file:line:column: path: message", or "--set path=value: path: message". */
void tobi_source_mistake(tobi_source *source, const tobi_place *place, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* The same at the place of a key instead of its value: for keys that should not be there. */
void tobi_source_mistake_at_key(tobi_source *source, const tobi_place *place, const char *format,
                                ...) __attribute__((format(printf, 3, 4)));

/* Says that the native path comes from an old place; to be called before `translated` is set. */
tobi_status tobi_source_add_origin(tobi_source *source, const char *native, const tobi_place *old);

/* The place of a path such as "fluids[0].density"; its steps, the root first, stand in chain, their keys in
   text. What would be too long is left out at the end. */
enum { TOBI_PATH_STEPS = 12 };
const tobi_place *tobi_place_read(const char *path, tobi_place chain[TOBI_PATH_STEPS],
                                  char text[TOBI_PATH_TEXT]);
/* Writes "fluids[0].density" into text (at least TOBI_PATH_TEXT bytes); "" for the root. */
void tobi_place_text(const tobi_place *place, char *text);

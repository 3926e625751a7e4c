/* The parts of a scene: keys whose values are objects or lists, each with the parameter table of
   what is inside. With the tables this is the whole grammar of a scene: the reader, the page of
   documentation and the schema for editors read the same list. */
#pragma once
#include "base/param.h"

typedef enum tobi_part_form {
    TOBI_PART_OBJECT,     /* { ... } by its table                              */
    TOBI_PART_LIST,       /* [ { ... } ], every entry by the table             */
    TOBI_PART_MOTION,     /* one of the motions, see scene/motions.h           */
    TOBI_PART_FREE,       /* an object that somebody else understands          */
    TOBI_PART_EDITOR      /* a text for editors, which the reader passes over  */
} tobi_part_form;

typedef struct tobi_part {
    const char *owner;              /* name of the table whose objects have the key   */
    const char *key;
    tobi_part_form form;
    const tobi_param_table *table;  /* NULL unless OBJECT or LIST                     */
    int least, most;                /* entries of a LIST                              */
    const char *doc;                /* one sentence                                   */
} tobi_part;

/* More than there are parts of one owner. */
enum { TOBI_PARTS = 32 };

/* The parts by index, a method's parameters among them; false past the end. */
bool tobi_part_at(int index, tobi_part *part);
/* The part `key` of an owner, which must exist. */
tobi_part tobi_part_find(const char *owner, const char *key);
/* The keys of an owner's parts, ended by NULL. */
void tobi_part_keys(const char *owner, const char *keys[TOBI_PARTS]);

/* Where things stand in the text of a scene: offsets of keys and values, lines and columns of offsets. */
#pragma once
#include <stddef.h>
#include <stdint.h>

/* Of a key and its value; of entries of a list, and of the whole, both are the value's. */
typedef struct tobi_spot { size_t key, value; } tobi_spot;

typedef struct tobi_spots {
    const char *text;              /* valid JSON, borrowed                                      */
    struct tobi_spot_node *node;   /* members of objects, sorted by object and key; owned       */
    size_t count, room;
    struct tobi_spot_mark *mark;   /* line and column every so many bytes; owned                */
    int ready;                     /* the index was made, or memory was short                   */
} tobi_spots;

/* Of the whole value. */
tobi_spot tobi_spots_root(const tobi_spots *s);
/* The member of the object, or the entry of the list, whose value is at `in`; 0 if it is not there. Of equal
   keys the last counts, as it does in jansson. The first call reads the text once. */
int tobi_spots_member(tobi_spots *s, tobi_spot in, const char *key, tobi_spot *found);
int tobi_spots_entry(tobi_spots *s, tobi_spot in, size_t index, tobi_spot *found);
/* Lines and columns count from 1; a column is a character, not a byte. */
void tobi_spots_line(tobi_spots *s, size_t offset, int *line, int *column);
void tobi_spots_clear(tobi_spots *s);

/* Walking valid JSON. Every function takes an offset and returns another one. */
size_t tobi_spots_skip(const char *text, size_t at);       /* behind the value at `at`                 */
size_t tobi_spots_enter(const char *text, size_t at);      /* first key or entry, or closing bracket   */
size_t tobi_spots_go_on(const char *text, size_t at);      /* the next, after a value that ends at `at` */
size_t tobi_spots_value(const char *text, size_t at);      /* the value of the key at `at`             */
/* The key whose quote stands at `at`, with its escapes undone; owned by the caller. */
char *tobi_spots_key(const char *text, size_t at);

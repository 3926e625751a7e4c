/* JSON for people: definitions back to JSON by their tables, and JSON to text with the shortest
   numbers that read back to the same bits. */
#pragma once
#include "base/param.h"
#include <jansson.h>

/* Every row of the table as an object; a number 0 that has a word is written as the word, texts
   that are NULL are left out. NULL when out of memory, never a part. */
json_t *tobi_write_def(const tobi_param_table *table, const void *def);
/* The value of one row; NULL for a text that is NULL. */
json_t *tobi_write_member(const tobi_param *row, const void *def);
/* Text of a JSON value, owned by the caller; NULL when out of memory. */
char *tobi_write_json(const json_t *value);

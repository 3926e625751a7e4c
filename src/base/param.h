/* Using parameter tables (tobiuo/params.h): defaults, range checks, words of a choice. */
#pragma once
#include "base/error.h"
#include "tobiuo/params.h"
#include <stdbool.h>

/* Writes every default into def (size bytes, zeroed first). */
void tobi_param_defaults(const tobi_param_table *table, void *def);
/* The number that the word of a row stands for: 0, or, where 0 is a value as any other, a default below the
   range. */
double tobi_param_word(const tobi_param *p);
/* A world keeps so many of a name. */
enum { TOBI_NAME_BYTES = 63 };
/* Checks the ranges of every row, and names; the first violation is described in err. */
tobi_status tobi_param_check(const tobi_param_table *table, const void *def, tobi_error *err);

/* The number of words in "a|b|c", and word i of it (not terminated), its length in *length;
   NULL past the end. */
int tobi_choice_count(const char *choices);
const char *tobi_choice_word(const char *choices, int i, int *length);

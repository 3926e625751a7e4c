/* Help texts: what describe.c and find.c share. */
#pragma once
#include "scene/parts.h"
#include <stdio.h>

/* Every table of keys: the topics' first, then those of the motions. NULL past the end. */
const tobi_param_table *tobi_describe_table_at(int index);
/* Every topic. NULL past the end. */
const char *tobi_describe_topic(int index);
/* Prints a key with unit, range, default and sentence; and a key whose value is an object or a list. */
void tobi_describe_row(FILE *out, const tobi_param *row);
void tobi_describe_part(FILE *out, const tobi_part *part);
/* Whether a sentence has the word, whole; capitals do not count. */
int tobi_describe_says(const char *sentence, const char *word);
/* Keys, fields and columns whose path has the words, or else whose sentence has them; how many. */
int tobi_describe_find(FILE *out, const char *word);
/* Writes the tables that have such a key into text, as "the top level (domain.walls), plane (walls)"; how
   many, 0 also if there are more than three. in: the table that has no such key; if it is of a method, other
   methods go first. */
int tobi_describe_owners(const tobi_param_table *in, const char *word, char *text, size_t size);

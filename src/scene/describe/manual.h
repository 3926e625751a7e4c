/* What is written about scenes, made from the tables that read them. Texts are owned by the caller;
   NULL when out of memory. */
#pragma once
#include "base/param.h"
#include <stdio.h>

/* "number", "vector", ...: what a user may write for a row. */
const char *tobi_manual_type(const tobi_param *row);

/* docs/scene.md. */
char *tobi_scene_manual(void);
/* docs/scene.schema.json: JSON Schema, draft-07. Comments must be taken out of a scene before a
   validator sees it; rules between several values are not in it. */
char *tobi_scene_schema(void);

/* docs/tables.md. */
char *tobi_tables_manual(void);
/* The columns of the table that a topic ("history") means; how many tables. */
int tobi_tables_describe(FILE *out, const char *topic);
/* The columns of this name, or whose sentence has it; how many. */
int tobi_tables_find(FILE *out, const char *name, int in_sentences);
/* Topics of tables with their sentence; NULL past the end. */
const char *tobi_tables_topic(int index, const char **doc);

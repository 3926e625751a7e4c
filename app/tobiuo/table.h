/* A CSV table in memory: history.csv, bodies.csv, and reference data that a scene names.

   Lines that begin with # and empty lines are skipped; the next line names the columns; fields may
   be quoted as RFC 4180 says. The comma, semicolon or tab between the names parts all fields. A row
   that holds more than there are names is refused. */
#pragma once
#include <stddef.h>

typedef struct table {
    char *path;              /* for messages                                            */
    char separator;
    int columns;
    size_t rows;
    char **names;            /* one per column                                          */
    char **cells;            /* [row*columns + column]; "" where a row is too short     */
    char *text;              /* what names and cells point into                         */
    char *added;             /* what the cells of an added column point into            */
} table;

/* Reads the file. 0; or -1 after a message on stderr, and then t is empty. */
int table_read(table *t, const char *path);
void table_free(table *t);
/* A column more, a number a row; once per table. name outlives the table. */
void table_add_column(table *t, const char *name, const double *value);
/* Names without their units: "P1_pressure [Pa]" becomes "P1_pressure". */
void table_strip_units(table *t);
/* -1 if there is no such column. */
int table_column(const table *t, const char *name);
/* NaN for what is not a number. */
double table_number(const table *t, size_t row, int column);
/* "a, b, c", cut to size; for messages. */
void table_list_columns(const table *t, char *list, size_t size);

/* Tables that grow row by row: history.csv, bodies.csv.

   Each row reaches the file in one write, so that a killed run leaves whole rows (a torn last line
   is dropped when the table is opened again). The first column is always written with 17 digits,
   because resuming compares it; texts are quoted as RFC 4180 says. Numbers have a decimal point in
   every locale; what is not finite is written as nan, inf, -inf. */
#pragma once
#include "base/error.h"
#include <stdint.h>

typedef struct tobi_csv tobi_csv;

/* Whole rows as text, apart from their table: for a writer on another thread. */
typedef struct tobi_csv_rows {
    char *text;               /* owned; NULL = none yet */
    size_t length, room;
} tobi_csv_rows;

typedef struct tobi_csv_column {
    const char *name;
    const char *unit;   /* "m/s": the header says "name [m/s]"; NULL, "" or "1" = no unit */
} tobi_csv_column;

typedef enum tobi_csv_mode {
    TOBI_CSV_NEW,   /* replaces a file that is there                                           */
    TOBI_CSV_APPEND /* continues; TOBI_INVALID if its header differs. No file or no header yet: as
                       new */
} tobi_csv_mode;

/* Digits of real numbers after the first column: 9 or 17. TOBI_IO, TOBI_NO_MEMORY, TOBI_INVALID. */
tobi_status tobi_csv_open(const char *path, tobi_csv_mode mode, int digits, const tobi_csv_column *columns,
                          int column_count, tobi_csv **csv, tobi_error *err);
void tobi_csv_add_real(tobi_csv *csv, double value);
void tobi_csv_add_int(tobi_csv *csv, int64_t value);
void tobi_csv_add_text(tobi_csv *csv, const char *value);
/* Writes the row. TOBI_INVALID if it has not one value per column (the row is dropped); TOBI_IO if the disk
   refuses, and then the file ends with the row before. */
tobi_status tobi_csv_end_row(tobi_csv *csv, tobi_error *err);
/* The row goes behind `rows` instead of into the file; the failures of tobi_csv_end_row but TOBI_IO. */
tobi_status tobi_csv_take_row(tobi_csv *csv, tobi_csv_rows *rows, tobi_error *err);
/* Writes such rows, at once and all or none; TOBI_IO. Another thread may take rows meanwhile. A file that was
   deleted begins anew. */
tobi_status tobi_csv_write_rows(tobi_csv *csv, const tobi_csv_rows *rows, tobi_error *err);
/* Patient: rows that the disk refuses wait in memory (64 MB at most, what comes then is dropped) and are
   written before the next; TOBI_IO is returned all the same. */
void tobi_csv_set_patient(tobi_csv *csv, int patient);
/* Tries to write the rows that wait; TOBI_IO. */
tobi_status tobi_csv_flush(tobi_csv *csv, tobi_error *err);
/* Rows that wait or were dropped. */
int64_t tobi_csv_waiting(const tobi_csv *csv);
/* 1 if somebody has deleted, moved or replaced the file. */
int tobi_csv_is_gone(const tobi_csv *csv);
/* 1 if it was not there, or empty, when it was to be continued. */
int tobi_csv_has_lost(const tobi_csv *csv);
/* NULL is fine. */
void tobi_csv_close(tobi_csv *csv);

/* Drops the rows whose first column is greater than `time`, or not a number, and a torn last line. The file
   is replaced in one stroke; a missing file is TOBI_NOT_FOUND. */
tobi_status tobi_csv_truncate(const char *path, double time, tobi_error *err);

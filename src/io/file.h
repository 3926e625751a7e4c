/* A file that appears whole or not at all: bytes go to PATH.part, tobi_file_commit renames it.

   The first failure is remembered and later writes do nothing, so that writers read as a plain list of
   writes and ask once, at the end. There is no fsync: after a power cut the newest file may be short,
   after a killed program never. */
#pragma once
#include "base/error.h"
#include <locale.h>
#include <stdio.h>
#include <sys/types.h>

typedef struct tobi_file {
    FILE *handle;        /* NULL when not open                       */
    char *path, *part;   /* owned                                    */
    locale_t plain;      /* "C", for numbers                         */
    int   error;         /* errno of the first failure; 0 = none     */
} tobi_file;

/* Opens PATH.part for writing. On failure (TOBI_IO, TOBI_NO_MEMORY) nothing is left to close. */
tobi_status tobi_file_open(tobi_file *file, const char *path, tobi_error *err);
void  tobi_file_write(tobi_file *file, const void *data, size_t bytes);
/* As printf, with a point as decimal mark in every locale. */
void  tobi_file_print(tobi_file *file, const char *format, ...) __attribute__((format(printf, 2, 3)));
off_t tobi_file_tell(tobi_file *file);
/* Overwrites earlier bytes and returns to the end. */
void  tobi_file_patch(tobi_file *file, off_t at, const void *data, size_t bytes);
/* Closes and renames; TOBI_IO with the path and the reason if anything failed, and then no trace is
 * left. */
tobi_status tobi_file_commit(tobi_file *file, tobi_error *err);
/* Closes and removes PATH.part; does nothing if not open. */
void  tobi_file_abandon(tobi_file *file);

/* PATH.part, owned by the caller; NULL without memory. */
char *tobi_file_part_name(const char *path);

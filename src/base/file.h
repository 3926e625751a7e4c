/* A file that appears whole or not at all: bytes go to PATH.part, tobi_file_commit renames it.

   The first failure is remembered and later writes do nothing, so that writers read as a plain list of
   writes and ask once, at the end. No link is followed and nothing but a plain file is replaced: a folder of
   results may come from a stranger. Drawback: a link to a file elsewhere is refused, not written through.
   After a killed program a file is whole; after a power cut only one with tobi_file_sync is. */
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
    int   synced;        /* tobi_file_sync was called                */
} tobi_file;

/* TOBI_INVALID if there is something at path that is no plain file: a folder, a link, a device, a FIFO. */
tobi_status tobi_file_check_target(const char *path, tobi_error *err);

/* Opens PATH.part for writing. On failure (TOBI_INVALID, TOBI_IO, TOBI_NO_MEMORY) nothing is left to
   close. */
tobi_status tobi_file_open(tobi_file *file, const char *path, tobi_error *err);
void  tobi_file_write(tobi_file *file, const void *data, size_t bytes);
/* As printf, with a point as decimal mark in every locale. */
void  tobi_file_print(tobi_file *file, const char *format, ...) __attribute__((format(printf, 2, 3)));
off_t tobi_file_tell(tobi_file *file);
/* Overwrites earlier bytes and returns to the end. */
void  tobi_file_patch(tobi_file *file, off_t at, const void *data, size_t bytes);
/* What was written so far will outlast a power cut, and so will the name once the file is committed.
   Waits for the disk. */
void  tobi_file_sync(tobi_file *file);
/* Closes and renames; TOBI_IO with the path and the reason if anything failed, and then no trace is left
   (except of a file whose folder could not be synced). */
tobi_status tobi_file_commit(tobi_file *file, tobi_error *err);
/* Closes and removes PATH.part; does nothing if not open. */
void  tobi_file_abandon(tobi_file *file);

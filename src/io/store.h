/* A container of named arrays and values in one HDF5 file: checkpoints.

   The file starts with a 512-byte seal (an HDF5 user block, so h5dump and h5py read the file as it
   is): its length and CRC-32. Opening checks the seal over every byte before HDF5 sees the file, so
   that a truncated, damaged or foreign file is TOBI_DAMAGED with the reason, never a crash or a
   wrong number; arrays carry HDF5's fletcher32 sums as well. The file appears whole or not at all.
   HDF5 is not thread-safe: use stores from one thread at a time. Its own error printing is off
   during calls.

   Source of the format: HDF5 file format specification 3.0, "user block", "filter pipeline". */
#pragma once
#include "base/error.h"
#include "base/type.h"

typedef struct tobi_store tobi_store;

/* Starts a new file at PATH. Its content grows in memory; tobi_store_commit writes it, as PATH.part
   first. TOBI_IO, TOBI_NO_MEMORY. */
tobi_status tobi_store_create(const char *path, tobi_store **store, tobi_error *err);
/* Opens for reading. TOBI_NOT_FOUND if there is no such file, TOBI_IO if it cannot be read,
 * TOBI_DAMAGED. */
tobi_status tobi_store_open(const char *path, tobi_store **store, tobi_error *err);
/* Finishes a created store: the file now stands at PATH. Frees the store in any case; after a failure
   (TOBI_IO) an older file at PATH is untouched. */
tobi_status tobi_store_commit(tobi_store *store, tobi_error *err);
/* Closes a store opened for reading, or gives up a created one and removes what was written. NULL
 * is fine. */
void tobi_store_close(tobi_store *store);

/* Adds an array of n rows (0 is fine) by components, row-major. A '/' in the name makes groups. TOBI_IO. */
tobi_status tobi_store_put(tobi_store *store, const char *name, tobi_type type, int64_t n,
                           int components, const void *data, tobi_error *err);
tobi_status tobi_store_put_real(tobi_store *store, const char *name, double value, tobi_error *err);
tobi_status tobi_store_put_int(tobi_store *store, const char *name, int64_t value, tobi_error *err);
tobi_status tobi_store_put_text(tobi_store *store, const char *name, const char *value, tobi_error *err);

/* 1 if there is an array of that name. */
int tobi_store_has(tobi_store *store, const char *name);
/* Number of rows of an array; TOBI_DAMAGED if it is missing. */
tobi_status tobi_store_rows(tobi_store *store, const char *name, int64_t *n, tobi_error *err);
/* Reads an array that must have exactly this type and size; TOBI_DAMAGED with both if not, or if
 * missing. */
tobi_status tobi_store_get(tobi_store *store, const char *name, tobi_type type, int64_t n,
                           int components, void *data, tobi_error *err);
tobi_status tobi_store_get_real(tobi_store *store, const char *name, double *value, tobi_error *err);
tobi_status tobi_store_get_int(tobi_store *store, const char *name, int64_t *value, tobi_error *err);
/* *value is owned by the caller (free). */
tobi_status tobi_store_get_text(tobi_store *store, const char *name, char **value, tobi_error *err);

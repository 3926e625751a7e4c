/* Finding the line of an OBJ file that refers to a vertex that does not exist. */
#pragma once
#include <stddef.h>
#include <stdint.h>

typedef struct tobi_obj_fault {
    int64_t line;              /* counted from 1                                     */
    int64_t index, vertices;   /* what it says, and how many vertices the file has   */
} tobi_obj_fault;

/* 1 and the file's text (owned by the caller) with a 0 before each number that begins with its point (.5) and
   without a byte order mark: the importer takes these for no number or no vertex, and misses it. 0 if the
   file has none, -1 when out of memory or the file cannot be read. */
int tobi_obj_add_zeros(const char *path, char **text, size_t *size);

/* 1 and fills fault if a face of the file uses a vertex index that is 0 or out of range. */
int tobi_obj_scan(const char *path, tobi_obj_fault *fault);

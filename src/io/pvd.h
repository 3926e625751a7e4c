/* ParaView's list of files with their times (PVD). It grows by an entry at a time and is written as often as
   wanted; its text is kept, so that a long list costs no more than its bytes. */
#pragma once
#include "base/error.h"

typedef struct tobi_pvd {
    char *text;               /* the entries, owned; NULL = none yet */
    size_t length, room;
} tobi_pvd;

typedef struct tobi_pvd_entry {
    double      time;    /* s                                                            */
    const char *file;    /* relative to the PVD file                                     */
    const char *name;    /* of the part, "fluid"; NULL = none                            */
    int         part;    /* files of the same time need different parts                  */
} tobi_pvd_entry;

/* TOBI_NO_MEMORY: the list is as it was. Names are UTF-8 and may hold any character. */
tobi_status tobi_pvd_add(tobi_pvd *list, const tobi_pvd_entry *entry, tobi_error *err);
/* The file appears whole or not at all (base/file.h). */
tobi_status tobi_pvd_write(const char *path, const tobi_pvd *list, tobi_error *err);
void tobi_pvd_free(tobi_pvd *list);

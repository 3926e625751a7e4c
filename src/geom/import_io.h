/* The only file that the importer may open. */
#pragma once
#include <assimp/cfileio.h>
#include <stdio.h>

typedef struct tobi_import_io {
    struct aiFileIO io;            /* first: to be handed to aiImportFileEx          */
    struct aiFile   file;
    const char *path;              /* borrowed                                       */
    FILE *text;                    /* borrowed                                       */
} tobi_import_io;

/* path: the name that opens `text`, whatever that is; all others are not there. */
void tobi_import_io_init(tobi_import_io *io, const char *path, FILE *text);

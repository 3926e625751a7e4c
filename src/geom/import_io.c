/* A mesh file may name others: an OBJ its library of materials, which the importer opens and reads though
   nobody asks for materials here. What it names may be anything, a pipe without a writer for one, so the
   importer sees one file. Drawback: formats that lie in several files could not be read. */
#include "geom/import_io.h"
#include <string.h>

static FILE *text_of(struct aiFile *file) { return ((tobi_import_io *)(void *)file->UserData)->text; }

static size_t read_file(struct aiFile *file, char *out, size_t size, size_t count)
{
    return fread(out, size, count, text_of(file));
}

static size_t refuse_write(struct aiFile *file, const char *data, size_t size, size_t count)
{
    (void)file;
    (void)data;
    (void)size;
    (void)count;
    return 0;
}

static size_t tell(struct aiFile *file)
{
    const long at = ftell(text_of(file));
    return at > 0 ? (size_t)at : 0;
}

static size_t measure(struct aiFile *file)
{
    const long at = ftell(text_of(file));
    fseek(text_of(file), 0, SEEK_END);
    const size_t size = tell(file);
    fseek(text_of(file), at, SEEK_SET);
    return size;
}

static enum aiReturn seek(struct aiFile *file, size_t to, enum aiOrigin from)
{
    const int whence = from == aiOrigin_SET ? SEEK_SET : from == aiOrigin_CUR ? SEEK_CUR : SEEK_END;
    return fseek(text_of(file), (long)to, whence) == 0 ? aiReturn_SUCCESS : aiReturn_FAILURE;
}

static void flush(struct aiFile *file) { (void)file; }

static struct aiFile *open_file(struct aiFileIO *io, const char *name, const char *mode)
{
    tobi_import_io *mine = (tobi_import_io *)(void *)io;
    if (strcmp(name, mine->path) != 0 || mode[0] != 'r') return NULL;
    rewind(mine->text);
    return &mine->file;
}

static void close_file(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    (void)file;
}

void tobi_import_io_init(tobi_import_io *io, const char *path, FILE *text)
{
    *io = (tobi_import_io){
        .io = { open_file, close_file, (aiUserData)(void *)io },
        .file = { read_file, refuse_write, tell, measure, seek, flush, (aiUserData)(void *)io },
        .path = path, .text = text };
}

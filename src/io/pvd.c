/* Lists of files. An entry becomes text once, when it is added; a file is that text between a head and
   a tail. Drawback: some 110 bytes of memory per entry for as long as the run goes on. */
#define _GNU_SOURCE 1
#include "io/pvd.h"
#include "base/file.h"
#include "io/xml.h"
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The entry's line, owned by the caller; NULL without memory. A decimal point whatever the host's locale. */
static char *print_entry(const tobi_pvd_entry *e)
{
    char *line = NULL, *name = tobi_xml_escape(e->name ? e->name : ""), *file = tobi_xml_escape(e->file);
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0), before = plain ? uselocale(plain) : plain;
    if (plain && name && file &&
        asprintf(&line, "<DataSet timestep=\"%.17g\" group=\"\" part=\"%d\" name=\"%s\" file=\"%s\"/>\n",
                 e->time, e->part, name, file) < 0)
        line = NULL;
    if (plain) uselocale(before);
    if (plain) freelocale(plain);
    free(name);
    free(file);
    return line;
}

tobi_status tobi_pvd_add(tobi_pvd *list, const tobi_pvd_entry *entry, tobi_error *err)
{
    char *line = print_entry(entry);
    size_t bytes = line ? strlen(line) : 0;
    if (line && list->length + bytes > list->room) {
        char *text = realloc(list->text, 2*(list->length + bytes));
        if (text) {
            list->text = text;
            list->room = 2*(list->length + bytes);
        }
    }
    const int fits = line && list->length + bytes <= list->room;
    if (fits) {
        memcpy(list->text + list->length, line, bytes);
        list->length += bytes;
    }
    free(line);
    return fits ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory to list %s", entry->file);
}

tobi_status tobi_pvd_write(const char *path, const tobi_pvd *list, tobi_error *err)
{
    static const char head[] = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<VTKFile type=\"Collection\" "
                               "version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n",
                      tail[] = "</Collection>\n</VTKFile>\n";
    tobi_file file;
    TOBI_TRY(tobi_file_open(&file, path, err));
    tobi_file_write(&file, head, sizeof head - 1);
    tobi_file_write(&file, list->text, list->length);
    tobi_file_write(&file, tail, sizeof tail - 1);
    return tobi_file_commit(&file, err);
}

void tobi_pvd_free(tobi_pvd *list)
{
    free(list->text);
    *list = (tobi_pvd){ 0 };
}

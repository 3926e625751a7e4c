/* Reads a CSV table whole into memory, column by column. Drawback: a history of many million rows
   takes as many doubles per column. */
#define _GNU_SOURCE
#include "table.h"
#include "app.h"
#include "language.h"
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SIZE_LIMIT = 1 << 29, COLUMN_LIMIT = 1000 };      /* bytes of a file; columns of a table */

static char *read_whole(const char *path)
{
    struct stat st;
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);      /* a pipe must not keep us waiting */
    FILE *file = fd < 0 ? NULL : fdopen(fd, "rb");
    if (!file) {
        complain("cannot read %s: %s", path, tr(strerror(errno)));
        if (fd >= 0) close(fd);
        return NULL;
    }
    char *text = NULL;
    if (fstat(fileno(file), &st) != 0 || !S_ISREG(st.st_mode)) {
        complain("%s is not a file", path);
    } else if (st.st_size > SIZE_LIMIT) {
        complain("%s has more than %d MiB", path, SIZE_LIMIT >> 20);
    } else if (!(text = malloc((size_t)st.st_size + 1))) {
        complain("out of memory");
    } else {
        size_t size = fread(text, 1, (size_t)st.st_size, file);
        text[size] = '\0';
        if (ferror(file) || strlen(text) != size) {
            complain(ferror(file) ? TEXT("cannot read %s") : TEXT("%s is not a text"), path);
            free(text);
            text = NULL;
        }
    }
    fclose(file);
    return text;
}

/* Cuts one field off *rest, in place: without quotes and the blanks around it. *last says that the
   row ends with it. */
static char *cut_field(const table *t, char **rest, int *last)
{
    const char ends[] = { t->separator, '\n', '\0' };
    char *from = *rest + strspn(*rest, t->separator == '\t' ? " " : " \t"), *to = from, *field = from;
    if (*from == '"') {
        for (from++; *from && (*from != '"' || from[1] == '"'); from++) {
            if (*from == '"') from++;
            *to++ = *from;
        }
        from += strcspn(from, ends);
    } else {
        from += strcspn(from, ends);
        to = from;
        while (to > field && strchr(" \t\r", to[-1])) to--;
    }
    *last = *from != t->separator;
    *rest = *from ? from + 1 : from;
    *to = '\0';
    return field;
}

static int is_skipped(const char *line)
{
    size_t blanks = strspn(line, " \t\r");
    return line[blanks] == '#' || line[blanks] == '\n' || line[blanks] == '\0';
}

static char *skip_lines(char *rest)
{
    while (*rest && is_skipped(rest)) {
        rest += strcspn(rest, "\n");
        rest += *rest == '\n';
    }
    return rest;
}

/* The first one in a row of names, outside of quotes. */
static char find_separator(const char *row)
{
    int quoted = 0;
    for (; *row && *row != '\n'; row++) {
        quoted ^= *row == '"';
        if (!quoted && strchr(",;\t", *row)) return *row;
    }
    return ',';
}

static int read_names(table *t, char **rest)
{
    t->names = calloc(COLUMN_LIMIT, sizeof *t->names);
    if (!t->names) return complain("out of memory");
    t->separator = find_separator(*rest);
    for (int last = 0; !last;) {
        if (t->columns == COLUMN_LIMIT)
            return complain("%s has more than %d columns", t->path, COLUMN_LIMIT);
        t->names[t->columns++] = cut_field(t, rest, &last);
    }
    return 0;
}

static int read_rows(table *t, char *rest)
{
    size_t room = 0;
    while (*(rest = skip_lines(rest))) {
        if (t->rows == room) {
            room = room ? 2 * room : 256;
            char **cells = reallocarray(t->cells, room, (size_t)t->columns * sizeof *cells);
            if (!cells) return complain("out of memory");
            t->cells = cells;
        }
        char **row = t->cells + t->rows++ * (size_t)t->columns;
        for (int k = 0; k < t->columns; k++) row[k] = "";
        for (int k = 0, last = 0; !last; k++) {
            char *field = cut_field(t, &rest, &last);
            if (k < t->columns) row[k] = field;
            else if (*field)
                return complain("%s: row %zu has more than the %d columns of the first line; is a comma a "
                                "decimal mark there?", t->path, t->rows, t->columns);
        }
    }
    return 0;
}

int table_read(table *t, const char *path)
{
    *t = (table){ .path = strdup(path), .text = read_whole(path) };
    char *rest = t->text;
    int code = t->path && t->text ? 0 : EXIT_ERROR;
    if (code == 0) {
        if (strncmp(rest, "\xef\xbb\xbf", 3) == 0) rest += 3;       /* byte order mark */
        rest = skip_lines(rest);
        code = *rest ? read_names(t, &rest) : complain("%s is empty", path);
    }
    if (code == 0) code = read_rows(t, rest);
    if (code == 0) return 0;
    table_free(t);
    return -1;
}

void table_free(table *t)
{
    free(t->path);
    free(t->names);
    free(t->cells);
    free(t->text);
    free(t->added);
    *t = (table){ 0 };
}

int table_column(const table *t, const char *name)
{
    for (int k = 0; k < t->columns; k++)
        if (strcmp(t->names[k], name) == 0) return k;
    return -1;
}

void table_add_column(table *t, const char *name, const double *value)
{
    enum { WIDTH = 32 };
    const size_t old = (size_t)t->columns, columns = old + 1;
    char **cells = calloc(t->rows*columns + 1, sizeof *cells);
    t->added = malloc(t->rows*WIDTH + 1);
    if (!cells || !t->added || t->columns == COLUMN_LIMIT) exit(complain("out of memory"));
    for (size_t i = 0; i < t->rows; i++) {
        memcpy(cells + i*columns, t->cells + i*old, old*sizeof *cells);
        cells[i*columns + old] = t->added + i*WIDTH;
        snprintf(t->added + i*WIDTH, WIDTH, "%.9g", value[i]);
    }
    free(t->cells);
    t->cells = cells;
    t->names[t->columns++] = (char *)name;
}

double table_number(const table *t, size_t row, int column)
{
    const char *cell = t->cells[row * (size_t)t->columns + (size_t)column];
    char *end;
    double value = strtod(cell, &end);
    return end == cell || *end != '\0' || !isfinite(value) ? NAN : value;
}

void table_list_columns(const table *t, char *list, size_t size)
{
    size_t used = 0;
    list[0] = '\0';
    for (int k = 0; k < t->columns && used < size; k++)
        used += (size_t)snprintf(list + used, size - used, "%s%s", k ? ", " : "", t->names[k]);
}

void table_strip_units(table *t)
{
    for (int k = 0; k < t->columns; k++) {
        char *unit = strstr(t->names[k], " [");
        if (unit) *unit = '\0';
    }
}

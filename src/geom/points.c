/* Tables of a survey. Drawback: a list doubles when it grows, so that its last room is up to half empty. */
#define _GNU_SOURCE
#include "geom/points.h"
#include "base/plain.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { WIDEST = 3 };

tobi_status tobi_points_add(tobi_points *p, const double *at, int64_t most, tobi_error *err)
{
    if (p->count == most) return tobi_fail(err, TOBI_INVALID, "more than %lld points", (long long)most);
    if ((p->count & (p->count - 1)) == 0) {         /* a power of two: no room for one more */
        void *more = realloc(p->at, (size_t)(2*p->count + 1)*(size_t)p->width*sizeof *p->at);
        if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for points");
        p->at = more;
    }
    memcpy(p->at + p->count++*p->width, at, (size_t)p->width*sizeof *at);
    return TOBI_OK;
}

void tobi_points_free(tobi_points *p)
{
    free(p->at);
    *p = (tobi_points){ 0 };
}

typedef struct table {
    const char *path, *names;       /* letters of the coordinates */
    long long line;
    char separator[2];
    int field[WIDEST];              /* of the line; -1: not yet known */
    double scale[WIDEST];
    int width, fields;              /* coordinates; fields of the first line */
} table;

/* The next field without blanks and quotes around it; NULL at the end. */
static char *next_field(const table *t, char **rest)
{
    char *field = strsep(rest, t->separator);
    if (!field) return NULL;
    field += strspn(field, " \"\r\n");
    for (size_t n = strlen(field); n && strchr(" \"\r\n", field[n - 1]);) field[--n] = 0;
    return field;
}

/* "x [mm]" is 1e-3; 0: a unit that is not known. Cuts it off. */
static double take_unit(char *field)
{
    char *unit = strpbrk(field, "[(");
    if (!unit) return 1;
    const size_t length = strcspn(unit + 1, "])");
    const double scale = length == 1 && unit[1] == 'm' ? 1 : length == 2 && !strncmp(unit + 1, "cm", 2) ? 1e-2
                       : length == 2 && !strncmp(unit + 1, "mm", 2) ? 1e-3 : 0;
    while (unit > field && unit[-1] == ' ') unit--;
    *unit = '\0';
    return scale;
}

static tobi_status read_header(table *t, char *line, tobi_error *err)
{
    const char *first = strpbrk(line, ",;\t");
    t->separator[0] = first ? *first : ',';
    for (int a = 0; a < t->width; a++) t->field[a] = -1;
    char *rest = line, *field;
    for (int k = 0; (field = next_field(t, &rest)); k++) {
        const double scale = take_unit(field);
        t->fields = k + 1;
        for (int a = 0; a < t->width; a++) {
            const char name[2] = { t->names[a], '\0' };
            if (strcasecmp(field, name) != 0) continue;
            if (scale == 0)
                return tobi_fail(err, TOBI_INVALID, "%s:%lld: the unit of column %s is not known; allowed "
                                 "are [m], [cm], [mm] or none, which is m", t->path, t->line, name);
            if (t->field[a] >= 0)
                return tobi_fail(err, TOBI_INVALID, "%s:%lld: column %s is there twice", t->path, t->line,
                                 name);
            t->field[a] = k, t->scale[a] = scale;
        }
    }
    for (int a = 0; a < t->width; a++)
        if (t->field[a] < 0)
            return tobi_fail(err, TOBI_INVALID, "%s:%lld: the first line names no column %c; it must name "
                             "%s%c and %c", t->path, t->line, t->names[a], t->width == 3 ? "x, " : "",
                             t->names[t->width - 2], t->names[t->width - 1]);
    return TOBI_OK;
}

static tobi_status read_row(table *t, char *line, int64_t most, tobi_points *out, tobi_error *err)
{
    char *rest = line, *field;
    double v[WIDEST] = { NAN, NAN, NAN };
    for (int k = 0; (field = next_field(t, &rest)); k++) {
        if (k >= t->fields && *field)
            return tobi_fail(err, TOBI_INVALID, "%s:%lld: the row has more than the %d columns of the first "
                             "line; is a comma a decimal mark there?", t->path, t->line, t->fields);
        for (int a = 0; a < t->width; a++) {
            char *end;
            if (k != t->field[a]) continue;
            v[a] = t->scale[a]*strtod(field, &end);
            if (end == field || *end || !isfinite(v[a]))
                return tobi_fail(err, TOBI_INVALID, "%s:%lld: \"%s\" is no finite number", t->path, t->line,
                                 tobi_excerpt(field).text);
        }
    }
    for (int a = 0; a < t->width; a++)
        if (isnan(v[a]))
            return tobi_fail(err, TOBI_INVALID, "%s:%lld: the row has fewer columns than the first line",
                             t->path, t->line);
    return tobi_points_add(out, v, most, err);
}

tobi_status tobi_points_read(const char *path, const char *names, int64_t most, tobi_points *out,
                             tobi_error *err)
{
    table t = { .path = path, .names = names, .width = (int)strlen(names) };
    char *line = NULL;
    size_t room = 0;
    int named = 0;
    tobi_status status = TOBI_OK;
    *out = (tobi_points){ .width = t.width };
    FILE *file = fopen(path, "r");
    if (!file)
        return tobi_fail(err, errno == ENOENT ? TOBI_NOT_FOUND : TOBI_IO, "%s: %s", path, tobi_reason(errno));
    while (status == TOBI_OK && getline(&line, &room, file) > 0) {
        t.line++;
        char *text = line;
        if (t.line == 1 && strncmp(text, "\xef\xbb\xbf", 3) == 0) text += 3;      /* as spreadsheets write */
        if (text[strspn(text, " \r\n")] == '\0' || *text == '#') continue;
        status = named++ ? read_row(&t, text, most, out, err) : read_header(&t, text, err);
    }
    if (status == TOBI_OK && ferror(file)) status = tobi_fail(err, TOBI_IO, "%s: cannot be read", path);
    if (status == TOBI_OK && !named) status = tobi_fail(err, TOBI_INVALID, "%s is empty", path);
    free(line);
    fclose(file);
    return status;
}

/* Points of an outline: from a text, and from a table of a survey. Drawback: a point beyond the 65536th is
   refused here, and one beyond the 5000th by the prism. */
#define _GNU_SOURCE
#include "geom/outline.h"
#include "base/plain.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MOST_POINTS = 65536, MOST_COLUMNS = 64 };

static tobi_status add_point(tobi_outline *o, double u, double v, tobi_error *err)
{
    if (o->count == MOST_POINTS)
        return tobi_fail(err, TOBI_INVALID, "more than %d points", MOST_POINTS);
    if ((o->count & (o->count - 1)) == 0) {         /* a power of two: no room for one more */
        void *more = realloc(o->at, (size_t)(2*o->count + 1)*sizeof *o->at);
        if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for an outline");
        o->at = more;
    }
    o->at[o->count][0] = u;
    o->at[o->count++][1] = v;
    return TOBI_OK;
}

tobi_status tobi_outline_parse(const char *text, tobi_outline *out, tobi_error *err)
{
    *out = (tobi_outline){ 0 };
    for (const char *c = text; *c;) {
        char *comma, *end;
        const double u = strtod(c, &comma), v = *comma == ',' ? strtod(comma + 1, &end) : NAN;
        if (!isfinite(u) || !isfinite(v) || comma == c || end == comma + 1 || (*end && *end != ' '))
            return tobi_fail(err, TOBI_INVALID, "\"%s\" is no point; points are like \"0,0 5,0.25 5,0\"",
                             tobi_excerpt(c).text);
        TOBI_TRY(add_point(out, u, v, err));
        c = end + strspn(end, " ");
    }
    return TOBI_OK;
}

/* --- tables --------------------------------------------------------------------------------- */

typedef struct table {
    const char *path;
    long long line;
    char separator[2];
    int field[2];                   /* of the line: both coordinates; -1: not yet known */
    double scale[2];
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

static tobi_status read_header(table *t, char *line, const int plane[2], tobi_error *err)
{
    const char *first = strpbrk(line, ",;\t");
    t->separator[0] = first ? *first : ',';
    t->field[0] = t->field[1] = -1;
    char *rest = line, *field;
    for (int k = 0; (field = next_field(t, &rest)); k++) {
        const double scale = take_unit(field);
        for (int a = 0; a < 2; a++) {
            const char name[2] = { "xyz"[plane[a]], '\0' };
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
    if (t->field[0] >= 0 && t->field[1] >= 0) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "%s:%lld: the first line must name columns %c and %c", t->path,
                     t->line, "xyz"[plane[0]], "xyz"[plane[1]]);
}

static tobi_status read_row(table *t, char *line, tobi_outline *out, tobi_error *err)
{
    char *rest = line, *field;
    double v[2] = { NAN, NAN };
    for (int k = 0; (field = next_field(t, &rest)); k++)
        for (int a = 0; a < 2; a++) {
            char *end;
            if (k != t->field[a]) continue;
            v[a] = t->scale[a]*strtod(field, &end);
            if (end == field || *end || !isfinite(v[a]))
                return tobi_fail(err, TOBI_INVALID, "%s:%lld: \"%s\" is no finite number", t->path, t->line,
                                 tobi_excerpt(field).text);
        }
    if (isnan(v[0]) || isnan(v[1]))
        return tobi_fail(err, TOBI_INVALID, "%s:%lld: the row has fewer columns than the first line", t->path,
                         t->line);
    return add_point(out, v[0], v[1], err);
}

tobi_status tobi_outline_read(const char *path, const int plane[2], tobi_outline *out, tobi_error *err)
{
    table t = { .path = path };
    char *line = NULL;
    size_t room = 0;
    int named = 0;
    tobi_status status = TOBI_OK;
    *out = (tobi_outline){ 0 };
    FILE *file = fopen(path, "r");
    if (!file)
        return tobi_fail(err, errno == ENOENT ? TOBI_NOT_FOUND : TOBI_IO, "%s: %s", path, strerror(errno));
    while (status == TOBI_OK && getline(&line, &room, file) > 0) {
        t.line++;
        char *text = line;
        if (t.line == 1 && strncmp(text, "\xef\xbb\xbf", 3) == 0) text += 3;      /* as spreadsheets write */
        if (text[strspn(text, " \r\n")] == '\0' || *text == '#') continue;
        status = named++ ? read_row(&t, text, out, err) : read_header(&t, text, plane, err);
    }
    if (status == TOBI_OK && ferror(file)) status = tobi_fail(err, TOBI_IO, "%s: cannot be read", path);
    if (status == TOBI_OK && !named) status = tobi_fail(err, TOBI_INVALID, "%s is empty", path);
    free(line);
    fclose(file);
    return status;
}

tobi_status tobi_outline_fill(tobi_outline *o, double base, tobi_error *err)
{
    for (int64_t k = 0; k < o->count; k++) {
        const double *p = o->at[k];
        if (k > 0 && !(p[0] > o->at[k - 1][0]))
            return tobi_fail(err, TOBI_INVALID, "with a base points go to the right, but (%g, %g) m follows "
                             "(%g, %g) m", p[0], p[1], o->at[k - 1][0], o->at[k - 1][1]);
        if (!(p[1] >= base))
            return tobi_fail(err, TOBI_INVALID, "the point (%g, %g) m lies below the base, %g m", p[0], p[1],
                             base);
    }
    if (o->count < 2)
        return tobi_fail(err, TOBI_INVALID, "%lld points; a line above a base has at least 2",
                         (long long)o->count);
    const double left = o->at[0][0], right = o->at[o->count - 1][0];
    TOBI_TRY(add_point(o, right, base, err));
    return add_point(o, left, base, err);
}

/* tobiuo sample: places along lines, of a table, of a grid. Drawback: all places are kept, so that a grid has
   a limit. */
#define _GNU_SOURCE
#include "sample.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_PLACES 20000000.0
#define FARTHEST 1e7                   /* m, as in scenes */

static int make_room(sample_places *p, int64_t count)
{
    p->count = count;
    p->x = malloc((size_t)count*sizeof *p->x + 1);
    return p->x ? 0 : complain("out of memory");
}

/* Two or three numbers between commas; what follows them, or NULL. */
static const char *read_place(const char *text, int dimension, double x[3])
{
    char *end;
    int n = 0;
    x[2] = 0;
    for (const char *at = text;; at = end + 1) {
        x[n++] = strtod(at, &end);
        if (end == at || !(fabs(x[n - 1]) <= FARTHEST)) return NULL;
        end += strspn(end, " ");
        if (*end != ',' || n == 3) break;
    }
    return n == dimension || (n == 3 && x[2] == 0) ? end : NULL;
}

/* "A to B". */
static int read_ends(const sample_run *s, const char *option, const char *text, double from[3], double to[3])
{
    const int dimension = s->looks.dimension;
    const char *at = read_place(text, dimension, from);
    if (at && strncmp(at, "to ", 3) == 0) at = read_place(at + 3, dimension, to);
    else at = NULL;
    return at && *at == '\0' ? 0
        : complain("%s '%s': is not like \"%s\", in metres; the run is in %d-D", option, text,
                   dimension == 2 ? "0.5,0 to 0.5,0.3" : "0.5,0,0 to 0.5,0,0.3", dimension);
}

static int find_lines(sample_run *s)
{
    const sample_options *o = s->options;
    sample_places *p = &s->places;
    int code = make_room(p, (int64_t)o->line_count*o->count);
    if (code) return code;
    p->way = malloc((size_t)p->count*sizeof *p->way);
    p->line = malloc((size_t)p->count*sizeof *p->line);
    if (!p->way || !p->line) return complain("out of memory");
    for (int64_t l = 0, i = 0; l < o->line_count; l++) {
        double from[3], to[3], length = 0;
        if ((code = read_ends(s, "--line", o->line[l], from, to))) return code;
        for (int a = 0; a < 3; a++) length += (to[a] - from[a])*(to[a] - from[a]);
        length = sqrt(length);
        if (!(length > 0)) return complain("--line '%s': both ends are the same", o->line[l]);
        for (int k = 0; k < o->count; k++, i++) {
            const double share = (double)k/(o->count - 1);
            for (int a = 0; a < 3; a++) p->x[i][a] = (1 - share)*from[a] + share*to[a];
            p->way[i] = share*length;
            p->line[i] = (int)l;
        }
    }
    return 0;
}

/* The column "x", or "x [mm]", and how many metres its unit is; -1 after a complaint. */
static int find_coordinate(const sample_run *s, const table *t, char axis, double *scale)
{
    static const struct { const char *name; double scale; } units[] = {
        { "", 1 }, { " [m]", 1 }, { " [cm]", 1e-2 }, { " [mm]", 1e-3 } };
    for (int k = 0; k < t->columns; k++) {
        const char *name = t->names[k];
        if (name[0] != axis || (name[1] != '\0' && strncmp(name + 1, " [", 2) != 0)) continue;
        for (size_t u = 0; u < sizeof units/sizeof *units; u++)
            if (strcmp(name + 1, units[u].name) == 0) return *scale = units[u].scale, k;
        complain("%s: the unit of column '%s' is not known; allowed are [m], [cm], [mm] or none, which is m",
                 t->path, name);
        return -1;
    }
    char list[200];
    table_list_columns(t, list, sizeof list);
    complain("%s: has no column '%c'; columns x, y%s are needed, as x or x [mm]; it has %s", t->path, axis,
             s->looks.dimension == 3 ? ", z" : "", list);
    return -1;
}

static int find_points(sample_run *s)
{
    const char *path = s->options->points;
    table t;
    if (table_read(&t, path) != 0) return EXIT_ERROR;
    int code = 0, column[3];
    double scale[3];
    for (int a = 0; a < s->looks.dimension && !code; a++)
        if ((column[a] = find_coordinate(s, &t, "xyz"[a], &scale[a])) < 0) code = EXIT_ERROR;
    if (!code && t.rows == 0) code = complain("%s: has no places", path);
    if (!code && (double)t.rows > MOST_PLACES)
        code = complain("%s: has %zu places, allowed are %.0f", path, t.rows, MOST_PLACES);
    if (!code) code = make_room(&s->places, (int64_t)t.rows);
    for (size_t i = 0; i < t.rows && !code; i++) {
        s->places.x[i][2] = 0;
        for (int a = 0; a < s->looks.dimension && !code; a++)
            if (!(fabs(s->places.x[i][a] = scale[a]*table_number(&t, i, column[a])) <= FARTHEST))
                code = complain("%s: place %zu has no number up to %g m in column '%c'", path, i + 1,
                                FARTHEST, "xyz"[a]);
    }
    table_free(&t);
    return code;
}

static int find_grid(sample_run *s)
{
    sample_places *p = &s->places;
    const double cell = s->options->cell > 0 ? s->options->cell : s->spacing;
    double to[3], points = 1, extents = 1;
    int axes = 0, code = read_ends(s, "--box", s->options->box, p->origin, to);
    for (int a = 0; a < 3 && !code; a++) {
        const double extent = to[a] - p->origin[a];
        if (extent < 0) code = complain("--box '%s': its corners are not in order along %c", s->options->box,
                                        "xyz"[a]);
        p->cell[a] = cell;
        p->n[a] = (int64_t)fmin(extent/cell + 1e-9, 1e15) + 1;
        points *= (double)p->n[a];
        if (extent > 0) extents *= extent, axes++;
    }
    if (!code && axes == 0) code = complain("--box '%s': both corners are the same", s->options->box);
    if (!code && points < 2)
        code = complain("--box '%s': a cell of %g m is wider than the box", s->options->box, cell);
    if (!code && points > MOST_PLACES)
        code = complain("--box '%s': a cell of %g m makes %.3g places, allowed are %.0f; take a cell of %.2g "
                        "m", s->options->box, cell, points, MOST_PLACES,
                        1.05*pow(extents/MOST_PLACES, 1.0/axes));
    p->is_grid = 1;
    if (!code) code = make_room(p, p->n[0]*p->n[1]*p->n[2]);
    for (int64_t i = 0; i < p->count && !code; i++) {
        const int64_t at[3] = { i%p->n[0], i/p->n[0]%p->n[1], i/p->n[0]/p->n[1] };
        for (int a = 0; a < 3; a++) p->x[i][a] = p->origin[a] + cell*(double)at[a];
    }
    return code;
}

/* Corners of a grid stand for it. A side of the domain may be off by rounding: places are put on it. */
static int check_domain(sample_run *s)
{
    const tobi_looks *l = &s->looks;
    for (int64_t i = 0; i < s->places.count; i++)
        for (int a = 0; a < l->dimension; a++) {
            const double low = l->box_min[a], high = l->box_max[a], slack = 1e-9*(high - low);
            double *x = &s->places.x[i][a];
            if (!(*x >= low - slack && *x <= high + slack))
                return complain("the place %g,%g,%g is outside of the domain, which is %g to %g m along %c",
                                s->places.x[i][0], s->places.x[i][1], s->places.x[i][2], low, high, "xyz"[a]);
            *x = fmin(fmax(*x, low), high);
        }
    return 0;
}

int sample_find_places(sample_run *s)
{
    const sample_options *o = s->options;
    const int code = o->line_count ? find_lines(s) : o->points ? find_points(s) : find_grid(s);
    return code || o->body ? code : check_domain(s);
}

/* Grids of heights from files. Drawback: a lattice of a table must be whole, and its lines must have the very
   same coordinates. */
#define _GNU_SOURCE
#include "geom/points.h"
#include "geom/terrain.h"
#include "base/plain.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MOST = 4000000 };          /* heights */

static tobi_status make_room(tobi_terrain *t, tobi_error *err)
{
    t->x = malloc((size_t)t->nx*sizeof *t->x);
    t->y = malloc((size_t)t->ny*sizeof *t->y);
    t->z = malloc((size_t)(t->nx*t->ny)*sizeof *t->z);
    return t->x && t->y && t->z ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for a terrain");
}

/* --- ESRI ASCII grids ------------------------------------------------------------------------ */

enum { COLUMNS, ROWS, X_CORNER, Y_CORNER, X_CENTER, Y_CENTER, SIZE, NO_DATA, KEYS };
static const char *const keys[KEYS] = { "ncols", "nrows", "xllcorner", "yllcorner", "xllcenter", "yllcenter",
                                        "cellsize", "nodata_value" };

typedef struct head { double value[KEYS]; int given[KEYS]; } head;

/* The pairs in front of the heights; the first of those stays in the file. */
static tobi_status read_head(FILE *file, const char *path, head *h, tobi_error *err)
{
    char word[64];
    for (;;) {
        const long at = ftell(file);
        if (fscanf(file, "%63s", word) != 1)
            return tobi_fail(err, TOBI_INVALID, "%s: there are no heights", path);
        char *end;
        strtod(word, &end);
        if (end > word && *end == '\0') return fseek(file, at, SEEK_SET) == 0 ? TOBI_OK : TOBI_IO;
        int key = 0;
        while (key < KEYS && strcasecmp(word, keys[key]) != 0) key++;
        if (key == KEYS || fscanf(file, "%lf", &h->value[key]) != 1 ||
            (key != NO_DATA && !isfinite(h->value[key])))
            return tobi_fail(err, TOBI_INVALID, "%s: \"%s\" is no key of an ESRI ASCII grid with its number",
                             path, tobi_excerpt(word).text);
        h->given[key] = 1;
    }
}

static tobi_status check_head(const char *path, const head *h, tobi_error *err)
{
    const int *g = h->given;
    const double n = h->value[COLUMNS], m = h->value[ROWS];
    const int places = g[X_CORNER] + g[X_CENTER] == 1 && g[Y_CORNER] + g[Y_CENTER] == 1;
    if (!g[COLUMNS] || !g[ROWS] || !g[SIZE] || !places)
        return tobi_fail(err, TOBI_INVALID, "%s: an ESRI ASCII grid needs ncols, nrows, cellsize, xllcorner "
                         "or xllcenter, and yllcorner or yllcenter", path);
    if (!(n >= 1 && m >= 1 && n == floor(n) && m == floor(m) && n*m <= MOST))
        return tobi_fail(err, TOBI_INVALID, "%s: ncols is %g and nrows %g; allowed are whole numbers from 1 "
                         "on, and %d heights", path, n, m, MOST);
    if (!(h->value[SIZE] > 0))
        return tobi_fail(err, TOBI_INVALID, "%s: cellsize is %g, must be above 0", path, h->value[SIZE]);
    return TOBI_OK;
}

/* Places of n cells: their middles, and both edges. */
static void place_lines(double *line, int64_t n, double corner, double size)
{
    line[0] = corner;
    for (int64_t k = 0; k < n; k++) line[k + 1] = corner + ((double)k + 0.5)*size;
    line[n + 1] = corner + (double)n*size;
}

/* Rows go from north to south; the outer lines repeat what is beside them. */
static tobi_status read_heights(FILE *file, const char *path, const head *h, tobi_terrain *t,
                                tobi_error *err)
{
    for (int64_t j = t->ny - 2; j >= 1; j--)
        for (int64_t i = 1; i < t->nx - 1; i++) {
            double z;
            if (fscanf(file, "%lf", &z) != 1 || !isfinite(z))
                return tobi_fail(err, TOBI_INVALID, "%s: row %lld, column %lld holds no height", path,
                                 (long long)(t->ny - 1 - j), (long long)i);
            if (z == (h->given[NO_DATA] ? h->value[NO_DATA] : -9999))
                return tobi_fail(err, TOBI_INVALID, "%s: row %lld, column %lld has no data (%g); fill it, or "
                                 "cut the grid", path, (long long)(t->ny - 1 - j), (long long)i, z);
            t->z[j*t->nx + i] = z;
        }
    char more[2];
    if (fscanf(file, "%1s", more) == 1)
        return tobi_fail(err, TOBI_INVALID, "%s: more follows after the %g times %g heights of ncols and "
                         "nrows", path, h->value[COLUMNS], h->value[ROWS]);
    for (int64_t j = 0; j < t->ny; j++)
        for (int64_t i = 0; i < t->nx; i++) {
            const int64_t row = j == 0 ? 1 : j == t->ny - 1 ? j - 1 : j;
            const int64_t column = i == 0 ? 1 : i == t->nx - 1 ? i - 1 : i;
            t->z[j*t->nx + i] = t->z[row*t->nx + column];
        }
    return TOBI_OK;
}

static tobi_status read_esri(FILE *file, const char *path, tobi_terrain *t, tobi_error *err)
{
    head h = { .given = { 0 } };
    TOBI_TRY(read_head(file, path, &h, err));
    TOBI_TRY(check_head(path, &h, err));
    const double size = h.value[SIZE];
    const double x = h.given[X_CORNER] ? h.value[X_CORNER] : h.value[X_CENTER] - 0.5*size;
    const double y = h.given[Y_CORNER] ? h.value[Y_CORNER] : h.value[Y_CENTER] - 0.5*size;
    t->nx = (int64_t)h.value[COLUMNS] + 2, t->ny = (int64_t)h.value[ROWS] + 2;
    TOBI_TRY(make_room(t, err));
    place_lines(t->x, t->nx - 2, x, size);
    place_lines(t->y, t->ny - 2, y, size);
    return read_heights(file, path, &h, t, err);
}

/* --- tables ---------------------------------------------------------------------------------- */

static int order_numbers(const void *a, const void *b)
{
    const double u = *(const double *)a, v = *(const double *)b;
    return u < v ? -1 : u > v;
}

/* The different values of a column, rising; their number. */
static int64_t list_values(const tobi_points *p, int column, double *out)
{
    int64_t n = 0;
    for (int64_t k = 0; k < p->count; k++) out[k] = p->at[k*p->width + column];
    qsort(out, (size_t)p->count, sizeof *out, order_numbers);
    for (int64_t k = 0; k < p->count; k++)
        if (k == 0 || out[k] > out[n - 1]) out[n++] = out[k];
    return n;
}

static int64_t find_line(const double *line, int64_t n, double at)
{
    const double *found = bsearch(&at, line, (size_t)n, sizeof *line, order_numbers);
    return found - line;
}

static tobi_status fill_lattice(const char *path, const tobi_points *p, tobi_terrain *t, tobi_error *err)
{
    if (t->nx < 2 || t->ny < 2 || t->nx*t->ny != p->count)
        return tobi_fail(err, TOBI_INVALID, "%s: %lld points are no lattice: x has %lld different values and "
                         "y %lld; at least 2 of each, and a point at each crossing", path,
                         (long long)p->count, (long long)t->nx, (long long)t->ny);
    for (int64_t k = 0; k < t->nx*t->ny; k++) t->z[k] = NAN;
    for (int64_t k = 0; k < p->count; k++) {
        const double *at = p->at + 3*k;
        double *z = &t->z[find_line(t->y, t->ny, at[1])*t->nx + find_line(t->x, t->nx, at[0])];
        if (!isnan(*z))
            return tobi_fail(err, TOBI_INVALID, "%s: the point x = %g, y = %g m is there twice", path, at[0],
                             at[1]);
        *z = at[2];
    }
    return TOBI_OK;
}

static tobi_status read_table(const char *path, tobi_terrain *t, tobi_error *err)
{
    tobi_points p;
    tobi_status status = tobi_points_read(path, "xyz", MOST, &p, err);
    if (status == TOBI_OK) {
        t->nx = t->ny = p.count + 1;                  /* room for the worst */
        t->x = malloc((size_t)t->nx*sizeof *t->x);
        t->y = malloc((size_t)t->ny*sizeof *t->y);
        t->z = malloc((size_t)(p.count + 1)*sizeof *t->z);
        if (!t->x || !t->y || !t->z) status = tobi_fail(err, TOBI_NO_MEMORY, "no memory for a terrain");
    }
    if (status == TOBI_OK) {
        t->nx = list_values(&p, 0, t->x), t->ny = list_values(&p, 1, t->y);
        status = fill_lattice(path, &p, t, err);
    }
    tobi_points_free(&p);
    return status;
}

tobi_status tobi_terrain_read(const char *path, tobi_terrain *out, tobi_error *err)
{
    static const char mark[] = "\xef\xbb\xbf";      /* of UTF-8, as Windows writes */
    char word[16] = "";
    *out = (tobi_terrain){ 0 };
    FILE *file = fopen(path, "r");
    if (!file)
        return tobi_fail(err, errno == ENOENT ? TOBI_NOT_FOUND : TOBI_IO, "%s: %s", path, tobi_reason(errno));
    int esri = 0;
    const int words = fscanf(file, "%15s", word);
    const int marked = strncmp(word, mark, strlen(mark)) == 0;
    for (int k = 0; k < KEYS && words == 1; k++) esri |= strcasecmp(word + 3*marked, keys[k]) == 0;
    if (fseek(file, 3*marked, SEEK_SET) != 0) rewind(file);
    const tobi_status status = esri ? read_esri(file, path, out, err) : TOBI_OK;
    fclose(file);
    return esri ? status : read_table(path, out, err);
}

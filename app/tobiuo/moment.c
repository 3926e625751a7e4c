/* What commands take of the outputs of a finished run: fields by name, points of bodies. Drawback: an output
   is read whole. */
#define _GNU_SOURCE
#include "moment.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

const tobi_moment_field *find_moment_field(const tobi_moment *m, const char *name)
{
    for (int k = 0; k < m->field_count; k++)
        if (strcmp(m->fields[k].name, name) == 0) return &m->fields[k];
    return NULL;
}

const tobi_moment_field *find_moment_part(const tobi_moment *m, const char *name, int *component)
{
    *component = -1;
    const tobi_moment_field *f = find_moment_field(m, name);
    const char *whole = f ? NULL : tobi_world_find_field(name, component, NULL);
    if (whole) f = find_moment_field(m, whole);
    return f && *component < f->components ? f : NULL;
}

int is_label_field(const char *name)
{
    static const char *const labels[] = { "material", "part", "piece", "cut_side" };
    for (size_t k = 0; k < sizeof labels/sizeof *labels; k++)
        if (strcmp(labels[k], name) == 0) return 1;
    return strstr(name, "_id") != NULL;
}

void list_moment_fields(const tobi_moment *m, char *list, size_t size)
{
    *list = '\0';
    for (int k = 0; k < m->field_count; k++) {
        const size_t used = strlen(list);
        snprintf(list + used, size - used, ", %s", m->fields[k].name);
    }
}

typedef struct cell_row { int64_t cell[3], row; } cell_row;

static int compare_cells(const void *a, const void *b)
{
    const cell_row *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->cell[k] != q->cell[k]) return p->cell[k] < q->cell[k] ? -1 : 1;
    return p->row < q->row ? -1 : p->row > q->row;
}

static int thin_bodies(double (*x)[3], int64_t count, double spacing, thinned *t)
{
    cell_row *cells = malloc((size_t)count*sizeof *cells + 1);
    int64_t *row = realloc(t->row, (size_t)count*sizeof *row + 1);
    if (row) t->row = row;
    if (!cells || !row) {
        free(cells);
        return complain("out of memory");
    }
    for (int64_t i = 0; i < count; i++) {
        cells[i].row = i;
        for (int k = 0; k < 3; k++)
            cells[i].cell[k] = (int64_t)floor(fmin(fmax(x[i][k]/spacing, -1e15), 1e15));
    }
    qsort(cells, (size_t)count, sizeof *cells, compare_cells);
    t->of = count, t->count = 0;
    for (int64_t i = 0; i < count; i++)
        if (i == 0 || memcmp(cells[i].cell, cells[i - 1].cell, sizeof cells->cell) != 0)
            row[t->count++] = cells[i].row;
    free(cells);
    return 0;
}

int take_body_points(const tobi_results *results, int64_t k, double spacing, thinned *t,
                     double (**points)[3], int64_t *count)
{
    tobi_error err = { 0 };
    double (*all)[3];
    *points = NULL;
    if (tobi_results_read_bodies(results, k, &all, count, &err) != TOBI_OK)
        return complain("%s", err.text);
    const int code = *count != t->of ? thin_bodies(all, *count, spacing, t) : 0;
    double (*kept)[3] = malloc((size_t)t->count*sizeof *kept + 1);
    if (!kept && code == 0) return free(all), complain("out of memory");
    for (int64_t i = 0; code == 0 && i < t->count; i++) memcpy(kept[i], all[t->row[i]], sizeof *kept);
    free(all);
    *points = kept;
    *count = code == 0 ? t->count : 0;
    return code;
}

/* Points sorted by cells as wide as a search reaches, so that it reads runs of memory. The box is that of the
   domain, and no loop over the points is needed to find it. Drawback: a domain that is nearly empty has many
   empty cells; beyond a limit they become wider. */
#include "view/sample/sample.h"
#include <string.h>

#define MOST_CELLS (1 << 24)

typedef struct fill_view {
    sample_cells *c;
    const double (*points)[3];
} fill_view;

void sample_free_cells(sample_cells *c)
{
    void *const arrays[] = { c->begin, c->row, c->x, c->key };
    for (size_t k = 0; k < sizeof arrays/sizeof *arrays; k++) tobi_array_free(arrays[k]);
    *c = (sample_cells){ 0 };
}

static void place_cells(sample_cells *c, const tobi_sample_def *def, double edge)
{
    const double most = fmax(MOST_CELLS, 4*(double)c->count);
    for (double cells = INFINITY; cells > most; edge *= 1.26) {
        c->edge = edge;
        cells = 1;
        for (int a = 0; a < 3; a++) {
            const double extent = a < c->dimension ? def->box_max[a] - def->box_min[a] : 0;
            c->low[a] = def->box_min[a];
            c->n[a] = (int64_t)fmin(extent/edge, 1e9) + 1;
            cells *= (double)c->n[a];
        }
    }
    c->cells = c->n[0]*c->n[1]*c->n[2];
}

static int64_t cell_along(const sample_cells *c, int a, double x)
{
    const double at = (x - c->low[a])/c->edge;
    return a >= c->dimension || at <= 0 ? 0 : at >= (double)c->n[a] ? c->n[a] - 1 : (int64_t)at;
}

static void find_keys(const void *view, int64_t begin, int64_t end)
{
    const fill_view *v = view;
    const sample_cells *c = v->c;
    for (int64_t i = begin; i < end; i++) {
        const double *x = v->points[i];
        double sum = 0;
        for (int a = 0; a < c->dimension; a++) sum += fabs(x[a]);
        c->key[i] = sum < INFINITY
            ? (uint32_t)((cell_along(c, 2, x[2])*c->n[1] + cell_along(c, 1, x[1]))*c->n[0] +
                         cell_along(c, 0, x[0]))
            : (uint32_t)c->cells;
    }
}

/* Where cells begin: each entry marks those after the cell of the entry before it, up to its own. */
static void copy_points(const void *view, int64_t begin, int64_t end)
{
    const fill_view *v = view;
    sample_cells *c = v->c;
    for (int64_t k = begin; k < end; k++) {
        const int64_t last = k < c->count ? (int64_t)c->key[k] : c->cells + 1;
        for (int64_t cell = k ? (int64_t)c->key[k - 1] + 1 : 0; cell <= last; cell++)
            c->begin[cell] = (int32_t)k;
        if (k < c->count) memcpy(c->x[k], v->points[c->row[k]], sizeof c->x[k]);
    }
}

tobi_status sample_fill_cells(sample_cells *c, tobi_exec *exec, const tobi_sample_def *def, double edge,
                              int64_t count, const double (*points)[3], tobi_error *err)
{
    *c = (sample_cells){ .dimension = def->dimension, .count = count };
    place_cells(c, def, edge);
    c->begin = tobi_array_make(c->cells + 2, sizeof *c->begin);
    c->row = tobi_array_make(count + 1, sizeof *c->row);
    c->x = tobi_array_make(count + 1, sizeof *c->x);
    c->key = tobi_array_make(count + 1, sizeof *c->key);
    uint32_t *key2 = tobi_array_make(count + 1, sizeof *key2);
    int32_t *row2 = tobi_array_make(count + 1, sizeof *row2);
    int64_t *histogram = tobi_array_make(tobi_sort_histogram_size(exec), sizeof *histogram);
    const bool enough = c->begin && c->row && c->x && c->key && key2 && row2 && histogram;
    const fill_view v = { c, points };
    if (enough) {
        tobi_loop(exec->threads, count, 0, find_keys, &v);
        tobi_sort_by_key(exec, count, (uint32_t)c->cells + 1, c->key, c->row, key2, row2, histogram);
        tobi_loop(exec->threads, count + 1, 0, copy_points, &v);
    }
    tobi_array_free(key2);
    tobi_array_free(row2);
    tobi_array_free(histogram);
    return enough ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "sample: out of memory");
}

bool sample_next_run(const sample_cells *c, const double x[3], double reach, int64_t *state, int32_t *begin,
                     int32_t *end)
{
    int64_t from[3], to[3];
    for (int a = 0; a < 3; a++) {
        from[a] = cell_along(c, a, x[a] - reach);
        to[a] = cell_along(c, a, x[a] + reach);
    }
    const int64_t rows = to[1] - from[1] + 1;
    const int64_t y = from[1] + *state%rows, z = from[2] + *state/rows;
    if (z > to[2] || c->count == 0) return false;
    const int64_t row = (z*c->n[1] + y)*c->n[0];
    *begin = c->begin[row + from[0]];
    *end = c->begin[row + to[0] + 1];
    ++*state;
    return true;
}

/* The neighbour search and the kernels as users may look at them. Cells and neighbours are read from the
   lists that the steps use, never computed again. Drawback: the writer holds a copy of all positions. */
#include "tobiuo/inspect.h"
#include "base/error.h"
#include "base/param.h"
#include "core/smoothing.h"
#include "io/vtk.h"
#include "record/record.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The longest list of kernels that a method offers: all methods count them alike. */
static const char *find_choices(void)
{
    const char *longest = NULL;
    for (int k = 0; tobi_method_at(k); k++)
        for (const tobi_param *p = tobi_method_at(k)->params->rows; p->key; p++)
            if (!strcmp(p->key, "kernel") && p->choices && (!longest || strlen(p->choices) > strlen(longest)))
                longest = p->choices;
    return longest;
}

int tobi_kernel_name(int kernel, char *name, size_t size)
{
    const char *choices = find_choices();
    int length = 0;
    const char *word = choices && kernel >= 0 ? tobi_choice_word(choices, kernel, &length) : NULL;
    if (name && size) snprintf(name, size, "%.*s", word ? length : 0, word ? word : "");
    return word != NULL;
}

static int is_kernel(int kernel, int dimension, double support, double r)
{
    return tobi_kernel_name(kernel, NULL, 0) && (dimension == 2 || dimension == 3) && support > 0 && r >= 0;
}

double tobi_kernel_value(int kernel, int dimension, double support, double r)
{
    return is_kernel(kernel, dimension, support, r) ? tobi_smoothing_w(kernel, dimension, support, r) : NAN;
}

double tobi_kernel_slope(int kernel, int dimension, double support, double r)
{
    if (!is_kernel(kernel, dimension, support, r)) return NAN;
    return r > 0 ? -r*tobi_smoothing_f(kernel, dimension, support, r) : 0;
}

/* The system of the fluid, with cells and lists of the present positions. */
static tobi_status find_system(tobi_world *w, tobi_system **s, tobi_error *err)
{
    *s = tobi_world_fluids(w);
    if (!*s)
        return tobi_fail(err, TOBI_UNSUPPORTED, "%s has no neighbour search; methods for fluids have one",
                         w->system[0].method->name);
    return tobi_world_refresh(w, err);
}

static void describe_search(const tobi_system *s, tobi_search *search)
{
    *search = (tobi_search){ .kernel = s->smoothing.shape, .support = s->smoothing.h,
                             .particles = s->particles.count };
    for (int a = 0; a < 3; a++) {
        search->cells[a] = s->cells.n[a];
        search->periodic[a] = s->cells.periodic[a];
        search->lower[a] = s->box.lower[a];
        search->width[a] = 1/s->cells.inverse[a];
    }
    /* The one layer of a 2-D world lies around its plane. */
    if (s->box.dimension == 2) search->lower[2] = -0.5*search->width[2];
}

tobi_status tobi_world_search(tobi_world *w, tobi_search *search, tobi_error *err)
{
    tobi_system *s = NULL;
    TOBI_NEED(search, "where the search goes");
    TOBI_NEED_WORLD(w);
    TOBI_TRY(find_system(w, &s, err));
    describe_search(s, search);
    return TOBI_OK;
}

/* Calls visit for the rows of each cell in the order of the cells' numbers. */
typedef void visit_cell(void *user, int64_t cell, int64_t begin, int64_t end);
static void visit_cells(const tobi_system *s, visit_cell *visit, void *user)
{
    const tobi_cells *c = &s->cells;
    int64_t cell = 0;
    for (int z = 0; z < c->n[2]; z++)
        for (int y = 0; y < c->n[1]; y++) {
            const int32_t *start = c->start + tobi_cells_row(c, y, z);
            for (int x = 0; x < c->n[0]; x++) visit(user, cell++, start[x], start[x + 1]);
        }
}

static void note_cell(void *user, int64_t cell, int64_t begin, int64_t end)
{
    int64_t *of_row = user;
    for (int64_t i = begin; i < end; i++) of_row[i] = cell;
}

static tobi_status find_cells(const tobi_system *s, int64_t **cells, tobi_error *err)
{
    *cells = malloc((size_t)(s->particles.count + 1)*sizeof **cells);
    if (!*cells) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the cells of %lld particles",
                                  (long long)s->particles.count);
    visit_cells(s, note_cell, *cells);
    return TOBI_OK;
}

tobi_status tobi_world_cells(tobi_world *w, int64_t *cell, int64_t count, tobi_error *err)
{
    tobi_system *s = NULL;
    int64_t *of_row;
    TOBI_NEED(cell || count == 0, "where the cells go");
    TOBI_NEED_WORLD(w);
    TOBI_TRY(find_system(w, &s, err));
    if (count < s->particles.count)
        return tobi_fail(err, TOBI_INVALID, "there are cells of %lld particles, room for %lld given",
                         (long long)s->particles.count, (long long)count);
    TOBI_TRY(find_cells(s, &of_row, err));
    for (int64_t k = 0; k < s->particles.count; k++) cell[k] = of_row[s->row_of[k]];
    free(of_row);
    return TOBI_OK;
}

static tobi_status find_row(const tobi_system *s, int64_t id, int64_t *row, tobi_error *err)
{
    for (*row = 0; *row < s->particles.count; ++*row)
        if (s->first_id + s->particles.id[*row] == id) return TOBI_OK;
    return tobi_fail(err, TOBI_NOT_FOUND, "the fluid has no particle %lld", (long long)id);
}

static int order_ids(const void *a, const void *b)
{
    const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x > y) - (x < y);
}

/* The list is in groups of eight, filled up with the particle itself. */
static int64_t *list_neighbours(const tobi_system *s, int64_t row, int64_t *count)
{
    const tobi_cells *c = &s->cells;
    int32_t unpacked[TOBI_LIST_LIMIT];
    int entries;
    const int32_t *list = tobi_cells_neighbors(c, row, &entries, unpacked);
    int64_t *ids = malloc((size_t)(entries + 1)*sizeof *ids);
    *count = 0;
    for (int k = 0; ids && k < entries; k++)
        if (list[k] != row) ids[(*count)++] = s->first_id + s->particles.id[list[k]];
    if (ids) qsort(ids, (size_t)*count, sizeof *ids, order_ids);
    return ids;
}

tobi_status tobi_world_neighbours(tobi_world *w, int64_t id, int64_t *ids, int64_t room, int64_t *count,
                                  tobi_error *err)
{
    tobi_system *s = NULL;
    int64_t row;
    TOBI_NEED(count, "where the number of neighbours goes");
    TOBI_NEED(ids || room <= 0, "where the neighbours go");
    TOBI_NEED_WORLD(w);
    TOBI_TRY(find_system(w, &s, err));
    TOBI_TRY(find_row(s, id, &row, err));
    int64_t *all = list_neighbours(s, row, count);
    if (!all) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the neighbours of particle %lld",
                               (long long)id);
    for (int64_t k = 0; k < *count && k < room; k++) ids[k] = all[k];
    free(all);
    return TOBI_OK;
}

/* What is written: points with what is known of them. */
typedef struct points {
    int64_t count, room;
    double (*place)[3], *distance, *weight;
    int64_t *id, *cell;
} points;

static void free_points(points *p)
{
    free(p->place);
    free(p->distance);
    free(p->weight);
    free(p->id);
    free(p->cell);
}

static tobi_status make_points(points *p, int64_t room, tobi_error *err)
{
    const size_t n = (size_t)room + 1;
    *p = (points){ .room = room, .place = malloc(n*sizeof *p->place), .id = malloc(n*sizeof *p->id),
                   .distance = malloc(n*sizeof *p->distance), .weight = malloc(n*sizeof *p->weight),
                   .cell = malloc(n*sizeof *p->cell) };
    return p->place && p->id && p->distance && p->weight && p->cell
               ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %lld points", (long long)room);
}

/* One look into the search: from the particle of a row. */
typedef struct look {
    const tobi_system *s;
    tobi_search search;
    int64_t row;
    int64_t *cell;                  /* of each row */
    const char *dir;
} look;

/* Over the shorter way where sides are periodic, m. */
static double measure_distance(const look *k, int64_t i)
{
    const double *a = &k->s->particles.position[k->row].x, *b = &k->s->particles.position[i].x;
    double square = 0;
    for (int c = 0; c < 3; c++) {
        double d = b[c] - a[c];
        if (k->s->box.periodic[c]) d -= k->s->box.size[c]*nearbyint(d/k->s->box.size[c]);
        square += d*d;
    }
    return sqrt(square);
}

static void add_row(points *p, const look *k, int64_t i)
{
    const tobi_particles *q = &k->s->particles;
    const int64_t n = p->count++;
    for (int a = 0; a < 3; a++) p->place[n][a] = (&q->position[i].x)[a] + k->s->box.lower[a];
    p->id[n] = k->s->first_id + q->id[i];
    p->cell[n] = k->cell[i];
    p->distance[n] = measure_distance(k, i);
    p->weight[n] = tobi_kernel_value(k->search.kernel, k->s->box.dimension, k->search.support,
                                     p->distance[n]);
}

/* Whether the particle looks into a cell: its own and all that touch it. */
static int is_searched(const look *k, int64_t cell)
{
    const int *n = k->search.cells;
    const int64_t own = k->cell[k->row];
    const int64_t at[3] = { cell%n[0], cell/n[0]%n[1], cell/n[0]/n[1] };
    const int64_t from[3] = { own%n[0], own/n[0]%n[1], own/n[0]/n[1] };
    for (int a = 0; a < 3; a++) {
        int64_t steps = llabs(at[a] - from[a]);
        if (k->search.periodic[a] && n[a] - steps < steps) steps = n[a] - steps;
        if (steps > 1) return 0;
    }
    return 1;
}

static tobi_status write_file(const look *k, const points *p, const char *name, const tobi_vtk_array *array,
                              int arrays, tobi_error *err)
{
    const tobi_vtk_cells cells = { .corners = 1, .count = p->count, .points = (const double (*)[3])p->place,
                                   .arrays = array, .array_count = arrays };
    char *path = tobi_record_path(k->dir, "%s", name);
    const tobi_status status = path ? tobi_vtp_write_cells(path, TOBI_COMPRESS_ZLIB, &cells, err)
                                    : tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", name);
    free(path);
    return status;
}

static tobi_status write_points(const look *k, const points *p, const char *name, int arrays, tobi_error *err)
{
    const tobi_vtk_array array[] = { { "particle_id", TOBI_I64, 1, p->id }, { "cell", TOBI_I64, 1, p->cell },
                                     { "distance", TOBI_F64, 1, p->distance },
                                     { "weight", TOBI_F64, 1, p->weight } };
    return write_file(k, p, name, array, arrays, err);
}

/* all, center, inCell, each_cell: rows that a question answers with yes. */
typedef int ask_row(const look *k, int64_t i);
static int is_any(const look *k, int64_t i) { return (void)k, (void)i, 1; }
static int is_centre(const look *k, int64_t i) { return i == k->row; }
static int is_in_cell(const look *k, int64_t i) { return is_searched(k, k->cell[i]); }

static tobi_status write_rows(const look *k, points *p, ask_row *ask, const char *name, int arrays,
                              tobi_error *err)
{
    p->count = 0;
    for (int64_t i = 0; i < k->s->particles.count; i++)
        if (ask(k, k->s->row_of[i])) add_row(p, k, k->s->row_of[i]);
    return write_points(k, p, name, arrays, err);
}

static tobi_status write_sphere(const look *k, points *p, tobi_error *err)
{
    const tobi_cells *c = &k->s->cells;
    int32_t unpacked[TOBI_LIST_LIMIT];
    int entries;
    const int32_t *list = tobi_cells_neighbors(c, k->row, &entries, unpacked);
    p->count = 0;
    add_row(p, k, k->row);
    for (int n = 0; n < entries; n++)
        if (list[n] != k->row) add_row(p, k, list[n]);
    return write_points(k, p, "inSphere.vtp", 4, err);
}

typedef struct cell_writing { const look *k; points *p; int by_cell; } cell_writing;

/* All rows of the cell, or its middle with what it has. */
static void add_cell(void *user, int64_t cell, int64_t begin, int64_t end)
{
    const cell_writing *w = user;
    const tobi_search *s = &w->k->search;
    const int64_t at[3] = { cell%s->cells[0], cell/s->cells[0]%s->cells[1], cell/s->cells[0]/s->cells[1] };
    for (int64_t i = begin; !w->by_cell && i < end; i++) add_row(w->p, w->k, i);
    if (!w->by_cell || begin == end) return;
    const int64_t n = w->p->count++;
    for (int a = 0; a < 3; a++) w->p->place[n][a] = s->lower[a] + ((double)at[a] + 0.5)*s->width[a];
    w->p->cell[n] = cell;
    w->p->id[n] = end - begin;
    w->p->distance[n] = is_searched(w->k, cell);
}

static tobi_status write_cells(const look *k, points *p, tobi_error *err)
{
    p->count = 0;
    visit_cells(k->s, add_cell, &(cell_writing){ k, p, 0 });
    TOBI_TRY(write_points(k, p, "each_cell.vtp", 2, err));
    p->count = 0;
    visit_cells(k->s, add_cell, &(cell_writing){ k, p, 1 });
    const tobi_vtk_array array[] = { { "cell", TOBI_I64, 1, p->cell }, { "particles", TOBI_I64, 1, p->id },
                                     { "searched", TOBI_F64, 1, p->distance } };
    return write_file(k, p, "each_cell_position.vtp", array, 3, err);
}

static tobi_status write_all(const look *k, points *p, tobi_error *err)
{
    TOBI_TRY(write_rows(k, p, is_any, "all.vtp", 2, err));
    TOBI_TRY(write_rows(k, p, is_centre, "center.vtp", 2, err));
    TOBI_TRY(write_rows(k, p, is_in_cell, "inCell.vtp", 4, err));
    TOBI_TRY(write_sphere(k, p, err));
    return write_cells(k, p, err);
}

tobi_status tobi_world_write_search(tobi_world *w, int64_t id, const char *dir, tobi_error *err)
{
    tobi_system *s = NULL;
    points p = { 0 };
    TOBI_NEED(dir, "the directory");
    TOBI_NEED_WORLD(w);
    TOBI_TRY(find_system(w, &s, err));
    look k = { .s = s, .dir = dir };
    describe_search(s, &k.search);
    TOBI_TRY(find_row(s, id, &k.row, err));
    TOBI_TRY(tobi_record_make_dir(dir, "", err));
    tobi_status status = find_cells(s, &k.cell, err);
    if (status == TOBI_OK) status = make_points(&p, s->particles.count, err);
    if (status == TOBI_OK) status = write_all(&k, &p, err);
    free_points(&p);
    free(k.cell);
    return status;
}

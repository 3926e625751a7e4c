#include "core/cells.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CACHED_CELLS = 700 };   /* cells of one layer of a strip that stay in a core's cache */

void tobi_box_init(tobi_box *b, int dimension, const double lower[3], const double upper[3],
                   const int periodic[3], double h)
{
    memset(b, 0, sizeof *b);
    b->dimension = dimension;
    for (int a = 0; a < 3; a++) {
        int flat = a == 2 && dimension == 2;
        b->lower[a] = flat ? 0 : lower[a];
        b->size[a] = flat ? h : upper[a] - lower[a];
        b->periodic[a] = flat ? 0 : periodic[a];
        /* A periodic side is 2^32 units, so that differences wrap; a walled one 2^30, so that they
         * never do. */
        b->to_fixed[a] = (b->periodic[a] ? 4294967296.0 : 1073741824.0)/b->size[a];
        b->from_fixed[a] = (float)(1/b->to_fixed[a]);
        b->centre[a] = flat ? 0 : 0.5*b->size[a];
    }
}

/* Enough cells of at least h; wider ones when the box is vast and empty. */
static void choose_cells(tobi_cells *c, const tobi_box *box, double h, int64_t particles)
{
    double wide = h*(1 + 1e-6);
    for (;; wide *= 1.26) {
        double total = 1;
        for (int a = 0; a < 3; a++) {
            double n = floor(box->size[a]/wide);
            c->n[a] = n < 1 ? 1 : n > 1e6 ? 1000000 : (int)n;
            total *= c->n[a];
        }
        if (total <= 4.0*(double)particles + 4096) break;
    }
    for (int a = 0; a < 3; a++) {
        c->inverse[a] = c->n[a]/box->size[a];
        c->periodic[a] = box->periodic[a];
    }
    int strip = CACHED_CELLS/c->n[0];
    c->strip = strip < 4 ? 4 : strip;
    if (c->strip > c->n[1]) c->strip = c->n[1];
    int strips = (c->n[1] + c->strip - 1)/c->strip;
    c->total = (int64_t)strips*c->strip*c->n[2]*c->n[0];
}

/* The list doubles as scratch of the sort: keys, order and their copies, or one widest state field. */
static int64_t scratch_entries(int64_t particles)
{
    int64_t sort = 4*particles, widest = tobi_particles_widest(TOBI_ALL | TOBI_SPH);
    int64_t permute = particles + particles*widest/4 + 64;
    return sort > permute ? sort : permute;
}

tobi_status tobi_cells_create(tobi_cells *c, const tobi_box *box, double h, int64_t particles,
                              const tobi_exec *x, tobi_error *err)
{
    memset(c, 0, sizeof *c);
    for (int a = 0; a < 3; a++)
        if (box->periodic[a] && box->size[a] < 3.001*h)
            return tobi_fail(err, TOBI_INVALID,
                             "the periodic domain is %g m along %c, allowed is at least three "
                             "support radii (%g m)",
                             box->size[a], "xyz"[a], 3 * h);
    choose_cells(c, box, h, particles);
    c->list_capacity = scratch_entries(particles) + 16;
    int64_t guess = particles*36 + 4096;
    if (guess > c->list_capacity) c->list_capacity = guess;
    c->start = malloc((size_t)(c->total + 1)*sizeof *c->start);
    c->histogram = malloc((size_t)tobi_sort_histogram_size(x)*sizeof *c->histogram);
    c->list = aligned_alloc(64, (size_t)(c->list_capacity*4 + 63)/64*64);
    if (c->start && c->histogram && c->list) return TOBI_OK;
    tobi_cells_free(c);
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld cells and the neighbour list",
                     (long long)c->total);
}

void tobi_cells_free(tobi_cells *c)
{
    free(c->start);
    free(c->histogram);
    free(c->list);
    memset(c, 0, sizeof *c);
}

static int cell_along(const tobi_cells *c, int axis, double x)
{
    int k = (int)floor(x*c->inverse[axis]);
    return k < 0 ? 0 : k >= c->n[axis] ? c->n[axis] - 1 : k;
}

static void wrap(const tobi_box *box, tobi_double3 *x)
{
    double *v = &x->x;
    for (int a = 0; a < 3; a++)
        if (box->periodic[a]) {
            if (v[a] < 0) v[a] += box->size[a];
            if (v[a] >= box->size[a]) v[a] -= box->size[a];
            if (v[a] < 0 || v[a] >= box->size[a]) v[a] -= box->size[a]*floor(v[a]/box->size[a]);
        }
}

static int32_t to_fixed(const tobi_box *box, int axis, double x)
{
    return (int32_t)(uint32_t)(int64_t)llrint((x - box->centre[axis])*box->to_fixed[axis]);
}

/* What the loops of a sort read and write. */
typedef struct sorting {
    const tobi_cells *cells;
    const tobi_box *box;
    tobi_particles *particles;
    uint32_t *keys;
} sorting;

static void find_keys(const void *view, int64_t begin, int64_t end)
{
    const sorting *s = view;
    const tobi_cells *c = s->cells;
    for (int64_t i = begin; i < end; i++) {
        tobi_double3 *x = &s->particles->position[i];
        wrap(s->box, x);
        int64_t row = tobi_cells_row(c, cell_along(c, 1, x->y), cell_along(c, 2, x->z));
        s->keys[i] = (uint32_t)(row + cell_along(c, 0, x->x));
    }
}

/* Over the particles and one place behind them. */
static void fill_starts(const void *view, int64_t begin, int64_t end)
{
    const sorting *s = view;
    for (int64_t k = begin; k < end; k++) {
        int64_t before = k > 0 ? (int64_t)s->keys[k - 1] : -1;
        int64_t here = k < s->particles->count ? (int64_t)s->keys[k] : s->cells->total;
        for (int64_t cell = before + 1; cell <= here; cell++) s->cells->start[cell] = (int32_t)k;
    }
}

static void make_records(const void *view, int64_t begin, int64_t end)
{
    const sorting *s = view;
    const tobi_particles *p = s->particles;
    for (int64_t i = begin; i < end; i++) {
        tobi_double3 q = p->position[i];
        p->record[i] = (tobi_record){to_fixed(s->box, 0, q.x), to_fixed(s->box, 1, q.y),
                                     to_fixed(s->box, 2, q.z), p->pressure[i]};
    }
}

void tobi_cells_sort(tobi_cells *c, const tobi_box *box, tobi_particles *p, tobi_exec *x)
{
    int64_t n = p->count;
    uint32_t *keys = (uint32_t *)c->list, *key_copy = keys + n;
    int32_t *order_copy = (int32_t *)(key_copy + n), *order = order_copy + n;
    const sorting view = {c, box, p, keys};
    tobi_loop(x->threads, n, 0, find_keys, &view);
    tobi_sort_by_key(x, n, (uint32_t)c->total, keys, order, key_copy, order_copy, c->histogram);
    tobi_loop(x->threads, n + 1, 0, fill_starts, &view);
    memmove(c->list, order, (size_t)n*sizeof *order);
    char *scratch = (char *)c->list + ((size_t)n*sizeof *order + 63)/64*64;
    tobi_particles_permute(p, c->list, scratch, x->threads);
    tobi_loop(x->threads, n, 0, make_records, &view);
}

tobi_cell_points tobi_cells_points(const tobi_cells *c, const tobi_box *box, const tobi_particles *p)
{
    tobi_cell_points q = {.dimension = box->dimension, .strip = c->strip, .start = c->start,
                          .position = p->position, .count = p->count};
    memcpy(q.n, c->n, sizeof q.n);
    memcpy(q.periodic, c->periodic, sizeof q.periodic);
    memcpy(q.inverse, c->inverse, sizeof q.inverse);
    return q;
}

static tobi_status grow_list(tobi_cells *c, tobi_error *err)
{
    int64_t more = c->list_capacity + c->list_capacity/8;
    int32_t *list = aligned_alloc(64, (size_t)(more*4 + 63)/64*64);
    if (!list) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld neighbours", (long long)more);
    free(c->list);
    c->list = list;
    c->list_capacity = more;
    return TOBI_OK;
}

tobi_status tobi_cells_list(tobi_cells *c, const tobi_box *box, double h, tobi_particles *p, tobi_exec *x,
                            tobi_error *err)
{
    static const tobi_kernel search[] = {tobi_neighbors_v2, tobi_neighbors_v3, tobi_neighbors_v4};
    for (;;) {
        int overflow = 0;
        c->list_used = 0;
        tobi_list_view v = {
            .cells = c, .record = p->record, .position = p->position, .list = c->list,
            .list_start = p->list_start, .list_groups = p->list_groups,
            .capacity = c->list_capacity, .used = &c->list_used, .overflow = &overflow,
            .from_fixed = {box->from_fixed[0], box->from_fixed[1], box->from_fixed[2]}, .h2 = (float)(h*h),
        };
        tobi_launch(x, search[x->isa - 2], &v, 0, p->count, NULL);
        if (overflow == 2)
            return tobi_fail(err, TOBI_DIVERGED,
                             "more than 1000 particles crowd into one support radius");
        if (overflow == 0) return TOBI_OK;
        TOBI_TRY(grow_list(c, err));
    }
}

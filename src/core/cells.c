/* Particles are sorted by cell in every step, then searched: neighbours lie side by side in memory.
   The list is the scratch of the sort. Drawback: cells are as wide as the widest kernel needs
   everywhere. */
#include "core/cells.h"
#include "core/cells.k.h"
#include "core/kernels.h"
#include <math.h>
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
void tobi_cells_plan(tobi_cells *c, const tobi_box *box, double h, int64_t particles)
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
static int64_t scratch_entries(int64_t particles, int64_t widest)
{
    int64_t sort = 4*particles;
    int64_t permute = particles + particles*widest/4 + 64;
    return sort > permute ? sort : permute;
}

static tobi_status give_up(tobi_cells *c, tobi_error *err)
{
    const long long total = (long long)c->total;
    tobi_cells_free(c);
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld cells and the neighbour list", total);
}

/* Nothing is kept: all is made anew after the next sort. */
tobi_status tobi_cells_grow(tobi_cells *c, const tobi_particles *p, tobi_error *err)
{
    const int64_t n = p->capacity, sort = 4*(scratch_entries(n, tobi_particles_widest(p)) + 16);
    const int64_t guess = TOBI_CELLS_LIST*n + 8192, bytes = sort > guess ? sort : guess;
    if (!c->record || c->rows < n) {
        tobi_array_free(c->record);
        tobi_array_free(c->list_start);
        tobi_array_free(c->list_groups);
        tobi_array_free(c->list_far);
        tobi_array_free(c->region);
        c->rows = n;
        c->regions = 0;
        c->record = tobi_particles_rows(n, sizeof *c->record);
        c->list_start = tobi_particles_rows(n, sizeof *c->list_start);
        c->list_groups = tobi_particles_rows(n, sizeof *c->list_groups);
        c->list_far = c->wide ? NULL : tobi_particles_rows(n, sizeof *c->list_far);
        c->region = tobi_array_zero(n/TOBI_BLOCK + 1, sizeof *c->region);
    }
    if (!c->list || c->list_bytes < bytes) {
        tobi_array_free(c->list);
        c->list_bytes = bytes;
        c->list = tobi_array_make(bytes, 1);
    }
    const int far = c->list_far || c->wide;
    return c->record && c->list_start && c->list_groups && far && c->region && c->list ? TOBI_OK
                                                                                       : give_up(c, err);
}

tobi_status tobi_cells_create(tobi_cells *c, const tobi_box *box, double h, const tobi_particles *p,
                              const tobi_exec *x, tobi_error *err)
{
    memset(c, 0, sizeof *c);
    for (int a = 0; a < 3; a++)
        if (box->periodic[a] && box->size[a] < 3.001*h)
            return tobi_fail(err, TOBI_INVALID,
                             "the periodic domain is %g m along %c, allowed is at least three "
                             "support radii (%g m)",
                             box->size[a], "xyz"[a], 3 * h);
    tobi_cells_plan(c, box, h, p->capacity);
    c->start = tobi_array_make(c->total + 1, sizeof *c->start);
    c->histogram = tobi_array_make(tobi_sort_histogram_size(x), sizeof *c->histogram);
    if (!c->start || !c->histogram) return give_up(c, err);
    return tobi_cells_grow(c, p, err);
}

void tobi_cells_free(tobi_cells *c)
{
    tobi_array_free(c->start);
    tobi_array_free(c->histogram);
    tobi_array_free(c->list);
    tobi_array_free(c->record);
    tobi_array_free(c->list_start);
    tobi_array_free(c->list_groups);
    tobi_array_free(c->list_far);
    tobi_array_free(c->region);
    memset(c, 0, sizeof *c);
}

static tobi_cells_view see_cells(const tobi_cells *c, const tobi_box *box, const tobi_particles *p)
{
    tobi_cells_view v = {
        .count = p->count, .strip = c->strip, .total = c->total, .start = c->start,
        .keys = c->list, .position = p->position, .record = c->record,
        .list_start = c->list_start, .list_groups = c->list_groups, .list_far = c->list_far,
    };
    memcpy(v.n, c->n, sizeof v.n);
    memcpy(v.periodic, c->periodic, sizeof v.periodic);
    memcpy(v.inverse, c->inverse, sizeof v.inverse);
    memcpy(v.size, box->size, sizeof v.size);
    memcpy(v.centre, box->centre, sizeof v.centre);
    memcpy(v.to_fixed, box->to_fixed, sizeof v.to_fixed);
    memcpy(v.from_fixed, box->from_fixed, sizeof v.from_fixed);
    return v;
}

void tobi_cells_sort(tobi_cells *c, const tobi_box *box, tobi_particles *p, const float *payload,
                     tobi_exec *x)
{
    int64_t n = p->count;
    const tobi_core_kernels *k = tobi_core_kernels_for(x->isa);
    tobi_cells_view v = see_cells(c, box, p);
    v.payload = payload;
    uint32_t *keys = v.keys, *key_copy = keys + n;
    int32_t *order_copy = (int32_t *)(key_copy + n), *order = order_copy + n;
    tobi_launch(x, k->cells_key, &v, 0, n, NULL);
    tobi_sort_by_key(x, n, (uint32_t)c->total, keys, order, key_copy, order_copy, c->histogram);
    tobi_launch(x, k->cells_start, &v, 0, n + 1, NULL);
    memmove(c->list, order, (size_t)n*sizeof *order);
    char *scratch = (char *)c->list + ((size_t)n*sizeof *order + 63)/64*64;
    tobi_particles_permute(p, c->list, scratch, x->threads);
    tobi_launch(x, k->cells_record, &v, 0, n, NULL);
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

/* Entries that there is room for. */
static int64_t list_room(const tobi_cells *c) { return c->list_bytes/(int64_t)tobi_list_size(c->list_far); }

/* A list that has grown so often is that of a world in which rows come and go. */
enum { GROWTHS = 4 };

/* What is left free: one part of so many. Lists are by far the longest arrays, and what a search needs
   changes slowly; but where rows come and go, they move on to other blocks. */
static uint32_t find_slack(const tobi_cells *c) { return c->growths < GROWTHS ? 64 : 20; }

/* Nothing is copied. */
static tobi_status grow_list(tobi_cells *c, int64_t entries, tobi_error *err)
{
    const int64_t more = entries + entries/find_slack(c), size = (int64_t)tobi_list_size(c->list_far);
    void *list = tobi_array_make(more, (size_t)size);
    if (!list) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld neighbours", (long long)more);
    tobi_array_free(c->list);
    c->list = list;
    c->list_bytes = more*size;
    c->growths++;
    return TOBI_OK;
}

void tobi_cells_widen(tobi_cells *c)
{
    tobi_array_free(c->list_far);
    c->list_far = NULL;
    c->wide = 1;
}

/* What blocks need that no search knows of: as much as the others, or an equal part of the list. */
static void guess_needs(tobi_cells *c, int64_t blocks)
{
    int64_t sum = 0;
    for (int64_t b = 0; b < c->regions; b++) sum += c->region[b].groups;
    const int64_t guess = c->regions ? sum/c->regions : list_room(c)/8/(blocks + blocks/32 + 1);
    for (int64_t b = c->regions; b < blocks; b++) c->region[b].groups = (uint32_t)guess;
    c->regions = blocks;
}

/* Regions one after the other, a little longer than the blocks needed last; returns where they end. */
static int64_t place_regions(tobi_cells *c, int64_t blocks)
{
    int64_t at = 0;
    for (int64_t b = 0; b < blocks; b++) {
        tobi_list_region *r = &c->region[b];
        const uint32_t room = r->groups + r->groups/find_slack(c) + 1;
        *r = (tobi_list_region){ .begin = at, .room = room, .groups = r->groups };
        at += r->room;
    }
    return at;
}

/* Regions from `at` on for the blocks that have outgrown theirs; returns where they end. */
static int64_t move_regions(tobi_cells *c, int64_t blocks, int64_t at)
{
    for (int64_t b = 0; b < blocks; b++) {
        tobi_list_region *r = &c->region[b];
        if (r->filled) continue;
        r->begin = at;
        r->room = r->groups;
        at += r->room;
    }
    return at;
}

/* Blocks keep the room that they needed last, so that one search counts and fills; few outgrow it and are
   searched again. Where the lists lie depends on the steps before, what is in them does not. */
tobi_status tobi_cells_list(tobi_cells *c, const tobi_box *box, double h, tobi_particles *p, tobi_exec *x,
                            tobi_error *err)
{
    const int64_t blocks = (p->count + TOBI_BLOCK - 1)/TOBI_BLOCK;
    const tobi_kernel search = tobi_core_kernels_for(x->isa)->cells_search;
    tobi_cells_view v = see_cells(c, box, p);
    int overflow = 0, far_apart = 0;
    v.h2 = (float)(h*h);
    v.overflow = &overflow;
    v.far_apart = &far_apart;
    v.region = c->region;
    guess_needs(c, blocks);
    for (;;) {
        int64_t end = place_regions(c, blocks), last = end;
        if (8*end > list_room(c)) TOBI_TRY(grow_list(c, 8*end, err));
        v.list = c->list;
        v.list_far = c->list_far;
        far_apart = 0;
        do {
            end = last;
            tobi_launch(x, search, &v, 0, p->count, NULL);
            if (overflow)
                return tobi_fail(err, TOBI_DIVERGED,
                                 "more than 1000 particles crowd into one support radius");
            last = move_regions(c, blocks, end);
        } while (last > end && 8*last <= list_room(c) && !far_apart);
        c->list_used = 8*end;
        if (last == end && !far_apart) return TOBI_OK;
        if (far_apart) tobi_cells_widen(c);
    }
}

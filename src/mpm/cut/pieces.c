/* Pairs by hashed cells, pieces by a forest of rows: a link hangs the root of the higher row under the lower
   one, so that the roots do not depend on the order of the links (Jayanti and Tarjan 2016, PODC, without
   their random order). */
#include "mpm/cut/pieces.h"
#include "mpm/cut/cuts.h"
#include "mpm/particle_fields.h"
#include <math.h>
#include <stdlib.h>

#define REACH 1.5                      /* spacings */

typedef struct search {
    const tobi_particles *particles;
    const tobi_solid *solids;
    int dimension;
    double reach;                      /* m                                                        */
    double low[3];                     /* m, lower corner of all places                            */
    uint64_t stride[3];                /* of cells in keys                                         */
    uint32_t mask;                     /* buckets - 1                                              */
    tobi_double3 *place;               /* where particles are looked for, sorted by bucket         */
    uint32_t *key;
    int32_t *row, *start, *parent;     /* sorted rows; first of each bucket; the forest, by row    */
} search;

static int keeps_neighbors(const search *f, int64_t row)
{
    const int model = f->solids[f->particles->fluid[row]].def.model;
    return model == TOBI_NEO_HOOKEAN || model == TOBI_COROTATED;
}

static tobi_double3 find_place(const search *f, int64_t row)
{
    const tobi_float4 *rest = &mpm_fields_of(f->particles)->rest[row];
    return keeps_neighbors(f, row) ? (tobi_double3){rest->x, rest->y, rest->z} : f->particles->position[row];
}

/* NaN and what is too far away to be counted go to cell 0: they link to nothing. */
static void find_cell(const search *f, const tobi_double3 *x, int64_t cell[3])
{
    for (int a = 0; a < 3; a++) {
        double c = floor(((&x->x)[a] - f->low[a])/f->reach);
        cell[a] = c > -1e15 && c < 1e15 ? (int64_t)c : 0;
    }
}

static uint32_t find_key(const search *f, const int64_t cell[3])
{
    uint64_t key = 0;
    for (int a = 0; a < 3; a++) key += (uint64_t)cell[a]*f->stride[a];
    return (uint32_t)key & f->mask;
}

/* Rows of cells in memory order if their box fits into the buckets; otherwise a hash (Teschner et al. 2003),
   and a clash only costs time. */
static void choose_strides(search *f, int64_t n)
{
    double high[3] = {-INFINITY, -INFINITY, -INFINITY}, cells = 1, wide[3];
    uint64_t buckets = 1024;
    while (buckets < 4*(uint64_t)n && buckets < UINT64_C(1) << 30) buckets *= 2;
    for (int a = 0; a < 3; a++) f->low[a] = INFINITY;
    for (int64_t i = 0; i < n; i++) {
        const tobi_double3 x = find_place(f, i);
        for (int a = 0; a < 3; a++) {
            if ((&x.x)[a] < f->low[a]) f->low[a] = (&x.x)[a];
            if ((&x.x)[a] > high[a]) high[a] = (&x.x)[a];
        }
    }
    for (int a = 0; a < 3; a++) {
        if (!isfinite(f->low[a])) f->low[a] = 0;
        wide[a] = floor((high[a] - f->low[a])/f->reach) + 2;
        cells *= wide[a];
    }
    int fits = cells < (double)buckets;                    /* NaN does not */
    f->stride[0] = fits ? 1 : 73856093;
    f->stride[1] = fits ? (uint64_t)wide[0] : 19349663;
    f->stride[2] = fits ? (uint64_t)wide[0]*(uint64_t)wide[1] : 83492791;
    f->mask = (uint32_t)(buckets - 1);
}

static void free_search(search *f)
{
    free(f->place);
    free(f->key);
    free(f->row);
    free(f->start);
    free(f->parent);
}

static void find_keys(const void *view, int64_t begin, int64_t end)
{
    const search *f = view;
    for (int64_t i = begin; i < end; i++) {
        int64_t cell[3];
        const tobi_double3 place = find_place(f, i);
        find_cell(f, &place, cell);
        f->key[i] = find_key(f, cell);
        f->parent[i] = (int32_t)i;
    }
}

/* Over the rows and one place behind them. */
static void fill_starts(const void *view, int64_t begin, int64_t end)
{
    const search *f = view;
    for (int64_t k = begin; k < end; k++) {
        if (k < f->particles->count) f->place[k] = find_place(f, f->row[k]);
        for (uint64_t b = k ? (uint64_t)f->key[k - 1] + 1 : 0; b <= f->key[k]; b++)
            f->start[b] = (int32_t)k;
    }
}

static tobi_status sort_by_cell(search *f, tobi_exec *x, int64_t n, tobi_error *err)
{
    const size_t rows = (size_t)n + 1;
    uint32_t *spare_key = malloc(rows*sizeof *spare_key);
    int32_t *spare_row = malloc(rows*sizeof *spare_row);
    int64_t *histogram = malloc((size_t)tobi_sort_histogram_size(x)*sizeof *histogram);
    f->place = malloc(rows*sizeof *f->place);
    f->key = malloc(rows*sizeof *f->key);
    f->row = malloc(rows*sizeof *f->row);
    f->parent = malloc(rows*sizeof *f->parent);
    f->start = malloc(((size_t)f->mask + 2)*sizeof *f->start);
    int whole = spare_key && spare_row && histogram && f->place && f->key && f->row && f->parent && f->start;
    if (whole) {
        tobi_loop(x->threads, n, 0, find_keys, f);
        tobi_sort_by_key(x, n, f->mask, f->key, f->row, spare_key, spare_row, histogram);
        f->key[n] = f->mask + 1;
        tobi_loop(x->threads, n + 1, 0, fill_starts, f);
    }
    free(spare_key);
    free(spare_row);
    free(histogram);
    return whole ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory to find the pieces of solids");
}

static int32_t find_root(int32_t *parent, int32_t i)
{
    int32_t up = __atomic_load_n(&parent[i], __ATOMIC_RELAXED);
    while (up != i) {
        int32_t next = __atomic_load_n(&parent[up], __ATOMIC_RELAXED);
        __atomic_store_n(&parent[i], next, __ATOMIC_RELAXED);       /* i is no root and never becomes one */
        i = up;
        up = next;
    }
    return i;
}

static void join(int32_t *parent, int32_t a, int32_t b)
{
    for (;;) {
        a = find_root(parent, a);
        b = find_root(parent, b);
        if (a == b) return;
        int32_t high = a > b ? a : b, low = a > b ? b : a;
        if (__atomic_compare_exchange_n(&parent[high], &high, low, 0, __ATOMIC_RELAXED, __ATOMIC_RELAXED))
            return;
    }
}

/* Across a crack the deformation of particles is the width of the crack. */
static int is_cracked(const search *f, int64_t i)
{
    const mpm_fields *own = mpm_fields_of(f->particles);
    return f->solids[f->particles->fluid[i]].def.strength > 0 && own->strain[i].c[1].w > 0.9f;
}

/* 1 if two particles that were neighbours at rest have been pulled apart. */
static int is_torn(const search *f, int64_t i, int64_t j)
{
    const tobi_particles *p = f->particles;
    const mpm_fields *fields = mpm_fields_of(p);
    const tobi_columns *e = &fields->strain[i], *g = &fields->strain[j];
    const double spacing = f->reach/REACH;
    double now = 0, meant = 0, rest[3];
    for (int a = 0; a < 3; a++) rest[a] = (double)(&fields->rest[j].x)[a] - (&fields->rest[i].x)[a];
    for (int a = 0; a < 3; a++) {
        double x = (&p->position[j].x)[a] - (&p->position[i].x)[a], y = rest[a];
        for (int c = 0; c < 3; c++) y += 0.5*((&e->c[c].x)[a] + (&g->c[c].x)[a])*rest[c];
        now += x*x;
        meant += y*y;
    }
    if (is_cracked(f, i) || is_cracked(f, j)) meant = 0;
    return !(now <= REACH*REACH*fmax(meant, spacing*spacing));
}

/* Whether a pair within reach is linked. */
static int holds(const search *f, int64_t i, int64_t j)
{
    const tobi_particles *p = f->particles;
    const mpm_fields *fields = mpm_fields_of(p);
    if (p->fluid[i] != p->fluid[j] || f->solids[p->fluid[i]].def.model == TOBI_LIQUID) return 0;
    if (fields->cuts && tobi_cuts_apart(&fields->cuts[i], &fields->cuts[j])) return 0;
    return !keeps_neighbors(f, i) || !is_torn(f, i, j);
}

/* Links the k-th particle with those behind it in its own bucket, and with all of the 13 cells ahead. */
static void link_particle(const search *f, int64_t k)
{
    const tobi_double3 x = f->place[k];
    int64_t cell[3];
    find_cell(f, &x, cell);
    for (int o = 13; o < 27; o++) {
        const int64_t at[3] = {cell[0] + o%3 - 1, cell[1] + o/3%3 - 1, cell[2] + o/9 - 1};
        if (f->dimension == 2 && o/9 != 1) break;
        const uint32_t key = find_key(f, at);
        for (int64_t l = o == 13 ? k + 1 : f->start[key]; l < f->start[key + 1]; l++) {
            double dx = f->place[l].x - x.x, dy = f->place[l].y - x.y, dz = f->place[l].z - x.z;
            if (!(dx*dx + dy*dy + dz*dz <= f->reach*f->reach)) continue;
            if (find_root(f->parent, f->row[k]) == find_root(f->parent, f->row[l])) continue;
            if (holds(f, f->row[k], f->row[l])) join(f->parent, f->row[k], f->row[l]);
        }
    }
}

static void link_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    (void)totals;
    for (int64_t k = begin; k < end; k++) link_particle(view, k);
}

/* Numbers the trees by their smallest id into list->of; returns how many there are. */
static int64_t number_trees(const search *f, int64_t n, const int32_t *row_of, tobi_piece_list *list)
{
    int32_t *number = f->row, count = 0;                   /* by root; the rows are not needed any more */
    for (int64_t i = 0; i < n; i++) number[i] = -1;
    for (int64_t r = 0; r < n; r++) {
        const int32_t i = row_of[r], root = find_root(f->parent, i);
        int liquid = f->solids[f->particles->fluid[i]].def.model == TOBI_LIQUID;
        if (!liquid && number[root] < 0) number[root] = count++;
        list->of[i] = number[root];
    }
    return count;
}

/* A piece and its number before it was ranked. */
typedef struct ranked { tobi_piece piece; int32_t was; } ranked;

/* Sums in the order of ids, whatever the rows' order. */
static void sum_pieces(const tobi_system *s, const int32_t *row_of, const double *volume,
                       const int32_t *of, ranked *found)
{
    const tobi_particles *p = &s->particles;
    for (int64_t r = 0; r < p->count; r++) {
        const int64_t i = row_of[r];
        if (of[i] < 0) continue;
        tobi_piece *piece = &found[of[i]].piece;
        const double mass = mpm_fields_of(p)->strain[i].c[2].w;
        if (piece->particles++ == 0) {
            piece->first_id = p->id[i];
            piece->solid = p->fluid[i];
        }
        piece->mass += mass;
        piece->volume += volume[i];
        for (int a = 0; a < 3; a++) piece->centre[a] += mass*((&p->position[i].x)[a] + s->box.lower[a]);
    }
}

static int compare(const void *left, const void *right)
{
    const tobi_piece *a = &((const ranked *)left)->piece, *b = &((const ranked *)right)->piece;
    if (a->fragment != b->fragment) return a->fragment - b->fragment;
    if (a->mass != b->mass) return a->mass < b->mass ? 1 : -1;
    return (a->first_id > b->first_id) - (a->first_id < b->first_id);
}

/* Orders the pieces and gives the rows their new numbers; `number` holds one per piece. */
static void rank_pieces(const tobi_system *s, ranked *found, int64_t count, int32_t *number,
                        tobi_piece_list *list)
{
    for (int64_t k = 0; k < count; k++) {
        tobi_piece *piece = &found[k].piece;
        found[k].was = (int32_t)k;
        piece->fragment = piece->particles < tobi_pieces_least(s->box.dimension);
        for (int a = 0; a < 3; a++) piece->centre[a] /= piece->mass;
    }
    qsort(found, (size_t)count, sizeof *found, compare);
    for (int64_t k = 0; k < count; k++) {
        const tobi_piece *piece = &found[k].piece;
        list->piece[k] = *piece;
        list->found.fragments += piece->fragment;
        list->found.mass += piece->mass;
        list->found.volume += piece->volume;
        number[found[k].was] = (int32_t)k;
    }
    list->found.count = count - list->found.fragments;
    list->found.piece = list->piece;
    for (int64_t i = 0; i < s->particles.count; i++)
        if (list->of[i] >= 0) list->of[i] = number[list->of[i]];
}

typedef struct reading { const tobi_system *s; double *volume; } reading;

static void read_volumes(const void *view, int64_t begin, int64_t end)
{
    const reading *r = view;
    for (int64_t i = begin; i < end; i++) {
        double ratio[9];
        r->s->method->read(r->s, "J", i, ratio);
        r->volume[i] = ratio[0]*mpm_fields_of(&r->s->particles)->strain[i].c[0].w;
    }
}

static tobi_status list_pieces(tobi_system *s, const int32_t *row_of, search *f, tobi_piece_list *list,
                               tobi_error *err)
{
    const int64_t n = s->particles.count, count = number_trees(f, n, row_of, list);
    double *volume = malloc((size_t)(n + 1)*sizeof *volume);
    ranked *found = calloc((size_t)count + 1, sizeof *found);
    list->piece = calloc((size_t)count + 1, sizeof *list->piece);
    tobi_status status = volume && found && list->piece
        ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld pieces of solids", (long long)count);
    if (status == TOBI_OK) {
        const reading view = {s, volume};
        tobi_loop(s->sim->exec.threads, n, 0, read_volumes, &view);
        sum_pieces(s, row_of, volume, list->of, found);
        rank_pieces(s, found, count, f->row, list);
    }
    free(volume);
    free(found);
    return status;
}

tobi_status tobi_pieces_find(tobi_system *s, const int32_t *row_of, tobi_piece_list *list, tobi_error *err)
{
    const int64_t n = s->particles.count;
    search f = {.particles = &s->particles, .solids = s->solids, .dimension = s->box.dimension,
                .reach = REACH*s->smoothing.spacing};
    *list = (tobi_piece_list){.of = malloc((size_t)(n + 1)*sizeof *list->of)};
    tobi_status status = list->of ? TOBI_OK
                                  : tobi_fail(err, TOBI_NO_MEMORY, "no memory for the pieces of solids");
    choose_strides(&f, n);
    if (status == TOBI_OK) status = sort_by_cell(&f, &s->sim->exec, n, err);
    if (status == TOBI_OK) {
        tobi_launch(&s->sim->exec, TOBI_HOST(link_range, 0, 0), &f, 0, n, NULL);
        status = list_pieces(s, row_of, &f, list, err);
    }
    free_search(&f);
    if (status != TOBI_OK) tobi_pieces_free(list);
    return status;
}

void tobi_pieces_free(tobi_piece_list *list)
{
    free(list->piece);
    free(list->of);
    *list = (tobi_piece_list){ 0 };
}

/* Water in cells as wide as its kernel reaches, sorted, so that a search reads runs of memory. Walls are the
   sides of the domain: water nearer than the reach has an image there. Drawback: cells cover the box of the
   water, so that a drop far away makes many empty ones; beyond a limit they become wider. */
#include "view/foam/foam.h"
#include <stdlib.h>
#include <string.h>

enum { PART = 4096 };            /* rows of one minimum and maximum */
#define MOST_CELLS (1 << 24)

void foam_free_cells(foam_cells *c)
{
    void *const arrays[] = { c->begin, c->place, c->move, c->of, c->place_raw, c->move_raw, c->of_raw,
                             c->order, c->order2, c->key, c->key2, c->first, c->histogram };
    for (size_t k = 0; k < sizeof arrays/sizeof *arrays; k++) tobi_array_free(arrays[k]);
    *c = (foam_cells){ 0 };
}

/* A fill of the cells. */
typedef struct fill_view {
    const tobi_foam *f;
    const foam_water *before, *after;
    double s;
    foam_cells *c;
    double (*bounds)[6];
} fill_view;

/* Place and velocity of a row; false: it is not there. Between outputs the cubic curve. */
bool foam_find_row(const foam_water *a, const foam_water *b, double s, int64_t i, double x[3], double u[3])
{
    const int64_t j = b ? a->partner[i] : i;
    const double t = 1 - s, dt = b ? b->time - a->time : 0;
    if (j < 0) return false;
    if (!b) memcpy(x, a->x[i], 3*sizeof *x), memcpy(u, a->v[i], 3*sizeof *u);
    for (int k = 0; b && k < 3; k++) {
        x[k] = t*t*(1 + 2*s)*a->x[i][k] + s*s*(3 - 2*s)*b->x[j][k] + s*t*dt*(t*a->v[i][k] - s*b->v[j][k]);
        u[k] = t*a->v[i][k] + s*b->v[j][k];
    }
    return true;
}

/* Rows behind those of water are of bodies, which move straight on. */
static bool find_solid(const fill_view *v, int64_t i, double x[3], double u[3])
{
    const foam_water *a = v->before, *b = v->after;
    const bool same = b && b->solids == a->solids;
    for (int k = 0; k < 3; k++) {
        x[k] = same ? (1 - v->s)*a->solid[i][k] + v->s*b->solid[i][k] : a->solid[i][k];
        u[k] = 0;
    }
    return true;
}

static int64_t count_of(const foam_water *w) { return w->count + w->solids; }

static bool find_row(const fill_view *v, int64_t i, double x[3], double u[3])
{
    if (i >= v->before->count) find_solid(v, i - v->before->count, x, u);
    else if (!foam_find_row(v->before, v->after, v->s, i, x, u)) return false;
    for (int k = 0; k < v->f->def.dimension; k++)
        if (!(x[k] >= v->f->def.box_min[k] - v->c->reach && x[k] <= v->f->def.box_max[k] + v->c->reach) ||
            !isfinite(u[k])) return false;
    return true;
}

/* Coordinates along an axis of the row and its images; how many. */
static int list_images(const fill_view *v, int a, double x, double out[3])
{
    const tobi_foam_def *d = &v->f->def;
    int n = 0;
    out[n++] = x;
    if (a >= d->dimension) return n;
    if (x - d->box_min[a] < v->c->reach) out[n++] = 2*d->box_min[a] - x;
    if (d->box_max[a] - x < v->c->reach) out[n++] = 2*d->box_max[a] - x;
    return n;
}

static void count_rows(const void *view, int64_t begin, int64_t end)
{
    const fill_view *v = view;
    double x[3], u[3], out[3];
    for (int64_t i = begin; i < end; i++) {
        v->c->first[i] = 0;
        if (!find_row(v, i, x, u)) continue;
        v->c->first[i] = list_images(v, 0, x[0], out)*list_images(v, 1, x[1], out)*
                         list_images(v, 2, x[2], out);
    }
}

static void find_bounds(const void *view, int64_t begin, int64_t end)
{
    const fill_view *v = view;
    double x[3], u[3];
    for (int64_t part = begin; part < end; part++) {
        double *b = v->bounds[part];
        const int64_t all = count_of(v->before), last = (part + 1)*PART < all ? (part + 1)*PART : all;
        for (int a = 0; a < 3; a++) b[a] = INFINITY, b[3 + a] = -INFINITY;
        for (int64_t i = part*PART; i < last; i++)
            if (find_row(v, i, x, u))
                for (int a = 0; a < 3; a++) b[a] = fmin(b[a], x[a]), b[3 + a] = fmax(b[3 + a], x[a]);
    }
}

/* Where the cells begin, how wide and how many they are. */
static tobi_status place_cells(fill_view *v, tobi_error *err)
{
    foam_cells *c = v->c;
    const int64_t parts = (count_of(v->before) + PART - 1)/PART;
    double low[3] = { 0 }, high[3] = { 0 };
    v->bounds = malloc(((size_t)parts + 1)*sizeof *v->bounds);
    if (!v->bounds) return foam_no_memory(err);
    tobi_loop(v->f->exec.threads, parts, 1, find_bounds, v);
    for (int64_t k = 0; k < parts; k++)
        for (int a = 0; a < 3; a++) {
            if (k == 0 || v->bounds[k][a] < low[a]) low[a] = v->bounds[k][a];
            if (k == 0 || v->bounds[k][3 + a] > high[a]) high[a] = v->bounds[k][3 + a];
        }
    free(v->bounds);
    const double most = fmax(MOST_CELLS, 4*(double)count_of(v->before));
    for (double wide = 1, cells = INFINITY; cells > most; wide *= 1.26) {
        c->edge = wide*c->reach;
        for (int a = 0; a < 3; a++) {
            const bool some = high[a] >= low[a] && a < v->f->def.dimension;
            c->low[a] = some ? low[a] - c->reach : 0;
            c->n[a] = some ? (int64_t)fmin((high[a] - low[a] + 2*c->reach)/c->edge, 1e6) + 1 : 1;
        }
        cells = (double)c->n[0]*(double)c->n[1]*(double)c->n[2];
    }
    c->cells = c->n[0]*c->n[1]*c->n[2];
    return TOBI_OK;
}

static int64_t cell_along(const foam_cells *c, int a, double p)
{
    const double at = p/c->edge;
    return at <= 0 ? 0 : at >= (double)c->n[a] ? c->n[a] - 1 : (int64_t)at;
}

static void fill_rows(const void *view, int64_t begin, int64_t end)
{
    const fill_view *v = view;
    foam_cells *c = v->c;
    double x[3], u[3], out[3][3];
    for (int64_t i = begin; i < end; i++) {
        if (!find_row(v, i, x, u)) continue;
        int n[3];
        for (int a = 0; a < 3; a++) n[a] = list_images(v, a, x[a], out[a]);
        int64_t to = c->first[i];
        for (int k = 0; k < n[0]*n[1]*n[2]; k++, to++) {
            const int at[3] = { k%n[0], k/n[0]%n[1], k/n[0]/n[1] };
            float p[3], w[3];
            int64_t cell[3];
            for (int a = 0; a < 3; a++) {
                p[a] = (float)(out[a][at[a]] - c->low[a]);
                w[a] = (float)(at[a] ? -u[a] : u[a]);
                cell[a] = cell_along(c, a, (double)p[a]);
            }
            const int mirrors = (at[0] > 0) + 2*(at[1] > 0) + 4*(at[2] > 0);
            const float marks = (float)mirrors + (i < v->before->count ? 0 : FOAM_SOLID);
            c->place_raw[to] = (tobi_float4){ p[0], p[1], p[2], marks };
            c->move_raw[to] = (tobi_float4){ w[0], w[1], w[2], 0 };
            c->of_raw[to] = (int32_t)(k ? -1 - i : i);
            c->key[to] = (uint32_t)((cell[2]*c->n[1] + cell[1])*c->n[0] + cell[0]);
        }
    }
}

static void sort_entries(const void *view, int64_t begin, int64_t end)
{
    foam_cells *c = ((const fill_view *)view)->c;
    for (int64_t k = begin; k < end; k++) {
        const int32_t from = c->order[k];
        c->place[k] = c->place_raw[from], c->move[k] = c->move_raw[from], c->of[k] = c->of_raw[from];
        for (int64_t cell = k ? c->key[k - 1] + 1 : 0; cell <= c->key[k]; cell++) c->begin[cell] = (int32_t)k;
    }
}

static bool make_room(foam_cells *c, const tobi_exec *x)
{
    int64_t room[8];
    for (int k = 0; k < 8; k++) room[k] = c->room;
    bool good = foam_room(&c->begin, &c->cell_room, c->cells + 1, sizeof *c->begin) &&
        foam_room(&c->place, &room[0], c->count, sizeof *c->place) &&
        foam_room(&c->move, &room[1], c->count, sizeof *c->move) &&
        foam_room(&c->place_raw, &room[2], c->count, sizeof *c->place_raw) &&
        foam_room(&c->move_raw, &room[3], c->count, sizeof *c->move_raw) &&
        foam_room(&c->of, &room[4], c->count, sizeof *c->of) &&
        foam_room(&c->of_raw, &room[5], c->count, sizeof *c->of_raw) &&
        foam_room(&c->order, &room[6], c->count, sizeof *c->order) &&
        foam_room(&c->order2, &room[7], c->count, sizeof *c->order2);
    int64_t other[2] = { c->room, c->room };
    good = good && foam_room(&c->key, &other[0], c->count, sizeof *c->key) &&
        foam_room(&c->key2, &other[1], c->count, sizeof *c->key2);
    if (good) c->room = room[0];
    if (!c->histogram) c->histogram = tobi_array_make(tobi_sort_histogram_size(x), sizeof *c->histogram);
    return good && c->histogram;
}

tobi_status foam_fill_cells(tobi_foam *f, const foam_water *before, const foam_water *after, double s,
                            tobi_error *err)
{
    foam_cells *c = &f->cells;
    fill_view v = { f, before, after, s, c, NULL };
    const int64_t all = count_of(before);
    c->reach = 2*f->def.spacing;
    TOBI_TRY(tobi_exec_reserve(&f->exec, all, err));
    TOBI_TRY(place_cells(&v, err));
    if (!foam_room(&c->first, &c->first_room, all + 1, sizeof *c->first))
        return foam_no_memory(err);
    tobi_loop(f->exec.threads, all, 0, count_rows, &v);
    c->count = tobi_scan(&f->exec, all, c->first);
    if (c->count > INT32_MAX || !make_room(c, &f->exec)) return foam_no_memory(err);
    tobi_loop(f->exec.threads, all, 0, fill_rows, &v);
    tobi_sort_by_key(&f->exec, c->count, (uint32_t)c->cells, c->key, c->order, c->key2, c->order2,
                     c->histogram);
    tobi_loop(f->exec.threads, c->count, 0, sort_entries, &v);
    for (int64_t cell = c->count ? c->key[c->count - 1] + 1 : 0; cell <= c->cells; cell++)
        c->begin[cell] = (int32_t)c->count;
    return TOBI_OK;
}

foam_runs foam_first_run(const foam_cells *c, const float p[3])
{
    foam_runs r;
    for (int a = 0; a < 3; a++) {
        r.from[a] = cell_along(c, a, (double)p[a] - c->reach);
        r.to[a] = cell_along(c, a, (double)p[a] + c->reach);
    }
    r.y = r.from[1], r.z = r.from[2];
    return r;
}

bool foam_next_run(const foam_cells *c, foam_runs *r, int64_t *begin, int64_t *end)
{
    if (r->z > r->to[2] || c->count == 0) return false;
    const int64_t row = (r->z*c->n[1] + r->y)*c->n[0];
    *begin = c->begin[row + r->from[0]];
    *end = c->begin[row + r->to[0] + 1];
    if (++r->y > r->to[1]) r->y = r->from[1], r->z++;
    return true;
}

/* Particles and their images in flat sides as records in bins, sorted by group and bin, so that each search
   reads runs of memory. Drawback: positions are floats against the whole extent of the particles. */
#include "view/surface/surface.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#define RADIUS 1.7               /* of the kernel, in spacings */

tobi_status surface_no_memory(tobi_error *err, double bytes)
{
    return tobi_fail(err, TOBI_NO_MEMORY, "surface: no memory for %.3g GB; a larger cell needs less",
                     1e-9*bytes);
}

tobi_status surface_sort(surface_work *w, int64_t n, uint64_t limit, uint64_t *key, int32_t *order,
                         tobi_error *err)
{
    const size_t size = (size_t)n + 1;
    uint32_t *part = malloc(size*sizeof *part), *part2 = malloc(size*sizeof *part2);
    int32_t *next = malloc(size*sizeof *next), *spare = malloc(size*sizeof *spare);
    uint64_t *sorted = malloc(size*sizeof *sorted);
    int64_t *histogram = malloc((size_t)tobi_sort_histogram_size(&w->exec)*sizeof *histogram);
    const bool good = part && part2 && next && spare && sorted && histogram;
    if (good) {
        const uint32_t low = limit >> 32 ? UINT32_MAX : (uint32_t)limit;
        for (int64_t k = 0; k < n; k++) part[k] = (uint32_t)key[k];
        tobi_sort_by_key(&w->exec, n, low, part, order, part2, spare, histogram);
        if (limit >> 32) {
            for (int64_t k = 0; k < n; k++) part[k] = (uint32_t)(key[order[k]] >> 32);
            tobi_sort_by_key(&w->exec, n, (uint32_t)(limit >> 32), part, next, part2, spare, histogram);
            for (int64_t k = 0; k < n; k++) spare[k] = order[next[k]];
            for (int64_t k = 0; k < n; k++) order[k] = spare[k];
        }
        for (int64_t k = 0; k < n; k++) sorted[k] = key[order[k]];
        for (int64_t k = 0; k < n; k++) key[k] = sorted[k];
    }
    free(part), free(part2), free(next), free(spare), free(sorted), free(histogram);
    return good ? TOBI_OK : surface_no_memory(err, 32.0*(double)n);
}

/* Where a coordinate is kept: a little beyond a flat side it is moved to it, farther it is left out. */
static bool keep(const surface_work *w, int a, double *p)
{
    const tobi_surface_def *d = w->def;
    if (!isfinite(*p)) return false;
    if (d->flat_min[a] && *p < d->box_min[a]) {
        if (*p < d->box_min[a] - 0.5*d->spacing) return false;
        *p = d->box_min[a];
    }
    if (d->flat_max[a] && *p > d->box_max[a]) {
        if (*p > d->box_max[a] + 0.5*d->spacing) return false;
        *p = d->box_max[a];
    }
    return true;
}

static bool keep_point(const surface_work *w, int64_t i, double p[3])
{
    for (int a = 0; a < 3; a++) p[a] = w->def->positions[i][a];
    if (w->def->group && w->def->group[i] < 0) return false;
    return keep(w, 0, &p[0]) && keep(w, 1, &p[1]) && keep(w, 2, &p[2]);
}

/* Coordinates of a point and its images along one axis; how many. */
static int list_images(const surface_work *w, int a, double p, double out[3])
{
    const tobi_surface_def *d = w->def;
    int n = 0;
    out[n++] = p;
    if (d->flat_min[a] && p - d->box_min[a] < w->radius) out[n++] = 2*d->box_min[a] - p;
    if (d->flat_max[a] && d->box_max[a] - p < w->radius) out[n++] = 2*d->box_max[a] - p;
    return n;
}

/* Grid: nodes lie on flat sides, otherwise at multiples of the cell; all particles lie more than R and a cell
   above node 0. */
static void place_grid(surface_work *w, const double low[3])
{
    const tobi_surface_def *d = w->def;
    for (int a = 0; a < 3; a++) {
        double cell = d->cell*d->spacing;
        const double length = d->box_max[a] - d->box_min[a];
        if (d->flat_min[a] && d->flat_max[a]) cell = length/fmax(1, floor(length/cell + 0.5));
        const double anchor = d->flat_min[a] ? d->box_min[a] : d->flat_max[a] ? d->box_max[a] : 0;
        const double base = d->flat_min[a] ? 0 : floor((low[a] - anchor)/cell);
        const double margin = ceil(w->radius/cell) + 2;
        w->origin[a] = anchor + (base - margin)*cell;
        w->view.cell[a] = (float)(cell/w->radius);
        w->view.low[a] = INT32_MIN;
        w->view.high[a] = INT32_MAX;
        if (d->flat_min[a]) w->view.low[a] = (int32_t)margin;
        const double top = floor((d->box_max[a] - w->origin[a])/cell + 0.5);
        if (d->flat_max[a] && top < INT32_MAX/2) w->view.high[a] = (int32_t)top;      /* or out of reach */
    }
}

/* Extent of the points, images included; the bins and blocks along each axis. */
static tobi_status size_grid(surface_work *w, tobi_error *err)
{
    const tobi_surface_def *d = w->def;
    double low[3] = { DBL_MAX, DBL_MAX, DBL_MAX }, high[3] = { -DBL_MAX, -DBL_MAX, -DBL_MAX };
    double bins = 1, p[3];
    int32_t groups = 1;
    for (int64_t i = 0; i < d->particle_count; i++) {
        if (!keep_point(w, i, p)) continue;
        for (int a = 0; a < 3; a++) low[a] = fmin(low[a], p[a]), high[a] = fmax(high[a], p[a]);
        if (d->group && d->group[i] >= groups) groups = d->group[i] + 1;
    }
    if (low[0] > high[0]) low[0] = low[1] = low[2] = high[0] = high[1] = high[2] = 0;
    place_grid(w, low);
    for (int a = 0; a < 3; a++) {
        const double top = (high[a] - w->origin[a])/w->radius + 3;
        bins *= top;
        if (!(top < 1e6) || !(bins*groups < 9e18))
            return tobi_fail(err, TOBI_INVALID, "surface: the particles are spread over %g x %g x %g m, too "
                             "far for a spacing of %g m", high[0] - low[0], high[1] - low[1],
                             high[2] - low[2], d->spacing);
        w->view.bins[a] = (uint64_t)top + 1;
        w->view.blocks[a] = (uint64_t)(top/(SURFACE_SIDE*(double)w->view.cell[a])) + 2;
    }
    return TOBI_OK;
}

typedef struct fill_view {
    surface_work *w;
    int64_t *begin;
    float *at;
    int32_t *of;
    uint64_t *key;
} fill_view;

static void count_points(const void *view, int64_t begin, int64_t end)
{
    const fill_view *f = view;
    double p[3], out[3];
    for (int64_t i = begin; i < end; i++) {
        f->begin[i] = 0;
        if (!keep_point(f->w, i, p)) continue;
        f->begin[i] = list_images(f->w, 0, p[0], out)*list_images(f->w, 1, p[1], out)*
                      list_images(f->w, 2, p[2], out);
    }
}

static void fill_points(const void *view, int64_t begin, int64_t end)
{
    const fill_view *f = view;
    const surface_work *w = f->w;
    const surface_view *v = &w->view;
    double p[3], out[3][3];
    for (int64_t i = begin; i < end; i++) {
        if (!keep_point(w, i, p)) continue;
        int n[3];
        for (int a = 0; a < 3; a++) n[a] = list_images(w, a, p[a], out[a]);
        const uint64_t group = w->def->group ? (uint64_t)w->def->group[i] : 0;
        int64_t to = f->begin[i];
        for (int k = 0; k < n[0]*n[1]*n[2]; k++, to++) {
            const int at[3] = { k%n[0], k/n[0]%n[1], k/n[0]/n[1] };
            uint64_t key = group;
            for (int a = 2; a >= 0; a--) {
                f->at[3*to + a] = (float)((out[a][at[a]] - w->origin[a])/w->radius);
                key = key*v->bins[a] + (uint64_t)f->at[3*to + a];
            }
            f->key[to] = key;
            f->of[to] = k ? (int32_t)(-1 - i) : (int32_t)i;
        }
    }
}

typedef struct order_view { surface_work *w; const float *at; const int32_t *of, *order; } order_view;

static void order_points(const void *view, int64_t begin, int64_t end)
{
    const order_view *o = view;
    surface_work *w = o->w;
    for (int64_t k = begin; k < end; k++) {
        const float *at = o->at + 3*(int64_t)o->order[k];
        w->x[k] = at[0], w->y[k] = at[1], w->z[k] = at[2];
        w->of[k] = o->of[o->order[k]];
    }
}

/* Runs of equal keys; the keys of the points become those of the bins. */
static tobi_status find_bins(surface_work *w, uint64_t *key, tobi_error *err)
{
    int64_t n = 0;
    for (int64_t k = 0; k < w->points; k++) n += k == 0 || key[k] != key[k - 1];
    w->bin_key = tobi_array_make(n + 1, sizeof *w->bin_key);
    w->bin_begin = tobi_array_make(n + 1, sizeof *w->bin_begin);
    if (!w->bin_key || !w->bin_begin) return surface_no_memory(err, 12.0*(double)n);
    n = 0;
    for (int64_t k = 0; k < w->points; k++) {
        if (k > 0 && key[k] == key[k - 1]) continue;
        w->bin_begin[n] = (int32_t)k;
        w->bin_key[n++] = key[k];
    }
    w->bin_begin[n] = (int32_t)w->points;
    w->view.bin_key = w->bin_key;
    w->view.bin_begin = w->bin_begin;
    w->view.bin_count = n;
    return TOBI_OK;
}

static tobi_status make_arrays(surface_work *w, tobi_error *err)
{
    const int64_t n = w->points + SURFACE_PAD;
    float **const arrays[] = { &w->x, &w->y, &w->z, &w->count, &w->strength };
    for (int k = 0; k < 5; k++)
        if (!(*arrays[k] = tobi_array_zero(n, sizeof(float)))) return surface_no_memory(err, 24.0*(double)n);
    w->of = tobi_array_make(n, sizeof *w->of);
    if (!w->of) return surface_no_memory(err, 24.0*(double)n);
    w->view.x = w->x, w->view.y = w->y, w->view.z = w->z;
    w->view.count = w->count, w->view.strength = w->strength;
    return TOBI_OK;
}

static tobi_status sort_points(surface_work *w, int64_t *begin, tobi_error *err)
{
    const surface_view *v = &w->view;
    const int64_t n = w->points;
    fill_view f = { .w = w, .begin = begin, .at = malloc((size_t)n*12 + 1), .of = malloc((size_t)n*4 + 1),
                    .key = malloc((size_t)n*8 + 1) };
    int32_t *order = malloc((size_t)n*4 + 1);
    tobi_status status = TOBI_OK;
    if (!f.at || !f.of || !f.key || !order) status = surface_no_memory(err, 28.0*(double)n);
    if (status == TOBI_OK) {
        tobi_loop(w->exec.threads, w->def->particle_count, 0, fill_points, &f);
        uint64_t limit = v->bins[0]*v->bins[1]*v->bins[2], groups = 1;
        for (int64_t k = 0; k < n; k++) groups = f.key[k]/limit >= groups ? f.key[k]/limit + 1 : groups;
        status = surface_sort(w, n, limit*groups, f.key, order, err);
    }
    if (status == TOBI_OK) {
        const order_view o = { w, f.at, f.of, order };
        tobi_loop(w->exec.threads, n, 0, order_points, &o);
        status = find_bins(w, f.key, err);
    }
    free(f.at), free(f.of), free(f.key), free(order);
    return status;
}

tobi_status surface_place_points(surface_work *w, tobi_error *err)
{
    const double share = 315/(64*3.14159265358979323846*RADIUS*RADIUS*RADIUS);     /* kernel at 0, d^3 */
    w->radius = RADIUS*w->def->spacing;
    w->view.scale = (float)share;
    w->view.level = 0.5765f;
    w->view.alone = 1.02f;
    w->view.dense = (float)(0.55/share);
    TOBI_TRY(size_grid(w, err));
    int64_t *begin = malloc(((size_t)w->def->particle_count + 1)*sizeof *begin);
    if (!begin) return surface_no_memory(err, 8.0*(double)w->def->particle_count);
    const fill_view f = { .w = w, .begin = begin };
    tobi_loop(w->exec.threads, w->def->particle_count, 0, count_points, &f);
    w->points = tobi_scan(&w->exec, w->def->particle_count, begin);
    tobi_status status = make_arrays(w, err);
    if (status == TOBI_OK) status = sort_points(w, begin, err);
    free(begin);
    TOBI_TRY(status);
    const int64_t chunks = (w->view.bin_count + SURFACE_CHUNK - 1)/SURFACE_CHUNK;
    tobi_launch_each(&w->exec, tobi_view_kernels_for(w->exec.isa)->surface_density, &w->view, chunks, NULL);
    return TOBI_OK;
}

/* Diffuse particles from output to output: the water of the last one is kept, the substeps between two are
   short enough that nothing goes farther than a spacing, as long as there are at most 60. Drawback: an output
   is copied, so that the caller's arrays may go. */
#include "view/foam/foam.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_SUBSTEPS = 60 };

tobi_foam_def tobi_default_foam(void)
{
    return (tobi_foam_def){ .dimension = 3, .gravity = { 0, 0, -9.81 }, .amount = 1, .most = 4000000 };
}

tobi_status foam_no_memory(tobi_error *err) { return tobi_fail(err, TOBI_NO_MEMORY, "foam: out of memory"); }

bool foam_room(void *array, int64_t *room, int64_t count, size_t size)
{
    void *old, *fresh;
    memcpy(&old, array, sizeof old);      /* whatever it points to */
    if (count <= *room && old) return true;
    const int64_t more = count + count/4 + 16;
    if (!(fresh = tobi_array_make(more, size))) return false;
    tobi_array_free(old);
    memcpy(array, &fresh, sizeof fresh);
    *room = more;
    return true;
}

static tobi_status check_def(const tobi_foam_def *d, tobi_error *err)
{
    if (d->dimension != 2 && d->dimension != 3)
        return tobi_fail(err, TOBI_INVALID, "foam: dimension %d, allowed are 2 and 3", d->dimension);
    if (!(d->spacing > 0) || !isfinite(d->spacing))
        return tobi_fail(err, TOBI_INVALID, "foam: a spacing of %g m, must be greater than 0", d->spacing);
    if (!(d->amount > 0 && d->amount <= 1000))
        return tobi_fail(err, TOBI_INVALID, "foam: %g times the usual amount, allowed is above 0 to 1000",
                         d->amount);
    if (!(d->lifetime >= 0) || !isfinite(d->lifetime))
        return tobi_fail(err, TOBI_INVALID, "foam: a lifetime of %g s, must be 0 or greater", d->lifetime);
    if (d->most < 1 || d->most > 1 << 30)
        return tobi_fail(err, TOBI_INVALID, "foam: at most %" PRId64 " particles, allowed are 1 to %d",
                         d->most, 1 << 30);
    for (int a = 0; a < d->dimension; a++) {
        if (!isfinite(d->box_min[a]) || !isfinite(d->box_max[a]) || !(d->box_min[a] < d->box_max[a]))
            return tobi_fail(err, TOBI_INVALID, "foam: the box is empty along %c", "xyz"[a]);
        if (!isfinite(d->gravity[a]))
            return tobi_fail(err, TOBI_INVALID, "foam: gravity is no number along %c", "xyz"[a]);
    }
    return TOBI_OK;
}

/* Sum of the weights of a lattice. */
static float sum_lattice(int dimension)
{
    float sum = 0;
    for (int z = dimension == 3 ? -2 : 0; z <= (dimension == 3 ? 2 : 0); z++)
        for (int y = -2; y <= 2; y++)
            for (int x = -2; x <= 2; x++) {
                const float w = 1 - 0.5f*sqrtf((float)(x*x + y*y + z*z));
                sum += w > 0 ? w : 0;
            }
    return sum;
}

tobi_status tobi_foam_create(const tobi_foam_def *def, tobi_foam **foam, tobi_error *err)
{
    TOBI_NEED(foam, "the place for the foam");
    *foam = NULL;
    TOBI_NEED(def, "def");
    TOBI_TRY(check_def(def, err));
    tobi_foam *f = calloc(1, sizeof *f);
    if (!f) return foam_no_memory(err);
    f->def = *def;
    double g = 0;
    for (int a = 0; a < def->dimension; a++) g += def->gravity[a]*def->gravity[a];
    g = sqrt(g);
    for (int a = 0; a < def->dimension; a++) f->up[a] = g > 0 ? -def->gravity[a]/g : 0;
    if (def->dimension == 2) f->def.gravity[2] = 0;
    f->pull = g > 0 ? g : 9.81;
    f->scale = sqrt(f->pull*def->spacing);
    f->rise = 0.25*sqrt(g/9.81);
    f->relax = g > 0 ? f->rise/(2*g) : 0;      /* it begins at 2 g: half of its water goes along */
    f->lifetime = def->lifetime > 0 ? def->lifetime : 60*sqrt(def->spacing/f->pull);
    f->full = sum_lattice(def->dimension);
    const tobi_status status = tobi_exec_init(&f->exec, def->threads, err);
    if (status == TOBI_OK) *foam = f;
    else tobi_foam_free(f);
    return status;
}

static void free_water(foam_water *w)
{
    void *const arrays[] = { w->x, w->v, w->id, w->rate, w->spread, w->partner, w->solid };
    for (size_t k = 0; k < sizeof arrays/sizeof *arrays; k++) tobi_array_free(arrays[k]);
    *w = (foam_water){ 0 };
}

void tobi_foam_free(tobi_foam *f)
{
    if (!f) return;
    free_water(&f->before);
    free_water(&f->after);
    foam_free_cells(&f->cells);
    for (size_t k = 0; k < sizeof f->out/sizeof *f->out; k++) tobi_array_free(f->out[k]);
    tobi_array_free(f->normal);
    tobi_array_free(f->number);
    tobi_array_free(f->drop);
    tobi_array_free(f->spare);
    tobi_exec_free(&f->exec);
    free(f);
}

/* Of loops over the water of an output. */
typedef struct water_view {
    foam_water *w;
    const foam_water *next;
    const tobi_foam_water *from;
    int dimension;
    double spacing;
    int unsorted;
} water_view;

static void copy_rows(const void *view, int64_t begin, int64_t end)
{
    water_view *v = (water_view *)view;
    for (int64_t i = begin; i < end; i++) {
        for (int a = 0; a < 3; a++) {
            v->w->x[i][a] = a < v->dimension ? v->from->positions[i][a] : 0;
            v->w->v[i][a] = a < v->dimension ? v->from->velocities[i][a] : 0;
        }
        v->w->id[i] = v->from->ids ? v->from->ids[i] : i;
        if (v->from->ids && i > 0 && v->from->ids[i] <= v->from->ids[i - 1])
            __atomic_store_n(&v->unsorted, 1, __ATOMIC_RELAXED);
    }
}

static tobi_status keep_water(tobi_foam *f, const tobi_foam_water *from, foam_water *w, tobi_error *err)
{
    const int64_t n = from->count;
    int64_t room[6];
    for (int k = 0; k < 6; k++) room[k] = w->room;
    if (!foam_room(&w->x, &room[0], n, sizeof *w->x) || !foam_room(&w->v, &room[1], n, sizeof *w->v) ||
        !foam_room(&w->id, &room[2], n, sizeof *w->id) ||
        !foam_room(&w->rate, &room[3], n, sizeof *w->rate) ||
        !foam_room(&w->spread, &room[4], n, sizeof *w->spread) ||
        !foam_room(&w->partner, &room[5], n, sizeof *w->partner)) return foam_no_memory(err);
    if (!foam_room(&w->solid, &w->solid_room, from->solid_count, sizeof *w->solid))
        return foam_no_memory(err);
    w->room = room[0], w->count = n, w->time = from->time;
    if (from->solid_count > 0)
        memcpy(w->solid, from->solids, (size_t)from->solid_count*sizeof *w->solid);
    w->solids = from->solid_count;
    water_view v = { .w = w, .from = from, .dimension = f->def.dimension };
    tobi_loop(f->exec.threads, n, 0, copy_rows, &v);
    return v.unsorted ? tobi_fail(err, TOBI_INVALID, "foam: the ids of the particles at %g s do not rise",
                                  from->time) : TOBI_OK;
}

/* The row of an id, often that of before; -1: none. */
static int64_t find_id(const foam_water *w, int64_t id, int64_t guess)
{
    if (guess < w->count && w->id[guess] == id) return guess;
    int64_t low = 0, high = w->count;
    while (low < high) {
        const int64_t middle = (low + high)/2;
        if (w->id[middle] < id) low = middle + 1;
        else high = middle;
    }
    return low < w->count && w->id[low] == id ? low : -1;
}

/* What has jumped, through a periodic side or an outlet and an inlet, is no partner. */
static void find_partners(const void *view, int64_t begin, int64_t end)
{
    const water_view *v = view;
    const double dt = v->next->time - v->w->time;
    for (int64_t i = begin; i < end; i++) {
        const int64_t j = find_id(v->next, v->w->id[i], i);
        double way = 0, old = 0, new = 0;
        v->w->partner[i] = (int32_t)j;
        for (int a = 0; j >= 0 && a < 3; a++) {
            const double d = v->next->x[j][a] - v->w->x[i][a];
            way += d*d, old += v->w->v[i][a]*v->w->v[i][a], new += v->next->v[j][a]*v->next->v[j][a];
        }
        if (!(sqrt(way) <= 4*(dt*sqrt(fmax(old, new)) + 4*v->spacing))) v->w->partner[i] = -1;
    }
}

static void find_most(const void *view, int64_t begin, int64_t end, double *totals)
{
    const foam_water *w = view;
    for (int64_t i = begin; i < end; i++) {
        const double square = w->v[i][0]*w->v[i][0] + w->v[i][1]*w->v[i][1] + w->v[i][2]*w->v[i][2];
        if (square > totals[6] && isfinite(square)) totals[6] = square;
        if ((double)w->rate[i] > totals[7]) totals[7] = (double)w->rate[i];
    }
}

static tobi_status run_substeps(tobi_foam *f, tobi_error *err)
{
    double a[TOBI_TOTALS] = { 0 }, b[TOBI_TOTALS] = { 0 };
    const double time = f->after.time - f->before.time;
    TOBI_TRY(tobi_exec_reserve(&f->exec, f->before.count + f->after.count, err));
    tobi_launch(&f->exec, TOBI_HOST(find_most, 0, 2), &f->before, 0, f->before.count, a);
    tobi_launch(&f->exec, TOBI_HOST(find_most, 0, 2), &f->after, 0, f->after.count, b);
    const double way = time*sqrt(fmax(a[6], b[6]))/f->def.spacing;
    const int n = way < 1 ? 1 : way < MOST_SUBSTEPS ? (int)ceil(way) : MOST_SUBSTEPS;
    const bool makes = a[7] > 0 || b[7] > 0;
    for (int k = 0; k < n && (makes || f->count > 0); k++) {
        const double s = (k + 0.5)/n;
        f->substep++;
        TOBI_TRY(foam_fill_cells(f, &f->before, &f->after, s, err));
        if (makes) TOBI_TRY(foam_make(f, s, time/n, err));
        TOBI_TRY(foam_move(f, time/n, err));
    }
    return TOBI_OK;
}

static tobi_status check_water(const tobi_foam *f, const tobi_foam_water *w, tobi_error *err)
{
    if (w->count < 0 || w->count > INT32_MAX || (w->count > 0 && (!w->positions || !w->velocities)))
        return tobi_fail(err, TOBI_INVALID, "foam: %" PRId64 " particles%s cannot be followed", w->count,
                         w->count > 0 && w->count <= INT32_MAX ? tr(" without positions or velocities") : "");
    if (w->solid_count < 0 || w->solid_count > INT32_MAX || (w->solid_count > 0 && !w->solids))
        return tobi_fail(err, TOBI_INVALID, "foam: %" PRId64 " points of bodies%s cannot be taken",
                         w->solid_count, w->solid_count > 0 ? tr(" without positions") : "");
    if (!isfinite(w->time) || (f->begun && !(w->time > f->before.time)))
        return tobi_fail(err, TOBI_INVALID, "foam: an output at %g s after one at %g s; times must rise",
                         w->time, f->begun ? f->before.time : 0);
    return TOBI_OK;
}

tobi_status tobi_foam_advance(tobi_foam *f, const tobi_foam_water *water, tobi_error *err)
{
    TOBI_NEED(f, "the foam");
    TOBI_NEED(water, "the water");
    TOBI_TRY(check_water(f, water, err));
    TOBI_TRY(keep_water(f, water, &f->after, err));
    TOBI_TRY(foam_find_potentials(f, &f->after, err));
    if (f->begun) {
        const water_view v = { .w = &f->before, .next = &f->after, .spacing = f->def.spacing };
        tobi_loop(f->exec.threads, f->before.count, 0, find_partners, &v);
        TOBI_TRY(run_substeps(f, err));
    }
    const foam_water old = f->before;
    f->before = f->after, f->after = old;
    f->begun = true;
    return TOBI_OK;
}

static void copy_drops(const void *view, int64_t begin, int64_t end)
{
    const tobi_foam *f = view;
    for (int64_t i = begin; i < end; i++) {
        const foam_drop *d = &f->drop[i];
        for (int a = 0; a < 3; a++) {
            ((double *)f->out[0])[3*i + a] = d->x[a];
            ((float *)f->out[1])[3*i + a] = (float)d->v[a];
        }
        ((uint8_t *)f->out[2])[i] = (uint8_t)d->kind;
        ((float *)f->out[3])[i] = d->age;
        ((float *)f->out[4])[i] = d->life;
        ((int64_t *)f->out[5])[i] = d->id;
    }
}

tobi_status tobi_foam_read(tobi_foam *f, tobi_foam_particles *p, tobi_error *err)
{
    static const size_t size[6] = { 3*sizeof(double), 3*sizeof(float), 1, sizeof(float), sizeof(float),
                                    sizeof(int64_t) };
    TOBI_NEED(f, "the foam");
    TOBI_NEED(p, "the place for its particles");
    for (int k = 0; k < 6; k++) {
        tobi_array_free(f->out[k]);
        if (!(f->out[k] = tobi_array_make(f->count + 1, size[k]))) return foam_no_memory(err);
    }
    tobi_loop(f->exec.threads, f->count, 0, copy_drops, f);
    *p = (tobi_foam_particles){ .count = f->count, .positions = f->out[0], .velocities = f->out[1],
                                .kind = f->out[2], .age = f->out[3], .life = f->out[4], .ids = f->out[5],
                                .left_out = f->left_out };
    return TOBI_OK;
}

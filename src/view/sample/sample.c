/* Fields at places. What is wet: the weights of the liquid around a place, over those of full liquid, are the
   share of its surroundings that liquid fills; the points of bodies give the share of bodies. A place is wet
   where liquid fills more than half of what bodies leave free, and not less than they do. Sides of the domain
   are mirrors there. Values come from the particles alone, without images: they hold for any wall. Drawback:
   a drop of one or two particles is dry. */
#include "view/sample/sample.h"
#include "view/weight.h"
#include <inttypes.h>
#include <string.h>

enum { UNKNOWNS = 4, MOST_AROUND = 512 };       /* 13 in 2-D, 33 in 3-D in liquid that is not crushed */
static const double REACH = 2;           /* spacings                                            */
static const double FULL_ENOUGH = 0.5;   /* of the room without bodies: a flat surface           */
static const double DEPTH = 0.1;         /* spacings that a place may lie within a body, for rounding */
static const double MOST_GAIN = 5;       /* sum of sizes of factors: 1 of a mean, 4 in a corner of a box */
static const double LEAST_PIVOT = 1e-4;  /* of the sum of weights: points in a plane have none   */

tobi_sample_def tobi_default_sample(void) { return (tobi_sample_def){ .dimension = 3 }; }

typedef struct sample_view {
    const tobi_sample_def *def;
    sample_cells liquid, solid;
    double reach, full;
} sample_view;

/* A place, or its images in the sides; through a periodic one it sees the particles themselves. */
typedef struct image { double x[3]; bool real; } image;

static int list_images(const sample_view *v, const double place[3], image out[27])
{
    const tobi_sample_def *d = v->def;
    int count = 1;
    out[0] = (image){ { place[0], place[1], place[2] }, true };
    for (int a = 0; a < d->dimension; a++) {
        const double low = d->box_min[a], high = d->box_max[a], x = place[a];
        const int before = count;
        for (int side = 0; side < 2; side++) {
            if ((side ? high - x : x - low) >= v->reach) continue;
            const double other = d->periodic[a] ? x + (side ? low - high : high - low)
                                                : 2*(side ? high : low) - x;
            for (int k = 0; k < before; k++) {
                out[count] = out[k];
                out[count].x[a] = other;
                out[count++].real &= d->periodic[a] != 0;
            }
        }
    }
    return count;
}

static double find_square(const sample_view *v, const double a[3], const double b[3])
{
    const double x = a[0] - b[0], y = a[1] - b[1], z = v->def->dimension == 3 ? a[2] - b[2] : 0;
    return x*x + y*y + z*z;
}

/* The particles around a place: rows, weights, and the way to each in reaches. */
typedef struct around {
    int count;
    int32_t row[MOST_AROUND];
    double w[MOST_AROUND], p[MOST_AROUND][3];
} around;

static void find_around(const sample_view *v, const image *images, int count, around *near)
{
    const double reach2 = v->reach*v->reach;
    near->count = 0;
    for (int k = 0; k < count; k++) {
        const double *x = images[k].x;
        int64_t state = 0;
        int32_t begin, end;
        while (images[k].real && sample_next_run(&v->liquid, x, v->reach, &state, &begin, &end))
            for (int32_t i = begin; i < end; i++) {
                const double *y = v->liquid.x[i], r2 = find_square(v, x, y);
                if (!(r2 < reach2) || near->count == MOST_AROUND) continue;
                const int n = near->count++;
                near->row[n] = v->liquid.row[i];
                near->w[n] = view_weight(r2, reach2);
                for (int a = 0; a < 3; a++) near->p[n][a] = (y[a] - x[a])/v->reach;
            }
    }
}

/* The share of what is around that these points fill, by images that are mirrored only or by all. */
static double find_share(const sample_view *v, const sample_cells *c, const image *images, int count,
                         bool all)
{
    const double reach2 = v->reach*v->reach;
    double sum = 0;
    for (int k = 0; k < count; k++) {
        int64_t state = 0;
        int32_t begin, end;
        while ((all || !images[k].real) &&
               sample_next_run(c, images[k].x, v->reach, &state, &begin, &end))
            for (int32_t i = begin; i < end; i++) {
                const double r2 = find_square(v, images[k].x, c->x[i]);
                if (r2 < reach2) sum += view_weight(r2, reach2);
            }
    }
    return sum/v->full;
}

static bool is_wet(const sample_view *v, const image *images, int count, const around *near)
{
    double liquid = find_share(v, &v->liquid, images, count, false);
    for (int n = 0; n < near->count; n++) liquid += near->w[n]/v->full;
    if (near->count == 0 || liquid <= 0.5*FULL_ENOUGH) return false;
    const double solid = find_share(v, &v->solid, images, count, true);
    return solid <= liquid + DEPTH && liquid > FULL_ENOUGH*(1 - fmin(solid, 0.5));
}

/* Solves M c = (1, 0, ...) by Cholesky. False: the points lie in a plane, or nearly. */
static bool solve_first(int n, double m[UNKNOWNS][UNKNOWNS], double c[UNKNOWNS])
{
    const double least = LEAST_PIVOT*m[0][0];
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) {
            double sum = m[i][j];
            for (int k = 0; k < j; k++) sum -= m[i][k]*m[j][k];
            if (i == j && !(sum > least)) return false;
            m[i][j] = i == j ? sqrt(sum) : sum/m[j][j];
        }
    for (int i = 0; i < n; i++) {
        c[i] = i == 0 ? 1 : 0;
        for (int k = 0; k < i; k++) c[i] -= m[i][k]*c[k];
        c[i] /= m[i][i];
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++) c[i] -= m[k][i]*c[k];
        c[i] /= m[i][i];
    }
    return true;
}

/* Factors of the fit for a linear field. False: the particles lie in a plane, or nearly. */
static bool find_factors(const sample_view *v, const around *near, double factor[MOST_AROUND])
{
    const int unknowns = v->def->dimension + 1;
    double m[UNKNOWNS][UNKNOWNS] = { { 0 } }, c[UNKNOWNS];
    for (int n = 0; n < near->count; n++) {
        const double p[UNKNOWNS] = { 1, near->p[n][0], near->p[n][1], near->p[n][2] };
        for (int i = 0; i < unknowns; i++)
            for (int j = 0; j <= i; j++) m[i][j] += near->w[n]*p[i]*p[j];
    }
    if (!solve_first(unknowns, m, c)) return false;
    for (int n = 0; n < near->count; n++) {
        factor[n] = c[0];
        for (int a = 0; a < v->def->dimension; a++) factor[n] += c[a + 1]*near->p[n][a];
        factor[n] *= near->w[n];
    }
    return true;
}

/* The fit, unless it amplifies too much what scatters among the particles; then the weighted mean. */
static void choose_factors(const sample_view *v, const around *near, double factor[MOST_AROUND])
{
    double gain = 0, weight = 0;
    const bool fits = find_factors(v, near, factor);
    for (int n = 0; n < near->count; n++) gain += fits ? fabs(factor[n]) : 0, weight += near->w[n];
    if (fits && gain <= MOST_GAIN) return;
    for (int n = 0; n < near->count; n++) factor[n] = near->w[n]/weight;
}

static void write_place(const sample_view *v, int64_t place, bool wet, const around *near)
{
    double factor[MOST_AROUND];
    if (wet) choose_factors(v, near, factor);
    for (int f = 0; f < v->def->field_count; f++) {
        const tobi_sample_field *field = &v->def->fields[f];
        const int components = field->components;
        double *at = field->at + place*components;
        for (int k = 0; k < components; k++) at[k] = wet ? 0 : NAN;
        for (int n = 0; wet && n < near->count; n++) {
            const double *values = field->values + (int64_t)near->row[n]*components;
            for (int k = 0; k < components; k++) at[k] += factor[n]*values[k];
        }
    }
}

static void sample_places(const void *view, int64_t begin, int64_t end)
{
    const sample_view *v = view;
    const tobi_sample_def *d = v->def;
    around near;
    for (int64_t i = begin; i < end; i++) {
        image images[27];
        double x[3] = { d->places[i][0], d->places[i][1], d->dimension == 3 ? d->places[i][2] : 0 };
        bool inside = true;
        for (int a = 0; a < d->dimension; a++) {
            const double length = d->box_max[a] - d->box_min[a];
            if (d->periodic[a]) x[a] -= length*floor((x[a] - d->box_min[a])/length);
            inside &= x[a] >= d->box_min[a] && x[a] <= d->box_max[a];
        }
        const int count = inside ? list_images(v, x, images) : 0;
        find_around(v, images, count, &near);
        const bool wet = inside && is_wet(v, images, count, &near);
        if (d->wet) d->wet[i] = wet;
        write_place(v, i, wet, &near);
    }
}

static tobi_status check_fields(const tobi_sample_def *d, tobi_error *err)
{
    if (d->field_count < 0 || d->field_count > TOBI_SAMPLE_FIELD_LIMIT)
        return tobi_fail(err, TOBI_INVALID, "sample: %d fields, allowed are 0 to %d", d->field_count,
                         TOBI_SAMPLE_FIELD_LIMIT);
    if (d->field_count) TOBI_NEED(d->fields, "the fields");
    for (int k = 0; k < d->field_count; k++) {
        const tobi_sample_field *f = &d->fields[k];
        if (f->components < 1 || f->components > 9)
            return tobi_fail(err, TOBI_INVALID, "sample: field %d has %d components, allowed are 1 to 9", k,
                             f->components);
        if (d->particle_count) TOBI_NEED(f->values, "the values of a field");
        if (d->place_count) TOBI_NEED(f->at, "the place for the values of a field");
    }
    return TOBI_OK;
}

static tobi_status check_def(const tobi_sample_def *d, tobi_error *err)
{
    if (d->dimension != 2 && d->dimension != 3)
        return tobi_fail(err, TOBI_INVALID, "sample: dimension %d, allowed are 2 and 3", d->dimension);
    if (!(d->spacing > 0) || !isfinite(d->spacing))
        return tobi_fail(err, TOBI_INVALID, "sample: a spacing of %g m, must be greater than 0", d->spacing);
    for (int a = 0; a < d->dimension; a++)
        if (!isfinite(d->box_min[a]) || !isfinite(d->box_max[a]) || !(d->box_min[a] < d->box_max[a]))
            return tobi_fail(err, TOBI_INVALID, "sample: the box is empty along %c", "xyz"[a]);
    const int64_t count[] = { d->particle_count, d->solid_count, d->place_count };
    const char *const what[] = { TR("particles"), TR("points of bodies"), TR("places") };
    for (int k = 0; k < 3; k++)
        if (count[k] < 0 || count[k] > INT32_MAX - 1)
            return tobi_fail(err, TOBI_INVALID, "sample: %" PRId64 " %s, allowed are 0 to %d", count[k],
                             tr(what[k]), INT32_MAX - 1);
    if (d->particle_count) TOBI_NEED(d->positions, "the positions");
    if (d->solid_count) TOBI_NEED(d->solids, "the points of bodies");
    if (d->place_count) TOBI_NEED(d->places, "the places");
    return check_fields(d, err);
}

tobi_status tobi_sample_make(const tobi_sample_def *def, tobi_error *err)
{
    TOBI_NEED(def, "def");
    TOBI_TRY(check_def(def, err));
    tobi_exec exec;
    sample_view v = { .def = def, .reach = REACH*def->spacing, .full = view_full_weight(def->dimension) };
    TOBI_TRY(tobi_exec_init(&exec, def->threads, err));
    tobi_status status = tobi_exec_reserve(&exec, def->particle_count + def->solid_count, err);
    if (status == TOBI_OK)
        status = sample_fill_cells(&v.liquid, &exec, def, v.reach, def->particle_count, def->positions, err);
    if (status == TOBI_OK)
        status = sample_fill_cells(&v.solid, &exec, def, v.reach, def->solid_count, def->solids, err);
    if (status == TOBI_OK) tobi_loop(exec.threads, def->place_count, 64, sample_places, &v);
    sample_free_cells(&v.liquid);
    sample_free_cells(&v.solid);
    tobi_exec_free(&exec);
    return status;
}

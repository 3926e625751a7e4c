/* Lattice points inside a body.

   Lines (lines.h) through a lattice four times finer in the other directions are cut
   with the mesh once; every shift of the body's lattice by quarters of its spacing is then counted
   from the same cuts, without testing a single point. */
#include "geom/sample.h"
#include "geom/lines.h"
#include "geom/massprops.h"
#include "geom/section.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

enum { FINE = 4 };                /* shifts per axis                                               */
#define GOOD 0.005                /* relative volume error that needs no better lattice            */
#define ALLOWED 0.01

/* Sums over the points of one shift. */
typedef struct moments {
    double count, first[3], second[3];
} moments;

/* First lattice number k whose point (FINE k + shift) fine lies at or beyond z. */
static int64_t first_point(const tobi_lines *l, double z, int shift)
{
    int64_t k = (int64_t)floor(z/(l->fine*FINE)) - 1;
    while ((double)(FINE*k + shift)*l->fine < z) k++;
    return k;
}

/* Calls for each run [k0, k1) of lattice points of a shift that lies inside on one line. */
typedef void run_fn(void *to, const double xy[2], int64_t k0, int64_t k1);

static void visit_line(const tobi_lines *l, int64_t i, int64_t j, int shift, run_fn *visit, void *to)
{
    int64_t line = tobi_line_index(l, i, j);
    double xy[2] = {(double)i*l->fine, (double)j*l->fine};
    int wound = 0;
    for (int64_t c = l->start[line]; c + 1 < l->start[line + 1]; c++) {
        wound += l->cuts[c].turn;
        if (wound <= 0) continue;
        int64_t k0 = first_point(l, l->cuts[c].at, shift), k1 = first_point(l, l->cuts[c + 1].at, shift);
        if (k1 > k0) visit(to, xy, k0, k1);
    }
}

/* The lowest number >= low that is shift modulo FINE. */
static int64_t first_shifted(int64_t low, int shift)
{
    int64_t rest = (shift - low) % FINE;
    return low + (rest < 0 ? rest + FINE : rest);
}

static void visit_lattice(const tobi_lines *l, const int shift[3], run_fn *visit, void *to)
{
    int64_t end[2] = {l->low[0] + l->size[0], l->low[1] + l->size[1]};
    int flat = l->dimension == 2;
    for (int64_t i = first_shifted(l->low[0], shift[0]); i < end[0]; i += FINE)
        for (int64_t j = flat ? 0 : first_shifted(l->low[1], shift[1]); j < end[1]; j += FINE)
            visit_line(l, i, j, shift[2], visit, to);
}

typedef struct tally {
    moments m;
    double fine;
    int shift, along;             /* along: axis of the lines                                      */
} tally;

static void count_run(void *to, const double xy[2], int64_t k0, int64_t k1)
{
    tally *c = to;
    double n = (double)(k1 - k0), step = FINE*c->fine;
    double mean = 0.5*step*(double)(k0 + k1 - 1) + c->shift*c->fine;
    c->m.count += n;
    for (int k = 0; k < c->along; k++) {
        c->m.first[k] += n*xy[k];
        c->m.second[k] += n*xy[k]*xy[k];
    }
    c->m.first[c->along] += n*mean;
    c->m.second[c->along] += n*(mean*mean + step*step*(n*n - 1)/12);
}

/* Means of x and x^2 over the body itself about the middle of the lines. */
static moments measure_body(const tobi_lines *l, const tobi_massprops *p)
{
    moments m = {.count = 1};
    double trace = p->inertia[0] + p->inertia[4] + p->inertia[8];
    for (int k = 0; k < 3; k++) {
        m.first[k] = p->centre[k] - l->middle[k];
        m.second[k] = (0.5*trace - p->inertia[4*k])/p->volume + m.first[k]*m.first[k];
    }
    return m;
}

/* How badly the points of one shift stand for the body: volume first, then second moments and
   centre. Each point stands for its cell, hence the spread. */
static double score_shift(const tobi_lines *l, const moments *m, const moments *body, double volume_error)
{
    double cell = l->fine*FINE, score = 2*volume_error + 20*fmax(0, volume_error - GOOD);
    if (m->count == 0) return INFINITY;
    for (int k = 0; k < l->dimension; k++) {
        double mean = m->first[k]/m->count - body->first[k];
        double second = m->second[k]/m->count + cell*cell/12;
        score += fabs(second/body->second[k] - 1)/l->dimension + 0.1*fabs(mean)/sqrt(body->second[k]);
    }
    return score;
}

/* The best shift of the lattice for these lines; returns its relative volume error. */
static double choose_shift(const tobi_lines *l, const tobi_massprops *whole, int best_shift[3])
{
    moments body = measure_body(l, whole);
    double cell = pow(l->fine*FINE, l->dimension), best = INFINITY, best_error = INFINITY;
    for (int s = 0; s < FINE*FINE*FINE; s++) {
        int shift[3] = {s/(FINE*FINE), s/FINE % FINE, s % FINE};
        if (l->dimension == 2 && shift[1]) continue;
        tally c = {.fine = l->fine, .shift = shift[2], .along = l->dimension - 1};
        visit_lattice(l, shift, count_run, &c);
        double error = fabs(c.m.count*cell/whole->volume - 1);
        double score = score_shift(l, &c.m, &body, error);
        /* equal up to rounding: the earlier one, whatever the last bits of this pose */
        if (!(score < best - 1e-9)) continue;
        best = score;
        best_error = error;
        memcpy(best_shift, shift, sizeof shift);
    }
    return best_error;
}

typedef struct writer {
    const tobi_lines *l;
    double (*points)[3];
    int64_t count;
    int shift;
} writer;

static void write_run(void *to, const double xy[2], int64_t k0, int64_t k1)
{
    writer *w = to;
    int along = w->l->dimension - 1;
    for (int64_t k = k0; k < k1; k++, w->count++) {
        double local[3] = {xy[0], xy[1], 0}, *x = w->points[w->count];
        local[along] = (double)(FINE*k + w->shift)*w->l->fine;
        for (int c = 0; c < 3; c++) x[c] = w->l->middle[c] + local[c];
    }
}

static tobi_status write_points(const tobi_lines *l, const int shift[3], double (**points)[3], int64_t *count,
                                tobi_error *err)
{
    tally c = {.fine = l->fine, .shift = shift[2], .along = l->dimension - 1};
    visit_lattice(l, shift, count_run, &c);
    writer w = {.l = l, .shift = shift[2], .points = malloc((size_t)(c.m.count + 1)*sizeof *w.points)};
    if (!w.points)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %.0f body particles", c.m.count);
    visit_lattice(l, shift, write_run, &w);
    *points = w.points;
    *count = w.count;
    return TOBI_OK;
}

/* A turned pose of the lattice: the mesh is turned instead, and the points turned back. */
typedef struct pose {
    double axis[3], degrees;
} pose;

/* Upright first; then angles without a simple relation to each other or to right angles. */
static const pose poses[] = {
    {{0, 0, 1}, 0},      {{1, 2, 3}, 37.3},   {{3, 1, -2}, 29.1}, {{-2, 3, 1}, 53.9}, {{1, -3, 2}, 41.7},
    {{2, 1, 1}, 19.4},   {{1, 3, -1}, 61.2},  {{3, -1, 1}, 23.6}, {{1, 1, 2}, 47.8},
};
static const pose flat_poses[] = {
    {{0, 0, 1}, 0},      {{0, 0, 1}, 31.7},   {{0, 0, 1}, 17.3},  {{0, 0, 1}, 26.2},  {{0, 0, 1}, 39.4},
    {{0, 0, 1}, 11.9},   {{0, 0, 1}, 34.6},   {{0, 0, 1}, 22.8},  {{0, 0, 1}, 14.1},
};
enum { POSES = sizeof poses/sizeof *poses };

static const double no_scale[3] = {1, 1, 1}, no_translation[3] = {0, 0, 0};

/* Finds the best shift in one pose; writes the points too if asked. */
static tobi_status try_pose(const tobi_mesh *mesh, const pose *p, double spacing, int dimension,
                            double *error, double (**points)[3], int64_t *count, tobi_error *err)
{
    tobi_mesh turned;
    tobi_section section = {0};
    tobi_massprops whole;
    tobi_lines l = {0};
    int shift[3] = {0, 0, 0};
    TOBI_TRY(tobi_mesh_copy(mesh, &turned, err));
    tobi_status status = tobi_mesh_transform(&turned, no_scale, p->axis, p->degrees, no_translation, err);
    if (status == TOBI_OK)
        status = (dimension == 2 ? tobi_massprops_section : tobi_massprops_volume)(&turned, &whole, err);
    if (status == TOBI_OK && dimension == 2) status = tobi_section_cut(&turned, &section, err);
    if (status == TOBI_OK)
        status = tobi_lines_cut(&l, &turned, dimension == 2 ? &section : NULL, spacing/FINE, err);
    if (status == TOBI_OK) *error = choose_shift(&l, &whole, shift);
    if (status == TOBI_OK && points) {
        status = write_points(&l, shift, points, count, err);
        tobi_mesh cloud = {.vertex_count = *count, .vertices = *points};
        if (status == TOBI_OK)
            status = tobi_mesh_transform(&cloud, no_scale, p->axis, -p->degrees, no_translation, err);
    }
    tobi_lines_free(&l);
    tobi_section_free(&section);
    tobi_mesh_free(&turned);
    return status;
}

tobi_status tobi_sample_volume(const tobi_mesh *mesh, const tobi_bvh *bvh, double spacing, int dimension,
                               double (**points)[3], int64_t *count, tobi_error *err)
{
    (void)bvh;
    *points = NULL;
    *count = 0;
    if (!(spacing > 0) || !isfinite(spacing))
        return tobi_fail(err, TOBI_INVALID, "body spacing is %g m; it must be > 0", spacing);
    if (dimension != 2 && dimension != 3)
        return tobi_fail(err, TOBI_INVALID, "dimension is %d; allowed are 2 and 3", dimension);
    const pose *list = dimension == 2 ? flat_poses : poses;
    double best = INFINITY;
    int chosen = 0;
    for (int i = 0; i < POSES && best > (i == 1 ? ALLOWED : GOOD); i++) {
        double error = INFINITY;
        TOBI_TRY(try_pose(mesh, &list[i], spacing, dimension, &error, NULL, NULL, err));
        if (error < best) {
            best = error;
            chosen = i;
        }
    }
    if (isinf(best))
        return tobi_fail(err, TOBI_INVALID, "no particle fits into the body at a spacing of %g m; choose a "
                         "smaller one", spacing);
    return try_pose(mesh, &list[chosen], spacing, dimension, &best, points, count, err);
}

/* Quadrature points of bodies sorted into bins, so that a particle asks only the points near it. Bins of a
   row follow one another, and so do their points: nine runs hold all that can be near. Drawback: a copy of
   the points, 120 bytes each. */
#include "sph/boundary/boundary.h"
#include "sph/state.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

static int bin_along(const tobi_boundary_bins *c, double width, int a, double x)
{
    const double k = (x - c->lower[a])/width;
    return k < 0 ? -1 : k >= c->n[a] ? c->n[a] : (int)k;
}

static int within(const tobi_boundary_bins *c, int a, int k)
{
    return k < 0 ? 0 : k >= c->n[a] ? c->n[a] - 1 : k;
}

/* Lays the bins of all bodies out, cells of width h over the boxes. */
static tobi_status plan_bins(tobi_system *s, tobi_error *err)
{
    tobi_boundary_links *n = &sph_of(s)->links;
    const int bodies = s->sim->body_count;
    int64_t starts = 0, items = 0;
    TOBI_TRY(tobi_boundary_grow(&n->bins, &n->bins_capacity, bodies + 1, err));
    n->bin_width = s->smoothing.h;
    n->loops = TOBI_TABLE_OF(s->sim->exec.isa, tobi_look_loops);
    for (int k = 0; k < bodies; k++) {
        tobi_boundary_bins *c = &n->bins[k];
        double lo[3], hi[3];
        int64_t total = 1;
        tobi_bvh_box(s->sim->bodies[k].bvh, lo, hi);
        for (int a = 0; a < 3; a++) {
            c->lower[a] = lo[a];
            c->upper[a] = hi[a];
            c->n[a] = a == 2 && s->box.dimension == 2
                          ? 1
                          : (int)fmin((hi[a] - lo[a]) / n->bin_width + 1, 4096);
            total *= c->n[a];
        }
        if (s->box.dimension == 2) c->lower[2] = -0.5*n->bin_width;
        memcpy(c->orientation, s->sim->bodies[k].rigid.orientation, sizeof c->orientation);
        c->start = starts;
        c->item = items;
        starts += total + 2;
        items += s->sim->bodies[k].point_count;
    }
    n->bins[bodies] = (tobi_boundary_bins){.start = starts, .item = items};
    TOBI_TRY(tobi_boundary_grow(&n->bin_start, &n->start_capacity, starts, err));
    for (int r = 0; r < TOBI_POINT_ROWS; r++)
        TOBI_TRY(tobi_boundary_grow(&n->point_row[r], &n->row_room[r], items + 4, err));    /* read beyond */
    return tobi_boundary_grow(&n->point, &n->point_capacity, items, err);
}

static int64_t bin_of(const tobi_boundary_links *n, const tobi_boundary_bins *bins, const double x[3])
{
    int64_t bin = 0;
    for (int a = 2; a >= 0; a--)
        bin = bin*bins->n[a] + within(bins, a, bin_along(bins, n->bin_width, a, x[a]));
    return bin;
}

/* Bodies of which one may lie in the other: those that contact does not keep apart. */
static int may_overlap(const tobi_system *s, int k, int other)
{
    const tobi_body *b = s->sim->bodies;
    const tobi_boundary_bins *x = &sph_of(s)->links.bins[k], *y = &sph_of(s)->links.bins[other];
    if (k == other || b[other].is_absent) return 0;
    for (int a = 0; a < s->box.dimension; a++)
        if (x->lower[a] > y->upper[a] || y->lower[a] > x->upper[a]) return 0;
    return (b[k].rigid.kind == TOBI_PRESCRIBED && b[other].rigid.kind == TOBI_PRESCRIBED) ||
           tobi_constraints_join(&s->sim->constraints, k, other);
}

/* Whether no water is between bodies that lie flush: parts of one structure. On a vessel bodies stand as on a
   side of the domain. */
static int are_parts(const tobi_system *s, int k, int other)
{
    const tobi_body *b = s->sim->bodies;
    return (!b[k].vessel && !b[other].vessel) || tobi_constraints_join(&s->sim->constraints, k, other);
}

/* Marks the points of a body that lie in another one, or flush on it as its part. */
static void bury_points(const tobi_system *s, int k)
{
    const tobi_body *b = &s->sim->bodies[k];
    const double least = 1e-3*s->smoothing.spacing;
    if (b->rigid.kind != TOBI_PRESCRIBED && s->sim->constraints.count == 0) return;
    for (int other = 0; other < s->sim->body_count; other++) {
        if (!may_overlap(s, k, other)) continue;
        const int parts = are_parts(s, k, other);
        for (int64_t q = 0; q < b->point_count; q++) {
            tobi_bvh_hit hit;
            if (!tobi_bvh_closest(s->sim->bodies[other].bvh, b->point[q], s->smoothing.h, &hit)) continue;
            if (hit.signed_distance > least) continue;
            if (hit.signed_distance < -least || (parts && vec3_dot(hit.normal, b->normal[q]) < -0.5))
                b->wet[q] = TOBI_BURIED;
        }
    }
}

static tobi_boundary_point copy_point(const tobi_body *b, int64_t q)
{
    tobi_boundary_point p = {.number = (int32_t)q, .outermost = b->outermost[q]};
    p.area = b->wet[q] == TOBI_BURIED ? 0 : b->area[q];
    memcpy(p.at, b->point[q], sizeof p.at);
    memcpy(p.normal, b->normal[q], sizeof p.normal);
    return p;
}

/* Sorts a body's points into its bins; those without an area face nothing. */
static void fill_bins(const tobi_boundary_links *n, int k, const tobi_body *b)
{
    const tobi_boundary_bins *bins = &n->bins[k];
    int32_t *start = n->bin_start + bins->start;
    tobi_boundary_point *point = n->point + bins->item;
    const int64_t total = bins[1].start - bins->start - 2;
    memset(start, 0, (size_t)(total + 2)*sizeof *start);
    for (int64_t q = 0; q < b->point_count; q++) start[bin_of(n, bins, b->point[q]) + 2]++;
    for (int64_t c = 1; c <= total; c++) start[c + 1] += start[c];
    for (int64_t q = 0; q < b->point_count; q++)
        point[start[bin_of(n, bins, b->point[q]) + 1]++] = copy_point(b, q);
    for (int64_t q = 0; q < b->point_count; q++)
        for (int a = 0; a < 3; a++) {
            n->point_row[a][bins->item + q] = point[q].at[a];
            n->point_row[3 + a][bins->item + q] = point[q].area > 0 ? point[q].normal[a] : 0;
        }
}

static void prepare_bodies(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    (void)totals;
    for (int64_t k = begin; k < end; k++) {
        const tobi_body *b = &s->sim->bodies[k];
        memset(b->wet, 0, (size_t)b->point_count);
        memset(b->covered, 0, (size_t)b->point_count*sizeof *b->covered);
        bury_points(s, (int)k);
        fill_bins(&sph_of(s)->links, (int)k, b);
    }
}

tobi_status tobi_boundary_place_points(tobi_system *s, tobi_error *err)
{
    TOBI_TRY(plan_bins(s, err));
    tobi_launch_each(&s->sim->exec, TOBI_HOST(prepare_bodies, 0, 0), s, s->sim->body_count, NULL);
    return TOBI_OK;
}

int tobi_boundary_runs(const tobi_boundary_links *n, int64_t body, const double x[3],
                       tobi_point_run run[TOBI_POINT_RUNS])
{
    const tobi_boundary_bins *bins = &n->bins[body];
    const int32_t *start = n->bin_start + bins->start;
    const tobi_boundary_point *point = n->point + bins->item;
    int low[3], high[3], runs = 0;
    for (int a = 0; a < 3; a++) {
        const int c = bin_along(bins, n->bin_width, a, x[a]);
        const double beyond = c < 0 ? bins->lower[a] - x[a]
                                    : x[a] - (bins->lower[a] + bins->n[a] * n->bin_width);
        if ((c < 0 || c >= bins->n[a]) && beyond > n->bin_width) return 0;
        low[a] = within(bins, a, c - 1);
        high[a] = within(bins, a, c + 1);
    }
    for (int z = low[2]; z <= high[2]; z++)
        for (int y = low[1]; y <= high[1]; y++) {
            const int32_t *row = start + ((int64_t)z*bins->n[1] + y)*bins->n[0];
            if (row[low[0]] < row[high[0] + 1])
                run[runs++] = (tobi_point_run){point + row[low[0]], point + row[high[0] + 1]};
        }
    return runs;
}

void tobi_boundary_take_facing(const tobi_boundary_links *n, int64_t body, const double x[3], double reach,
                               void (*take)(void *user, tobi_facing_points *list), void *user)
{
    tobi_point_run run[TOBI_POINT_RUNS];
    tobi_facing_points list;
    const int runs = tobi_boundary_runs(n, body, x, run);
    list.count = 0;
    list.all = n->point;
    for (int r = 0; r < runs; r++) {
        int64_t begin = run[r].begin - n->point, end = run[r].end - n->point;
        while (begin < end) {
            const int64_t room = begin + TOBI_FACING_MOST - list.count, stop = end < room ? end : room;
            n->loops->list(n->point_row, begin, stop, x, reach*reach, &list);
            begin = stop;
            if (list.count < TOBI_FACING_MOST) continue;
            take(user, &list);
            list.count = 0;
        }
    }
    if (list.count > 0) take(user, &list);
}

void tobi_facing_weigh(tobi_facing_points *l, const tobi_smoothing_constants *c)
{
    tobi_smoothing_weigh(c->shape, c->dimension, c->h, l->count, l->square, l->weight);
}

tobi_point_run tobi_boundary_nearest_run(const tobi_boundary_links *n, int64_t body, const double x[3])
{
    const tobi_boundary_bins *bins = &n->bins[body];
    const int32_t *start = n->bin_start + bins->start + bin_of(n, bins, x);
    const tobi_boundary_point *point = n->point + bins->item;
    return (tobi_point_run){point + start[0], point + start[1]};
}

int tobi_boundary_visit(const tobi_boundary_links *n, int64_t body, const double x[3],
                        int (*visit)(void *user, int32_t point), void *user)
{
    tobi_point_run run[TOBI_POINT_RUNS];
    const int runs = tobi_boundary_runs(n, body, x, run);
    for (int r = 0; r < runs; r++)
        for (const tobi_boundary_point *p = run[r].begin; p < run[r].end; p++)
            if (visit(user, p->number)) return 1;
    return 0;
}

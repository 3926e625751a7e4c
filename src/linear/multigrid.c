/* The cell multigrid: levels of nodes by halving, Gauss-Seidel in two colours, values constant over groups of
   eight nodes between levels. Weights come from the points themselves, so any shape of the liquid has a
   grid without a matrix being assembled; in exchange the grid's equation is not exactly that of the points.
   Drawback: it covers the whole box, wet or dry. */
#include "linear/multigrid.h"
#include "linear/grid_view.h"
#include "linear/kernels.h"
#include <string.h>

enum { THREADED = 8000,        /* nodes from which a sweep is worth sharing */
       GRID_ARRAYS = 7 };      /* of a level                                */

static int64_t nodes_of(const tobi_grid_level *g) { return (int64_t)g->n[0]*g->n[1]*g->n[2]; }

/* Sizes of all levels; returns the number of nodes. */
static int64_t plan(tobi_multigrid *m)
{
    const tobi_cell_points *p = &m->points;
    int64_t total = 0;
    for (int a = 0; a < 3; a++) {
        m->cells[a] = (p->n[a] + m->wide - 1)/m->wide;
        m->per_metre[a] = p->inverse[a]/m->wide;
        m->grid[0].n[a] = a >= p->dimension ? 1 : m->cells[a] + !p->periodic[a];
    }
    for (m->levels = 1;; m->levels++) {
        const tobi_grid_level *fine = &m->grid[m->levels - 1];
        total += nodes_of(fine);
        if (nodes_of(fine) <= 8 || m->levels == TOBI_GRID_LEVELS) return total;
        tobi_grid_level *coarse = &m->grid[m->levels];
        for (int a = 0; a < 3; a++) {
            coarse->n[a] = (fine->n[a] + 1)/2;
            coarse->odd |= a < p->dimension && p->periodic[a] && coarse->n[a] > 1 && coarse->n[a]%2;
        }
    }
}

tobi_status tobi_multigrid_create(tobi_multigrid *m, const tobi_cell_points *p, int wide, int visits,
                                  tobi_error *err)
{
    memset(m, 0, sizeof *m);
    m->points = *p;
    m->wide = wide;
    m->visits = visits;
    const int64_t total = plan(m), cells = (int64_t)m->cells[0]*m->cells[1]*m->cells[2];
    m->memory = tobi_array_zero(total*GRID_ARRAYS, sizeof *m->memory);
    m->corner = tobi_array_zero(cells, sizeof *m->corner);
    if (!m->memory || !m->corner) {
        tobi_multigrid_free(m);
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a grid of %lld nodes", (long long)total);
    }
    float *at = m->memory;
    for (int l = 0; l < m->levels; l++) {
        tobi_grid_level *g = &m->grid[l];
        float **array[] = {&g->value, &g->source, &g->next, &g->face[0], &g->face[1], &g->face[2],
                           &g->inverse};
        for (int k = 0; k < GRID_ARRAYS; k++, at += nodes_of(g)) *array[k] = at;
    }
    return TOBI_OK;
}

static int64_t sum_bytes(const tobi_multigrid *m, int64_t nodes)
{
    return nodes*GRID_ARRAYS*(int64_t)sizeof *m->memory +
           (int64_t)m->cells[0]*m->cells[1]*m->cells[2]*(int64_t)sizeof *m->corner;
}

int64_t tobi_multigrid_plan_bytes(const tobi_cell_points *p, int wide)
{
    tobi_multigrid m = { .points = *p, .wide = wide };
    const int64_t nodes = plan(&m);
    return sum_bytes(&m, nodes);
}

int64_t tobi_multigrid_bytes(const tobi_multigrid *m)
{
    int64_t nodes = 0;
    if (!m->memory) return 0;
    for (int l = 0; l < m->levels; l++) nodes += nodes_of(&m->grid[l]);
    return sum_bytes(m, nodes);
}

void tobi_multigrid_free(tobi_multigrid *m)
{
    tobi_array_free(m->memory);
    tobi_array_free(m->corner);
    memset(m, 0, sizeof *m);
}

tobi_grid_values tobi_multigrid_values(const tobi_multigrid *m)
{
    tobi_grid_values v = {.value = m->grid[0].value, .dimension = m->points.dimension};
    memcpy(v.per_metre, m->per_metre, sizeof v.per_metre);
    memcpy(v.n, m->grid[0].n, sizeof v.n);
    return v;
}

/* A kernel over rows, on threads if the nodes are worth waking them. */
static void launch_rows(tobi_exec *x, tobi_kernel kernel, const tobi_grid_view *v, int64_t rows,
                        int64_t nodes)
{
    double unused[TOBI_TOTALS];
    if (nodes >= THREADED) tobi_launch_each(x, kernel, v, rows, NULL);
    else kernel.run(v, 0, rows, unused);
}

static void launch_nodes(tobi_exec *x, tobi_kernel kernel, const tobi_grid_view *v)
{
    launch_rows(x, kernel, v, (int64_t)v->g.n[1]*v->g.n[2], nodes_of(&v->g));
}

static const tobi_linear_kernels *kernels_of(const tobi_exec *x) { return tobi_linear_kernels_for(x->isa); }

/* Both colours, the first or the second of them first; or twice all nodes. */
static void sweep(tobi_exec *x, tobi_grid_view *v, int second_first)
{
    const tobi_linear_kernels *k = kernels_of(x);
    for (int s = 0; s < 2; s++) {
        v->colour = s ^ second_first;
        launch_nodes(x, v->g.odd ? k->grid_relax : k->grid_sweep, v);
        if (!v->g.odd) continue;
        float *made = v->g.next;
        v->g.next = v->g.value;
        v->g.value = made;
    }
}

/* From nothing, or from the value that an earlier cycle left. */
static void cycle(const tobi_multigrid *m, tobi_exec *x, int level, int from_nothing)
{
    const tobi_linear_kernels *k = kernels_of(x);
    const int coarsest = level + 1 == m->levels, rounds = coarsest ? 8 : 1;
    tobi_grid_view v = {.g = m->grid[level]};
    if (from_nothing) memset(v.g.value, 0, (size_t)nodes_of(&v.g)*sizeof *v.g.value);
    for (int s = 0; s < rounds; s++) sweep(x, &v, 0);
    if (!coarsest) {
        tobi_grid_view down = {.g = m->grid[level + 1], .other = v.g};
        launch_nodes(x, k->grid_restrict, &down);
        cycle(m, x, level + 1, 1);
        for (int k = 1; k < m->visits && level + 2 < m->levels; k++) cycle(m, x, level + 1, 0);
        v.other = m->grid[level + 1];
        launch_nodes(x, k->grid_prolong, &v);
    }
    for (int s = 0; s < rounds; s++) sweep(x, &v, 1);
}

/* A view of the points and the finest grid. */
static tobi_grid_view see_points(const tobi_multigrid *m)
{
    tobi_grid_view v = {.g = m->grid[0], .points = m->points, .wide = m->wide, .corner = m->corner,
                        .scale = 1, .factor = 1};
    memcpy(v.cells, m->cells, sizeof v.cells);
    memcpy(v.per_metre, m->per_metre, sizeof v.per_metre);
    return v;
}

/* out = scale P^T share. */
static void gather(const tobi_multigrid *m, tobi_exec *x, const tobi_grid_view *v)
{
    const tobi_linear_kernels *k = kernels_of(x);
    launch_rows(x, k->grid_sum_cells, v, (int64_t)m->cells[1]*m->cells[2], nodes_of(&v->g));
    launch_nodes(x, k->grid_collect, v);
}

/* Faces of the finest grid, from the count of points, or the sum of their shares, in grid[0].value. */
static void set_faces(const tobi_multigrid *m, tobi_exec *x, const tobi_grid_weights *w)
{
    tobi_grid_view v = see_points(m);
    double full = 1/w->volume;
    for (int a = 0; a < m->points.dimension; a++) full /= m->per_metre[a];
    v.full = (float)full;
    for (v.axis = 0; v.axis < m->points.dimension; v.axis++) {
        const double per = m->per_metre[v.axis];
        v.face = (float)(w->strength*full*per*per);
        launch_nodes(x, kernels_of(x)->grid_wet_faces, &v);
    }
}

/* What rows have beside the Laplacian, to grid[0].value. */
static void set_holds(const tobi_multigrid *m, tobi_exec *x, const tobi_grid_weights *w)
{
    tobi_grid_view v = see_points(m);
    v.out = v.g.value;
    v.share = w->excess ? TOBI_SHARE_DOUBLE : TOBI_SHARE_BYTE;
    v.value = w->excess ? (const void *)w->excess : w->marked;
    if (!w->excess) v.scale = (float)w->hold;
    if (v.value) gather(m, x, &v);
    else memset(v.g.value, 0, (size_t)nodes_of(&v.g)*sizeof *v.g.value);
}

void tobi_multigrid_set(tobi_multigrid *m, tobi_exec *x, const tobi_cell_points *p,
                        const tobi_grid_weights *w)
{
    const tobi_linear_kernels *k = kernels_of(x);
    m->points = *p;
    tobi_grid_view v = see_points(m);
    v.out = v.g.value;
    v.share = w->share ? TOBI_SHARE_DOUBLE : TOBI_SHARE_ONE;
    v.value = w->share;
    gather(m, x, &v);
    set_faces(m, x, w);
    v.share = TOBI_SHARE_ONE;
    v.active = w->active;
    v.out = v.g.source;
    gather(m, x, &v);
    set_holds(m, x, w);
    for (int l = 0; l < m->levels; l++) {
        tobi_grid_view n = {.g = m->grid[l]};
        if (l > 0) {
            n.other = m->grid[l - 1];
            n.points = m->points;
            launch_nodes(x, k->grid_coarsen, &n);
        }
        launch_nodes(x, k->grid_diagonal, &n);
    }
}

double tobi_multigrid_apply(tobi_multigrid *m, tobi_exec *x, const float *r, const float *active)
{
    tobi_grid_view v = see_points(m);
    double dot = 0;
    v.share = TOBI_SHARE_FLOAT;
    v.value = r;
    v.active = active;
    v.out = v.g.source;
    gather(m, x, &v);
    cycle(m, x, 0, 1);
    for (int64_t c = 0; c < nodes_of(&v.g); c++) dot += (double)v.g.source[c]*v.g.value[c];
    return dot;
}

/* The residual is shared as a number near 1 whatever its size: the grid computes in float. */
void tobi_multigrid_cycle(tobi_multigrid *m, tobi_exec *x, const tobi_linear_system *a, const double *inverse,
                          double damping, double *scratch, double *z, const double *r)
{
    const tobi_linear_kernels *k = kernels_of(x);
    tobi_grid_view v = see_points(m);
    double totals[TOBI_TOTALS];
    v.inverse = inverse;
    v.damping = damping;
    v.r = r;
    v.z = z;
    v.t = scratch;
    tobi_launch(x, k->grid_smooth_first, &v, 0, a->rows, NULL);
    a->apply(a->user, scratch, z);
    tobi_launch(x, k->grid_point_residual, &v, 0, a->rows, totals);
    if (totals[6] > 0) {
        v.share = TOBI_SHARE_DOUBLE;
        v.value = scratch;
        v.factor = 1/totals[6];
        v.out = v.g.source;
        gather(m, x, &v);
        cycle(m, x, 0, 1);
        v.coarse = tobi_multigrid_values(m);
        v.factor = totals[6];
        tobi_launch(x, k->grid_add_coarse, &v, 0, a->rows, NULL);
        a->apply(a->user, scratch, z);
    }
    tobi_launch(x, k->grid_smooth_last, &v, 0, a->rows, NULL);
}

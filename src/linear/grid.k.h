/* The multigrid's kernels. One item is a row (y, z) of nodes or of cells, or a point. A row writes only its
   own nodes. */
#pragma once
#include "exec/strips.h"
#include "linear/grid_view.h"
#include "linear/value.k.h"

/* Offset to the node after and before number k along an axis; the ends wrap (with a face of 0 where they
   must not). */
TOBI_FN int64_t grid_after(const tobi_grid_level *g, int axis, int k, int64_t stride)
{
    return k + 1 < g->n[axis] ? stride : -(int64_t)(g->n[axis] - 1)*stride;
}
TOBI_FN int64_t grid_before(const tobi_grid_level *g, int axis, int k, int64_t stride)
{
    return k > 0 ? -stride : (int64_t)(g->n[axis] - 1)*stride;
}

/* Sum of face times value over the neighbours of node c. */
TOBI_FN float grid_pull(const tobi_grid_level *g, int x, int y, int z, int64_t c)
{
    const int at[3] = {x, y, z};
    int64_t stride = 1;
    float sum = 0;
    for (int a = 0; a < 3; a++) {
        int64_t up = c + grid_after(g, a, at[a], stride), down = c + grid_before(g, a, at[a], stride);
        sum += g->face[a][c]*g->value[up] + g->face[a][down]*g->value[down];
        stride *= g->n[a];
    }
    return sum;
}

/* Gauss-Seidel over the nodes of one colour. */
TOBI_FN void grid_sweep(const tobi_grid_view *v, int64_t i, double *totals)
{
    const tobi_grid_level *g = &v->g;
    const int y = (int)(i%g->n[1]), z = (int)(i/g->n[1]);
    const int64_t row = i*g->n[0];
    (void)totals;
    for (int x = (y + z + v->colour) & 1; x < g->n[0]; x += 2)
        if (g->inverse[row + x] > 0)
            g->value[row + x] = (g->source[row + x] + grid_pull(g, x, y, z, row + x))*g->inverse[row + x];
}

/* Damped Jacobi over all nodes, value to next: where an odd number of nodes wraps, two colours do not do,
   and an order of nodes would not be symmetric. */
TOBI_FN void grid_relax(const tobi_grid_view *v, int64_t i, double *totals)
{
    const tobi_grid_level *g = &v->g;
    const int y = (int)(i%g->n[1]), z = (int)(i/g->n[1]);
    const int64_t row = i*g->n[0];
    (void)totals;
    for (int x = 0; x < g->n[0]; x++) {
        const int64_t c = row + x;
        const float answer = (g->source[c] + grid_pull(g, x, y, z, c))*g->inverse[c];
        g->next[c] = g->inverse[c] > 0 ? g->value[c] + 0.8f*(answer - g->value[c]) : g->value[c];
    }
}

/* source = the residual of the finer level, summed over groups of eight nodes. */
TOBI_FN void grid_restrict(const tobi_grid_view *v, int64_t i, double *totals)
{
    const tobi_grid_level *g = &v->g, *fine = &v->other;
    const int y = (int)(i%g->n[1]), z = (int)(i/g->n[1]);
    float *out = g->source + i*g->n[0];
    (void)totals;
    for (int x = 0; x < g->n[0]; x++) out[x] = 0;
    for (int zz = 2*z; zz < 2*z + 2 && zz < fine->n[2]; zz++)
        for (int yy = 2*y; yy < 2*y + 2 && yy < fine->n[1]; yy++)
            for (int x = 0; x < fine->n[0]; x++) {
                int64_t c = ((int64_t)zz*fine->n[1] + yy)*fine->n[0] + x;
                if (fine->inverse[c] > 0)
                    out[x/2] += fine->source[c] + grid_pull(fine, x, yy, zz, c) -
                                fine->value[c]/fine->inverse[c];
            }
}

TOBI_FN void grid_prolong(const tobi_grid_view *v, int64_t i, double *totals)
{
    const tobi_grid_level *g = &v->g, *coarse = &v->other;
    const int y = (int)(i%g->n[1]), z = (int)(i/g->n[1]);
    const float *in = coarse->value + ((int64_t)(z/2)*coarse->n[1] + y/2)*coarse->n[0];
    const int64_t row = i*g->n[0];
    (void)totals;
    for (int x = 0; x < g->n[0]; x++)
        if (g->inverse[row + x] > 0) g->value[row + x] += in[x/2];
}

TOBI_FN float grid_share(const tobi_grid_view *v, int64_t i)
{
    if (v->active && !(v->active[i] > 0)) return 0;
    if (v->share == TOBI_SHARE_FLOAT) return ((const float *)v->value)[i];
    if (v->share == TOBI_SHARE_DOUBLE) return (float)(((const double *)v->value)[i]*v->factor);
    if (v->share == TOBI_SHARE_BYTE) return ((const uint8_t *)v->value)[i];
    return 1;
}

/* Adds the points begin to end, which lie in grid cell `at`, to the sums of its corners. */
TOBI_FN void grid_add_points(const tobi_grid_view *v, int64_t begin, int64_t end, const int at[3],
                             float sum[8])
{
    for (int64_t i = begin; i < end; i++) {
        const double *q = &v->points.position[i].x;
        float s = grid_share(v, i), w[3][2];
        for (int a = 0; a < 3; a++) {
            w[a][1] = a < v->points.dimension ? (float)(q[a]*v->per_metre[a] - at[a]) : 0;
            w[a][0] = 1 - w[a][1];
        }
        for (int k = 0; k < 8; k++) sum[k] += s*w[0][k & 1]*w[1][k >> 1 & 1]*w[2][k >> 2];
    }
}

/* corner = what the points of each cell of a row add to its corners. */
TOBI_FN void grid_sum_cells(const tobi_grid_view *v, int64_t i, double *totals)
{
    const tobi_cell_points *p = &v->points;
    const int wide = v->wide, y = (int)(i%v->cells[1]), z = (int)(i/v->cells[1]);
    (void)totals;
    for (int x = 0; x < v->cells[0]; x++) {
        const int at[3] = {x, y, z}, last = wide*(x + 1) < p->n[0] ? wide*(x + 1) : p->n[0];
        float *sum = v->corner[i*v->cells[0] + x];
        for (int k = 0; k < 8; k++) sum[k] = 0;
        for (int zz = wide*z; zz < wide*(z + 1) && zz < p->n[2]; zz++)
            for (int yy = wide*y; yy < wide*(y + 1) && yy < p->n[1]; yy++) {
                const int64_t row = tobi_strip_row(p->n, p->strip, yy, zz);
                grid_add_points(v, p->start[row + wide*x], p->start[row + last], at, sum);
            }
    }
}

/* The cell before (side 0) or after (side 1) node k along an axis, -1 = none. */
TOBI_FN int grid_cell_beside(const tobi_grid_view *v, int axis, int k, int side)
{
    int c = k - 1 + side;
    if (axis >= v->points.dimension) return side ? 0 : -1;
    if (c >= 0 && c < v->cells[axis]) return c;
    return v->points.periodic[axis] ? (c + v->cells[axis])%v->cells[axis] : -1;
}

/* out = P^T share: the corner sums of the cells around each node, times scale. */
TOBI_FN void grid_collect(const tobi_grid_view *v, int64_t i, double *totals)
{
    const int y = (int)(i%v->g.n[1]), z = (int)(i/v->g.n[1]);
    (void)totals;
    for (int x = 0; x < v->g.n[0]; x++) {
        float sum = 0;
        for (int k = 0; k < 8; k++) {
            int cx = grid_cell_beside(v, 0, x, k & 1), cy = grid_cell_beside(v, 1, y, k >> 1 & 1),
                cz = grid_cell_beside(v, 2, z, k >> 2);
            if (cx < 0 || cy < 0 || cz < 0) continue;
            sum += v->corner[((int64_t)cz*v->cells[1] + cy)*v->cells[0] + cx][7 - k];
        }
        v->out[i*v->g.n[0] + x] = sum*v->scale;
    }
}

/* The face between two nodes is as wet as the drier one; value counts points per node. */
TOBI_FN void grid_wet_faces(const tobi_grid_view *v, int64_t i, double *totals)
{
    const tobi_grid_level *g = &v->g;
    const int a = v->axis, y = (int)(i%g->n[1]), z = (int)(i/g->n[1]);
    const int64_t stride = a == 0 ? 1 : a == 1 ? g->n[0] : (int64_t)g->n[0]*g->n[1];
    (void)totals;
    for (int x = 0; x < g->n[0]; x++) {
        const int64_t c = i*g->n[0] + x;
        const int k = a == 0 ? x : a == 1 ? y : z;
        /* no wrap over an odd number of nodes: its ends have one colour; the points know of it */
        const int end = k + 1 == g->n[a] && (!v->points.periodic[a] || g->n[a]%2);
        const float here = g->value[c], next = g->value[c + grid_after(g, a, k, stride)];
        const float wet = (next < here ? next : here)/v->full;
        g->face[a][c] = end ? 0 : v->face*(wet < 1 ? wet : 1);
    }
}

/* inverse = 1/(sum of faces + what holds the value down, in `value`) where something is solved. */
TOBI_FN void grid_diagonal(const tobi_grid_view *v, int64_t i, double *totals)
{
    const tobi_grid_level *g = &v->g;
    const int y = (int)(i%g->n[1]), z = (int)(i/g->n[1]);
    (void)totals;
    for (int x = 0; x < g->n[0]; x++) {
        const int at[3] = {x, y, z};
        int64_t c = i*g->n[0] + x, stride = 1;
        float sum = g->value[c];
        for (int a = 0; a < 3; a++) {
            sum += g->face[a][c] + g->face[a][c + grid_before(g, a, at[a], stride)];
            stride *= g->n[a];
        }
        g->inverse[c] = g->source[c] > 0 && sum > 0 ? 1/sum : 0;
    }
}

/* Node (x, y, z) of the next level: faces halve (twice the distance), what holds and is solved adds up. */
TOBI_FN void grid_coarsen_node(const tobi_grid_view *v, int x, int y, int z, int64_t c)
{
    const tobi_grid_level *g = &v->g, *f = &v->other;
    float face[3] = {0, 0, 0}, hold = 0, solved = 0;
    for (int k = 0; k < 8; k++) {
        const int at[3] = {2*x + (k & 1), 2*y + (k >> 1 & 1), 2*z + (k >> 2)};
        if (at[0] >= f->n[0] || at[1] >= f->n[1] || at[2] >= f->n[2]) continue;
        const int64_t i = ((int64_t)at[2]*f->n[1] + at[1])*f->n[0] + at[0];
        for (int a = 0; a < 3; a++)
            if (at[a]%2 == 1 || at[a] + 1 == f->n[a]) face[a] += 0.5f*f->face[a][i];
        hold += f->value[i];
        solved += f->source[i];
    }
    for (int a = 0; a < 3; a++) g->face[a][c] = face[a];
    g->value[c] = hold;
    g->source[c] = solved;
}
TOBI_FN void grid_coarsen(const tobi_grid_view *v, int64_t i, double *totals)
{
    const int y = (int)(i%v->g.n[1]), z = (int)(i/v->g.n[1]);
    (void)totals;
    for (int x = 0; x < v->g.n[0]; x++) grid_coarsen_node(v, x, y, z, i*v->g.n[0] + x);
}

/* Points: z = w D^-1 r from nothing, */
TOBI_FN void grid_smooth_first(const tobi_grid_view *v, int64_t i, double *totals)
{
    (void)totals;
    v->z[i] = v->damping*v->inverse[i]*v->r[i];
}
/* what that leaves, t = r - t with t = A z; totals: the largest, */
TOBI_FN void grid_point_residual(const tobi_grid_view *v, int64_t i, double *totals)
{
    const double t = v->inverse[i] > 0 ? v->r[i] - v->t[i] : 0, size = t < 0 ? -t : t;
    v->t[i] = t;
    totals[6] = size > totals[6] ? size : totals[6];
}
/* the grid's answer, where the residual was shared times 1/factor, */
TOBI_FN void grid_add_coarse(const tobi_grid_view *v, int64_t i, double *totals)
{
    (void)totals;
    if (v->inverse[i] > 0)
        v->z[i] += v->factor*(double)tobi_grid_value(&v->coarse, &v->points.position[i].x);
}
/* and z += w D^-1 (r - t) once more. */
TOBI_FN void grid_smooth_last(const tobi_grid_view *v, int64_t i, double *totals)
{
    (void)totals;
    v->z[i] += v->damping*v->inverse[i]*(v->r[i] - v->t[i]);
}

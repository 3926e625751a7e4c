/* A pool of jittered particles and the compact symmetric Laplacian of incompressible SPH over it, in double:
   a_ij = V F_ij (k_i + k_j) with mirrored neighbours at walls, (A p)_i = sum_j a_ij (p_i - p_j) + e_i p_i,
   where e_i is what rows at the free surface lack. F is scaled so that sum V F x^2 = 1 on the lattice. */
#pragma once
#include "core/cells.h"
#include "linear/multigrid.h"
#include "linear/solve.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POISSON_JACOBI, POISSON_CYCLE };

typedef struct poisson {
    tobi_exec exec;
    tobi_box box;
    tobi_cells cells;
    tobi_particles p;
    double d, h, scale, full;        /* full: the row's sum on the lattice                          */
    double *weight;                  /* of each entry of the list                                   */
    double *factor;                  /* k_i; before: tr M_i                                         */
    double *excess, *inverse, *b, *x, *scratch, *work;
    tobi_linear_system system;
    tobi_multigrid grid;
    int kind, products;
    double wall;                     /* m: so high a thin wall stands in the middle, 0 = none       */
    const double *in;                /* of the product at hand                                      */
    double *out;
} poisson;

static uint64_t poisson_seed = 5;
/* Uniform in -1..1. */
static double poisson_random(void)
{
    poisson_seed = poisson_seed*6364136223846793005u + 1442695040888963407u;
    return (double)(poisson_seed >> 11)/4503599627370496.0 - 1;
}

static double poisson_falloff(const poisson *q, double r2)
{
    const double s = 1 - sqrt(r2)/q->h;
    return s > 0 ? q->scale*s*s*s : 0;
}

/* Scales F, and the full row, by the lattice. */
static void poisson_measure_lattice(poisson *q, int dimension)
{
    const int m = (int)(q->h/q->d) + 1, deep = dimension == 3 ? m : 0;
    double moment = 0, sum = 0;
    q->scale = 1;
    for (int z = -deep; z <= deep; z++)
        for (int y = -m; y <= m; y++)
            for (int x = -m; x <= m; x++) {
                const double f = poisson_falloff(q, q->d*q->d*(x*x + y*y + z*z));
                moment += f*q->d*q->d*x*x;
                sum += x || y || z ? f : 0;
            }
    q->scale = 1/moment;             /* V is part of F from here on */
    q->full = 2*sum/moment;
}

typedef struct poisson_pair { double f, moment, source; } poisson_pair;

/* One axis of a pair: the distance to j itself and to its images at the two walls; returns how many. */
static int poisson_offsets(const poisson *q, int a, int64_t i, int64_t j, double offset[3])
{
    const double x = (&q->p.position[i].x)[a], y = (&q->p.position[j].x)[a], size = q->box.size[a];
    offset[0] = x - y;
    if (a >= q->box.dimension) return 1;
    if (q->box.periodic[a]) {
        offset[0] -= size*round(offset[0]/size);
        return 1;
    }
    offset[1] = x + y;
    offset[2] = x + y - 2*size;
    return 3;
}

/* 1: the thin wall stands between i and j; it mirrors nothing. */
static int poisson_apart(const poisson *q, int64_t i, int64_t j)
{
    const double *x = &q->p.position[i].x, *y = &q->p.position[j].x, middle = 0.5*q->box.size[0] + 0.3*q->d;
    const int up = q->box.dimension - 1;
    return (x[0] < middle) != (y[0] < middle) && fmin(x[up], y[up]) < q->wall;
}

/* F, F r^2 and the hydrostatic source over j and all its images; of itself only the images. */
static poisson_pair poisson_sum(const poisson *q, int64_t i, int64_t j)
{
    double x[3], y[3], z[3];
    const int n[3] = {poisson_offsets(q, 0, i, j, x), poisson_offsets(q, 1, i, j, y),
                      poisson_offsets(q, 2, i, j, z)};
    const int up = q->box.dimension - 1;
    poisson_pair s = {0, 0, 0};
    for (int c = 0; c < n[2]; c++)
        for (int b = 0; b < n[1]; b++)
            for (int a = 0; a < n[0]; a++) {
                const double r2 = x[a]*x[a] + y[b]*y[b] + z[c]*z[c];
                if (r2 >= q->h*q->h || (i == j && !a && !b && !c)) continue;
                const double f = poisson_falloff(q, r2), v = up == 1 ? y[b] - y[0] : z[c] - z[0];
                s.f += f;
                s.moment += f*r2;
                s.source += f*v;
            }
    return s;
}

static int64_t poisson_neighbour(const poisson *q, int64_t i, int64_t k)
{
    return tobi_list_at(q->cells.list, q->cells.list_far, i, k);
}

#define POISSON_NEIGHBOURS(q, i, k)                                                                  \
    for (int64_t k = 8*(int64_t)(q)->cells.list_start[i], end_ = k + 8*(int64_t)(q)->cells.list_groups[i];  \
         k < end_; k++)

static void poisson_moments(const void *view, int64_t begin, int64_t end, double *totals)
{
    const poisson *q = view;
    (void)totals;
    for (int64_t i = begin; i < end; i++) {
        double moment = poisson_sum(q, i, i).moment;
        POISSON_NEIGHBOURS(q, i, k)
            if (poisson_neighbour(q, i, k) != i)
                moment += poisson_sum(q, i, poisson_neighbour(q, i, k)).moment;
        q->factor[i] = moment;
    }
}

static double poisson_factor(const poisson *q, int64_t i)
{
    const int dim = q->box.dimension;
    return fmin(1.3, dim/fmax(q->factor[i], 0.95*dim));
}

static void poisson_rows(const void *view, int64_t begin, int64_t end, double *totals)
{
    const poisson *q = view;
    const int dim = q->box.dimension;
    (void)totals;
    for (int64_t i = begin; i < end; i++) {
        const double ki = poisson_factor(q, i), loss = 1 - q->factor[i]/dim;
        const poisson_pair own = poisson_sum(q, i, i);
        double sum = 0;
        q->b[i] = 2*ki*own.source;
        POISSON_NEIGHBOURS(q, i, k) {
            const int64_t j = poisson_neighbour(q, i, k);
            const int none = j == i || poisson_apart(q, i, j);
            const poisson_pair s = none ? (poisson_pair){0, 0, 0} : poisson_sum(q, i, j);
            const double both = ki + poisson_factor(q, j);
            q->weight[k] = s.f*both;
            q->b[i] += s.source*both;
            sum += q->weight[k];
        }
        const double open = fmin(fmax((loss - 0.05)/0.1, 0), 1);
        q->excess[i] = 2*open*fmax(q->full - sum - 2*ki*own.f, 0.5*loss*q->full);
        q->inverse[i] = 1/(sum + q->excess[i]);
    }
}

static void poisson_product(const void *view, int64_t begin, int64_t end, double *totals)
{
    const poisson *q = view;
    (void)totals;
    for (int64_t i = begin; i < end; i++) {
        double sum = q->excess[i]*q->in[i];
        POISSON_NEIGHBOURS(q, i, k) sum += q->weight[k]*(q->in[i] - q->in[poisson_neighbour(q, i, k)]);
        q->out[i] = sum;
    }
}

static void poisson_apply(void *user, double *y, const double *x)
{
    poisson *q = user;
    q->in = x;
    q->out = y;
    q->products++;
    tobi_launch(&q->exec, TOBI_HOST(poisson_product, 0, 0), q, 0, q->p.count, NULL);
}

static void poisson_precondition(void *user, double *z, const double *r)
{
    poisson *q = user;
    if (q->kind == POISSON_CYCLE)
        tobi_multigrid_cycle(&q->grid, &q->exec, &q->system, q->inverse, 0.7, q->scratch, z, r);
    else
        for (int64_t i = 0; i < q->p.count; i++) z[i] = q->inverse[i]*r[i];
}

/* A pool n[0] x n[1] (x n[2]) spacings with its last axis upwards; closed: full to the lid. */
static tobi_status poisson_fill(poisson *q, int dimension, const int n[3], int closed, int threads)
{
    static tobi_error err;
    const double lower[3] = {-3, 1, 2};
    const int none[3] = {0, 0, 0};
    double upper[3] = {0, 0, 0};
    int64_t count = 1, i = 0;
    memset(q, 0, sizeof *q);
    q->d = 0.01;
    q->h = 2.5*q->d;
    for (int a = 0; a < dimension; a++) {
        count *= n[a];
        upper[a] = lower[a] + q->d*(n[a] + (a + 1 < dimension || closed ? 0 : 6));
    }
    tobi_box_init(&q->box, dimension, lower, upper, none, q->h);
    TOBI_TRY(tobi_exec_init(&q->exec, threads, &err));
    TOBI_TRY(tobi_particles_create(&q->p, NULL, 0, count, &err));
    TOBI_TRY(tobi_cells_create(&q->cells, &q->box, q->h, &q->p, &q->exec, &err));
    TOBI_TRY(tobi_exec_reserve(&q->exec, count, &err));
    for (int z = 0; z < (dimension == 3 ? n[2] : 1); z++)
        for (int y = 0; y < n[1]; y++)
            for (int x = 0; x < n[0]; x++, i++) {
                const int at[3] = {x, y, z};
                for (int a = 0; a < dimension; a++)
                    (&q->p.position[i].x)[a] = q->d*(at[a] + 0.5 + 0.15*poisson_random());
            }
    q->p.count = count;
    tobi_cells_sort(&q->cells, &q->box, &q->p, NULL, &q->exec);
    TOBI_TRY(tobi_cells_list(&q->cells, &q->box, q->h, &q->p, &q->exec, &err));
    poisson_measure_lattice(q, dimension);
    return TOBI_OK;
}

/* The matrix, the hydrostatic source with noise, the memory for a solve. */
static inline void poisson_assemble(poisson *q)
{
    const int64_t n = q->p.count;
    double **array[] = {&q->factor, &q->excess, &q->inverse, &q->b, &q->x, &q->scratch};
    for (size_t k = 0; k < sizeof array/sizeof *array; k++) *array[k] = calloc((size_t)n, sizeof(double));
    q->weight = malloc((size_t)q->cells.list_used*sizeof *q->weight);
    q->work = calloc((size_t)tobi_cg_work(n), sizeof *q->work);
    tobi_launch(&q->exec, TOBI_HOST(poisson_moments, 0, 0), q, 0, n, NULL);
    tobi_launch(&q->exec, TOBI_HOST(poisson_rows, 0, 0), q, 0, n, NULL);
    for (int64_t i = 0; i < n; i++) q->b[i] += 0.1/q->d*poisson_random();
    q->system = (tobi_linear_system){.rows = n, .user = q, .apply = poisson_apply,
                                     .precondition = poisson_precondition, .singular = 1};
    for (int64_t i = 0; i < n; i++) if (q->excess[i] != 0) q->system.singular = 0;
}

static inline tobi_status poisson_make_grid(poisson *q, tobi_error *err)
{
    const tobi_cell_points points = tobi_cells_points(&q->cells, &q->box, &q->p);
    return tobi_multigrid_create(&q->grid, &points, 1, 2, err);
}

/* What a step has to do again after each move. */
static inline void poisson_set_grid(poisson *q)
{
    const tobi_cell_points points = tobi_cells_points(&q->cells, &q->box, &q->p);
    const double d = q->d;
    const tobi_grid_weights w = {.strength = 1, .volume = q->box.dimension == 3 ? d*d*d : d*d,
                                 .excess = q->excess};
    tobi_multigrid_set(&q->grid, &q->exec, &points, &w);
}

static inline tobi_linear_report poisson_solve(poisson *q, int kind, double tolerance, int max)
{
    const tobi_linear_settings s = {.tolerance = tolerance, .max = max};
    q->kind = kind;
    q->products = 0;
    memset(q->x, 0, (size_t)q->p.count*sizeof *q->x);
    return tobi_cg(&q->exec, &q->system, &s, q->b, q->x, q->work);
}

static void poisson_drop(poisson *q)
{
    double *array[] = {q->factor, q->excess, q->inverse, q->b, q->x, q->scratch, q->weight, q->work};
    for (size_t k = 0; k < sizeof array/sizeof *array; k++) free(array[k]);
    tobi_multigrid_free(&q->grid);
    tobi_cells_free(&q->cells);
    tobi_particles_free(&q->p);
    tobi_exec_free(&q->exec);
}

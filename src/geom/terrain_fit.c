/* A grid of heights cut to a rectangle, and thinned. Each line of a thinned grid is the mean of those around
   it, place and heights alike, so that planes stay as they are. Drawback: heights on a cut are linear between
   the lines of the grid, though two triangles share a cell. */
#include "geom/terrain.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Lines of a grid made of others: line k is (1 - share) of `from` and share of the next. */
typedef struct cut { int64_t count, *from; double *at, *share; } cut;

static void free_cut(cut *c)
{
    free(c->from);
    free(c->at);
    free(c->share);
}

static void add_line(cut *c, const double *line, int64_t k, double share)
{
    c->from[c->count] = k;
    c->share[c->count] = share;
    c->at[c->count++] = share > 0 ? line[k] + share*(line[k + 1] - line[k]) : line[k];
}

/* Those from lower to upper; where the grid goes on, its first and last lie there. */
static int cut_lines(const double *line, int64_t n, double lower, double upper, cut *c)
{
    const double slack = 1e-12*(upper - lower), end[2] = { lower, upper };
    c->from = malloc((size_t)n*sizeof *c->from);
    c->at = malloc((size_t)n*sizeof *c->at);
    c->share = malloc((size_t)n*sizeof *c->share);
    if (!c->from || !c->at || !c->share) return 0;
    for (int64_t k = 0; k < n; k++) {
        if (line[k] >= lower - slack && line[k] <= upper + slack) add_line(c, line, k, 0);
        for (int e = 0; e < 2 && k + 1 < n; e++)
            if (line[k] < end[e] - slack && line[k + 1] > end[e] + slack)
                add_line(c, line, k, (end[e] - line[k])/(line[k + 1] - line[k]));
    }
    return 1;
}

static double find_height(const tobi_terrain *t, const cut *x, const cut *y, int64_t i, int64_t j)
{
    double side[2] = { 0, 0 };
    for (int n = 0; n < 2; n++) {
        if (n > 0 && !(y->share[j] > 0)) return side[0];
        const double *row = t->z + (y->from[j] + n)*t->nx + x->from[i];
        side[n] = x->share[i] > 0 ? row[0] + x->share[i]*(row[1] - row[0]) : row[0];
    }
    return side[0] + y->share[j]*(side[1] - side[0]);
}

static tobi_status take_cut(tobi_terrain *t, cut *x, cut *y, tobi_error *err)
{
    double *z = malloc((size_t)(x->count*y->count)*sizeof *z);
    if (!z) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a terrain");
    for (int64_t j = 0; j < y->count; j++)
        for (int64_t i = 0; i < x->count; i++) z[j*x->count + i] = find_height(t, x, y, i, j);
    tobi_terrain_free(t);
    *t = (tobi_terrain){ x->at, y->at, z, x->count, y->count };
    x->at = y->at = NULL;
    return TOBI_OK;
}

static int is_whole(const cut *c, int64_t n)
{
    return c->count == n && !(c->share[0] > 0) && !(c->share[n - 1] > 0);
}

tobi_status tobi_terrain_cut(tobi_terrain *t, const double lower[2], const double upper[2], int *was_cut,
                             tobi_error *err)
{
    cut x = { 0 }, y = { 0 };
    tobi_status status = TOBI_OK;
    *was_cut = 0;
    if (!cut_lines(t->x, t->nx, lower[0], upper[0], &x) || !cut_lines(t->y, t->ny, lower[1], upper[1], &y))
        status = tobi_fail(err, TOBI_NO_MEMORY, "no memory for a terrain");
    else if (x.count < 2 || y.count < 2) status = TOBI_NOT_FOUND;
    else if (!is_whole(&x, t->nx) || !is_whole(&y, t->ny)) {
        *was_cut = 1;
        status = take_cut(t, &x, &y, err);
    }
    free_cut(&x);
    free_cut(&y);
    return status;
}

/* One of how many lines stays: of cells below a quarter of the spacing so many as are half of it. */
static int64_t find_factor(const double *line, int64_t n, double spacing)
{
    double widest = 0;
    for (int64_t k = 0; k + 1 < n; k++) widest = fmax(widest, line[k + 1] - line[k]);
    return widest < 0.25*spacing*(1 - 1e-9) ? (int64_t)floor(0.5*spacing/widest*(1 + 1e-9)) : 1;
}

/* Of n values, `step` apart in both arrays: the first, a mean around every factor-th, the last; their number.
   Weights fall off to both sides, so that neighbouring means share all between them. */
static int64_t thin(const double *from, int64_t n, int64_t step, int64_t factor, double *to)
{
    int64_t count = 0;
    to[step*count++] = from[0];
    for (int64_t k = factor; k + factor <= n; k += factor) {
        double sum = 0;
        for (int64_t m = 1 - factor; m < factor; m++)
            sum += (double)(factor - llabs(m))*from[(k + m)*step];
        to[step*count++] = sum/(double)(factor*factor);
    }
    to[step*count++] = from[(n - 1)*step];
    return count;
}

void tobi_terrain_thin(tobi_terrain *t, const double spacing[2], int64_t factor[2])
{
    const int64_t nx = t->nx, ny = t->ny;
    factor[0] = find_factor(t->x, nx, spacing[0]);
    factor[1] = find_factor(t->y, ny, spacing[1]);
    for (int64_t j = 0; j < ny && factor[0] > 1; j++)         /* in place: a mean lies before what it is of */
        t->nx = thin(t->z + j*nx, nx, 1, factor[0], t->z + j*nx);
    for (int64_t j = 1; j < ny && factor[0] > 1; j++)
        memmove(t->z + j*t->nx, t->z + j*nx, (size_t)t->nx*sizeof *t->z);
    for (int64_t i = 0; i < t->nx && factor[1] > 1; i++)
        t->ny = thin(t->z + i, ny, t->nx, factor[1], t->z + i);
    if (factor[0] > 1) thin(t->x, nx, 1, factor[0], t->x);
    if (factor[1] > 1) thin(t->y, ny, 1, factor[1], t->y);
}

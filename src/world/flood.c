/* What a vessel holds: cells of a spacing, flooded from outside; what stays dry below the level is a
   compartment. A wall parts two cells if the way between their middles meets it, however thin it is.
   Drawback: gaps and rims are known to a cell, and a fine scene has many cells. */
#include "world/flood.h"
#include "base/error.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What is known of a cell: free of the body; no wall to the next one along x, y, z; reached from outside;
   held by other bodies without the vessel. */
enum { FREE = 1, LINK = 2, OUTSIDE = 16, HELD = TOBI_FLOOD_HELD };
enum { HALVINGS = 30 };
/* Of a cell: nearer to a wall than that is on it. */
static const double ON_SURFACE = 1e-6;
static const double SAME = 1e-3;        /* spacings: walls so near to each other are one plane */
static const double CELLS_MOST = 4e8;

void tobi_flood_free(tobi_flood *f)
{
    free(f->mark);
    free(f->label);
    free(f->stack);
}

static void split(const tobi_flood *f, int64_t c, int64_t at[3])
{
    at[0] = c%f->n[0];
    at[1] = c/f->stride[1]%f->n[1];
    at[2] = c/f->stride[2];
}

void tobi_flood_place(const tobi_flood *f, int64_t c, double x[3])
{
    int64_t at[3];
    split(f, c, at);
    for (int a = 0; a < 3; a++) x[a] = a < f->dimension ? f->lower[a] + ((double)at[a] + 0.5)*f->d : 0;
}

double tobi_flood_height(const tobi_flood *f, const double x[3])
{
    double h = 0;
    for (int a = 0; a < f->dimension; a++) h += f->up[a]*x[a];
    return h;
}

static int is_inside(const tobi_flood *f, const double x[3])
{
    for (int k = 0; k < f->walls; k++)
        if (&f->wall[k] != f->without && tobi_bvh_inside(f->wall[k].bvh, x)) return 1;
    return 0;
}

static int is_parted(const tobi_flood *f, const double from[3], const double to[3])
{
    for (int k = 0; k < f->walls; k++)
        if (&f->wall[k] != f->without && tobi_bvh_segment_hits(f->wall[k].bvh, from, to)) return 1;
    return 0;
}

/* Inside of the walls, or on their surface, which rounding may put on either side: a cell there belongs to
   nobody, or those along a wall's outside would be a compartment. */
static int is_wall(const tobi_flood *f, const double x[3])
{
    tobi_bvh_hit hit;
    for (int k = 0; k < f->walls; k++)
        if (&f->wall[k] != f->without && tobi_bvh_closest(f->wall[k].bvh, x, ON_SURFACE*f->d, &hit)) return 1;
    return is_inside(f, x);
}

static void mark_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_flood *f = view;
    for (int64_t c = begin; c < end; c++) {
        double x[3], next[3];
        int64_t at[3];
        tobi_flood_place(f, c, x);
        split(f, c, at);
        f->mark[c] &= HELD;
        if (is_wall(f, x)) continue;
        f->mark[c] |= FREE;
        for (int a = 0; a < f->dimension; a++) {
            memcpy(next, x, sizeof next);
            next[a] += f->d;
            if (at[a] + 1 < f->n[a] && !is_parted(f, x, next))
                f->mark[c] = (uint8_t)(f->mark[c] | LINK << a);
        }
    }
}

tobi_status tobi_flood_lay(tobi_flood *f, const tobi_world *w, tobi_error *err)
{
    double low[3], high[3], cells = 1;
    tobi_bvh_box(f->b->bvh, low, high);
    for (int a = 0; a < 3; a++) {
        const int flat = a >= f->dimension;
        f->lower[a] = flat ? 0 : low[a] - 1.5*f->d;
        cells *= flat ? 1 : ceil((high[a] - low[a])/f->d) + 3;
        if (!(cells <= CELLS_MOST))
            return tobi_fail(err, TOBI_NO_MEMORY, "vessel '%s' is %g m wide: too many cells of %g m to look "
                             "for its compartments; allowed is a larger spacing", f->b->name,
                             high[a] - low[a], f->d);
        f->n[a] = flat ? 1 : (int64_t)ceil((high[a] - low[a])/f->d) + 3;
        f->stride[a] = a == 0 ? 1 : f->stride[a - 1]*f->n[a - 1];
    }
    f->cells = (int64_t)cells;
    f->mark = calloc((size_t)f->cells, 1);
    f->label = calloc((size_t)f->cells, sizeof *f->label);
    f->stack = malloc((size_t)f->cells*sizeof *f->stack);
    if (!f->mark || !f->label || !f->stack)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld cells of vessel '%s'", (long long)f->cells,
                         f->b->name);
    tobi_loop(w->sim.exec.threads, f->cells, 4096, mark_range, f);
    return TOBI_OK;
}

/* A free cell below the level that the flood has not seen. */
static int is_open(const tobi_flood *f, int64_t c)
{
    double x[3];
    if (!(f->mark[c] & FREE) || f->mark[c] & OUTSIDE || f->label[c] != 0) return 0;
    tobi_flood_place(f, c, x);
    return tobi_flood_height(f, x) <= f->level;
}

static void see(tobi_flood *f, int64_t c, int label, int64_t *top)
{
    if (label) f->label[c] = label;
    else f->mark[c] |= OUTSIDE;
    f->stack[(*top)++] = (int32_t)c;
}

/* The linked neighbour of a cell in one of six directions; -1: none. */
static int64_t find_next(const tobi_flood *f, int64_t c, int way)
{
    const int a = way/2;
    int64_t at[3];
    if (a >= f->dimension) return -1;
    split(f, c, at);
    if (way%2 == 0) return f->mark[c] & LINK << a ? c + f->stride[a] : -1;
    return at[a] > 0 && f->mark[c - f->stride[a]] & LINK << a ? c - f->stride[a] : -1;
}

/* From a cell to all that liquid reaches from there; how many. label 0: they are outside. */
static int64_t spread(tobi_flood *f, int64_t from, int label)
{
    int64_t top = 0, count = 0;
    if (!is_open(f, from)) return 0;
    for (see(f, from, label, &top); top > 0;) {
        const int64_t c = f->stack[--top];
        count++;
        for (int way = 0; way < 6; way++) {
            const int64_t next = find_next(f, c, way);
            if (next >= 0 && is_open(f, next)) see(f, next, label, &top);
        }
    }
    return count;
}

void tobi_flood_find_compartments(tobi_flood *f)
{
    const int64_t least = f->dimension == 3 ? 8 : 4;      /* fewer cells are the pits of a rough surface */
    memset(f->label, 0, (size_t)f->cells*sizeof *f->label);
    for (int64_t c = 0; c < f->cells; c++) f->mark[c] = (uint8_t)(f->mark[c] & ~OUTSIDE);
    for (int64_t c = 0; c < f->cells; c++) {
        int64_t at[3];
        int side = 0;
        split(f, c, at);
        for (int a = 0; a < f->dimension; a++) side |= at[a] == 0 || at[a] == f->n[a] - 1;
        if (side) spread(f, c, 0);
    }
    f->compartments = 0;
    for (int64_t c = 0; c < f->cells; c++) {
        const int64_t count = spread(f, c, f->compartments + 1);
        if (count >= least) f->compartments++;
        for (int64_t k = c; count > 0 && count < least && k < f->cells; k++)
            if (f->label[k] == f->compartments + 1) f->label[k] = -1;
    }
}

int64_t tobi_flood_cell(const tobi_flood *f, const double x[3])
{
    int64_t c = 0;
    for (int a = f->dimension - 1; a >= 0; a--) {
        const double k = floor((x[a] - f->lower[a])/f->d);
        if (!(k >= 0 && k < (double)f->n[a])) return -1;
        c += (int64_t)k*f->stride[a];
    }
    return c;
}

int64_t tobi_flood_leak(tobi_flood *f, int wanted)
{
    int64_t top = 0;
    for (int64_t c = 0; c < f->cells; c++) {
        if (f->label[c] <= 0 || (wanted > 0 && f->label[c] != wanted)) f->label[c] = 0;
        else f->stack[top++] = (int32_t)c;
    }
    f->level += f->d;
    while (top > 0) {
        const int64_t c = f->stack[--top];
        for (int way = 0; way < 6; way++) {
            const int64_t next = find_next(f, c, way);
            if (next < 0) continue;
            if (f->mark[next] & OUTSIDE) return c;
            if (is_open(f, next)) see(f, next, 1, &top);
        }
    }
    return -1;
}

void tobi_flood_close_holes(tobi_flood *f, const tobi_world *w)
{
    f->wall = w->sim.bodies;
    f->walls = w->sim.body_count;
    f->without = f->b;
    tobi_loop(w->sim.exec.threads, f->cells, 4096, mark_range, f);
    tobi_flood_find_compartments(f);
    for (int64_t c = 0; c < f->cells; c++)
        if (f->label[c] > 0) f->mark[c] |= HELD;
    f->without = NULL;
    tobi_loop(w->sim.exec.threads, f->cells, 4096, mark_range, f);
    tobi_flood_find_compartments(f);
}

/* How far liquid reaches from a cell along an axis until a wall, a cell at most. */
static double reach_wall(const tobi_flood *f, const double x[3], int axis, double way)
{
    double free = 0, blocked = 1, to[3];
    for (int k = 0; k < HALVINGS; k++) {
        const double middle = 0.5*(free + blocked);
        memcpy(to, x, sizeof to);
        to[axis] += middle*way*f->d;
        if (is_parted(f, x, to)) blocked = middle;
        else free = middle;
    }
    return x[axis] + free*way*f->d;
}

/* Whether a cell of a compartment ends it on a side along an axis: 0 below, 1 above. */
static int is_end(const tobi_flood *f, int label, int64_t c, int axis, int side)
{
    if (f->label[c] != label) return 0;
    const int64_t next = find_next(f, c, 2*axis + !side);
    return next < 0 || f->label[next] != label;
}

/* The layer in which half or more of the cells lie that end a compartment on a side. */
static void find_flat(tobi_flood *f, int label, int axis, int side, int64_t *layer)
{
    int64_t at[3], all = 0;
    int32_t *count = f->stack;
    memset(count, 0, (size_t)f->n[axis]*sizeof *count);
    for (int64_t c = 0; c < f->cells; c++) {
        if (!is_end(f, label, c, axis, side)) continue;
        split(f, c, at);
        count[at[axis]]++;
        all++;
    }
    for (int64_t k = 0; k < f->n[axis]; k++)
        if (2*(int64_t)count[k] >= all) *layer = k;
}

static void find_layers(tobi_flood *f, int label, int flat, int64_t layer[2][3])
{
    int64_t at[3];
    for (int a = 0; a < 3; a++) {
        layer[0][a] = INT64_MAX;
        layer[1][a] = -1;
    }
    for (int64_t c = 0; c < f->cells; c++) {
        if (f->label[c] != label) continue;
        split(f, c, at);
        for (int a = 0; a < 3; a++) {
            if (at[a] < layer[0][a]) layer[0][a] = at[a];
            if (at[a] > layer[1][a]) layer[1][a] = at[a];
        }
    }
    for (int a = 0; flat && a < f->dimension; a++)
        for (int side = 0; side < 2; side++) find_flat(f, label, a, side, &layer[side][a]);
}

/* How far the cells of such a layer reach; flat: most of them, which a gate in a hole or a rib is not. */
static double find_wall(const tobi_flood *f, int label, int axis, int side, int64_t layer, int flat)
{
    const double way = side ? 1 : -1, same = SAME*f->d;
    double x[3], far = -INFINITY, near = INFINITY;
    int64_t at[3], at_far = 0, at_near = 0;
    for (int pass = 0; pass <= flat; pass++)
        for (int64_t c = 0; c < f->cells; c++) {
            if (!is_end(f, label, c, axis, side)) continue;
            split(f, c, at);
            if (at[axis] != layer) continue;
            tobi_flood_place(f, c, x);
            const double reach = way*reach_wall(f, x, axis, way);
            at_far += pass && far - reach < same;
            at_near += pass && reach - near < same;
            far = fmax(far, reach);
            near = fmin(near, reach);
        }
    return way*(at_near > at_far ? near : far);
}

void tobi_flood_box(tobi_flood *f, int label, int flat, double lower[3], double upper[3])
{
    int64_t layer[2][3];
    find_layers(f, label, flat, layer);
    for (int a = 0; a < 3; a++) {
        const int used = a < f->dimension;
        lower[a] = used ? find_wall(f, label, a, 0, layer[0][a], flat) : 0;
        upper[a] = used ? find_wall(f, label, a, 1, layer[1][a], flat) : 0;
    }
    if (f->up_axis < 0) return;
    if (f->up[f->up_axis] > 0) upper[f->up_axis] = fmin(upper[f->up_axis], f->level);
    else lower[f->up_axis] = fmax(lower[f->up_axis], -f->level);
}

int tobi_flood_stands_free(const tobi_flood *f, const double x[3], double margin)
{
    tobi_bvh_hit hit;
    for (int k = 0; k < f->walls; k++)
        if (tobi_bvh_closest(f->wall[k].bvh, x, margin, &hit)) return 0;
    return 1;
}

int tobi_flood_has(const tobi_flood *f, int label, const double x[3])
{
    const int64_t own = tobi_flood_cell(f, x);
    int64_t at[3];
    if (own < 0 || is_inside(f, x) || tobi_flood_height(f, x) > f->level) return 0;
    split(f, own, at);
    for (int64_t k = at[2] - 1; k <= at[2] + 1; k++)
        for (int64_t j = at[1] - 1; j <= at[1] + 1; j++)
            for (int64_t i = at[0] - 1; i <= at[0] + 1; i++) {
                double y[3];
                if (i < 0 || j < 0 || k < 0 || i >= f->n[0] || j >= f->n[1] || k >= f->n[2]) continue;
                const int64_t c = i + j*f->stride[1] + k*f->stride[2];
                if (f->label[c] != label) continue;
                tobi_flood_place(f, c, y);
                if (!is_parted(f, x, y)) return 1;
            }
    return 0;
}


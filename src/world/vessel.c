/* Filling vessels: cells of a spacing, flooded from outside; what stays dry below the level is a compartment.
   A wall parts two cells if the way between their middles meets it, however thin it is. Drawback: gaps and
   rims are known to a cell, and a fine scene has many cells. */
#include "world/vessel.h"
#include "base/error.h"
#include "world/overlap.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What is known of a cell: free of the body; no wall to the next one along x, y, z; reached from outside;
   held by other bodies without the vessel. */
enum { FREE = 1, LINK = 2, OUTSIDE = 16, HELD = 32 };
enum { HALVINGS = 30 };
/* Of a cell: nearer to a wall than that is on it. */
static const double ON_SURFACE = 1e-6;
static const double CELLS_MOST = 4e8;

/* Coordinates are those of the box: from the domain's lower corner. */
typedef struct flood {
    const tobi_body *b;
    const tobi_body *wall;           /* whose walls part compartments: the vessel, or all bodies        */
    int walls;
    const tobi_body *without;        /* of them, this one does not count                                */
    double d, lower[3], up[3];
    int dimension, up_axis;          /* up_axis: the one that up follows, -1 = none                     */
    double level;                    /* m, along up                                                     */
    int64_t n[3], stride[3], cells;
    uint8_t *mark;
    int32_t *label, *stack;          /* label: compartment, 0 = none                                    */
    int compartments;
} flood;

static void free_flood(flood *f)
{
    free(f->mark);
    free(f->label);
    free(f->stack);
}

static void split(const flood *f, int64_t c, int64_t at[3])
{
    at[0] = c%f->n[0];
    at[1] = c/f->stride[1]%f->n[1];
    at[2] = c/f->stride[2];
}

static void place(const flood *f, int64_t c, double x[3])
{
    int64_t at[3];
    split(f, c, at);
    for (int a = 0; a < 3; a++) x[a] = a < f->dimension ? f->lower[a] + ((double)at[a] + 0.5)*f->d : 0;
}

static double height(const flood *f, const double x[3])
{
    double h = 0;
    for (int a = 0; a < f->dimension; a++) h += f->up[a]*x[a];
    return h;
}

static int is_inside(const flood *f, const double x[3])
{
    for (int k = 0; k < f->walls; k++)
        if (&f->wall[k] != f->without && tobi_bvh_inside(f->wall[k].bvh, x)) return 1;
    return 0;
}

static int is_parted(const flood *f, const double from[3], const double to[3])
{
    for (int k = 0; k < f->walls; k++)
        if (&f->wall[k] != f->without && tobi_bvh_segment_hits(f->wall[k].bvh, from, to)) return 1;
    return 0;
}

/* Inside of the walls, or on their surface, which rounding may put on either side: a cell there belongs to
   nobody, or those along a wall's outside would be a compartment. */
static int is_wall(const flood *f, const double x[3])
{
    tobi_bvh_hit hit;
    for (int k = 0; k < f->walls; k++)
        if (&f->wall[k] != f->without && tobi_bvh_closest(f->wall[k].bvh, x, ON_SURFACE*f->d, &hit)) return 1;
    return is_inside(f, x);
}

static void mark_range(const void *view, int64_t begin, int64_t end)
{
    const flood *f = view;
    for (int64_t c = begin; c < end; c++) {
        double x[3], next[3];
        int64_t at[3];
        place(f, c, x);
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

static tobi_status lay_cells(flood *f, const tobi_world *w, tobi_error *err)
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
static int is_open(const flood *f, int64_t c)
{
    double x[3];
    if (!(f->mark[c] & FREE) || f->mark[c] & OUTSIDE || f->label[c] != 0) return 0;
    place(f, c, x);
    return height(f, x) <= f->level;
}

static void see(flood *f, int64_t c, int label, int64_t *top)
{
    if (label) f->label[c] = label;
    else f->mark[c] |= OUTSIDE;
    f->stack[(*top)++] = (int32_t)c;
}

/* The linked neighbour of a cell in one of six directions; -1: none. */
static int64_t find_next(const flood *f, int64_t c, int way)
{
    const int a = way/2;
    int64_t at[3];
    if (a >= f->dimension) return -1;
    split(f, c, at);
    if (way%2 == 0) return f->mark[c] & LINK << a ? c + f->stride[a] : -1;
    return at[a] > 0 && f->mark[c - f->stride[a]] & LINK << a ? c - f->stride[a] : -1;
}

/* From a cell to all that liquid reaches from there; how many. label 0: they are outside. */
static int64_t spread(flood *f, int64_t from, int label)
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

/* Labels the compartments below the level. */
static void find_compartments(flood *f)
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

static int64_t find_cell(const flood *f, const double x[3])
{
    int64_t c = 0;
    for (int a = f->dimension - 1; a >= 0; a--) {
        const double k = floor((x[a] - f->lower[a])/f->d);
        if (!(k >= 0 && k < (double)f->n[a])) return -1;
        c += (int64_t)k*f->stride[a];
    }
    return c;
}

static int has_seed(const tobi_region *r) { return r->seed[0] > -1e9; }

/* The compartment that is asked for: 0 = all, -1 = there is none, or other bodies hold them all. */
static int choose(const flood *f, const tobi_region *r, const double lower[3])
{
    double seed[3];
    int own = 0;
    for (int64_t c = 0; c < f->cells && !own; c++) own = f->label[c] > 0 && !(f->mark[c] & HELD);
    if (!has_seed(r)) return own ? 0 : -1;
    for (int a = 0; a < 3; a++) seed[a] = r->seed[a] - lower[a];
    const int64_t c = find_cell(f, seed);
    return c >= 0 && f->label[c] > 0 ? f->label[c] : -1;
}

/* With a compartment found at the level, a cell on the way out of it when that rises by a cell; -1: none. */
static int64_t find_leak(flood *f, int wanted)
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

/* Where the vessel alone does not hold liquid, other bodies may close its holes: a gate, a plug, a lid. */
static void close_holes(flood *f, const tobi_world *w)
{
    f->wall = w->sim.bodies;
    f->walls = w->sim.body_count;
    f->without = f->b;
    tobi_loop(w->sim.exec.threads, f->cells, 4096, mark_range, f);
    find_compartments(f);
    for (int64_t c = 0; c < f->cells; c++)
        if (f->label[c] > 0) f->mark[c] |= HELD;
    f->without = NULL;
    tobi_loop(w->sim.exec.threads, f->cells, 4096, mark_range, f);
    find_compartments(f);
}

static tobi_status find_nothing(const flood *f, const tobi_region *r, const char *whose, tobi_error *err)
{
    return tobi_fail(err, TOBI_INVALID, "%s: fill[%d] finds nothing to fill in vessel '%s' below a level of "
                     "%g m%s: it leaks at its lowest place, stands above the level, or its cells of one "
                     "spacing, %g m, are too coarse for it", whose, r->number, f->b->name, r->level,
                     has_seed(r) ? tr(" at the seed") : "", f->d);
}

/* No compartment at that level: says up to where there is one. */
static tobi_status refuse(flood *f, const tobi_world *w, const tobi_region *r, const char *whose,
                          tobi_error *err)
{
    const double *lower = w->system[0].box.lower, wish = r->level, base = height(f, lower);
    double low[3], high[3], depth = 0;
    tobi_bvh_box(f->b->bvh, low, high);
    for (int a = 0; a < f->dimension; a++) depth += fabs(f->up[a])*(high[a] - low[a]);
    for (double down = f->d; down <= depth + 2*f->d; down += f->d) {
        f->level = wish - base - down;
        find_compartments(f);
        const int found = choose(f, r, lower);
        if (found < 0) continue;
        const double held = f->level;
        const int64_t leak = find_leak(f, found);
        double x[3] = { 0 };
        if (leak >= 0) place(f, leak, x);
        return tobi_fail(err, TOBI_INVALID, "%s: the level of fill[%d] is %g m, and vessel '%s' holds liquid "
                         "up to %.4g m only: above that it runs out over a rim or through a hole near (%.4g, "
                         "%.4g, %.4g) m", whose, r->number, wish, f->b->name, held + base, x[0] + lower[0],
                         x[1] + lower[1], x[2] + lower[2]);
    }
    return find_nothing(f, r, whose, err);
}

/* How far liquid reaches from a cell along an axis until a wall, a cell at most. */
static double reach_wall(const flood *f, const double x[3], int axis, double way)
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

/* The box of a compartment, walls and level as they are. */
static void find_box(const flood *f, int label, double lower[3], double upper[3])
{
    int64_t first[3], last[3], at[3];
    double x[3];
    for (int a = 0; a < 3; a++) {
        first[a] = INT64_MAX;
        last[a] = -1;
        lower[a] = INFINITY;
        upper[a] = -INFINITY;
    }
    for (int64_t c = 0; c < f->cells; c++) {
        if (f->label[c] != label) continue;
        split(f, c, at);
        for (int a = 0; a < 3; a++) {
            if (at[a] < first[a]) first[a] = at[a];
            if (at[a] > last[a]) last[a] = at[a];
        }
    }
    for (int64_t c = 0; c < f->cells; c++) {
        if (f->label[c] != label) continue;
        split(f, c, at);
        place(f, c, x);
        for (int a = 0; a < f->dimension; a++) {
            if (at[a] == first[a]) lower[a] = fmin(lower[a], reach_wall(f, x, a, -1));
            if (at[a] == last[a]) upper[a] = fmax(upper[a], reach_wall(f, x, a, 1));
        }
    }
    for (int a = f->dimension; a < 3; a++) lower[a] = upper[a] = 0;
    if (f->up_axis < 0) return;
    if (f->up[f->up_axis] > 0) upper[f->up_axis] = fmin(upper[f->up_axis], f->level);
    else lower[f->up_axis] = fmax(lower[f->up_axis], -f->level);
}

/* Whether a point belongs to a compartment: a cell near it does, and no wall lies between. */
static int is_within(const flood *f, int label, const double x[3])
{
    const int64_t own = find_cell(f, x);
    int64_t at[3];
    if (own < 0 || is_inside(f, x) || height(f, x) > f->level) return 0;
    split(f, own, at);
    for (int64_t k = at[2] - 1; k <= at[2] + 1; k++)
        for (int64_t j = at[1] - 1; j <= at[1] + 1; j++)
            for (int64_t i = at[0] - 1; i <= at[0] + 1; i++) {
                double y[3];
                if (i < 0 || j < 0 || k < 0 || i >= f->n[0] || j >= f->n[1] || k >= f->n[2]) continue;
                const int64_t c = i + j*f->stride[1] + k*f->stride[2];
                if (f->label[c] != label) continue;
                place(f, c, y);
                if (!is_parted(f, x, y)) return 1;
            }
    return 0;
}

/* The points of a lattice that lie in a compartment. */
static tobi_status find_points(const flood *f, int label, const double low[3], const double step[3],
                               const int64_t n[3], const double corner[3], tobi_region *r, tobi_error *err)
{
    const int64_t all = n[0]*n[1]*n[2];
    free(r->points);
    r->point_count = 0;
    r->points = malloc((size_t)(all + 1)*sizeof *r->points);
    if (!r->points) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the particles of a vessel");
    for (int64_t c = 0; c < all; c++) {
        const double at[3] = { (double)(c%n[0]), (double)(c/n[0]%n[1]), (double)(c/(n[0]*n[1])) };
        double x[3];
        for (int a = 0; a < 3; a++) x[a] = a < f->dimension ? low[a] + (at[a] + 0.5)*step[a] : 0;
        if (!is_within(f, label, x)) continue;
        for (int a = 0; a < 3; a++) r->points[r->point_count][a] = x[a] + (a < f->dimension ? corner[a] : 0);
        r->point_count++;
    }
    return TOBI_OK;
}

/* Layers from the lowest place to the level, with rows across them whose points have the volume of a
   particle. */
static void lay_rows(const flood *f, const double low[3], const double high[3], double first[3],
                     double step[3], int64_t n[3])
{
    const int up = f->up_axis, across = f->dimension - 1;
    const double depth = up >= 0 ? high[up] - low[up] : 0;
    const double layer = up >= 0 ? depth/fmax(1, floor(depth/f->d + 0.5)) : f->d;
    for (int a = 0; a < f->dimension; a++) {
        step[a] = a == up ? layer : up < 0 ? f->d : f->d*pow(f->d/layer, 1.0/across);
        n[a] = (int64_t)fmax(1, floor((high[a] - low[a])/step[a] + 0.5));
        first[a] = 0.5*(low[a] + high[a] - (double)n[a]*step[a]);
    }
}

/* The lattice in a compartment: layers evenly between its walls where it is a box, which then needs no
   points; else rows that hold its volume. */
static tobi_status place_points(const flood *f, int label, tobi_region *r, const double corner[3],
                                tobi_error *err)
{
    double low[3], high[3], first[3] = { 0 }, step[3] = { 0 };
    int64_t n[3] = { 1, 1, 1 };
    find_box(f, label, low, high);
    for (int a = 0; a < f->dimension; a++) {
        n[a] = (int64_t)fmax(1, floor((high[a] - low[a])/f->d + 0.5));
        step[a] = (high[a] - low[a])/(double)n[a];
    }
    TOBI_TRY(find_points(f, label, low, step, n, corner, r, err));
    for (int a = 0; a < 3; a++) {
        r->lower[a] = low[a] + corner[a];
        r->upper[a] = high[a] + corner[a];
    }
    r->volume = (high[0] - low[0])*(high[1] - low[1])*(f->dimension == 3 ? high[2] - low[2] : 1);
    r->vessel[0] = '\0';
    if (r->point_count == n[0]*n[1]*n[2]) {
        free(r->points);
        r->points = NULL;
        r->point_count = 0;
        return TOBI_OK;
    }
    lay_rows(f, low, high, first, step, n);
    TOBI_TRY(find_points(f, label, first, step, n, corner, r, err));
    r->volume = (double)r->point_count*pow(f->d, f->dimension);
    return TOBI_OK;
}

/* Whether a region that was there before has a place in it. points: a table of those of a compartment. */
static int holds(const tobi_region *r, const tobi_overlap *points, const double x[3], int dimension)
{
    double square = 0;
    if (points) return tobi_overlap_meets(points, x);
    if (r->vessel[0] || r->shape.triangle_count) return 0;
    for (int a = 0; a < dimension; a++) {
        const double from_middle = x[a] - 0.5*(r->lower[a] + r->upper[a]);
        if (x[a] <= r->lower[a] || x[a] >= r->upper[a]) return 0;
        square += from_middle*from_middle;
    }
    return !(r->radius > 0) || square < r->radius*r->radius;
}

static const char *name_owner(const tobi_world *w, const tobi_region *r, char text[TOBI_NOTE])
{
    const tobi_system *s = &w->system[r->system];
    const int solid = s->solid_count > 0;
    snprintf(text, TOBI_NOTE, "%s '%s'", solid ? tr("solid") : tr("fluid"),
             solid ? s->solids[r->owner].name : s->fluid[r->owner].name);
    return text;
}

/* The first place of a compartment that another region has. */
static tobi_status find_shared(const flood *f, int label, const tobi_region *other, const double lower[3],
                               double x[3], int *found, tobi_error *err)
{
    tobi_overlap *points = NULL;
    *found = 0;
    if (other->points)
        TOBI_TRY(tobi_overlap_create((const double (*)[3])other->points, other->point_count, f->dimension,
                                     f->d, &points, err));
    for (int64_t c = 0; c < f->cells && !*found; c++) {
        if (f->label[c] != label) continue;
        place(f, c, x);
        for (int a = 0; a < f->dimension; a++) x[a] += lower[a];
        *found = holds(other, points, x, f->dimension);
    }
    tobi_overlap_free(points);
    return TOBI_OK;
}

/* Of two fluids the later one takes the place; solids, and regions of one fluid, may not share one. */
static tobi_status check_overlap(const flood *f, int label, const tobi_world *w, const tobi_region *r,
                                 const char *whose, tobi_error *err)
{
    for (int k = 0; k < w->region_count; k++) {
        const tobi_region *other = &w->regions[k];
        double x[3];
        char text[TOBI_NOTE];
        int found;
        if (other->system != r->system) continue;
        if (w->system[r->system].solid_count == 0 && other->owner != r->owner) continue;
        TOBI_TRY(find_shared(f, label, other, w->system[0].box.lower, x, &found, err));
        if (found)
            return tobi_fail(err, TOBI_INVALID, "%s: what fill[%d] fills of vessel '%s' overlaps another "
                             "region, fill[%d] of %s, at (%.4g, %.4g, %.4g) m: %s", whose, r->number,
                             f->b->name, other->number, name_owner(w, other, text), x[0], x[1], x[2],
                             has_seed(r) && other->in_vessel ? tr("no wall that reaches above both levels "
                             "parts the seeds") : tr("leave the vessel out of that one"));
    }
    return TOBI_OK;
}

/* Says which key of the scene a failure is about. */
static tobi_status blame(const tobi_world *w, const tobi_region *r, const char *key, tobi_status status,
                         tobi_error *err)
{
    const char *list = w->system[r->system].solid_count > 0 ? "solids" : "fluids";
    return tobi_at_key(err, status, "%s[%d].fill[%d].%s", list, r->owner, r->number, key);
}

static tobi_status find_vessel(const tobi_world *w, const tobi_region *r, const char *whose, flood *f,
                               tobi_error *err)
{
    double g = 0;
    f->up_axis = -1;
    f->dimension = w->system[0].box.dimension;
    f->d = w->sim.def.spacing;
    const int body = tobi_world_find_body(w, r->vessel);
    if (body >= 0) f->b = &w->sim.bodies[body];
    /* where one compartment is meant, bulkheads that are bodies of their own part it from the others */
    f->wall = has_seed(r) ? w->sim.bodies : f->b;
    f->walls = has_seed(r) ? w->sim.body_count : 1;
    if (!f->b || !f->b->vessel)
        return blame(w, r, "vessel", tobi_fail(err, TOBI_INVALID, "%s: fill[%d] fills '%s', which is no %s",
                                               whose, r->number, r->vessel, f->b ? tr("vessel") : tr("body")),
                                               err);
    for (int a = 0; a < f->dimension; a++) g += w->sim.def.gravity[a]*w->sim.def.gravity[a];
    if (!(g > 0))
        return tobi_fail(err, TOBI_INVALID, "%s: fill[%d] fills a vessel up to a level, and without gravity "
                         "nothing is up", whose, r->number);
    for (int a = 0; a < f->dimension; a++) {
        f->up[a] = -w->sim.def.gravity[a]/sqrt(g);
        if (fabs(f->up[a]) == 1) f->up_axis = a;
    }
    f->level = r->level - height(f, w->system[0].box.lower);
    return TOBI_OK;
}

/* Puts a copy of a region that waits before another: regions are filled in the order of their fluids. */
static tobi_region *add_region(tobi_world *w, const tobi_region *of, int before)
{
    const tobi_region copy = *of;
    tobi_region *more = realloc(w->regions, (size_t)(w->region_count + 2)*sizeof *more);
    if (!more) return NULL;
    w->regions = more;
    memmove(&more[before + 1], &more[before], (size_t)(w->region_count - before)*sizeof *more);
    w->region_count++;
    more[before] = copy;
    return &more[before];
}

/* The regions of the compartments that are asked for; *next: the number behind them. */
static tobi_status place_all(const flood *f, int wanted, tobi_world *w, int *next, tobi_error *err)
{
    const int number = (*next)++;
    w->regions[number].in_vessel = 1;
    const tobi_region r = w->regions[number];
    char text[TOBI_NOTE];
    int64_t points = 0;
    for (int k = 1, taken = 0; k <= f->compartments; k++) {
        if (wanted > 0 && k != wanted) continue;
        tobi_region *to = taken++ == 0 ? &w->regions[number] : add_region(w, &r, (*next)++);
        if (!to) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the compartments of a vessel");
        TOBI_TRY(place_points(f, k, to, w->system[0].box.lower, err));
        points += to->points ? to->point_count : 1;
    }
    return points > 0 ? TOBI_OK : find_nothing(f, &r, name_owner(w, &r, text), err);
}

/* *number: of a region that waits; then that behind its compartments. */
static tobi_status resolve(tobi_world *w, int *number, tobi_error *err)
{
    const tobi_region r = w->regions[*number];
    const double *corner = w->system[0].box.lower;
    char text[TOBI_NOTE];
    const char *whose = name_owner(w, &r, text);
    flood f = { 0 };
    tobi_status status = find_vessel(w, &r, whose, &f, err);
    if (status == TOBI_OK) status = lay_cells(&f, w, err);
    if (status == TOBI_OK) find_compartments(&f);
    int wanted = status == TOBI_OK ? choose(&f, &r, corner) : -1;
    if (status == TOBI_OK && wanted < 0 && !has_seed(&r)) {
        close_holes(&f, w);
        wanted = choose(&f, &r, corner);
    }
    if (status == TOBI_OK && wanted < 0) status = refuse(&f, w, &r, whose, err);
    for (int k = 1; status == TOBI_OK && k <= f.compartments; k++)
        if (wanted == 0 || k == wanted) status = check_overlap(&f, k, w, &r, whose, err);
    if (status == TOBI_OK) status = place_all(&f, wanted, w, number, err);
    free_flood(&f);
    return blame(w, &r, "level", status, err);
}

tobi_status tobi_vessel_resolve(tobi_world *w, tobi_error *err)
{
    for (int k = 0; k < w->region_count;) {
        if (w->regions[k].vessel[0]) TOBI_TRY(resolve(w, &k, err));
        else k++;
    }
    return TOBI_OK;
}

/* Filling vessels: the regions of their compartments. A compartment that is a box is a plain region, whose
   layers fit as those of other boxes; what it has beside, such as a drain, follows in the same rows.
   Drawback: in any other the rows keep the volume, and stand up to 3/4 of a spacing off its walls. */
#include "world/vessel.h"
#include "base/error.h"
#include "world/flood.h"
#include "world/overlap.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A row whose places lie on a wall is none: a half, less what rounding may add. */
static const double HALF = 0.5 - 1e-6;
/* Spacings: nearer to a wall than that no particle of a drain or nozzle begins. */
static const double CLEAR = 0.2;

static int has_seed(const tobi_region *r) { return r->seed[0] > -1e9; }

/* The compartment that is asked for: 0 = all, -1 = there is none, or other bodies hold them all. */
static int choose(const tobi_flood *f, const tobi_region *r, const double lower[3])
{
    double seed[3];
    int own = 0;
    for (int64_t c = 0; c < f->cells && !own; c++) own = f->label[c] > 0 && !(f->mark[c] & TOBI_FLOOD_HELD);
    if (!has_seed(r)) return own ? 0 : -1;
    for (int a = 0; a < 3; a++) seed[a] = r->seed[a] - lower[a];
    const int64_t c = tobi_flood_cell(f, seed);
    return c >= 0 && f->label[c] > 0 ? f->label[c] : -1;
}

static tobi_status find_nothing(const tobi_flood *f, const tobi_region *r, const char *whose, tobi_error *err)
{
    return tobi_fail(err, TOBI_INVALID, "%s: fill[%d] finds nothing to fill in vessel '%s' below a level of "
                     "%g m%s: it leaks at its lowest place, stands above the level, or its cells of one "
                     "spacing, %g m, are too coarse for it", whose, r->number, f->b->name, r->level,
                     has_seed(r) ? tr(" at the seed") : "", f->d);
}

/* No compartment at that level: says up to where there is one. */
static tobi_status refuse(tobi_flood *f, const tobi_world *w, const tobi_region *r, const char *whose,
                          tobi_error *err)
{
    const double *lower = w->system[0].box.lower, wish = r->level, base = tobi_flood_height(f, lower);
    double low[3], high[3], depth = 0, top = 0;
    tobi_bvh_box(f->b->bvh, low, high);
    for (int a = 0; a < f->dimension; a++) {
        depth += fabs(f->up[a])*(high[a] - low[a]);
        top += fmax(f->up[a]*low[a], f->up[a]*high[a]);
    }
    top = fmin(wish - base, top + 2*f->d);
    for (double down = f->d; down <= depth + 4*f->d; down += f->d) {
        f->level = top - down;
        tobi_flood_find_compartments(f);
        const int found = choose(f, r, lower);
        if (found < 0) continue;
        const double held = f->level;
        const int64_t leak = tobi_flood_leak(f, found);
        double x[3] = { 0 };
        if (leak >= 0) tobi_flood_place(f, leak, x);
        return tobi_fail(err, TOBI_INVALID, "%s: the level of fill[%d] is %g m, and vessel '%s' holds liquid "
                         "up to %.4g m only: above that it runs out over a rim or through a hole near (%.4g, "
                         "%.4g, %.4g) m", whose, r->number, wish, f->b->name, held + base, x[0] + lower[0],
                         x[1] + lower[1], x[2] + lower[2]);
    }
    return find_nothing(f, r, whose, err);
}

/* The points of a lattice that lie in a compartment. */
static tobi_status find_points(const tobi_flood *f, int label, const double low[3], const double step[3],
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
        if (!tobi_flood_has(f, label, x)) continue;
        for (int a = 0; a < 3; a++) r->points[r->point_count][a] = x[a] + (a < f->dimension ? corner[a] : 0);
        r->point_count++;
    }
    return TOBI_OK;
}

/* Layers from the lowest place to the level, with rows across them whose points have the volume of a
   particle. */
static void lay_rows(const tobi_flood *f, const double low[3], const double high[3], double first[3],
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

/* Out of the box, and not at a wall. */
static int is_beside(const tobi_flood *f, const tobi_region *box, const double x[3], const double corner[3])
{
    double local[3] = { 0 };
    int within = 1;
    for (int a = 0; a < f->dimension; a++) {
        within &= x[a] > box->lower[a] && x[a] < box->upper[a];
        local[a] = x[a] - corner[a];
    }
    return !within && tobi_flood_stands_free(f, local, CLEAR*f->d);
}

/* What a compartment has beside its box, by rows that go on from those of the box. */
static tobi_status find_rest(const tobi_flood *f, int label, const double low[3], const double high[3],
                             const tobi_region *box, const double corner[3], tobi_region *rest,
                             tobi_error *err)
{
    double first[3] = { 0 }, step[3] = { 0 };
    int64_t n[3] = { 1, 1, 1 }, beside = 0, kept = 0;
    *rest = *box;
    for (int a = 0; a < f->dimension; a++) {
        const double from = box->lower[a] - corner[a], to = box->upper[a] - corner[a];
        step[a] = (to - from)/tobi_region_layers(box, a, f->d);
        const double below = floor((from - low[a])/step[a] + HALF);
        const double above = floor((high[a] - to)/step[a] + HALF);
        first[a] = from - below*step[a];
        n[a] = (int64_t)(below + above + round((to - from)/step[a]));
        beside += (int64_t)(below + above);
    }
    if (beside == 0) return TOBI_OK;
    TOBI_TRY(find_points(f, label, first, step, n, corner, rest, err));
    for (int64_t k = 0; k < rest->point_count; k++)
        if (is_beside(f, box, rest->points[k], corner))
            memcpy(rest->points[kept++], rest->points[k], sizeof rest->points[k]);
    rest->point_count = kept;
    rest->volume = (double)kept*pow(f->d, f->dimension);
    return TOBI_OK;
}

/* The lattice in a compartment: layers evenly between its walls where it is a box, which then needs no
   points, beside the rest of it; else rows that hold its volume. */
static tobi_status place_points(tobi_flood *f, int label, tobi_region *r, tobi_region *rest,
                                const double corner[3], tobi_error *err)
{
    double low[3], high[3], flat_low[3], flat_high[3], first[3] = { 0 }, step[3] = { 0 };
    int64_t n[3] = { 1, 1, 1 };
    tobi_flood_box(f, label, 0, low, high);
    tobi_flood_box(f, label, 1, flat_low, flat_high);
    for (int a = 0; a < f->dimension; a++) {
        if (!(flat_high[a] > flat_low[a])) flat_low[a] = low[a], flat_high[a] = high[a];
        n[a] = (int64_t)fmax(1, floor((flat_high[a] - flat_low[a])/f->d + 0.5));
        step[a] = (flat_high[a] - flat_low[a])/(double)n[a];
    }
    TOBI_TRY(find_points(f, label, flat_low, step, n, corner, r, err));
    r->vessel[0] = '\0';
    const int is_box = r->point_count == n[0]*n[1]*n[2];
    for (int a = 0; a < 3; a++) {
        r->lower[a] = (is_box ? flat_low : low)[a] + corner[a];
        r->upper[a] = (is_box ? flat_high : high)[a] + corner[a];
    }
    if (is_box) {
        free(r->points);
        r->points = NULL;
        r->point_count = 0;
        r->volume = (flat_high[0] - flat_low[0])*(flat_high[1] - flat_low[1]) *
                    (f->dimension == 3 ? flat_high[2] - flat_low[2] : 1);
        return find_rest(f, label, low, high, r, corner, rest, err);
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
static tobi_status find_shared(const tobi_flood *f, int label, const tobi_region *other,
                               const double lower[3], double x[3], int *found, tobi_error *err)
{
    tobi_overlap *points = NULL;
    *found = 0;
    if (other->points)
        TOBI_TRY(tobi_overlap_create((const double (*)[3])other->points, other->point_count, f->dimension,
                                     f->d, &points, err));
    for (int64_t c = 0; c < f->cells && !*found; c++) {
        if (f->label[c] != label) continue;
        tobi_flood_place(f, c, x);
        for (int a = 0; a < f->dimension; a++) x[a] += lower[a];
        *found = holds(other, points, x, f->dimension);
    }
    tobi_overlap_free(points);
    return TOBI_OK;
}

/* Of two fluids the later one takes the place; solids, and regions of one fluid, may not share one. */
static tobi_status check_overlap(const tobi_flood *f, int label, const tobi_world *w, const tobi_region *r,
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

static tobi_status find_vessel(const tobi_world *w, const tobi_region *r, const char *whose, tobi_flood *f,
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
    f->level = r->level - tobi_flood_height(f, w->system[0].box.lower);
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
static tobi_status place_all(tobi_flood *f, int wanted, tobi_world *w, int *next, tobi_error *err)
{
    const int number = (*next)++;
    w->regions[number].in_vessel = 1;
    const tobi_region r = w->regions[number];
    char text[TOBI_NOTE];
    int64_t points = 0;
    for (int k = 1, taken = 0; k <= f->compartments; k++) {
        if (wanted > 0 && k != wanted) continue;
        tobi_region rest = { 0 }, *to = taken++ == 0 ? &w->regions[number] : add_region(w, &r, (*next)++);
        if (!to) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the compartments of a vessel");
        TOBI_TRY(place_points(f, k, to, &rest, w->system[0].box.lower, err));
        points += to->points ? to->point_count : 1;
        if (rest.point_count > 0 && add_region(w, &rest, *next)) ++*next;
        else free(rest.points);
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
    tobi_flood f = { 0 };
    tobi_status status = find_vessel(w, &r, whose, &f, err);
    if (status == TOBI_OK) status = tobi_flood_lay(&f, w, err);
    if (status == TOBI_OK) tobi_flood_find_compartments(&f);
    int wanted = status == TOBI_OK ? choose(&f, &r, corner) : -1;
    if (status == TOBI_OK && wanted < 0 && !has_seed(&r)) {
        tobi_flood_close_holes(&f, w);
        wanted = choose(&f, &r, corner);
    }
    if (status == TOBI_OK && wanted < 0) status = refuse(&f, w, &r, whose, err);
    for (int k = 1; status == TOBI_OK && k <= f.compartments; k++)
        if (wanted == 0 || k == wanted) status = check_overlap(&f, k, w, &r, whose, err);
    if (status == TOBI_OK) status = place_all(&f, wanted, w, number, err);
    tobi_flood_free(&f);
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

/* Hydrostatic pressure that no solve knows (sph/hydrostatic.h) beside soft solids: it presses a solid as the
   liquid that it displaces would, by -V grad p at each particle. That is exact for a solid within the liquid,
   however its particles and those of the liquid stand (decision 112). The level of still water lies below
   air beside a solid, as behind a gate. Where a body touches a solid both are pressed as by the liquid;
   where a side of the domain does, neither is. Drawback: still water does not compress a solid. */
#include "sph/soft.h"
#include "exec/exec.h"
#include "geom/vec3.h"
#include "sph/reference.h"
#include "sph/sensor/around.h"
#include "sph/state.h"
#include <string.h>

/* Air is looked for so many marks from a point of a solid; it has no liquid within so many spacings, and no
   side or body: no layer of liquid fits there. */
static const double LOOK = 2.5, LIQUID = 1.1, COVER = 0.75;
/* Marks at most: per point of a solid, and besides. */
static const double MARKS_EACH = 8, MARKS = 1e6;

/* Takes the pressure from what started at a side of the domain: no liquid is between. The layers before the
   side have one spacing of the solid each; the first has the force. Not from sand, whose pores have the
   liquid at the side too. */
static void take_off_at_sides(const tobi_system *s, int64_t point, double force[3])
{
    const tobi_soft *soft = &s->sim->soft;
    const double d = soft->solids->smoothing.spacing, area = soft->size[point].volume/d;
    const tobi_double3 p = soft->position[point];
    if (soft->solids->solids[soft->solid[point]].def.model == TOBI_SAND) return;
    for (int a = 0; a < s->box.dimension; a++)
        for (int upper = 0; upper < 2 && !s->box.periodic[a]; upper++) {
            if (soft->touched[soft->solid[point]] >> (2*a + upper) & 1) continue;
            double at[3] = { p.x, p.y, p.z };
            const double gap = upper ? s->box.size[a] - at[a] : at[a], share = 1 - fabs(gap/d - 0.5);
            if (!(share > 0)) continue;
            at[a] = upper ? s->box.size[a] : 0;
            force[a] += (upper ? 1 : -1)*share*area*tobi_reference_pressure(&sph_of(s)->soft.still, at);
        }
}

void sph_soft_still_force(const tobi_system *s, int64_t point, double force[3])
{
    const tobi_soft *soft = &s->sim->soft;
    const tobi_reference *w = &sph_of(s)->soft.still;
    const double volume = soft->size[point].volume, density = s->fluid[0].density,
                 held = w->push*tobi_reference_share(w, &soft->position[point].x);
    for (int a = 0; a < 3; a++) force[a] = 0;
    for (int a = 0; a < s->box.dimension; a++)
        force[a] = -volume*(density*(s->sim->def.gravity[a] - s->gravity[a]) + held*w->down[a]);
    if (w->push > 0) take_off_at_sides(s, point, force);
}

static void sum_forces(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    for (int64_t b = begin; b < end; b++) {
        double force[3];
        sph_soft_still_force(s, b, force);
        for (int a = 0; a < 3; a++) totals[a] += force[a];
    }
}

void sph_soft_still_sum(tobi_system *s, double force[3])
{
    double t[TOBI_TOTALS] = { 0 };
    if (s->sim->soft.solids)
        tobi_launch(&s->sim->exec, TOBI_HOST(sum_forces, 3, 0), s, 0, s->sim->soft.count, t);
    for (int a = 0; a < 3; a++) force[a] = t[a];
}

/* --- where solids are ------------------------------------------------------------------------------ */

typedef struct axis_of { const tobi_soft *soft; int axis; double size; } axis_of;

/* totals: largest distance from the lower side of the domain, and from the upper. */
static void find_ends(const void *view, int64_t begin, int64_t end, double *totals)
{
    const axis_of *v = view;
    for (int64_t b = begin; b < end; b++) {
        const double x = (&v->soft->position[b].x)[v->axis];
        totals[6] = fmax(totals[6], x);
        totals[7] = fmax(totals[7], v->size - x);
    }
}

/* The mark around x; beyond them all -2 or two past the last. */
static void find_mark(const sph_soft_marks *m, const double *x, int at[3])
{
    for (int a = 0; a < 3; a++)
        at[a] = (int)floor(fmin(fmax((x[a] - m->low[a])*m->inverse, -2), m->n[a] + 2));
}

/* NULL beyond them. */
static uint8_t *get_mark(const sph_soft_marks *m, int x, int y, int z)
{
    if (x < 0 || y < 0 || z < 0 || x >= m->n[0] || y >= m->n[1] || z >= m->n[2]) return NULL;
    return &m->taken[((int64_t)z*m->n[1] + y)*m->n[0] + x];
}

static int is_marked(const sph_soft_marks *m, int x, int y, int z)
{
    const uint8_t *mark = get_mark(m, x, y, z);
    return mark && *mark;
}

static void mark_points(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_soft_marks *m = &sph_of(s)->soft.marks;
    for (int64_t b = begin; b < end; b++) {
        int at[3];
        find_mark(m, &s->sim->soft.position[b].x, at);
        uint8_t *mark = get_mark(m, at[0], at[1], at[2]);
        if (mark) __atomic_store_n(mark, 1, __ATOMIC_RELAXED);
    }
}

/* Marks as wide as the spacing of the solids, wider where these lie far apart. Nobody asks where the
   liquid feels no gravity. */
tobi_status sph_soft_mark(tobi_system *s, tobi_error *err)
{
    sph_soft_marks *m = &sph_of(s)->soft.marks;
    const tobi_soft *soft = &s->sim->soft;
    const double least = soft->solids->smoothing.spacing, most = MARKS_EACH*(double)soft->count + MARKS;
    double low[3] = { 0 }, size[3] = { 0 }, volume = 1, t[TOBI_TOTALS];
    if (!(sph_reference_make(s, 1).push > 0)) return TOBI_OK;
    for (int a = 0; a < s->box.dimension; a++) {
        const axis_of v = { soft, a, s->box.size[a] };
        tobi_launch(&s->sim->exec, TOBI_HOST(find_ends, 0, 2), &v, 0, soft->count, t);
        low[a] = s->box.size[a] - t[7] - 0.5*least;        /* no rounding leaves a point outside */
        volume *= size[a] = fmax(t[6] - low[a], 0) + 0.5*least;
    }
    const double width = fmax(least, s->box.dimension == 3 ? cbrt(volume/most) : sqrt(volume/most));
    int64_t count = 1;
    m->inverse = 1/width;
    for (int a = 0; a < 3; a++) {
        m->low[a] = low[a];
        count *= m->n[a] = 1 + (int)(size[a]/width);
    }
    if (count > m->room) {
        tobi_array_free(m->taken);
        m->room = 0;
        m->taken = tobi_array_make(count + count/4, 1);
        if (!m->taken) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for marks of %lld points of solids",
                                        (long long)soft->count);
        m->room = count + count/4;
    }
    memset(m->taken, 0, (size_t)count);
    tobi_loop(s->sim->exec.threads, soft->count, 0, mark_points, s);
    return TOBI_OK;
}

/* Whether a point of a solid is within a mark or two of x. */
static int meets_solid(const tobi_system *s, const double x[3])
{
    const sph_soft_marks *m = &sph_of(s)->soft.marks;
    int at[3];
    find_mark(m, x, at);
    for (int k = -1; k <= 1; k++)
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++)
                if (is_marked(m, at[0] + i, at[1] + j, at[2] + k)) return 1;
    return 0;
}

int sph_soft_fills(const tobi_system *s, const double x[3])
{
    const sph_soft_marks *m = &sph_of(s)->soft.marks;
    if (!s->sim->soft.solids || !m->taken) return 0;
    for (int corner = 0; corner < 8; corner++) {
        double place[3];
        int at[3];
        for (int a = 0; a < 3; a++)
            place[a] = x[a] + (a < s->box.dimension ? (corner >> a & 1) - 0.5 : 0)/m->inverse;
        find_mark(m, place, at);
        if (is_marked(m, at[0], at[1], at[2])) return 1;
    }
    return 0;
}

int sph_soft_meets(const tobi_system *s, const double from[3], const double to[3])
{
    const sph_soft_marks *m = &sph_of(s)->soft.marks;
    double way[3];
    if (!s->sim->soft.solids) return 0;
    vec3_sub(way, to, from);
    const int parts = 1 + (int)(sqrt(vec3_dot(way, way))*m->inverse);
    for (int k = 0; k <= parts; k++) {
        double x[3];
        int at[3];
        for (int a = 0; a < 3; a++) x[a] = from[a] + k*way[a]/parts;
        find_mark(m, x, at);
        if (is_marked(m, at[0], at[1], at[2])) return 1;
    }
    return 0;
}

/* --- air beside them ------------------------------------------------------------------------------- */

static void meet(void *user, int64_t i, const double d[3])
{
    (void)i;
    double *nearest = user;
    *nearest = fmin(*nearest, vec3_dot(d, d));
}

static int meets_liquid(const tobi_system *s, const double x[3])
{
    const double reach = LIQUID*s->smoothing.spacing;
    const sph_range cells = sph_cells_around(s, x, reach);
    double nearest = INFINITY;
    sph_visit(s, x, &cells, meet, &nearest);
    return nearest < reach*reach;
}

/* The inside of a body that holds the solid does not count: by isph no water presses where it holds it, and
   still water would press the solid as if it were closed there. */
static int meets_body(const tobi_system *s, const tobi_solid *solid, const double x[3])
{
    tobi_bvh_hit hit;
    for (int k = 0; k < s->sim->body_count; k++) {
        const tobi_body *b = &s->sim->bodies[k];
        if (!b->is_absent && (tobi_bvh_closest(b->bvh, x, COVER*s->smoothing.spacing, &hit) ||
                              (!tobi_solid_is_clamped(solid, k) && tobi_bvh_inside(b->bvh, x)))) return 1;
    }
    return 0;
}

/* What lies in a body, or so near to one or to a side that no liquid fits between, is not dry. */
static int is_dry(const tobi_system *s, int64_t point, const double x[3])
{
    const tobi_soft *soft = &s->sim->soft;
    const tobi_solid *solid = &soft->solids->solids[soft->solid[point]];
    const double reach = fmax(LOOK/sph_of(s)->soft.marks.inverse,
                              COVER*s->smoothing.spacing + 0.5*soft->solids->smoothing.spacing);
    for (int way = 0; way < 2*s->box.dimension; way++) {
        const int a = way/2;
        double at[3] = { x[0], x[1], x[2] };
        at[a] += way%2 ? -reach : reach;
        if (!s->box.periodic[a] && (at[a] < 0 || at[a] > s->box.size[a])) continue;
        if (!meets_solid(s, at) && !meets_liquid(s, at) && !meets_body(s, solid, at)) return 1;
    }
    return 0;
}

typedef struct drying { const tobi_system *s; double below; } drying;

/* totals: largest depth. */
static void find_dry(const void *view, int64_t begin, int64_t end, double *totals)
{
    const drying *d = view;
    const sph_soft *q = &sph_of(d->s)->soft;
    for (int64_t b = begin; b < end; b++) {
        const tobi_double3 p = d->s->sim->soft.position[b];
        const double x[3] = { p.x, p.y, p.z }, depth = tobi_reference_depth(&q->still, x);
        q->dry[b] = depth > d->below && is_dry(d->s, b, x) ? (float)depth : 0;
        totals[6] = fmax(totals[6], q->dry[b]);
    }
}

double sph_soft_find_dry(tobi_system *s, double below)
{
    const drying d = { s, below };
    double t[TOBI_TOTALS] = { 0 };
    if (s->sim->soft.solids)
        tobi_launch(&s->sim->exec, TOBI_HOST(find_dry, 0, 1), &d, 0, s->sim->soft.count, t);
    return t[6];
}

/* --- bodies that touch them ------------------------------------------------------------------------ */

typedef struct wetting { const tobi_system *s; tobi_body *body; } wetting;

int sph_soft_touches(const tobi_system *s, const tobi_body *b, int64_t point)
{
    const double reach = s->sim->soft.solids->smoothing.spacing;
    double at[3];
    for (int a = 0; a < 3; a++) at[a] = b->point[point][a] + reach*b->normal[point][a];
    return meets_solid(s, at);
}

static void wet_points(const void *view, int64_t begin, int64_t end)
{
    const wetting *w = view;
    for (int64_t k = begin; k < end; k++)
        if (!w->body->wet[k] && sph_soft_touches(w->s, w->body, k)) w->body->wet[k] = TOBI_WET;
}

void sph_soft_wet_bodies(tobi_system *s)
{
    if (!s->sim->soft.solids || !(sph_of(s)->reference.push > 0)) return;
    for (int k = 0; k < s->sim->body_count; k++) {
        const wetting w = { s, &s->sim->bodies[k] };
        tobi_loop(s->sim->exec.threads, w.body->point_count, 256, wet_points, &w);
    }
}

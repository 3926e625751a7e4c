/* Water in gaps between bodies and sides. Under a body that lies flat on a floor there are no particles, and
   without pressure there the water above would hold it down for ever. A gap has the pressure of the points
   around it, its rim, on average, and that of liquid at rest from there on; a rim that is dry counts with no
   pressure. So the force stays linear in the pressures of the particles, and the equation symmetric.
   Soft solids that lie on a body have the pressure of still water between, as they are pressed by it
   (sph/soft_still.c). Drawback: a gap has no flow, hence no suction when a body leaves fast. */
#include "sph/isph/gaps.h"
#include "sph/isph/bodies.h"
#include "sph/state.h"
#include <math.h>
#include <string.h>

typedef struct gap_view {
    const tobi_system *s;
    const isph_view *v;
    const tobi_body *b;
    isph_point *point;
    double middle[3], wet;           /* m, of the wet points of the rim; their share of its area */
    int body, kind;                  /* kind: one bit of tobi_boundary_near                      */
} gap_view;

static int is_dry(const isph_point *p) { return !(p->weight < INFINITY); }

/* totals[q]: area of what faces side q in a gap; the first of the maxima is 1 for another body. */
static void mark_gaps(const void *view, int64_t begin, int64_t end, double *totals)
{
    const gap_view *g = view;
    const tobi_body *b = g->b;
    for (int64_t k = begin; k < end; k++) {
        isph_point *p = &g->point[k];
        p->gap = p->rim = 0;
        if (!is_dry(p) || !(b->area[k] > 0) || b->wet[k] == TOBI_BURIED) continue;
        p->gap = (uint8_t)tobi_boundary_near(g->s, g->body, b->point[k], b->normal[k],
                                             g->s->smoothing.spacing);
        for (int q = 0; q < TOBI_SUMS; q++)
            if (p->gap & 1 << q) totals[q] += b->area[k];
        if (p->gap & TOBI_NEAR_BODY) totals[TOBI_SUMS] = 1;
    }
}

/* A dry point that looks away from what is near, such as one on the outside of a vessel's floor, does not say
   that the rim is dry. */
static int looks_away(const gap_view *g, int64_t k)
{
    const double *n = g->b->normal[k], back[3] = { -n[0], -n[1], -n[2] };
    return tobi_boundary_near(g->s, g->body, g->b->point[k], back, g->s->smoothing.h) & g->kind;
}

/* totals: area of the rim; of its wet part area, place, pressure of rest. */
static void sum_rim(const void *view, int64_t begin, int64_t end, double *totals)
{
    const gap_view *g = view;
    const tobi_body *b = g->b;
    for (int64_t k = begin; k < end; k++) {
        isph_point *p = &g->point[k];
        const double area = b->area[k];
        if (p->gap || !(area > 0) || b->wet[k] == TOBI_BURIED) continue;
        if (!(tobi_boundary_near(g->s, g->body, b->point[k], NULL, g->s->smoothing.h) & g->kind)) continue;
        if (is_dry(p) && looks_away(g, k)) continue;
        p->rim |= (uint8_t)g->kind;
        totals[0] += area;
        if (is_dry(p)) continue;
        totals[1] += area;
        for (int a = 0; a < 3; a++) totals[2 + a] += area*b->point[k][a];
        totals[5] += area*p->hydrostatic/p->weight;
    }
}

/* A point may face two sides: each has its part. */
static double share_of(const gap_view *g, int64_t k)
{
    return g->point[k].gap & g->kind ? g->b->area[k]/__builtin_popcount(g->point[k].gap) : 0;
}

static void sum_push(const void *view, int64_t begin, int64_t end, double *totals)
{
    const gap_view *g = view;
    for (int64_t k = begin; k < end; k++) isph_bodies_push(g->b, k, share_of(g, k), totals);
}

/* The force of liquid at rest between the rim and the points of the gap. */
static void sum_rest(const void *view, int64_t begin, int64_t end, double *totals)
{
    const gap_view *g = view;
    for (int64_t k = begin; k < end; k++) {
        const double area = share_of(g, k);
        double pull[3] = { 0 }, deeper = 0;
        if (area == 0) continue;
        if (g->v->acceleration.acts) tobi_acceleration_at(&g->v->acceleration, g->b->point[k], pull);
        for (int a = 0; a < 3; a++) deeper += (pull[a] + g->v->gravity[a])*(g->b->point[k][a] - g->middle[a]);
        isph_bodies_push(g->b, k, -area*g->wet*g->v->density*deeper, totals);
    }
}

/* rest: its force that is not linear in the pressures of the particles. */
static void find_gap(isph_solver *m, gap_view *g, isph_gap *gap, double rest[TOBI_TOTALS])
{
    const int64_t count = g->b->point_count;
    double rim[TOBI_TOTALS] = { 0 }, push[TOBI_TOTALS] = { 0 };
    tobi_launch(m->exec, TOBI_HOST(sum_rim, 6, 0), g, 0, count, rim);
    if (!(rim[1] > 0)) return;
    g->wet = rim[1]/rim[0];
    for (int a = 0; a < 3; a++) g->middle[a] = rim[2 + a]/rim[1];
    tobi_launch(m->exec, TOBI_HOST(sum_push, 6, 0), g, 0, count, push);
    tobi_launch(m->exec, TOBI_HOST(sum_rest, 6, 0), g, 0, count, rest);
    gap->rim = rim[0];
    memcpy(gap->push, push, sizeof gap->push);
    for (int a = 0; a < 6; a++) rest[a] -= push[a]*rim[5]/rim[0];
}

void isph_gaps_find(isph_solver *m, tobi_system *s, int k, isph_point *point, double f[6])
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    isph_body *body = &m->body[k];
    gap_view g = { .s = s, .v = &m->view, .b = &s->sim->bodies[k], .point = point, .body = k };
    double t[TOBI_TOTALS] = { 0 };
    memset(body->gap, 0, sizeof body->gap);
    memset(body->gap_rest, 0, sizeof body->gap_rest);
    body->gaps = 0;
    if (n->first[k] == n->first[k + 1] || g.b->sealed) return;
    tobi_launch(m->exec, TOBI_HOST(mark_gaps, TOBI_SUMS, 1), &g, 0, g.b->point_count, t);
    for (int q = 0; q < TOBI_NEAR_KINDS; q++) {
        double rest[TOBI_TOTALS] = { 0 };
        if (!(t[q] > 0) || (g.b->dry_outside && 1 << q != TOBI_NEAR_BODY)) continue;
        g.kind = 1 << q;
        find_gap(m, &g, &body->gap[q], rest);
        body->gaps |= body->gap[q].rim > 0;
        for (int a = 0; a < 6; a++) f[a] += rest[a];
        if (g.kind != TOBI_NEAR_BODY) body->gap_rest[q/2] += rest[q/2];
    }
}

void isph_gaps_add(const isph_body *b, const tobi_body *body, const isph_point *point, int64_t k,
                   double push[6])
{
    for (int q = 0; q < TOBI_NEAR_KINDS && point[k].rim; q++)
        for (int a = 0; a < 6 && point[k].rim & 1 << q && b->gap[q].rim > 0; a++)
            push[a] += body->area[k]/b->gap[q].rim*b->gap[q].push[a];
}

void isph_gaps_add_side(const isph_body *b, const tobi_body *body, const isph_point *p, int64_t k,
                        double share, double f[3])
{
    for (int q = 0; q < TOBI_NEAR_KINDS && p->rim; q++)
        if (1 << q != TOBI_NEAR_BODY && p->rim & 1 << q && b->gap[q].rim > 0)
            f[q/2] -= share*body->area[k]/b->gap[q].rim*b->gap[q].push[q/2];
}

/* totals: the force of still water on points that no particle sees as a soft solid lies there. Where the body
   holds the solid, none. */
static void press_touched(const void *view, int64_t begin, int64_t end, double *totals)
{
    const gap_view *g = view;
    const tobi_body *b = g->b;
    for (int64_t k = begin; k < end; k++) {
        const isph_point *p = &g->point[k];
        if (!is_dry(p) || p->gap || p->held > 0 || !(b->area[k] > 0) || b->wet[k] == TOBI_BURIED) continue;
        if (!sph_soft_touches(g->s, b, k)) continue;
        const double still = tobi_reference_pressure(&sph_of(g->s)->soft.still, b->point[k]);
        isph_bodies_push(b, k, -b->area[k]*still, totals);
    }
}

void isph_gaps_add_still(isph_solver *m, tobi_system *s)
{
    if (!s->sim->soft.solids || !(sph_of(s)->soft.still.push > 0)) return;
    for (int k = 0; k < s->sim->body_count; k++) {
        const gap_view g = { .s = s, .v = &m->view, .b = &s->sim->bodies[k], .body = k,
                             .point = m->point + sph_of(s)->links.bins[k].item };
        double t[TOBI_TOTALS] = { 0 };
        tobi_launch(m->exec, TOBI_HOST(press_touched, 6, 0), &g, 0, g.b->point_count, t);
        for (int a = 0; a < 6; a++) m->body[k].rest_force[a] += t[a];
    }
}

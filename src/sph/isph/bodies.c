/* Bodies as mirrors of isph: a plane per particle and body, through the closest point of its surface, and
   further ones in concave corners (corners.c). How much of the half space behind the plane is body tells
   edges and tips from faces. Drawback: room for all planes of a corner for every particle beside a body that
   is not convex. */
#include "sph/isph/bodies.h"
#include "sph/isph/body_pairs.k.h"
#include "sph/isph/body_sides.h"
#include "sph/isph/corners.h"
#include "sph/state.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

static void interpolate(const tobi_body *b, const tobi_boundary_entry *e, const double (*vertex)[3],
                        double out[3])
{
    const int32_t *t = b->mesh.triangles[e->triangle];
    for (int a = 0; a < 3; a++) {
        out[a] = 0;
        for (int c = 0; c < 3; c++) out[a] += e->barycentric[c]*vertex[t[c]][a];
    }
}

/* The normal of the surface that the kernel sees: it turns steadily where the closest facet changes at once,
   else forces on round bodies jump with every facet that a particle passes. */
static void find_normal(const tobi_boundary_link *link, const tobi_boundary_entry *e,
                        const tobi_smoothing_constants *c, double normal[3])
{
    const double size = sqrt(vec3_dot(link->gradient, link->gradient));
    const int seen = size*c->h > 1e-3, apart = e->distance > 0.05*c->spacing;
    for (int a = 0; a < 3; a++)
        normal[a] = seen ? -link->gradient[a]/size : apart ? e->offset[a]/e->distance : e->foot_normal[a];
}

static isph_mirror make_mirror(const tobi_system *s, const tobi_boundary_link *link,
                               const tobi_boundary_entry *e)
{
    isph_mirror m = { .body = link->body, .previous = link->previous };
    const tobi_smoothing_constants *c = &s->smoothing;
    const double lambda = tobi_wall_table_at(c->plane.lambda, fmax(e->distance, 0)/c->h*TOBI_PLANE_SAMPLES);
    if (e->triangle < 0) return m;
    m.share = lambda > 1e-6 ? fmin(e->steady/lambda, 1) : 0;
    memcpy(m.offset, e->offset, sizeof m.offset);
    find_normal(link, e, c, m.normal);
    const tobi_body *b = &s->sim->bodies[link->body];
    double before[3];
    interpolate(b, e, (const double (*)[3])b->vertex_velocity, m.velocity);
    double flow[3] = { 0 };
    if (b->rigid.kind != TOBI_PRESCRIBED) tobi_body_carry(b, e->foot, b->rigid.before, before);
    else interpolate(b, e, (const double (*)[3])b->vertex_before, before);
    if (b->swimmer) interpolate(b, e, (const double (*)[3])b->vertex_before, flow);
    for (int a = 0; a < 3; a++) m.velocity_change[a] = m.velocity[a] - before[a] - flow[a];
    return m;
}

typedef struct mirrors { isph_solver *m; const tobi_system *s; double dt; } mirrors;

static void make_briefs(const void *view, int64_t begin, int64_t end)
{
    const isph_solver *m = ((const mirrors *)view)->m;
    for (int64_t k = begin; k < end; k++) isph_make_brief(&m->mirror[k], &m->brief[k + 1]);
}

static void make_mirrors(const void *view, int64_t begin, int64_t end)
{
    const mirrors *all = view;
    const tobi_boundary_links *n = &sph_of(all->s)->links;
    isph_mirror *m = all->m->mirror, more[ISPH_CORNER_FACES];
    for (int64_t k = begin; k < end; k++) {
        isph_body_sides_add(&all->m->view, all->s, &n->link[k], &n->entry[k]);
        m[k] = make_mirror(all->s, &n->link[k], &n->entry[k]);
        if (!all->m->corners) continue;
        const int found = isph_corner_find(all->s, &n->link[k], &n->entry[k], &m[k], more);
        for (int f = 0; f < found; f++) {            /* into the chain of the particle, behind the first */
            const int64_t at = n->count*(f + 1) + k;
            m[at] = more[f];
            m[at].previous = m[k].previous;
            m[k].previous = (int32_t)at;
        }
    }
}

/* Of the trace of (2): by the theorem of Gauss the kernel's share and a share of the heights. */
static float share_of_trace(const tobi_system *s, const tobi_boundary_entry *e)
{
    return (float)fmin(e->steady + e->height/s->smoothing.dimension, 0.98);
}

/* The links of a particle are handled together, where the last of them stands. */
static void add_shares(const void *view, int64_t begin, int64_t end)
{
    const mirrors *all = view;
    const tobi_boundary_links *n = &sph_of(all->s)->links;
    const isph_view *v = &all->m->view;
    for (int64_t k = begin; k < end; k++) {
        const int64_t i = n->link[k].particle;
        for (int64_t q = v->last_link[i] == k ? k : -1; q >= 0; q = n->link[q].previous)
            v->body_share[i] = 1 - (1 - v->body_share[i])*(1 - share_of_trace(all->s, &n->entry[q]));
        if (v->last_link[i] == k) v->body_share[i] += (float)n->entry[k].hidden;
    }
}

static tobi_status reserve_mirrors(isph_solver *m, int64_t need, tobi_error *err)
{
    const int64_t room = need + need/2 + 64;
    if (need <= m->mirrors) return TOBI_OK;
    isph_mirror *more = tobi_array_grow(m->mirror, 0, room, sizeof *more);
    if (more) m->mirror = more;
    int64_t *first = more ? tobi_array_grow(m->view.first_group, 0, room, sizeof *first) : NULL;
    if (!first) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld mirrors", (long long)room);
    m->view.first_group = first;
    isph_brief *brief = tobi_array_grow(m->brief, 0, room + 1, sizeof *brief);
    if (!brief) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld mirrors", (long long)room);
    brief[0] = (isph_brief){ .body = -1 };
    m->view.brief = m->brief = brief;
    m->mirrors = room;
    return TOBI_OK;
}

/* Images of pairs; how many there are is known when all are made. */
static tobi_status list_images(isph_solver *m, tobi_error *err)
{
    isph_view *v = &m->view;
    v->group_count = &m->groups;
    for (;;) {
        m->groups = 0;
        tobi_launch(m->exec, m->kernel->isph_list_images, v, 0, v->count, NULL);
        if (m->groups <= v->group_room) return TOBI_OK;
        const int64_t room = m->groups + m->groups/8 + 64;
        isph_group_place *more = tobi_array_grow(v->group, 0, room, sizeof *more);
        if (!more)
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld groups of images", (long long)room);
        v->group = more;
        v->group_room = room;
    }
}

tobi_status isph_bodies_find_mirrors(isph_solver *m, tobi_system *s, tobi_error *err)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    isph_view *v = &m->view;
    if (s->particles.count > 0) memset(v->body_share, 0, (size_t)s->particles.count*sizeof *v->body_share);
    v->last_link = s->sim->body_count ? sph_fields_of(&s->particles)->last_link : NULL;
    if (!v->last_link) return TOBI_OK;
    m->corners = 0;
    for (int b = 0; b < s->sim->body_count; b++) m->corners |= !s->sim->bodies[b].convex;
    const int64_t rows = n->count*(m->corners ? s->box.dimension : 1);
    TOBI_TRY(reserve_mirrors(m, rows, err));
    v->mirror = m->mirror;
    const mirrors all = { m, s, 0 };
    tobi_loop(s->sim->exec.threads, n->count, 0, make_mirrors, &all);
    tobi_loop(s->sim->exec.threads, n->count, 0, add_shares, &all);
    tobi_loop(s->sim->exec.threads, rows, 0, make_briefs, &all);
    return list_images(m, err);
}

static void remove_hydrostatic(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const tobi_boundary_links *n = &sph_of(s)->links;
    const int32_t *last = sph_fields_of(&s->particles)->last_link;
    for (int64_t k = begin; k < end; k++) {
        const int64_t i = n->link[k].particle;
        for (int64_t q = last[i] == k ? k : -1; q >= 0; q = n->link[q].previous)
            for (int a = 0; a < 3; a++)
                (&s->particles.velocity[i].x)[a] -= (float)(s->dt*n->entry[q].hydrostatic[a]);
    }
}

void isph_bodies_remove_hydrostatic(tobi_system *s)
{
    tobi_loop(s->sim->exec.threads, sph_of(s)->links.count, 0, remove_hydrostatic, s);
}

static void accelerate(const void *view, int64_t begin, int64_t end)
{
    const mirrors *all = view;
    const tobi_boundary_links *n = &sph_of(all->s)->links;
    for (int64_t k = begin; k < end; k++) {
        const tobi_boundary_entry *e = &n->entry[k];
        const tobi_body *b = &all->s->sim->bodies[n->link[k].body];
        const tobi_double3 *x = &all->s->particles.position[n->link[k].particle];
        if (e->triangle < 0 || b->rigid.kind == TOBI_PRESCRIBED) continue;
        int64_t at = k;
        do {                                         /* the first, and those of corners behind it */
            isph_mirror *m = &all->m->mirror[at];
            const double place[3] = { x->x - m->offset[0], x->y - m->offset[1], x->z - m->offset[2] };
            double u[3];
            tobi_body_carry(b, at == k ? e->foot : place, n->answer[n->link[k].body], u);
            for (int a = 0; a < 3; a++) {
                m->velocity[a] += all->dt*u[a];
                m->velocity_change[a] += all->dt*u[a];
            }
            at = m->previous;
        } while (at >= n->count);
    }
}

void isph_bodies_accelerate(isph_solver *m, tobi_system *s, double dt)
{
    const mirrors all = { m, s, dt };
    tobi_loop(s->sim->exec.threads, sph_of(s)->links.count, 0, accelerate, &all);
}

void isph_bodies_refresh_images(isph_solver *m)
{
    if (m->view.last_link)
        tobi_launch(m->exec, m->kernel->isph_refresh_images, &m->view, 0, m->view.count, NULL);
}

void isph_bodies_lever(const tobi_body *b, int64_t k, double lever[6])
{
    double arm[3];
    for (int a = 0; a < 3; a++) arm[a] = b->point[k][a] + b->lower[a] - b->centre[a];
    memcpy(lever, b->normal[k], 3*sizeof *lever);
    vec3_cross(lever + 3, arm, b->normal[k]);
}

void isph_bodies_push(const tobi_body *b, int64_t k, double push, double f[6])
{
    double lever[6];
    isph_bodies_lever(b, k, lever);
    for (int a = 0; a < 6; a++) f[a] += push*lever[a];
}

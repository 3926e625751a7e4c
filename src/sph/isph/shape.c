/* The power of pressure on bodies that change their shape, by the velocities that the change adds: the sums
   of sph/isph/forces.c with those in place of levers (decision 142). Drawback: gaps beside a body press it as
   a rigid one. */
#include "sph/isph/shape.h"
#include "sph/boundary/boundary.h"
#include "sph/state.h"
#include "geom/vec3.h"

typedef struct shape_view { const tobi_system *s; const isph_solver *m; int body; } shape_view;

/* m3/s: what a point sweeps by the change of shape. */
static double sweep_of(const tobi_body *b, int64_t k)
{
    double flow[3];
    tobi_body_point_flow(b, k, flow);
    return b->area[k]*vec3_dot(b->normal[k], flow);
}

/* A particle's look at the points of one body. */
typedef struct look { const shape_view *v; const tobi_body *b; const isph_point *point; double sum; } look;

static void add_points(void *user, tobi_facing_points *l)
{
    look *g = user;
    const tobi_smoothing_constants *c = &g->v->s->smoothing;
    tobi_facing_weigh(l, c);
    for (int i = 0; i < l->count; i++) {
        const int32_t k = tobi_facing_point(l, i)->number;
        if (!(g->point[k].weight < INFINITY)) continue;
        g->sum -= c->volume*c->weight_correction*l->weight[i]/g->point[k].weight*sweep_of(g->b, k);
    }
}

/* totals[0]: W, of the pressures of the particles. */
static void sum_particles(const void *view, int64_t begin, int64_t end, double *totals)
{
    const shape_view *v = view;
    const tobi_boundary_links *n = &sph_of(v->s)->links;
    for (int64_t k = begin; k < end; k++) {
        const tobi_boundary_link *l = &n->link[k];
        const tobi_body *b = &v->s->sim->bodies[l->body];
        const tobi_double3 *at = &v->m->view.position[l->particle];
        const double x[3] = { at->x, at->y, at->z };
        look g = { v, b, v->m->point + n->bins[l->body].item, 0 };
        if (!b->deforms) continue;
        tobi_boundary_take_facing(n, l->body, x, v->s->smoothing.h, add_points, &g);
        totals[0] += g.sum*v->m->view.solution[l->particle];
    }
}

/* totals[0]: W, of what the surface has beyond them: of water at rest and of water that it accelerates. */
static void sum_points(const void *view, int64_t begin, int64_t end, double *totals)
{
    const shape_view *v = view;
    const tobi_body *b = &v->s->sim->bodies[v->body];
    const isph_point *point = v->m->point + sph_of(v->s)->links.bins[v->body].item;
    const double *taken = v->m->body[v->body].taken;
    for (int64_t k = begin; k < end; k++) {
        const isph_point *p = &point[k];
        double lever[6];
        if (!(p->weight < INFINITY)) continue;
        isph_bodies_lever(b, k, lever);
        const double along = vec3_dot(lever, taken) + vec3_dot(lever + 3, taken + 3) +
                             tobi_body_point_acceleration(b, k, v->s->dt);
        totals[0] -= (p->hydrostatic + v->m->view.density*p->distance*along)/p->weight*sweep_of(b, k);
    }
}

void isph_shape_load(isph_solver *m, tobi_system *s)
{
    shape_view v = { s, m, 0 };
    const tobi_boundary_links *n = &sph_of(s)->links;
    if (!tobi_body_any_deforms(s->sim->bodies, s->sim->body_count)) return;
    tobi_boundary_sum(s, TOBI_HOST(sum_particles, 1, 0), &v, 0);
    for (v.body = 0; v.body < s->sim->body_count; v.body++) {
        tobi_body *b = &s->sim->bodies[v.body];
        double t[TOBI_TOTALS] = { 0 };
        if (!b->deforms || n->first[v.body] == n->first[v.body + 1]) continue;
        tobi_launch(m->exec, TOBI_HOST(sum_points, 1, 0), &v, 0, b->point_count, t);
        b->load[s->number].shape += n->total[v.body][0] + t[0];
    }
}

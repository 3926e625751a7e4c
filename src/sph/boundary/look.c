/* Surface sums over the quadrature points a fluid particle sees (docs/theory/boundaries.md).
   A point counts when it faces the particle and no part of the body lies between. For a function f(s)
   of the distance to a plane, sum A W f(s_b)/sigma(s_b) with s_b the distance to the point's tangent
   plane gives f(s) exactly on a plane and its natural extension on curves and edges. The points that face
   the particle are listed first, then weighed together. Drawback: the list is short, and long ones take
   several rounds. */
#include "sph/boundary/boundary.h"
#include "sph/boundary/look.h"
#include "sph/hydrostatic.h"
#include "sph/scalars.h"
#include "sph/state.h"
#include <math.h>
#include <string.h>

/* Of the spacing: so far above a point ends the line of sight. */
static const double LIFT = 1e-3;

static double dot(const double a[3], const double b[3]) { return a[0]*b[0] + a[1]*b[1] + a[2]*b[2]; }

/* A particle's look at one body. */
typedef struct look {
    const tobi_system *s;
    double x[3];
    tobi_look_view view;
    tobi_boundary_link *link;
    tobi_boundary_entry *entry;
} look;

/* Hidden if it lies behind the tangent plane of the nearest point and the body is in the way, which is not
   when both ends of the line of sight lie above all of the body. */
static int is_hidden(const look *l, const tobi_facing_points *q, int k)
{
    const tobi_boundary_entry *e = l->entry;
    const tobi_boundary_point *p = tobi_facing_point(q, k);
    const double d = l->s->smoothing.spacing;
    double to[3], from_foot[3];
    if (p->outermost && q->height[k] > LIFT*d) return 0;
    for (int a = 0; a < 3; a++) {
        to[a] = p->at[a] + LIFT*d*p->normal[a];
        from_foot[a] = to[a] - e->foot[a];
    }
    return dot(from_foot, e->foot_normal) < -0.25*d && tobi_bvh_segment_hits(l->view.body->bvh, l->x, to);
}

static void drop_hidden(const look *l, tobi_facing_points *q)
{
    int kept = 0;
    for (int k = 0; k < q->count; k++) {
        if (is_hidden(l, q, k)) continue;
        q->index[kept] = q->index[k];
        q->square[kept] = q->square[k];
        q->height[kept++] = q->height[k];
    }
    q->count = kept;
}

static void add_points(void *user, tobi_facing_points *q)
{
    const look *l = user;
    const tobi_smoothing_constants *c = &l->s->smoothing;
    drop_hidden(l, q);
    tobi_facing_weigh(q, c);
    for (int k = 0; k < q->count; k++) q->weight[k] = c->plane_scale*q->weight[k];
    sph_of(l->s)->links.loops->sum(&l->view, q, l->link, l->entry);
}

/* The nearest place of the body; 0 if it is far. */
static int find_foot(const look *l)
{
    tobi_boundary_entry *e = l->entry;
    tobi_bvh_hit hit;
    if (!tobi_bvh_closest(l->view.body->bvh, l->x, 1.1*l->s->smoothing.h, &hit)) return 0;
    e->distance = hit.signed_distance;
    e->triangle = hit.triangle;
    memcpy(e->barycentric, hit.barycentric, sizeof e->barycentric);
    for (int a = 0; a < 3; a++) e->offset[a] = l->x[a] - hit.point[a];
    memcpy(e->foot, hit.point, sizeof e->foot);
    memcpy(e->foot_normal, hit.normal, sizeof e->foot_normal);
    return 1;
}

void tobi_boundary_look(const tobi_system *s, int32_t i, int body, int alone, tobi_boundary_link *link,
                        tobi_boundary_entry *entry)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    const tobi_double3 at = s->particles.position[i];
    look l;
    l.s = s;
    l.view.body = &s->sim->bodies[body];
    l.view.smoothing = &s->smoothing;
    l.view.alone = alone;
    memcpy(l.x, &at, sizeof l.x);
    l.link = link;
    l.entry = entry;
    memset(entry, 0, sizeof *entry);
    *link = (tobi_boundary_link){.particle = i, .body = (int16_t)body};
    entry->triangle = -1;
    entry->distance = s->smoothing.h;
    link->distance = (float)s->smoothing.h;
    if (!find_foot(&l)) return;
    link->distance = (float)fabs(entry->distance);
    sph_gravity_at(s, l.x, s->particles.fluid[i], l.view.gravity);
    sph_scalars_add_lift(s, i, l.view.gravity);
    tobi_boundary_take_facing(n, body, l.x, s->smoothing.h, add_points, &l);
    entry->share = fmin(entry->share, 0.98);
}

/* Further planes of a particle in a concave corner of one body: of the nearest points of the surface whose
   faces turn away from that of the closest point, and rise before it (decision 82 in docs/decisions).
   Without them a tank that is one mesh has open corners. Drawback: a walk over the points near the particle
   for each face. */
#include "sph/isph/corners.h"
#include "sph/isph/bodies.h"
#include "sph/state.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

/* Cosine of the angle between the normals of points of one face, at least. */
static const double ONE_FACE = 0.7;
/* Spacings that either of two faces must rise before the other: less is what a mesh of flat facets has. */
static const double RISE = 0.1;

/* A face that the particle stands before. */
typedef struct corner_face {
    int32_t point;                   /* nearest; -1: that of the closest point of the surface       */
    double place[3], normal[3];      /* of a point of the face                                      */
    double sum[3];                   /* m2/m3: sum of area W n over its points                      */
    double share;                    /* 1: sum of area W lambda/sigma over them and their images    */
} corner_face;

/* A particle's look for faces, the closest first. */
typedef struct corner_look {
    const tobi_system *s;
    const tobi_body *b;
    double x[3];
    corner_face face[1 + ISPH_CORNER_FACES];
    int faces;
    double nearest;                  /* m2, of the next face's point                                */
    int32_t next;                    /* that point, -1: there is none                               */
} corner_look;

/* Whether a point is of a face that makes a concave corner with this one. */
static int meets(const corner_look *l, const corner_face *f, int32_t k)
{
    const double least = RISE*l->s->smoothing.spacing, *n = l->b->normal[k];
    double apart[3];
    vec3_sub(apart, l->b->point[k], f->place);
    return vec3_dot(f->normal, n) <= ISPH_TWO_FACES && vec3_dot(apart, f->normal) >= least &&
           -vec3_dot(apart, n) >= least;
}

static int meets_all(const corner_look *l, int32_t k)
{
    for (int f = 0; f < l->faces; f++)
        if (!meets(l, &l->face[f], k)) return 0;
    return 1;
}

static void find_next(void *user, tobi_facing_points *q)
{
    corner_look *l = user;
    for (int i = 0; i < q->count; i++) {
        const int32_t k = tobi_facing_point(q, i)->number;
        if (q->square[i] >= l->nearest || !meets_all(l, k)) continue;
        l->nearest = q->square[i];
        l->next = k;
    }
}

/* Mirrors a place of face f in another face, along f. */
static void mirror_along(const corner_face *f, const corner_face *other, double place[3])
{
    const double turn = vec3_dot(other->normal, f->normal), size2 = 1 - turn*turn;
    double along[3], apart[3];
    memcpy(along, other->normal, sizeof along);
    vec3_add_scaled(along, along, -turn, f->normal);
    vec3_sub(apart, place, other->place);
    vec3_add_scaled(place, place, -2*vec3_dot(apart, other->normal)/size2, along);
}

/* Sum of W of a point of face f and of its images in the other faces: behind them the body goes on. */
static double weigh_point(const corner_look *l, int f, int32_t k)
{
    const tobi_smoothing_constants *c = &l->s->smoothing;
    double sum = 0;
    for (int images = 0; images < 1 << l->faces; images++) {
        double place[3], r[3];
        if (images >> f & 1) continue;
        memcpy(place, l->b->point[k], sizeof place);
        for (int g = 0; g < l->faces; g++)
            if (images >> g & 1) mirror_along(&l->face[f], &l->face[g], place);
        for (int a = 0; a < 3; a++) r[a] = a < c->dimension ? l->x[a] - place[a] : 0;
        sum += tobi_smoothing_w(c->shape, c->dimension, c->h, sqrt(vec3_dot(r, r)));
    }
    return sum;
}

static void add_point(corner_look *l, const tobi_boundary_point *p, double height, double weight)
{
    const tobi_smoothing_constants *c = &l->s->smoothing;
    const double w = p->area*c->plane_scale*weight;
    const double at = height/c->h*TOBI_PLANE_SAMPLES, sigma = tobi_wall_table_at(c->plane.sigma, at);
    for (int f = 0; f < l->faces; f++) {
        if (vec3_dot(p->normal, l->face[f].normal) < ONE_FACE) continue;
        for (int a = 0; a < 3; a++) l->face[f].sum[a] += w*p->normal[a];
        l->face[f].share += sigma > 0 ? p->area*c->plane_scale*weigh_point(l, f, p->number)*
                                        tobi_wall_table_at(c->plane.lambda, at)/sigma : 0;
    }
}

static void add_points(void *user, tobi_facing_points *q)
{
    corner_look *l = user;
    tobi_facing_weigh(q, &l->s->smoothing);
    for (int i = 0; i < q->count; i++) add_point(l, tobi_facing_point(q, i), q->height[i], q->weight[i]);
}

/* The next face, unless the body is in the way. */
static int look_for_face(corner_look *l, int body)
{
    double ahead[3];
    l->nearest = INFINITY;
    l->next = -1;
    tobi_boundary_take_facing(&sph_of(l->s)->links, body, l->x, l->s->smoothing.h, find_next, l);
    if (l->next < 0) return 0;
    corner_face *f = &l->face[l->faces];
    *f = (corner_face){ .point = l->next };
    memcpy(f->place, l->b->point[l->next], sizeof f->place);
    memcpy(f->normal, l->b->normal[l->next], sizeof f->normal);
    vec3_add_scaled(ahead, f->place, 1e-3*l->s->smoothing.spacing, f->normal);
    if (tobi_bvh_segment_hits(l->b->bvh, l->x, ahead)) return 0;
    l->faces++;
    return 1;
}

/* As of the first mirror: its change is that of the body and of the flow of a swimmer. */
static void set_velocities(const corner_look *l, const corner_face *f, isph_mirror *out)
{
    const tobi_body *b = l->b;
    double place[3], before[3] = { 0 };
    vec3_sub(place, l->x, out->offset);
    if (b->rigid.kind != TOBI_PRESCRIBED) tobi_body_carry(b, place, b->rigid.before, before);
    for (int a = 0; a < 3; a++) {
        out->velocity[a] = b->point_velocity[f->point][a];
        if (b->swimmer || b->motion) before[a] += b->point_before[f->point][a];
        out->velocity_change[a] = out->velocity[a] - before[a];
    }
}

/* The plane of a face; 0: it is out of reach. */
static int make_plane(const corner_look *l, const corner_face *f, int body, isph_mirror *out)
{
    const tobi_smoothing_constants *c = &l->s->smoothing;
    double from[3];
    *out = (isph_mirror){ .body = body };
    memcpy(out->normal, f->sum, sizeof out->normal);
    vec3_normalize(out->normal);
    vec3_sub(from, l->x, f->place);
    const double distance = vec3_dot(from, out->normal);
    if (!(distance > 0)) return 0;
    const double lambda = tobi_wall_table_at(c->plane.lambda, distance/c->h*TOBI_PLANE_SAMPLES);
    if (!(lambda > 1e-6)) return 0;
    out->share = fmin(f->share/lambda, 1);
    for (int a = 0; a < 3; a++) out->offset[a] = distance*out->normal[a];
    set_velocities(l, f, out);
    return 1;
}

int isph_corner_find(const tobi_system *s, const tobi_boundary_link *link, const tobi_boundary_entry *e,
                     isph_mirror *first, isph_mirror more[ISPH_CORNER_FACES])
{
    const tobi_double3 *at = &s->particles.position[link->particle];
    const int most = s->box.dimension;
    corner_look l = { .s = s, .b = &s->sim->bodies[link->body], .x = { at->x, at->y, at->z }, .faces = 1 };
    int found = 0;
    if (l.b->convex || e->triangle < 0 || !(e->distance > 0)) return 0;
    l.face[0].point = -1;
    memcpy(l.face[0].place, e->foot, sizeof e->foot);
    for (int a = 0; a < 3; a++) l.face[0].normal[a] = e->offset[a]/e->distance;
    while (l.faces < most && look_for_face(&l, link->body)) { }
    if (l.faces == 1) return 0;
    tobi_boundary_take_facing(&sph_of(s)->links, link->body, l.x, s->smoothing.h, add_points, &l);
    for (int f = 1; f < l.faces; f++) found += make_plane(&l, &l.face[f], link->body, &more[found]);
    if (found > 0 && vec3_dot(l.face[0].sum, l.face[0].sum) > 0) {   /* its normal is of its own face alone */
        memcpy(first->normal, l.face[0].sum, sizeof first->normal);
        vec3_normalize(first->normal);
    }
    return found;
}

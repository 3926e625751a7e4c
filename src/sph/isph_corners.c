/* The second plane of a particle in a concave corner of one body: the nearest point of the surface whose face
   turns away from that of the closest point and rises before it (docs/decisions/0082-concave-corners.md).
   Without it a tank that is one mesh has an open corner. Drawback: two planes at most, and a corner in 3-D
   has three. */
#include "sph/isph_corners.h"
#include "sph/isph_bodies.h"
#include "sph/state.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

/* Cosine of the angle between the normals of points of one face, at least. */
static const double ONE_FACE = 0.7;
/* Spacings that either face must rise before the other: less is what a mesh of flat facets has. */
static const double RISE = 0.1;

/* A particle's look for a second face, and what the points of both are together. */
typedef struct corner_look {
    const tobi_system *s;
    const tobi_body *b;
    double x[3], foot[3], normal[3];
    double nearest;                  /* m2, of the point of the second face                         */
    int32_t point;                   /* -1: there is none                                           */
    double first[3], second[3];      /* m2/m3: sum of area W n of either face                       */
    double share;                    /* 1: sum of area W lambda/sigma of the second                 */
} corner_look;

/* Whether a point faces the particle within reach. r: from it to the particle. */
static int faces(const corner_look *l, int32_t k, double r[3])
{
    const double h = l->s->smoothing.h;
    for (int a = 0; a < 3; a++) r[a] = a < l->s->box.dimension ? l->x[a] - l->b->point[k][a] : 0;
    return l->b->area[k] > 0 && vec3_dot(r, r) < h*h && vec3_dot(r, l->b->normal[k]) > 0;
}

static int find_second(void *user, int32_t k)
{
    corner_look *l = user;
    double r[3], apart[3];
    if (!faces(l, k, r) || vec3_dot(l->normal, l->b->normal[k]) > ISPH_TWO_FACES) return 0;
    for (int a = 0; a < 3; a++) apart[a] = l->b->point[k][a] - l->foot[a];
    const double least = RISE*l->s->smoothing.spacing, r2 = vec3_dot(r, r);
    if (r2 >= l->nearest || vec3_dot(apart, l->normal) < least || -vec3_dot(apart, l->b->normal[k]) < least)
        return 0;
    l->nearest = r2;
    l->point = k;
    return 0;
}

static int add_face(void *user, int32_t k)
{
    corner_look *l = user;
    const tobi_smoothing_constants *c = &l->s->smoothing;
    const double *n = l->b->normal[k];
    double r[3];
    if (!faces(l, k, r)) return 0;
    const double w = l->b->area[k]*c->plane_scale*
                     tobi_smoothing_w(c->shape, c->dimension, c->h, sqrt(vec3_dot(r, r)));
    if (vec3_dot(n, l->normal) > ISPH_TWO_FACES)
        for (int a = 0; a < 3; a++) l->first[a] += w*n[a];
    if (vec3_dot(n, l->b->normal[l->point]) < ONE_FACE) return 0;
    const double at = vec3_dot(r, n)/c->h*TOBI_PLANE_SAMPLES, sigma = tobi_wall_table_at(c->plane.sigma, at);
    for (int a = 0; a < 3; a++) l->second[a] += w*n[a];
    l->share += sigma > 0 ? w*tobi_wall_table_at(c->plane.lambda, at)/sigma : 0;
    return 0;
}

/* As of the first mirror: its change is that of the body and of the flow of a swimmer. */
static void set_velocities(const corner_look *l, isph_mirror *out)
{
    const tobi_body *b = l->b;
    double place[3], before[3] = { 0 };
    for (int a = 0; a < 3; a++) place[a] = l->x[a] - out->offset[a];
    if (b->rigid.kind != TOBI_PRESCRIBED) isph_body_velocity(b, place, b->rigid.before, before);
    for (int a = 0; a < 3; a++) {
        out->velocity[a] = b->point_velocity[l->point][a];
        if (b->swimmer || b->motion) before[a] += b->point_before[l->point][a];
        out->velocity_change[a] = out->velocity[a] - before[a];
    }
}

int isph_corner_find(const tobi_system *s, const tobi_boundary_link *link, const tobi_boundary_entry *e,
                     isph_mirror *first, isph_mirror *out)
{
    const tobi_smoothing_constants *c = &s->smoothing;
    const tobi_double3 *at = &s->particles.position[link->particle];
    corner_look l = { .s = s, .b = &s->sim->bodies[link->body], .x = { at->x, at->y, at->z },
                      .nearest = INFINITY, .point = -1 };
    double ahead[3];
    if (l.b->convex || e->triangle < 0 || !(e->distance > 0)) return 0;
    memcpy(l.foot, e->foot, sizeof l.foot);
    for (int a = 0; a < 3; a++) l.normal[a] = e->offset[a]/e->distance;
    tobi_boundary_visit(&sph_of(s)->links, link->body, l.x, find_second, &l);
    if (l.point < 0) return 0;
    for (int a = 0; a < 3; a++)
        ahead[a] = l.b->point[l.point][a] + 1e-3*c->spacing*l.b->normal[l.point][a];
    if (tobi_bvh_segment_hits(l.b->bvh, l.x, ahead)) return 0;
    tobi_boundary_visit(&sph_of(s)->links, link->body, l.x, add_face, &l);
    vec3_normalize(l.second);
    *out = (isph_mirror){ .body = link->body, .previous = link->previous };
    double distance = 0;
    for (int a = 0; a < 3; a++) distance += (l.x[a] - l.b->point[l.point][a])*l.second[a];
    if (!(distance > 0)) return 0;
    const double lambda = tobi_wall_table_at(c->plane.lambda, distance/c->h*TOBI_PLANE_SAMPLES);
    if (!(lambda > 1e-6)) return 0;
    out->share = fmin(l.share/lambda, 1);
    for (int a = 0; a < 3; a++) {
        out->normal[a] = l.second[a];
        out->offset[a] = distance*l.second[a];
    }
    set_velocities(&l, out);
    if (vec3_dot(l.first, l.first) > 0) {          /* the first normal is of its own face alone */
        vec3_normalize(l.first);
        memcpy(first->normal, l.first, sizeof first->normal);
    }
    return 1;
}

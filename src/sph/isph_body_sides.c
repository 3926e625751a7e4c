/* How much of the half space behind a particle's plane is body, where a side of the domain cuts the body. Its
   points end at the side, though water and body both go on behind it as mirrors. Without their images a post
   on a floor has open corners (decision 88 in docs/decisions). Drawback: a second walk over the points near
   a particle, beside sides only; it does not ask what hides them. */
#include "sph/isph_body_sides.h"
#include "sph/state.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

isph_body_sides isph_body_sides_near(const tobi_system *s, const double x[3])
{
    const double h = s->smoothing.h;
    isph_body_sides l = { .images = 1 };             /* the first: nothing is mirrored */
    for (int a = 0; a < s->box.dimension; a++) {
        const int before = l.images;
        for (int upper = 0; upper < 2 && !s->box.periodic[a]; upper++) {
            const double wall = upper ? s->box.size[a] : 0;
            if (fabs(x[a] - wall) >= h) continue;
            for (int k = 0; k < before; k++) {
                memcpy(l.wall[l.images], l.wall[k], sizeof l.wall[k]);
                memcpy(l.mirrored[l.images], l.mirrored[k], sizeof l.mirrored[k]);
                l.wall[l.images][a] = wall;
                l.mirrored[l.images++][a] = 1;
            }
        }
    }
    l.images--;
    memmove(l.wall, l.wall + 1, (size_t)l.images*sizeof *l.wall);
    memmove(l.mirrored, l.mirrored + 1, (size_t)l.images*sizeof *l.mirrored);
    return l;
}

void isph_body_sides_mirror(const isph_body_sides *sides, int image, double place[3])
{
    for (int a = 0; a < 3; a++)
        if (sides->mirrored[image][a]) place[a] = 2*sides->wall[image][a] - place[a];
}

typedef struct summing {
    const tobi_system *s;
    const tobi_body *b;
    double x[3];
    isph_body_sides sides;
    double share, height;
} summing;

static int add_point(void *user, int32_t k)
{
    summing *q = user;
    const tobi_smoothing_constants *c = &q->s->smoothing;
    const double *n = q->b->normal[k];
    double r[3];
    for (int a = 0; a < 3; a++) r[a] = a < c->dimension ? q->x[a] - q->b->point[k][a] : 0;
    if (!(q->b->area[k] > 0) || !(vec3_dot(r, n) > 0)) return 0;
    for (int image = 0; image < q->sides.images; image++) {
        double place[3], height = 0;
        memcpy(place, q->b->point[k], sizeof place);
        isph_body_sides_mirror(&q->sides, image, place);
        for (int a = 0; a < 3; a++) {
            r[a] = a < c->dimension ? q->x[a] - place[a] : 0;
            height += (q->sides.mirrored[image][a] ? -1 : 1)*r[a]*n[a];
        }
        const double square = vec3_dot(r, r);
        if (square >= c->h*c->h || !(height > 0)) continue;
        const double at = height/c->h*TOBI_PLANE_SAMPLES, sigma = tobi_wall_table_at(c->plane.sigma, at);
        if (!(sigma > 0)) continue;
        const double aw = q->b->area[k]*c->plane_scale*
                          tobi_smoothing_w(c->shape, c->dimension, c->h, sqrt(square));
        q->share += aw*tobi_wall_table_at(c->plane.lambda, at)/sigma;
        q->height += aw*height;
    }
    return 0;
}

void isph_body_sides_add(const tobi_system *s, const tobi_boundary_link *link, double *share, double *height)
{
    const tobi_double3 *at = &s->particles.position[link->particle];
    summing q = { .s = s, .b = &s->sim->bodies[link->body], .x = { at->x, at->y, at->z } };
    q.sides = isph_body_sides_near(s, q.x);
    if (q.sides.images > 0) tobi_boundary_visit(&sph_of(s)->links, link->body, q.x, add_point, &q);
    *share += q.share;
    *height += q.height;
}

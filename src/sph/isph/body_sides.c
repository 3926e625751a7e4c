/* How much of the half space behind a particle's plane is body, where a side of the domain cuts the body. Its
   points end at the side, though water and body both go on behind it as mirrors. Without their images a post
   on a floor has open corners (decision 88 in docs/decisions). Drawback: a second walk over the points near
   a particle, beside sides only; it does not ask what hides them. */
#include "sph/isph/body_sides.h"
#include "sph/isph/images.k.h"
#include "sph/state.h"
#include "geom/vec3.h"
#include <math.h>

typedef struct summing {
    const isph_view *v;
    const tobi_smoothing_constants *c;
    const tobi_body *b;
    double x[3];                                     /* m, of the particle */
    isph_reflections sides;
    tobi_boundary_entry *entry;
} summing;

/* From the image of a point in these sides to the particle, m; its height above the plane of the image. */
static double measure_image(const summing *q, int32_t k, const int side[3], double r[3])
{
    double height = 0;
    for (int a = 0; a < 3; a++) {
        const double at = q->b->point[k][a], wall = side[a] == 1 ? q->v->size[a] : 0;
        r[a] = a < q->c->dimension ? q->x[a] - (side[a] < 0 ? at : 2*wall - at) : 0;
        height += (side[a] < 0 ? 1 : -1)*r[a]*q->b->normal[k][a];
    }
    return height;
}

static int add_point(void *user, int32_t k)
{
    const summing *q = user;
    const tobi_smoothing_constants *c = q->c;
    const int itself[3] = { -1, -1, -1 };
    double r[3];
    if (!(q->b->area[k] > 0) || !(measure_image(q, k, itself, r) > 0)) return 0;
    for (int m = 1; m < q->sides.total; m++) {       /* 0 is itself */
        int side[3];
        isph_choose_sides(&q->sides, m, side);
        const double height = measure_image(q, k, side, r), square = vec3_dot(r, r),
                     at = fmax(height, 0)/c->h*TOBI_PLANE_SAMPLES,
                     sigma = tobi_wall_table_at(c->plane.sigma, at);
        if (square >= c->h*c->h || !(height > 0) || !(sigma > 0)) continue;
        const double aw = q->b->area[k]*c->plane_scale*
                          tobi_smoothing_w(c->shape, c->dimension, c->h, sqrt(square));
        q->entry->steady += aw*tobi_wall_table_at(c->plane.lambda, at)/sigma*
                            tobi_boundary_rise(height, q->entry->distance, c->spacing);
        q->entry->height += aw*height;
    }
    return 0;
}

void isph_body_sides_add(const isph_view *v, const tobi_system *s, const tobi_boundary_link *link,
                         tobi_boundary_entry *e)
{
    const tobi_double3 *at = &s->particles.position[link->particle];
    summing q = { .v = v, .c = &s->smoothing, .b = &s->sim->bodies[link->body], .x = { at->x, at->y, at->z },
                  .sides = isph_find_reflections(v, link->particle), .entry = e };
    if (q.sides.total > 1) tobi_boundary_visit(&sph_of(s)->links, link->body, q.x, add_point, &q);
}

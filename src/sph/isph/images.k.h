/* Mirror images of pairs at the sides of the domain. All pairs of a particle of one reflection go together.
   The image of a pair is as far from either particle, so that sums over images stay symmetric, and never
   nearer than the pair itself, so that the neighbour list holds all that can have one. */
#pragma once
#include "sph/isph/view.h"

enum { ISPH_PLAIN, ISPH_SIDE, ISPH_BODY };

/* What eight pairs are images of. */
typedef struct isph_image {
    int64_t k;                       /* entry of the first pair in the list; -1: of i and itself    */
    lane sign[3];                    /* of velocities: -1 along mirrored axes                       */
    lane displacement[3];            /* m, from j to its image                                      */
    float gravity[3];                /* m/s2, that i feels at rest                                  */
    /* bodies only */
    int32_t index[8];                /* of each neighbour                                           */
    int64_t entry[8];                /* of each pair, in place of k                                 */
    lane weight;                     /* 1; less at edges                                            */
    lane normal[3];
    lane normal_velocity, velocity_change;     /* m/s: of the surface along the normal; its change  */
    int corners;                     /* 1: some are images in several planes, for which             */
    lane corner_velocity[3], corner_change[3]; /* m/s: twice the velocity of those planes; its change */
} isph_image;

/* Gravity and what acts besides on particle i at rest, m/s2. */
TOBI_FN void isph_gravity_at(const isph_view *v, int64_t i, float g[3])
{
    double more[3];
    for (int a = 0; a < 3; a++) g[a] = v->gravity[a];
    if (v->lift.acts) tobi_scalar_add_lift(&v->lift, v->scalars[i], g);
    if (!v->acceleration.acts) return;
    tobi_acceleration_at(&v->acceleration, &v->position[i].x, more);
    if (v->lift.acts) tobi_scalar_add_share(&v->lift, v->scalars[i], more, g);
    for (int a = 0; a < v->dimension; a++) g[a] += (float)more[a];
}

/* V F over slope: V grad W = -V F x_ij. 0 out of reach. */
TOBI_FN lane isph_falloff(const isph_view *v, const tobi_neighbors *n, const isph_image *m, const int shape,
                          const int kind)
{
    const lane r = lane_sqrt(n->r2), f = smoothing_falloff(shape, r*v->inverse_h, r);
    return kind == ISPH_BODY ? f*m->weight : f;
}

/* V W over weight. */
TOBI_FN lane isph_weight(const isph_view *v, const tobi_neighbors *n, const isph_image *m, const int shape,
                         const int kind)
{
    const lane w = smoothing_shape(shape, lane_sqrt(n->r2)*v->inverse_h);
    return kind == ISPH_BODY ? w*m->weight : w;
}

/* Velocities of j or of its image; walls do not mirror what gravity gave in this step. */
TOBI_FN void isph_velocity(const isph_view *v, const tobi_neighbors *n, const isph_image *m, const int kind,
                           lane u[3])
{
    lane w, across = lane_set(0);
    lane_load_float4(v->velocity, n->j, &u[0], &u[1], &u[2], &w);
    if (kind == ISPH_PLAIN) return;
    for (int a = 0; a < 3; a++) u[a] = m->sign[a]*u[a] + (1.0f - m->sign[a])*(v->gravity_dt*m->gravity[a]);
    if (kind == ISPH_SIDE) return;
    for (int a = 0; a < 3; a++) across += 2*(u[a] - v->gravity_dt*m->gravity[a])*m->normal[a];
    across -= 2*(m->normal_velocity - (v->gravity_dt > 0 ? m->velocity_change : lane_set(0)));
    for (int a = 0; a < 3; a++) u[a] -= across*m->normal[a];
    if (!m->corners) return;
    for (int a = 0; a < 3; a++)
        u[a] += m->corner_velocity[a] - (v->gravity_dt > 0 ? 2*m->corner_change[a] : lane_set(0));
}

/* Pa: pressure of the image less that of j, as of liquid at rest, eq. (7). */
TOBI_FN lane isph_pressure_difference(const isph_view *v, const isph_image *m, const int kind)
{
    if (kind == ISPH_PLAIN) return lane_set(0);
    const lane *d = m->displacement, *n = m->normal;
    const lane still = (float)v->density*(m->gravity[0]*d[0] + m->gravity[1]*d[1] + m->gravity[2]*d[2]);
    if (kind == ISPH_SIDE) return still;
    const lane single = still -
                        (float)(v->density/v->dt)*m->velocity_change*(n[0]*d[0] + n[1]*d[1] + n[2]*d[2]);
    if (!m->corners) return single;
    const lane *c = m->corner_change;
    return single - (float)(v->density/v->dt)*(c[0]*d[0] + c[1]*d[1] + c[2]*d[2]);
}

/* m2, out of reach of every kernel. */
TOBI_FN lane isph_far(const isph_view *v) { return lane_set(4*(float)(v->h*v->h)); }

TOBI_FN lane isph_square(const tobi_neighbors *n) { return n->dx*n->dx + n->dy*n->dy + n->dz*n->dz; }

/* Eight neighbours; those that are i itself, which pad the list, are out of reach. */
TOBI_FN void isph_load(const isph_view *v, int64_t i, const int32_t *j, tobi_neighbors *n)
{
    const tobi_record own = v->record[i];
    lane_int x, y, z;
    n->j = j;
    n->index = lane_load_index(j);
    lane_load_record(v->record, j, &x, &y, &z, &n->w);
    n->dx = lane_from_int(lane_sub_wrap(own.x, x))*v->from_fixed[0];
    n->dy = lane_from_int(lane_sub_wrap(own.y, y))*v->from_fixed[1];
    n->dz = lane_from_int(lane_sub_wrap(own.z, z))*v->from_fixed[2];
    n->r2 = lane_where_equal(n->index, lane_set_int((int32_t)i), isph_far(v), isph_square(n));
}

/* Reflections that i may see: side[a] of axis a has -1 for none, 0 and 1 for its lower and upper side. */
typedef struct isph_reflections { int side[3][3], count[3], total; } isph_reflections;

TOBI_FN isph_reflections isph_find_reflections(const isph_view *v, int64_t i)
{
    isph_reflections f;
    for (int a = 0; a < 3; a++) {
        const double x = (&v->position[i].x)[a];
        f.count[a] = 1;
        f.side[a][0] = -1;
        if (v->periodic[a] || a >= v->dimension) continue;
        if (x < v->h) f.side[a][f.count[a]++] = 0;
        if (v->size[a] - x < v->h) f.side[a][f.count[a]++] = 1;
    }
    f.total = f.count[0]*f.count[1]*f.count[2];
    return f;
}

/* Sides of reflection m. */
TOBI_FN void isph_choose_sides(const isph_reflections *f, int m, int side[3])
{
    side[0] = f->side[0][m%f->count[0]];
    side[1] = f->side[1][m/f->count[0]%f->count[1]];
    side[2] = f->side[2][m/(f->count[0]*f->count[1])];
}

/* The pairs as the sides mirror them: by the sum of both distances from a side, so that i sees j as j sees i.
   Of a group of i itself (k < 0) the first counts. */
TOBI_FN void isph_reflect(const isph_view *v, int64_t i, const int side[3], tobi_neighbors *n, isph_image *m)
{
    static const int32_t first[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    const int32_t *own = &v->record[i].x;
    lane_int at[3];
    lane w, x[3] = {n->dx, n->dy, n->dz};
    lane_load_record(v->record, n->j, &at[0], &at[1], &at[2], &w);
    for (int a = 0; a < 3; a++) {
        m->sign[a] = lane_set(1);
        m->displacement[a] = lane_set(0);
        if (side[a] < 0) continue;
        const int32_t wall = v->side[side[a]][a];
        const lane both = lane_from_int(lane_sub_wrap(wall, at[a])) + (float)(wall - own[a]),
                   image = -both*v->from_fixed[a];
        m->sign[a] = lane_set(-1);
        m->displacement[a] = x[a] - image;
        x[a] = image;
    }
    n->dx = x[0]; n->dy = x[1]; n->dz = x[2];
    n->r2 = m->k < 0 ? lane_where_equal(lane_load_index(first), lane_set_int(0), isph_square(n), isph_far(v))
                     : lane_where_equal(n->index, lane_set_int((int32_t)i), isph_far(v), isph_square(n));
}

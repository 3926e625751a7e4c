/* What a particle of isph sees: its neighbours, and the mirror images of them and of itself at the sides of
   the domain and at bodies. The image of a pair is as far from either particle, so that sums over images stay
   symmetric, and never nearer than the pair itself, so that the neighbour list holds all that can have one.
   At a body a pair has one mirror plane, the mean of those at the points of the surface that are closest to
   either: exact at flat faces, rounded at edges. Images at two bodies at once are left out. */
#pragma once
#include "core/smoothing.h"
#include "core/smoothing.k.h"
#include "exec/portable.h"
#include <math.h>

/* Symmetric. */
typedef struct isph_tensor { float xx, yy, zz, xy, yz, zx; } isph_tensor;

/* The plane in which a particle sees a body. */
typedef struct isph_mirror {
    int32_t body, previous;          /* previous: the particle's plane for an earlier body, -1 = none */
    double offset[3];                /* m, from the closest point of the surface to the particle    */
    double normal[3], velocity[3];   /* 1, m/s, of the surface there                                */
    double share;                    /* 1: how much of the half space behind is body, 0 to 1        */
} isph_mirror;

enum { ISPH_BODIES = 4 };            /* that a pair sees at once                                    */

typedef struct isph_view {
    int64_t count;
    int dimension, shape;            /* shape: TOBI_SHAPE_*                                         */
    int open;                        /* 1: there may be a free surface                              */
    double spacing, h, volume;       /* m, m, m3                                                    */
    double weight, slope;            /* core/smoothing.h                                            */
    double full;                     /* 1/m2: the sum of a row of the Laplacian on the lattice      */
    double size[3];                  /* m                                                           */
    int periodic[3];
    double gravity[3];               /* m/s2                                                        */
    double density;                  /* kg/m3                                                       */
    double dt, motion_dt;            /* s; motion_dt: the step that motion alone allows             */
    double volume_gain, shifting;    /* parameters                                                  */
    /* particle arrays */
    const tobi_double3 *position;
    tobi_float4 *velocity, *accel;
    float *pressure;
    const int32_t *list;
    const uint32_t *list_start;
    const uint16_t *list_groups;
    const int32_t *near;             /* last mirror of each particle, < 0: none; NULL: no bodies    */
    const isph_mirror *mirror;
    float *behind;                   /* 1: share of the kernel in and behind bodies                 */
    /* the method's own: geometry, eq. (2) to (5) */
    isph_tensor *inverse;            /* 1: B                                                        */
    float *trace;                    /* 1: tr M                                                     */
    float *gate;                     /* 1: gamma, 0 in the bulk, 1 at a free surface                */
    float *scale;                    /* 1: kappa                                                    */
    float *filled;                   /* 1: kernel sum, 1 on the lattice                             */
    tobi_float4 *lack;               /* 1/m: sum of V grad W                                        */
    /* the matrix */
    float *entry;                    /* 1/m2: a of each entry of the list                           */
    double *excess, *inverse_diagonal;     /* 1/m2, m2                                              */
    double *source;                  /* Pa/m2                                                       */
    const double *in;                /* of the product at hand                                      */
    double *out;
    tobi_double3 *change;            /* m/s: of the velocity, with the shift                        */
} isph_view;

/* A neighbour, or an image of it. */
typedef struct isph_pair {
    int64_t j, k;                    /* k: where in the list; -1: an image of the particle itself   */
    double x[3], r2;                 /* m, x_i - x_j; m2                                            */
    double away[3];                  /* m, from j to its image                                      */
    double weight;                   /* 1; less at the edges of bodies                              */
    int image;                       /* 1: it is one                                                */
    int mirrored;                    /* bit a: at a side, the velocity along a changes its sign     */
    int body;                        /* -1: none                                                    */
    double normal[3], velocity[3];   /* 1, m/s, of the body's mirror                                */
} isph_pair;

/* The mirror of a pair at one body. */
typedef struct isph_plane {
    int body;
    double normal[3], velocity[3];
    double sum[3];                   /* m, of the offsets of both particles                         */
    double weight;
} isph_plane;

typedef struct isph_walk {
    const isph_view *v;
    int64_t i, j, k, end;
    double own[3];
    double offset[3][3];             /* per axis: to j, and to its images                           */
    int count[3], sides, at, total;  /* sides: images at sides, j included                          */
    int planes;
    isph_plane plane[ISPH_BODIES];
    isph_pair pair;
} isph_walk;

static inline const double *isph_place(const isph_view *v, int64_t i) { return &v->position[i].x; }

/* The images of j along one axis that may be near enough. */
static inline void isph_see_axis(isph_walk *w, const double *other, int a)
{
    const isph_view *v = w->v;
    double *to = w->offset[a], x = w->own[a] - other[a];
    w->count[a] = 1;
    if (v->periodic[a]) x -= v->size[a]*round(x/v->size[a]);
    to[0] = x;
    if (v->periodic[a] || a >= v->dimension) return;
    const double lower = w->own[a] + other[a], upper = lower - 2*v->size[a];
    if (lower < v->h) to[w->count[a]++] = lower;
    if (-upper < v->h) to[w->count[a]++] = upper;
}

/* Where both share of the body is below a half there is next to none between a particle and the image. */
static inline void isph_join(isph_walk *w, const isph_mirror *a, const isph_mirror *b)
{
    isph_plane *p = &w->plane[w->planes];
    const double both = a->share + b->share - 0.5;
    double size = 0;
    p->weight = both < 0 ? 0 : both < 1 ? both : 1;
    for (int c = 0; c < 3; c++) {
        p->normal[c] = a->normal[c] + b->normal[c];
        p->velocity[c] = 0.5*(a->velocity[c] + b->velocity[c]);
        p->sum[c] = a->offset[c] + b->offset[c];
        size += p->normal[c]*p->normal[c];
    }
    if (!(size > 1) || !(p->weight > 0)) return;     /* the surface turns by less than 120 degrees */
    for (int c = 0; c < 3; c++) p->normal[c] /= sqrt(size);
    p->body = a->body;
    w->planes++;
}

static inline void isph_see_bodies(isph_walk *w, int64_t j)
{
    const isph_view *v = w->v;
    for (int32_t a = v->near[w->i]; a >= 0; a = v->mirror[a].previous)
        for (int32_t b = v->near[j]; b >= 0; b = v->mirror[b].previous)
            if (v->mirror[a].body == v->mirror[b].body && w->planes < ISPH_BODIES)
                isph_join(w, &v->mirror[a], &v->mirror[b]);
}

static inline void isph_see(isph_walk *w, int64_t j)
{
    const double *other = isph_place(w->v, j);
    for (int a = 0; a < 3; a++) isph_see_axis(w, other, a);
    w->j = j;
    w->at = w->planes = 0;
    w->sides = w->total = w->count[0]*w->count[1]*w->count[2];
    if (!w->v->near || w->v->near[w->i] < 0 || w->v->near[j] < 0) return;
    isph_see_bodies(w, j);
    w->total *= 1 + w->planes;
}

static inline isph_walk isph_walk_begin(const isph_view *v, int64_t i)
{
    isph_walk w = {.v = v, .i = i, .k = 8*(int64_t)v->list_start[i]};
    w.end = w.k + 8*(int64_t)v->list_groups[i];
    for (int a = 0; a < 3; a++) w.own[a] = isph_place(v, i)[a];
    w.pair.k = -1;
    isph_see(&w, i);
    w.at = 1;                        /* its images, not itself */
    return w;
}

/* The image at sides, once more mirrored at a body: only where the two stand across one another. 1: there
   is one. Symmetric: r^2 + 4 s_i s_j with the distances of both from the plane. */
static inline int isph_reflect(const isph_walk *w, const isph_plane *b, isph_pair *p)
{
    double size = 0, own = 0, other = 0;
    for (int a = 0; a < 3; a++) {
        p->normal[a] = p->mirrored >> a & 1 ? 0 : b->normal[a];
        size += p->normal[a]*p->normal[a];
    }
    if (size < 0.9) return 0;
    for (int a = 0; a < 3; a++) {
        p->normal[a] /= sqrt(size);
        own += 0.5*(b->sum[a] + w->offset[a][0])*p->normal[a];
        other += 0.5*(b->sum[a] - w->offset[a][0])*p->normal[a];
    }
    if (!(own > 0) || !(other > 0)) return 0;
    for (int a = 0; a < 3; a++) {
        p->x[a] += 2*other*p->normal[a];
        p->velocity[a] = b->velocity[a];
    }
    p->body = b->body;
    p->weight = b->weight;
    return 1;
}

/* 1: w->pair is an image near enough. */
static inline int isph_take_image(isph_walk *w, int m)
{
    isph_pair *p = &w->pair;
    const int side = m%w->sides,
              at[3] = { side%w->count[0], side/w->count[0]%w->count[1], side/(w->count[0]*w->count[1]) };
    p->mirrored = 0;
    p->body = -1;
    p->weight = 1;
    for (int a = 0; a < 3; a++) {
        p->x[a] = w->offset[a][at[a]];
        p->mirrored |= (at[a] > 0) << a;
    }
    if (m >= w->sides && !isph_reflect(w, &w->plane[m/w->sides - 1], p)) return 0;
    p->r2 = p->x[0]*p->x[0] + p->x[1]*p->x[1] + p->x[2]*p->x[2];
    if (p->r2 >= w->v->h*w->v->h) return 0;
    p->j = w->j;
    p->image = m > 0;
    for (int a = 0; a < 3; a++) p->away[a] = w->offset[a][0] - p->x[a];
    return 1;
}

/* The next pair into w->pair; 0 at the end. Padding repeats the particle itself. */
static inline int isph_walk_next(isph_walk *w)
{
    for (;;) {
        while (w->at < w->total)
            if (isph_take_image(w, w->at++)) return 1;
        while (w->k < w->end && w->v->list[w->k] == w->i) w->k++;
        if (w->k == w->end) return 0;
        w->pair.k = w->k;
        isph_see(w, w->v->list[w->k++]);
    }
}

#define ISPH_PAIRS(v, i, p)                                                                         \
    for (isph_walk walk_ = isph_walk_begin(v, i); isph_walk_next(&walk_);)                          \
        for (const isph_pair *p = &walk_.pair; p; p = NULL)

/* V F: V grad W = -V F x_ij. */
static inline double isph_falloff(const isph_view *v, const isph_pair *p)
{
    const double r = sqrt(p->r2), t = 1 - r/v->h, u = 0.5 - r/v->h;
    if (v->shape == TOBI_SHAPE_WENDLAND) return p->weight*v->slope*t*t*t;
    return p->weight*v->slope*(t*t - (u > 0 ? 4*u*u : 0))/(r + 1e-20);
}

/* V W. */
static inline double isph_weight(const isph_view *v, const isph_pair *p)
{
    const double q = sqrt(p->r2)/v->h, t = 1 - q, u = 0.5 - q;
    if (v->shape == TOBI_SHAPE_WENDLAND) return p->weight*v->weight*t*t*t*t*(1 + 4*q);
    return p->weight*v->weight*(2*t*t*t - (u > 0 ? 8*u*u*u : 0));
}

/* Velocity of j or of its image; kick: what gravity gave in this step, which walls do not mirror. */
static inline void isph_velocity(const isph_view *v, const isph_pair *p, double kick, double u[3])
{
    const tobi_float4 *w = &v->velocity[p->j];
    double across = 0;
    u[0] = w->x; u[1] = w->y; u[2] = w->z;
    if (!p->image) return;
    for (int a = 0; a < 3; a++)
        if (p->mirrored >> a & 1) u[a] = 2*kick*v->gravity[a] - u[a];
    if (p->body < 0) return;
    for (int a = 0; a < 3; a++) across += 2*(u[a] - kick*v->gravity[a] - p->velocity[a])*p->normal[a];
    for (int a = 0; a < 3; a++) u[a] -= across*p->normal[a];
}

/* Pa: pressure of the image less that of j, as of liquid at rest, eq. (7). */
static inline double isph_lift(const isph_view *v, const isph_pair *p)
{
    double sum = 0;
    if (!p->image) return 0;
    for (int a = 0; a < v->dimension; a++) sum += v->gravity[a]*p->away[a];
    return v->density*sum;
}

static inline void isph_apply(const isph_tensor *t, const double x[3], double out[3])
{
    out[0] = t->xx*x[0] + t->xy*x[1] + t->zx*x[2];
    out[1] = t->xy*x[0] + t->yy*x[1] + t->yz*x[2];
    out[2] = t->zx*x[0] + t->yz*x[1] + t->zz*x[2];
}

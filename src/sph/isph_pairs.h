/* What a particle of isph sees: its neighbours, and the mirror images of them and of itself at the sides of
   the domain. The image of a pair is as far from either particle, so that sums over images stay symmetric,
   and never nearer than the pair itself, so that the neighbour list holds all that can have one. */
#pragma once
#include "core/smoothing.h"
#include "core/smoothing.k.h"
#include "exec/portable.h"
#include <math.h>

/* Symmetric. */
typedef struct isph_tensor { float xx, yy, zz, xy, yz, zx; } isph_tensor;

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
    int mirrored;                    /* bit a: the velocity along a changes its sign                */
} isph_pair;

typedef struct isph_walk {
    const isph_view *v;
    int64_t i, j, k, end;
    double own[3];
    double offset[3][3];             /* per axis: to j, and to its images                           */
    int count[3], at, total;
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

static inline void isph_see(isph_walk *w, int64_t j)
{
    const double *other = isph_place(w->v, j);
    for (int a = 0; a < 3; a++) isph_see_axis(w, other, a);
    w->j = j;
    w->at = 0;
    w->total = w->count[0]*w->count[1]*w->count[2];
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

/* 1: w->pair is an image near enough. */
static inline int isph_take_image(isph_walk *w, int m)
{
    isph_pair *p = &w->pair;
    const int at[3] = { m%w->count[0], m/w->count[0]%w->count[1], m/(w->count[0]*w->count[1]) };
    p->r2 = 0;
    for (int a = 0; a < 3; a++) {
        p->x[a] = w->offset[a][at[a]];
        p->r2 += p->x[a]*p->x[a];
    }
    if (p->r2 >= w->v->h*w->v->h) return 0;
    p->j = w->j;
    p->mirrored = 0;
    for (int a = 0; a < 3; a++) {
        p->away[a] = at[a] ? w->offset[a][0] - p->x[a] : 0;
        p->mirrored |= (at[a] > 0) << a;
    }
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
static inline double isph_falloff(const isph_view *v, double r2)
{
    const double r = sqrt(r2), t = 1 - r/v->h, u = 0.5 - r/v->h;
    if (v->shape == TOBI_SHAPE_WENDLAND) return v->slope*t*t*t;
    return v->slope*(t*t - (u > 0 ? 4*u*u : 0))/(r + 1e-20);
}

/* V W. */
static inline double isph_weight(const isph_view *v, double r2)
{
    const double q = sqrt(r2)/v->h, t = 1 - q, u = 0.5 - q;
    if (v->shape == TOBI_SHAPE_WENDLAND) return v->weight*t*t*t*t*(1 + 4*q);
    return v->weight*(2*t*t*t - (u > 0 ? 8*u*u*u : 0));
}

/* Velocity of j or of its image; kick: what gravity gave in this step, which walls do not mirror. */
static inline void isph_velocity(const isph_view *v, const isph_pair *p, double kick, double u[3])
{
    const tobi_float4 *w = &v->velocity[p->j];
    u[0] = w->x; u[1] = w->y; u[2] = w->z;
    for (int a = 0; p->mirrored >> a; a++)
        if (p->mirrored >> a & 1) u[a] = 2*kick*v->gravity[a] - u[a];
}

/* Pa: pressure of the image less that of j, as of liquid at rest, eq. (7). */
static inline double isph_lift(const isph_view *v, const isph_pair *p)
{
    double sum = 0;
    if (!p->mirrored) return 0;
    for (int a = 0; a < v->dimension; a++) sum += v->gravity[a]*p->away[a];
    return v->density*sum;
}

static inline void isph_apply(const isph_tensor *t, const double x[3], double out[3])
{
    out[0] = t->xx*x[0] + t->xy*x[1] + t->zx*x[2];
    out[1] = t->xy*x[0] + t->yy*x[1] + t->yz*x[2];
    out[2] = t->zx*x[0] + t->yz*x[1] + t->zz*x[2];
}

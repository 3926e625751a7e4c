/* The planes in which a pair of particles is mirrored at bodies, and which of its images may be within reach.
   Drawback: the walk that holds them holds all that is made of them too (body_images.k.h). */
#pragma once
#include "sph/isph/body_pairs.k.h"

enum {
    ISPH_PLANES = 6,                 /* that a pair sees at once                                    */
    ISPH_FACES = 3,                  /* that an image is in at once                                 */
    ISPH_IMAGES = 16,                /* of a pair: in planes, and in several of them at once        */
    ISPH_BATCH = 64                  /* images that are made together                               */
};

/* The mirror of a pair at one body. */
typedef struct isph_plane {
    int32_t mirror[2];               /* of i and of j                                               */
    double normal[3];
    double size;                     /* 1: square of the normal before its length is one            */
    double sum[3];                   /* m, of the offsets of both particles                         */
    double weight;
    int reaches, meets;              /* 1: its image may be within reach, so may one in others too  */
} isph_plane;

/* Images in one plane each, some of them in sides too, that are made together. */
typedef struct isph_batch {
    int count;
    /* as they are put in */
    double normal[3][ISPH_BATCH], size[ISPH_BATCH], sum[3][ISPH_BATCH];        /* of the plane           */
    double offset[3][ISPH_BATCH];    /* m, of the pair                                              */
    double x[3][ISPH_BATCH];         /* m, from the image in sides alone to the particle            */
    double along[3][ISPH_BATCH];     /* 1; 0 along axes of sides                                    */
    float weight[ISPH_BATCH];
    int32_t mirror[2][ISPH_BATCH], pair[ISPH_BATCH];
    /* made of that: x and normal, as they are in the end, and 1 where they are within reach */
    double reaches[ISPH_BATCH];
} isph_batch;

/* One particle's images at bodies: the pair and the group at hand. */
typedef struct isph_walk {
    const isph_view *v;
    isph_reflections reflections;
    int64_t i, first;
    int pair;                        /* at hand: of the list, -1: i itself                          */
    double offset[3];                /* m, x_i - x_j                                                */
    isph_plane plane[ISPH_PLANES];
    int planes;                      /* of the pair                                                 */
    int face[ISPH_IMAGES][ISPH_FACES], images;       /* the planes of each, -1: none                */
    double whole[ISPH_IMAGES];       /* 1: how much there is of one in several planes               */
    isph_batch batch;
    int used;                        /* images in the group                                         */
    isph_image_group group;          /* at hand                                                     */
    isph_image_rest rest;            /* of it                                                       */
    int64_t *to;                     /* where the next group is told; NULL: groups are made anew in */
    int64_t next;                    /* their places                                                */
} isph_walk;

/* Two faces of a corner that is concave; offset: of the pair. */
TOBI_FN int isph_faces_apart(const isph_mirror *a, const isph_mirror *b, const double offset[3])
{
    double turn = 0, hollow = 0;
    for (int c = 0; c < 3; c++) {
        turn += a->normal[c]*b->normal[c];
        hollow += (a->offset[c] - b->offset[c] - offset[c])*(a->normal[c] - b->normal[c]);
    }
    return turn < ISPH_TWO_FACES && hollow > 0;
}

/* Where both share of the body is below a half there is next to none between a particle and the image. 0: the
   surface turns by 120 degrees or more, or there is no body. */
TOBI_FN int isph_find_plane(const isph_view *v, int32_t own, int32_t other, isph_plane *p)
{
    const isph_mirror *a = &v->mirror[own], *b = &v->mirror[other];
    const double both = a->share + b->share - 0.5;
    p->size = 0;
    p->mirror[0] = own;
    p->mirror[1] = other;
    p->weight = both < 0 ? 0 : both < 1 ? both : 1;
    for (int c = 0; c < 3; c++) {
        p->normal[c] = a->normal[c] + b->normal[c];
        p->sum[c] = a->offset[c] + b->offset[c];
        p->size += p->normal[c]*p->normal[c];
    }
    return p->size > 1 && p->weight > 0;
}

TOBI_FN void isph_normalise_plane(isph_plane *p)
{
    for (int c = 0; c < 3; c++) p->normal[c] /= sqrt(p->size);
    p->size = 1;
}

/* m/s: of the plane along a direction, and its change. */
TOBI_FN void isph_plane_speed(const isph_view *v, const int32_t mirror[2], const double along[3],
                              double speed[2])
{
    const isph_mirror *a = &v->mirror[mirror[0]], *b = &v->mirror[mirror[1]];
    speed[0] = speed[1] = 0;
    for (int c = 0; c < 3; c++) {
        speed[0] += 0.5*(a->velocity[c] + b->velocity[c])*along[c];
        speed[1] += 0.5*(a->velocity_change[c] + b->velocity_change[c])*along[c];
    }
}

/* Most images are out of reach, which is told before roots are drawn: in one plane r^2 = o^2 + 4 s_i s_j; in
   several an image is no nearer than s_i + s_j of each, and both particles stand before all of them. */
TOBI_FN void isph_find_reach(const isph_walk *w, isph_plane *p)
{
    const double far2 = ISPH_REACH*w->v->h*w->v->h, before = -1e-6*w->v->h;
    double own = 0, other = 0, both = 0, square = 0;
    p->reaches = p->meets = 1;
    if (w->reflections.total != 1) return;
    for (int a = 0; a < 3; a++) {
        own += (p->sum[a] + w->offset[a])*p->normal[a];
        other += (p->sum[a] - w->offset[a])*p->normal[a];
        both += p->sum[a]*p->normal[a];
        square += w->offset[a]*w->offset[a];
    }
    if (own < before || other < before) p->reaches = p->meets = 0;
    if ((square - far2)*p->size + own*other > 0) p->reaches = 0;
    if (both*both > far2*p->size) p->meets = 0;
}

/* How much of the image in both of two faces there is: all of it in a corner of at most 90 degrees; images in
   either face fill one of 120. Faces turn by at least 60 degrees. */
TOBI_FN double isph_planes_meet(const isph_walk *w, int p, int q)
{
    const isph_plane *a = &w->plane[p], *b = &w->plane[q];
    double c = 0, before = 0, behind = 0;            /* either face, as seen from the other */
    for (int x = 0; x < 3; x++) {
        c += a->normal[x]*b->normal[x];
        before += (b->sum[x] - a->sum[x])*b->normal[x];
        behind += (a->sum[x] - b->sum[x])*a->normal[x];
    }
    const double least = 0.2*w->v->spacing;
    if (!a->meets || !b->meets) return 0;
    if (fabs(c) >= ISPH_TWO_FACES || before < least || behind < least) return 0;
    const double whole = 2*M_PI/acos(-c) - 3;
    return whole < 1 ? whole : 1;
}

/* Images of the pair: in each plane; where faces of a body meet, in two and three at once too. */
TOBI_FN void isph_walk_list_images(isph_walk *w)
{
    int (*f)[ISPH_FACES] = w->face, meeting = 0;
    w->images = 0;
    for (int p = 0; p < w->planes; p++) {
        isph_find_reach(w, &w->plane[p]);
        meeting += w->plane[p].meets;
    }
    for (int p = 0; p < w->planes; p++) {
        if (w->plane[p].reaches || meeting > 1) isph_normalise_plane(&w->plane[p]);
        if (!w->plane[p].reaches) continue;
        f[w->images][0] = p;
        f[w->images][1] = f[w->images][2] = -1;
        w->images++;
    }
    for (int p = 0; p < w->planes && meeting > 1; p++)
        for (int q = p + 1; q < w->planes; q++) {
            const double both = isph_planes_meet(w, p, q);
            if (!(both > 0)) continue;
            for (int r = q; r < w->planes && w->images < ISPH_IMAGES; r++) {
                const double whole = r == q ? both : both*isph_planes_meet(w, p, r)*isph_planes_meet(w, q, r);
                if (!(whole > 0)) continue;
                w->whole[w->images] = whole;
                f[w->images][0] = p;
                f[w->images][1] = q;
                f[w->images][2] = r > q ? r : -1;
                w->images++;
            }
        }
}

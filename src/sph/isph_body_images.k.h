/* Images of pairs at bodies, in the mean of the planes at the points of the surface that are closest to
   either particle: exact at flat faces, rounded at edges. In a concave corner of one body also images in two
   or three of its faces at once. Images at two bodies at once are left out.
   Drawback: pairs are made one at a time; they are handed on in groups. */
#pragma once
#include "sph/isph_images.k.h"

enum {
    ISPH_PLANES = 6,                 /* that a pair sees at once                                    */
    ISPH_FACES = 3,                  /* that an image is in at once                                 */
    ISPH_IMAGES = 16                 /* of a pair: in planes, and in several of them at once        */
};

/* The mirror of a pair at one body. */
typedef struct isph_plane {
    double normal[3], velocity[3], velocity_change[3];
    double sum[3];                   /* m, of the offsets of both particles                         */
    double weight;
} isph_plane;

/* One particle's images at bodies: where the walk is, and the group at hand. */
typedef struct isph_walk {
    const isph_view *v;
    const isph_reflections *reflections;
    int64_t i, j, first;
    int k, groups;                   /* the next of the list; before all others i itself            */
    double offset[3];                /* m, x_i - x_j                                                */
    isph_plane plane[ISPH_PLANES];
    int planes;                      /* of the pair                                                 */
    int face[ISPH_IMAGES][ISPH_FACES], images, at;   /* the planes of each, -1: none; those done     */
    double whole[ISPH_IMAGES];       /* 1: how much there is of one in several planes               */
    int used;                        /* images in the group                                         */
    int32_t index[8];
    int64_t entry[8];
    float x[3][8], displacement[3][8], sign[3][8], normal[3][8];
    float normal_velocity[8], velocity_change[8], weight[8];
    int corners;                     /* of the group: images in several planes                      */
    float corner_velocity[3][8], corner_change[3][8];
} isph_walk;

/* Where both share of the body is below a half there is next to none between a particle and the image. */
TOBI_FN void isph_add_plane(isph_walk *w, const isph_mirror *a, const isph_mirror *b)
{
    isph_plane *p = &w->plane[w->planes];
    const double both = a->share + b->share - 0.5;
    double size = 0, turn = 0, hollow = 0;
    for (int c = 0; c < 3; c++) {                    /* two faces of a corner that is concave */
        turn += a->normal[c]*b->normal[c];
        hollow += (a->offset[c] - b->offset[c] - w->offset[c])*(a->normal[c] - b->normal[c]);
    }
    if (turn < ISPH_TWO_FACES && hollow > 0) return;
    p->weight = both < 0 ? 0 : both < 1 ? both : 1;
    for (int c = 0; c < 3; c++) {
        p->normal[c] = a->normal[c] + b->normal[c];
        p->velocity[c] = 0.5*(a->velocity[c] + b->velocity[c]);
        p->velocity_change[c] = 0.5*(a->velocity_change[c] + b->velocity_change[c]);
        p->sum[c] = a->offset[c] + b->offset[c];
        size += p->normal[c]*p->normal[c];
    }
    if (!(size > 1) || !(p->weight > 0)) return;     /* the surface turns by less than 120 degrees */
    for (int c = 0; c < 3; c++) p->normal[c] /= sqrt(size);
    w->planes++;
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
    if (fabs(c) >= ISPH_TWO_FACES || before < least || behind < least) return 0;
    const double whole = 2*M_PI/acos(-c) - 3;
    return whole < 1 ? whole : 1;
}

/* Images of the pair: in each plane; where faces of a body meet, in two and three at once too. */
TOBI_FN void isph_walk_list_images(isph_walk *w)
{
    int (*f)[ISPH_FACES] = w->face;
    w->images = w->at = 0;
    for (int p = 0; p < w->planes; p++) {
        f[w->images][0] = p;
        f[w->images][1] = f[w->images][2] = -1;
        w->images++;
    }
    for (int p = 0; p < w->planes; p++)
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

/* The pair of i and j: its offset, and its mirrors. */
TOBI_FN void isph_walk_load_pair(isph_walk *w, int64_t j)
{
    const isph_view *v = w->v;
    w->j = j;
    w->planes = 0;
    for (int a = 0; a < 3; a++) {
        double x = (&v->position[w->i].x)[a] - (&v->position[j].x)[a];
        if (v->periodic[a]) x -= x > 0.5*v->size[a] ? v->size[a] : x < -0.5*v->size[a] ? -v->size[a] : 0;
        w->offset[a] = x;
    }
    for (int32_t a = v->last_link[w->i]; a >= 0; a = v->mirror[a].previous)
        for (int32_t b = v->last_link[j]; b >= 0; b = v->mirror[b].previous)
            if (v->mirror[a].body == v->mirror[b].body && w->planes < ISPH_PLANES)
                isph_add_plane(w, &v->mirror[a], &v->mirror[b]);
    isph_walk_list_images(w);
}

TOBI_FN isph_walk isph_walk_begin(const isph_view *v, int64_t i, const isph_reflections *reflections,
                                  int64_t first, int groups)
{
    isph_walk w;
    w.v = v; w.reflections = reflections; w.i = i; w.first = first; w.groups = groups;
    w.k = 0;
    isph_walk_load_pair(&w, i);
    return w;
}

/* The image at sides, once more mirrored at a body: only where the two stand across one another. Symmetric:
   r^2 + 4 s_i s_j with the distances of both from the plane. */
TOBI_FN void isph_walk_add_image(isph_walk *w, const isph_plane *b, const int side[3])
{
    const isph_view *v = w->v;
    const int k = w->used;
    double x[3], normal[3], size = 0, own = 0, other = 0, normal_velocity = 0, change = 0, r2 = 0;
    for (int a = 0; a < 3; a++) {
        const double wall = side[a] == 1 ? v->size[a] : 0;
        x[a] = side[a] < 0 ? w->offset[a] : 2*((&v->position[w->i].x)[a] - wall) - w->offset[a];
        normal[a] = side[a] < 0 ? b->normal[a] : 0;
        size += normal[a]*normal[a];
    }
    if (size < 0.9) return;
    for (int a = 0; a < 3; a++) {
        normal[a] /= sqrt(size);
        own += 0.5*(b->sum[a] + w->offset[a])*normal[a];
        other += 0.5*(b->sum[a] - w->offset[a])*normal[a];
        normal_velocity += b->velocity[a]*normal[a];
        change += b->velocity_change[a]*normal[a];
    }
    if (!(own > 0) || !(other > 0)) return;
    for (int a = 0; a < 3; a++) {
        x[a] += 2*other*normal[a];
        r2 += x[a]*x[a];
    }
    if (r2 >= v->h*v->h) return;
    for (int a = 0; a < 3; a++) {
        w->x[a][k] = (float)x[a];
        w->displacement[a][k] = (float)(w->offset[a] - x[a]);
        w->sign[a][k] = side[a] < 0 ? 1 : -1;
        w->normal[a][k] = (float)normal[a];
    }
    w->normal_velocity[k] = (float)normal_velocity;
    w->velocity_change[k] = (float)change;
    w->weight[k] = (float)b->weight;
    w->index[k] = (int32_t)w->j;
    w->entry[k] = w->k > 0 ? w->first + w->k - 1 : -1;
    for (int a = 0; a < 3; a++) w->corner_velocity[a][k] = w->corner_change[a][k] = 0;
    w->used++;
}

/* Along the sides nothing of a normal is left; 0: it lies across them. */
TOBI_FN int isph_turn_along(const double normal[3], const int side[3], double out[3])
{
    double size = 0;
    for (int a = 0; a < 3; a++) {
        out[a] = side[a] < 0 ? normal[a] : 0;
        size += out[a]*out[a];
    }
    for (int a = 0; a < 3; a++) out[a] /= sqrt(size) + 1e-30;
    return size >= 0.9;
}

TOBI_FN void isph_across(double out[3], const double a[3], const double b[3])
{
    for (int c = 0; c < 3; c++) out[c] = a[(c + 1)%3]*b[(c + 2)%3] - a[(c + 2)%3]*b[(c + 1)%3];
}

/* The vector with these components along three normals. */
TOBI_FN void isph_compose(double n[3][3], const double along[3], double out[3])
{
    double across[3], det = 0;
    for (int a = 0; a < 3; a++) out[a] = 0;
    for (int f = 0; f < 3; f++) {
        isph_across(across, n[(f + 1)%3], n[(f + 2)%3]);
        det = 0;
        for (int a = 0; a < 3; a++) det += across[a]*n[f][a];
        for (int a = 0; a < 3; a++) out[a] += along[f]*across[a]/det;
    }
}

/* Planes that meet in a corner, as the sides leave them. */
typedef struct isph_corner {
    int faces;
    double normal[3][3];             /* of two planes the third is along the line in which they meet */
    double at[3];                    /* m, of the image's offset along them                         */
    double moved[3], change[3];      /* m/s, of the planes                                          */
    double weight;
} isph_corner;

/* 0: the particles do not stand before the plane, or it lies across a side. */
TOBI_FN int isph_corner_add_face(isph_corner *c, const isph_walk *w, const isph_plane *p, const int side[3])
{
    double own = 0, other = 0, *n = c->normal[c->faces];
    c->moved[c->faces] = c->change[c->faces] = 0;
    if (!isph_turn_along(p->normal, side, n)) return 0;
    for (int a = 0; a < 3; a++) {
        own += 0.5*(p->sum[a] + w->offset[a])*n[a];
        other += 0.5*(p->sum[a] - w->offset[a])*n[a];
        c->moved[c->faces] += p->velocity[a]*n[a];
        c->change[c->faces] += p->velocity_change[a]*n[a];
    }
    c->at[c->faces++] = own + other;
    c->weight *= p->weight;
    return own > 0 && other > 0;
}

/* The third direction, along which only sides mirror; 0: two of them are next to one. */
TOBI_FN int isph_corner_close(isph_corner *c, const isph_walk *w, const int side[3])
{
    double line[3], size = 0, volume = 0, *n = c->normal[2];
    isph_across(line, c->normal[0], c->normal[1]);
    for (int a = 0; a < 3; a++) size += line[a]*line[a];
    if (size < 0.1) return 0;
    for (int a = 0; a < 3; a++) {
        const double wall = side[a] == 1 ? w->v->size[a] : 0,
                     mirrored = 2*((&w->v->position[w->i].x)[a] - wall) - w->offset[a];
        if (c->faces == 2) c->at[2] += line[a]/sqrt(size)*(side[a] < 0 ? w->offset[a] : mirrored);
        if (c->faces == 2) n[a] = line[a]/sqrt(size);
        volume += line[a]*n[a];
    }
    return fabs(volume) > 0.1;
}

/* The image in two or three planes at once, and at sides: a turn by half about the line in which two meet,
   a mirror in the point in which three do. It is the same for i and j, at any angle of the corner. */
TOBI_FN void isph_walk_add_corner(isph_walk *w, const int face[ISPH_FACES], double whole, const int side[3])
{
    const int k = w->used, faces = face[2] < 0 ? 2 : 3;
    isph_corner c;
    double x[3], speed[3], change[3], r2 = 0;
    c.faces = 0;
    c.weight = whole;
    c.at[2] = c.moved[2] = c.change[2] = 0;
    for (int f = 0; f < faces; f++)
        if (!isph_corner_add_face(&c, w, &w->plane[face[f]], side)) return;
    if (!isph_corner_close(&c, w, side)) return;
    isph_compose(c.normal, c.at, x);
    for (int a = 0; a < 3; a++) r2 += x[a]*x[a];
    if (r2 >= w->v->h*w->v->h) return;
    isph_compose(c.normal, c.moved, speed);
    isph_compose(c.normal, c.change, change);
    for (int a = 0; a < 3; a++) {
        w->x[a][k] = (float)x[a];
        w->displacement[a][k] = (float)(w->offset[a] - x[a]);
        w->sign[a][k] = -1;
        w->normal[a][k] = faces == 2 && side[a] < 0 ? (float)c.normal[2][a] : 0;
        w->corner_velocity[a][k] = (float)(2*speed[a]);
        w->corner_change[a][k] = (float)change[a];
    }
    w->normal_velocity[k] = w->velocity_change[k] = 0;
    w->weight[k] = (float)c.weight;
    w->index[k] = (int32_t)w->j;
    w->entry[k] = w->k > 0 ? w->first + w->k - 1 : -1;
    w->corners = 1;
    w->used++;
}

/* The next group; 0: there is none. */
TOBI_FN int isph_walk_fill(isph_walk *w)
{
    w->used = w->corners = 0;
    for (;;) {
        for (; w->at < w->images*w->reflections->total && w->used < TOBI_LANES; w->at++) {
            const int m = w->at/w->reflections->total, *face = w->face[m];
            int side[3];
            isph_choose_sides(w->reflections, w->at%w->reflections->total, side);
            if (face[1] < 0) isph_walk_add_image(w, &w->plane[face[0]], side);
            else isph_walk_add_corner(w, face, w->whole[m], side);
        }
        if (w->used == TOBI_LANES) return 1;
        for (;; w->k++) {
            if (w->k == w->groups) return w->used > 0;
            const int32_t j = w->v->list[w->first + w->k];
            if (j != w->i && w->v->last_link[j] >= 0) break;
        }
        isph_walk_load_pair(w, w->v->list[w->first + w->k++]);
    }
}

/* The group at hand; what is missing in it is out of reach. */
TOBI_FN void isph_walk_load(isph_walk *w, tobi_neighbors *n, isph_image *m)
{
    lane_int x, y, z;
    for (int k = w->used; k < TOBI_LANES; k++) {
        w->index[k] = (int32_t)w->i;
        w->entry[k] = -1;
        w->x[0][k] = 2*(float)w->v->h;
        w->x[1][k] = w->x[2][k] = w->normal_velocity[k] = w->velocity_change[k] = w->weight[k] = 0;
        for (int a = 0; a < 3; a++) w->displacement[a][k] = w->sign[a][k] = w->normal[a][k] = 0;
        for (int a = 0; a < 3; a++) w->corner_velocity[a][k] = w->corner_change[a][k] = 0;
    }
    n->j = w->index;
    n->index = lane_load_index(w->index);
    lane_load_record(w->v->record, n->j, &x, &y, &z, &n->w);
    n->dx = lane_load(w->x[0]); n->dy = lane_load(w->x[1]); n->dz = lane_load(w->x[2]);
    n->r2 = isph_square(n);
    for (int a = 0; a < 3; a++) {
        m->sign[a] = lane_load(w->sign[a]);
        m->displacement[a] = lane_load(w->displacement[a]);
        m->normal[a] = lane_load(w->normal[a]);
    }
    m->normal_velocity = lane_load(w->normal_velocity);
    m->velocity_change = lane_load(w->velocity_change);
    m->weight = lane_load(w->weight);
    m->entry = w->entry;
    m->corners = w->corners;
    if (!m->corners) return;
    for (int a = 0; a < 3; a++) {
        m->corner_velocity[a] = lane_load(w->corner_velocity[a]);
        m->corner_change[a] = lane_load(w->corner_change[a]);
    }
}

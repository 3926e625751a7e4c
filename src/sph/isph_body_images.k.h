/* Images of pairs at bodies, in the mean of the planes at the points of the surface that are closest to
   either particle: exact at flat faces, rounded at edges. Images at two bodies at once are left out.
   Drawback: pairs are made one at a time; they are handed on in groups. */
#pragma once
#include "sph/isph_images.k.h"

enum { ISPH_PLANES = 6 };            /* that a pair sees at once                                    */

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
    int planes, at;                  /* of the pair: planes, images done                            */
    int used;                        /* images in the group                                         */
    int32_t index[8];
    int64_t entry[8];
    float x[3][8], displacement[3][8], sign[3][8], normal[3][8];
    float normal_velocity[8], velocity_change[8], weight[8];
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

/* The pair of i and j: its offset, and its mirrors. */
TOBI_FN void isph_walk_load_pair(isph_walk *w, int64_t j)
{
    const isph_view *v = w->v;
    w->j = j;
    w->planes = w->at = 0;
    for (int a = 0; a < 3; a++) {
        double x = (&v->position[w->i].x)[a] - (&v->position[j].x)[a];
        if (v->periodic[a]) x -= x > 0.5*v->size[a] ? v->size[a] : x < -0.5*v->size[a] ? -v->size[a] : 0;
        w->offset[a] = x;
    }
    for (int32_t a = v->last_link[w->i]; a >= 0; a = v->mirror[a].previous)
        for (int32_t b = v->last_link[j]; b >= 0; b = v->mirror[b].previous)
            if (v->mirror[a].body == v->mirror[b].body && w->planes < ISPH_PLANES)
                isph_add_plane(w, &v->mirror[a], &v->mirror[b]);
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
    w->used++;
}

/* The next group; 0: there is none. */
TOBI_FN int isph_walk_fill(isph_walk *w)
{
    w->used = 0;
    for (;;) {
        for (; w->at < w->planes*w->reflections->total && w->used < TOBI_LANES; w->at++) {
            int side[3];
            isph_choose_sides(w->reflections, w->at%w->reflections->total, side);
            isph_walk_add_image(w, &w->plane[w->at/w->reflections->total], side);
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
}

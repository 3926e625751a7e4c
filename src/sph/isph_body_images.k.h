/* Images of pairs at bodies, in the mean of the planes at the points of the surface that are closest to
   either particle: exact at flat faces, rounded at edges. In a concave corner of one body also images in two
   or three of its faces at once. Images at two bodies at once are left out. They are made once for all loops
   of a step, and again where bodies change their velocity within it.
   Drawback: pairs are made one at a time; what is made takes some 50 bytes an image. */
#pragma once
#include "sph/isph_images.k.h"

/* Of the square of the support: what is farther is out of reach whatever the rounding. */
#define ISPH_REACH 1.0001

enum {
    ISPH_PLANES = 6,                 /* that a pair sees at once                                    */
    ISPH_FACES = 3,                  /* that an image is in at once                                 */
    ISPH_IMAGES = 16                 /* of a pair: in planes, and in several of them at once        */
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

/* One particle's images at bodies: where the walk is, and the group at hand. */
typedef struct isph_walk {
    const isph_view *v;
    isph_reflections reflections;
    int64_t i, first;
    int k, groups;                   /* the next of the list; before all others i itself            */
    double offset[3];                /* m, x_i - x_j                                                */
    isph_plane plane[ISPH_PLANES];
    int planes;                      /* of the pair                                                 */
    int face[ISPH_IMAGES][ISPH_FACES], images;       /* the planes of each, -1: none                */
    int at, reflection;              /* the image that comes next                                   */
    double whole[ISPH_IMAGES];       /* 1: how much there is of one in several planes               */
    int used;                        /* images in the group                                         */
    isph_image_group group;          /* at hand                                                     */
    isph_image_rest rest;            /* of it                                                       */
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
}

/* m/s: of the plane along a direction, and its change. */
TOBI_FN void isph_plane_speed(const isph_view *v, const isph_plane *p, const double along[3], double speed[2])
{
    const isph_mirror *a = &v->mirror[p->mirror[0]], *b = &v->mirror[p->mirror[1]];
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
    w->images = w->at = w->reflection = 0;
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

/* The pair of i and j: its offset, and its mirrors. */
TOBI_FN void isph_walk_load_pair(isph_walk *w, int64_t j)
{
    const isph_view *v = w->v;
    w->planes = 0;
    for (int a = 0; a < 3; a++) {
        double x = (&v->position[w->i].x)[a] - (&v->position[j].x)[a];
        if (v->periodic[a]) x -= x > 0.5*v->size[a] ? v->size[a] : x < -0.5*v->size[a] ? -v->size[a] : 0;
        w->offset[a] = x;
    }
    for (int32_t a = v->last_link[w->i]; a >= 0; a = v->mirror[a].previous)
        for (int32_t b = v->last_link[j]; b >= 0; b = v->mirror[b].previous)
            if (v->mirror[a].body == v->mirror[b].body && w->planes < ISPH_PLANES &&
                !isph_faces_apart(&v->mirror[a], &v->mirror[b], w->offset))
                w->planes += isph_find_plane(v, a, b, &w->plane[w->planes]);
    isph_walk_list_images(w);
}

TOBI_FN void isph_walk_begin(isph_walk *w, const isph_view *v, int64_t i)
{
    w->v = v;
    w->i = i;
    w->reflections = isph_find_reflections(v, i);
    w->first = 8*(int64_t)v->list_start[i];
    w->groups = 8*v->list_groups[i];
    w->k = 0;
    isph_walk_load_pair(w, i);
}

/* What sides leave of the normal; 0: next to nothing. */
TOBI_FN int isph_plane_along(const isph_plane *p, const int sided[3], double normal[3])
{
    double size = 0;
    for (int a = 0; a < 3; a++) {
        normal[a] = sided[a] ? 0 : p->normal[a];
        size += normal[a]*normal[a];
    }
    if (size < 0.9) return 0;
    for (int a = 0; a < 3; a++) normal[a] /= sqrt(size);
    return 1;
}

/* The image at sides, once more mirrored at a body: only where the two stand across one another. Symmetric:
   r^2 + 4 s_i s_j with the distances of both from the plane. */
TOBI_FN void isph_walk_add_image(isph_walk *w, const isph_plane *b, const int side[3])
{
    const isph_view *v = w->v;
    isph_image_group *g = &w->group;
    const int k = w->used, sided[3] = { side[0] >= 0, side[1] >= 0, side[2] >= 0 };
    double x[3], normal[3], speed[2], own = 0, other = 0, r2 = 0;
    if (!isph_plane_along(b, sided, normal)) return;
    for (int a = 0; a < 3; a++) {
        const double wall = side[a] == 1 ? v->size[a] : 0;
        x[a] = side[a] < 0 ? w->offset[a] : 2*((&v->position[w->i].x)[a] - wall) - w->offset[a];
        own += 0.5*(b->sum[a] + w->offset[a])*normal[a];
        other += 0.5*(b->sum[a] - w->offset[a])*normal[a];
    }
    if (!(own > 0) || !(other > 0)) return;
    for (int a = 0; a < 3; a++) {
        x[a] += 2*other*normal[a];
        r2 += x[a]*x[a];
    }
    if (r2 >= v->h*v->h) return;
    isph_plane_speed(v, b, normal, speed);
    for (int a = 0; a < 3; a++) {
        g->x[a][k] = (float)x[a];
        g->displacement[a][k] = (float)(w->offset[a] - x[a]);
        w->rest.sign[a][k] = side[a] < 0 ? 1 : -1;
        g->normal[a][k] = (float)normal[a];
        w->rest.velocity[a][k] = w->rest.change[a][k] = 0;
    }
    g->normal_velocity[k] = (float)speed[0];
    g->velocity_change[k] = (float)speed[1];
    g->weight[k] = (float)b->weight;
    for (int e = 0; e < 2; e++) g->mirror[e][k] = b->mirror[e];
    g->neighbor[k] = w->k - 1;
    g->sided |= sided[0] | sided[1] | sided[2];
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
    double own = 0, other = 0, speed[2], *n = c->normal[c->faces];
    if (!isph_turn_along(p->normal, side, n)) return 0;
    for (int a = 0; a < 3; a++) {
        own += 0.5*(p->sum[a] + w->offset[a])*n[a];
        other += 0.5*(p->sum[a] - w->offset[a])*n[a];
    }
    isph_plane_speed(w->v, p, n, speed);
    c->moved[c->faces] = speed[0];
    c->change[c->faces] = speed[1];
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
    isph_image_group *g = &w->group;
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
        g->x[a][k] = (float)x[a];
        g->displacement[a][k] = (float)(w->offset[a] - x[a]);
        w->rest.sign[a][k] = -1;
        g->normal[a][k] = faces == 2 && side[a] < 0 ? (float)c.normal[2][a] : 0;
        w->rest.velocity[a][k] = (float)(2*speed[a]);
        w->rest.change[a][k] = (float)change[a];
    }
    g->normal_velocity[k] = g->velocity_change[k] = 0;
    g->weight[k] = (float)c.weight;
    g->neighbor[k] = w->k - 1;
    g->corners = 1;
    w->used++;
}

/* The next group; 0: there is none. */
TOBI_FN int isph_walk_fill(isph_walk *w)
{
    w->used = w->group.corners = w->group.sided = 0;
    for (;;) {
        while (w->at < w->images && w->used < TOBI_LANES) {
            const int *face = w->face[w->at];
            int side[3] = { -1, -1, -1 };
            if (w->reflection > 0) isph_choose_sides(&w->reflections, w->reflection, side);
            if (face[1] < 0) isph_walk_add_image(w, &w->plane[face[0]], side);
            else isph_walk_add_corner(w, face, w->whole[w->at], side);
            w->reflection = (w->reflection + 1)%w->reflections.total;
            w->at += w->reflection == 0;
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

/* What is missing in the group at hand is out of reach. */
TOBI_FN void isph_walk_pad(isph_walk *w)
{
    isph_image_group *g = &w->group;
    for (int k = w->used; k < 8; k++) {
        g->neighbor[k] = g->mirror[0][k] = -1;
        g->x[0][k] = 2*(float)w->v->h;
        g->x[1][k] = g->x[2][k] = g->normal_velocity[k] = g->velocity_change[k] = g->weight[k] = 0;
        for (int a = 0; a < 3; a++) {
            g->displacement[a][k] = w->rest.sign[a][k] = g->normal[a][k] = 0;
            w->rest.velocity[a][k] = w->rest.change[a][k] = 0;
        }
    }
}

/* Its first group; -1: it has none. */
TOBI_FN int64_t isph_first_group(const isph_view *v, int64_t i)
{
    return v->last_link && v->last_link[i] >= 0 ? v->first_group[v->last_link[i]] : -1;
}

TOBI_FN int isph_places(const isph_image_group *g) { return g->sided || g->corners ? 2 : 1; }

TOBI_FN void isph_put_group(const isph_view *v, isph_walk *w, int64_t g)
{
    isph_walk_pad(w);
    v->group[g].images = w->group;
    if (isph_places(&w->group) > 1) v->group[g + 1].rest = w->rest;
}

/* Images of particle i, in groups as they are free. Those beyond the room are counted, and lost. */
TOBI_FN void isph_list_images(const isph_view *v, int64_t i, double *totals)
{
    isph_walk w;
    (void)totals;
    if (!v->last_link || v->last_link[i] < 0) return;
    int64_t *to = &v->first_group[v->last_link[i]];
    isph_walk_begin(&w, v, i);
    while (isph_walk_fill(&w)) {
        const int places = isph_places(&w.group);
        const int64_t g = tobi_fetch_add(v->group_count, places);
        if (g + places > v->group_room) continue;
        isph_put_group(v, &w, g);
        *to = g;
        to = &v->group[g].images.next;
    }
    *to = -1;
}

TOBI_FN int isph_has_corners(const isph_view *v, int64_t i)
{
    int any = 0;
    for (int64_t g = isph_first_group(v, i); g >= 0; g = v->group[g].images.next)
        any |= v->group[g].images.corners;
    return any;
}

/* The velocities of a group without corners. */
TOBI_FN void isph_refresh_group(const isph_view *v, int64_t group)
{
    isph_image_group *g = &v->group[group].images;
    for (int k = 0; k < TOBI_LANES && g->mirror[0][k] >= 0; k++) {
        int sided[3];
        double normal[3], speed[2];
        isph_plane p;
        for (int a = 0; a < 3; a++) sided[a] = g->sided && v->group[group + 1].rest.sign[a][k] < 0;
        isph_find_plane(v, g->mirror[0][k], g->mirror[1][k], &p);
        isph_normalise_plane(&p);
        isph_plane_along(&p, sided, normal);
        isph_plane_speed(v, &p, normal, speed);
        g->normal_velocity[k] = (float)speed[0];
        g->velocity_change[k] = (float)speed[1];
    }
}

/* The same images in the same groups, made anew. */
TOBI_FN void isph_make_images_anew(const isph_view *v, int64_t i)
{
    isph_walk w;
    isph_walk_begin(&w, v, i);
    for (int64_t g = isph_first_group(v, i); g >= 0 && isph_walk_fill(&w); g = w.group.next) {
        w.group.next = v->group[g].images.next;
        isph_put_group(v, &w, g);
    }
}

/* When bodies have other velocities. What is in corners has those of several planes. */
TOBI_FN void isph_refresh_images(const isph_view *v, int64_t i, double *totals)
{
    (void)totals;
    if (isph_has_corners(v, i)) {
        isph_make_images_anew(v, i);
        return;
    }
    for (int64_t g = isph_first_group(v, i); g >= 0; g = v->group[g].images.next) isph_refresh_group(v, g);
}

/* A group of particle i, whose list begins at first. */
TOBI_FN void isph_load_group(const isph_view *v, int64_t i, int64_t first, int64_t group, tobi_neighbors *n,
                             isph_image *m)
{
    const isph_image_group *g = &v->group[group].images;
    lane_int x, y, z;
    for (int k = 0; k < TOBI_LANES; k++) {
        m->index[k] = g->neighbor[k] < 0 ? (int32_t)i : v->list[first + g->neighbor[k]];
        m->entry[k] = g->neighbor[k] < 0 ? -1 : first + g->neighbor[k];
    }
    n->j = m->index;
    n->index = lane_load_index(m->index);
    lane_load_record(v->record, n->j, &x, &y, &z, &n->w);
    n->dx = lane_load(g->x[0]); n->dy = lane_load(g->x[1]); n->dz = lane_load(g->x[2]);
    n->r2 = isph_square(n);
    const int whole = isph_places(g) == 1;
    const isph_image_rest *rest = &v->group[group + 1].rest;
    for (int a = 0; a < 3; a++) {
        m->sign[a] = whole ? lane_set(1) : lane_load(rest->sign[a]);
        m->displacement[a] = lane_load(g->displacement[a]);
        m->normal[a] = lane_load(g->normal[a]);
    }
    m->normal_velocity = lane_load(g->normal_velocity);
    m->velocity_change = lane_load(g->velocity_change);
    m->weight = lane_load(g->weight);
    m->corners = g->corners;
    for (int a = 0; a < 3 && m->corners; a++) {
        m->corner_velocity[a] = lane_load(rest->velocity[a]);
        m->corner_change[a] = lane_load(rest->change[a]);
    }
}

/* Images of pairs at bodies, in the mean of the planes at the points of the surface that are closest to
   either particle: exact at flat faces, rounded at edges. In a concave corner of one body also images in two
   or three of its faces at once. Images at two bodies at once are left out. They are made once for all loops
   of a step, and again where bodies change their velocity within it. Those in one plane are made many at a
   time. Drawback: what is made takes some 50 bytes an image; those in corners are made one at a time. */
#pragma once
#include "sph/isph/body_planes.k.h"

TOBI_FN void isph_walk_find_offset(isph_walk *w, int64_t j)
{
    const isph_view *v = w->v;
    for (int a = 0; a < 3; a++) {
        double x = (&v->position[w->i].x)[a] - (&v->position[j].x)[a];
        if (v->periodic[a]) x -= x > 0.5*v->size[a] ? v->size[a] : x < -0.5*v->size[a] ? -v->size[a] : 0;
        w->offset[a] = x;
    }
}

/* The mirrors of the pair of i and j. */
TOBI_FN void isph_walk_find_planes(isph_walk *w, int64_t j)
{
    const isph_view *v = w->v;
    const isph_brief *m = v->brief;
    w->planes = 0;
    for (int32_t a = v->last_link[w->i] + 1; a > 0; a = m[a].previous)
        for (int32_t b = v->last_link[j] + 1; b > 0; b = m[b].previous)
            if (m[a].body == m[b].body && w->planes < ISPH_PLANES &&
                !isph_faces_apart(&v->mirror[a - 1], &v->mirror[b - 1], w->offset))
                w->planes += isph_find_plane(v, a - 1, b - 1, &w->plane[w->planes]);
}

TOBI_FN int isph_places(const isph_image_group *g) { return g->sided || g->corners ? 2 : 1; }

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

/* The group at hand goes to its place, and a new one begins. Those beyond the room are counted, and lost. */
TOBI_FN void isph_walk_put(isph_walk *w)
{
    const isph_view *v = w->v;
    const int places = isph_places(&w->group);
    const int64_t g = w->to ? tobi_fetch_add(v->group_count, places) : w->next;
    isph_walk_pad(w);
    w->used = 0;
    if (g >= 0 && g + places <= v->group_room) {
        if (w->to) *w->to = g;
        else w->group.next = w->next = v->group[g].images.next;
        v->group[g].images = w->group;
        if (places > 1) v->group[g + 1].rest = w->rest;
        if (w->to) w->to = &v->group[g].images.next;
    }
    w->group.corners = w->group.sided = 0;
}

/* Image k of the batch. */
TOBI_FN void isph_walk_add_image(isph_walk *w, int k)
{
    const isph_batch *b = &w->batch;
    isph_image_group *g = &w->group;
    const int32_t mirror[2] = { b->mirror[0][k], b->mirror[1][k] };
    const double normal[3] = { b->normal[0][k], b->normal[1][k], b->normal[2][k] };
    const int to = w->used++;
    double speed[2];
    isph_plane_speed(w->v, mirror, normal, speed);
    for (int a = 0; a < 3; a++) {
        const int sided = !(b->along[a][k] > 0);
        g->x[a][to] = (float)b->x[a][k];
        g->displacement[a][to] = (float)(b->offset[a][k] - b->x[a][k]);
        w->rest.sign[a][to] = sided ? -1 : 1;
        g->normal[a][to] = (float)normal[a];
        w->rest.velocity[a][to] = w->rest.change[a][to] = 0;
        g->sided |= sided;
    }
    g->normal_velocity[to] = (float)speed[0];
    g->velocity_change[to] = (float)speed[1];
    g->weight[to] = b->weight[k];
    for (int e = 0; e < 2; e++) g->mirror[e][to] = mirror[e];
    g->neighbor[to] = b->pair[k];
    if (w->used == TOBI_LANES) isph_walk_put(w);
}

/* The normal of a plane from the sum of two and its square: of length 1, and along sides only. Returns the
   square of what they leave of it. */
TOBI_FN double isph_find_normal(const double sum[3], double square, const double along[3], double n[3])
{
    const double length = sqrt(square);
    double left = 0;
    for (int a = 0; a < 3; a++) {
        n[a] = along[a] > 0 ? sum[a]/length : 0;
        left += n[a]*n[a];
    }
    const double size = sqrt(left);
    for (int a = 0; a < 3; a++) n[a] /= size;
    return left;
}

/* The images at sides, once more mirrored at a body: only where the two stand across one another. Symmetric:
   r^2 + 4 s_i s_j with the distances of both from the plane. */
TOBI_FN void isph_make_batch(isph_batch *b, double h)
{
    const double far2 = h*h;
    for (int k = 0; k < b->count; k++) {
        const double sum[3] = { b->normal[0][k], b->normal[1][k], b->normal[2][k] };
        const double along[3] = { b->along[0][k], b->along[1][k], b->along[2][k] };
        double n[3], x[3], own = 0, other = 0, r2 = 0;
        const double left = isph_find_normal(sum, b->size[k], along, n);
        for (int a = 0; a < 3; a++) {
            own += 0.5*(b->sum[a][k] + b->offset[a][k])*n[a];
            other += 0.5*(b->sum[a][k] - b->offset[a][k])*n[a];
        }
        for (int a = 0; a < 3; a++) {
            x[a] = b->x[a][k] + 2*other*n[a];
            r2 += x[a]*x[a];
            b->normal[a][k] = n[a];
            b->x[a][k] = x[a];
        }
        b->reaches[k] = (left >= 0.9) & (own > 0) & (other > 0) & (r2 < far2) ? 1 : 0;
    }
}

TOBI_RARE_FN void isph_walk_empty_batch(isph_walk *w)
{
    isph_make_batch(&w->batch, w->v->h);
    for (int k = 0; k < w->batch.count; k++)
        if (w->batch.reaches[k] > 0) isph_walk_add_image(w, k);
    w->batch.count = 0;
}

/* The image in a plane and in these sides, if any, to the batch. That in sides alone is no farther. */
TOBI_FN void isph_walk_list_image(isph_walk *w, const isph_plane *p, const int side[3])
{
    isph_batch *b = &w->batch;
    double x[3], square = 0;
    for (int a = 0; a < 3; a++) {
        const double wall = side[a] == 1 ? w->v->size[a] : 0;
        x[a] = side[a] < 0 ? w->offset[a] : 2*((&w->v->position[w->i].x)[a] - wall) - w->offset[a];
        square += x[a]*x[a];
    }
    if (square > ISPH_REACH*w->v->h*w->v->h) return;
    if (b->count == ISPH_BATCH) isph_walk_empty_batch(w);
    const int k = b->count++;
    for (int a = 0; a < 3; a++) {
        b->normal[a][k] = p->normal[a];
        b->sum[a][k] = p->sum[a];
        b->offset[a][k] = w->offset[a];
        b->x[a][k] = x[a];
        b->along[a][k] = side[a] < 0;
    }
    b->size[k] = p->size;
    b->weight[k] = (float)p->weight;
    for (int e = 0; e < 2; e++) b->mirror[e][k] = p->mirror[e];
    b->pair[k] = w->pair;
}

/* Those of the pair in planes and in sides. */
TOBI_FN void isph_walk_list_plane(isph_walk *w, const isph_plane *p)
{
    for (int f = 0; f < w->reflections.total; f++) {
        int side[3] = { -1, -1, -1 };
        if (f > 0) isph_choose_sides(&w->reflections, f, side);
        isph_walk_list_image(w, p, side);
    }
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

/* Whether the particles stand before the plane, as sides leave it, and the image is not out of reach: it is
   no nearer than their distances from it together. Told before roots are drawn. */
TOBI_FN int isph_face_may_reach(const isph_walk *w, const isph_plane *p, const int side[3])
{
    const double h = w->v->h, before = -1e-6*h;
    double own = 0, other = 0, size = 0;
    for (int a = 0; a < 3; a++) {
        const double n = side[a] < 0 ? p->normal[a] : 0;
        own += 0.5*(p->sum[a] + w->offset[a])*n;
        other += 0.5*(p->sum[a] - w->offset[a])*n;
        size += n*n;
    }
    return size >= 0.9 && own > before && other > before && (own + other)*(own + other) < ISPH_REACH*h*h*size;
}

/* 0: the particles do not stand before the plane, or it lies across a side. */
TOBI_FN int isph_corner_add_face(isph_corner *c, const isph_walk *w, const isph_plane *p, const int side[3])
{
    double own = 0, other = 0, speed[2], *n = c->normal[c->faces];
    if (!isph_turn_along(p->normal, side, n)) return 0;
    for (int a = 0; a < 3; a++) {
        own += 0.5*(p->sum[a] + w->offset[a])*n[a];
        other += 0.5*(p->sum[a] - w->offset[a])*n[a];
    }
    isph_plane_speed(w->v, p->mirror, n, speed);
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
        if (!isph_face_may_reach(w, &w->plane[face[f]], side)) return;
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
    g->neighbor[k] = w->pair;
    g->corners = 1;
    if (++w->used == TOBI_LANES) isph_walk_put(w);
}

/* The images of the pair at hand. */
TOBI_RARE_FN void isph_walk_take_pair(isph_walk *w, int64_t j)
{
    isph_walk_find_offset(w, j);
    isph_walk_find_planes(w, j);
    isph_walk_list_images(w);
    for (int m = 0; m < w->images; m++) {
        const int *face = w->face[m];
        if (face[1] < 0) isph_walk_list_plane(w, &w->plane[face[0]]);
        else isph_walk_empty_batch(w);
        for (int f = 0; f < w->reflections.total && face[1] >= 0; f++) {
            int side[3] = { -1, -1, -1 };
            if (f > 0) isph_choose_sides(&w->reflections, f, side);
            isph_walk_add_corner(w, face, w->whole[m], side);
        }
    }
}

/* Those of one whose planes do not meet, found before; the batch tells which are within reach. */
TOBI_FN void isph_walk_take_single(isph_walk *w, const isph_asking *q, const isph_answer *found, int k,
                                   int64_t j)
{
    const isph_view *v = w->v;
    isph_plane p;
    isph_walk_find_offset(w, j);
    for (uint32_t left = (uint32_t)found->hit[k]; left; left &= left - 1) {
        const int bit = tobi_lowest_bit(left);
        const int32_t own = q->own[bit/ISPH_SEEN], other = found->other[bit%ISPH_SEEN][k];
        if (isph_faces_apart(&v->mirror[own], &v->mirror[other], w->offset)) continue;
        if (isph_find_plane(v, own, other, &p)) isph_walk_list_plane(w, &p);
    }
}

/* All images of particle i, the last group too. to: NULL, or where the first group is told; first: its place,
   where groups are made anew. */
TOBI_FN void isph_walk_take_all(isph_walk *w, const isph_view *v, int64_t i, int64_t *to, int64_t first)
{
    isph_asking asking;
    isph_answer found;
    w->v = v;
    w->i = i;
    w->reflections = isph_find_reflections(v, i);
    w->first = 8*(int64_t)v->list_start[i];
    w->to = to;
    w->next = first;
    w->pair = -1;
    w->used = w->batch.count = w->group.corners = w->group.sided = 0;
    isph_ask_begin(v, i, &w->reflections, &asking);
    isph_walk_take_pair(w, i);
    for (int k = 0; k < 8*v->list_groups[i]; k += TOBI_LANES) {
        int32_t unpacked[8];
        const int32_t *near = tobi_list_load(v->list, v->list_far, i, w->first + k, TOBI_LANES, unpacked);
        isph_ask_pairs(v, i, &asking, near, &found);
        for (unsigned left = found.single | found.several; left; left &= left - 1) {
            const int at = tobi_lowest_bit(left);
            const int32_t j = near[at];
            w->pair = k + at;
            if (found.single >> at & 1) isph_walk_take_single(w, &asking, &found, at, j);
            else isph_walk_take_pair(w, j);
        }
    }
    isph_walk_empty_batch(w);
    if (w->used > 0) isph_walk_put(w);
}

/* Its first group; -1: it has none. */
TOBI_FN int64_t isph_first_group(const isph_view *v, int64_t i)
{
    return v->last_link && v->last_link[i] >= 0 ? v->first_group[v->last_link[i]] : -1;
}

/* Images of particle i, in groups as they are free. */
TOBI_FN void isph_list_images(const isph_view *v, int64_t i, double *totals)
{
    isph_walk w;
    (void)totals;
    if (!v->last_link || v->last_link[i] < 0) return;
    isph_walk_take_all(&w, v, i, &v->first_group[v->last_link[i]], -1);
    *w.to = -1;
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
    double normal[3][8], along[3][8], velocity[3][8], change[3][8];
    int used = 0;
    for (; used < 8 && g->mirror[0][used] >= 0; used++) {
        const isph_mirror *a = &v->mirror[g->mirror[0][used]], *b = &v->mirror[g->mirror[1][used]];
        for (int c = 0; c < 3; c++) {
            normal[c][used] = a->normal[c] + b->normal[c];
            along[c][used] = !g->sided || v->group[group + 1].rest.sign[c][used] > 0;
            velocity[c][used] = a->velocity[c] + b->velocity[c];
            change[c][used] = a->velocity_change[c] + b->velocity_change[c];
        }
    }
    for (int k = 0; k < used; k++) {
        const double sum[3] = { normal[0][k], normal[1][k], normal[2][k] };
        const double open[3] = { along[0][k], along[1][k], along[2][k] };
        double n[3], square = 0, speed = 0, more = 0;
        for (int a = 0; a < 3; a++) square += sum[a]*sum[a];
        isph_find_normal(sum, square, open, n);
        for (int a = 0; a < 3; a++) {
            speed += 0.5*velocity[a][k]*n[a];
            more += 0.5*change[a][k]*n[a];
        }
        g->normal_velocity[k] = (float)speed;
        g->velocity_change[k] = (float)more;
    }
}

/* When bodies have other velocities. What is in corners has those of several planes. */
TOBI_FN void isph_refresh_images(const isph_view *v, int64_t i, double *totals)
{
    (void)totals;
    if (isph_has_corners(v, i)) {
        isph_walk w;                                 /* the same images in the same groups */
        isph_walk_take_all(&w, v, i, NULL, isph_first_group(v, i));
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
        m->index[k] = g->neighbor[k] < 0 ? (int32_t)i
                                          : tobi_list_at(v->list, v->list_far, i, first + g->neighbor[k]);
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

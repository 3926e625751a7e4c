/* The skin of a solid on its surface in a picture. Where a vertex was at rest is what an affine map of its
   group says, and the mean of what the particles around differ from it. Coordinates are looked up there, not
   averaged, so that seams stay seams. Faces across a seam read all corners in one plane of the skin; faces
   from deep below have a plain colour. Drawback: vertices are copied along seams and rims. */
#include "view/skin.h"
#include "view/image.h"
#include <stdlib.h>
#include <string.h>

/* What a jump may be, in the usual change of coordinates along a face. */
static const double JUMP = 4;

typedef struct looking {
    const canvas *c;
    const surface_request *r;
    const vec *place, *rest;     /* of vertices: view space; what they differ from the map  */
    double (*at)[3];             /* m, of vertices at rest                                  */
    float (*uv)[2], *depth;
} looking;

/* Added to the squares of extents, as a part of their sum: thin groups have no map across. */
static const double THIN = 1e-3;

static void invert(const double m[3][3], double out[3][3])
{
    double c[3][3], det = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int p = (i + 1)%3, q = (i + 2)%3, r = (j + 1)%3, s = (j + 2)%3;
            c[i][j] = m[p][r]*m[q][s] - m[p][s]*m[q][r];
        }
    for (int j = 0; j < 3; j++) det += m[0][j]*c[0][j];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) out[i][j] = det > 0 ? c[j][i]/det : i == j;
}

void view_apply_map(const rest_map *m, const double x[3], double out[3])
{
    for (int a = 0; a < 3; a++) {
        out[a] = m->to[a];
        for (int b = 0; b < 3; b++) out[a] += m->by[a][b]*(x[b] - m->from[b]);
    }
}

/* Least squares: rest - x is fitted, so that what has no extent is not turned or stretched. */
void view_fit_rest(const double (*positions)[3], const double (*rest)[3], const int32_t *row, int64_t count,
                   rest_map *m, vec *off)
{
    double square[3][3] = { { 0 } }, mixed[3][3] = { { 0 } }, inverse[3][3];
    *m = (rest_map){ .by = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
    for (int64_t i = 0; i < count; i++)
        for (int a = 0; a < 3; a++) {
            m->from[a] += positions[row[i]][a]/(double)count;
            m->to[a] += rest[row[i]][a]/(double)count;
        }
    for (int64_t i = 0; i < count; i++) {
        const double *x = positions[row[i]], *r = rest[row[i]];
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) {
                const double xa = x[a] - m->from[a], xb = x[b] - m->from[b];
                square[a][b] += xa*xb;
                mixed[a][b] += (r[a] - m->to[a] - xa)*xb;
            }
    }
    const double extent = square[0][0] + square[1][1] + square[2][2];
    for (int a = 0; a < 3; a++) square[a][a] += THIN*extent + 1e-300;
    invert((const double (*)[3])square, inverse);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            for (int c = 0; c < 3; c++) m->by[a][b] += mixed[a][c]*inverse[c][b];
    for (int64_t i = 0; i < count; i++) {
        double at[3];
        const double *r = rest[row[i]];
        view_apply_map(m, positions[row[i]], at);
        off[row[i]] = (vec){ (float)(r[0] - at[0]), (float)(r[1] - at[1]), (float)(r[2] - at[2]) };
    }
}

static void look_range(const void *view, int64_t begin, int64_t end)
{
    const looking *l = view;
    const camera *c = &l->c->camera;
    const tobi_picture_skin *s = l->r->skin;
    for (int64_t i = begin; i < end; i++) {
        const vec p = l->place[i], rest = l->rest[i];
        double x[3], *at = l->at[i];
        for (int a = 0; a < 3; a++)
            x[a] = c->eye[a] + (double)p.x*c->right[a] + (double)p.y*c->up[a] + (double)p.z*c->forward[a];
        view_apply_map(l->r->map, x, at);
        at[0] += (double)rest.x, at[1] += (double)rest.y, at[2] += (double)rest.z;
        l->depth[i] = (float)s->look(s->user, at, l->uv[i]);
    }
}

static bool jumps(const tobi_picture_skin *skin, const double at[3][3], const float uv[3][2])
{
    for (int k = 0; k < 3; k++) {
        const double *p = at[k], *q = at[(k + 1)%3];
        const double way = fabs(p[0] - q[0]) + fabs(p[1] - q[1]) + fabs(p[2] - q[2]);
        const double most = JUMP*skin->stretch*way + 1e-4;
        for (int c = 0; c < 2; c++)
            if (!(fabs((double)uv[k][c] - (double)uv[(k + 1)%3][c]) <= most)) return true;
    }
    return false;
}

bool view_skin_face(const tobi_picture_skin *skin, const double at[3][3], const float depth[3],
                    float uv[3][2])
{
    if (!((depth[0] + depth[1] + depth[2])/3 <= (float)skin->depth)) return false;
    if (jumps(skin, at, (const float (*)[2])uv)) skin->look_flat(skin->user, at, uv);
    return true;
}

/* The colours, or marks of the image, of a face's corners. */
static void find_colors(const canvas *c, const looking *l, const int64_t v[3], vec out[3])
{
    const int number = l->r->skin_number;
    double at[3][3];
    float depth[3], uv[3][2];
    for (int k = 0; k < 3; k++) {
        memcpy(at[k], l->at[v[k]], sizeof at[k]);
        memcpy(uv[k], l->uv[v[k]], sizeof uv[k]);
        depth[k] = l->depth[v[k]];
    }
    const bool skin = view_skin_face(l->r->skin, (const double (*)[3])at, depth, uv);
    for (int k = 0; k < 3; k++) out[k] = skin ? image_mark(uv[k], number) : c->inside[number];
}

/* Gives a corner its colour; a vertex that has another one already is copied. */
static void set_corner(geometry *g, int32_t *corner, vec color, uint8_t *taken)
{
    vec *own = &g->color[*corner];
    if (!*taken) {
        *own = color;
        *taken = 1;
    } else if (own->x != color.x || own->y != color.y || own->z != color.z) {
        const int64_t to = g->vertices++;
        g->place[to] = g->place[*corner];
        g->normal[to] = g->normal[*corner];
        g->color[to] = color;
        *corner = (int32_t)to;
    }
}

bool view_put_skin(const canvas *c, const surface_request *r, geometry *g, int64_t vertex, int64_t face)
{
    const int64_t count = g->vertices - vertex;
    const size_t room = (size_t)count + 1;
    vec *rest = malloc(room*sizeof *rest);
    looking l = { c, r, NULL, rest, malloc(room*sizeof *l.at), malloc(room*sizeof *l.uv),
                  malloc(room*sizeof *l.depth) };
    uint8_t *taken = calloc((size_t)count + 1, 1);
    const bool enough = rest && l.at && l.uv && l.depth && taken &&
                        view_reserve(g, 3*(g->faces - face), 0, 0);
    if (enough) {
        memcpy(rest, g->color + vertex, (size_t)count*sizeof *rest);
        l.place = g->place + vertex;
        tobi_loop(c->threads, count, 0, look_range, &l);
    }
    for (int64_t f = face; enough && f < g->faces; f++) {
        const int64_t v[3] = { g->face[f][0] - vertex, g->face[f][1] - vertex, g->face[f][2] - vertex };
        vec colors[3];
        find_colors(c, &l, v, colors);
        for (int k = 0; k < 3; k++) set_corner(g, &g->face[f][k], colors[k], &taken[v[k]]);
    }
    free(rest);
    free(l.at);
    free(l.uv);
    free(l.depth);
    free(taken);
    return enough;
}

vec view_skin_color(const surface_request *r, int64_t particle)
{
    const tobi_picture_skin *s = r->skin;
    float uv[2];
    if (!(s->look(s->user, r->f->rest[particle], uv) <= s->depth)) return linear_color(s->inside);
    return image_color(s->image, 0, uv[0], uv[1]);
}

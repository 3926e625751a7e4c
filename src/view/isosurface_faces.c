/* The quick surface from cells to view space: normals, colours, and sharp edges at walls. Drawback: a
   vertex in a wall is kept twice. */
#include "view/isosurface.h"
#include <stdlib.h>
#include <string.h>

/* The mean colour of the particles around a vertex, from the nodes of its cell. */
static vec color_at(const grid *s, const float point[3], vec otherwise)
{
    float sum[4] = { 0, 0, 0, 0 }, t[3];
    int low[3];
    for (int k = 0; k < 3; k++) low[k] = (int)point[k], t[k] = point[k] - (float)low[k];
    for (int n = 0; n < 8; n++) {
        const int at[3] = { low[0] + (n & 1), low[1] + (n >> 1 & 1), low[2] + (n >> 2) };
        const int32_t b = *block_at(s, at[0]/BLOCK_EDGE, at[1]/BLOCK_EDGE, at[2]/BLOCK_EDGE);
        if (b < 0 || s->colored[b] < 0) continue;
        const int in = (at[2]%BLOCK_EDGE*BLOCK_EDGE + at[1]%BLOCK_EDGE)*BLOCK_EDGE + at[0]%BLOCK_EDGE;
        const float share = (n & 1 ? t[0] : 1 - t[0])*(n & 2 ? t[1] : 1 - t[1])*(n & 4 ? t[2] : 1 - t[2]);
        const float *color = s->colors + 4*((int64_t)s->colored[b]*BLOCK_NODES + in);
        for (int k = 0; k < 4; k++) sum[k] += share*color[k];
    }
    return sum[3] > 0 ? (vec){ sum[0]/sum[3], sum[1]/sum[3], sum[2]/sum[3] } : otherwise;
}

/* The wall that a quad lies in: its axis, or -1. */
static int find_wall(const grid *s, const int32_t corner[4])
{
    for (int k = 0; k < 3; k++) {
        int in = 0;
        for (int n = 0; n < 4; n++)
            in += (s->locked[corner[n]] >> k & 1) && s->point[corner[n]][k] == s->point[corner[0]][k];
        if (in == 4) return k;
    }
    return -1;
}

/* A vertex again, for faces in a wall: the surface is sharp there. */
static int32_t copy_to_wall(geometry *g, int32_t (*copy)[3], int64_t first, int32_t corner, int axis,
                            vec normal)
{
    int32_t *to = &copy[corner][axis];
    if (*to < 0) {
        *to = (int32_t)g->vertices++;
        g->place[*to] = g->place[first + corner];
        g->color[*to] = g->color[first + corner];
        g->normal[*to] = normal;
    }
    return *to;
}

static void add_vertices(const grid *s, const surface_request *r, geometry *g)
{
    const camera *c = &s->c->camera;
    const vec base = view_point(c, s->low);
    vec axis[3];
    for (int k = 0; k < 3; k++)
        axis[k] = vec_scale((float)s->edge, (vec){ (float)c->right[k], (float)c->up[k],
                                                   (float)c->forward[k] });
    for (int64_t v = 0; v < s->vertex[s->blocks]; v++) {
        const float *p = s->point[v];
        const int64_t i = g->vertices++;
        g->place[i] = vec_add(vec_add(base, vec_scale(p[0], axis[0])),
                              vec_add(vec_scale(p[1], axis[1]), vec_scale(p[2], axis[2])));
        g->normal[i] = (vec){ 0, 0, 0 };
        g->color[i] = r->color ? color_at(s, p, r->plain) : r->plain;
    }
}

/* Where a value lies between those of two corners, or -1. */
static float find_level(float a, float b, float level)
{
    return (a < level) != (b < level) ? (level - a)/(b - a) : -1;
}

/* The lines of equal value in a face whose corners have the values t; false: no memory. */
static bool add_isolines(const geometry *g, const int32_t face[3], int levels, segments *out)
{
    const float t[3] = { g->color[face[0]].x, g->color[face[1]].x, g->color[face[2]].x };
    for (int n = 1; n <= levels; n++) {
        const float level = (float)n/(float)(levels + 1);
        vec end[3];
        int ends = 0;
        for (int k = 0; k < 3; k++) {
            const float at = find_level(t[k], t[(k + 1)%3], level);
            if (at >= 0) end[ends++] = vec_mix(g->place[face[k]], g->place[face[(k + 1)%3]], at);
        }
        if (ends != 2) continue;
        if (!view_add_segment(out, end[0], end[1])) return false;
    }
    return true;
}

/* Values become colours, after the lines between them were found. */
static bool apply_scale(const surface_request *r, geometry *g, int64_t vertex, int64_t face)
{
    const int levels = r->isolines ? r->f->isolines : 0;
    for (int64_t k = face; k < g->faces && levels > 0; k++)
        if (!add_isolines(g, g->face[k], levels, r->isolines)) return false;
    for (int64_t v = vertex; v < g->vertices; v++) g->color[v] = view_scaled(r->scale, g->color[v].x);
    return true;
}

/* From cells to view space, with normals from the faces around. */
bool view_add_faces(const grid *s, const surface_request *r, geometry *g)
{
    const int64_t vertices = s->vertex[s->blocks], quads = s->quad[s->blocks], first = g->vertices;
    const int64_t first_face = g->faces;
    int32_t (*copy)[3] = malloc(((size_t)vertices + 1)*sizeof *copy);
    if (!copy || !view_reserve(g, 4*vertices, 2*quads, 0)) {
        free(copy);
        return false;
    }
    memset(copy, -1, (size_t)vertices*sizeof *copy);
    add_vertices(s, r, g);
    for (int64_t q = 0; q < quads; q++) {
        const int32_t *corner = s->corner[q];
        const int wall = find_wall(s, corner);
        int32_t i[4];
        for (int k = 0; k < 4; k++) i[k] = (int32_t)(first + corner[k]);
        const vec *p = g->place, a = vec_sub(p[i[2]], p[i[0]]), b = vec_sub(p[i[3]], p[i[1]]);
        const vec n = vec_cross(a, b);
        const int from = vec_dot(a, a) <= vec_dot(b, b) ? 0 : 1;      /* the shorter diagonal parts it */
        for (int k = 0; k < 4; k++) {
            if (wall < 0) g->normal[i[k]] = vec_add(g->normal[i[k]], n);
            else i[k] = copy_to_wall(g, copy, first, corner[k], wall, vec_unit(n));
        }
        for (int t = 0; t < 2; t++) {
            int32_t *face = g->face[g->faces++];
            face[0] = i[from], face[1] = i[(from + 1 + t) & 3], face[2] = i[(from + 2 + t) & 3];
        }
    }
    free(copy);
    for (int64_t v = first; v < first + vertices; v++) g->normal[v] = vec_unit(g->normal[v]);
    if (r->skin) return view_put_skin(s->c, r, g, first, first_face);
    return !r->scale || apply_scale(r, g, first, first_face);
}

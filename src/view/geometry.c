/* Triangles and balls in view space, from the meshes of bodies. Corners get the mean normal of their
   vertex where the surface is smooth there, and the triangle's own at edges and in faces of 2-D bodies, so
   that balls are round and boxes sharp. Drawback: the vertices of bodies are kept once for each triangle. */
#include "view/image.h"
#include <stdlib.h>

static bool grow_vertices(geometry *g, int64_t room)
{
    vec *place = realloc(g->place, (size_t)room*sizeof *place);
    if (place) g->place = place;
    vec *normal = realloc(g->normal, (size_t)room*sizeof *normal);
    if (normal) g->normal = normal;
    vec *color = realloc(g->color, (size_t)room*sizeof *color);
    if (color) g->color = color;
    spot *at = realloc(g->at, (size_t)room*sizeof *at);
    if (at) g->at = at;
    if (place && normal && color && at) g->vertex_room = room;
    return place && normal && color && at;
}

bool view_reserve(geometry *g, int64_t vertices, int64_t faces, int64_t balls)
{
    vertices += g->vertices, faces += g->faces, balls += g->ball_count;
    if (vertices > g->vertex_room && !grow_vertices(g, vertices + g->vertices/2 + 16)) return false;
    if (faces > g->face_room) {
        const int64_t room = faces + g->faces/2 + 16;
        int32_t (*longer)[3] = realloc(g->face, (size_t)room*sizeof *longer);
        if (!longer) return false;
        g->face = longer, g->face_room = room;
    }
    if (balls > g->ball_room) {
        const int64_t room = balls + 16;
        ball *longer = realloc(g->balls, (size_t)room*sizeof *longer);
        if (!longer) return false;
        g->balls = longer, g->ball_room = room;
    }
    return true;
}

void view_geometry_free(geometry *g)
{
    free(g->place);
    free(g->normal);
    free(g->color);
    free(g->at);
    free(g->face);
    free(g->balls);
    *g = (geometry){ 0 };
}

/* Vertex normals, weighted as Max (1999) does it: exact on spheres. */
static vec *make_normals(const tobi_picture_mesh *m, const vec *p)
{
    vec *normal = calloc((size_t)m->vertex_count + 1, sizeof *normal);
    if (!normal) return NULL;
    for (int64_t t = 0; t < m->triangle_count; t++) {
        const int32_t *v = m->triangles[t];
        for (int k = 0; k < 3; k++) {
            vec a = vec_sub(p[v[(k + 1)%3]], p[v[k]]), b = vec_sub(p[v[(k + 2)%3]], p[v[k]]);
            float square = vec_dot(a, a)*vec_dot(b, b);
            if (square > 0) normal[v[k]] = vec_add(normal[v[k]], vec_scale(1/square, vec_cross(a, b)));
        }
    }
    for (int64_t i = 0; i < m->vertex_count; i++) normal[i] = vec_unit(normal[i]);
    return normal;
}

bool view_add_mesh(geometry *g, const canvas *c, const tobi_picture_mesh *m, int number, bool fills,
                   float depth)
{
    const float smooth = 0.8f;      /* cosine between a corner's mean normal and the triangle's */
    const int64_t room = c->cut.count ? CUT_CORNERS : 3;
    cut cut = c->cut;
    if (cut.faced && fills) {       /* the other plane is looked at when it is drawn */
        cut.normal[0] = cut.normal[cut.faced - 1], cut.offset[0] = cut.offset[cut.faced - 1];
        cut.count = 1;
    }
    vec *p = malloc(((size_t)m->vertex_count + 1)*sizeof *p), *normal = NULL, color = linear_color(m->color);
    for (int64_t i = 0; p && i < m->vertex_count; i++) p[i] = view_point(&c->camera, m->vertices[i]);
    if (p) normal = make_normals(m, p);
    const bool enough = normal && view_reserve(g, room*m->triangle_count, room*m->triangle_count, 0);
    for (int64_t t = 0; enough && t < m->triangle_count; t++) {
        const int32_t *v = m->triangles[t];
        const vec place[3] = { p[v[0]], p[v[1]], p[v[2]] };
        const vec sum = vec_add(vec_add(place[0], place[1]), place[2]);
        if (!(fabsf(sum.x) + fabsf(sum.y) + fabsf(sum.z) < INFINITY)) continue;
        vec face = vec_unit(vec_cross(vec_sub(place[1], place[0]), vec_sub(place[2], place[0]))), n[3];
        const bool cap = c->camera.orthographic && fabsf(face.z) > 0.9999f;      /* of a 2-D body: flat */
        for (int k = 0; k < 3; k++)
            n[k] = vec_scale(depth, !cap && vec_dot(face, normal[v[k]]) > smooth ? normal[v[k]] : face);
        vec colors[3] = { color, color, color };
        for (int k = 0; k < 3 && number >= 0; k++) colors[k] = image_mark(m->uv[t][k], number);
        view_add_triangle(g, &cut, place, n, colors);
    }
    free(p);
    free(normal);
    return enough;
}

bool view_cross_triangle(const tobi_picture_mesh *m, const int32_t v[3], double end[2][3])
{
    int count = 0;
    for (int k = 0; k < 3 && count < 2; k++) {
        const double *a = m->vertices[v[k]], *b = m->vertices[v[(k + 1)%3]];
        if ((a[2] < 0) == (b[2] < 0)) continue;
        const double t = a[2]/(a[2] - b[2]);
        const int place = a[2] < 0;
        for (int c = 0; c < 3; c++) end[place][c] = c < 2 ? (1 - t)*a[c] + t*b[c] : 0;
        count++;
    }
    return count == 2 && isfinite(end[0][0] + end[0][1] + end[1][0] + end[1][1]);
}

bool view_add_outline(geometry *g, const canvas *c, const tobi_picture_mesh *m, float width)
{
    const vec color = linear_color(m->color), to_eye = { 0, 0, -1 };
    const vec normal[3] = { to_eye, to_eye, to_eye }, colors[3] = { color, color, color };
    if (!view_reserve(g, 6*m->triangle_count, 2*m->triangle_count, 0)) return false;
    for (int64_t t = 0; t < m->triangle_count; t++) {
        double end[2][3];
        if (!view_cross_triangle(m, m->triangles[t], end)) continue;
        const vec a = view_point(&c->camera, end[0]), b = view_point(&c->camera, end[1]);
        const vec along = vec_scale(0.5f*width, vec_unit(vec_sub(b, a))), across = { -along.y, along.x, 0 };
        const vec low = vec_sub(a, along), high = vec_add(b, along);      /* they join at corners */
        const vec q[4] = { vec_sub(low, across), vec_sub(high, across), vec_add(high, across),
                           vec_add(low, across) };
        view_add_triangle(g, &c->cut, (vec[3]){ q[0], q[1], q[2] }, normal, colors);
        view_add_triangle(g, &c->cut, (vec[3]){ q[0], q[2], q[3] }, normal, colors);
    }
    return true;
}

static int64_t add_vertex(geometry *g, int64_t a, int64_t b, float t)
{
    const int64_t i = g->vertices++;
    g->place[i] = vec_mix(g->place[a], g->place[b], t);
    g->normal[i] = vec_mix(g->normal[a], g->normal[b], t);
    g->color[i] = vec_mix(g->color[a], g->color[b], t);
    return i;
}

/* A face that reaches nearer than `near` becomes 0, 1 or 2; face f is overwritten by the first. */
static void cut_face(geometry *g, int64_t f, float near, bool *gone)
{
    int64_t kept[4];
    int n = 0;
    const int32_t v[3] = { g->face[f][0], g->face[f][1], g->face[f][2] };
    for (int k = 0; k < 3; k++) {
        const int32_t a = v[k], b = v[(k + 1)%3];
        const float za = g->place[a].z, zb = g->place[b].z;
        if (za >= near) kept[n++] = a;
        if ((za >= near) != (zb >= near)) kept[n++] = add_vertex(g, a, b, (near - za)/(zb - za));
    }
    *gone = n < 3;
    for (int k = 0; k < 3 && n >= 3; k++) g->face[f][k] = (int32_t)kept[k];
    if (n == 4) {
        for (int k = 0; k < 3; k++) g->face[g->faces][k] = (int32_t)kept[k ? k + 1 : 0];
        g->faces++;
    }
}

typedef struct projection { geometry *g; const camera *c; } projection;

static void project_vertices(const void *view, int64_t begin, int64_t end)
{
    const projection *p = view;
    for (int64_t i = begin; i < end; i++) p->g->at[i] = project(p->c, p->g->place[i]);
}

static bool is_cut(const geometry *g, int64_t f, float near)
{
    const int32_t *v = g->face[f];
    return !(g->place[v[0]].z >= near && g->place[v[1]].z >= near && g->place[v[2]].z >= near);
}

tobi_status view_project(geometry *g, const camera *c, int threads, tobi_error *err)
{
    int64_t cut = 0, faces = g->faces, filled = g->filled, kept = 0;
    for (int64_t f = 0; f < faces && c->near > -INFINITY; f++) cut += is_cut(g, f, c->near);
    if (cut && !view_reserve(g, 2*cut, cut, 0)) return tobi_fail(err, TOBI_NO_MEMORY,
                                                                 "no memory for a picture");
    if (cut) {
        for (int64_t f = 0; f < faces; f++) {
            bool gone = false;
            if (is_cut(g, f, c->near)) cut_face(g, f, c->near, &gone);
            if (gone) g->face[f][0] = -1;
        }
        for (int64_t f = 0; f < g->faces; f++) {
            if (f == filled) g->filled = kept;
            if (g->face[f][0] < 0) continue;
            for (int k = 0; k < 3; k++) g->face[kept][k] = g->face[f][k];
            kept++;
        }
        g->faces = kept;
    }
    const projection p = { g, c };
    tobi_loop(threads, g->vertices, 0, project_vertices, &p);
    return TOBI_OK;
}

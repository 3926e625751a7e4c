/* The arrays that the caller gets: metres, and a small sphere for each drop. Drawback: an icosahedron is a
   coarse sphere. */
#include "view/surface/surface.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GOLDEN 1.6180339887498949f
enum { BALL_VERTICES = 12, BALL_TRIANGLES = 20 };
static const float ball_vertex[BALL_VERTICES][3] = {
    { -1, GOLDEN, 0 }, { 1, GOLDEN, 0 }, { -1, -GOLDEN, 0 }, { 1, -GOLDEN, 0 },
    { 0, -1, GOLDEN }, { 0, 1, GOLDEN }, { 0, -1, -GOLDEN }, { 0, 1, -GOLDEN },
    { GOLDEN, 0, -1 }, { GOLDEN, 0, 1 }, { -GOLDEN, 0, -1 }, { -GOLDEN, 0, 1 },
};
static const uint8_t ball_triangle[BALL_TRIANGLES][3] = {
    { 0, 11, 5 }, { 0, 5, 1 }, { 0, 1, 7 }, { 0, 7, 10 }, { 0, 10, 11 }, { 1, 5, 9 }, { 5, 11, 4 },
    { 11, 10, 2 }, { 10, 7, 6 }, { 7, 1, 8 }, { 3, 9, 4 }, { 3, 4, 2 },
    { 3, 2, 6 }, { 3, 6, 8 }, { 3, 8, 9 },
    { 4, 9, 5 }, { 2, 4, 11 }, { 6, 2, 10 }, { 8, 6, 7 }, { 9, 8, 1 },
};

static void copy_vertices(const surface_work *w, tobi_surface *s)
{
    const tobi_surface_def *d = w->def;
    int32_t place[3];
    for (int64_t i = 0; i < w->vertices; i++) {
        const float *p = &w->vertex[i].x, *n = &w->normal[i].x;
        s->sides[i] = (uint8_t)(w->sides[i] & ~SURFACE_WITHIN);
        s->group[i] = (int32_t)surface_place(&w->view, w->block_of[i], place);
        for (int a = 0; a < 3; a++) {
            s->normals[i][a] = n[a];
            s->vertices[i][a] = s->sides[i] >> a & 1 ? d->box_min[a] : s->sides[i] >> a & 8 ? d->box_max[a]
                              : w->origin[a] + w->radius*(double)p[a];
        }
    }
}

/* A drop of the volume of a particle, within the flat sides. */
static void add_drop(const surface_work *w, int64_t k, double radius, tobi_surface *s)
{
    const tobi_surface_def *d = w->def;
    const int32_t particle = w->drop[k];
    const int64_t first = w->vertices + k*BALL_VERTICES;
    const float one = 1/sqrtf(1 + GOLDEN*GOLDEN);
    double middle[3];
    for (int a = 0; a < 3; a++) {
        middle[a] = d->positions[particle][a];
        if (d->flat_min[a]) middle[a] = fmax(middle[a], d->box_min[a] + radius);
        if (d->flat_max[a]) middle[a] = fmin(middle[a], d->box_max[a] - radius);
    }
    for (int64_t i = 0; i < BALL_VERTICES; i++) {
        for (int a = 0; a < 3; a++) {
            s->normals[first + i][a] = one*ball_vertex[i][a];
            s->vertices[first + i][a] = middle[a] + radius*(double)s->normals[first + i][a];
        }
        s->sides[first + i] = 0;
        s->group[first + i] = d->group ? d->group[particle] : 0;
        for (int f = 0; f < d->field_count; f++)
            for (int c = 0, n = d->fields[f].components; c < n; c++)
                s->fields[f][(first + i)*n + c] = (float)d->fields[f].values[(int64_t)particle*n + c];
    }
    int32_t (*to)[3] = s->triangles + w->triangles + k*BALL_TRIANGLES;
    for (int t = 0; t < BALL_TRIANGLES; t++)
        for (int q = 0; q < 3; q++) to[t][q] = (int32_t)(first + ball_triangle[t][q]);
}

tobi_status surface_make_result(surface_work *w, tobi_surface **surface, tobi_error *err)
{
    const int64_t n = w->vertices + w->drops*BALL_VERTICES, m = w->triangles + w->drops*BALL_TRIANGLES;
    tobi_surface *s = calloc(1, sizeof *s);
    if (!s || n > INT32_MAX) {
        free(s);
        return surface_no_memory(err, 53.0*(double)n + 12.0*(double)m);
    }
    s->vertex_count = n;
    s->triangle_count = m;
    s->field_count = w->def->field_count;
    s->vertices = tobi_array_make(n + 1, sizeof *s->vertices);
    s->normals = tobi_array_make(n + 1, sizeof *s->normals);
    s->triangles = tobi_array_make(m + 1, sizeof *s->triangles);
    s->group = tobi_array_make(n + 1, sizeof *s->group);
    s->sides = tobi_array_make(n + 1, sizeof *s->sides);
    if (!s->vertices || !s->normals || !s->triangles || !s->group || !s->sides) {
        tobi_surface_free(s);
        return surface_no_memory(err, 53.0*(double)n + 12.0*(double)m);
    }
    for (int f = 0; f < w->def->field_count; f++) {
        const tobi_surface_field *field = &w->def->fields[f];
        snprintf(s->field_names[f], sizeof s->field_names[f], "%s", field->name ? field->name : "field");
        s->field_components[f] = field->components;
        s->fields[f] = w->fields[f];
        w->fields[f] = NULL;
    }
    copy_vertices(w, s);
    memcpy(s->triangles, w->triangle, (size_t)w->triangles*sizeof *s->triangles);
    /* the volume of an icosahedron of circumradius r is 2.5361507 r^3 */
    const double radius = w->def->spacing*0.7332983;
    for (int64_t k = 0; k < w->drops; k++) add_drop(w, k, radius, s);
    *surface = s;
    return TOBI_OK;
}

void tobi_surface_free(tobi_surface *s)
{
    if (!s) return;
    tobi_array_free(s->vertices);
    tobi_array_free(s->normals);
    tobi_array_free(s->triangles);
    tobi_array_free(s->group);
    tobi_array_free(s->sides);
    for (int f = 0; f < TOBI_SURFACE_FIELD_LIMIT; f++) tobi_array_free(s->fields[f]);
    free(s->skin);
    free(s->uv);
    free(s);
}

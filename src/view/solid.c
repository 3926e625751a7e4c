/* Bodies, floor and box lines. Triangles are clipped at the near plane, sorted into tiles and filled by
   edge functions; depth is linear in 1/z. Corners get the mean normal of their vertex where the surface is
   smooth there, and the triangle's own at edges, so that balls are round and boxes sharp. */
#include "view/draw.h"
#include <stdlib.h>

typedef struct corner {
    vec p, n;         /* view space */
} corner;

typedef struct triangle {
    spot at[3];
    vec  n[3];
    vec  color;       /* linear albedo */
} triangle;

typedef struct triangle_list {
    triangle *item;
    int64_t   count, room;
} triangle_list;

/* Light from above and from around, without a lamp. */
vec view_sky_color(const canvas *c, vec direction)
{
    float t = clampf(0.5f + 0.5f*vec_dot(direction, c->sky_up), 0, 1);
    vec ground = {0.30f, 0.29f, 0.27f}, horizon = {0.88f, 0.92f, 0.95f},
        zenith = {0.42f, 0.58f, 0.78f};
    if (t < 0.5f) return vec_mix(ground, horizon, clampf(t*2.2f - 0.1f, 0, 1));
    return vec_mix(horizon, zenith, 2*t - 1);
}

vec view_shade_solid(const canvas *c, vec p, vec n, vec albedo)
{
    vec eye = to_eye(&c->camera, p);
    if (vec_dot(n, eye) < 0) n = vec_scale(-1, n);
    float lit = view_lit_at(c, vec_add(p, vec_scale(2/c->shadow.focal, n)));
    float lambert = lit*fmaxf(vec_dot(n, c->light), 0), fill = 0.5f + 0.5f*vec_dot(n, c->sky_up);
    vec half = vec_unit(vec_add(c->light, eye));
    float shine = lit*0.22f*powf(fmaxf(vec_dot(n, half), 0), 48);
    float rim = powf(1 - fmaxf(vec_dot(n, eye), 0), 4);
    vec ambient = vec_mix((vec){ 0.20f, 0.19f, 0.19f }, (vec){ 0.42f, 0.46f, 0.52f }, fill);
    vec light = vec_add(ambient, vec_scale(0.85f*lambert, (vec){ 1, 0.97f, 0.92f }));
    vec color = vec_add(vec_mul(albedo, light), (vec){ shine, shine, shine });
    return vec_add(color, vec_scale(0.10f*rim, view_sky_color(c, n)));
}

static bool triangle_rect(const void *items, int64_t i, int rect[4])
{
    const spot *a = ((const triangle *)items)[i].at;
    float x0 = fminf(a[0].x, fminf(a[1].x, a[2].x)), x1 = fmaxf(a[0].x, fmaxf(a[1].x, a[2].x));
    float y0 = fminf(a[0].y, fminf(a[1].y, a[2].y)), y1 = fmaxf(a[0].y, fmaxf(a[1].y, a[2].y));
    if (!(x1 > -1e6f && y1 > -1e6f && x0 < 1e6f && y0 < 1e6f)) return false;    /* also NaN */
    rect[0] = (int)fmaxf(floorf(x0), -1e6f), rect[1] = (int)fmaxf(floorf(y0), -1e6f);
    rect[2] = (int)fminf(ceilf(x1), 1e6f), rect[3] = (int)fminf(ceilf(y1), 1e6f);
    return true;
}

static void fill_triangle(canvas *c, const triangle *t, const int tile[4])
{
    const spot *a = t->at;
    float area = (a[1].x - a[0].x)*(a[2].y - a[0].y) - (a[2].x - a[0].x)*(a[1].y - a[0].y);
    int r[4];
    if (!(fabsf(area) > 1e-9f) || !triangle_rect(t, 0, r)) return;
    for (int k = 0; k < 2; k++) {
        if (r[k] < tile[k]) r[k] = tile[k];
        if (r[k + 2] > tile[k + 2]) r[k + 2] = tile[k + 2];
    }
    bool flat = c->camera.orthographic;
    float w[3] = { flat ? 1 : 1/a[0].z, flat ? 1 : 1/a[1].z, flat ? 1 : 1/a[2].z };
    for (int y = r[1]; y <= r[3]; y++)
        for (int x = r[0]; x <= r[2]; x++) {
            float px = (float)x + 0.5f, py = (float)y + 0.5f, b[3];
            for (int k = 0; k < 3; k++) {
                const spot *u = &a[(k + 1)%3], *v = &a[(k + 2)%3];
                b[k] = ((u->x - px)*(v->y - py) - (v->x - px)*(u->y - py))/area;
            }
            if (b[0] < 0 || b[1] < 0 || b[2] < 0) continue;
            float sum = b[0]*w[0] + b[1]*w[1] + b[2]*w[2];
            float z = (b[0]*w[0]*a[0].z + b[1]*w[1]*a[1].z + b[2]*w[2]*a[2].z)/sum;
            size_t k = (size_t)y*(size_t)c->width + (size_t)x;
            if (!(z < c->depth[k])) continue;
            c->depth[k] = z;
            if (!c->color) continue;
            vec n = vec_unit(vec_add(vec_add(vec_scale(b[0]*w[0], t->n[0]), vec_scale(b[1]*w[1], t->n[1])),
                                     vec_scale(b[2]*w[2], t->n[2])));
            c->color[k] = view_shade_solid(c, unproject(&c->camera, px, py, z), n, t->color);
        }
}

/* Angle-weighted vertex normals in view space (Thuermer & Wuethrich 1998). */
static vec *make_normals(const tobi_picture_mesh *m, const vec *p)
{
    vec *normal = calloc((size_t)m->vertex_count + 1, sizeof *normal);
    if (!normal) return NULL;
    for (int64_t t = 0; t < m->triangle_count; t++) {
        const int32_t *v = m->triangles[t];
        vec face = vec_unit(vec_cross(vec_sub(p[v[1]], p[v[0]]), vec_sub(p[v[2]], p[v[0]])));
        for (int k = 0; k < 3; k++) {
            vec a = vec_unit(vec_sub(p[v[(k + 1)%3]], p[v[k]]));
            vec b = vec_unit(vec_sub(p[v[(k + 2)%3]], p[v[k]]));
            float angle = acosf(clampf(vec_dot(a, b), -1, 1));
            normal[v[k]] = vec_add(normal[v[k]], vec_scale(angle, face));
        }
    }
    for (int64_t i = 0; i < m->vertex_count; i++) normal[i] = vec_unit(normal[i]);
    return normal;
}

static void add_triangle(const canvas *c, triangle_list *list, const corner a[3], vec color)
{
    if (list->count == list->room) return;
    triangle *t = &list->item[list->count++];
    t->color = color;
    for (int k = 0; k < 3; k++) {
        t->at[k] = project(&c->camera, a[k].p);
        t->n[k] = a[k].n;
    }
}

/* Cuts a triangle at the near plane and adds what is in front of it: 0, 1 or 2 triangles. */
static void clip_triangle(const canvas *c, triangle_list *list, const corner a[3], vec color)
{
    corner kept[4];
    int n = 0;
    float near = c->camera.near;
    for (int k = 0; k < 3; k++) {
        const corner *u = &a[k], *v = &a[(k + 1)%3];
        if (u->p.z >= near) kept[n++] = *u;
        if ((u->p.z >= near) != (v->p.z >= near)) {
            float t = (near - u->p.z)/(v->p.z - u->p.z);
            kept[n++] = (corner){ vec_mix(u->p, v->p, t), vec_mix(u->n, v->n, t) };
        }
    }
    if (n >= 3) add_triangle(c, list, kept, color);
    if (n == 4) add_triangle(c, list, (corner[3]){ kept[0], kept[2], kept[3] }, color);
}

static bool add_mesh(const canvas *c, triangle_list *list, const tobi_picture_mesh *m)
{
    const float smooth = 0.8f;      /* cosine between a corner's mean normal and the triangle's */
    vec *p = malloc(((size_t)m->vertex_count + 1)*sizeof *p);
    if (!p) return false;
    for (int64_t i = 0; i < m->vertex_count; i++) p[i] = view_point(&c->camera, m->vertices[i]);
    vec *normal = make_normals(m, p), color = linear_color(m->color);
    for (int64_t t = 0; normal && t < m->triangle_count; t++) {
        const int32_t *v = m->triangles[t];
        vec face = vec_unit(vec_cross(vec_sub(p[v[1]], p[v[0]]), vec_sub(p[v[2]], p[v[0]])));
        corner a[3];
        for (int k = 0; k < 3; k++)
            a[k] = (corner){ p[v[k]], vec_dot(face, normal[v[k]]) > smooth ? normal[v[k]] : face };
        clip_triangle(c, list, a, color);
    }
    free(p);
    free(normal);
    return normal != NULL;
}

typedef struct filling { canvas *c; const tiles *t; const triangle_list *list; } filling;

static void fill_tiles(const void *view, int64_t begin, int64_t end)
{
    const filling *f = view;
    const tiles *t = f->t;
    for (int64_t k = begin; k < end; k++) {
        int rect[4];
        view_tiles_rect(t, f->c, k, rect);
        for (int64_t i = t->first[k]; i < t->first[k + 1]; i++)
            fill_triangle(f->c, &f->list->item[t->item[i]], rect);
    }
}

tobi_status view_draw_meshes(canvas *c, const tobi_picture *frame, tobi_error *err)
{
    triangle_list list = { 0 };
    for (int i = 0; i < frame->mesh_count; i++) list.room += 2*frame->meshes[i].triangle_count;
    list.item = malloc((size_t)(list.room + 1)*sizeof *list.item);
    bool enough = list.item != NULL;
    for (int i = 0; i < frame->mesh_count && enough; i++) enough = add_mesh(c, &list, &frame->meshes[i]);
    tiles t;
    tobi_status status = enough ? view_tiles_build(&t, c, list.count, list.item, triangle_rect, err)
                                : tobi_fail(err, TOBI_NO_MEMORY, "no memory for a picture");
    if (status == TOBI_OK) {
        const filling view = { c, &t, &list };
        tobi_loop(0, (int64_t)t.across*t.down, 1, fill_tiles, &view);
        view_tiles_free(&t);
    }
    free(list.item);
    return status;
}

/* How a line or the floor shows at a sample: over what is opaque, and through the water by its light. */
static void blend(canvas *c, int x, int y, float z, vec color, float alpha)
{
    size_t k = (size_t)y*(size_t)c->width + (size_t)x;
    if (!(z <= c->depth[k])) return;
    if (c->surface && z > c->surface[k]) alpha *= c->value[k];
    c->color[k] = vec_mix(c->color[k], color, alpha);
}

/* A line of a width in samples with soft edges, walked along its longer axis. */
static void draw_line(canvas *c, const double from[3], const double to[3], float width, vec color,
                      float alpha)
{
    vec p = view_point(&c->camera, from), q = view_point(&c->camera, to);
    float near = c->camera.near;
    if (p.z < near && q.z < near) return;
    if (p.z < near) p = vec_mix(p, q, (near - p.z)/(q.z - p.z));
    if (q.z < near) q = vec_mix(q, p, (near - q.z)/(p.z - q.z));
    spot a = project(&c->camera, p), b = project(&c->camera, q);
    float dx = b.x - a.x, dy = b.y - a.y, length = sqrtf(dx*dx + dy*dy);
    if (!(length > 0.01f) || length > 1e6f) return;
    bool steep = fabsf(dy) > fabsf(dx);
    float reach = 0.5f*width + 1, across = (steep ? fabsf(dy) : fabsf(dx))/length;
    float low = steep ? fminf(a.y, b.y) : fminf(a.x, b.x), high = steep ? fmaxf(a.y, b.y) : fmaxf(a.x, b.x);
    int limit = steep ? c->height : c->width, side = steep ? c->width : c->height;
    int begin = (int)clampf(low - reach, 0, (float)limit), end = (int)clampf(high + reach, 0, (float)limit);
    bool flat = c->camera.orthographic;
    for (int m = begin; m < end; m++) {
        float t = ((float)m + 0.5f - (steep ? a.y : a.x))/(steep ? dy : dx), s = clampf(t, 0, 1);
        float z = flat ? a.z : 1/((1 - s)/a.z + s/b.z), middle = steep ? a.x + t*dx : a.y + t*dy;
        if (!(fabsf(middle) < 1e6f)) continue;
        for (int o = (int)floorf(middle - reach/across); o <= (int)ceilf(middle + reach/across); o++) {
            if (o < 0 || o >= side) continue;
            float off = fabsf((float)o + 0.5f - middle) * across,
                  cover = clampf(0.5f * width + 0.5f - off, 0, 1);
            float over = fmaxf(t*length - length, -t*length);      /* beyond the ends */
            cover *= clampf(0.5f*width + 0.5f - over, 0, 1);
            if (cover > 0) blend(c, steep ? o : m, steep ? m : o, z*0.9995f, color, alpha*cover);
        }
    }
}

static double grid_step(double size)
{
    double step = pow(10, floor(log10(size/4)));
    return size/step > 40 ? 5*step : size/step > 16 ? 2*step : step;
}

/* The side of the box that faces down: the axis nearest to up. Returns the axis; *level is its
 * coordinate. */
static int find_floor(const tobi_picture *f, double *level)
{
    int axis = 2;
    if (f->up[0] != 0 || f->up[1] != 0 || f->up[2] != 0)
        for (int k = 0; k < 3; k++)
            if (fabs(f->up[k]) > fabs(f->up[axis])) axis = k;
    *level = f->up[axis] < 0 ? f->box_max[axis] : f->box_min[axis];
    return axis;
}

/* The floor's brightness where the ray through a sample meets it: the bodies' shadow. */
static vec floor_tint(const canvas *c, float x, float y, const corner *plane)
{
    vec tint = { 0.80f, 0.82f, 0.83f }, ray = unproject(&c->camera, x, y, 1);
    if (c->camera.orthographic) return tint;
    float t = vec_dot(plane->p, plane->n)/vec_dot(ray, plane->n);
    return vec_scale(0.45f + 0.55f*view_lit_at(c, vec_scale(t, ray)), tint);
}

typedef struct flooring { canvas *c; spot s[4]; corner plane; } flooring;

static void fill_floor_rows(const void *view, int64_t begin, int64_t end)
{
    const flooring *f = view;
    canvas *c = f->c;
    for (int y = (int)begin; y < end; y++)
        for (int x = 0; x < c->width; x++) {
            float px = (float)x + 0.5f, py = (float)y + 0.5f;
            int left = 0;
            for (int i = 0; i < 4; i++) {
                const spot *a = &f->s[i], *b = &f->s[(i + 1)%4];
                left += (b->x - a->x)*(py - a->y) - (b->y - a->y)*(px - a->x) > 0;
            }
            if (left == 0 || left == 4) blend(c, x, y, -INFINITY, floor_tint(c, px, py, &f->plane), 0.6f);
        }
}

/* Fills the quadrangle of the four view points. */
static void fill_floor(canvas *c, const vec p[4])
{
    flooring view = { .c = c,
                      .plane = { p[0], vec_unit(vec_cross(vec_sub(p[1], p[0]), vec_sub(p[3], p[0]))) } };
    for (int i = 0; i < 4; i++) view.s[i] = project(&c->camera, p[i]);
    tobi_loop(0, c->height, 0, fill_floor_rows, &view);
}

/* Lines on the floor at round coordinates: across[0] and across[1] are its axes. */
static void draw_grid(canvas *c, const tobi_picture *f, int axis, double level, const int across[2])
{
    const vec mark = { 0.40f, 0.44f, 0.48f };
    double size = 0;
    for (int k = 0; k < 2; k++) size = fmax(size, f->box_max[across[k]] - f->box_min[across[k]]);
    double step = grid_step(size);
    for (int way = 0; way < 2; way++) {
        int fixed = across[way], along = across[1 - way];
        double start = ceil(f->box_min[fixed]/step)*step;
        for (int i = 0; i < 100 && start + i*step < f->box_max[fixed]; i++) {
            double a[3], b[3];
            a[axis] = b[axis] = level;
            a[fixed] = b[fixed] = start + i*step;
            a[along] = f->box_min[along];
            b[along] = f->box_max[along];
            draw_line(c, a, b, 1.2f*(float)c->width/(float)f->width, mark, 0.35f);
        }
    }
}

/* 2-D: the box's area, a little lighter. 3-D: the box's bottom with a grid. */
void view_draw_floor(canvas *c, const tobi_picture *f)
{
    double level = 0, at[3];
    int axis = f->dimension == 2 ? 2 : find_floor(f, &level), across[2] = { (axis + 1)%3, (axis + 2)%3 };
    vec p[4];
    for (int i = 0; i < 4; i++) {
        at[axis] = level;
        at[across[0]] = i == 1 || i == 2 ? f->box_max[across[0]] : f->box_min[across[0]];
        at[across[1]] = i >= 2 ? f->box_max[across[1]] : f->box_min[across[1]];
        p[i] = view_point(&c->camera, at);
        if (p[i].z < c->camera.near) return;      /* the eye is over the floor: no floor then */
    }
    fill_floor(c, p);
    if (f->dimension == 3) draw_grid(c, f, axis, level, across);
}

void view_draw_box(canvas *c, const tobi_picture *f)
{
    vec color = { 0.05f, 0.07f, 0.10f };
    int corners = f->dimension == 2 ? 4 : 8;
    for (int i = 0; i < corners; i++)
        for (int k = 0; k < f->dimension; k++) {
            if (i >> k & 1) continue;
            double a[3] = { 0, 0, 0 }, b[3] = { 0, 0, 0 };
            for (int m = 0; m < f->dimension; m++) a[m] = b[m] = i >> m & 1 ? f->box_max[m] : f->box_min[m];
            b[k] = f->box_max[k];
            draw_line(c, a, b, 1.3f*(float)f->samples, color, 0.75f);
        }
}

/* The corners of the file are kept as they came, and the nearest is asked. Drawback: a look-up is a
   search among all triangles. */
#include "geom/texture.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

static int is_finite(const float uv[3][2])
{
    float sum = 0;
    for (int k = 0; k < 3; k++) sum += 0*uv[k][0] + 0*uv[k][1];      /* 0 times a number is 0 */
    return sum == 0;
}

tobi_status tobi_texture_create(const tobi_mesh *raw, const float (*uv)[3][2], tobi_texture **out,
                                tobi_error *err)
{
    int64_t count = 0;
    *out = NULL;
    for (int64_t t = 0; t < raw->triangle_count; t++) count += is_finite(uv[t]);
    if (count == 0) return TOBI_OK;
    tobi_texture *texture = calloc(1, sizeof *texture);
    if (texture) texture->corner = malloc((size_t)count*sizeof *texture->corner);
    if (texture) texture->uv = malloc((size_t)count*sizeof *texture->uv);
    if (!texture || !texture->corner || !texture->uv) {
        tobi_texture_free(texture);
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld texture coordinates", (long long)count);
    }
    for (int64_t t = 0; t < raw->triangle_count; t++) {
        if (!is_finite(uv[t])) continue;
        for (int k = 0; k < 3; k++)
            memcpy(texture->corner[texture->count][k], raw->vertices[raw->triangles[t][k]], 3*sizeof(double));
        memcpy(texture->uv[texture->count++], uv[t], sizeof *uv);
    }
    *out = texture;
    return TOBI_OK;
}

void tobi_texture_free(tobi_texture *texture)
{
    if (!texture) return;
    tobi_bvh_free(texture->tree);
    free(texture->corner);
    free(texture->uv);
    free(texture);
}

tobi_status tobi_texture_prepare(tobi_texture *texture, tobi_error *err)
{
    int32_t (*triangles)[3];
    if (texture->tree) return TOBI_OK;
    triangles = malloc((size_t)texture->count*sizeof *triangles);
    if (!triangles)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld texture coordinates",
                         (long long)texture->count);
    for (int64_t t = 0; t < texture->count; t++)
        for (int k = 0; k < 3; k++) triangles[t][k] = (int32_t)(3*t + k);
    tobi_status status =
        tobi_bvh_build(3*texture->count, (const double (*)[3])texture->corner, texture->count,
                       (const int32_t (*)[3])triangles, &texture->tree, err);
    free(triangles);
    return status;
}

static void mix(const float corner[3][2], const double share[3], float uv[2])
{
    for (int c = 0; c < 2; c++)
        uv[c] = (float)(share[0]*corner[0][c] + share[1]*corner[1][c] + share[2]*corner[2][c]);
}

/* The highest triangle on a line along z. */
typedef struct seeing { const tobi_texture *t; double x[3], top; tobi_bvh_hit *hit; int found; } seeing;

static void see_triangle(void *user, int32_t triangle, int turn)
{
    seeing *s = user;
    const double (*p)[3] = (const double (*)[3])s->t->corner[triangle];
    double share[3], sum = 0, z = 0;
    (void)turn;
    for (int k = 0; k < 3; k++) {
        const double *a = p[(k + 1)%3], *b = p[(k + 2)%3];
        share[k] = (a[0] - s->x[0])*(b[1] - s->x[1]) - (b[0] - s->x[0])*(a[1] - s->x[1]);
        sum += share[k];
    }
    if (sum == 0) return;
    for (int k = 0; k < 3; k++) share[k] /= sum, z += share[k]*p[k][2];
    if (s->found && !(z > s->top)) return;
    s->found = 1;
    s->top = z;
    s->hit->triangle = triangle;
    s->hit->distance = 0;
    memcpy(s->hit->barycentric, share, sizeof share);
}

static int find(const tobi_texture *texture, const double x[3], tobi_bvh_hit *hit)
{
    seeing s = { .t = texture, .x = { x[0], x[1] }, .hit = hit };
    double low[3], high[3];
    if (!texture->front) return tobi_bvh_closest(texture->tree, x, INFINITY, hit);
    tobi_bvh_box(texture->tree, low, high);
    s.x[2] = low[2] - 1 - (high[2] - low[2]);
    tobi_bvh_look_up(texture->tree, s.x, see_triangle, &s);
    return s.found || tobi_bvh_closest(texture->tree, x, INFINITY, hit);
}

double tobi_texture_look(const tobi_texture *texture, const double x[3], float uv[2])
{
    tobi_bvh_hit hit;
    uv[0] = uv[1] = 0;
    if (!find(texture, x, &hit)) return INFINITY;
    mix(texture->uv[hit.triangle], hit.barycentric, uv);
    return hit.distance;
}

/* Twice the areas between a point of a triangle's plane and its sides, each across from a corner and below 0
   beside it, times the length of n; returns n2, what they add up to. */
static double find_areas(const double corner[3][3], const double x[3], double area[3])
{
    double e[3][3], n[3];
    for (int k = 0; k < 3; k++) vec3_sub(e[k], corner[(k + 2)%3], corner[(k + 1)%3]);
    vec3_cross(n, e[2], e[0]);
    for (int k = 0; k < 3; k++) {
        double d[3], c[3];
        vec3_sub(d, x, corner[(k + 1)%3]);
        vec3_cross(c, e[k], d);
        area[k] = vec3_dot(c, n);
    }
    return vec3_dot(n, n);
}

/* Shares of the corners at a point of the plane of a triangle; beside it those of its border, or, as on
   a plane without end, below 0. */
static void find_shares(const double corner[3][3], const double x[3], int endless, double share[3])
{
    double sum = find_areas(corner, x, share);
    for (int k = 0; k < 3 && !endless; k++) share[k] = fmax(0, share[k]);
    if (!endless) sum = share[0] + share[1] + share[2];
    for (int k = 0; k < 3; k++) share[k] = sum > 0 ? share[k]/sum : 1.0/3;
}

/* The texture's triangle behind the middle of a triangle of the mesh, read at the corners of that one: at a
   seam every side has its own. */
static void look_corners(const tobi_texture *texture, const double corner[3][3], int endless,
                         float uv[3][2])
{
    double middle[3], share[3];
    tobi_bvh_hit hit;
    memset(uv, 0, 3*sizeof *uv);
    for (int a = 0; a < 3; a++) middle[a] = (corner[0][a] + corner[1][a] + corner[2][a])/3;
    if (!find(texture, middle, &hit)) return;
    for (int k = 0; k < 3; k++) {
        find_shares((const double (*)[3])texture->corner[hit.triangle], corner[k], endless, share);
        mix((const float (*)[2])texture->uv[hit.triangle], share, uv[k]);
    }
}

void tobi_texture_look_flat(const tobi_texture *texture, const double corner[3][3], float uv[3][2])
{
    look_corners(texture, corner, 1, uv);
}

static int compare_numbers(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

tobi_status tobi_texture_stretch(const tobi_texture *texture, double *stretch, tobi_error *err)
{
    double *each = malloc((size_t)texture->count*sizeof *each);
    if (!each)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld texture coordinates",
                         (long long)texture->count);
    for (int64_t t = 0; t < texture->count; t++) {
        each[t] = 0;
        for (int k = 0; k < 3; k++) {
            double d[3];
            const float *p = texture->uv[t][k], *q = texture->uv[t][(k + 1)%3];
            vec3_sub(d, texture->corner[t][k], texture->corner[t][(k + 1)%3]);
            const double way = sqrt(vec3_dot(d, d)), change = fmax(fabsf(p[0] - q[0]), fabsf(p[1] - q[1]));
            if (way > 0) each[t] = fmax(each[t], change/way);
        }
    }
    qsort(each, (size_t)texture->count, sizeof *each, compare_numbers);
    *stretch = each[(texture->count - 1)*99/100];
    free(each);
    return TOBI_OK;
}

tobi_status tobi_texture_copy(const tobi_texture *texture, tobi_texture **copy, tobi_error *err)
{
    tobi_texture *t = *copy = calloc(1, sizeof *t);
    const size_t n = (size_t)texture->count;
    if (t) t->corner = malloc(n*sizeof *t->corner);
    if (t) t->uv = malloc(n*sizeof *t->uv);
    tobi_status status = TOBI_OK;
    if (t && t->corner && t->uv) {
        t->count = texture->count;
        t->front = texture->front;
        memcpy(t->corner, texture->corner, n*sizeof *t->corner);
        memcpy(t->uv, texture->uv, n*sizeof *t->uv);
        status = tobi_texture_prepare(t, err);
    } else {
        status = tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld texture coordinates", (long long)n);
    }
    if (status == TOBI_OK) return TOBI_OK;
    tobi_texture_free(t);
    *copy = NULL;
    return status;
}

/* The copy of a vertex with these coordinates, a new one if there is none; next chains the copies. */
static int32_t find_copy(tobi_skin *skin, int32_t *head, int32_t *next, int32_t vertex, const float uv[2])
{
    const float same = 1e-5f;      /* of the picture's side: a tenth of a pixel of 10 000 */
    for (int32_t k = head[vertex]; k >= 0; k = next[k])
        if (fabsf(skin->uv[k][0] - uv[0]) <= same && fabsf(skin->uv[k][1] - uv[1]) <= same) return k;
    int32_t k = (int32_t)skin->vertex_count++;
    skin->vertex[k] = vertex;
    memcpy(skin->uv[k], uv, sizeof skin->uv[k]);
    next[k] = head[vertex];
    head[vertex] = k;
    return k;
}

tobi_status tobi_skin_build(const tobi_mesh *mesh, tobi_skin *out, tobi_error *err)
{
    size_t corners = 3*(size_t)mesh->triangle_count + 1;
    *out = (tobi_skin){ .vertex = malloc(corners*sizeof *out->vertex), .uv = malloc(corners*sizeof *out->uv),
                        .triangles = malloc(corners*sizeof(int32_t)) };
    int32_t *head = malloc((size_t)(mesh->vertex_count + 1)*sizeof *head);
    int32_t *next = malloc(corners*sizeof *next);
    tobi_status status = TOBI_OK;
    if (!out->vertex || !out->uv || !out->triangles || !head || !next)
        status = tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld texture coordinates", (long long)corners);
    if (status == TOBI_OK) memset(head, 0xff, (size_t)mesh->vertex_count*sizeof *head);
    for (int64_t t = 0; status == TOBI_OK && t < mesh->triangle_count; t++) {
        double corner[3][3];
        float uv[3][2];
        for (int k = 0; k < 3; k++)
            memcpy(corner[k], mesh->vertices[mesh->triangles[t][k]], sizeof corner[k]);
        look_corners(mesh->texture, (const double (*)[3])corner, 0, uv);
        for (int k = 0; k < 3; k++)
            out->triangles[t][k] = find_copy(out, head, next, mesh->triangles[t][k], uv[k]);
    }
    free(head);
    free(next);
    if (status != TOBI_OK) tobi_skin_free(out);
    return status;
}

void tobi_skin_free(tobi_skin *skin)
{
    free(skin->vertex);
    free(skin->uv);
    free(skin->triangles);
    *skin = (tobi_skin){ 0 };
}

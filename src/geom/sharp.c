/* Sharp edges: how sharp the solid is at each edge of its mesh. The surface is cut by the plane
   through the middle of the edge and perpendicular to it, and followed to both sides, so that a
   rounded or blunted edge of many facets shows the angle of its flanks, and how far apart they are.
   */
#include "geom/sharp.h"
#include "geom/edges.h"
#include "geom/vec3.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* How far below the tip of a strip an edge of the mesh may lie, in widths of the strip. */
static const double tip_share = 0.1;

typedef struct surface {
    const tobi_mesh *mesh;
    double (*normal)[3];               /* unit, of the triangles; 0 for one without area          */
    int32_t (*opposite)[3];
    double width, degrees;             /* of tobi_sharp_find                                      */
    int flat;
} surface;

/* One way along the cut: the triangle it is in, where it came in and where it leaves. */
typedef struct walker {
    int32_t triangle, way_out;         /* way_out: the side it leaves by                          */
    double in[3], out[3], normal[3];
} walker;

static void make_normals(surface *s)
{
    for (int64_t t = 0; t < s->mesh->triangle_count; t++) {
        const int32_t *v = s->mesh->triangles[t];
        double u[3], w[3];
        vec3_sub(u, s->mesh->vertices[v[1]], s->mesh->vertices[v[0]]);
        vec3_sub(w, s->mesh->vertices[v[2]], s->mesh->vertices[v[0]]);
        vec3_cross(s->normal[t], u, w);
        vec3_normalize(s->normal[t]);
    }
}

static double height(const surface *s, int32_t vertex, const double middle[3], const double along[3])
{
    double d[3];
    vec3_sub(d, s->mesh->vertices[vertex], middle);
    return vec3_dot(d, along);
}

/* Enters triangle t by its side k at point `in` of the plane. */
static void enter(const surface *s, walker *w, int32_t t, int k, const double in[3], const double middle[3],
                  const double along[3])
{
    const int32_t *v = s->mesh->triangles[t];
    int next = (k + 1)%3, last = (k + 2)%3;
    double h0 = height(s, v[k], middle, along), h2 = height(s, v[last], middle, along);
    int from = (h2 > 0) == (h0 > 0) ? next : last, to = (from + 1)%3;
    double h = height(s, v[from], middle, along), g = height(s, v[to], middle, along);
    double share = h != g ? fmin(fmax(h/(h - g), 0), 1) : 0.5;
    w->triangle = t;
    w->way_out = from;
    memcpy(w->in, in, sizeof w->in);
    for (int a = 0; a < 3; a++)
        w->out[a] = (1 - share)*s->mesh->vertices[v[from]][a] + share*s->mesh->vertices[v[to]][a];
    if (vec3_dot(s->normal[t], s->normal[t]) > 0) memcpy(w->normal, s->normal[t], sizeof w->normal);
}

/* The inner angle between the two flanks, degrees; 180 if the surface is hollow or flat there. */
static double angle_between(const walker w[2])
{
    double u[3], v[3], sum[3];
    if (vec3_dot(w[0].normal, w[0].normal) == 0 || vec3_dot(w[1].normal, w[1].normal) == 0) return 180;
    vec3_sub(u, w[1].out, w[0].in);
    vec3_sub(v, w[0].out, w[1].in);
    if (vec3_dot(u, w[0].normal) >= 0 || vec3_dot(v, w[1].normal) >= 0) return 180;
    vec3_add_scaled(sum, w[0].normal, 1, w[1].normal);
    return 2*asin(fmin(0.5*vec3_length(sum), 1))*180/acos(-1);
}

/* Where the cut by the plane through the middle of side k of triangle t goes. */
static void set_out(const surface *s, int32_t t, int k, walker w[2], double middle[3], double along[3])
{
    const int32_t *v = s->mesh->triangles[t];
    const double *from = s->mesh->vertices[v[k]], *to = s->mesh->vertices[v[(k + 1)%3]];
    int32_t other = s->opposite[t][k];
    vec3_sub(along, to, from);
    for (int a = 0; a < 3; a++) middle[a] = 0.5*(from[a] + to[a]);
    memset(w, 0, 2*sizeof *w);
    enter(s, &w[0], t, k, middle, middle, along);
    enter(s, &w[1], other/3, other%3, middle, middle, along);
}

/* Follows the cut to both sides until the flanks are sharp (1) or too far apart (0). If ahead is
   given, r->low becomes how much farther that way the cut has been. */
static int follow(const surface *s, int32_t t, int k, tobi_ridge *r, const double *ahead, double *sharpest)
{
    double along[3], middle[3], up[3];
    walker w[2];
    set_out(s, t, k, w, middle, along);
    for (int64_t step = 0; step < s->mesh->triangle_count; step++) {
        double angle = angle_between(w);
        *sharpest = fmin(*sharpest, angle);
        if (angle <= s->degrees) {
            if (ahead) return 1;
            vec3_add_scaled(r->ahead, w[0].normal, 1, w[1].normal);
            if (vec3_length(r->ahead) < 1e-3)
                for (int a = 0; a < 3; a++) r->ahead[a] = 2*middle[a] - w[0].out[a] - w[1].out[a];
            vec3_normalize(r->ahead);
            return 1;
        }
        int side = vec3_distance2(w[0].out, w[1].in) <= vec3_distance2(w[1].out, w[0].in) ? 0 : 1;
        double reach = sqrt(vec3_distance2(w[side].out, w[!side].in)), in[3];
        int32_t across = s->opposite[w[side].triangle][w[side].way_out];
        if (reach > s->width || across < 0) return 0;
        r->width = fmax(r->width, reach);
        memcpy(in, w[side].out, sizeof in);
        enter(s, &w[side], across/3, across%3, in, middle, along);
        vec3_sub(up, in, middle);
        if (ahead) r->low = fmax(r->low, vec3_dot(up, ahead));
    }
    return 0;
}

/* Whether side k of triangle t runs along the tip of a strip between sharp flanks: nothing of the
   strip lies much ahead of it, and it runs across that direction; one along it only borders the
   strip's end. */
static int is_ridge(const surface *s, int32_t t, int k, tobi_ridge *r, double *sharpest)
{
    const int32_t *v = s->mesh->triangles[t];
    double along[3], ahead[3];
    vec3_sub(along, s->mesh->vertices[v[(k + 1)%3]], s->mesh->vertices[v[k]]);
    *r = (tobi_ridge){ .from = v[k], .to = v[(k + 1)%3], .length = vec3_length(along) };
    if (!follow(s, t, k, r, NULL, sharpest)) return 0;
    memcpy(ahead, r->ahead, sizeof ahead);
    follow(s, t, k, r, ahead, sharpest);
    return fabs(vec3_dot(ahead, along)) <= 0.5*r->length && r->low <= tip_share*r->width;
}

/* Each edge from one of its triangles; in a section, only the edges that cross it. */
static int counts(const surface *s, int32_t t, int k)
{
    const int32_t *v = s->mesh->triangles[t];
    const double *a = s->mesh->vertices[v[k]], *b = s->mesh->vertices[v[(k + 1)%3]];
    double length = sqrt(vec3_distance2(a, b));
    if (s->opposite[t][k] < 3*t + k || !(length > 0)) return 0;
    return !s->flat || fabs(a[2] - b[2]) > 0.7*length;
}

static tobi_status add_ridge(tobi_ridges *r, const tobi_ridge *found, tobi_error *err)
{
    if (r->count == r->room) {
        r->room = 2*r->room + 64;
        tobi_ridge *more = realloc(r->ridge, (size_t)r->room*sizeof *more);
        if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the edges of a blade");
        r->ridge = more;
    }
    r->ridge[r->count++] = *found;
    return TOBI_OK;
}

enum { RIDGE = 1, TOUCHED = 2 };       /* marks: of 3 t + k; of vertices                          */

static tobi_status list_ridges(const surface *s, tobi_ridges *r, uint8_t *marks, double *sharpest,
                               tobi_error *err)
{
    for (int64_t t = 0; t < s->mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            tobi_ridge found;
            if (!counts(s, (int32_t)t, k) || !is_ridge(s, (int32_t)t, k, &found, sharpest)) continue;
            TOBI_TRY(add_ridge(r, &found, err));
            marks[3*t + k] |= RIDGE;
            marks[found.from] |= TOUCHED;
            marks[found.to] |= TOUCHED;
        }
    return TOBI_OK;
}

/* Short edges across a strip lead from one line of facets to the next. */
static tobi_status list_bridges(const surface *s, tobi_ridges *r, const uint8_t *marks, tobi_error *err)
{
    for (int64_t t = 0; t < s->mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            int32_t from = s->mesh->triangles[t][k], to = s->mesh->triangles[t][(k + 1)%3];
            double length = sqrt(vec3_distance2(s->mesh->vertices[from], s->mesh->vertices[to]));
            tobi_ridge across = { .from = from, .to = to, .width = length, .length = length,
                                  .low = tip_share*length };
            if ((marks[3*t + k] & RIDGE) || !(marks[from] & TOUCHED) || !(marks[to] & TOUCHED)) continue;
            if (s->opposite[t][k] < 3*t + k || !(length > 0) || length > s->width) continue;
            TOBI_TRY(add_ridge(r, &across, err));
        }
    return TOBI_OK;
}

/* The narrowest bluntness whose chains are as long as those of the widest: anything wider would
   only climb around the ends of the edge. */
static tobi_status choose(const tobi_ridges *r, double width, double tolerance, tobi_sharp *out,
                          tobi_error *err)
{
    enum { LEVELS = 9 };
    tobi_sharp best = { .width = width };
    double whole, longest;
    TOBI_TRY(tobi_sharp_chains(r, width, fmax(tolerance, 0.25*width), &best, &whole, err));
    for (int k = 0; k <= LEVELS && best.count; k++) {
        tobi_sharp trial = { .width = k ? width*exp2(k - LEVELS) : 0 };
        TOBI_TRY(tobi_sharp_chains(r, trial.width, fmax(tolerance, 0.25*trial.width), &trial, &longest, err));
        int enough = longest >= 0.8*whole;
        free(enough ? best.edge : trial.edge);
        if (!enough) continue;
        best = trial;
        break;
    }
    best.sharpest = out->sharpest;
    *out = best;
    return TOBI_OK;
}

/* The points where the edges cross the section become pieces of 1 m depth. */
static void take_section(tobi_sharp *out)
{
    int64_t kept = 0;
    for (int64_t i = 0; i < out->count; i++) {
        tobi_edge e = out->edge[i];
        if ((e.a[2] > 0) == (e.b[2] > 0)) continue;
        double share = e.a[2]/(e.a[2] - e.b[2]);
        for (int a = 0; a < 2; a++) e.a[a] = e.b[a] = (1 - share)*e.a[a] + share*e.b[a];
        e.a[2] = -0.5;
        e.b[2] = 0.5;
        e.ahead[2] = 0;
        vec3_normalize(e.ahead);
        out->edge[kept++] = e;
    }
    out->count = kept;
}

tobi_status tobi_sharp_find(const tobi_mesh *mesh, double degrees, double width, int flat, tobi_sharp *out,
                            tobi_error *err)
{
    size_t n = (size_t)mesh->triangle_count + 1;
    surface s = { .mesh = mesh, .width = width, .degrees = degrees, .flat = flat };
    tobi_ridges r = { .vertex = (const double (*)[3])mesh->vertices,
                      .vertex_count = mesh->vertex_count };
    *out = (tobi_sharp){ .sharpest = 180 };
    s.normal = malloc(n*sizeof *s.normal);
    s.opposite = malloc(n*sizeof *s.opposite);
    uint8_t *marks = calloc(3*n + (size_t)mesh->vertex_count, 1);
    tobi_status status = TOBI_NO_MEMORY;
    if (s.normal && s.opposite && marks)
        status = tobi_edges_match(mesh->vertex_count, mesh->triangle_count,
                                  (const int32_t (*)[3])mesh->triangles, s.opposite, NULL);
    if (status != TOBI_OK)
        status = tobi_fail(err, TOBI_NO_MEMORY, "no memory to look for the edge of a blade");
    if (status == TOBI_OK) {
        make_normals(&s);
        status = list_ridges(&s, &r, marks, &out->sharpest, err);
    }
    if (status == TOBI_OK) status = list_bridges(&s, &r, marks, err);
    if (status == TOBI_OK && r.count) status = choose(&r, width, 0.02*width, out, err);
    if (status == TOBI_OK && flat) take_section(out);
    free(s.normal);
    free(s.opposite);
    free(marks);
    free(r.ridge);
    return status;
}

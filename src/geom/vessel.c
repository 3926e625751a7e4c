/* Walls for surfaces that are seen from inside: the surface, turned round, and a copy of it that is shifted
   outwards, joined along the rims. Drawback: where the surface bends inwards more sharply than the walls are
   thick, the copy crosses itself, which the winding number forgives. */
#include "geom/vessel.h"
#include "geom/bvh.h"
#include "geom/edges.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

enum { SAMPLES = 20 };                       /* places per axis that are asked for pockets              */
static const double POCKET = 0.02;           /* of the box: less is no room                             */
static const double FLAT = 1e-6;             /* of the mesh's extent                                    */
static const double STEEPEST = 0.3;          /* cosine: corners get no spikes longer than 1/STEEPEST    */

/* Whether a place outside of the solid sees it in all directions but one: walls all round, and a floor. */
static int is_pocket(const tobi_bvh *tree, const double x[3], double reach, int dimension)
{
    int seen = 0;
    if (tobi_bvh_inside(tree, x)) return 0;
    for (int side = 0; side < 2*dimension; side++) {
        double to[3] = { x[0], x[1], x[2] };
        to[side/2] += side%2 ? reach : -reach;
        seen += tobi_bvh_segment_hits(tree, x, to);
    }
    return seen >= 2*dimension - 1;
}

/* The share of the mesh's box that is pockets. */
static double find_pockets(const tobi_mesh *mesh, const tobi_bvh *tree, int dimension)
{
    double low[3], high[3], reach = 0;
    int64_t found = 0, all = 0;
    tobi_mesh_box(mesh, low, high);
    for (int a = 0; a < 3; a++) reach += high[a] - low[a];
    for (int k = 0; k < (dimension == 3 ? SAMPLES : 1); k++)
        for (int j = 0; j < SAMPLES; j++)
            for (int i = 0; i < SAMPLES; i++, all++) {
                const int at[3] = { i, j, k };
                double x[3];
                for (int a = 0; a < 3; a++) x[a] = low[a] + (at[a] + 0.5)/SAMPLES*(high[a] - low[a]);
                if (dimension == 2) x[2] = 0;
                found += is_pocket(tree, x, reach, dimension);
            }
    return (double)found/(double)all;
}

/* *walled: 1 if the mesh, which is closed then, is a solid that has room for liquid. */
static tobi_status has_walls(tobi_mesh *mesh, int dimension, const char *name, int *walled, tobi_error *err)
{
    tobi_mesh closed = { 0 };
    tobi_error why;
    tobi_bvh *tree = NULL;
    *walled = 0;
    TOBI_TRY(tobi_mesh_copy(mesh, &closed, err));
    tobi_status status = tobi_mesh_orient(&closed, name, &why);
    if (status == TOBI_INVALID) {                      /* an open surface */
        tobi_mesh_free(&closed);
        return TOBI_OK;
    }
    if (status == TOBI_OK)
        status = tobi_bvh_build(closed.vertex_count, (const double (*)[3])closed.vertices,
                                closed.triangle_count, (const int32_t (*)[3])closed.triangles, &tree, &why);
    if (status == TOBI_OK && closed.overlapping) tobi_bvh_use_winding(tree);
    *walled = status == TOBI_OK && find_pockets(&closed, tree, dimension) > POCKET;
    tobi_bvh_free(tree);
    tobi_mesh_free(&closed);
    return status == TOBI_OK ? TOBI_OK : tobi_fail(err, status, "%s", why.text);
}

static void find_normal(const tobi_mesh *m, int64_t t, double n[3])
{
    double e[2][3];
    vec3_sub(e[0], m->vertices[m->triangles[t][1]], m->vertices[m->triangles[t][0]]);
    vec3_sub(e[1], m->vertices[m->triangles[t][2]], m->vertices[m->triangles[t][0]]);
    vec3_cross(n, e[0], e[1]);
    vec3_normalize(n);
}

/* Angle of a triangle at a corner. */
static double find_angle(const tobi_mesh *m, int64_t t, int corner)
{
    double e[2][3];
    const double *x = m->vertices[m->triangles[t][corner]];
    vec3_sub(e[0], m->vertices[m->triangles[t][(corner + 1)%3]], x);
    vec3_sub(e[1], m->vertices[m->triangles[t][(corner + 2)%3]], x);
    vec3_normalize(e[0]);
    vec3_normalize(e[1]);
    return acos(fmax(-1, fmin(1, vec3_dot(e[0], e[1]))));
}

/* normal: of each vertex, by the angles of its triangles; slant: how far the steepest of them leans away. */
static void find_vertex_normals(const tobi_mesh *m, double (*normal)[3], double *slant)
{
    double n[3];
    for (int64_t t = 0; t < m->triangle_count; t++) {
        find_normal(m, t, n);
        for (int c = 0; c < 3; c++) {
            double *sum = normal[m->triangles[t][c]];
            vec3_add_scaled(sum, sum, find_angle(m, t, c), n);
        }
    }
    for (int64_t v = 0; v < m->vertex_count; v++) {
        vec3_normalize(normal[v]);
        slant[v] = 1;
    }
    for (int64_t t = 0; t < m->triangle_count; t++) {
        find_normal(m, t, n);
        for (int c = 0; c < 3 && vec3_length(n) > 0; c++) {
            const int32_t v = m->triangles[t][c];
            slant[v] = fmin(slant[v], fmax(vec3_dot(normal[v], n), STEEPEST));
        }
    }
}

static void add_triangle(tobi_mesh *m, int64_t a, int64_t b, int64_t c)
{
    const int32_t t[3] = { (int32_t)a, (int32_t)b, (int32_t)c };
    memcpy(m->triangles[m->triangle_count++], t, sizeof t);
}

/* The inner face, the outer face, and the rims. */
static void join_faces(const tobi_mesh *in, const int32_t (*opposite)[3], tobi_mesh *out)
{
    const int64_t n = in->vertex_count;
    for (int64_t t = 0; t < in->triangle_count; t++) {
        const int32_t *v = in->triangles[t];
        add_triangle(out, v[0], v[2], v[1]);
        add_triangle(out, n + v[0], n + v[1], n + v[2]);
        for (int k = 0; k < 3; k++) {
            const int32_t a = v[k], b = v[(k + 1)%3];
            if (opposite[t][k] >= 0) continue;
            add_triangle(out, a, b, n + b);
            add_triangle(out, a, n + b, n + a);
        }
    }
}

/* in: oriented outwards, holes open. */
static int thicken(const tobi_mesh *in, double thickness, tobi_mesh *out)
{
    const size_t n = (size_t)in->vertex_count, t = (size_t)in->triangle_count;
    double (*normal)[3] = calloc(n + 1, sizeof *normal), *slant = calloc(n + 1, sizeof *slant);
    int32_t (*opposite)[3] = malloc((t + 1)*sizeof *opposite);
    out->vertices = malloc((2*n + 1)*sizeof *out->vertices);
    out->triangles = malloc((8*t + 1)*sizeof *out->triangles);
    int good = normal && slant && opposite && out->vertices && out->triangles &&
               tobi_edges_match(in->vertex_count, in->triangle_count, (const int32_t (*)[3])in->triangles,
                                opposite, NULL) == TOBI_OK;
    if (good) {
        find_vertex_normals(in, normal, slant);
        memcpy(out->vertices, in->vertices, n*sizeof *out->vertices);
        for (size_t v = 0; v < n; v++)
            vec3_add_scaled(out->vertices[n + v], in->vertices[v], thickness/slant[v], normal[v]);
        out->vertex_count = 2*in->vertex_count;
        join_faces(in, (const int32_t (*)[3])opposite, out);
    }
    free(normal);
    free(slant);
    free(opposite);
    return good;
}

/* Leaves out the triangles that lie farthest towards `open`. */
static tobi_status open_side(tobi_mesh *m, const double open[3], const char *name, tobi_error *err)
{
    const int64_t all = m->triangle_count;
    double to[3] = { open[0], open[1], open[2] }, low = INFINITY, high = -INFINITY;
    vec3_normalize(to);
    for (int64_t v = 0; v < m->vertex_count; v++) {
        low = fmin(low, vec3_dot(to, m->vertices[v]));
        high = fmax(high, vec3_dot(to, m->vertices[v]));
    }
    m->triangle_count = 0;
    for (int64_t t = 0; t < all; t++) {
        int flat = 1;
        for (int c = 0; c < 3; c++)
            flat &= vec3_dot(to, m->vertices[m->triangles[t][c]]) >= high - FLAT*(high - low);
        if (!flat) memmove(m->triangles[m->triangle_count++], m->triangles[t], sizeof *m->triangles);
    }
    if (m->triangle_count < all) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "mesh '%s': open_side [%g, %g, %g]: no flat side lies farthest that "
                     "way", name, open[0], open[1], open[2]);
}

tobi_status tobi_mesh_make_vessel(tobi_mesh *mesh, double thickness, double usual, const double open[3],
                                  int dimension, const char *name, tobi_error *err)
{
    const int opens = vec3_length(open) > 0;
    int walled = 0;
    if (!(thickness > 0)) TOBI_TRY(has_walls(mesh, dimension, name, &walled, err));
    if (walled && opens)
        return tobi_fail(err, TOBI_INVALID, "mesh '%s': open_side is for an inner surface; this mesh has "
                         "walls of its own", name);
    if (walled) return tobi_mesh_orient_vessel(mesh, name, err);
    if (opens) TOBI_TRY(open_side(mesh, open, name, err));
    tobi_mesh out = { 0 };
    const double t = thickness > 0 ? thickness : usual;
    TOBI_TRY(tobi_mesh_orient_open(mesh, name, err));
    if (!thicken(mesh, t, &out)) {
        tobi_mesh_free(&out);
        return tobi_fail(err, TOBI_NO_MEMORY, "mesh '%s': no memory for walls", name);
    }
    memcpy(out.notes, mesh->notes, sizeof out.notes);
    const int rims = out.triangle_count > 2*mesh->triangle_count;
    tobi_mesh_note(&out, tr("it has no walls of its own: they lie outside of it, %.4g m thick%s"), t,
                   rims ? "" : tr("; it is closed all round"));
    const tobi_status status = tobi_mesh_orient_vessel(&out, name, err);
    tobi_mesh_free(mesh);
    *mesh = out;
    return status;
}

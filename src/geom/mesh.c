/* The mesh itself: building from raw arrays with welding, placing, boxes.

   Welding hashes each vertex into a grid whose cell is twice the tolerance and looks into the
   neighbouring cells only where the vertex is close to their border. The first of the vertices
   that meet keeps its exact position, so the result depends only on the order of the input. */
#include "geom/mesh.h"
#include "geom/mesh_mend.h"
#include "geom/texture.h"
#include "geom/vec3.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WELD_TOLERANCE 1e-9     /* of the longest side of the box */
/* m: squares of coordinates are kept as float in the tree, products of six in the integrals */
#define LARGEST        1e15
#define SMALLEST_SIZE  1e-15

typedef struct weld {
    double origin[3], tolerance;
    const double (*vertices)[3];
    uint64_t mask;
    int32_t *head, *next;       /* hash table of kept vertices, chained */
} weld;

void tobi_mesh_free(tobi_mesh *mesh)
{
    if (!mesh) return;
    free(mesh->vertices);
    free(mesh->triangles);
    tobi_texture_free(mesh->texture);
    *mesh = (tobi_mesh){0};
}

static tobi_status allocate_mesh(tobi_mesh *mesh, int64_t vertices, int64_t triangles, tobi_error *err)
{
    mesh->vertex_count = vertices;
    mesh->triangle_count = triangles;
    mesh->vertices = malloc((size_t)(vertices + 1)*sizeof *mesh->vertices);
    mesh->triangles = malloc((size_t)(triangles + 1)*sizeof *mesh->triangles);
    if (mesh->vertices && mesh->triangles) return TOBI_OK;
    tobi_mesh_free(mesh);
    return tobi_fail(err, TOBI_NO_MEMORY, "mesh: no memory for %lld vertices and %lld triangles",
                     (long long)vertices, (long long)triangles);
}

tobi_status tobi_mesh_copy(const tobi_mesh *mesh, tobi_mesh *out, tobi_error *err)
{
    *out = (tobi_mesh){0};
    TOBI_TRY(allocate_mesh(out, mesh->vertex_count, mesh->triangle_count, err));
    out->overlapping = mesh->overlapping;
    memcpy(out->notes, mesh->notes, sizeof out->notes);
    if (mesh->vertex_count)
        memcpy(out->vertices, mesh->vertices, (size_t)mesh->vertex_count*sizeof *out->vertices);
    if (mesh->triangle_count)
        memcpy(out->triangles, mesh->triangles, (size_t)mesh->triangle_count*sizeof *out->triangles);
    return TOBI_OK;
}

void tobi_mesh_note(tobi_mesh *mesh, const char *format, ...)
{
    size_t used = strlen(mesh->notes), room = sizeof mesh->notes - used;
    va_list args;
    va_start(args, format);
    int length = vsnprintf(mesh->notes + used, room, format, args);
    va_end(args);
    if (length < 0 || (size_t)length + 2 > room) mesh->notes[used] = 0;
    else strcpy(mesh->notes + used + length, "\n");
}

void tobi_mesh_box(const tobi_mesh *mesh, double min[3], double max[3])
{
    for (int k = 0; k < 3; k++) {
        min[k] = INFINITY;
        max[k] = -INFINITY;
    }
    for (int64_t i = 0; i < mesh->vertex_count; i++) {
        for (int k = 0; k < 3; k++) {
            double x = mesh->vertices[i][k];
            if (x < min[k]) min[k] = x;
            if (x > max[k]) max[k] = x;
        }
    }
}

int tobi_mesh_hint_units(const tobi_mesh *mesh, int dimension, const double size[3], char *text,
                         size_t room)
{
    static const struct { const char *name; double factor; } units[] = {
        {TR("millimetres"), 0.001}, {TR("inches"), 0.0254}, {TR("centimetres"), 0.01}, {TR("micrometres"),
                                                                                        1e-6}};
    double min[3], max[3], mine = 0, domain = 0;
    text[0] = 0;
    tobi_mesh_box(mesh, min, max);
    for (int k = 0; k < dimension; k++) {
        mine = fmax(mine, max[k] - min[k]);
        domain = fmax(domain, size[k]);
    }
    if (!(mine > 0 && domain > 0) || (mine <= 10*domain && mine >= 1e-3*domain)) return 0;
    int used = snprintf(text, room, tr("the mesh is %.4g m long, %s than the domain of %.4g m: "), mine,
                        mine > domain ? tr("far larger") : tr("far smaller"), domain);
    for (size_t i = 0; i < sizeof units/sizeof *units && mine > domain; i++) {
        double fitted = mine*units[i].factor/domain;
        if (fitted > 1 || fitted < 0.01) continue;
        snprintf(text + used, room - (size_t)used, tr("are its units %s? Multiply its scale by %g"),
                 tr(units[i].name), units[i].factor);
        return 1;
    }
    snprintf(text + used, room - (size_t)used, tr("is its scale right?"));
    return mine > domain ? 1 : -1;
}

static uint64_t hash_cell(const weld *w, const int64_t cell[3])
{
    uint64_t h = (uint64_t)cell[0]*0x9E3779B97F4A7C15u;
    h = (h ^ (h >> 29) ^ (uint64_t)cell[1])*0xBF58476D1CE4E5B9u;
    h = (h ^ (h >> 31) ^ (uint64_t)cell[2])*0x94D049BB133111EBu;
    return (h ^ (h >> 32)) & w->mask;
}

static int32_t find_in_cell(const weld *w, const int64_t cell[3], const double x[3])
{
    for (int32_t i = w->head[hash_cell(w, cell)]; i >= 0; i = w->next[i]) {
        const double *y = w->vertices[i];
        if (fabs(x[0] - y[0]) <= w->tolerance && fabs(x[1] - y[1]) <= w->tolerance &&
            fabs(x[2] - y[2]) <= w->tolerance) return i;
    }
    return -1;
}

/* The kept vertex within the tolerance of x, or -1; own receives the cell of x itself. */
static int32_t find_welded(const weld *w, const double x[3], int64_t own[3])
{
    int64_t range[3][2];
    double width = 2*w->tolerance;
    for (int k = 0; k < 3; k++) {
        double s = x[k] - w->origin[k];
        own[k] = (int64_t)floor(s/width);
        range[k][0] = (int64_t)floor((s - w->tolerance)/width);
        range[k][1] = (int64_t)floor((s + w->tolerance)/width);
    }
    int32_t best = -1;
    int64_t c[3];
    for (c[0] = range[0][0]; c[0] <= range[0][1]; c[0]++)
        for (c[1] = range[1][0]; c[1] <= range[1][1]; c[1]++)
            for (c[2] = range[2][0]; c[2] <= range[2][1]; c[2]++) {
                int32_t i = find_in_cell(w, c, x);
                if (i >= 0 && (best < 0 || i < best)) best = i;
            }
    return best;
}

/* Fills merged[i] with the lowest vertex that i coincides with (itself if none); tolerance as a part of
   the box. only: which vertices may move, NULL = all. */
static tobi_status weld_vertices(const tobi_mesh *mesh, double tolerance, const char *only,
                                 int32_t *merged)
{
    double max[3], size = 0;
    weld w = {.vertices = (const double (*)[3])mesh->vertices};
    tobi_mesh_box(mesh, w.origin, max);
    for (int k = 0; k < 3; k++) size = fmax(size, max[k] - w.origin[k]);
    w.tolerance = size > SMALLEST_SIZE ? tolerance*size : 1;      /* or all become one point */
    uint64_t slots = 16;
    while (slots < (uint64_t)mesh->vertex_count*2) slots *= 2;
    w.mask = slots - 1;
    w.head = malloc(slots*sizeof *w.head);
    w.next = malloc((size_t)mesh->vertex_count*sizeof *w.next);
    if (w.head && w.next) {
        memset(w.head, 0xff, slots*sizeof *w.head);
        for (int32_t i = 0; i < mesh->vertex_count; i++) {
            int64_t own[3];
            merged[i] = i;
            if (only && !only[i]) continue;
            int32_t same = find_welded(&w, w.vertices[i], own);
            if (same >= 0) merged[i] = same;
            if (same >= 0) continue;
            uint64_t slot = hash_cell(&w, own);
            w.next[i] = w.head[slot];
            w.head[slot] = i;
        }
    }
    tobi_status status = w.head && w.next ? TOBI_OK : TOBI_NO_MEMORY;
    free(w.head);
    free(w.next);
    return status;
}

/* Rewrites the triangles with merged vertices, drops collapsed ones, renumbers what is used. */
static void compact_mesh(tobi_mesh *mesh, int32_t *merged, int32_t *number)
{
    int64_t kept = 0;
    for (int64_t t = 0; t < mesh->triangle_count; t++) {
        int32_t a = merged[mesh->triangles[t][0]], b = merged[mesh->triangles[t][1]],
                c = merged[mesh->triangles[t][2]];
        if (a == b || b == c || c == a) continue;
        mesh->triangles[kept][0] = a;
        mesh->triangles[kept][1] = b;
        mesh->triangles[kept++][2] = c;
    }
    mesh->triangle_count = kept;
    memset(number, 0xff, (size_t)mesh->vertex_count*sizeof *number);
    for (int64_t t = 0; t < kept; t++)
        for (int k = 0; k < 3; k++) number[mesh->triangles[t][k]] = 0;
    int32_t used = 0;
    for (int64_t i = 0; i < mesh->vertex_count; i++) {
        if (number[i] < 0) continue;
        memmove(mesh->vertices[used], mesh->vertices[i], sizeof mesh->vertices[used]);
        number[i] = used++;
    }
    mesh->vertex_count = used;
    for (int64_t t = 0; t < kept; t++)
        for (int k = 0; k < 3; k++) mesh->triangles[t][k] = number[mesh->triangles[t][k]];
}

static tobi_status check_input(const char *name, int64_t vertex_count, const double (*vertices)[3],
                               int64_t triangle_count, const int32_t (*triangles)[3], tobi_error *err)
{
    if (vertex_count <= 0 || triangle_count <= 0)
        return tobi_fail(err, TOBI_INVALID, "mesh '%s': no triangles; a closed surface is needed", name);
    if (vertex_count > INT32_MAX || triangle_count > INT32_MAX/3)
        return tobi_fail(err, TOBI_INVALID, "mesh '%s': %lld vertices and %lld triangles; allowed are "
                         "at most %d and %d", name, (long long)vertex_count,
                         (long long)triangle_count, INT32_MAX, INT32_MAX/3);
    for (int64_t i = 0; i < vertex_count; i++) {
        const double *x = vertices[i];
        if (!(fabs(x[0]) < LARGEST && fabs(x[1]) < LARGEST && fabs(x[2]) < LARGEST))
            return tobi_fail(err, TOBI_INVALID, "mesh '%s': vertex %lld is (%g, %g, %g); coordinates "
                             "must be finite numbers below 1e15", name, (long long)i + 1, x[0], x[1], x[2]);
    }
    for (int64_t t = 0; t < triangle_count; t++)
        for (int k = 0; k < 3; k++)
            if (triangles[t][k] < 0 || triangles[t][k] >= vertex_count)
                return tobi_fail(err, TOBI_INVALID, "mesh '%s': triangle %lld uses vertex index %d "
                                 "(counted from 0); allowed are 0 to %lld", name, (long long)t + 1,
                                 triangles[t][k], (long long)vertex_count - 1);
    return TOBI_OK;
}

tobi_status tobi_mesh_build(const char *name, int64_t vertex_count, const double (*vertices)[3],
                            int64_t triangle_count, const int32_t (*triangles)[3],
                            tobi_mesh *out, tobi_error *err)
{
    *out = (tobi_mesh){0};
    TOBI_TRY(check_input(name, vertex_count, vertices, triangle_count, triangles, err));
    tobi_mesh raw = {.vertex_count = vertex_count, .triangle_count = triangle_count,
                     .vertices = (double (*)[3])(uintptr_t)vertices,
                     .triangles = (int32_t (*)[3])(uintptr_t)triangles};
    tobi_mesh mesh;
    TOBI_TRY(tobi_mesh_copy(&raw, &mesh, err));
    int32_t *merged = malloc((size_t)vertex_count*2*sizeof *merged);
    if (!merged || weld_vertices(&mesh, WELD_TOLERANCE, NULL, merged) != TOBI_OK) {
        free(merged);
        tobi_mesh_free(&mesh);
        return tobi_fail(err, TOBI_NO_MEMORY, "mesh '%s': no memory to weld %lld vertices", name,
                         (long long)vertex_count);
    }
    compact_mesh(&mesh, merged, merged + vertex_count);
    free(merged);
    if (!mesh.triangle_count) {
        tobi_mesh_free(&mesh);
        return tobi_fail(err, TOBI_INVALID, "mesh '%s': all %lld triangles are collapsed to a line or "
                         "a point", name, (long long)triangle_count);
    }
    *out = mesh;
    return TOBI_OK;
}

tobi_status tobi_mesh_weld(tobi_mesh *mesh, double tolerance, const char *only)
{
    int32_t *merged = malloc((size_t)(mesh->vertex_count + 1)*2*sizeof *merged);
    tobi_status status = merged ? weld_vertices(mesh, tolerance, only, merged) : TOBI_NO_MEMORY;
    if (status == TOBI_OK) compact_mesh(mesh, merged, merged + mesh->vertex_count);
    free(merged);
    return status;
}

/* Rodrigues' rotation matrix for a unit axis. */
static void make_rotation(const double axis[3], double degrees, double r[3][3])
{
    double angle = degrees*(3.14159265358979323846/180), c = cos(angle), s = sin(angle);
    /* quarter turns exact, so that a turned box stays a box */
    if (fmod(degrees, 90) == 0) {
        c = nearbyint(c);
        s = nearbyint(s);
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) r[i][j] = axis[i]*axis[j]*(1 - c) + (i == j ? c : 0);
    r[0][1] -= axis[2]*s;
    r[0][2] += axis[1]*s;
    r[1][0] += axis[2]*s;
    r[1][2] -= axis[0]*s;
    r[2][0] -= axis[1]*s;
    r[2][1] += axis[0]*s;
}

static void place_points(int64_t count, double (*points)[3], const double scale[3], const double r[3][3],
                         const double translation[3])
{
    for (int64_t i = 0; i < count; i++) {
        double *x = points[i], s[3] = {scale[0]*x[0], scale[1]*x[1], scale[2]*x[2]};
        for (int k = 0; k < 3; k++) x[k] = vec3_dot(r[k], s) + translation[k];
    }
}

tobi_status tobi_mesh_transform(tobi_mesh *mesh, const double scale[3], const double axis[3],
                                double degrees, const double translation[3], tobi_error *err)
{
    double unit[3] = {axis[0], axis[1], axis[2]}, r[3][3], volume = scale[0]*scale[1]*scale[2];
    if (volume == 0 || !isfinite(volume))
        return tobi_fail(err, TOBI_INVALID, "scale (%g, %g, %g): every factor must be finite and not 0",
                         scale[0], scale[1], scale[2]);
    vec3_normalize(unit);
    if (!isfinite(degrees) || !isfinite(vec3_length(axis)) || (vec3_length(axis) == 0 && degrees != 0))
        return tobi_fail(err, TOBI_INVALID, "rotation by %g degrees about (%g, %g, %g): the angle must "
                         "be finite and the axis not zero", degrees, axis[0], axis[1], axis[2]);
    if (!isfinite(translation[0] + translation[1] + translation[2]))
        return tobi_fail(err, TOBI_INVALID, "translation (%g, %g, %g) must be finite", translation[0],
                         translation[1], translation[2]);
    double reach = 0;
    for (int64_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++) reach = fmax(reach, fabs(scale[k]*mesh->vertices[i][k]));
    reach = 2*reach + fmax(fabs(translation[0]), fmax(fabs(translation[1]), fabs(translation[2])));
    if (!(reach < LARGEST))
        return tobi_fail(err, TOBI_INVALID, "scale (%g, %g, %g) and translation (%g, %g, %g) put the mesh "
                         "further than %g m away", scale[0], scale[1], scale[2], translation[0],
                         translation[1], translation[2], LARGEST);
    make_rotation(unit, degrees, r);
    place_points(mesh->vertex_count, mesh->vertices, scale, (const double (*)[3])r, translation);
    if (mesh->texture)
        place_points(3*mesh->texture->count, mesh->texture->corner[0], scale, (const double (*)[3])r,
                     translation);
    for (int64_t t = 0; volume < 0 && t < mesh->triangle_count; t++) {
        int32_t swap = mesh->triangles[t][1];
        mesh->triangles[t][1] = mesh->triangles[t][2];
        mesh->triangles[t][2] = swap;
    }
    return TOBI_OK;
}

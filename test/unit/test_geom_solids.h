/* Meshes and random numbers for the tests of src/geom. */
#pragma once
#include "calls.h"
#include "geom/mesh.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

/* A relative difference of at most tolerance. */
#define NEAR(value, expected, tolerance)                                              \
    do {                                                                              \
        double near_v = (value), near_e = (expected);                                 \
        if (!(fabs(near_v - near_e) <= (tolerance)*fmax(fabs(near_e), 1e-300)))       \
            fail_msg("line %d: %s = %.12g, expected %.12g", __LINE__, #value, near_v, near_e); \
    } while (0)

/* An absolute difference of at most tolerance. */
#define WITHIN(value, expected, tolerance)                                            \
    do {                                                                              \
        double near_v = (value), near_e = (expected);                                 \
        if (!(fabs(near_v - near_e) <= (tolerance)))                                  \
            fail_msg("line %d: %s = %.12g, expected %.12g", __LINE__, #value, near_v, near_e); \
    } while (0)

static inline double random_number(uint64_t *state)   /* in [-1, 1) */
{
    *state = *state*6364136223846793005u + 1442695040888963407u;
    return (double)(int64_t)(*state >> 11)/(double)(1ll << 52) - 1;
}

static inline void random_point(uint64_t *state, double scale, double p[3])
{
    for (int k = 0; k < 3; k++) p[k] = scale*random_number(state);
}

/* A box with its corners at min and max; outward. */
static inline tobi_mesh make_box(const double min[3], const double max[3])
{
    double v[8][3];
    static const int32_t t[12][3] = {
        {0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
        {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5},
    };
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++) v[i][k] = i >> k & 1 ? max[k] : min[k];
    tobi_mesh mesh;
    OK(tobi_mesh_build("box", 8, (const double (*)[3])v, 12, t, &mesh, &err));
    return mesh;
}

static inline tobi_mesh make_cube(double half)
{
    return make_box((double[3]){-half, -half, -half}, (double[3]){half, half, half});
}

/* Puts b's triangles beside a's; b is freed. */
static inline tobi_mesh join_meshes(tobi_mesh a, tobi_mesh b)
{
    tobi_mesh out = {.vertex_count = a.vertex_count + b.vertex_count,
                     .triangle_count = a.triangle_count + b.triangle_count};
    out.vertices = malloc((size_t)out.vertex_count*sizeof *out.vertices);
    out.triangles = malloc((size_t)out.triangle_count*sizeof *out.triangles);
    if (a.vertex_count) memcpy(out.vertices, a.vertices, (size_t)a.vertex_count*sizeof *a.vertices);
    memcpy(out.vertices + a.vertex_count, b.vertices, (size_t)b.vertex_count*sizeof *b.vertices);
    if (a.triangle_count) memcpy(out.triangles, a.triangles, (size_t)a.triangle_count*sizeof *a.triangles);
    for (int64_t t = 0; t < b.triangle_count; t++)
        for (int k = 0; k < 3; k++)
            out.triangles[a.triangle_count + t][k] = b.triangles[t][k] + (int32_t)a.vertex_count;
    tobi_mesh_free(&a);
    tobi_mesh_free(&b);
    return out;
}

static inline double mesh_volume(const tobi_mesh *mesh)
{
    double sum = 0;
    for (int64_t t = 0; t < mesh->triangle_count; t++) {
        const double *a = mesh->vertices[mesh->triangles[t][0]], *b = mesh->vertices[mesh->triangles[t][1]],
                     *c = mesh->vertices[mesh->triangles[t][2]];
        sum += a[0]*(b[1]*c[2] - b[2]*c[1]) + a[1]*(b[2]*c[0] - b[0]*c[2]) + a[2]*(b[0]*c[1] - b[1]*c[0]);
    }
    return sum/6;
}

/* Reads one of the project's own meshes, path from the root of the sources. */
static inline tobi_mesh read_own(const char *path)
{
    char full[1000];
    tobi_mesh mesh;
    snprintf(full, sizeof full, "%s/%s", TOBI_SOURCE_DIR, path);
    OK(tobi_mesh_read(full, &mesh, &err));
    OK(tobi_mesh_orient(&mesh, path, &err));
    return mesh;
}

/* Our own half of the meshes: raw vertices and triangles as the importer's child would send them.

   Input: flags, exponent of the unit, vertex count, then three bytes per vertex (doubles with flag
   1), then three bytes per triangle. A mesh that passes the orientation has a volume, and every tree,
   piece and sample of it must be finite. */
#include "target.h"
#include "geom/bvh.h"
#include "geom/massprops.h"
#include "geom/sample.h"
#include "geom/section.h"
#include <math.h>

enum { VERTICES = 64, TRIANGLES = 128 };

static double length_of(const tobi_mesh *mesh, double lower[3], double upper[3])
{
    double size = 0;
    tobi_mesh_box(mesh, lower, upper);
    for (int k = 0; k < 3; k++) size = fmax(size, upper[k] - lower[k]);
    return size;
}

static void ask_tree(const tobi_mesh *mesh)
{
    tobi_error err = { 0 };
    tobi_bvh *bvh = NULL;
    const double (*vertices)[3] = (const double (*)[3])mesh->vertices;
    if (!passed(tobi_bvh_build(mesh->vertex_count, vertices, mesh->triangle_count,
                               (const int32_t (*)[3])mesh->triangles, &bvh, &err), &err)) return;
    double lower[3], upper[3];
    length_of(mesh, lower, upper);
    for (int i = 0; i < 27; i++) {
        static const double part[3] = { -0.25, 0.4375, 1.0 };
        double p[3];
        for (int k = 0, j = i; k < 3; k++, j /= 3) p[k] = lower[k] + part[j%3]*(upper[k] - lower[k]);
        tobi_bvh_hit hit;
        PROMISE(tobi_bvh_closest(bvh, p, INFINITY, &hit) == 1);
        PROMISE(hit.distance >= 0 && isfinite(hit.signed_distance) && hit.triangle >= 0 &&
                hit.triangle < mesh->triangle_count);
        tobi_bvh_inside(bvh, p);
        tobi_bvh_segment_hits(bvh, p, vertices[0]);
    }
    tobi_bvh_refit(bvh, vertices);
    tobi_bvh_free(bvh);
}

static void cut_surface(const tobi_mesh *mesh, int dimension, double spacing)
{
    tobi_error err = { 0 };
    tobi_quadrature surface;
    if (!passed(tobi_quadrature_build(mesh, spacing, dimension, &surface, &err), &err)) return;
    double *numbers = calloc((size_t)surface.count*7 + 1, sizeof *numbers);
    PROMISE(numbers);
    tobi_quadrature_update(&surface, (const double (*)[3])mesh->vertices,
                        (const int32_t (*)[3])mesh->triangles, (double (*)[3])numbers,
                        (double (*)[3])(numbers + 3*surface.count), numbers + 6*surface.count);
    for (int64_t i = 0; i < 7*surface.count; i++) PROMISE(isfinite(numbers[i]));
    free(numbers);
    tobi_quadrature_free(&surface);
}

static void sample(const tobi_mesh *mesh, int dimension, double spacing)
{
    tobi_error err = { 0 };
    double (*points)[3] = NULL;
    int64_t count = 0;
    if (!passed(tobi_sample_volume(mesh, NULL, spacing, dimension, &points, &count, &err), &err)) return;
    PROMISE(count > 0);
    for (int64_t i = 0; i < 3*count; i++) PROMISE(isfinite(points[i/3][i%3]));
    free(points);
}

static void use(tobi_mesh *mesh, int flags)
{
    tobi_error err = { 0 };
    tobi_massprops whole, plane;
    tobi_mesh copy;
    double lower[3], upper[3], size = length_of(mesh, lower, upper), axis[3] = { 0, 0.6, 0.8 };
    double scale[3] = { 1, flags & 2 ? -2 : 0.5, 1 }, shift[3] = { -lower[0], 0, -lower[2] };
    PROMISE(passed(tobi_mesh_copy(mesh, &copy, &err), &err));
    if (passed(tobi_massprops_volume(mesh, &whole, &err), &err))
        PROMISE(whole.volume > 0 && isfinite(whole.area + whole.centre[0] + whole.inertia[0]));
    if (passed(tobi_massprops_section(mesh, &plane, &err), &err)) PROMISE(isfinite(plane.volume));
    ask_tree(mesh);
    for (int dimension = 2; dimension <= 3; dimension++) {
        cut_surface(mesh, dimension, size/3);
        sample(mesh, dimension, size/5);
    }
    if (passed(tobi_mesh_refine(&copy, size/3, &err), &err) &&
        passed(tobi_mesh_transform(&copy, scale, axis, 10.0*flags, shift, &err), &err))
        if (passed(tobi_mesh_orient(&copy, "refined", &err), &err)) ask_tree(&copy);
    tobi_mesh_free(&copy);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    double vertices[VERTICES][3];
    int32_t triangles[TRIANGLES][3];
    reader r = { data, size };
    int flags = take_byte(&r), n = 0;
    double unit = ldexp(1.0, 2*(int8_t)take_byte(&r));
    int count = take_byte(&r)%(VERTICES + 1);
    for (int i = 0; i < 3*count; i++) {
        if (flags & 1) take(&r, &vertices[i/3][i%3], sizeof(double));
        else vertices[i/3][i%3] = (int8_t)take_byte(&r)*unit;
    }
    for (; r.left >= 3 && n < TRIANGLES; n++)
        for (int k = 0; k < 3; k++) triangles[n][k] = (int8_t)take_byte(&r);
    tobi_mesh mesh;
    tobi_error err = { 0 };
    if (!passed(tobi_mesh_build("fuzz", count, (const double (*)[3])vertices, n,
                                (const int32_t (*)[3])triangles, &mesh, &err), &err)) return 0;
    if (passed(tobi_mesh_orient(&mesh, "fuzz", &err), &err)) use(&mesh, flags);
    tobi_mesh_free(&mesh);
    return 0;
}

/* Points inside bodies and pieces of their surfaces. */
#include "test_geom_solids.h"
#include "geom/massprops.h"
#include "geom/sample.h"
#include <time.h>

typedef struct cloud {
    double (*points)[3];
    int64_t count;
} cloud;

static cloud fill(const tobi_mesh *mesh, double spacing, int dimension)
{
    cloud c;
    OK(tobi_sample_volume(mesh, NULL, spacing, dimension, &c.points, &c.count, &err));
    return c;
}

static tobi_bvh *build_tree(const tobi_mesh *m)
{
    tobi_bvh *bvh;
    OK(tobi_bvh_build(m->vertex_count, (const double (*)[3])m->vertices, m->triangle_count,
                      (const int32_t (*)[3])m->triangles, &bvh, &err));
    return bvh;
}

/* All points inside, none nearer to another than the spacing; returns count spacing^3 / volume. */
static double check_cloud(const tobi_mesh *mesh, cloud c, double spacing)
{
    tobi_bvh *bvh = build_tree(mesh);
    tobi_massprops p;
    OK(tobi_massprops_volume(mesh, &p, &err));
    double middle[3] = {0};
    for (int64_t i = 0; i < c.count; i++) {
        tobi_bvh_hit hit;
        assert_true(tobi_bvh_closest(bvh, c.points[i], INFINITY, &hit));
        if (hit.distance > 1e-9) assert_true(hit.signed_distance < 0);
        for (int k = 0; k < 3; k++) middle[k] += c.points[i][k]/(double)c.count;
    }
    for (int64_t i = 0; i < c.count; i += c.count/50 + 1)
        for (int64_t j = 0; j < c.count; j++) {
            double d2 = 0;
            for (int k = 0; k < 3; k++) d2 += pow(c.points[i][k] - c.points[j][k], 2);
            if (i != j) assert_true(d2 > pow(0.999*spacing, 2));
        }
    for (int k = 0; k < 3; k++) WITHIN(middle[k], p.centre[k], 0.3*spacing);
    tobi_bvh_free(bvh);
    return (double)c.count*spacing*spacing*spacing/p.volume;
}

static void volume_within_one_percent(void **state)
{
    (void)state;
    static const struct { const char *path; double spacing; } cases[] = {
        {"test/meshes/sphere.obj", 0.1},   {"test/meshes/sphere.obj", 0.083},
        {"test/meshes/sphere.obj", 0.05},
        {"test/meshes/box.obj", 0.1},      {"test/meshes/box.obj", 0.05},     {"test/meshes/box.obj", 0.08},
        {"test/meshes/box.obj", 0.0951},   {"test/meshes/cylinder.obj", 0.1}, {"test/meshes/torus.obj", 0.03},
        {"test/meshes/wedge.obj", 0.05},   {"test/meshes/wedge.obj", 0.041},
        {"scenes/flying_fish/meshes/fish.obj", 0.001},
        {"scenes/flying_fish/meshes/fish.obj", 0.002}, {"scenes/flying_fish/meshes/fish.obj", 0.003},
        {"scenes/flying_fish/meshes/fish.obj", 0.004},
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        tobi_mesh mesh = read_own(cases[i].path);
        clock_t t0 = clock();
        cloud c = fill(&mesh, cases[i].spacing, 3);
        double seconds = (double)(clock() - t0)/CLOCKS_PER_SEC;
        double ratio = check_cloud(&mesh, c, cases[i].spacing);
        printf("%-36s spacing %-6g %7lld points, volume %+.2f %% (%.0f ms)\n", cases[i].path,
               cases[i].spacing, (long long)c.count, 100*(ratio - 1), 1000*seconds);
        WITHIN(ratio, 1, 0.01);
        free(c.points);
        tobi_mesh_free(&mesh);
    }
}

/* A box that holds a whole number of particles gets exactly the lattice one would draw by hand. */
static void a_fitting_box_gets_the_plain_lattice(void **state)
{
    (void)state;
    tobi_mesh mesh = make_box((double[3]){1, 2, 3}, (double[3]){2, 2.5, 3.2});
    cloud c = fill(&mesh, 0.1, 3);
    assert_int_equal(c.count, 100);
    for (int64_t i = 0; i < c.count; i++) {
        WITHIN(c.points[i][0], 1 + 0.1*((double)(i/10) + 0.5), 1e-12);
        WITHIN(c.points[i][1], 2 + 0.1*((double)(i/2 % 5) + 0.5), 1e-12);
        WITHIN(c.points[i][2], 3 + 0.1*((double)(i % 2) + 0.5), 1e-12);
    }
    free(c.points);
    tobi_mesh_free(&mesh);
}

/* Wings of one to ten particles across keep their part of the points. */
static void thin_wings_get_their_share(void **state)
{
    (void)state;
    tobi_mesh fish = read_own("scenes/flying_fish/meshes/fish.obj");
    double reference = 0;
    static const double spacings[] = {0.0004, 0.001, 0.002, 0.004};
    for (int i = 0; i < 4; i++) {
        cloud c = fill(&fish, spacings[i], 3);
        int64_t wings = 0;
        for (int64_t k = 0; k < c.count; k++) wings += fabs(c.points[k][1]) > 0.0101;
        double volume = (double)wings*pow(spacings[i], 3);
        printf("wings at %g m: %.3f cm3\n", spacings[i], volume*1e6);
        if (i == 0) reference = volume;
        else NEAR(volume, reference, i == 1 ? 0.02 : 0.08);
        free(c.points);
    }
    tobi_mesh_free(&fish);
}

static void sections_are_filled_in_two_dimensions(void **state)
{
    (void)state;
    static const struct { const char *path; double spacing; } cases[] = {
        {"test/meshes/cylinder.obj", 0.1}, {"test/meshes/cylinder.obj", 0.02},
        {"test/meshes/torus.obj", 0.02},   {"test/meshes/box.obj", 0.1},
        {"test/meshes/box.obj", 0.08},     {"test/meshes/sphere.obj", 0.07},
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        tobi_mesh mesh = read_own(cases[i].path);
        tobi_bvh *bvh = build_tree(&mesh);
        tobi_massprops p;
        OK(tobi_massprops_section(&mesh, &p, &err));
        cloud c = fill(&mesh, cases[i].spacing, 2);
        double ratio = (double)c.count*pow(cases[i].spacing, 2)/p.volume;
        printf("2-D %-26s spacing %-5g %6lld points, area %+.2f %%\n", cases[i].path, cases[i].spacing,
               (long long)c.count, 100*(ratio - 1));
        WITHIN(ratio, 1, 0.01);
        for (int64_t k = 0; k < c.count; k++) {
            tobi_bvh_hit hit;
            assert_true(c.points[k][2] == 0 && tobi_bvh_closest(bvh, c.points[k], INFINITY, &hit));
            if (hit.distance > 1e-9) assert_true(hit.signed_distance < 0);
        }
        free(c.points);
        tobi_bvh_free(bvh);
        tobi_mesh_free(&mesh);
    }
}

static void refuses_what_cannot_be_filled(void **state)
{
    (void)state;
    tobi_mesh mesh = make_box((double[3]){0, 0, 0.5}, (double[3]){1, 1, 1.5});
    cloud c;
    REFUSED(tobi_sample_volume(&mesh, NULL, 0, 3, &c.points, &c.count, &err), TOBI_INVALID, "must be > 0");
    REFUSED(tobi_sample_volume(&mesh, NULL, NAN, 3, &c.points, &c.count, &err), TOBI_INVALID, "must be > 0");
    REFUSED(tobi_sample_volume(&mesh, NULL, 0.1, 4, &c.points, &c.count, &err), TOBI_INVALID, "2 and 3");
    REFUSED(tobi_sample_volume(&mesh, NULL, 1e-6, 3, &c.points, &c.count, &err), TOBI_INVALID, "too fine");
    REFUSED(tobi_sample_volume(&mesh, NULL, 0.1, 2, &c.points, &c.count, &err), TOBI_INVALID, "z = 0");
    assert_null(c.points);
    tobi_mesh_free(&mesh);
}

/* --- surfaces ----------------------------------------------------------------------------- */

static void pieces_cover_the_surface(void **state)
{
    (void)state;
    tobi_mesh mesh = read_own("scenes/flying_fish/meshes/fish.obj");
    tobi_massprops p;
    OK(tobi_massprops_volume(&mesh, &p, &err));
    static const double spacings[] = {0.004, 0.001};
    for (int i = 0; i < 2; i++) {
        tobi_quadrature s;
        OK(tobi_quadrature_build(&mesh, spacings[i], 3, &s, &err));
        double (*x)[3] = malloc((size_t)s.count*sizeof *x), (*n)[3] = malloc((size_t)s.count*sizeof *n);
        double *area = malloc((size_t)s.count*sizeof *area);
        double sum = 0, largest = 0, closed[3] = {0}, volume = 0;
        const int32_t (*t)[3] = (const int32_t (*)[3])mesh.triangles;
        tobi_quadrature_update(&s, (const double (*)[3])mesh.vertices, t, x, n, area);
        for (int64_t k = 0; k < s.count; k++) {
            sum += area[k];
            largest = fmax(largest, area[k]);
            for (int c = 0; c < 3; c++) {
                closed[c] += area[k]*n[k][c];
                volume += area[k]*n[k][c]*x[k][c]/3;
            }
            NEAR(n[k][0]*n[k][0] + n[k][1]*n[k][1] + n[k][2]*n[k][2], 1, 1e-12);
        }
        printf("fish at %g m: %lld pieces, largest %.3f spacing^2\n", spacings[i], (long long)s.count,
               largest/spacings[i]/spacings[i]);
        NEAR(sum, p.area, 1e-11);
        NEAR(volume, p.volume, 1e-10);      /* Gauss: exact, since x.n is linear on a piece */
        for (int c = 0; c < 3; c++) WITHIN(closed[c], 0, 1e-12*sum);
        assert_true(largest <= 0.4331*spacings[i]*spacings[i]);
        free(x);
        free(n);
        free(area);
        tobi_quadrature_free(&s);
    }
    tobi_mesh_free(&mesh);
}

static void pieces_move_with_the_mesh(void **state)
{
    (void)state;
    tobi_mesh mesh = make_cube(1);
    tobi_quadrature s;
    OK(tobi_quadrature_build(&mesh, 0.5, 3, &s, &err));
    double (*before)[3] = malloc((size_t)s.count*sizeof *before);
    double (*after)[3] = malloc((size_t)s.count*sizeof *after);
    double (*n)[3] = malloc((size_t)s.count*sizeof *n);
    double *area = malloc((size_t)s.count*sizeof *area), sum = 0;
    const int32_t (*t)[3] = (const int32_t (*)[3])mesh.triangles;
    tobi_quadrature_update(&s, (const double (*)[3])mesh.vertices, t, before, n, area);
    OK(tobi_mesh_transform(&mesh, (double[3]){3, 1, 1}, (double[3]){0, 0, 1}, 90, (double[3]){0, 5, 0},
                           &err));
    tobi_quadrature_update(&s, (const double (*)[3])mesh.vertices, t, after, n, area);
    for (int64_t i = 0; i < s.count; i++) {
        WITHIN(after[i][0], -before[i][1], 1e-12);
        WITHIN(after[i][1], 3*before[i][0] + 5, 1e-12);
        WITHIN(fabs(n[i][0]) + fabs(n[i][1]) + fabs(n[i][2]), 1, 1e-12);
        if (n[i][1] > 0.5) WITHIN(after[i][1], 8, 1e-12);
        sum += area[i];
    }
    NEAR(sum, 2*(12 + 12 + 4), 1e-13);
    /* a linear field is met exactly */
    tobi_quadrature_interpolate(&s, t, (const double (*)[3])mesh.vertices, n);
    for (int64_t i = 0; i < s.count; i++)
        for (int k = 0; k < 3; k++) WITHIN(n[i][k], after[i][k], 1e-12);
    free(before);
    free(after);
    free(n);
    free(area);
    tobi_quadrature_free(&s);
    tobi_mesh_free(&mesh);
}

static void outlines_in_two_dimensions(void **state)
{
    (void)state;
    tobi_mesh mesh = read_own("test/meshes/cylinder.obj");
    tobi_massprops p;
    tobi_quadrature s;
    OK(tobi_massprops_section(&mesh, &p, &err));
    OK(tobi_quadrature_build(&mesh, 0.03, 2, &s, &err));
    double (*x)[3] = malloc((size_t)s.count*sizeof *x), (*n)[3] = malloc((size_t)s.count*sizeof *n);
    double *length = malloc((size_t)s.count*sizeof *length);
    const int32_t (*t)[3] = (const int32_t (*)[3])mesh.triangles;
    /* shifted in the plane: pieces and their values follow */
    for (int64_t i = 0; i < mesh.vertex_count; i++) mesh.vertices[i][0] += 7;
    tobi_quadrature_update(&s, (const double (*)[3])mesh.vertices, t, x, n, length);
    double sum = 0, area = 0, first_moment = 0;
    for (int64_t i = 0; i < s.count; i++) {
        sum += length[i];
        area += 0.5*length[i]*(n[i][0]*x[i][0] + n[i][1]*x[i][1]);
        first_moment += length[i]*n[i][0];
        assert_true(length[i] <= 0.03 && x[i][2] == 0 && n[i][2] == 0);
        NEAR(n[i][0]*n[i][0] + n[i][1]*n[i][1], 1, 1e-12);
        double outward = n[i][0]*(x[i][0] - 7) + n[i][1]*x[i][1];
        WITHIN(outward, 0.5*cos(PI/48), 1e-7);
    }
    NEAR(sum, p.area, 1e-12);
    NEAR(area, p.volume, 1e-11);
    WITHIN(first_moment, 0, 1e-13);
    tobi_quadrature_interpolate(&s, t, (const double (*)[3])mesh.vertices, n);
    for (int64_t i = 0; i < s.count; i++) WITHIN(n[i][0], x[i][0], 1e-12);
    free(x);
    free(n);
    free(length);
    tobi_quadrature_free(&s);
    REFUSED(tobi_quadrature_build(&mesh, 0, 2, &s, &err), TOBI_INVALID, "must be > 0");
    REFUSED(tobi_quadrature_build(&mesh, 0.1, 1, &s, &err), TOBI_INVALID, "2 and 3");
    REFUSED(tobi_quadrature_build(&mesh, 1e-9, 3, &s, &err), TOBI_INVALID, "allow larger");
    tobi_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(volume_within_one_percent),
        cmocka_unit_test(a_fitting_box_gets_the_plain_lattice),
        cmocka_unit_test(thin_wings_get_their_share),
        cmocka_unit_test(sections_are_filled_in_two_dimensions),
        cmocka_unit_test(refuses_what_cannot_be_filled),
        cmocka_unit_test(pieces_cover_the_surface),
        cmocka_unit_test(pieces_move_with_the_mesh),
        cmocka_unit_test(outlines_in_two_dimensions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

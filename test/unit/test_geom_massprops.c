/* Exact integrals against closed forms. */
#include "test_geom_solids.h"
#include "geom/massprops.h"

static void box_anywhere(void **state)
{
    (void)state;
    /* the second pose is 10 km away: digits must not be lost to the distance */
    for (int far = 0; far < 2; far++) {
        double x = far ? 10000 : 0;
        tobi_mesh mesh = make_box((double[3]){x - 0.5, -1, 2}, (double[3]){x + 0.5, 1, 5});
        tobi_massprops p;
        OK(tobi_massprops_volume(&mesh, &p, &err));
        NEAR(p.volume, 6, 1e-14);
        NEAR(p.area, 2*(2 + 3 + 6), 1e-14);
        WITHIN(p.centre[0], x, 1e-12);
        WITHIN(p.centre[1], 0, 1e-14);
        NEAR(p.centre[2], 3.5, 1e-14);
        NEAR(p.inertia[0], 6.0/12*(4 + 9), 1e-13);
        NEAR(p.inertia[4], 6.0/12*(1 + 9), 1e-13);
        NEAR(p.inertia[8], 6.0/12*(1 + 4), 1e-13);
        for (int i = 0; i < 9; i++)
            if (i % 4) WITHIN(p.inertia[i], 0, 1e-12);
        tobi_mesh_free(&mesh);
    }
}

static void tetrahedron_with_products(void **state)
{
    (void)state;
    static const double v[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const int32_t t[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    tobi_mesh mesh;
    tobi_massprops p;
    OK(tobi_mesh_build("tetrahedron", 4, v, 4, t, &mesh, &err));
    OK(tobi_massprops_volume(&mesh, &p, &err));
    NEAR(p.volume, 1.0/6, 1e-14);
    for (int k = 0; k < 3; k++) NEAR(p.centre[k], 0.25, 1e-14);
    /* int x^2 = 1/60, int xy = 1/120; about the centre less V/16 each */
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            NEAR(p.inertia[3*i + j], i == j ? 2*(1.0/60 - 1.0/96) : -(1.0/120 - 1.0/96), 1e-12);
    tobi_mesh_free(&mesh);
}

static void a_hollow_box_loses_its_cavity(void **state)
{
    (void)state;
    tobi_mesh mesh = join_meshes(make_cube(1), make_cube(0.5));
    tobi_massprops p;
    OK(tobi_mesh_orient(&mesh, "hollow", &err));
    OK(tobi_massprops_volume(&mesh, &p, &err));
    NEAR(p.volume, 7, 1e-14);
    NEAR(p.inertia[0], 8.0/12*8 - 1.0/12*2, 1e-13);
    tobi_mesh_free(&mesh);
}

/* The polyhedra converge to the sphere with the square of the edge. */
static void sphere_in_the_limit(void **state)
{
    (void)state;
    tobi_mesh mesh = read_own("test/meshes/sphere.obj");
    double error[2], sphere = 4.0/3*PI*0.125;
    for (int fine = 0; fine < 2; fine++) {
        tobi_massprops p;
        if (fine) {
            OK(tobi_mesh_refine(&mesh, 0.045, &err));
            for (int64_t i = 0; i < mesh.vertex_count; i++) {
                double *x = mesh.vertices[i], s = 0.5/sqrt(x[0]*x[0] + x[1]*x[1] + x[2]*x[2]);
                for (int k = 0; k < 3; k++) x[k] *= s;
            }
        }
        OK(tobi_massprops_volume(&mesh, &p, &err));
        error[fine] = 1 - p.volume/sphere;
        double tolerance = 4e-3*sphere*(fine ? 0.3 : 1);
        for (int i = 0; i < 9; i++) WITHIN(p.inertia[i], i % 4 ? 0 : 0.4*0.25*sphere, tolerance);
    }
    printf("sphere: volume error %.2e, refined %.2e\n", error[0], error[1]);
    assert_true(error[0] > 0 && error[0] < 9e-3 && error[1] < error[0]/3);
    tobi_mesh_free(&mesh);
}

static void sections(void **state)
{
    (void)state;
    tobi_massprops p;
    tobi_mesh mesh = make_box((double[3]){1, 2, -3}, (double[3]){3, 5, 1});
    OK(tobi_massprops_section(&mesh, &p, &err));
    NEAR(p.volume, 6, 1e-14);
    NEAR(p.area, 10, 1e-14);
    NEAR(p.centre[0], 2, 1e-14);
    NEAR(p.centre[1], 3.5, 1e-14);
    NEAR(p.inertia[8], 6.0/12*(4 + 9), 1e-13);
    NEAR(p.inertia[0], 6.0/12*9, 1e-13);
    NEAR(p.inertia[4], 6.0/12*4, 1e-13);
    WITHIN(p.inertia[1], 0, 1e-13);
    tobi_mesh_free(&mesh);

    mesh = read_own("test/meshes/cylinder.obj");
    double side = 2*PI/48, polygon = 24*0.25*sin(side);
    OK(tobi_massprops_section(&mesh, &p, &err));
    NEAR(p.volume, polygon, 1e-7);
    NEAR(p.inertia[8], polygon*0.25*(2 + cos(side))/6, 1e-6);
    tobi_mesh_free(&mesh);

    /* an octahedron whose corners lie in the plane, and a hollow box: holes count negative */
    static const double v[6][3] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    static const int32_t t[8][3] = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4},
                                    {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}};
    OK(tobi_mesh_build("octahedron", 6, v, 8, t, &mesh, &err));
    OK(tobi_massprops_section(&mesh, &p, &err));
    NEAR(p.volume, 2, 1e-14);
    NEAR(p.inertia[8], 2.0/3, 1e-14);
    tobi_mesh_free(&mesh);
    mesh = join_meshes(make_cube(1), make_cube(0.5));
    OK(tobi_mesh_orient(&mesh, "hollow", &err));
    OK(tobi_massprops_section(&mesh, &p, &err));
    NEAR(p.volume, 3, 1e-14);
    tobi_mesh_free(&mesh);

    mesh = make_box((double[3]){0, 0, 1}, (double[3]){1, 1, 2});
    REFUSED(tobi_massprops_section(&mesh, &p, &err), TOBI_INVALID, "its z runs from 1 to 2 m");
    tobi_mesh_free(&mesh);
}

static void inside_out_is_refused(void **state)
{
    (void)state;
    tobi_mesh mesh = make_cube(1);
    tobi_massprops p;
    for (int t = 0; t < 12; t++) {
        int32_t swap = mesh.triangles[t][0];
        mesh.triangles[t][0] = mesh.triangles[t][1];
        mesh.triangles[t][1] = swap;
    }
    REFUSED(tobi_massprops_volume(&mesh, &p, &err), TOBI_INVALID, "oriented outwards");
    REFUSED(tobi_massprops_section(&mesh, &p, &err), TOBI_INVALID, "oriented outwards");
    tobi_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(box_anywhere),
        cmocka_unit_test(tetrahedron_with_products),
        cmocka_unit_test(a_hollow_box_loses_its_cavity),
        cmocka_unit_test(sphere_in_the_limit),
        cmocka_unit_test(sections),
        cmocka_unit_test(inside_out_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

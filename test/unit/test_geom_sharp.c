/* Sharp edges: where a blade cuts. */
#include "geom/sharp.h"
#include "geom/vec3.h"
#include "test_geom_solids.h"

/* A prism along y whose convex section (x, z) is given in order, in so many pieces. */
static tobi_mesh make_prism(const double (*section)[2], int n, double length, int pieces)
{
    tobi_mesh mesh;
    double (*v)[3] = malloc((size_t)(n*(pieces + 1))*sizeof *v);
    int32_t (*t)[3] = malloc((size_t)(2*n*pieces + 2*n)*sizeof *t);
    int64_t count = 0;
    for (int k = 0; k <= pieces; k++)
        for (int i = 0; i < n; i++) {
            v[k*n + i][0] = section[i][0];
            v[k*n + i][1] = length*(k/(double)pieces - 0.5);
            v[k*n + i][2] = section[i][1];
        }
    for (int k = 0; k < pieces; k++)
        for (int i = 0; i < n; i++) {
            int32_t a = k*n + i, b = k*n + (i + 1)%n;
            t[count][0] = a; t[count][1] = b; t[count++][2] = b + n;
            t[count][0] = a; t[count][1] = b + n; t[count++][2] = a + n;
        }
    for (int i = 1; i < n - 1; i++) {                    /* fans close a convex section */
        t[count][0] = 0; t[count][1] = i + 1; t[count++][2] = i;
        t[count][0] = pieces*n; t[count][1] = pieces*n + i; t[count++][2] = pieces*n + i + 1;
    }
    OK(tobi_mesh_build("prism", n*(pieces + 1), (const double (*)[3])v, count, (const int32_t (*)[3])t, &mesh,
                       &err));
    OK(tobi_mesh_orient(&mesh, "prism", &err));
    free(v);
    free(t);
    return mesh;
}

static double length_of(const tobi_sharp *s)
{
    double sum = 0;
    for (int64_t i = 0; i < s->count; i++) sum += sqrt(vec3_distance2(s->edge[i].a, s->edge[i].b));
    return sum;
}

/* Every piece is a chain's, and each has unit `ahead` across itself, and all normals look to one
   side. */
static void check_pieces(const tobi_sharp *s)
{
    double first[3] = { 0 };
    for (int64_t i = 0; i < s->count; i++) {
        const tobi_edge *e = &s->edge[i];
        double along[3], normal[3];
        vec3_sub(along, e->b, e->a);
        vec3_normalize(along);
        WITHIN(vec3_length(e->ahead), 1, 1e-12);
        WITHIN(vec3_dot(e->ahead, along), 0, 1e-12);
        vec3_cross(normal, along, e->ahead);
        if (i == 0) memcpy(first, normal, sizeof first);
        assert_true(vec3_dot(normal, first) > 0);
    }
}

static const double knife[5][2] = { { 0, 0 }, { 0.0015, 0.008 }, { 0.0015, 0.1 }, { -0.0015, 0.1 },
                                    { -0.0015, 0.008 } };

static void test_wedge_edge(void **state)
{
    (void)state;
    tobi_sharp s;
    tobi_mesh mesh = make_prism(knife, 5, 0.24, 12);
    OK(tobi_sharp_find(&mesh, 60, 0.0007, 0, &s, &err));
    assert_int_equal(s.count, 1);
    assert_true(s.width == 0);
    WITHIN(s.sharpest, 2*atan(0.0015/0.008)*180/PI, 1e-9);
    WITHIN(length_of(&s), 0.24, 1e-12);
    WITHIN(s.edge[0].ahead[2], -1, 1e-12);
    WITHIN(fabs(s.edge[0].a[1]), 0.12, 1e-12);
    check_pieces(&s);
    free(s.edge);
    /* The limit decides: the edge is 21.2 degrees sharp. */
    OK(tobi_sharp_find(&mesh, 21.1, 0.0007, 0, &s, &err));
    assert_int_equal(s.count, 0);
    assert_null(s.edge);
    tobi_mesh_free(&mesh);
}

/* Ground off by 30 um, or doubled by a facet of 200 um: one edge still, and none if no width is
   allowed. */
static void test_blunt_edge(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        double half = k ? 1e-4 : 1.5e-5;
        double section[6][2] = { { half, half*8/1.5 }, { 0.0015, 0.008 }, { 0.0015, 0.1 }, { -0.0015, 0.1 },
                                 { -0.0015, 0.008 }, { -half, half*8/1.5 } };
        tobi_sharp s;
        tobi_mesh mesh = make_prism(section, 6, 0.24, 12);
        OK(tobi_sharp_find(&mesh, 60, 0.0007, 0, &s, &err));
        assert_in_range(s.count, 1, 3);
        for (int64_t i = 0; i < s.count; i++) assert_true(fabs(s.edge[i].a[0]) <= half*1.001);
        assert_true(s.width >= 2*half && s.width <= 4*half);
        WITHIN(length_of(&s), 0.24, 1e-7);
        WITHIN(s.edge[0].ahead[2], -1, 1e-3);
        check_pieces(&s);
        free(s.edge);
        OK(tobi_sharp_find(&mesh, 60, half, 0, &s, &err));
        assert_int_equal(s.count, 0);
        tobi_mesh_free(&mesh);
    }
}

/* A round tip of 16 facets, 1.2 mm across. */
static void test_round_edge(void **state)
{
    (void)state;
    double section[19][2];
    for (int k = 0; k < 17; k++) {
        section[k][0] = 0.0006*sin((k - 8)/16.0*PI);
        section[k][1] = -0.0006*cos((k - 8)/16.0*PI);
    }
    section[17][0] = 0.002; section[17][1] = 0.05;
    section[18][0] = -0.002; section[18][1] = 0.05;
    tobi_sharp s;
    tobi_mesh mesh = make_prism(section, 19, 0.24, 30);
    OK(tobi_sharp_find(&mesh, 60, 0.0015, 0, &s, &err));
    assert_in_range(s.count, 1, 4);
    WITHIN(length_of(&s), 0.24, 0.0003);
    for (int64_t i = 0; i < s.count; i++) {
        assert_true(s.edge[i].ahead[2] < -0.9);
        WITHIN(s.edge[i].a[0], 0, 4e-4);
        WITHIN(s.edge[i].a[2], -0.0006, 1.5e-4);
    }
    check_pieces(&s);
    free(s.edge);
    tobi_mesh_free(&mesh);
}

/* No plate, ball, box or torus has an edge; a tetrahedron of 70.5 degrees has, if that is allowed.
   */
static void test_no_edge(void **state)
{
    (void)state;
    static const char *const names[] = { "sphere", "box", "cylinder", "torus" };
    tobi_sharp s;
    for (int k = 0; k < 4; k++) {
        tobi_mesh mesh;
        char path[300];
        snprintf(path, sizeof path, "%s/test/meshes/%s.obj", TOBI_SOURCE_DIR, names[k]);
        OK(tobi_mesh_read(path, &mesh, &err));
        OK(tobi_mesh_orient(&mesh, names[k], &err));
        OK(tobi_sharp_find(&mesh, 60, 0.05, 0, &s, &err));
        assert_int_equal(s.count, 0);
        assert_true(s.sharpest > 60);
        tobi_mesh_free(&mesh);
    }
    const double low[3] = { 0, 0, 0 }, high[3] = { 0.003, 0.1, 0.2 };
    tobi_mesh plate = make_box(low, high);
    OK(tobi_sharp_find(&plate, 60, 0.25*0.0029, 0, &s, &err));
    assert_int_equal(s.count, 0);
    WITHIN(s.sharpest, 90, 1e-9);
    OK(tobi_sharp_find(&plate, 91, 0.25*0.0029, 0, &s, &err));
    assert_true(s.count > 0);
    free(s.edge);
    tobi_mesh_free(&plate);
}

/* A lens: its rim is one closed edge, in two halves that meet. */
static void test_closed_edge(void **state)
{
    (void)state;
    enum { N = 60 };
    double v[N + 2][3] = { { 0, 0, 0.01 }, { 0, 0, -0.01 } };
    int32_t t[2*N][3];
    for (int i = 0; i < N; i++) {
        v[i + 2][0] = 0.1*cos(2*PI*i/N);
        v[i + 2][1] = 0.1*sin(2*PI*i/N);
        v[i + 2][2] = 0;
        t[2*i][0] = 0; t[2*i][1] = 2 + i; t[2*i][2] = 2 + (i + 1)%N;
        t[2*i + 1][0] = 1; t[2*i + 1][1] = 2 + (i + 1)%N; t[2*i + 1][2] = 2 + i;
    }
    tobi_mesh mesh;
    tobi_sharp s;
    OK(tobi_mesh_build("lens", N + 2, (const double (*)[3])v, 2*N, (const int32_t (*)[3])t, &mesh, &err));
    OK(tobi_mesh_orient(&mesh, "lens", &err));
    OK(tobi_sharp_find(&mesh, 60, 0.001, 0, &s, &err));
    NEAR(length_of(&s), 2*N*0.1*sin(PI/N), 2e-3);
    check_pieces(&s);
    for (int64_t i = 0; i < s.count; i++) {
        double middle[2] = { s.edge[i].a[0] + s.edge[i].b[0], s.edge[i].a[1] + s.edge[i].b[1] };
        assert_true(s.edge[i].ahead[0]*middle[0] + s.edge[i].ahead[1]*middle[1] > 0);
    }
    free(s.edge);
    tobi_mesh_free(&mesh);
}

/* In a section the edge is a point: 1 m of line along z. */
static void test_section(void **state)
{
    (void)state;
    tobi_mesh mesh = make_prism(knife, 5, 0.24, 1);
    const double unit[3] = { 1, 1, 1 }, x[3] = { 1, 0, 0 }, none[3] = { 0 };
    tobi_sharp s;
    OK(tobi_mesh_transform(&mesh, unit, x, 90, none, &err));        /* y -> z, z -> -y */
    OK(tobi_sharp_find(&mesh, 60, 0.0007, 1, &s, &err));
    assert_int_equal(s.count, 1);
    WITHIN(s.edge[0].a[2], -0.5, 0);
    WITHIN(s.edge[0].b[2], 0.5, 0);
    WITHIN(s.edge[0].ahead[1], 1, 1e-12);
    WITHIN(s.edge[0].a[0], 0, 1e-12);
    WITHIN(s.edge[0].b[1], 0, 1e-12);
    free(s.edge);
    tobi_mesh_free(&mesh);
}

/* The meshes of the scenes: the blade and the wedge have one straight edge, the wire has none. */
static void test_shipped(void **state)
{
    (void)state;
    static const struct { const char *file; double length, thickness; } meshes[] = {
        { "apple_cut/meshes/blade.obj", 0.24, 0.003 }, { "apple_cut_seed/knife2.obj", 0.24, 0.003 },
        { "wedge_split/meshes/wedge.obj", 0.1, 0.012 }, { "cheese_wire/meshes/wire.obj", 0, 0.0005 },
    };
    for (size_t k = 0; k < sizeof meshes/sizeof *meshes; k++) {
        tobi_mesh mesh;
        tobi_sharp s;
        char path[300];
        snprintf(path, sizeof path, "%s/scenes/%s", TOBI_SOURCE_DIR, meshes[k].file);
        OK(tobi_mesh_read(path, &mesh, &err));
        OK(tobi_mesh_orient(&mesh, path, &err));
        assert_string_equal(mesh.notes, "");
        OK(tobi_sharp_find(&mesh, 60, 0.25*meshes[k].thickness, 0, &s, &err));
        assert_int_equal(s.count, meshes[k].length > 0);
        WITHIN(length_of(&s), meshes[k].length, 1e-9);
        if (s.count) WITHIN(s.edge[0].ahead[2], -1, 1e-9);
        free(s.edge);
        tobi_mesh_free(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wedge_edge), cmocka_unit_test(test_blunt_edge),
        cmocka_unit_test(test_round_edge), cmocka_unit_test(test_no_edge),
        cmocka_unit_test(test_closed_edge), cmocka_unit_test(test_section),
        cmocka_unit_test(test_shipped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

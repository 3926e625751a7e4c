/* The search tree against brute force written in another way, and against closed forms. */
#include "test_geom_solids.h"
#include "geom/bvh.h"
#include "geom/vec3.h"

static tobi_bvh *build_tree(const tobi_mesh *m)
{
    tobi_bvh *bvh;
    OK(tobi_bvh_build(m->vertex_count, (const double (*)[3])m->vertices, m->triangle_count,
                      (const int32_t (*)[3])m->triangles, &bvh, &err));
    return bvh;
}

/* Distance from p to the segment a b. */
static double to_segment(const double p[3], const double a[3], const double b[3])
{
    double ab[3], ap[3], q[3];
    vec3_sub(ab, b, a);
    vec3_sub(ap, p, a);
    double s = fmin(1, fmax(0, vec3_dot(ab, ap)/vec3_dot(ab, ab)));
    vec3_add_scaled(q, a, s, ab);
    return sqrt(vec3_distance2(p, q));
}

/* Distance to a triangle: to its plane if the foot lies inside by the signs of three areas, else to
   its edges. */
static double to_triangle(const double p[3], const double a[3], const double b[3], const double c[3])
{
    double ab[3], ac[3], ap[3], n[3], foot[3];
    vec3_sub(ab, b, a);
    vec3_sub(ac, c, a);
    vec3_sub(ap, p, a);
    vec3_cross(n, ab, ac);
    vec3_normalize(n);
    double height = vec3_dot(n, ap);
    vec3_add_scaled(foot, p, -height, n);
    const double *corner[4] = {a, b, c, a};
    int inside = 1;
    for (int k = 0; k < 3; k++) {
        double e[3], f[3], x[3];
        vec3_sub(e, corner[k + 1], corner[k]);
        vec3_sub(f, foot, corner[k]);
        vec3_cross(x, e, f);
        inside &= vec3_dot(x, n) >= 0;
    }
    if (inside) return fabs(height);
    return fmin(to_segment(p, a, b), fmin(to_segment(p, b, c), to_segment(p, c, a)));
}

static double to_mesh(const tobi_mesh *m, const double p[3])
{
    double best = INFINITY;
    for (int64_t t = 0; t < m->triangle_count; t++)
        best = fmin(best, to_triangle(p, m->vertices[m->triangles[t][0]], m->vertices[m->triangles[t][1]],
                                      m->vertices[m->triangles[t][2]]));
    return best;
}

/* Winding number by solid angles: 1 inside, 0 outside. */
static double wind(const tobi_mesh *m, const double p[3])
{
    double sum = 0;
    for (int64_t t = 0; t < m->triangle_count; t++) {
        double e[3][3], n[3], l[3];
        for (int c = 0; c < 3; c++) {
            vec3_sub(e[c], m->vertices[m->triangles[t][c]], p);
            l[c] = vec3_length(e[c]);
        }
        vec3_cross(n, e[1], e[2]);
        sum += 2*atan2(vec3_dot(e[0], n), l[0]*l[1]*l[2] + vec3_dot(e[0], e[1])*l[2] +
                       vec3_dot(e[1], e[2])*l[0] + vec3_dot(e[2], e[0])*l[1]);
    }
    return sum/(4*PI);
}

static void check_against_brute_force(const tobi_mesh *m, const tobi_bvh *bvh, int n, double scale)
{
    uint64_t seed = 1;
    int insiders = 0;
    for (int i = 0; i < n; i++) {
        double p[3], q[3], limit = i % 3 ? INFINITY : 0.1*scale;
        random_point(&seed, i % 2 ? scale : 0.3*scale, p);
        tobi_bvh_hit hit;
        double expected = to_mesh(m, p);
        int found = tobi_bvh_closest(bvh, p, limit, &hit);
        assert_int_equal(found, expected < limit);
        if (!found) continue;
        WITHIN(hit.distance, expected, 1e-12*scale);
        WITHIN(sqrt(vec3_distance2(p, hit.point)), hit.distance, 1e-12*scale);
        memset(q, 0, sizeof q);
        for (int c = 0; c < 3; c++)
            vec3_add_scaled(q, q, hit.barycentric[c], m->vertices[m->triangles[hit.triangle][c]]);
        WITHIN(sqrt(vec3_distance2(q, hit.point)), 0, 1e-12*scale);
        NEAR(vec3_length(hit.normal), 1, 1e-12);
        int inside = wind(m, p) > 0.5;
        insiders += inside;
        if (expected < 1e-9*scale) continue;
        NEAR(hit.signed_distance, inside ? -hit.distance : hit.distance, 1e-12);
        assert_int_equal(tobi_bvh_inside(bvh, p), inside);
    }
    assert_true(insiders > n/200);
}

static void agrees_with_brute_force(void **state)
{
    (void)state;
    static const char *paths[] = {"test/meshes/box.obj", "test/meshes/sphere.obj", "test/meshes/torus.obj",
                                  "test/meshes/wedge.obj", "test/meshes/cylinder.obj"};
    for (int i = 0; i < 5; i++) {
        tobi_mesh mesh = read_own(paths[i]);
        tobi_bvh *bvh = build_tree(&mesh);
        check_against_brute_force(&mesh, bvh, 1000, 1);
        tobi_bvh_free(bvh);
        tobi_mesh_free(&mesh);
    }
    tobi_mesh fish = read_own("scenes/flying_fish/meshes/fish.obj");
    tobi_bvh *bvh = build_tree(&fish);
    check_against_brute_force(&fish, bvh, 600, 0.05);
    tobi_bvh_free(bvh);
    tobi_mesh_free(&fish);
}

static void few_triangles_fit_one_node(void **state)
{
    (void)state;
    static const double v[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const int32_t t[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    tobi_bvh *bvh;
    OK(tobi_bvh_build(4, v, 4, t, &bvh, &err));
    assert_true(tobi_bvh_inside(bvh, (double[3]){0.1, 0.1, 0.1}));
    assert_false(tobi_bvh_inside(bvh, (double[3]){0.4, 0.4, 0.4}));
    assert_true(tobi_bvh_segment_hits(bvh, (double[3]){-1, 0.1, 0.1}, (double[3]){2, 0.1, 0.1}));
    tobi_bvh_free(bvh);
    REFUSED(tobi_bvh_build(4, v, 0, t, &bvh, &err), TOBI_INVALID, "0 triangles");
    assert_null(bvh);
}

/* Near an edge or a corner the nearest face alone gives the wrong sign; the pseudonormal must not. */
static void sign_is_right_beside_edges_and_corners(void **state)
{
    (void)state;
    tobi_mesh mesh = make_cube(1);
    tobi_bvh *bvh = build_tree(&mesh);
    tobi_bvh_hit hit;
    uint64_t seed = 7;
    for (int i = 0; i < 20000; i++) {
        double p[3], beyond[3];
        for (int k = 0; k < 3; k++) {
            p[k] = (random_number(&seed) < 0 ? -1 : 1) + 1e-3*random_number(&seed)*(i % 3 != k);
            beyond[k] = fmax(0, fabs(p[k]) - 1);
        }
        double outside = vec3_length(beyond), inside = 1 - fmax(fabs(p[0]), fmax(fabs(p[1]), fabs(p[2])));
        assert_true(tobi_bvh_closest(bvh, p, 1, &hit));
        WITHIN(hit.signed_distance, outside > 0 ? outside : -inside, 1e-12);
    }
    assert_true(tobi_bvh_closest(bvh, (double[3]){2, 2, 2}, 9, &hit));
    for (int k = 0; k < 3; k++) NEAR(hit.normal[k], sqrt(1.0/3), 1e-12);    /* angle-weighted */
    assert_true(tobi_bvh_closest(bvh, (double[3]){2, 2, 0.3}, 9, &hit));
    NEAR(hit.normal[0], sqrt(0.5), 1e-12);
    WITHIN(hit.normal[2], 0, 1e-12);
    tobi_bvh_free(bvh);
    tobi_mesh_free(&mesh);
}

static void far_points_and_odd_numbers(void **state)
{
    (void)state;
    tobi_mesh mesh = make_box((double[3]){9999, 0, 0}, (double[3]){10000, 1, 1});
    tobi_bvh *bvh = build_tree(&mesh);
    tobi_bvh_hit hit;
    assert_true(tobi_bvh_closest(bvh, (double[3]){-1e6, 0.5, 0.25}, INFINITY, &hit));
    NEAR(hit.distance, 1e6 + 9999, 1e-14);
    NEAR(hit.point[2], 0.25, 1e-9);
    assert_true(tobi_bvh_closest(bvh, (double[3]){9999.5, 0.5, 1 + 1e-7}, 2e-7, &hit));
    WITHIN(hit.signed_distance, 1e-7, 1e-15);
    assert_false(tobi_bvh_closest(bvh, (double[3]){9999.5, 0.5, 1 + 1e-7}, 1e-7, &hit));
    assert_false(tobi_bvh_closest(bvh, (double[3]){NAN, 0.5, 0.5}, INFINITY, &hit));
    assert_false(tobi_bvh_inside(bvh, (double[3]){NAN, 0.5, 0.5}));
    assert_false(tobi_bvh_segment_hits(bvh, (double[3]){NAN, 0.5, 0.5}, (double[3]){0, 0, 0}));
    double min[3], max[3];
    tobi_bvh_box(bvh, min, max);
    assert_true(min[0] == 9999 && max[2] == 1);
    tobi_bvh_free(bvh);
    tobi_mesh_free(&mesh);
}

/* --- segments ----------------------------------------------------------------------------- */

static int brute_segment(const tobi_mesh *m, const double p[3], const double q[3])
{
    for (int64_t t = 0; t < m->triangle_count; t++) {
        double ab[3], ac[3], d[3], h[3], s[3], k[3];
        const double *a = m->vertices[m->triangles[t][0]];
        vec3_sub(ab, m->vertices[m->triangles[t][1]], a);
        vec3_sub(ac, m->vertices[m->triangles[t][2]], a);
        vec3_sub(d, q, p);
        vec3_cross(h, d, ac);
        double det = vec3_dot(ab, h);
        if (fabs(det) < 1e-300) continue;
        vec3_sub(s, p, a);
        vec3_cross(k, s, ab);
        double u = vec3_dot(s, h)/det, v = vec3_dot(d, k)/det, w = vec3_dot(ac, k)/det;
        if (u > 0 && v > 0 && u + v < 1 && w > 0 && w < 1) return 1;
    }
    return 0;
}

static void segments_agree_with_brute_force(void **state)
{
    (void)state;
    static const char *paths[] = {"test/meshes/torus.obj", "test/meshes/sphere.obj",
                                  "scenes/flying_fish/meshes/fish.obj"};
    for (int i = 0; i < 3; i++) {
        tobi_mesh mesh = read_own(paths[i]);
        tobi_bvh *bvh = build_tree(&mesh);
        uint64_t seed = 3;
        int hits = 0, n = i < 2 ? 4000 : 1500;
        for (int k = 0; k < n; k++) {
            double p[3], d[3], q[3];
            random_point(&seed, i < 2 ? 0.6 : 0.05, p);
            random_point(&seed, k % 2 ? 1 : 0.01, d);
            vec3_add_scaled(q, p, i < 2 ? 1 : 0.1, d);
            int hit = tobi_bvh_segment_hits(bvh, p, q);
            assert_int_equal(hit, brute_segment(&mesh, p, q));
            assert_int_equal(hit, tobi_bvh_segment_hits(bvh, q, p));
            hits += hit;
        }
        assert_true(hits > n/50 && hits < n);
        tobi_bvh_free(bvh);
        tobi_mesh_free(&mesh);
    }
}

/* Aimed at vertices and edge middles: nothing may slip through a closed surface. */
static void nothing_slips_through_edges(void **state)
{
    (void)state;
    tobi_mesh mesh = read_own("test/meshes/sphere.obj");
    tobi_bvh *bvh = build_tree(&mesh);
    uint64_t seed = 11;
    for (int64_t t = 0; t < mesh.triangle_count; t++)
        for (int k = 0; k < 6; k++) {
            const double *a = mesh.vertices[mesh.triangles[t][k % 3]],
                         *b = mesh.vertices[mesh.triangles[t][(k + 1) % 3]];
            double aim[3], from[3], to[3];
            random_point(&seed, 0.2, from);
            for (int c = 0; c < 3; c++) aim[c] = k < 3 ? a[c] : 0.5*(a[c] + b[c]);
            for (int c = 0; c < 3; c++) to[c] = from[c] + 3*(aim[c] - from[c]);
            assert_true(tobi_bvh_segment_hits(bvh, from, to));
        }
    tobi_bvh_free(bvh);
    tobi_mesh_free(&mesh);
}

static void past_an_edge_is_not_through(void **state)
{
    (void)state;
    static const double up[3] = {0, 0, 1}, down[3] = {0, 0, -1}, side[3] = {1, 0, 0};
    static const struct {
        double a[3], b[3];
        const double *normal_a, *normal_b;
        double cosine;
        int passes;
    } way[] = {
        {{0.8, 0.1, 1.05}, {1.1, 0.2, 0.9}, up, side, -0.25, 0},       /* past an edge of 90 degrees */
        {{0.8, 0.1, 1.05}, {1.1, 0.2, 0.9}, up, side, 0.25, 1},
        {{0.1, 0.1, 1.1}, {0.2, 0.3, -1.1}, up, down, -0.25, 1},       /* top to bottom */
        {{0.8, 0.1, 1}, {1.1, 0.2, 0.9}, up, side, -0.25, 0},         /* from the face itself */
        {{0.9, 0.1, 0.9}, {1.1, 0.2, 0.9}, up, side, -0.25, 0},       /* from behind it */
        {{0.1, 0.1, 1}, {0.2, 0.3, -1.1}, up, down, -0.25, 1},
        {{0.1, 0.1, 1.1}, {0.2, 0.3, -1}, up, down, -0.25, 1},
        {{0.1, 0.1, 1.1}, {1.2, 0.3, 1.1}, up, side, -0.25, 0},        /* beside it */
    };
    tobi_mesh mesh = make_cube(1);
    tobi_bvh *bvh = build_tree(&mesh);
    for (size_t k = 0; k < sizeof way/sizeof *way; k++) {
        assert_int_equal(tobi_bvh_segment_passes(bvh, way[k].a, way[k].b, way[k].normal_a, way[k].normal_b,
                                                 way[k].cosine), way[k].passes);
        assert_int_equal(tobi_bvh_segment_passes(bvh, way[k].b, way[k].a, way[k].normal_b, way[k].normal_a,
                                                 way[k].cosine), way[k].passes);
    }
    tobi_bvh_free(bvh);
    tobi_mesh_free(&mesh);
}

static void touching_is_no_crossing(void **state)
{
    (void)state;
    tobi_mesh mesh = make_cube(1);
    tobi_bvh *bvh = build_tree(&mesh);
    assert_false(tobi_bvh_segment_hits(bvh, (double[3]){2, 0.3, 0.1}, (double[3]){1, 0.3, 0.1}));
    assert_false(tobi_bvh_segment_hits(bvh, (double[3]){1, 0.3, 0.1}, (double[3]){0, 0.3, 0.1}));
    assert_true(tobi_bvh_segment_hits(bvh, (double[3]){1.001, 0.3, 0.1}, (double[3]){0.999, 0.3, 0.1}));
    assert_false(tobi_bvh_segment_hits(bvh, (double[3]){1, -0.5, 0}, (double[3]){1, 0.5, 0.2}));
    assert_false(tobi_bvh_segment_hits(bvh, (double[3]){-0.9, 0, 0}, (double[3]){0.9, 0.5, 0}));
    assert_false(tobi_bvh_segment_hits(bvh, (double[3]){0, 0, 0}, (double[3]){0, 0, 0}));
    /* both sides of a wing of 4 mm */
    assert_true(tobi_bvh_segment_hits(bvh, (double[3]){0, 0, 1.001}, (double[3]){0, 0, -1.001}));
    tobi_bvh_free(bvh);
    tobi_mesh_free(&mesh);
}

/* --- refit -------------------------------------------------------------------------------- */

static void bend(tobi_mesh *m)
{
    for (int64_t i = 0; i < m->vertex_count; i++) {
        double *x = m->vertices[i];
        x[1] += 0.02*sin(30*x[0]);
        x[2] += 3 + 5*x[1]*x[1];
    }
}

static void refit_follows_the_mesh(void **state)
{
    (void)state;
    tobi_mesh mesh = read_own("scenes/flying_fish/meshes/fish.obj");
    tobi_bvh *bvh = build_tree(&mesh);
    bend(&mesh);
    tobi_bvh_refit(bvh, (const double (*)[3])mesh.vertices);
    tobi_bvh *fresh = build_tree(&mesh);
    uint64_t seed = 9;
    for (int i = 0; i < 2000; i++) {
        double p[3], d[3], q[3];
        tobi_bvh_hit a, b;
        random_point(&seed, 0.1, p);
        random_point(&seed, 0.05, d);
        p[2] = 3 + 0.4*p[2];
        vec3_add_scaled(q, p, 1, d);
        assert_true(tobi_bvh_closest(bvh, p, INFINITY, &a) && tobi_bvh_closest(fresh, p, INFINITY, &b));
        NEAR(a.distance, b.distance, 1e-12);
        NEAR(a.signed_distance, b.signed_distance, 1e-9);
        assert_int_equal(tobi_bvh_segment_hits(bvh, p, q), tobi_bvh_segment_hits(fresh, p, q));
        if (i < 100) NEAR(a.distance, to_mesh(&mesh, p), 1e-10);
    }
    tobi_bvh_free(bvh);
    tobi_bvh_free(fresh);
    tobi_mesh_free(&mesh);
}

static void same_bits_for_any_number_of_threads(void **state)
{
    (void)state;
    tobi_mesh mesh = read_own("test/meshes/torus.obj");
    OK(tobi_mesh_refine(&mesh, 0.015, &err));
    tobi_bvh *bvh = build_tree(&mesh);
    enum { N = 4000 };
    static double p[N][3];
    static tobi_bvh_hit one[N], many[N];
    uint64_t seed = 21;
    for (int i = 0; i < N; i++) random_point(&seed, 0.6, p[i]);
    memset(one, 0, sizeof one);
    memset(many, 0, sizeof many);
    for (int i = 0; i < N; i++) tobi_bvh_closest(bvh, p[i], INFINITY, &one[i]);
    tobi_bvh_refit(bvh, (const double (*)[3])mesh.vertices);
#pragma omp parallel for num_threads(4) schedule(dynamic, 7)
    for (int i = 0; i < N; i++) tobi_bvh_closest(bvh, p[i], INFINITY, &many[i]);
    assert_memory_equal(one, many, sizeof one);
    tobi_bvh_free(bvh);
    tobi_mesh_free(&mesh);
}

/* Triangles without area, all in one place or thinner than rounding, must not upset anything. */
static void flat_triangles_are_harmless(void **state)
{
    (void)state;
    tobi_mesh cube = make_cube(1);
    /* split an edge of one triangle only, and close the gap with a triangle without area */
    double v[9][3];
    int32_t t[14][3];
    memcpy(v, cube.vertices, 8*sizeof v[0]);
    memcpy(t, cube.triangles, 12*sizeof t[0]);
    int32_t a = t[0][0], b = t[0][1], c = t[0][2];
    for (int k = 0; k < 3; k++) v[8][k] = 0.5*(v[a][k] + v[b][k]);
    memcpy(t[0], (int32_t[3]){a, 8, c}, sizeof t[0]);
    memcpy(t[12], (int32_t[3]){8, b, c}, sizeof t[12]);
    memcpy(t[13], (int32_t[3]){a, b, 8}, sizeof t[13]);
    tobi_mesh mesh;
    OK(tobi_mesh_build("sliver", 9, (const double (*)[3])v, 14, (const int32_t (*)[3])t, &mesh, &err));
    assert_int_equal(mesh.triangle_count, 14);
    OK(tobi_mesh_orient(&mesh, "sliver", &err));
    tobi_bvh *bvh = build_tree(&mesh);
    uint64_t seed = 4;
    for (int i = 0; i < 20000; i++) {
        double p[3];
        random_point(&seed, 1.4, p);
        int inside = fabs(p[0]) < 1 && fabs(p[1]) < 1 && fabs(p[2]) < 1;
        assert_int_equal(tobi_bvh_inside(bvh, p), inside);
    }
    tobi_bvh_free(bvh);
    tobi_mesh_free(&mesh);
    tobi_mesh_free(&cube);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_brute_force),
        cmocka_unit_test(few_triangles_fit_one_node),
        cmocka_unit_test(sign_is_right_beside_edges_and_corners),
        cmocka_unit_test(far_points_and_odd_numbers),
        cmocka_unit_test(segments_agree_with_brute_force),
        cmocka_unit_test(nothing_slips_through_edges),
        cmocka_unit_test(past_an_edge_is_not_through),
        cmocka_unit_test(touching_is_no_crossing),
        cmocka_unit_test(refit_follows_the_mesh),
        cmocka_unit_test(same_bits_for_any_number_of_threads),
        cmocka_unit_test(flat_triangles_are_harmless),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

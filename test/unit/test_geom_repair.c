/* Meshes as they come from CAD: what is repaired gives exact figures and is said; what cannot be decided is
   refused with its place. */
#include "test_geom_solids.h"
#include "geom/bvh.h"
#include "geom/massprops.h"
#include "geom/mesh_mend.h"
#include "geom/sample.h"
#include "geom/vec3.h"

static void turn(int32_t t[3])
{
    int32_t swap = t[0];
    t[0] = t[1];
    t[1] = swap;
}

/* The note must be there; without words there must be none. */
static void says(const tobi_mesh *mesh, const char *words)
{
    if (words ? !strstr(mesh->notes, words) : mesh->notes[0] != 0)
        fail_msg("notes \"%s\" do not say \"%s\"", mesh->notes, words ? words : "nothing");
}

static tobi_mesh rebuild(tobi_mesh mesh)
{
    tobi_mesh out;
    OK(tobi_mesh_build("rebuilt", mesh.vertex_count, (const double (*)[3])mesh.vertices, mesh.triangle_count,
                       (const int32_t (*)[3])mesh.triangles, &out, &err));
    tobi_mesh_free(&mesh);
    return out;
}

static void has_volume(const tobi_mesh *mesh, double volume, double tolerance)
{
    tobi_massprops p;
    OK(tobi_massprops_volume(mesh, &p, &err));
    NEAR(p.volume, volume, tolerance);
}

static void a_good_mesh_needs_no_words(void **state)
{
    (void)state;
    tobi_mesh mesh = make_cube(1);
    OK(tobi_mesh_orient(&mesh, "cube", &err));
    says(&mesh, NULL);
    assert_false(mesh.overlapping);
    tobi_mesh_free(&mesh);
    mesh = read_own("scenes/flying_fish/meshes/fish.obj");
    says(&mesh, NULL);
    tobi_mesh_free(&mesh);
}

static void flipped_faces_are_turned_and_counted(void **state)
{
    (void)state;
    tobi_mesh mesh = make_cube(1);
    for (int t = 0; t < 12; t++) turn(mesh.triangles[t]);
    OK(tobi_mesh_orient(&mesh, "inside out", &err));
    has_volume(&mesh, 8, 1e-15);
    says(&mesh, "1 of 1 shells turned");
    tobi_mesh_free(&mesh);
    mesh = make_cube(1);
    for (int t = 0; t < 12; t += 4) turn(mesh.triangles[t]);
    OK(tobi_mesh_orient(&mesh, "three faces", &err));
    has_volume(&mesh, 8, 1e-15);
    says(&mesh, "3 of 12 triangles turned");
    tobi_mesh_free(&mesh);
}

static void shells_beside_and_within_each_other(void **state)
{
    (void)state;
    tobi_mesh mesh = join_meshes(make_cube(1), make_box((double[3]){3, 0, 0}, (double[3]){4, 1, 1}));
    OK(tobi_mesh_orient(&mesh, "two", &err));
    has_volume(&mesh, 9, 1e-14);
    says(&mesh, NULL);
    tobi_mesh_free(&mesh);
    mesh = join_meshes(make_cube(2), make_cube(1));
    OK(tobi_mesh_orient(&mesh, "hollow", &err));
    has_volume(&mesh, 64 - 8, 1e-14);
    says(&mesh, "1 of 2 shells lie inside another one and are hollows; those of a body are filled");
    assert_false(mesh.overlapping);
    tobi_mesh_free(&mesh);
}

/* A bar through a cube, (2 x 2 x 2) and (4 x 0.5 x 0.5): they share 2 x 0.5 x 0.5. */
static void overlapping_solids_count_once(void **state)
{
    (void)state;
    tobi_mesh mesh = join_meshes(make_cube(1), make_box((double[3]){-1.5, -0.25, -0.25},
                                                        (double[3]){2.5, 0.25, 0.25}));
    tobi_bvh *bvh;
    tobi_massprops p;
    tobi_bvh_hit hit;
    OK(tobi_mesh_orient(&mesh, "bar", &err));
    assert_true(mesh.overlapping);
    says(&mesh, "parts of the surface overlap");
    OK(tobi_massprops_volume(&mesh, &p, &err));
    NEAR(p.volume, 8.5, 2e-4);
    /* the parts that stick out: 0.5 long at x = -1.25, 1.5 long at x = 1.75, section 0.25 */
    /* half a line spacing, 4 m/1000, over the shared 0.5 m3 of 8.5 */
    WITHIN(p.centre[0], (0.125*-1.25 + 0.375*1.75)/8.5, 1.2e-4);
    double xx = 8*4/12. + 0.125*(0.25/12 + 1.25*1.25) + 0.375*(2.25/12 + 1.75*1.75);
    double yy = 8*4/12. + 0.5*0.25/12;
    NEAR(p.inertia[8], xx + yy - 8.5*p.centre[0]*p.centre[0], 1e-3);
    OK(tobi_bvh_build(mesh.vertex_count, (const double (*)[3])mesh.vertices, mesh.triangle_count,
                      (const int32_t (*)[3])mesh.triangles, &bvh, &err));
    tobi_bvh_use_winding(bvh);
    uint64_t seed = 3;
    for (int i = 0; i < 20000; i++) {
        double x[3];
        random_point(&seed, 2.7, x);
        int in_cube = fabs(x[0]) < 1 && fabs(x[1]) < 1 && fabs(x[2]) < 1;
        int in_bar = x[0] > -1.5 && x[0] < 2.5 && fabs(x[1]) < 0.25 && fabs(x[2]) < 0.25;
        assert_int_equal(tobi_bvh_winding(bvh, x), in_cube + in_bar);
        assert_int_equal(tobi_bvh_inside(bvh, x), in_cube || in_bar);
        assert_int_equal(tobi_bvh_closest(bvh, x, INFINITY, &hit) && hit.signed_distance < 0,
                         in_cube || in_bar);
    }
    tobi_bvh_free(bvh);
    double (*points)[3];
    int64_t count;
    OK(tobi_sample_volume(&mesh, NULL, 0.1, 3, &points, &count, &err));
    NEAR((double)count*0.001, 8.5, 0.01);
    for (int64_t i = 0; i < count; i++)
        for (int64_t j = i + 1; j < count && j < i + 3; j++)
            assert_true(vec3_distance2(points[i], points[j]) > 0.0099);
    free(points);
    OK(tobi_massprops_section(&mesh, &p, &err));
    NEAR(p.volume, 4 + 0.5*0.5 + 1.5*0.5, 1e-3);
    tobi_mesh_free(&mesh);
}

static void a_winding_number_is_exact_on_any_line(void **state)
{
    (void)state;
    /* points straight below vertices and edges, where a line is counted twice or not at all if the rule
       for ties is wrong */
    tobi_mesh mesh = make_cube(1);
    tobi_bvh *bvh;
    OK(tobi_bvh_build(mesh.vertex_count, (const double (*)[3])mesh.vertices, mesh.triangle_count,
                      (const int32_t (*)[3])mesh.triangles, &bvh, &err));
    for (int i = -4; i <= 4; i++)
        for (int j = -4; j <= 4; j++) {
            double below[3] = {i/4.0, j/4.0, -1.5}, middle[3] = {i/4.0, j/4.0, 0.1};
            assert_int_equal(tobi_bvh_winding(bvh, below), 0);
            if (i > -4 && i < 4 && j > -4 && j < 4) assert_int_equal(tobi_bvh_winding(bvh, middle), 1);
        }
    tobi_bvh_free(bvh);
    tobi_mesh_free(&mesh);
}

/* make_box's triangles 4 and 5 close the lower z; 2 and 3 the upper. */
static void a_missing_face_is_closed(void **state)
{
    (void)state;
    tobi_mesh mesh = make_box((double[3]){0, 0, 0}, (double[3]){1, 2, 3});
    tobi_massprops p;
    memmove(mesh.triangles, mesh.triangles + 2, 10*sizeof *mesh.triangles);
    mesh.triangle_count = 10;
    for (int t = 0; t < 10; t += 3) turn(mesh.triangles[t]);
    OK(tobi_mesh_orient(&mesh, "open box", &err));
    assert_int_equal(mesh.triangle_count, 12);
    OK(tobi_massprops_volume(&mesh, &p, &err));
    NEAR(p.volume, 6, 1e-14);
    NEAR(p.centre[2], 1.5, 1e-14);
    NEAR(p.inertia[0], 6*(4 + 9)/12., 1e-13);
    says(&mesh, "1 hole (4 open edges): 6 m around at (0.5, 1, 0) closed");
    says(&mesh, "to within 0.1 %");
    tobi_mesh_free(&mesh);
}

static void a_hole_that_says_too_little_is_refused(void **state)
{
    (void)state;
    /* a ring of walls 0.2 m high whose halves stand 1.2 m above each other: each lid is a guess */
    enum { N = 24 };
    double v[2*N][3];
    int32_t t[2*N][3];
    for (int i = 0; i < N; i++) {
        double a = 2*PI*i/N, z = i % 12 < 6 ? 0.6 : -0.6;
        for (int k = 0; k < 2; k++)
            memcpy(v[2*i + k], (double[3]){cos(a), sin(a), z + (k ? 0.1 : -0.1)}, sizeof v[0]);
        int j = (i + 1) % N;
        memcpy(t[2*i], (int32_t[3]){2*i, 2*j, 2*j + 1}, sizeof t[0]);
        memcpy(t[2*i + 1], (int32_t[3]){2*i, 2*j + 1, 2*i + 1}, sizeof t[0]);
    }
    tobi_mesh mesh;
    OK(tobi_mesh_build("crown", 2*N, (const double (*)[3])v, 2*N, (const int32_t (*)[3])t, &mesh, &err));
    REFUSED(tobi_mesh_orient(&mesh, "crown", &err), TOBI_INVALID,
            "does not say what is inside: 2 holes (48 open");
    tobi_mesh_free(&mesh);
    /* a single sheet */
    static const int32_t sheet[2][3] = {{0, 1, 2}, {0, 2, 3}};
    static const double corner[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    OK(tobi_mesh_build("sheet", 4, corner, 2, sheet, &mesh, &err));
    REFUSED(tobi_mesh_orient(&mesh, "sheet", &err), TOBI_INVALID, "1 hole (4 open edges): 4 m around");
    tobi_mesh_free(&mesh);
}

/* Six faces of a cube that do not share a vertex, each 1e-5 off the others, written without an order. */
static void borders_that_nearly_meet_are_welded(void **state)
{
    (void)state;
    tobi_mesh cube = make_cube(1), mesh;
    double v[36][3];
    int32_t t[12][3];
    uint64_t seed = 9;
    for (int i = 0; i < 36; i++) {
        memcpy(v[i], cube.vertices[cube.triangles[i/3][i % 3]], sizeof v[i]);
        for (int k = 0; k < 3; k++) v[i][k] += 1e-5*random_number(&seed);
        t[i/3][i % 3] = i;
    }
    OK(tobi_mesh_build("gaps", 36, (const double (*)[3])v, 12, (const int32_t (*)[3])t, &mesh, &err));
    assert_int_equal(mesh.vertex_count, 36);
    OK(tobi_mesh_orient(&mesh, "gaps", &err));
    assert_int_equal(mesh.vertex_count, 8);
    has_volume(&mesh, 8, 1e-4);
    says(&mesh, "36 open edges became 0");
    tobi_mesh_free(&mesh);
    tobi_mesh_free(&cube);
}

/* One face of the cube is cut finer along an edge than its neighbour: a crack without width. */
static void cracks_between_tessellations_are_closed(void **state)
{
    (void)state;
    tobi_mesh mesh = make_cube(1);
    mesh.vertices = realloc(mesh.vertices, 10*sizeof *mesh.vertices);
    mesh.triangles = realloc(mesh.triangles, 14*sizeof *mesh.triangles);
    /* triangle 0 is (0, 2, 1); put vertex 8 on its edge 1-0 */
    for (int k = 0; k < 3; k++) mesh.vertices[8][k] = 0.5*(mesh.vertices[0][k] + mesh.vertices[1][k]);
    memcpy(mesh.triangles[0], (int32_t[3]){0, 2, 8}, sizeof *mesh.triangles);
    memcpy(mesh.triangles[12], (int32_t[3]){8, 2, 1}, sizeof *mesh.triangles);
    mesh.vertex_count = 9;
    mesh.triangle_count = 13;
    OK(tobi_mesh_orient(&mesh, "crack", &err));
    assert_int_equal(mesh.triangle_count, 14);
    has_volume(&mesh, 8, 1e-14);
    says(&mesh, "1 hole (3 open edges)");
    tobi_mesh_free(&mesh);
}

static void double_triangles_and_touching_solids(void **state)
{
    (void)state;
    /* two cubes share a face: the wall between them goes */
    tobi_mesh mesh = rebuild(join_meshes(make_cube(1), make_box((double[3]){1, -1, -1},
                                                                (double[3]){3, 1, 1})));
    assert_int_equal(mesh.vertex_count, 12);
    OK(tobi_mesh_orient(&mesh, "face", &err));
    has_volume(&mesh, 16, 1e-14);
    says(&mesh, "double triangles dropped");
    tobi_mesh_free(&mesh);
    /* a triangle given twice */
    mesh = make_cube(1);
    mesh.triangles = realloc(mesh.triangles, 13*sizeof *mesh.triangles);
    memcpy(mesh.triangles[12], mesh.triangles[4], sizeof *mesh.triangles);
    mesh.triangle_count = 13;
    OK(tobi_mesh_orient(&mesh, "twice", &err));
    assert_int_equal(mesh.triangle_count, 12);
    has_volume(&mesh, 8, 1e-14);
    tobi_mesh_free(&mesh);
    /* two cubes share an edge: four triangles meet there */
    mesh = rebuild(join_meshes(make_cube(1), make_box((double[3]){1, 1, -1}, (double[3]){2, 2, 1})));
    assert_int_equal(mesh.vertex_count, 14);
    OK(tobi_mesh_orient(&mesh, "edge", &err));
    assert_int_equal(mesh.vertex_count, 16);
    has_volume(&mesh, 8 + 2, 1e-14);
    says(&mesh, "1 edges with more than two triangles taken apart");
    OK(tobi_mesh_refine(&mesh, 0.5, &err));
    has_volume(&mesh, 8 + 2, 1e-13);
    tobi_mesh_free(&mesh);
    /* a fin without thickness on a cube */
    mesh = make_cube(1);
    mesh.vertices = realloc(mesh.vertices, 9*sizeof *mesh.vertices);
    mesh.triangles = realloc(mesh.triangles, 13*sizeof *mesh.triangles);
    memcpy(mesh.vertices[8], (double[3]){-1, -1, 5}, sizeof *mesh.vertices);
    memcpy(mesh.triangles[12], (int32_t[3]){0, 1, 8}, sizeof *mesh.triangles);
    mesh.vertex_count = 9;
    mesh.triangle_count = 13;
    REFUSED(tobi_mesh_orient(&mesh, "fin", &err), TOBI_INVALID, "shell around (0, -1, 2) encloses no volume");
    tobi_mesh_free(&mesh);
}

/* Cubes of side 1 where solid is set, as one surface without the walls between them. */
static tobi_mesh make_voxels(const int size[3], const char *solid)
{
    tobi_mesh all = {0};
    for (int i = 0; i < size[0]*size[1]*size[2]; i++) {
        double low[3] = {i % size[0], i/size[0] % size[1], i/size[0]/size[1]};
        if (solid[i]) all = join_meshes(all, make_box(low, (double[3]){low[0] + 1, low[1] + 1, low[2] + 1}));
    }
    return rebuild(all);
}

static void is_closed(const tobi_mesh *mesh)
{
    tobi_edge_report report;
    int32_t (*opposite)[3] = malloc((size_t)mesh->triangle_count*sizeof *opposite);
    OK(tobi_edges_match(mesh->vertex_count, mesh->triangle_count, (const int32_t (*)[3])mesh->triangles,
                        opposite, &report));
    assert_int_equal(report.open + report.non_manifold, 0);
    free(opposite);
}

/* Eight cubes in a chain around an edge of which two touch, but only along it: one solid, and the vertices
   at both ends of the edge hang together, so that doubling them would not part it. */
static void a_solid_may_touch_itself_along_an_edge(void **state)
{
    (void)state;
    static const char chain[] = {1, 0, 1, 1,  1, 0, 0, 1,  1, 1, 0, 1};
    tobi_mesh mesh = make_voxels((int[3]){2, 2, 3}, chain);
    OK(tobi_mesh_orient(&mesh, "chain", &err));
    is_closed(&mesh);
    has_volume(&mesh, 8, 1e-14);
    assert_false(mesh.overlapping);
    says(&mesh, "1 edges with more than two triangles taken apart");
    OK(tobi_mesh_refine(&mesh, 0.3, &err));
    is_closed(&mesh);
    has_volume(&mesh, 8, 1e-13);
    tobi_mesh_free(&mesh);
}

/* Of each of n^3 cubes six tetrahedra, from (0, 0, 0) along the axes in one order each; those where solid
   is set, as one surface without the walls between them. */
static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}};

static tobi_mesh make_sponge(int n, const char *solid)
{
    static const int32_t face[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    int64_t count = 6*n*n*n, kept = 0;
    double (*v)[3] = calloc((size_t)(4*count), sizeof *v);
    int32_t (*t)[3] = calloc((size_t)(4*count), sizeof *t);
    for (int64_t i = 0; i < count; i++) {
        int64_t cell = i/6;
        if (!solid[i]) continue;
        for (int k = 0; k < 4; k++) {
            double *x = v[4*kept + k];
            memcpy(x, (double[3]){cell % n, cell/n % n, cell/n/n}, sizeof *v);
            for (int a = 0; a < k; a++) x[orders[i % 6][a]]++;
            int32_t *f = t[4*kept + k];
            for (int c = 0; c < 3; c++) f[c] = (int32_t)(4*kept) + face[k][c];
            if (i % 6 >= 3) turn(f);      /* an odd order mirrors the tetrahedron */
        }
        kept++;
    }
    tobi_mesh mesh;
    OK(tobi_mesh_build("sponge", 4*kept, (const double (*)[3])v, 4*kept, (const int32_t (*)[3])t, &mesh,
                       &err));
    free(v);
    free(t);
    return mesh;
}

/* Which tetrahedron of make_sponge holds x. */
static int find_tetrahedron(int n, const double x[3])
{
    int cell = 0, order = 0;
    double r[3];
    for (int k = 2; k >= 0; k--) {
        cell = n*cell + (int)x[k];
        r[k] = x[k] - (int)x[k];
    }
    for (; order < 5; order++) {
        const int *axis = orders[order];
        if (r[axis[0]] >= r[axis[1]] && r[axis[1]] >= r[axis[2]]) break;
    }
    return 6*cell + order;
}

/* A sponge of tetrahedra touches itself along many edges, with two and three pairs of triangles, with wedges
   above 180 degrees, and with several such edges of one triangle; whichever way its triangles look. */
static void sponges_keep_their_volume(void **state)
{
    (void)state;
    enum { N = 6 };
    uint64_t seed = 11;
    for (int round = 0; round < 8; round++) {
        char solid[6*N*N*N];
        int count = 0;
        for (int i = 0; i < 6*N*N*N; i++) count += solid[i] = random_number(&seed) < 0.2*(round % 4) - 0.1;
        tobi_mesh mesh = make_sponge(N, solid);
        tobi_bvh *bvh;
        for (int64_t t = 0; round >= 4 && t < mesh.triangle_count; t++) turn(mesh.triangles[t]);
        OK(tobi_mesh_orient(&mesh, "sponge", &err));
        is_closed(&mesh);
        has_volume(&mesh, count/6., 1e-13);
        assert_false(mesh.overlapping);
        OK(tobi_bvh_build(mesh.vertex_count, (const double (*)[3])mesh.vertices, mesh.triangle_count,
                          (const int32_t (*)[3])mesh.triangles, &bvh, &err));
        for (int i = 0; i < 3000; i++) {
            double x[3];
            random_point(&seed, 0.5*N, x);
            for (int k = 0; k < 3; k++) x[k] += 0.5*N;
            int in = solid[find_tetrahedron(N, x)];
            assert_int_equal(tobi_bvh_winding(bvh, x), in);
            assert_int_equal(tobi_bvh_inside(bvh, x), in);
        }
        tobi_bvh_free(bvh);
        tobi_mesh_free(&mesh);
    }
}

/* A blade whose edge lies in the inner corner of an L, whose own edge there has 270 degrees: near it the
   nearest feature may be of the blade or of the L, and both must tell inside from outside. */
static void a_blade_in_a_corner(void **state)
{
    (void)state;
    static const char corner[] = {1, 1, 1, 0};
    static const double v[6][3] = {{1, 1, 0}, {2, 1.2, 0}, {1.2, 2, 0}, {1, 1, 1}, {2, 1.2, 1}, {1.2, 2, 1}};
    static const int32_t t[8][3] = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                                    {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
    tobi_mesh mesh, blade;
    tobi_bvh *bvh;
    uint64_t seed = 5;
    OK(tobi_mesh_build("blade", 6, v, 8, t, &blade, &err));
    mesh = rebuild(join_meshes(make_voxels((int[3]){2, 2, 1}, corner), blade));
    OK(tobi_mesh_orient(&mesh, "corner", &err));
    is_closed(&mesh);
    has_volume(&mesh, 3 + 0.48, 1e-14);
    OK(tobi_bvh_build(mesh.vertex_count, (const double (*)[3])mesh.vertices, mesh.triangle_count,
                      (const int32_t (*)[3])mesh.triangles, &bvh, &err));
    for (int i = 0; i < 20000; i++) {
        double x[3];
        random_point(&seed, 0.5, x);
        double a = x[0], b = x[1];      /* from the edge */
        int in_blade = 5*b > a && 5*a > b && a + b < 1.2;
        for (int k = 0; k < 3; k++) x[k] += k < 2 ? 1 : 0.5;
        assert_int_equal(tobi_bvh_inside(bvh, x), a < 0 || b < 0 || in_blade);
    }
    tobi_bvh_free(bvh);
    tobi_mesh_free(&mesh);
}

/* A wall without thickness between two rooms: three triangles at its edges, and a second surface over it
   when the rooms are closed. */
static void sheets_within_a_solid_are_refused(void **state)
{
    (void)state;
    tobi_mesh mesh = rebuild(join_meshes(make_cube(1), make_box((double[3]){1, -1, -1},
                                                                (double[3]){3, 1, 1})));
    /* make_box's triangles 8 and 9 close the lower x */
    memmove(mesh.triangles + 20, mesh.triangles + 22, 2*sizeof *mesh.triangles);
    mesh.triangle_count = 22;
    REFUSED(tobi_mesh_orient(&mesh, "wall", &err), TOBI_INVALID,
            "1 edges with more than two triangles and 0 with one, the first from (1, 1, -1)");
    tobi_mesh_free(&mesh);
}

static void odd_sizes_ask_about_units(void **state)
{
    (void)state;
    static const double domain[3] = {0.6, 0.3, 0.6};
    tobi_mesh mesh = make_cube(75);
    char text[200];
    assert_int_equal(tobi_mesh_hint_units(&mesh, 3, domain, text, sizeof text), 1);
    assert_string_equal(text, "the mesh is 150 m long, far larger than the domain of 0.6 m: are its units "
                              "millimetres? Multiply its scale by 0.001");
    tobi_mesh_free(&mesh);
    mesh = make_cube(1e-4);
    assert_int_equal(tobi_mesh_hint_units(&mesh, 3, domain, text, sizeof text), -1);
    assert_non_null(strstr(text, "far smaller"));
    tobi_mesh_free(&mesh);
    mesh = make_cube(0.1);
    assert_int_equal(tobi_mesh_hint_units(&mesh, 3, domain, text, sizeof text), 0);
    assert_string_equal(text, "");
    tobi_mesh_free(&mesh);
}

/* Each choice of triangles of a cube without its first two is turned: the hole is closed all the same. */
static void closes_holes_beside_triangles_that_were_turned(void **state)
{
    (void)state;
    for (int choice = 0; choice < 1 << 10; choice += 11) {
        tobi_mesh mesh = make_cube(1);
        mesh.triangle_count = 10;
        for (int t = 0; t < 10; t++) {
            const int32_t first = mesh.triangles[t + 2][0], other = mesh.triangles[t + 2][1];
            mesh.triangles[t][0] = choice >> t & 1 ? other : first;
            mesh.triangles[t][1] = choice >> t & 1 ? first : other;
            mesh.triangles[t][2] = mesh.triangles[t + 2][2];
        }
        OK(tobi_mesh_orient(&mesh, "open cube", &err));
        NEAR(mesh_volume(&mesh), 8, 1e-14);
        tobi_mesh_free(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closes_holes_beside_triangles_that_were_turned),
        cmocka_unit_test(a_good_mesh_needs_no_words),
        cmocka_unit_test(flipped_faces_are_turned_and_counted),
        cmocka_unit_test(shells_beside_and_within_each_other),
        cmocka_unit_test(overlapping_solids_count_once),
        cmocka_unit_test(a_winding_number_is_exact_on_any_line),
        cmocka_unit_test(a_missing_face_is_closed),
        cmocka_unit_test(a_hole_that_says_too_little_is_refused),
        cmocka_unit_test(borders_that_nearly_meet_are_welded),
        cmocka_unit_test(cracks_between_tessellations_are_closed),
        cmocka_unit_test(double_triangles_and_touching_solids),
        cmocka_unit_test(a_solid_may_touch_itself_along_an_edge),
        cmocka_unit_test(sponges_keep_their_volume),
        cmocka_unit_test(a_blade_in_a_corner),
        cmocka_unit_test(sheets_within_a_solid_are_refused),
        cmocka_unit_test(odd_sizes_ask_about_units),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

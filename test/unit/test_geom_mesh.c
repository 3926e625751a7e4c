/* Reading, welding, placing, orienting and refining meshes, and what is said about bad ones. */
#include "test_geom_solids.h"
#include "own_folder.h"
#include "geom/edges.h"
#include "geom/file_checks.h"
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static const char tetra_obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

static const char *write_text(const char *path, const char *text)
{
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
    return path;
}

/* --- reading ------------------------------------------------------------------------------ */

static void reads_obj_with_groups_and_both_kinds_of_vt(void **state)
{
    (void)state;
    tobi_mesh mesh;
    char text[1000];
    snprintf(text, sizeof text, "# two groups, vt of 3 and of 2 components\nmtllib none.mtl\n%s"
             "vt 0 0 0\nvt 0.5 0.5 0\nvt 0.1 0.2\nvn 0 0 1\n"
             "g one\nusemtl a\nf 1/1 3/2 2/1\nf 1/1/1 2/2/1 4/3/1\n"
             "g two\nusemtl b\nf 1//1 4//1 3//1\nf -3 -2 -1\n", tetra_obj);
    OK(tobi_mesh_read(write_text("groups.obj", text), &mesh, &err));
    assert_int_equal(mesh.vertex_count, 4);
    assert_int_equal(mesh.triangle_count, 4);
    OK(tobi_mesh_orient(&mesh, "groups", &err));
    NEAR(mesh_volume(&mesh), 1.0/6, 1e-15);
    tobi_mesh_free(&mesh);
}

/* A library of materials that is a pipe, for files that are read as they are and for changed ones. */
static void opens_no_other_file(void **state)
{
    (void)state;
    tobi_mesh mesh;
    remove("pipe.mtl");
    assert_int_equal(mkfifo("pipe.mtl", 0600), 0);
    for (int k = 0; k < 2; k++) {
        char text[500];
        snprintf(text, sizeof text, "mtllib pipe.mtl\n%s%susemtl a\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n",
                 tetra_obj, k ? "v .5 .5 .5\n" : "");
        const time_t begin = time(NULL);
        OK(tobi_mesh_read(write_text("piped.obj", text), &mesh, &err));
        assert_true(time(NULL) - begin < 5);
        assert_int_equal(mesh.triangle_count, 4);
        tobi_mesh_free(&mesh);
    }
    remove("pipe.mtl");
}

static void reads_polygons_and_decimal_numbers_as_written(void **state)
{
    (void)state;
    tobi_mesh mesh;
    write_text("quads.obj", "v 0.1 0.01 -0.06\nv 0.3 0.01 -0.06\nv 0.3 0.21 -0.06\nv 0.1 0.21 -0.06\n"
               "v 0.1 0.01 0.123457\nv 0.3 0.01 0.123457\nv 0.3 0.21 0.123457\nv 0.1 0.21 0.123457\n"
               "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    OK(tobi_mesh_read("quads.obj", &mesh, &err));
    assert_int_equal(mesh.vertex_count, 8);
    assert_int_equal(mesh.triangle_count, 12);
    double min[3], max[3];
    tobi_mesh_box(&mesh, min, max);
    assert_true(min[0] == 0.1 && min[1] == 0.01 && min[2] == -0.06 && max[2] == 0.123457);
    tobi_mesh_free(&mesh);
}

/* As some programs write them; the importer alone would miss these vertices or refuse the file. */
static void reads_numbers_without_leading_zero(void **state)
{
    (void)state;
    tobi_mesh mesh;
    write_text("points.obj", "v .0 -.25 .0\nv 1 .0 0\nv 0 1 +.5e-1\nv .0\t.0\t.125\n"
               "vt .5 .5\nf 1/1 3/1 2/1\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    OK(tobi_mesh_read("points.obj", &mesh, &err));
    double min[3], max[3];
    tobi_mesh_box(&mesh, min, max);
    assert_int_equal(mesh.vertex_count, 4);
    assert_true(min[1] == -0.25 && max[2] == 0.125 && max[0] == 1);
    tobi_mesh_free(&mesh);
}

/* Editors of Windows put it in front of the first vertex. */
static void reads_behind_a_byte_order_mark(void **state)
{
    (void)state;
    tobi_mesh mesh;
    char text[400];
    snprintf(text, sizeof text, "\xef\xbb\xbf%sf 1 3 2\nf 1 2 4\nf 2 3 4\nf -2 -4 -1\n", tetra_obj);
    OK(tobi_mesh_read(write_text("marked.obj", text), &mesh, &err));
    assert_int_equal(mesh.vertex_count, 4);
    tobi_mesh_free(&mesh);
    snprintf(text, sizeof text, "\xef\xbb\xbf%sf 1 3 2\nf 1 2 5\n", tetra_obj);
    REFUSED(tobi_mesh_read(write_text("marked.obj", text), &mesh, &err), TOBI_INVALID,
            "marked.obj', line 6: a face uses vertex index 5, out of range; allowed are 1 to 4");
}

static void reads_ascii_stl_and_ply(void **state)
{
    (void)state;
    static const char *facets[] = {"0 0 0 0 1 0 1 0 0", "0 0 0 1 0 0 0 0 1", "0 0 0 0 0 1 0 1 0",
                                   "1 0 0 0 1 0 0 0 1"};
    tobi_mesh mesh;
    FILE *f = fopen("tetra.stl", "w");
    fputs("solid tetra\n", f);
    for (int i = 0; i < 4; i++) {
        double x[9];
        sscanf(facets[i], "%lf %lf %lf %lf %lf %lf %lf %lf %lf", x, x + 1, x + 2, x + 3, x + 4, x + 5, x + 6,
               x + 7, x + 8);
        fprintf(f, "facet normal 0 0 0\nouter loop\nvertex %g %g %g\nvertex %g %g %g\nvertex %g %g %g\n"
                "endloop\nendfacet\n", x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7], x[8]);
    }
    fputs("endsolid tetra\n", f);
    fclose(f);
    OK(tobi_mesh_read("tetra.stl", &mesh, &err));
    assert_int_equal(mesh.vertex_count, 4);
    NEAR(mesh_volume(&mesh), 1.0/6, 1e-15);
    tobi_mesh_free(&mesh);

    write_text("tetra.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
               "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
               "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    OK(tobi_mesh_read("tetra.ply", &mesh, &err));
    assert_int_equal(mesh.vertex_count, 4);
    NEAR(mesh_volume(&mesh), 1.0/6, 1e-15);
    tobi_mesh_free(&mesh);
}

static void write_binary_stl(const char *path, const tobi_mesh *m, uint32_t claimed)
{
    FILE *f = fopen(path, "wb");
    char header[80] = "binary";
    fwrite(header, 1, 80, f);
    fwrite(&claimed, 4, 1, f);
    for (int64_t t = 0; t < m->triangle_count; t++) {
        float x[12] = {0};
        for (int i = 0; i < 9; i++) x[3 + i] = (float)m->vertices[m->triangles[t][i/3]][i % 3];
        fwrite(x, 4, 12, f);
        fwrite("\0\0", 1, 2, f);
    }
    fclose(f);
}

static void reads_binary_stl(void **state)
{
    (void)state;
    tobi_mesh box = make_box((double[3]){-0.1, -0.2, -0.3}, (double[3]){0.1, 0.2, 0.3}), mesh;
    write_binary_stl("box.stl", &box, 12);
    OK(tobi_mesh_read("box.stl", &mesh, &err));
    assert_int_equal(mesh.vertex_count, 8);
    assert_int_equal(mesh.triangle_count, 12);
    OK(tobi_mesh_orient(&mesh, "box", &err));
    NEAR(mesh_volume(&mesh), 0.048, 1e-14);
    tobi_mesh_free(&mesh);
    tobi_mesh_free(&box);
}

/* The pipe of the importer may then be one of the three streams, which it shuts for its own texts. */
static void reads_where_a_host_has_closed_its_streams(void **state)
{
    (void)state;
    int kept[3];
    tobi_mesh mesh;
    tobi_error err = {0};
    char text[200];
    snprintf(text, sizeof text, "%sf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n", tetra_obj);
    write_text("streams.obj", text);
    fflush(NULL);
    for (int k = 0; k < 3; k++) kept[k] = dup(k);
    for (int k = 0; k < 3; k++) close(k);
    tobi_status status = tobi_mesh_read("streams.obj", &mesh, &err);
    for (int k = 0; k < 3; k++) dup2(kept[k], k);
    for (int k = 0; k < 3; k++) close(kept[k]);
    OK(status);
    assert_int_equal(mesh.triangle_count, 4);
    tobi_mesh_free(&mesh);
}

static void refuses_bad_files(void **state)
{
    (void)state;
    tobi_mesh mesh, box = make_cube(1);
    char text[1000];
    REFUSED(tobi_mesh_read("no_such.obj", &mesh, &err), TOBI_NOT_FOUND, "no_such.obj");
    REFUSED(tobi_mesh_read(".", &mesh, &err), TOBI_IO, "mesh .: is a directory; only plain files are read");
    write_text("cube.step", "ISO-10303-21;\n");
    REFUSED(tobi_mesh_read("cube.step", &mesh, &err), TOBI_INVALID, "allowed are .obj, .stl and .ply");
    write_text("empty.obj", "");
    REFUSED(tobi_mesh_read("empty.obj", &mesh, &err), TOBI_INVALID, "empty file");
    write_text("garbage.obj", "this is not a mesh\nnor is this\n");
    REFUSED(tobi_mesh_read("garbage.obj", &mesh, &err), TOBI_INVALID, "garbage.obj");
    REFUSED(tobi_mesh_read(write_text("points.obj", tetra_obj), &mesh, &err), TOBI_INVALID, "points.obj");
    snprintf(text, sizeof text, "%sf 1 2 3\nf 1 2 9\n", tetra_obj);
    REFUSED(tobi_mesh_read(write_text("index.obj", text), &mesh, &err), TOBI_INVALID,
            "line 6: a face uses vertex index 9, out of range; allowed are 1 to 4");
    snprintf(text, sizeof text, "%sf 1 2 3\nf 1 2 -9\n", tetra_obj);
    REFUSED(tobi_mesh_read(write_text("index2.obj", text), &mesh, &err), TOBI_INVALID, "index -9");
    snprintf(text, sizeof text, "%sf 0 2 3\n", tetra_obj);
    REFUSED(tobi_mesh_read(write_text("index3.obj", text), &mesh, &err), TOBI_INVALID, "index 0");
    REFUSED(tobi_mesh_read(write_text("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n"), &mesh, &err),
            TOBI_INVALID, "finite");
    REFUSED(tobi_mesh_read(write_text("inf.obj", "v 0 0 0\nv 1 inf 0\nv 0 1 0\nf 1 2 3\n"), &mesh, &err),
            TOBI_INVALID, "finite");
    write_text("index.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
               "0 0 0\n1 0 0\n0 1 0\n3 0 1 77\n");
    REFUSED(tobi_mesh_read("index.ply", &mesh, &err), TOBI_INVALID, "index.ply");
#ifndef __SANITIZE_ADDRESS__      /* the child's memory is not limited there */
    write_text("claims.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\n"
               "property float y\nproperty float z\nelement face 4000000000\n"
               "property list uchar int vertex_indices\nend_header\n0 0 0\n");
    REFUSED(tobi_mesh_read("claims.ply", &mesh, &err), TOBI_INVALID, "claims");
#endif
    write_binary_stl("short.stl", &box, 4000000000u);
    REFUSED(tobi_mesh_read("short.stl", &mesh, &err), TOBI_INVALID,
            "short.stl': a binary STL of 4000000000 triangles has 200000000084 bytes, this file has 684, "
            "room for 12: it is cut off or its count is wrong");
    assert_null(mesh.vertices);
    tobi_mesh_free(&box);
}

/* The importer would look for the rest of such a file until its time is up. */
static void ply_headers_are_judged_before_the_import(void **state)
{
    (void)state;
#define PROPERTIES "property float x\nproperty float y\nproperty float z\n"
#define FACES "element face 1\nproperty list uchar int vertex_indices\n"
    static const struct { const char *text, *says; } bad[] = {
        {"plx\n", "does not begin with the line ply"},
        {"ply\nformat ascii 1.0\nelement vertex 3\n" PROPERTIES, "no end_header line"},
        {"ply\nformat ebcdic 1.0\nend_header\n", "line 2 of the header: allowed formats"},
        {"ply\nformat ascii 1.0\nelement vertex -3\nend_header\n", "line 3"},
        {"ply\nformat ascii 1.0\nelement vertex 3\nproperty list\nend_header\n", "line 4"},
        {"ply\nformat ascii 1.0\nelement vertex 3\nproperty quad x\nend_header\n", "line 4"},
        {"ply\nformat ascii 1.0\nhello\nend_header\n", "line 3 of the header: a header holds"},
        {"ply\nformat ascii 1.0\nelement vertex 3\n" PROPERTIES "end_header\n0 0 0\n1 0 0\n0 1 0\n",
         "no faces"},
        {"ply\nformat ascii 1.0\n" FACES "end_header\n3 0 1 2\n", "no vertices"},
        {"ply\nformat binary_little_endian 1.0\nelement vertex 300\n" PROPERTIES FACES "end_header\n0000",
         "at least 3601 bytes; after the header there are 4"},
    };
    tobi_mesh mesh;
    struct timespec begin, end;
    clock_gettime(CLOCK_MONOTONIC, &begin);
    for (size_t i = 0; i < sizeof bad/sizeof *bad; i++)
        REFUSED(tobi_mesh_read(write_text("bad.ply", bad[i].text), &mesh, &err), TOBI_INVALID, bad[i].says);
    clock_gettime(CLOCK_MONOTONIC, &end);
    assert_true(end.tv_sec - begin.tv_sec < 5);
}

/* By arithmetic the same as by text. */
static void floats_become_the_decimals_that_were_written(void **state)
{
    (void)state;
    uint64_t seed = 11;
    char text[40];
    for (int i = 0; i < 200000; i++) {
        float x = (float)(random_number(&seed)*pow(10, 20*random_number(&seed)));
        if (i % 2) {
            snprintf(text, sizeof text, "%.5e", (double)x);
            x = strtof(text, NULL);
        }
        double expected = x;
        for (int digits = 6; digits < 9; digits++) {
            snprintf(text, sizeof text, "%.*g", digits, (double)x);
            if (strtof(text, NULL) != x) continue;
            expected = strtod(text, NULL);
            break;
        }
        if (tobi_shortest_decimal(x) != expected)
            fail_msg("%.9g became %.17g, not %.17g", (double)x, tobi_shortest_decimal(x), expected);
    }
    assert_true(tobi_shortest_decimal(0.1f) == 0.1 && tobi_shortest_decimal(-2500) == -2500);
}

/* Any damage to a file gives a mesh or an error, never a crash of this process. */
static void survives_damaged_files(void **state)
{
    (void)state;
    uint64_t seed = 5;
    tobi_mesh box = make_cube(1);
    unsigned char good[4096], bad[4096];
    write_binary_stl("whole.stl", &box, 12);
    FILE *f = fopen("whole.stl", "rb");
    size_t size = fread(good, 1, sizeof good, f);
    fclose(f);
    for (int round = 0; round < 40; round++) {
        size_t length = size;
        memcpy(bad, good, size);
        for (int k = 0; k < 6; k++)
            bad[(size_t)((random_number(&seed) + 1)/2*(double)size)] = (unsigned char)(seed >> 40);
        if (round % 3 == 0) length = (size_t)((random_number(&seed) + 1)/2*(double)size);
        f = fopen("damaged.stl", "wb");
        fwrite(bad, 1, length, f);
        fclose(f);
        tobi_mesh mesh;
        tobi_error err = {0};
        tobi_status status = tobi_mesh_read("damaged.stl", &mesh, &err);
        if (status == TOBI_OK) assert_true(mesh.triangle_count > 0);
        else assert_true(strlen(err.text) > 10);
        tobi_mesh_free(&mesh);
    }
    tobi_mesh_free(&box);
}

/* --- building and placing ----------------------------------------------------------------- */

static void welds_and_checks_raw_arrays(void **state)
{
    (void)state;
    /* a tetrahedron as triangle soup; one corner off by 1e-10, one triangle collapsed, one vertex unused */
    double v[14][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 1e-10},
                       {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5e-10, 0, 0}, {0.5, 0.5, 0.5}};
    int32_t t[5][3] = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}, {0, 12, 1}};
    const double (*cv)[3] = (const double (*)[3])v;
    const int32_t (*ct)[3] = (const int32_t (*)[3])t;
    tobi_mesh mesh;
    OK(tobi_mesh_build("soup", 14, cv, 5, ct, &mesh, &err));
    assert_int_equal(mesh.vertex_count, 4);
    assert_int_equal(mesh.triangle_count, 4);
    OK(tobi_mesh_orient(&mesh, "soup", &err));
    tobi_mesh_free(&mesh);

    t[1][2] = 14;
    REFUSED(tobi_mesh_build("soup", 14, cv, 5, ct, &mesh, &err), TOBI_INVALID, "allowed are 0 to 13");
    t[1][2] = -1;
    REFUSED(tobi_mesh_build("soup", 14, cv, 5, ct, &mesh, &err), TOBI_INVALID, "index -1");
    t[1][2] = 5;
    v[5][1] = NAN;
    REFUSED(tobi_mesh_build("soup", 14, cv, 5, ct, &mesh, &err), TOBI_INVALID, "vertex 6");
    v[5][1] = INFINITY;
    REFUSED(tobi_mesh_build("soup", 14, cv, 5, ct, &mesh, &err), TOBI_INVALID, "finite");
    v[5][1] = 0;
    REFUSED(tobi_mesh_build("soup", 0, cv, 0, ct, &mesh, &err), TOBI_INVALID, "no triangles");
    REFUSED(tobi_mesh_build("soup", 14, cv, 1, (const int32_t[1][3]){{0, 3, 12}}, &mesh, &err), TOBI_INVALID,
            "collapsed");
}

static void places_a_mesh(void **state)
{
    (void)state;
    static const double x[3] = {1, 0, 0}, z[3] = {0, 0, 2}, none[3] = {0, 0, 0}, one[3] = {1, 1, 1};
    tobi_mesh mesh = make_box((double[3]){0, 0, 0}, (double[3]){1, 2, 3});
    double min[3], max[3];
    OK(tobi_mesh_transform(&mesh, (double[3]){2, 1, 1}, z, 90, (double[3]){10, 0, -1}, &err));
    tobi_mesh_box(&mesh, min, max);
    /* (x, y) -> (-y, 2 x) + (10, 0) */
    assert_true(min[0] == 8 && max[0] == 10 && min[1] == 0 && max[1] == 2 && min[2] == -1 && max[2] == 2);
    NEAR(mesh_volume(&mesh), 12, 1e-14);
    OK(tobi_mesh_transform(&mesh, (double[3]){-1, 1, 1}, x, 0, none, &err));
    NEAR(mesh_volume(&mesh), 12, 1e-14);    /* mirrored, still outward */
    OK(tobi_mesh_transform(&mesh, one, (double[3]){1, 2, 3}, 33, (double[3]){100, 50, 0}, &err));
    NEAR(mesh_volume(&mesh), 12, 1e-11);
    REFUSED(tobi_mesh_transform(&mesh, (double[3]){1, 0, 1}, x, 0, none, &err), TOBI_INVALID, "scale");
    REFUSED(tobi_mesh_transform(&mesh, one, none, 10, none, &err), TOBI_INVALID, "axis");
    REFUSED(tobi_mesh_transform(&mesh, one, x, NAN, none, &err), TOBI_INVALID, "angle");
    REFUSED(tobi_mesh_transform(&mesh, one, x, 0, (double[3]){0, INFINITY, 0}, &err), TOBI_INVALID, "finite");
    REFUSED(tobi_mesh_transform(&mesh, (double[3]){1e20, 1, 1}, x, 0, none, &err), TOBI_INVALID, "further");
    tobi_mesh_free(&mesh);
}

/* --- orientation -------------------------------------------------------------------------- */

static void turns_triangles_outward(void **state)
{
    (void)state;
    tobi_mesh mesh = make_cube(1);
    for (int t = 0; t < 12; t++) {
        if (t % 3 == 0) continue;
        int32_t swap = mesh.triangles[t][0];
        mesh.triangles[t][0] = mesh.triangles[t][1];
        mesh.triangles[t][1] = swap;
    }
    OK(tobi_mesh_orient(&mesh, "cube", &err));
    NEAR(mesh_volume(&mesh), 8, 1e-15);
    tobi_mesh_free(&mesh);
}

static void keeps_cavities_and_what_lies_in_them(void **state)
{
    (void)state;
    /* a cube with a cavity with a cube in it, and a cube beside it: 64 - 27 + 1 + 8 */
    tobi_mesh mesh = join_meshes(make_cube(2), make_cube(1.5));
    mesh = join_meshes(mesh, make_cube(0.5));
    mesh = join_meshes(mesh, make_box((double[3]){3, -1, -1}, (double[3]){5, 1, 1}));
    OK(tobi_mesh_orient(&mesh, "nested", &err));
    NEAR(mesh_volume(&mesh), 64 - 27 + 1 + 8, 1e-14);
    tobi_mesh_free(&mesh);
    /* overlapping, neither holds the other: both stay solid */
    mesh = join_meshes(make_cube(1), make_box((double[3]){0, 0, 0}, (double[3]){1.5, 0.5, 0.5}));
    OK(tobi_mesh_orient(&mesh, "overlapping", &err));
    NEAR(mesh_volume(&mesh), 8 + 0.375, 1e-14);
    tobi_mesh_free(&mesh);
}

static void refuses_surfaces_without_an_inside(void **state)
{
    (void)state;
    /* the projective plane on six vertices: closed, but its triangles cannot agree */
    static const int32_t plane[10][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1},
                                         {1, 2, 4}, {2, 3, 5}, {3, 4, 1}, {4, 5, 2}, {5, 1, 3}};
    static const double v[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}};
    static const int32_t flat[2][3] = {{0, 1, 2}, {0, 2, 1}};
    tobi_mesh mesh;
    OK(tobi_mesh_build("plane", 6, v, 10, plane, &mesh, &err));
    REFUSED(tobi_mesh_orient(&mesh, "plane", &err), TOBI_INVALID, "no inside");
    tobi_mesh_free(&mesh);
    OK(tobi_mesh_build("flat", 3, v, 2, flat, &mesh, &err));
    REFUSED(tobi_mesh_orient(&mesh, "flat", &err), TOBI_INVALID, "encloses no volume");
    tobi_mesh_free(&mesh);
}

/* --- refinement --------------------------------------------------------------------------- */

static double longest_edge(const tobi_mesh *m)
{
    double longest = 0;
    for (int64_t t = 0; t < m->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            const double *a = m->vertices[m->triangles[t][k]], *b = m->vertices[m->triangles[t][(k + 1) % 3]];
            longest = fmax(longest, sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2)));
        }
    return longest;
}

static void refines_without_changing_the_shape(void **state)
{
    (void)state;
    tobi_mesh mesh = make_box((double[3]){0, 0, 0}, (double[3]){1, 0.04, 0.3});
    OK(tobi_mesh_refine(&mesh, 0.05, &err));
    assert_true(longest_edge(&mesh) <= 0.05);
    assert_true(mesh.triangle_count > 500 && mesh.triangle_count < 5000);
    NEAR(mesh_volume(&mesh), 0.012, 1e-13);
    tobi_edge_report report;
    int32_t (*opposite)[3] = malloc((size_t)mesh.triangle_count*sizeof *opposite);
    assert_int_equal(tobi_edges_match(mesh.vertex_count, mesh.triangle_count,
                                      (const int32_t (*)[3])mesh.triangles, opposite, &report), TOBI_OK);
    assert_int_equal(report.open + report.non_manifold, 0);
    /* Euler: V - E + F = 2 */
    assert_int_equal(mesh.vertex_count - mesh.triangle_count/2, 2);
    free(opposite);
    int64_t before = mesh.triangle_count;
    OK(tobi_mesh_refine(&mesh, 0.05, &err));
    assert_int_equal(mesh.triangle_count, before);
    REFUSED(tobi_mesh_refine(&mesh, 0, &err), TOBI_INVALID, "must be > 0");
    mesh.triangle_count--;
    REFUSED(tobi_mesh_refine(&mesh, 0.01, &err), TOBI_INVALID, "closed");
    tobi_mesh_free(&mesh);
}

/* --- the project's own meshes ------------------------------------------------------------- */

static void the_fish_is_as_described(void **state)
{
    (void)state;
    tobi_mesh fish = read_own("scenes/flying_fish/meshes/fish.obj");
    double min[3], max[3], lead = 1, rear = -1, low = 1, high = -1, wide = 0;
    tobi_mesh_box(&fish, min, max);
    assert_true(min[0] == -0.1 && max[0] == 0.1 && min[1] == -0.1 && max[1] == 0.1);
    for (int64_t i = 0; i < fish.vertex_count; i++) {
        const double *x = fish.vertices[i];
        if (fabs(x[1]) > 0.0100001) {          /* a wing */
            lead = fmin(lead, x[0]);
            rear = fmax(rear, x[0]);
            low = fmin(low, x[2]);
            high = fmax(high, x[2]);
        } else {
            wide = fmax(wide, fabs(x[1]));
        }
    }
    WITHIN(lead, -0.06, 1e-4);
    WITHIN(rear, -0.02, 1e-4);
    WITHIN(high - low, 0.004, 1e-9);
    assert_true(wide == 0.01);
    assert_true(longest_edge(&fish) < 0.0065);
    /* one surface: V - E + F = 2, the wings included */
    assert_int_equal(fish.vertex_count - fish.triangle_count/2, 2);
    double volume = mesh_volume(&fish);
    printf("fish: %lld triangles, %.2f cm3\n", (long long)fish.triangle_count, volume*1e6);
    assert_true(volume > 60e-6 && volume < 90e-6);
    tobi_mesh_free(&fish);
}

static void the_test_solids_are_closed_and_sized(void **state)
{
    (void)state;
    static const struct { const char *path; double volume, tolerance; int euler; } own[] = {
        {"test/meshes/box.obj", 1, 1e-12, 2},
        {"test/meshes/sphere.obj", PI/6, 0.01, 2},
        {"test/meshes/cylinder.obj", PI/4, 0.005, 2},
        {"test/meshes/torus.obj", 2*PI*PI*0.35*0.15*0.15, 0.02, 0},
        {"test/meshes/wedge.obj", 0.125, 1e-12, 2},
    };
    for (size_t i = 0; i < sizeof own/sizeof *own; i++) {
        tobi_mesh mesh = read_own(own[i].path);
        NEAR(mesh_volume(&mesh), own[i].volume, own[i].tolerance);
        assert_int_equal(mesh.vertex_count - mesh.triangle_count/2, own[i].euler);
        tobi_mesh_free(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_obj_with_groups_and_both_kinds_of_vt),
        cmocka_unit_test(opens_no_other_file),
        cmocka_unit_test(reads_polygons_and_decimal_numbers_as_written),
        cmocka_unit_test(reads_numbers_without_leading_zero),
        cmocka_unit_test(reads_behind_a_byte_order_mark),
        cmocka_unit_test(reads_ascii_stl_and_ply),
        cmocka_unit_test(reads_binary_stl),
        cmocka_unit_test(reads_where_a_host_has_closed_its_streams),
        cmocka_unit_test(refuses_bad_files),
        cmocka_unit_test(ply_headers_are_judged_before_the_import),
        cmocka_unit_test(floats_become_the_decimals_that_were_written),
        cmocka_unit_test(survives_damaged_files),
        cmocka_unit_test(welds_and_checks_raw_arrays),
        cmocka_unit_test(places_a_mesh),
        cmocka_unit_test(turns_triangles_outward),
        cmocka_unit_test(keeps_cavities_and_what_lies_in_them),
        cmocka_unit_test(refuses_surfaces_without_an_inside),
        cmocka_unit_test(refines_without_changing_the_shape),
        cmocka_unit_test(the_fish_is_as_described),
        cmocka_unit_test(the_test_solids_are_closed_and_sized),
    };
    return cmocka_run_group_tests(tests, enter_own_folder, leave_own_folder);
}

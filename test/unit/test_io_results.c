/* Results read back: every packing, a run that grows, and files that are damaged anywhere. */
#define _GNU_SOURCE 1
#include "io/vtk.h"
#include "io/vtk_read.h"
#include "tobiuo/results.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>

enum { N = 20011 };     /* several blocks, the last one partial */

static char folder[] = "/tmp/tobi_io_results_XXXXXX";
static double points[N][3];
static float velocity[N][3];
static int64_t id[N];
static const double corners[4][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
static const int32_t faces[4][3] = { { 0, 2, 1 }, { 0, 1, 3 }, { 0, 3, 2 }, { 1, 2, 3 } };

static const char *in_folder(const char *name)
{
    static char path[8][256];
    static int next;
    next = (next + 1)%8;
    snprintf(path[next], sizeof path[next], "%s/%s", folder, name);
    return path[next];
}

static void write_text(const char *name, const char *text)
{
    FILE *file = fopen(in_folder(name), "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static void write_files(tobi_compression packing)
{
    const tobi_vtk_array arrays[] = { { "velo<c>i&ty", TOBI_F32, 3, velocity }, { "particle_id", TOBI_I64,
            1, id } };
    const tobi_vtk_surface surface = { .vertex_count = 4, .vertices = corners, .triangle_count = 4,
                                       .triangles = faces };
    assert_int_equal(tobi_vtu_write(in_folder("fluid/a.vtu"), packing, N, (const double (*)[3])points,
                                    arrays, 2,
                                    NULL), TOBI_OK);
    assert_int_equal(tobi_vtp_write(in_folder("surfaces/b.vtp"), packing, &surface, NULL), TOBI_OK);
}

static int set_up(void **state)
{
    (void)state;
    if (!mkdtemp(folder) || mkdir(in_folder("fluid"), 0700) || mkdir(in_folder("surfaces"), 0700)) return -1;
    for (int i = 0; i < N; i++) {
        for (int k = 0; k < 3; k++) {
            points[i][k] = sin(0.37*i + k);
            velocity[i][k] = (float)cos(0.11*i*k);
        }
        id[i] = (int64_t)3*i;
    }
    write_text("all.pvd",
               "<VTKFile>\n"
               "<DataSet timestep=\"0.5\" group=\"\" part=\"0\" name=\"fluid\" file=\"fluid/a.vtu\"/>\n"
               "<DataSet timestep=\"0.5\" group=\"\" part=\"1\" name=\"bodies\" "
               "file=\"bodies/none.vtu\"/>\n"
               "<DataSet timestep=\"0.5\" group=\"\" part=\"2\" name=\"A &amp; &quot;B&quot;\" "
               "file=\"surfaces/b.vtp\"/>\n"
               "<DataSet timestep=\"0.5\" group=\"\" part=\"3\" name=\"gone\" "
               "file=\"surfaces/gone.vtp\"/>\n"
               "</VTKFile>\n");
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    char command[300];
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command);
}

static tobi_results *open_results(void)
{
    tobi_results *r;
    assert_int_equal(tobi_results_open(folder, &r, NULL), TOBI_OK);
    return r;
}

static void every_packing_is_read_back(void **state)
{
    (void)state;
    static const tobi_compression packings[] = { TOBI_COMPRESS_NONE, TOBI_COMPRESS_ZLIB, TOBI_COMPRESS_LZ4,
                                                 TOBI_ASCII };
    for (size_t p = 0; p < sizeof packings/sizeof *packings; p++) {
        tobi_moment m;
        write_files(packings[p]);
        tobi_results *r = open_results();
        assert_int_equal(tobi_results_count(r), 1);
        assert_float_equal(tobi_results_time(r, 0), 0.5, 0);
        assert_float_equal(tobi_results_time(r, 1), 0, 0);
        assert_int_equal(tobi_results_read(r, 0, &m, NULL), TOBI_OK);
        assert_int_equal(m.count, N);
        assert_memory_equal(m.positions, points, sizeof points);
        assert_int_equal(m.field_count, 2);
        assert_string_equal(m.fields[0].name, "velo<c>i&ty");
        assert_int_equal(m.fields[0].components, 3);
        for (int i = 0; i < N; i++) {
            for (int k = 0; k < 3; k++) assert_true((float)m.fields[0].values[3*i + k] == velocity[i][k]);
            assert_true((int64_t)m.fields[1].values[i] == id[i]);
        }
        assert_int_equal(m.surface_count, 1);
        assert_string_equal(m.surfaces[0].name, "A & \"B\"");
        assert_memory_equal(m.surfaces[0].vertices, corners, sizeof corners);
        assert_memory_equal(m.surfaces[0].triangles, faces, sizeof faces);
        tobi_moment_free(&m);
        tobi_results_free(r);
    }
}

static void a_run_grows(void **state)
{
    (void)state;
    tobi_results *r = open_results();
    FILE *file = fopen(in_folder("all.pvd"), "a");
    fputs("<DataSet timestep=\"0.7\" part=\"0\" name=\"fluid\" file=\"fluid/a.vtu\"/>\n", file);
    fclose(file);
    assert_int_equal(tobi_results_refresh(r, NULL), TOBI_OK);
    assert_int_equal(tobi_results_count(r), 2);
    rename(in_folder("all.pvd"), in_folder("all.old"));
    assert_int_equal(tobi_results_refresh(r, NULL), TOBI_NOT_FOUND);
    assert_int_equal(tobi_results_count(r), 2);
    rename(in_folder("all.old"), in_folder("all.pvd"));
    tobi_results_free(r);
    tobi_results_free(NULL);
}

static void expect_text(const tobi_error *err, const char *text)
{
    if (!strstr(err->text, text)) fail_msg("\"%s\" does not say \"%s\"", err->text, text);
}

static void mistakes_are_named(void **state)
{
    (void)state;
    tobi_error err;
    tobi_moment m;
    tobi_results *r = open_results(), *none;
    assert_int_equal(tobi_results_read(r, 7, &m, &err), TOBI_INVALID);
    expect_text(&err, "there is no output 7");
    assert_int_equal(tobi_results_read(NULL, 0, &m, &err), TOBI_INVALID);
    assert_int_equal(tobi_results_count(NULL), 0);
    assert_int_equal(tobi_results_open("/nowhere", &none, &err), TOBI_NOT_FOUND);
    assert_null(none);
    mkdir(in_folder("odd"), 0700);
    write_text("odd/all.pvd", "<DataSet timestep=\"1\" name=\"fluid\"/>\n");
    assert_int_equal(tobi_results_open(in_folder("odd"), &none, &err), TOBI_DAMAGED);
    expect_text(&err, "has an entry without time, name or file");
    write_text("odd/all.pvd", "no list\n");
    assert_int_equal(tobi_results_open(in_folder("odd"), &none, &err), TOBI_DAMAGED);
    expect_text(&err, "lists no particles");
    tobi_results_free(r);
}

/* What is read from any text is an answer, never a crash; the sanitizers look on. */
static tobi_status read_text(const char *text, size_t size, tobi_error *err)
{
    FILE *file = fopen(in_folder("odd.vtu"), "wb");
    fwrite(text, 1, size, file);
    fclose(file);
    tobi_moment m = { 0 };
    tobi_moment_surface s = { 0 };
    const tobi_status status = tobi_vtu_read(in_folder("odd.vtu"), &m, err);
    tobi_moment_free(&m);
    tobi_vtp_read(in_folder("odd.vtu"), &s, NULL);
    free(s.vertices);
    free(s.triangles);
    return status;
}

static void expect_damage(const char *text, const char *why)
{
    tobi_error err = { 0 };
    assert_int_equal(read_text(text, strlen(text), &err), TOBI_DAMAGED);
    expect_text(&err, why);
}

static void damaged_files_are_refused(void **state)
{
    (void)state;
#define HEAD "<VTKFile type=\"UnstructuredGrid\"><Piece NumberOfPoints=\"2\" NumberOfPolys=\"1\"><Points>"
#define ARRAY "<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" "
    expect_damage("nothing", "is no VTK file");
    expect_damage("<VTKFile type=\"a\"><Piece Number=\"2\">", "has no number of points");
    expect_damage(HEAD "</Points>", "has no points");
    expect_damage(HEAD "<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"1\" "
        "format=\"ascii\">1 2",
                  "has points that are none");
    expect_damage(HEAD ARRAY "format=\"ascii\">1 2 3 4 5 x</DataArray>", "has fewer numbers than rows");
    expect_damage(HEAD ARRAY "format=\"appended\" offset=\"900\"/></Points><AppendedData "
        "encoding=\"raw\">_12",
                  "ends too early");
    expect_damage("<VTKFile type=\"a\"><Piece NumberOfPoints=\"99999999999\"><Points>" ARRAY
                  "format=\"ascii\">1</DataArray>", "says it has more rows");
    char *text;
    long size;
    write_files(TOBI_COMPRESS_ZLIB);
    FILE *file = fopen(in_folder("fluid/a.vtu"), "rb");
    fseek(file, 0, SEEK_END);
    size = ftell(file);
    rewind(file);
    text = malloc((size_t)size);
    assert_int_equal(fread(text, 1, (size_t)size, file), (size_t)size);
    fclose(file);
    for (long cut = 0; cut < size; cut += 1 + size/150) {
        read_text(text, (size_t)cut, NULL);
        text[cut] ^= 0x5a;
        read_text(text, (size_t)size, NULL);
        text[cut] ^= 0x5a;
    }
    free(text);
}

static void surfaces_that_are_none(void **state)
{
    (void)state;
    tobi_error err;
    tobi_moment_surface s = { 0 };
#define SURFACE HEAD ARRAY "format=\"ascii\">1 2 3 4 5 6</DataArray></Points>"
    write_text("odd.vtp", SURFACE "<Polys>");
    assert_int_equal(tobi_vtp_read(in_folder("odd.vtp"), &s, &err), TOBI_DAMAGED);
    expect_text(&err, "has no surface");
    free(s.vertices);
    s = (tobi_moment_surface){ 0 };
    write_text("odd.vtp",
               SURFACE "<Polys><DataArray type=\"Int32\" Name=\"connectivity\" NumberOfComponents=\"1\" "
               "format=\"ascii\">0 1 2</DataArray>");
    assert_int_equal(tobi_vtp_read(in_folder("odd.vtp"), &s, &err), TOBI_DAMAGED);
    expect_text(&err, "has a triangle of vertices that are none");
    free(s.vertices);
    free(s.triangles);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_packing_is_read_back),
        cmocka_unit_test(mistakes_are_named),
        cmocka_unit_test(damaged_files_are_refused),
        cmocka_unit_test(surfaces_that_are_none),
        cmocka_unit_test(a_run_grows),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}

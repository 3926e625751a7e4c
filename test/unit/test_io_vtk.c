/* VTU, VTP, STL and PVD files, read back by VTK's own readers (test/api/read_vtk.py), and what happens when
   the disk is full at any byte. */
#define _GNU_SOURCE 1
#include "io/pvd.h"
#include "io/vtk.h"
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>

enum { N = 30011 };     /* several blocks, the last one partial */

static char folder[] = "/tmp/tobi_io_vtk_XXXXXX";
static double points[N][3], velocity[N][3];
static float density[N];
static int32_t object[N];
static int64_t id[N];
static uint8_t flag[N];

static const char *in_folder(const char *name)
{
    static char path[8][256];
    static int next;
    next = (next + 1)%8;
    snprintf(path[next], sizeof path[next], "%s/%s", folder, name);
    return path[next];
}

static int exists(const char *path) { return access(path, F_OK) == 0; }

static void fill(void)
{
    for (int i = 0; i < N; i++) {
        for (int k = 0; k < 3; k++) {
            points[i][k] = sin(0.37*i + k) - 0.25*k;
            velocity[i][k] = cos(0.11*i*k) + 1e-9*i;
        }
        density[i] = 1000 + 0.001f*(float)(i%97);
        object[i] = i%3 - 1;
        id[i] = (int64_t)i*1000003 + 5000000000;
        flag[i] = (uint8_t)(i%251);
    }
}

static const tobi_vtk_array arrays[] = {
    { "velocity", TOBI_F64, 3, velocity }, { "density", TOBI_F32, 1, density },
    { "object <&\"'> id", TOBI_I32, 1, object }, { "particle_id", TOBI_I64, 1, id },
    { "flag\xc3\xa9", TOBI_U8, 1, flag }
};

/* The script that reads files with VTK. */
static int read_with_vtk(const char *checks)
{
    static const char script[] = TOBI_SOURCE_DIR "/test/api/read_vtk.py";
    const char *python[] = { "/usr/bin/python3", "python3" };
    int code = 77;
    for (int i = 0; i < 2 && code == 77; i++) {
        char command[1024];
        snprintf(command, sizeof command, "%s '%s' '%s'", python[i], script, checks);
        fflush(stdout);
        int answer = system(command);
        code = WIFEXITED(answer) ? WEXITSTATUS(answer) : 1;
        if (code == 127) code = 77;
    }
    return code;
}

static void require_vtk_answer(const char *checks)
{
    int code = read_with_vtk(checks);
    if (code == 77) {
        print_message("SKIPPED: no python3 with VTK (Debian: python3-vtk9), files were not read back\n");
        skip();
    }
    assert_int_equal(code, 0);
}

static double weigh(int64_t n, int components, double (*value)(int64_t))
{
    double sum = 0;
    for (int64_t i = 0; i < n; i++)
        for (int k = 0; k < components; k++) sum += (double)(i + 1)*value(i*components + k);
    return sum;
}

static double point_value(int64_t i) { return points[i/3][i%3]; }
static double velocity_value(int64_t i) { return velocity[i/3][i%3]; }
static double density_value(int64_t i) { return density[i]; }
static double object_value(int64_t i) { return object[i]; }
static double id_value(int64_t i) { return (double)id[i]; }
static double flag_value(int64_t i) { return flag[i]; }

static void print_particle_checks(FILE *out, const char *name, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += (i + 1.0)*i;
    fprintf(out, "{\"file\": \"%s\", \"points\": %d, \"cells\": %d, \"cell_type\": 1, ", name, n, n);
    fprintf(out, "\"connectivity\": %.0f, \"arrays\": {\"velocity\": 3, \"density\": 1, ", sum);
    fprintf(out, "\"object <&\\\"'> id\": 1, \"particle_id\": 1, \"flag\xc3\xa9\": 1}, \"sums\": {");
    fprintf(out, "\"Points\": %.17g, \"velocity\": %.17g, \"density\": %.17g, ", weigh(n, 3, point_value),
            weigh(n, 3, velocity_value), weigh(n, 1, density_value));
    fprintf(out, "\"object <&\\\"'> id\": %.17g, \"particle_id\": %.17g, \"flag\xc3\xa9\": %.17g}",
            weigh(n, 1, object_value), weigh(n, 1, id_value), weigh(n, 1, flag_value));
    if (n == N)
        fprintf(out, ", \"ranges\": {\"particle_id\": [%.17g, %.17g], \"flag\xc3\xa9\": [0, 250]}",
                (double)id[0], (double)id[N - 1]);
    fprintf(out, "}");
}

static void vtu_is_read_by_vtk(void **state)
{
    (void)state;
    const char *names[] = { "none", "zlib", "lz4", "ascii" };
    /* 8192 points = 3 whole blocks of coordinates, 1 of connectivity: no partial block. */
    const int counts[] = { N, 8192, 1, 0 };
    tobi_error err;
    FILE *out = fopen(in_folder("vtu.json"), "w");
    fprintf(out, "[");
    for (int c = 0; c < 4; c++)
        for (int k = 0; k < 4; k++) {
            char name[64];
            snprintf(name, sizeof name, "%s_%d.vtu", names[c], counts[k]);
            assert_int_equal(tobi_vtu_write(in_folder(name), (tobi_compression)c, counts[k], points, arrays,
                                            5, &err), 0);
            fprintf(out, c + k ? ",\n" : "\n");
            print_particle_checks(out, name, counts[k]);
        }
    assert_int_equal(tobi_vtu_write(in_folder("null.vtu"), TOBI_COMPRESS_ZLIB, 0, NULL, NULL, 0, &err), 0);
    fprintf(out, ",\n{\"file\": \"null.vtu\", \"points\": 0, \"cells\": 0}]\n");
    fclose(out);
    struct stat raw, packed;
    stat(in_folder("none_30011.vtu"), &raw);
    stat(in_folder("zlib_30011.vtu"), &packed);
    assert_true(packed.st_size < raw.st_size*8/10);
    require_vtk_answer(in_folder("vtu.json"));
}

static const double corner[4][3] = { { 0, 0, 0 }, { 2, 0, 0 }, { 0, 3, 0 }, { 0, 0, -4 } };
static const int32_t face[4][3] = { { 0, 1, 2 }, { 0, 3, 1 }, { 0, 2, 3 }, { 1, 3, 2 } };

static void surfaces_are_read_by_vtk(void **state)
{
    (void)state;
    const double pressure[4] = { 1, -2, 3.5, 1e5 };
    const float load[4][3] = { { 1, 2, 3 }, { 4, 5, 6 }, { 7, 8, 9 }, { 10, 11, 12 } };
    tobi_vtk_array point_array = { "pressure", TOBI_F64, 1, pressure };
    tobi_vtk_array cell_array = { "load", TOBI_F32, 3, load };
    tobi_vtk_surface surface = { 4, corner, 4, face, &point_array, 1, &cell_array, 1 }, nothing = { 0 };
    const char *names[] = { "none.vtp", "zlib.vtp", "lz4.vtp", "ascii.vtp" };
    tobi_error err;
    FILE *out = fopen(in_folder("vtp.json"), "w");
    fprintf(out, "[");
    for (int c = 0; c < 4; c++) {
        assert_int_equal(tobi_vtp_write(in_folder(names[c]), (tobi_compression)c, &surface, &err), 0);
        fprintf(out, "{\"file\": \"%s\", \"points\": 4, \"cells\": 4, \"cell_type\": 5, "
                "\"connectivity\": %d, \"bounds\": [0, 2, 0, 3, -4, 0], \"arrays\": "
                "{\"pressure\": 1, \"load\": 3}, \"ranges\": {\"pressure\": [-2, 1e5], \"load\": [1, 12]}, "
                "\"sums\": {\"load\": 240}},\n", names[c],
                3 + 2*4 + 3*5 + 4*6);
    }
    assert_int_equal(tobi_vtp_write(in_folder("nothing.vtp"), TOBI_COMPRESS_LZ4, &nothing, &err), 0);
    assert_int_equal(tobi_stl_write(in_folder("tetra.stl"), 4, corner, 4, face, &err), 0);
    fprintf(out, "{\"file\": \"nothing.vtp\", \"points\": 0, \"cells\": 0},\n"
            "{\"file\": \"tetra.stl\", \"points\": 4, \"cells\": 4, \"cell_type\": 5, "
            "\"bounds\": [0, 2, 0, 3, -4, 0]},\n");

    /* A collection whose file and part names need escaping. */
    mkdir(in_folder("a&b"), 0777);
    assert_int_equal(tobi_vtp_write(in_folder("a&b/\"0\".vtp"), TOBI_COMPRESS_ZLIB, &surface, &err), 0);
    tobi_pvd_entry entries[] = { { 0, "a&b/\"0\".vtp", "fish <1>\n", 0 }, { 0, "zlib.vtp", NULL, 1 },
                                 { 0.1 + 0.2, "lz4.vtp", "fish", 0 } };
    tobi_pvd list = { 0 };
    for (int k = 0; k < 3; k++) assert_int_equal(tobi_pvd_add(&list, &entries[k], &err), 0);
    assert_int_equal(tobi_pvd_write(in_folder("series.pvd"), &list, &err), 0);
    tobi_pvd_free(&list);
    fprintf(out, "{\"file\": \"series.pvd\", \"times\": [0, 0, 0.30000000000000004], \"parts\": [0, 1, 0], "
            "\"names\": [\"fish <1>_\", \"\", \"fish\"], \"each\": {\"points\": 4, \"cells\": 4}}]\n");
    fclose(out);
    require_vtk_answer(in_folder("vtp.json"));
}

static void stl_normals_point_outwards(void **state)
{
    (void)state;
    tobi_error err;
    assert_int_equal(tobi_stl_write(in_folder("n.stl"), 4, corner, 4, face, &err), 0);
    FILE *in = fopen(in_folder("n.stl"), "rb");
    float normal[3];
    fseek(in, 84, SEEK_SET);
    assert_int_equal(fread(normal, 4, 3, in), 3);
    fclose(in);
    assert_true(normal[0] == 0 && normal[1] == 0 && normal[2] == 1);
    struct stat info;
    stat(in_folder("n.stl"), &info);
    assert_int_equal(info.st_size, 84 + 4*50);
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    tobi_error err;
    const int32_t wild[1][3] = { { 0, 1, 4 } };
    tobi_vtk_surface surface = { .vertex_count = 4, .vertices = corner,
                                 .triangle_count = 1, .triangles = wild };
    const char *path = in_folder("wrong.vtp");
    assert_int_equal(tobi_vtp_write(path, TOBI_COMPRESS_ZLIB, &surface, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "triangle 0 uses vertex 4 of 4"));
    assert_int_equal(tobi_stl_write(path, 4, corner, 1, wild, &err), TOBI_INVALID);
    tobi_vtk_array array = { "a", (tobi_type)9, 1, density };
    assert_int_equal(tobi_vtu_write(path, TOBI_COMPRESS_ZLIB, 3, points, &array, 1, &err), TOBI_INVALID);
    array = (tobi_vtk_array){ "a", TOBI_F32, 0, density };
    assert_int_equal(tobi_vtu_write(path, TOBI_COMPRESS_ZLIB, 3, points, &array, 1, &err), TOBI_INVALID);
    array = (tobi_vtk_array){ "a", TOBI_F32, 1, NULL };
    assert_int_equal(tobi_vtu_write(path, TOBI_COMPRESS_ZLIB, 3, points, &array, 1, &err), TOBI_INVALID);
    array = (tobi_vtk_array){ NULL, TOBI_F32, 1, density };
    assert_int_equal(tobi_vtu_write(path, TOBI_COMPRESS_ZLIB, 3, points, &array, 1, &err), TOBI_INVALID);
    assert_int_equal(tobi_vtu_write(path, (tobi_compression)7, 3, points, NULL, 0, &err), TOBI_INVALID);
    assert_int_equal(tobi_vtu_write(path, TOBI_COMPRESS_ZLIB, -1, points, NULL, 0, &err), TOBI_INVALID);
    const double hole[3] = { 1, NAN, 3 };
    array = (tobi_vtk_array){ "p", TOBI_F64, 1, hole };
    assert_int_equal(tobi_vtu_write(path, TOBI_ASCII, 3, points, &array, 1, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "row 1 of p"));
    assert_false(exists(path));
    assert_false(exists(in_folder("wrong.vtp.part")));
    assert_int_equal(tobi_vtu_write(in_folder("no/such/a.vtu"), TOBI_ASCII, 0, NULL, NULL, 0, &err), TOBI_IO);
    assert_non_null(strstr(err.text, "no/such/a.vtu: No such file or directory"));
}

/* Points, lines and triangles that share no corner. */
static void loose_cells_are_read_by_vtk(void **state)
{
    (void)state;
    const double load[3] = { 1, 2, 4 };
    const tobi_vtk_array array = { "load", TOBI_F64, 1, load };
    const int kinds[] = { 0, 1, 3, 5 };             /* VTK's numbers of vertex, line, triangle */
    tobi_vtk_cells cells = { .points = points, .arrays = &array, .array_count = 1 };
    tobi_error err;
    FILE *out = fopen(in_folder("cells.json"), "w");
    fprintf(out, "[");
    for (cells.corners = 1; cells.corners <= 3; cells.corners++) {
        char name[64];
        cells.count = 3;
        snprintf(name, sizeof name, "cells_%d.vtp", cells.corners);
        assert_int_equal(tobi_vtp_write_cells(in_folder(name), TOBI_COMPRESS_ZLIB, &cells, &err), TOBI_OK);
        fprintf(out, "{\"file\": \"%s\", \"points\": %d, \"cells\": 3, \"cell_type\": %d, \"sums\": "
                "{\"load\": 17}},\n", name, 3*cells.corners, kinds[cells.corners]);
    }
    cells = (tobi_vtk_cells){ .corners = 3 };
    assert_int_equal(tobi_vtp_write_cells(in_folder("no_cells.vtp"), TOBI_ASCII, &cells, &err), TOBI_OK);
    fprintf(out, "{\"file\": \"no_cells.vtp\", \"points\": 0, \"cells\": 0}]\n");
    fclose(out);
    cells.corners = 4;
    assert_int_equal(tobi_vtp_write_cells(in_folder("four.vtp"), TOBI_ASCII, &cells, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "cells of 4 points; allowed are 1 to 3"));
    cells = (tobi_vtk_cells){ .corners = 1, .count = 1 };
    assert_int_equal(tobi_vtp_write_cells(in_folder("none.vtp"), TOBI_ASCII, &cells, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "no points"));
    require_vtk_answer(in_folder("cells.json"));
}

static int count_files(void)
{
    char command[300], line[32] = "";
    snprintf(command, sizeof command, "ls '%s' | wc -l", folder);
    FILE *in = popen(command, "r");
    assert_non_null(fgets(line, sizeof line, in));
    pclose(in);
    return atoi(line);
}

/* The disk fills at many different bytes: each time an error with the path, and no new file. */
static void full_disk_leaves_nothing(void **state)
{
    (void)state;
    signal(SIGXFSZ, SIG_IGN);
    struct rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    int files = count_files(), failures = 0;
    const int sizes[] = { 0, 1, 500, 4096, 20000, 131072, 400000 };
    for (int c = 0; c < 4; c++)
        for (size_t k = 0; k < sizeof sizes/sizeof *sizes; k++) {
            struct rlimit limit = { (rlim_t)sizes[k], before.rlim_max };
            tobi_error err = { 0 };
            setrlimit(RLIMIT_FSIZE, &limit);
            tobi_status status = tobi_vtu_write(in_folder("full.vtu"), (tobi_compression)c, N, points, arrays,
                                                5, &err);
            setrlimit(RLIMIT_FSIZE, &before);
            assert_int_equal(status, TOBI_IO);
            assert_non_null(strstr(err.text, "full.vtu: File too large"));
            failures++;
        }
    assert_int_equal(failures, 28);
    assert_int_equal(count_files(), files);
}

static int set_up(void **state)
{
    (void)state;
    fill();
    return mkdtemp(folder) ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    char command[300];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vtu_is_read_by_vtk), cmocka_unit_test(surfaces_are_read_by_vtk),
        cmocka_unit_test(stl_normals_point_outwards), cmocka_unit_test(wrong_arguments_are_refused),
        cmocka_unit_test(loose_cells_are_read_by_vtk),
        cmocka_unit_test(full_disk_leaves_nothing)
    };
    return cmocka_run_group_tests_name("io/vtk", tests, set_up, tear_down);
}

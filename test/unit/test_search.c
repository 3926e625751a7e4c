/* Looking into the search: cells and neighbours against a loop over all pairs, kernels against their
   definition, and the files of one particle as VTK reads them. */
#include "tobiuo/inspect.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static tobi_world *make_tank(const char *method, int dimension, int periodic)
{
    tobi_error err;
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    w.method = method;
    w.dimension = dimension;
    w.spacing = 0.01;
    w.domain_min[0] = -0.1;
    w.domain_max[0] = 0.1; w.domain_max[1] = 0.2; w.domain_max[2] = dimension == 3 ? 0.2 : 0;
    if (periodic) w.wall_min[0] = w.wall_max[0] = TOBI_WALL_PERIODIC;
    w.gravity[2] = 0;
    w.gravity[dimension - 1] = -9.81;
    assert_int_equal(tobi_world_create(&w, NULL, &world, &err), TOBI_OK);
    tobi_fluid_def f = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    fill.box_min[0] = -0.1;
    fill.box_max[0] = 0.1; fill.box_max[1] = dimension == 3 ? 0.2 : 0.08; fill.box_max[2] = 0.08;
    assert_int_equal(tobi_world_add_fluid(world, &f, &fill, 1, &err), TOBI_OK);
    return world;
}

typedef struct all { int64_t count, *id, *cell; double (*x)[3]; tobi_search search; } all;

static all read_all(tobi_world *world)
{
    all a;
    tobi_error err;
    assert_int_equal(tobi_world_search(world, &a.search, &err), TOBI_OK);
    a.count = a.search.particles;
    assert_true(a.count > 100);
    a.id = malloc((size_t)a.count*sizeof *a.id);
    a.cell = malloc((size_t)a.count*sizeof *a.cell);
    a.x = malloc((size_t)a.count*sizeof *a.x);
    assert_int_equal(tobi_world_read_ids(world, TOBI_FLUID, a.id, a.count, &err), TOBI_OK);
    assert_int_equal(tobi_world_cells(world, a.cell, a.count, &err), TOBI_OK);
    assert_int_equal(tobi_world_read(world, TOBI_FLUID, "position", a.x[0], a.count, &err), TOBI_OK);
    return a;
}

static void free_all(all *a)
{
    free(a->id);
    free(a->cell);
    free(a->x);
}

static double distance(const all *a, int64_t i, int64_t j)
{
    double square = 0;
    for (int c = 0; c < 3; c++) {
        double d = fabs(a->x[i][c] - a->x[j][c]), side = a->search.cells[c]*a->search.width[c];
        if (a->search.periodic[c] && side - d < d) d = side - d;
        square += d*d;
    }
    return sqrt(square);
}

/* After some steps, so that not all lies on a lattice. Distances in steps are single precision. */
static void neighbours_are_those_within_the_support(void **state)
{
    (void)state;
    static const char *const methods[] = { "dfsph", "wcsph", "isph" };
    for (int k = 0; k < 6; k++) {
        tobi_error err;
        tobi_world *world = make_tank(methods[k/2], 2 + k%2, k%3 == 0);
        for (int n = 0; n < 3; n++) assert_int_equal(tobi_world_step(world, 0, NULL, &err), TOBI_OK);
        all a = read_all(world);
        for (int64_t i = 3; i < a.count; i += 97) {
            int64_t ids[512], count, expected = 0;
            assert_int_equal(tobi_world_neighbours(world, a.id[i], ids, 512, &count, &err), TOBI_OK);
            for (int64_t j = 0; j < a.count; j++) {
                const double away = distance(&a, i, j)/a.search.support - 1;
                const int listed = expected < count && ids[expected] == a.id[j];
                if (j == i) assert_false(listed);
                else if (fabs(away) > 1e-6) assert_int_equal(listed, away < 0);  /* nearer ones: in doubt */
                expected += listed;
            }
            assert_int_equal(count, expected);
            assert_true(count > 3);
        }
        free_all(&a);
        tobi_world_destroy(world);
    }
}

static void cells_hold_their_particles(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        tobi_world *world = make_tank("dfsph", 2 + k, k);
        all a = read_all(world);
        for (int64_t i = 0; i < a.count; i++) {
            const int *n = a.search.cells;
            const int64_t at[3] = { a.cell[i]%n[0], a.cell[i]/n[0]%n[1], a.cell[i]/n[0]/n[1] };
            for (int c = 0; c < 3; c++) {
                assert_true(a.search.width[c] >= a.search.support);
                const double low = a.search.lower[c] + (double)at[c]*a.search.width[c];
                assert_true(a.x[i][c] >= low - 1e-12 && a.x[i][c] <= low + a.search.width[c] + 1e-12);
            }
        }
        free_all(&a);
        tobi_world_destroy(world);
    }
}

/* Names, W of an integral of one (midpoints, fine), the slope as difference quotient. */
static void kernels_integrate_to_one(void **state)
{
    (void)state;
    char name[32], cut[5];
    int count = 0;
    for (; tobi_kernel_name(count, name, sizeof name); count++)
        for (int dimension = 2; dimension <= 3; dimension++) {
            const double h = 0.3, step = h/20000;
            double sum = 0;
            for (int k = 0; k < 20000; k++) {
                const double r = (k + 0.5)*step, ring = dimension == 3 ? 4*M_PI*r*r : 2*M_PI*r;
                sum += tobi_kernel_value(count, dimension, h, r)*ring*step;
            }
            print_message("%s %d-D: %.8f\n", name, dimension, sum);
            assert_true(fabs(sum - 1) < 1e-6);
            for (double r = 0.01; r < 0.29; r += 0.02) {
                const double e = 1e-6, slope = (tobi_kernel_value(count, dimension, h, r + e) -
                                                tobi_kernel_value(count, dimension, h, r - e))/(2*e);
                assert_true(fabs(tobi_kernel_slope(count, dimension, h, r) - slope) < 1e-4*(1 + fabs(slope)));
            }
            assert_true(tobi_kernel_value(count, dimension, h, h) == 0);
        }
    assert_true(count > TOBI_KERNEL_CUBIC_SPLINE);
    assert_true(tobi_kernel_name(TOBI_KERNEL_CUBIC_SPLINE, name, sizeof name));
    assert_string_equal(name, "cubic-spline");
    assert_true(tobi_kernel_name(TOBI_KERNEL_CUBIC_SPLINE, cut, sizeof cut));
    assert_string_equal(cut, "cubi");
    assert_false(tobi_kernel_name(-1, name, sizeof name));
    assert_true(isnan(tobi_kernel_value(count, 3, 1, 0.5)) && isnan(tobi_kernel_value(0, 1, 1, 0.5)));
    assert_true(isnan(tobi_kernel_slope(0, 3, 0, 0.5)) && isnan(tobi_kernel_slope(0, 3, 1, -1)));
}

static void what_cannot_be_answered_is_told(void **state)
{
    (void)state;
    tobi_error err;
    tobi_search search;
    int64_t count, cell[4];
    tobi_world *world = make_tank("dfsph", 2, 0);
    assert_int_equal(tobi_world_cells(world, cell, 4, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "room for 4 given"));
    assert_int_equal(tobi_world_neighbours(world, 1000000, NULL, 0, &count, &err), TOBI_NOT_FOUND);
    assert_non_null(strstr(err.text, "no particle 1000000"));
    assert_int_equal(tobi_world_write_search(world, -1, "nowhere", &err), TOBI_NOT_FOUND);
    assert_int_equal(tobi_world_search(NULL, &search, &err), TOBI_INVALID);
    assert_int_equal(tobi_world_search(world, NULL, &err), TOBI_INVALID);
    tobi_world_destroy(world);
    tobi_world_def w = tobi_default_world_def();
    w.method = "mlsmpm";
    w.domain_max[0] = w.domain_max[1] = w.domain_max[2] = 1;
    w.spacing = 0.1;
    assert_int_equal(tobi_world_create(&w, NULL, &world, &err), TOBI_OK);
    assert_int_equal(tobi_world_search(world, &search, &err), TOBI_UNSUPPORTED);
    assert_non_null(strstr(err.text, "mlsmpm has no neighbour search"));
    tobi_world_destroy(world);
}

/* How many particles are in the cells that touch that of particle i, by their numbers alone. */
static int64_t count_searched(const all *a, int64_t i)
{
    const int *n = a->search.cells;
    int64_t found = 0;
    for (int64_t j = 0; j < a->count; j++) {
        const int64_t p = a->cell[i], q = a->cell[j];
        const int64_t away[3] = { llabs(p%n[0] - q%n[0]), llabs(p/n[0]%n[1] - q/n[0]%n[1]),
                                  llabs(p/n[0]/n[1] - q/n[0]/n[1]) };
        int near = 1;
        for (int c = 0; c < 3; c++)
            near &= away[c] <= 1 || (a->search.periodic[c] && away[c] == n[c] - 1);
        found += near;
    }
    return found;
}

/* What VTK shall find: exit code of the script that reads, 77 without VTK. */
static int read_files(const char *dir, const all *a, int64_t i, int64_t neighbours)
{
    char path[64], command[512];
    snprintf(path, sizeof path, "%s/checks.json", dir);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    const long long count = a->count, id = a->id[i];
    fprintf(f, "[{\"file\": \"all.vtp\", \"points\": %lld, \"cells\": %lld,", count, count);
    fprintf(f, " \"arrays\": {\"cell\": 1}},\n{\"file\": \"center.vtp\", \"points\": 1,");
    fprintf(f, " \"ranges\": {\"particle_id\": [%lld, %lld]}},\n", id, id);
    fprintf(f, "{\"file\": \"inCell.vtp\", \"points\": %lld,", (long long)count_searched(a, i));
    fprintf(f, " \"arrays\": {\"weight\": 1}},\n");
    fprintf(f, "{\"file\": \"inSphere.vtp\", \"points\": %lld,", (long long)neighbours + 1);
    fprintf(f, " \"arrays\": {\"distance\": 1}},\n");
    fprintf(f, "{\"file\": \"each_cell.vtp\", \"points\": %lld, \"cell_type\": 1},\n", count);
    fprintf(f, "{\"file\": \"each_cell_position.vtp\", \"arrays\": {\"searched\": 1}}]\n");
    fclose(f);
    snprintf(command, sizeof command, "/usr/bin/python3 '%s/test/api/read_vtk.py' '%s'", TOBI_SOURCE_DIR,
             path);
    const int code = system(command)/256;
    return code == 127 ? 77 : code;
}

/* VTK counts the points that the questions above count. */
static void files_are_read_by_vtk(void **state)
{
    (void)state;
    char dir[] = "/tmp/tobi_search_XXXXXX", command[64];
    tobi_error err;
    int64_t neighbours;
    assert_non_null(mkdtemp(dir));
    tobi_world *world = make_tank("dfsph", 3, 1);
    all a = read_all(world);
    const int64_t i = a.count/2;
    assert_int_equal(tobi_world_neighbours(world, a.id[i], NULL, 0, &neighbours, &err), TOBI_OK);
    assert_int_equal(tobi_world_write_search(world, a.id[i], dir, &err), TOBI_OK);
    const int code = read_files(dir, &a, i, neighbours);
    snprintf(command, sizeof command, "rm -rf '%s'", dir);
    assert_int_equal(system(command), 0);
    free_all(&a);
    tobi_world_destroy(world);
    if (code == 77) skip();
    assert_int_equal(code, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(neighbours_are_those_within_the_support),
        cmocka_unit_test(cells_hold_their_particles),
        cmocka_unit_test(kernels_integrate_to_one),
        cmocka_unit_test(what_cannot_be_answered_is_told),
        cmocka_unit_test(files_are_read_by_vtk),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

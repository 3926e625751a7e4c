/* The surface that a picture shows encloses the volume of the particles: a ball, a box and a plate of solids,
   in 2-D a disc, a square and a bar. What is known: the number of particles times what each fills. */
#define _GNU_SOURCE 1
#include "view/draw.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <cmocka.h>

enum { HALF = 20, MOST = 8*HALF*HALF*HALF };
enum { BALL, BOX, PLATE };
static double place[MOST][3];
static int32_t row[MOST];

static bool is_within(int shape, double across, const double p[3])
{
    if (shape == BALL) return p[0]*p[0] + p[1]*p[1] + p[2]*p[2] < across*across/4;
    for (int k = 0; k < 3; k++)
        if (fabs(p[k]) > (shape == PLATE && k == 1 ? 2 : across/2)) return false;
    return true;
}

static double chance(void)
{
    static uint32_t seed = 1;
    return (double)(seed = 1664525*seed + 1013904223)/4294967296.0 - 0.5;
}

/* A lattice of spacing 1 that is not quite one. Returns the number of particles. */
static int fill(int dimension, int shape, double across)
{
    int n = 0;
    for (int k = dimension == 3 ? -HALF : 0; k < (dimension == 3 ? HALF : 1); k++)
        for (int j = -HALF; j < HALF; j++)
            for (int i = -HALF; i < HALF; i++) {
                const double p[3] = { i + 0.5, j + 0.5, dimension == 3 ? k + 0.5 : 0 };
                if (!is_within(shape, across, p)) continue;
                for (int a = 0; a < dimension; a++) place[n][a] = p[a] + 0.2*chance();
                place[n][2] = dimension == 3 ? place[n][2] : 0;
                row[n] = n, n++;
            }
    return n;
}

static double measure(const geometry *g, int dimension)
{
    double sum = 0;
    for (int64_t t = 0; t < g->faces; t++) {
        const vec a = g->place[g->face[t][0]], b = g->place[g->face[t][1]], c = g->place[g->face[t][2]];
        sum += dimension == 3 ? (double)vec_dot(a, vec_cross(b, c))/6
            : fabs((double)vec_cross(vec_sub(b, a), vec_sub(c, a)).z)/2;
    }
    return fabs(sum);
}

/* The volume of the surface over that of the particles. */
static double share_of(int dimension, int shape, double across)
{
    const int n = fill(dimension, shape, across);
    tobi_picture f = tobi_default_picture();
    tobi_exec exec;
    tobi_error err;
    bool around;
    for (int k = 0; k < 3; k++) f.box_min[k] = -60, f.box_max[k] = 60;
    f.dimension = dimension, f.positions = (const double (*)[3])place, f.particle_count = n, f.radius = 0.5;
    assert_int_equal(tobi_exec_init(&exec, 1, &err), TOBI_OK);
    const canvas c = { .width = 100, .height = 100, .samples = 2, .threads = 1,
                       .kernels = tile_kernels_for(exec.isa),
                       .camera = { .eye = { 0, 0, -200 }, .right = { 1, 0, 0 }, .up = { 0, 1, 0 },
                                   .forward = { 0, 0, 1 }, .focal = 100, .near = 1,
                                   .orthographic = dimension == 2 } };
    segments outline = { .count = 0 };
    geometry g = { .faces = 0 }, drops = { .faces = 0 };
    const surface_request r = { .f = &f, .row = row, .count = n, .radius = 0.5, .evens = true,
                                .level = view_even_level(dimension), .drop = 0.55f, .outline = &outline };
    assert_int_equal(dimension == 3 ? view_add_surface(&g, &drops, &c, &r, &around, &err)
                         : view_add_region(&g, &c, &r, &err), TOBI_OK);
    assert_int_equal(drops.ball_count + g.ball_count, 0);
    const double share = measure(&g, dimension)/n;
    view_geometry_free(&g);
    view_geometry_free(&drops);
    free(outline.end);
    tobi_exec_free(&exec);
    return share;
}

static void solids_have_their_volume(void **state)
{
    (void)state;
    assert_float_equal(share_of(3, BALL, 16), 1, 0.01);
    assert_float_equal(share_of(3, BALL, 32), 1, 0.01);
    assert_float_equal(share_of(3, BOX, 16), 1, 0.015);      /* its edges are round */
    assert_float_equal(share_of(3, BOX, 32), 1, 0.01);
    assert_float_equal(share_of(3, PLATE, 32), 1, 0.03);     /* four layers */
}

static void solids_have_their_area(void **state)
{
    (void)state;
    assert_float_equal(share_of(2, BALL, 16), 1, 0.01);
    assert_float_equal(share_of(2, BALL, 32), 1, 0.01);
    assert_float_equal(share_of(2, BOX, 16), 1, 0.01);
    assert_float_equal(share_of(2, PLATE, 32), 1, 0.04);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solids_have_their_volume),
        cmocka_unit_test(solids_have_their_area),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Corners, edges and balls of surfaces, and the triangles that a box touches. */
#include "geom/facets.h"
#include "geom/mesh.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

typedef struct solid { tobi_mesh mesh; tobi_bvh *bvh; tobi_facets facets; } solid;

static void open_solid(solid *s, const char *name, int flat)
{
    tobi_error err = { 0 };
    char path[300];
    snprintf(path, sizeof path, "%s/test/meshes/%s.obj", TOBI_SOURCE_DIR, name);
    memset(s, 0, sizeof *s);
    if (tobi_mesh_read(path, &s->mesh, &err) != TOBI_OK ||
        tobi_mesh_orient(&s->mesh, name, &err) != TOBI_OK ||
        tobi_bvh_build(s->mesh.vertex_count, (const double (*)[3])s->mesh.vertices, s->mesh.triangle_count,
                       (const int32_t (*)[3])s->mesh.triangles, &s->bvh, &err) != TOBI_OK ||
        tobi_facets_build(&s->facets, s->bvh, (const double (*)[3])s->mesh.vertices, flat, &err) != TOBI_OK)
        fail_msg("%s", err.text);
}

static void close_solid(solid *s)
{
    tobi_facets_free(&s->facets);
    tobi_bvh_free(s->bvh);
    tobi_mesh_free(&s->mesh);
}

static int count_owned(const tobi_facets *f, int bits)
{
    int sum = 0;
    for (int64_t t = 0; t < f->triangle_count; t++)
        for (int k = 0; k < 6; k++) sum += (bits >> k & 1) && (f->owned[t] >> k & 1);
    return sum;
}

/* A box of 192 triangles has 8 corners, and its 12 edges are the only ones, in pieces. */
static void test_box(void **state)
{
    (void)state;
    solid s;
    double length = 0, min[3], max[3];
    open_solid(&s, "box", 0);
    const tobi_facets *f = &s.facets;
    assert_int_equal(f->corner_count, 8);
    assert_int_equal(count_owned(f, 7), 8);
    assert_true(f->convex && f->ball == 0);
    for (int64_t t = 0; t < f->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            if (!(f->owned[t] >> (3 + k) & 1)) continue;
            const double *a = f->vertex[f->triangle[t][k]], *b = f->vertex[f->triangle[t][(k + 1)%3]];
            length += hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
        }
    tobi_mesh_box(&s.mesh, min, max);
    assert_true(fabs(length - 4*(max[0] - min[0] + max[1] - min[1] + max[2] - min[2])) < 1e-9);
    close_solid(&s);
}

static void test_balls(void **state)
{
    (void)state;
    solid s;
    open_solid(&s, "sphere", 0);
    assert_true(fabs(s.facets.ball - 0.5) < 1e-6 && s.facets.ball_gap > 0 && s.facets.ball_gap < 0.005);
    assert_int_equal(s.facets.corner_count, s.mesh.vertex_count);
    close_solid(&s);
    open_solid(&s, "torus", 0);
    assert_true(!s.facets.convex && s.facets.ball == 0);
    close_solid(&s);
    open_solid(&s, "cylinder", 0);
    assert_true(s.facets.convex && s.facets.ball == 0);
    close_solid(&s);
}

typedef struct seen { uint8_t *at; int count; } seen;

static void mark(void *user, int32_t triangle)
{
    seen *s = user;
    s->count += !s->at[triangle];
    s->at[triangle] = 1;
}

/* No triangle whose own box meets the box is left out; most of the others are. */
static void test_touching(void **state)
{
    (void)state;
    solid s;
    open_solid(&s, "torus", 0);
    int64_t n = s.mesh.triangle_count, needed = 0, found = 0;
    seen view = { calloc((size_t)n, 1), 0 };
    srand(7);
    for (int trial = 0; trial < 300; trial++) {
        double low[3], high[3];
        for (int a = 0; a < 3; a++) {
            low[a] = 1.6*rand()/RAND_MAX - 0.8;
            high[a] = low[a] + 0.3*rand()/RAND_MAX;
        }
        memset(view.at, 0, (size_t)n);
        view.count = 0;
        tobi_bvh_touching(s.bvh, low, high, mark, &view);
        found += view.count;
        for (int64_t t = 0; t < n; t++) {
            int meets = 1;
            for (int a = 0; a < 3; a++) {
                double x = s.mesh.vertices[s.mesh.triangles[t][0]][a];
                double y = s.mesh.vertices[s.mesh.triangles[t][1]][a];
                double z = s.mesh.vertices[s.mesh.triangles[t][2]][a];
                meets &= fmin(x, fmin(y, z)) <= high[a] && fmax(x, fmax(y, z)) >= low[a];
            }
            needed += meets;
            if (meets) assert_int_equal(view.at[t], 1);
        }
    }
    print_message("%lld triangles met, %lld visited\n", (long long)needed, (long long)found);
    assert_true(needed > 1000 && found < 3*needed);
    free(view.at);
    close_solid(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_box), cmocka_unit_test(test_balls), cmocka_unit_test(test_touching),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Scattered points: distances, density, repeatability. */
#include "test_geom_solids.h"
#include "geom/seed.h"

typedef struct cloud {
    double (*x)[3];
    int64_t count;
} cloud;

static int inside(const tobi_seed_shape *s, const double x[3])
{
    double d2 = 0, out = 0;
    if (s->tree) return tobi_bvh_inside(s->tree, x);
    for (int a = 0; a < s->dimension; a++) {
        d2 += pow(x[a] - 0.5*(s->lower[a] + s->upper[a]), 2);
        out += x[a] < s->lower[a] || x[a] > s->upper[a];
    }
    return s->radius > 0 ? d2 < s->radius*s->radius : !(out > 0);
}

static cloud place(const tobi_seed_shape *s, double spacing)
{
    int64_t n[3], room = 1;
    cloud c = { NULL, 0 };
    for (int a = 0; a < 3; a++) {
        n[a] = a < s->dimension ? (int64_t)ceil((s->upper[a] - s->lower[a])/spacing - 1e-9) : 1;
        room *= n[a];
    }
    c.x = malloc((size_t)room*sizeof *c.x);
    for (int64_t k = 0; k < room; k++) {
        const int64_t at[3] = { k%n[0], k/n[0]%n[1], k/n[0]/n[1] };
        double *x = c.x[c.count];
        for (int a = 0; a < 3; a++)
            x[a] = a < s->dimension ? s->lower[a] + ((double)at[a] + 0.5)*spacing : 0;
        c.count += inside(s, x);
    }
    return c;
}

static cloud scatter(const tobi_seed_shape *s, double spacing, uint64_t number, int threads)
{
    cloud c = place(s, spacing);
    OK(tobi_seed_scatter(s, spacing, number, c.count, c.x, threads, &err));
    return c;
}

/* Distance of each point to its nearest; mean and least in spacings. */
static void find_distances(cloud c, double spacing, double *mean, double *least)
{
    *mean = 0;
    *least = INFINITY;
    for (int64_t i = 0; i < c.count; i++) {
        double nearest = INFINITY;
        for (int64_t j = 0; j < c.count; j++) {
            double d2 = 0;
            for (int a = 0; a < 3; a++) d2 += pow(c.x[i][a] - c.x[j][a], 2);
            if (i != j) nearest = fmin(nearest, sqrt(d2)/spacing);
        }
        *mean += nearest/(double)c.count;
        *least = fmin(*least, nearest);
    }
}

/* Share of the points in the middle, the shape shrunk to half its size. */
static double count_middle(const tobi_seed_shape *s, cloud c)
{
    int64_t n = 0;
    for (int64_t i = 0; i < c.count; i++) {
        double twice[3] = {0, 0, 0};
        for (int a = 0; a < s->dimension; a++) twice[a] = 2*c.x[i][a] - 0.5*(s->lower[a] + s->upper[a]);
        n += inside(s, twice);
    }
    return (double)n/(double)c.count;
}

static void check_shape(const tobi_seed_shape *s, double spacing, double middle)
{
    cloud c = scatter(s, spacing, 7, 1), same = scatter(s, spacing, 7, 3), other = scatter(s, spacing, 8, 2);
    double mean, least, line = 0;
    for (int64_t i = 0; i < c.count; i++) {
        assert_true(inside(s, c.x[i]));
        const double at = (c.x[i][0] - s->lower[0])/spacing;
        line += pow(at - floor(at) - 0.5, 2)/(double)c.count;
    }
    assert_memory_equal(c.x, same.x, (size_t)c.count*sizeof *c.x);
    assert_memory_not_equal(c.x, other.x, (size_t)c.count*sizeof *c.x);
    find_distances(c, spacing, &mean, &least);
    /* Seen 0.73 to 0.76; random points without relaxation have neighbours at 0.01, jittered ones at 0.1. */
    assert_true(least > 0.65);
    /* Seen 0.95; 1.12 (2-D: 1.07) would be the densest packing, 1 the lattice. */
    assert_true(mean > 0.9 && mean < 1.0);
    /* 0 on a lattice, 1/12 where no place between two planes is preferred; walls order the points near them,
       and 0.33/12 to 0.65/12 is seen. */
    assert_true(line > 0.2/12);
    if (middle > 0) WITHIN(count_middle(s, c)/middle, 1, 0.06);
    free(c.x);
    free(same.x);
    free(other.x);
}

static void even_in_boxes_and_spheres(void **state)
{
    (void)state;
    const tobi_seed_shape box = { .lower = {-1, 2, 0}, .upper = {0.6, 3.2, 1.5}, .dimension = 3 };
    const tobi_seed_shape flat = { .lower = {-1, 2, 0}, .upper = {0.6, 3.2, 0}, .dimension = 2 };
    const tobi_seed_shape ball = { .lower = {-1, -1, -1}, .upper = {1, 1, 1}, .radius = 1, .dimension = 3 };
    const tobi_seed_shape disc = { .lower = {-1, -1, 0}, .upper = {1, 1, 0}, .radius = 1, .dimension = 2 };
    check_shape(&box, 0.1, 1/8.0);
    check_shape(&flat, 0.025, 1/4.0);
    check_shape(&ball, 0.125, 1/8.0);
    check_shape(&disc, 0.04, 1/4.0);
}

static void even_in_meshes(void **state)
{
    (void)state;
    tobi_mesh m = read_own("test/meshes/torus.obj");
    tobi_bvh *tree;
    OK(tobi_bvh_build(m.vertex_count, (const double (*)[3])m.vertices, m.triangle_count,
                      (const int32_t (*)[3])m.triangles, &tree, &err));
    tobi_seed_shape s = { .tree = tree, .dimension = 3 };
    tobi_bvh_box(tree, s.lower, s.upper);
    check_shape(&s, 0.05, 0);
    tobi_bvh_free(tree);
    tobi_mesh_free(&m);
}

/* Nothing to place, one point, a sheet thinner than a spacing: no trouble. */
static void small_shapes(void **state)
{
    (void)state;
    const tobi_seed_shape sheet = { .lower = {0, 0, 0}, .upper = {1, 1, 0.02}, .dimension = 3 };
    const tobi_seed_shape grain = { .lower = {0, 0, 0}, .upper = {0.1, 0.1, 0.1}, .dimension = 3 };
    OK(tobi_seed_scatter(&grain, 0.1, 1, 0, NULL, 1, &err));
    cloud one = scatter(&grain, 0.1, 1, 1), many = scatter(&sheet, 0.02, 1, 2);
    assert_int_equal(one.count, 1);
    assert_true(inside(&grain, one.x[0]));
    for (int64_t i = 0; i < many.count; i++) assert_true(inside(&sheet, many.x[i]));
    free(one.x);
    free(many.x);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(even_in_boxes_and_spheres),
        cmocka_unit_test(even_in_meshes),
        cmocka_unit_test(small_shapes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

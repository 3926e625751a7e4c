/* Surfaces of particles: closed, manifold, of the right volume, flat at sides, one for each group; the same
   bits for any number of threads; mistakes in words. */
#define _GNU_SOURCE 1
#include "calls.h"
#include "surface_rig.h"
#include "view/surface/surface.h"
#include <stdio.h>

#define D 0.01

static tobi_surface *make(const rig_points *p, tobi_surface_def d)
{
    tobi_surface *s;
    d.particle_count = p->count;
    d.positions = (const double (*)[3])p->position;
    d.spacing = D;
    OK(tobi_surface_make(&d, &s, &err));
    return s;
}

static void expect_closed(const tobi_surface *s)
{
    if (!rig_is_closed(s)) fail_msg("%d vertices: not a closed manifold", (int)s->vertex_count);
    for (int64_t i = 0; i < s->vertex_count; i++) {
        const float *n = s->normals[i];
        const float square = n[0]*n[0] + n[1]*n[1] + n[2]*n[2];
        if (fabsf(square - 1) > 1e-4f) fail_msg("normal %d has no length 1", (int)i);
    }
}

static void expect_near(double value, double wanted, double share)
{
    if (!(fabs(value - wanted) <= share*fabs(wanted)))
        fail_msg("%.6g instead of %.6g, which is off by %.3g %%", value, wanted, 100*(value/wanted - 1));
}

static const double zero[3] = { 0, 0, 0 };
static const tobi_surface_def *usual(void)
{
    static tobi_surface_def d;
    d = tobi_default_surface();
    return &d;
}

/* Every case of the cubes can be cut, with as many triangles as loops ask for, and the crossings are those of
   the corners. */
static void test_cases(void **state)
{
    (void)state;
    surface_cases *c = malloc(sizeof *c);
    assert_int_equal(surface_make_cases(c), 0);
    assert_int_equal(c->count[0] + c->count[255], 0);
    for (int k = 1; k < 255; k++) {
        int crossed = 0, used = 0;
        for (int e = 0; e < 12; e++) {
            const int u = e & 1, v = e >> 1 & 1, axis = e >> 2;
            const int low = axis == 0 ? 2*u + 4*v : axis == 1 ? u + 4*v : u + 2*v;
            crossed |= ((k >> low ^ k >> (low + (1 << axis))) & 1) << e;
        }
        for (int i = 0; i < 3*c->count[k]; i++) used |= 1 << c->edge[k][i];
        assert_int_equal(used, crossed);
    }
    free(c);
}

static void test_ball(void **state)
{
    (void)state;
    const double middle[3] = { 0.1234, 0.1267, 0.1211 };
    for (int jitter = 0; jitter < 2; jitter++) {
        rig_points p = rig_box((int[3]){ 25, 25, 25 }, zero, D, 0.3*jitter);
        rig_cut_ball(&p, middle, 0.1);
        tobi_surface *s = make(&p, *usual());
        expect_closed(s);
        assert_int_equal(rig_parts(s), 1);
        expect_near(rig_volume(s), 4.18879e-3, 0.01);
        for (int64_t i = 0; i < s->vertex_count; i++) {
            double square = 0, out = 0;
            for (int a = 0; a < 3; a++) {
                square += pow(s->vertices[i][a] - middle[a], 2);
                out += s->normals[i][a]*(s->vertices[i][a] - middle[a]);
            }
            expect_near(sqrt(square), 0.1, 0.06);
            assert_true(out > 0.8*0.1);
        }
        tobi_surface_free(s);
        free(p.position);
    }
}

static void test_box_alone(void **state)
{
    (void)state;
    rig_points p = rig_box((int[3]){ 20, 16, 24 }, (double[3]){ 3, -7, 1 }, D, 0);
    tobi_surface *s = make(&p, *usual());
    expect_closed(s);
    expect_near(rig_volume(s), 20*16*24*1e-6, 0.01);
    tobi_surface_free(s);
    free(p.position);
}

/* Water in a tank: flat at walls and floor, the level where it is, the caps whole. */
static void test_tank(void **state)
{
    (void)state;
    rig_points p = rig_box((int[3]){ 20, 20, 12 }, zero, D, 0.2);
    tobi_surface_def d = tobi_default_surface();
    for (int a = 0; a < 3; a++) d.box_max[a] = a < 2 ? 0.2 : 0.3, d.flat_min[a] = d.flat_max[a] = 1;
    tobi_surface *s = make(&p, d);
    expect_closed(s);
    expect_near(rig_volume(s), 20*20*12*1e-6, 0.01);
    int64_t at_wall = 0;
    for (int64_t i = 0; i < s->vertex_count; i++) {
        for (int a = 0; a < 3; a++) {
            assert_true(s->vertices[i][a] >= d.box_min[a] && s->vertices[i][a] <= d.box_max[a]);
            assert_int_equal(s->vertices[i][a] == d.box_min[a], s->sides[i] >> a & 1);
            assert_int_equal(s->vertices[i][a] == d.box_max[a], s->sides[i] >> (a + 3) & 1);
        }
        at_wall += s->sides[i] != 0;
        const double z = s->vertices[i][2];
        if (!s->sides[i] && fabs(z - 0.12) > 0.3*D) fail_msg("level at %g", z);
    }
    double floor = 0;
    for (int64_t t = 0; t < s->triangle_count; t++) {
        const int32_t *v = s->triangles[t];
        if (!(s->sides[v[0]] & s->sides[v[1]] & s->sides[v[2]] & 4)) continue;
        const double *a = s->vertices[v[0]], *b = s->vertices[v[1]], *c = s->vertices[v[2]];
        floor -= 0.5*((b[0] - a[0])*(c[1] - a[1]) - (b[1] - a[1])*(c[0] - a[0]));
    }
    expect_near(floor, 0.04, 1e-6);
    assert_true(at_wall > 500);
    tobi_surface_free(s);
    free(p.position);
}

/* A wave of 12 spacings keeps 0.8 of its height, though smoothing reaches as far. */
static void test_wave(void **state)
{
    (void)state;
    const double length = 12*D, pi = 3.14159265358979323846;
    rig_points p = rig_box((int[3]){ 48, 16, 12 }, zero, D, 0);
    for (int64_t i = 0; i < p.count; i++)
        p.position[i][2] *= 1 + 0.08*sin(2*pi*p.position[i][0]/length);
    tobi_surface_def d = tobi_default_surface();
    const double top[3] = { 0.48, 0.16, 0.3 };
    for (int a = 0; a < 3; a++) d.box_max[a] = top[a], d.flat_min[a] = d.flat_max[a] = 1;
    tobi_surface *s = make(&p, d);
    expect_closed(s);
    double sum = 0;
    int64_t n = 0;
    for (int64_t i = 0; i < s->vertex_count; i++)
        if (!s->sides[i]) sum += s->vertices[i][2]*sin(2*pi*s->vertices[i][0]/length), n++;
    const double height = 2*sum/(double)n/(0.08*0.12);
    if (!(height > 0.78 && height < 1.05)) fail_msg("%.3g of its height", height);
    tobi_surface_free(s);
    free(p.position);
}

/* Two halves that touch stay two surfaces, and what is negative is left out. */
static void test_groups(void **state)
{
    (void)state;
    rig_points p = rig_box((int[3]){ 24, 12, 12 }, zero, D, 0);
    int32_t *group = malloc((size_t)p.count*sizeof *group);
    for (int64_t i = 0; i < p.count; i++) {
        group[i] = p.position[i][0] < 0.08 ? 3 : p.position[i][0] < 0.16 ? 70000 : -1;
        if (i == p.count - 1) p.position[i][0] = NAN;
    }
    tobi_surface_def d = tobi_default_surface();
    d.group = group;
    tobi_surface *s = make(&p, d);
    expect_closed(s);
    assert_int_equal(rig_parts(s), 2);
    expect_near(rig_volume(s), 16*12*12*1e-6, 0.025);      /* round edges: 0.18 d2 along each */
    for (int64_t i = 0; i < s->vertex_count; i++)
        if (s->group[i] == 3) assert_true(s->vertices[i][0] < 0.08 + 0.4*D);
        else if (s->group[i] == 70000) assert_true(s->vertices[i][0] > 0.08 - 0.4*D);
        else fail_msg("group %d", (int)s->group[i]);
    tobi_surface_free(s);
    free(group);
    free(p.position);
}

/* A particle alone is a sphere of its volume wherever it lies, a film of one layer has no hole, a thread no
   gap. */
static void test_thin(void **state)
{
    (void)state;
    rig_points p = rig_box((int[3]){ 10, 10, 10 }, zero, 7.3*D, 1);
    tobi_surface *s = make(&p, *usual());
    expect_closed(s);
    assert_true(rig_parts(s) > 900);
    expect_near(rig_volume(s), 1000*1e-6, 0.05);
    tobi_surface_free(s);
    free(p.position);
    const int shape[2][3] = { { 30, 30, 1 }, { 40, 1, 1 } };
    for (int k = 0; k < 2; k++) {
        p = rig_box(shape[k], (double[3]){ 0.002, 0.003, 0.0071 }, 1.3*D, 0.2);
        s = make(&p, *usual());
        expect_closed(s);
        assert_int_equal(rig_parts(s), 1);
        /* V - E + F of a ball: no hole */
        assert_int_equal(s->vertex_count - s->triangle_count/2, 2);
        tobi_surface_free(s);
        free(p.position);
    }
}

/* Noise is the hardest field: closed and manifold whatever is near what. */
static void test_noise(void **state)
{
    (void)state;
    for (int k = 0; k < 6; k++) {
        rig_points p = rig_box((int[3]){ 16, 16, 16 }, zero, (1 + 0.2*k)*D, 2.5);
        tobi_surface_def d = tobi_default_surface();
        d.cell = k%3 == 0 ? 0.4 : k%3 == 1 ? 0.75 : 1.6;
        d.smoothing = k < 3 ? 0 : 20;
        for (int a = 0; a < 3; a++) d.box_max[a] = 0.12 + 0.04*a, d.flat_min[a] = 1, d.flat_max[a] = k & 1;
        tobi_surface *s = make(&p, d);
        expect_closed(s);
        tobi_surface_free(s);
        free(p.position);
    }
}

static void test_fields(void **state)
{
    (void)state;
    rig_points p = rig_box((int[3]){ 14, 14, 14 }, zero, D, 0.2);
    double *one = malloc((size_t)p.count*sizeof *one);
    for (int64_t i = 0; i < p.count; i++) one[i] = 4;
    const tobi_surface_field fields[2] = { { NULL, 1, one }, { "place", 3, &p.position[0][0] } };
    tobi_surface_def d = tobi_default_surface();
    d.fields = fields, d.field_count = 2;
    tobi_surface *s = make(&p, d);
    for (int64_t i = 0; i < s->vertex_count; i++) {
        assert_true(fabsf(s->fields[0][i] - 4) < 1e-4f);
        for (int a = 0; a < 3; a++) assert_true(fabs(s->fields[1][3*i + a] - s->vertices[i][a]) < 1.3*D);
    }
    tobi_surface_free(s);
    free(one);
    free(p.position);
}

static void expect_same(const tobi_surface *a, const tobi_surface *b)
{
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->triangle_count, b->triangle_count);
    const size_t n = (size_t)a->vertex_count, m = (size_t)a->triangle_count;
    assert_memory_equal(a->vertices, b->vertices, n*sizeof *a->vertices);
    assert_memory_equal(a->normals, b->normals, n*sizeof *a->normals);
    assert_memory_equal(a->triangles, b->triangles, m*sizeof *a->triangles);
    assert_memory_equal(a->fields[0], b->fields[0], n*3*sizeof(float));
}

static void test_same_bits(void **state)
{
    (void)state;
    rig_points p = rig_box((int[3]){ 30, 30, 20 }, zero, D, 1.5);
    const tobi_surface_field field = { "place", 3, &p.position[0][0] };
    tobi_surface_def d = tobi_default_surface();
    d.fields = &field, d.field_count = 1, d.threads = 1;
    for (int a = 0; a < 3; a++) d.box_max[a] = 0.3, d.flat_min[a] = d.flat_max[a] = 1;
    tobi_surface *first = make(&p, d);
    const char *const levels[] = { "2", "3", "4" };
    for (int k = 0; k < 6; k++) {
        d.threads = 1 + k;
        setenv("TOBIUO_ISA", levels[k%3], 1);
        tobi_surface *s = make(&p, d);
        expect_same(first, s);
        tobi_surface_free(s);
    }
    unsetenv("TOBIUO_ISA");
    tobi_surface_free(first);
    free(p.position);
}

static void test_nothing(void **state)
{
    (void)state;
    const rig_points none = { 0, NULL };
    tobi_surface *s = make(&none, *usual());
    assert_int_equal(s->vertex_count + s->triangle_count, 0);
    tobi_surface_free(s);
    tobi_surface_free(NULL);
}

/* A side that is far away is no concern of the particles here. */
static void test_far_side(void **state)
{
    (void)state;
    rig_points p = rig_box((int[3]){ 10, 10, 10 }, zero, D, 0.2);
    tobi_surface_def d = tobi_default_surface();
    for (int a = 0; a < 3; a++) d.box_max[a] = 1e12, d.flat_min[a] = d.flat_max[a] = 1;
    tobi_surface *s = make(&p, d);
    expect_closed(s);
    expect_near(rig_volume(s), 1e-3, 0.02);
    tobi_surface_free(s);
    free(p.position);
}

static void test_mistakes(void **state)
{
    (void)state;
    double p[2][3] = { { 0, 0, 0 }, { 1e9, 0, 0 } };
    int32_t group[2] = { 0, 1 << 20 };
    tobi_surface *s;
    tobi_surface_def good = tobi_default_surface(), d;
    good.particle_count = 2, good.positions = (const double (*)[3])p, good.spacing = D;
    REFUSED(tobi_surface_make(&good, NULL, &err), TOBI_INVALID, "surface is NULL");
    REFUSED(tobi_surface_make(NULL, &s, &err), TOBI_INVALID, "def is NULL");
    REFUSED(tobi_surface_make(&good, &s, &err), TOBI_INVALID, "spread over 1e+09 x 0 x 0 m");
    assert_null(s);
#define WRONG(change, words)                                                    \
    d = good;                                                                   \
    change;                                                                     \
    REFUSED(tobi_surface_make(&d, &s, &err), TOBI_INVALID, words)
    WRONG(d.positions = NULL, "2 particles without positions");
    WRONG(d.particle_count = -1, "-1 particles, allowed");
    WRONG(d.spacing = NAN, "spacing of nan m");
    WRONG(d.cell = 0.05, "a cell of 0.05 spacings, allowed are 0.1 to 2");
    WRONG(d.smoothing = 101, "101 rounds");
    WRONG(d.group = group, "particle 1 is of group 1048576");
    WRONG(d.flat_max[1] = 1, "the box is empty along y");
    WRONG(d.field_count = 33, "33 fields, allowed are 0 to 32");
    const tobi_surface_field wide = { NULL, 10, &p[0][0] }, empty = { NULL, 1, NULL };
    WRONG((d.field_count = 1, d.fields = &wide), "field 0 has 10 components and some values");
    WRONG((d.field_count = 1, d.fields = &empty), "no values");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cases), cmocka_unit_test(test_ball), cmocka_unit_test(test_box_alone),
        cmocka_unit_test(test_tank),
        cmocka_unit_test(test_wave), cmocka_unit_test(test_groups), cmocka_unit_test(test_thin),
        cmocka_unit_test(test_noise), cmocka_unit_test(test_fields), cmocka_unit_test(test_same_bits),
        cmocka_unit_test(test_nothing), cmocka_unit_test(test_far_side), cmocka_unit_test(test_mistakes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

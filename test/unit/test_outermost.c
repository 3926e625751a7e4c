/* Where a body's outline says that nothing lies between, no line of sight meets the mesh: at places and
   points without order, in poses without order. */
#include "calls.h"
#include "rigid_rig.h"

#define LIFT 1e-3
enum { PLACES = 400, POSES = 3 };

static double random_unit(uint64_t *seed)
{
    *seed = *seed*6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11)/9007199254740992.0;
}

/* Around the body, at most two away from its box. */
static void random_place(const tobi_body *b, uint64_t *seed, double x[3])
{
    double low[3], high[3];
    tobi_bvh_box(b->bvh, low, high);
    for (int a = 0; a < 3; a++) x[a] = low[a] - 2 + (high[a] - low[a] + 4)*random_unit(seed);
}

static void turn(tobi_body *b, uint64_t *seed)
{
    double size = 0, *q = b->rigid.orientation;
    tobi_error err = { 0 };
    for (int a = 0; a < 4; a++) {
        q[a] = random_unit(seed) - 0.5;
        size += q[a]*q[a];
    }
    for (int a = 0; a < 4; a++) q[a] /= sqrt(size);
    assert_int_equal(tobi_body_place(b, 0, &err), TOBI_OK);
}

/* Points that are outermost see all that faces them; returns how many were asked. */
static int check_points(const tobi_body *b, const double x[3])
{
    int asked = 0;
    for (int64_t k = 0; k < b->point_count; k++) {
        double r[3], to[3];
        vec3_sub(r, x, b->point[k]);
        if (!b->outermost[k] || vec3_dot(r, b->normal[k]) < LIFT) continue;
        vec3_add_scaled(to, b->point[k], LIFT, b->normal[k]);
        assert_false(tobi_bvh_segment_hits(b->bvh, x, to));
        asked++;
    }
    return asked;
}

/* Above the plane across the way from the nearest point to x, all see x. */
static int check_convex(const tobi_body *b, const double x[3], uint64_t *seed)
{
    tobi_bvh_hit hit;
    double y[3], way[3], from_foot[3];
    if (!b->convex || !tobi_bvh_closest(b->bvh, x, INFINITY, &hit) || hit.signed_distance < 0.01) return 0;
    random_place(b, seed, y);
    vec3_sub(way, x, hit.point);
    vec3_sub(from_foot, y, hit.point);
    if (vec3_dot(way, from_foot) < 0.01*hit.distance) return 0;
    assert_false(tobi_bvh_segment_hits(b->bvh, x, y));
    return 1;
}

static void check(tobi_body *b, int *points, int *places)
{
    uint64_t seed = 1;
    *points = *places = 0;
    for (int pose = 0; pose < POSES; pose++) {
        for (int k = 0; k < PLACES; k++) {
            double x[3];
            random_place(b, &seed, x);
            *points += check_points(b, x);
            *places += check_convex(b, x, &seed);
        }
        turn(b, &seed);
    }
}

static int64_t outermost(const tobi_body *b)
{
    int64_t sum = 0;
    for (int64_t k = 0; k < b->point_count; k++) sum += b->outermost[k];
    return sum;
}

static void sees_along_convex_bodies(void **state)
{
    (void)state;
    static const double side[3] = { 2, 3, 1 }, middle[3] = { 10, 10, 10 }, none[3] = { 0, 0, 0 };
    int points, places;
    rig g;
    rig_open(&g, 20, none);
    tobi_body *box = rig_box(&g, rig_def(), side, middle);
    assert_true(box->convex);
    assert_int_equal(outermost(box), box->point_count);
    check(box, &points, &places);
    assert_true(points > 100*PLACES && places > PLACES/2);
    tobi_body_def def = rig_def();
    def.sphere_radius = 2;
    for (int a = 0; a < 3; a++) def.sphere_centre[a] = 10;
    tobi_body *ball = rig_add(&g, &def);
    assert_true(ball->convex);
    check(ball, &points, &places);
    assert_true(places > PLACES/2);
    rig_close(&g);
}

/* Surfaces of 0.8 spacings and less between two faces are thin; the rig's spacing is 1. */
static void tells_thick_from_thin(void **state)
{
    (void)state;
    static const double middle[3] = { 10, 10, 10 }, none[3] = { 0, 0, 0 };
    static const double side[4][3] = { { 2, 3, 1 }, { 2, 3, 0.8 }, { 0.5, 3, 3 }, { 4, 4, 4 } };
    rig g;
    rig_open(&g, 20, none);
    for (int k = 0; k < 4; k++) assert_int_equal(rig_box(&g, rig_def(), side[k], middle)->thick, k%3 == 0);
    tobi_body_def def = rig_def();
    def.sphere_radius = 1;
    for (int a = 0; a < 3; a++) def.sphere_centre[a] = 10;
    assert_true(rig_add(&g, &def)->thick);
    rig_close(&g);
}

/* Of a ring the outer half is outermost at most. */
static void asks_in_a_ring(void **state)
{
    (void)state;
    static const double none[3] = { 0, 0, 0 };
    int points, places;
    rig g;
    rig_open(&g, 20, none);
    tobi_body_def def = rig_def();
    def.mesh = TOBI_SOURCE_DIR "/test/meshes/torus.obj";
    for (int a = 0; a < 3; a++) def.scale[a] = 4, def.translation[a] = 10;
    tobi_body *b = rig_add(&g, &def);
    assert_false(b->convex);
    assert_true(outermost(b) > 0 && outermost(b) < b->point_count);
    check(b, &points, &places);
    assert_true(points > 0 && places == 0);
    rig_close(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sees_along_convex_bodies),
        cmocka_unit_test(tells_thick_from_thin),
        cmocka_unit_test(asks_in_a_ring),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

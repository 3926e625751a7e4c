/* Particles that leave the domain by an open side, and restarts among them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "tobiuo/tobiuo.h"

/* A block that flies through the open side at x = 0, after it one that stays. No gravity. */
static tobi_world *make_world(int threads)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *world;
    w.method = "mlsmpm";
    w.spacing = 0.1;
    w.threads = threads;
    w.gravity[2] = 0;
    w.wall_min[0] = TOBI_WALL_OPEN;
    for (int a = 0; a < 3; a++) {
        w.domain_max[a] = 2;
        fill.box_min[a] = 0.5;
        fill.box_max[a] = 1;
    }
    fill.velocity[0] = -5;
    assert_int_equal(tobi_world_create(&w, NULL, &world, NULL), TOBI_OK);
    assert_int_equal(tobi_world_add_solid(world, &solid, &fill, 1, NULL), TOBI_OK);
    solid.name = "rest";
    solid.model = TOBI_STATIONARY;
    fill.velocity[0] = 0;
    fill.box_min[2] = 1.5;
    fill.box_max[2] = 1.8;
    assert_int_equal(tobi_world_add_solid(world, &solid, &fill, 1, NULL), TOBI_OK);
    return world;
}

static void check_rest(tobi_world *world)
{
    enum { MOVED = 125, KEPT = 75 };
    double id[KEPT], x[3*KEPT], material[KEPT];
    const tobi_step_info *info = tobi_world_info(world);
    assert_int_equal(info->particles_lost, MOVED);
    assert_int_equal(info->fluid_particles, KEPT);
    assert_int_equal(tobi_world_count(world, TOBI_FLUID), KEPT);
    /* They took their energy along: 125 kg at 5 m/s had 1562.5 J. */
    assert_true(fabs(info->energy_lost) < 20 && info->kinetic_energy == 0);
    assert_int_equal(tobi_world_read(world, TOBI_FLUID, "particle_id", id, KEPT, NULL), TOBI_OK);
    assert_int_equal(tobi_world_read(world, TOBI_FLUID, "material", material, KEPT, NULL), TOBI_OK);
    assert_int_equal(tobi_world_read(world, TOBI_FLUID, "position", x, KEPT, NULL), TOBI_OK);
    for (int i = 0; i < KEPT; i++) {
        assert_true(id[i] == MOVED + i && material[i] == 1);
        assert_true(x[3*i + 2] > 1.5 && x[3*i + 2] < 1.8);
    }
}

static void an_open_side_lets_out(void **state)
{
    (void)state;
    char path[] = "/tmp/tobiuo_leaving_XXXXXX";
    tobi_error err = { 0 };
    close(mkstemp(path));
    tobi_world *one = make_world(1), *three = make_world(3), *later = make_world(2);
    int64_t half = 0;
    for (int k = 0; k < 400 && (half == 0 || half == 125); k++) {     /* until some have left, not all */
        assert_int_equal(tobi_world_step(one, 0, NULL, &err), TOBI_OK);
        half = tobi_world_info(one)->particles_lost;
    }
    assert_true(half > 0 && half < 125);
    if (tobi_world_save(one, path, &err) || tobi_world_load(later, path, &err)) fail_msg("%s", err.text);
    assert_int_equal(tobi_world_count(later, TOBI_FLUID), 200 - half);
    assert_true(tobi_world_hash(one) == tobi_world_hash(later));
    if (tobi_world_advance(one, 0.5, NULL, &err) || tobi_world_advance(later, 0.5, NULL, &err) ||
        tobi_world_advance(three, 0.5, NULL, &err))
        fail_msg("%s", err.text);
    assert_true(tobi_world_hash(one) == tobi_world_hash(later));
    assert_true(tobi_world_hash(one) == tobi_world_hash(three));
    check_rest(one);
    check_rest(later);
    unlink(path);
    tobi_world_destroy(one);
    tobi_world_destroy(three);
    tobi_world_destroy(later);
}

/* When all have left, time goes on. */
static void nothing_may_be_left(void **state)
{
    (void)state;
    tobi_world_def w = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *world;
    tobi_error err = { 0 };
    w.method = "mlsmpm";
    w.dimension = 2;
    w.spacing = 0.1;
    w.gravity[1] = -9.81;
    w.wall_min[1] = TOBI_WALL_OPEN;
    for (int a = 0; a < 3; a++) w.domain_max[a] = fill.box_max[a] = 0.5;
    fill.box_max[1] = 0.3;                      /* a slip side above would hold it */
    assert_int_equal(tobi_world_create(&w, NULL, &world, NULL), TOBI_OK);
    assert_int_equal(tobi_world_add_solid(world, &solid, &fill, 1, NULL), TOBI_OK);
    if (tobi_world_advance(world, 1, NULL, &err)) fail_msg("%s", err.text);
    assert_int_equal(tobi_world_count(world, TOBI_FLUID), 0);
    assert_int_equal(tobi_world_info(world)->particles_lost, 15);
    tobi_world_destroy(world);
}

/* A block too soft to stop is thrown at a slip side; how many of its 80 particles are lost until they have
   been sorted twice. */
static int64_t throw_at_side(int leaving)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_mlsmpm_def method = tobi_default_mlsmpm_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *world;
    tobi_error err = { 0 };
    w.method = "mlsmpm";
    w.dimension = 2;
    w.spacing = 0.05;
    method.leaving = leaving;
    solid.youngs_modulus = 1;
    fill.velocity[0] = -5;
    for (int a = 0; a < 3; a++) {
        w.gravity[a] = 0;
        w.domain_max[a] = 1;
        fill.box_min[a] = a ? 0 : 0.1;
        fill.box_max[a] = a ? 1 : 0.3;
    }
    assert_int_equal(tobi_world_create(&w, &method, &world, NULL), TOBI_OK);
    assert_int_equal(tobi_world_add_solid(world, &solid, &fill, 1, NULL), TOBI_OK);
    if (tobi_world_advance(world, 5, NULL, &err)) fail_msg("%s", err.text);
    int64_t lost = tobi_world_info(world)->particles_lost;
    assert_int_equal(tobi_world_count(world, TOBI_FLUID), 80 - lost);
    tobi_world_destroy(world);
    return lost;
}

static void other_sides_keep_or_remove(void **state)
{
    (void)state;
    assert_int_equal(throw_at_side(TOBI_KEEP), 0);
    assert_true(throw_at_side(TOBI_REMOVE) > 0);
}

static void sph_has_no_open_sides(void **state)
{
    (void)state;
    tobi_world_def w = tobi_default_world_def();
    tobi_world *world;
    tobi_error err = { 0 };
    for (int a = 0; a < 3; a++) w.domain_max[a] = 1;
    w.spacing = 0.1;
    w.wall_max[1] = TOBI_WALL_OPEN;
    assert_int_equal(tobi_world_create(&w, NULL, &world, &err), TOBI_UNSUPPORTED);
    assert_non_null(strstr(err.text, "a side along y is open, which dfsph does not know; mlsmpm does"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_open_side_lets_out),
        cmocka_unit_test(nothing_may_be_left),
        cmocka_unit_test(other_sides_keep_or_remove),
        cmocka_unit_test(sph_has_no_open_sides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

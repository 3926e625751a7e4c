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
#include "solid_rig.h"

/* A block that flies through the open side at x = 0, after it one that stays. No gravity. */
static tobi_world *make_world(int threads)
{
    solid_setup s = solid_default(3, 0.1, 2);
    s.world.threads = threads;
    s.world.gravity[2] = 0;
    s.world.wall_min[0] = TOBI_WALL_OPEN;
    for (int a = 0; a < 3; a++) {
        s.fill.box_min[a] = 0.5;
        s.fill.box_max[a] = 1;
    }
    s.fill.velocity[0] = -5;
    tobi_world *world = solid_world(&s);
    s.solid.name = "rest";
    s.solid.model = TOBI_STATIONARY;
    s.fill.velocity[0] = 0;
    s.fill.box_min[2] = 1.5;
    s.fill.box_max[2] = 1.8;
    OK(tobi_world_add_solid(world, &s.solid, &s.fill, 1, &err));
    return world;
}

static void check_rest(tobi_world *world)
{
    enum { MOVED = 125, KEPT = 75 };
    const tobi_step_info *info = tobi_world_info(world);
    assert_int_equal(info->particles_lost, MOVED);
    assert_int_equal(info->fluid_particles, KEPT);
    assert_int_equal(tobi_world_count(world, TOBI_FLUID), KEPT);
    /* They took their energy along: 125 kg at 5 m/s had 1562.5 J. */
    assert_true(fabs(info->energy_lost) < 20 && info->kinetic_energy == 0);
    double *id = solid_read(world, "particle_id", 1), *material = solid_read(world, "material", 1);
    double *x = solid_read(world, "position", 3);
    for (int i = 0; i < KEPT; i++) {
        assert_true(id[i] == MOVED + i && material[i] == 1);
        assert_true(x[3*i + 2] > 1.5 && x[3*i + 2] < 1.8);
    }
    free(id);
    free(material);
    free(x);
}

static void an_open_side_lets_out(void **state)
{
    (void)state;
    tobi_world *one = make_world(1), *three = make_world(3), *later = make_world(2);
    int64_t half = 0;
    for (int k = 0; k < 400 && (half == 0 || half == 125); k++) {     /* until some have left, not all */
        solid_step(one, 1);
        half = tobi_world_info(one)->particles_lost;
    }
    assert_true(half > 0 && half < 125);
    solid_copy(one, later);
    assert_int_equal(tobi_world_count(later, TOBI_FLUID), 200 - half);
    OK(tobi_world_advance(one, 0.5, NULL, &err));
    OK(tobi_world_advance(later, 0.5, NULL, &err));
    OK(tobi_world_advance(three, 0.5, NULL, &err));
    assert_true(tobi_world_hash(one) == tobi_world_hash(later));
    assert_true(tobi_world_hash(one) == tobi_world_hash(three));
    check_rest(one);
    check_rest(later);
    tobi_world_destroy(one);
    tobi_world_destroy(three);
    tobi_world_destroy(later);
}

/* When all have left, time goes on. */
static void nothing_may_be_left(void **state)
{
    (void)state;
    solid_setup s = solid_default(2, 0.1, 0.5);
    s.world.gravity[1] = -9.81;
    s.world.wall_min[1] = TOBI_WALL_OPEN;
    s.fill.box_max[1] = 0.3;                      /* a slip side above would hold it */
    tobi_world *world = solid_world(&s);
    OK(tobi_world_advance(world, 1, NULL, &err));
    assert_int_equal(tobi_world_count(world, TOBI_FLUID), 0);
    assert_int_equal(tobi_world_info(world)->particles_lost, 15);
    tobi_world_destroy(world);
}

/* A block too soft to stop is thrown at a slip side; how many of its 80 particles are lost until they have
   been sorted twice. */
static int64_t throw_at_side(int leaving)
{
    solid_setup s = solid_default(2, 0.05, 1);
    s.method.leaving = leaving;
    s.solid.youngs_modulus = 1;
    s.world.gravity[2] = 0;
    s.fill.velocity[0] = -5;
    s.fill.box_min[0] = 0.1;
    s.fill.box_max[0] = 0.3;
    tobi_world *world = solid_world(&s);
    OK(tobi_world_advance(world, 5, NULL, &err));
    int64_t lost = tobi_world_info(world)->particles_lost;
    assert_int_equal(tobi_world_info(world)->put_back > 0, leaving == TOBI_KEEP);
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
    for (int a = 0; a < 3; a++) w.domain_max[a] = 1;
    w.spacing = 0.1;
    w.wall_max[1] = TOBI_WALL_OPEN;
    REFUSED(tobi_world_create(&w, NULL, &world, &err), TOBI_UNSUPPORTED,
            "domain.walls.y: is open, which only mlsmpm knows");
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

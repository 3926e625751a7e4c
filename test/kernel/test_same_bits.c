/* A world's state depends neither on threads, nor on the instruction set, nor on who looks at it. */
#include "tobiuo/tobiuo.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

enum { STEPS = 12 };
static const char *method;      /* the state of every test */

enum { ALONE, POST, SHOT, KINDS };      /* what is in the water's way: nothing, a fixed body, one it moves */

/* A dam of 16 x 12 x 14 particles breaking over a floor. */
static tobi_world *make(int threads, int body)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_fluid_def f = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def b = tobi_default_body_def();
    tobi_world *world;
    tobi_error err;
    w.method = method;
    w.spacing = 0.01;
    w.threads = threads;
    w.end_time = 1;
    const double top[3] = {0.3, 0.12, 0.2}, water[3] = {0.16, 0.12, 0.14};
    for (int a = 0; a < 3; a++) {
        w.domain_max[a] = top[a];
        fill.box_max[a] = water[a];
    }
    w.wall_min[2] = TOBI_WALL_NO_SLIP;
    f.name = "water";
    f.viscosity = 0.05;
    f.surface_tension = 0.05;
    if (tobi_world_create(&w, NULL, &world, &err)) fail_msg("%s", err.text);
    if (tobi_world_add_fluid(world, &f, &fill, 1, &err)) fail_msg("%s", err.text);
    b.name = "post";
    b.mesh = TOBI_SOURCE_DIR "/test/meshes/sphere.obj";
    b.friction = TOBI_NO_SLIP;
    for (int a = 0; a < 3; a++) b.scale[a] = 0.05;
    b.translation[0] = 0.13; b.translation[1] = 0.06; b.translation[2] = 0.06;
    if (body == SHOT) {
        b.dynamics = TOBI_FREE;
        b.density = 300;
        b.velocity[0] = 0.5;
        b.angular_velocity[1] = 3;
    }
    if (body != ALONE && tobi_world_add_body(world, &b, &err)) fail_msg("%s", err.text);
    return world;
}

static uint64_t run(int threads, int body, int look)
{
    tobi_world *w = make(threads, body);
    tobi_error err;
    tobi_step_info info;
    for (int k = 0; k < STEPS; k++) {
        if (tobi_world_step(w, 0, &info, &err)) fail_msg("%s", err.text);
        int64_t n = tobi_world_count(w, TOBI_FLUID);
        double *p = malloc((size_t)n*sizeof *p);
        if (look) assert_int_equal(tobi_world_read(w, TOBI_FLUID, "density", p, n, &err), TOBI_OK);
        free(p);
    }
    assert_true(info.speed_max > 0.005);
    uint64_t hash = tobi_world_hash(w);
    tobi_world_destroy(w);
    return hash;
}

static void threads_do_not_matter(void **state)
{
    method = *state;
    for (int body = 0; body < KINDS; body++) {
        uint64_t one = run(1, body, 0);
        assert_true(run(1, body, 0) == one);
        assert_true(run(2, body, 0) == one);
        assert_true(run(3, body, 0) == one);
        assert_true(run(4, body, 0) == one);
    }
    assert_true(run(1, ALONE, 0) != run(1, POST, 0) && run(1, POST, 0) != run(1, SHOT, 0));
}

static void instruction_sets_do_not_matter(void **state)
{
    static const char *const sets[] = {"2", "3", "4"};
    method = *state;
    unsetenv("TOBIUO_ISA");
    uint64_t best = run(2, SHOT, 0);
    for (int k = 0; k < 3; k++) {
        setenv("TOBIUO_ISA", sets[k], 1);
        assert_true(run(2, SHOT, 0) == best);
    }
    unsetenv("TOBIUO_ISA");
}

/* Reading results between steps changes nothing. */
static void looking_does_not_matter(void **state)
{
    method = *state;
    for (int body = 0; body < KINDS; body++) assert_true(run(2, body, 1) == run(2, body, 0));
}

/* Saved after any step and loaded into a fresh world: the same state in the end. */
static void restarts_do_not_matter(void **state)
{
    method = *state;
    for (int body = 0; body < KINDS; body++) {
        tobi_world *a = make(2, body), *b = make(3, body);
        tobi_error err;
        for (int k = 0; k < STEPS/2; k++) assert_int_equal(tobi_world_step(a, 0, NULL, &err), TOBI_OK);
        if (tobi_world_save(a, "same_bits.h5", &err)) fail_msg("%s", err.text);
        if (tobi_world_load(b, "same_bits.h5", &err)) fail_msg("%s", err.text);
        remove("same_bits.h5");
        assert_true(tobi_world_hash(a) == tobi_world_hash(b));
        for (int k = 0; k < STEPS/2; k++) assert_int_equal(tobi_world_step(b, 0, NULL, &err), TOBI_OK);
        assert_true(tobi_world_hash(b) == run(1, body, 0));
        tobi_world_destroy(a);
        tobi_world_destroy(b);
    }
}

int main(void)
{
#define EACH(name) cmocka_unit_test_prestate(name, "dfsph"), cmocka_unit_test_prestate(name, "wcsph")
    const struct CMUnitTest tests[] = {
        EACH(threads_do_not_matter),
        EACH(instruction_sets_do_not_matter),
        EACH(looking_does_not_matter),
        EACH(restarts_do_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

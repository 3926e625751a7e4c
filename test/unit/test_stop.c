/* A step that the caller stops within has not happened: wherever it is stopped, the run goes on to the same
   bits. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include "calls.h"
#include "world/world.h"

/* Answers 1 when it is asked for the n-th time. */
typedef struct counter { int asked, stop_at; } counter;

static int count_down(void *user)
{
    counter *c = user;
    return ++c->asked == c->stop_at;
}

/* Water with a free surface, or a box full of it, and a body that floats or shakes. */
typedef struct setup { const char *method; int full, dynamics; } setup;

static tobi_status shake(void *user, double t, int64_t n, const double (*rest)[3], double (*position)[3],
                         tobi_error *err)
{
    (void)user;
    (void)err;
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++) position[i][a] = rest[i][a] + (a == 0 ? t : 0);
    return TOBI_OK;
}

static tobi_world *make_world(const setup *s)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def body = tobi_default_body_def();
    tobi_world *world;
    w.method = s->method;
    w.dimension = 2;
    w.domain_max[0] = w.domain_max[1] = 1;
    w.gravity[2] = 0;
    w.gravity[1] = -9.81;
    w.spacing = 0.05;
    w.threads = 1;
    fill.box_max[0] = 1;
    fill.box_max[1] = s->full ? 1 : 0.6;
    body.density = 400;
    body.dynamics = s->dynamics;
    body.motion = s->dynamics == TOBI_PRESCRIBED ? shake : NULL;
    body.motion_rigid = 1;
    for (int a = 0; a < 2; a++) {
        body.box_min[a] = 0.31;
        body.box_max[a] = 0.57;
    }
    OK(tobi_world_create(&w, NULL, &world, &err));
    if (strcmp(s->method, "mlsmpm") == 0) OK(tobi_world_add_solid(world, &solid, &fill, 1, &err));
    else OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
    OK(tobi_world_add_body(world, &body, &err));
    OK(tobi_world_start(world, &err));
    return world;
}

enum { STEPS = 4 };

/* Stops step `step` at every question that it asks; *questions is how many it has. */
static void stop_everywhere(const setup *s, int step, const char *path)
{
    tobi_world *whole = make_world(s);
    for (int k = 0; k < STEPS; k++) OK(tobi_world_step(whole, 0, NULL, &err));
    int at = 1;
    for (int stopped = 1; stopped; at += at < 8 ? 1 : 7) {
        counter c = { 0, 0 };
        tobi_world *w = make_world(s), *restarted = make_world(s);
        tobi_world_set_stop(w, count_down, &c);
        for (int k = 0; k < step; k++) OK(tobi_world_step(w, 0, NULL, &err));
        const uint64_t before = tobi_world_hash(w);
        const tobi_step_info info = *tobi_world_info(w);
        c = (counter){ 0, at };
        tobi_error err = { 0 };
        const tobi_status status = tobi_world_step(w, 0, NULL, &err);
        stopped = status == TOBI_STOPPED;
        c.stop_at = 0;
        if (stopped) {
            assert_non_null(strstr(err.text, "stopped on request at t = "));
            assert_int_equal(tobi_world_hash(w), before);
            assert_memory_equal(tobi_world_info(w), &info, sizeof info);
        } else {
            assert_int_equal(status, TOBI_OK);
        }
        OK(tobi_world_save(w, path, &err));
        OK(tobi_world_load(restarted, path, &err));
        for (int k = step + !stopped; k < STEPS; k++) {
            OK(tobi_world_step(w, 0, NULL, &err));
            OK(tobi_world_step(restarted, 0, NULL, &err));
        }
        assert_int_equal(tobi_world_hash(w), tobi_world_hash(whole));
        assert_int_equal(tobi_world_hash(restarted), tobi_world_hash(whole));
        tobi_world_destroy(w);
        tobi_world_destroy(restarted);
    }
    assert_true(at > (strcmp(s->method, "dfsph") == 0 ? 10 : 2));
    tobi_world_destroy(whole);
}

static void stop(const setup *s)
{
    char path[] = "stop_XXXXXX";
    const int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    for (int step = 0; step < STEPS; step += 3) stop_everywhere(s, step, path);
    remove(path);
}

static void of_a_pool(void **state) { (void)state; stop(&(setup){ "dfsph", 0, TOBI_FREE }); }
static void of_a_stirred_pool(void **state) { (void)state; stop(&(setup){ "dfsph", 0, TOBI_PRESCRIBED }); }
static void of_a_full_vessel(void **state) { (void)state; stop(&(setup){ "dfsph", 1, TOBI_PRESCRIBED }); }
static void of_one_equation(void **state)
{
    (void)state;
    for (int full = 0; full < 2; full++) stop(&(setup){ "isph", full, TOBI_PRESCRIBED });
}
static void of_methods_without_solves(void **state)
{
    (void)state;
    stop(&(setup){ "wcsph", 0, TOBI_FREE });
    stop(&(setup){ "mlsmpm", 0, TOBI_FREE });
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(of_a_pool),
        cmocka_unit_test(of_a_stirred_pool),
        cmocka_unit_test(of_a_full_vessel),
        cmocka_unit_test(of_one_equation),
        cmocka_unit_test(of_methods_without_solves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

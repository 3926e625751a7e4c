/* Steps in which a motion, a control program or memory fails: no divergence, and the world goes on where
   nothing had moved. */
#define _GNU_SOURCE 1
#include "calls.h"
#include "failing_memory.h"
#include "tobiuo/tobiuo.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const char *const methods[] = { "dfsph", "wcsph", "mlsmpm" };
static const double WIDTH = 0.1;
static tobi_status motion_fails, control_fails;

static tobi_status swing(void *user, double t, int64_t n, const double (*rest)[3], double (*to)[3],
                         tobi_error *err)
{
    (void)user;
    if (motion_fails) return tobi_fail(err, motion_fails, "the motion has no answer");
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++) to[i][a] = rest[i][a] + (a == 0 ? 0.01*sin(20*t) : 0);
    return TOBI_OK;
}

static tobi_status push(void *user, const tobi_control_input *in, tobi_control_output *out, tobi_error *err)
{
    (void)user, (void)in;
    if (control_fails) return tobi_fail(err, control_fails, "the program has no answer");
    out->force[0] = 1;
    return TOBI_OK;
}

static void add_body(tobi_world *world, const char *name, double x, double y, int dynamics)
{
    tobi_body_def b = tobi_default_body_def();
    b.name = name;
    b.dynamics = dynamics;
    b.motion = dynamics == TOBI_PRESCRIBED ? swing : NULL;
    b.motion_rigid = 1;
    b.control = dynamics == TOBI_CONTROLLED ? push : NULL;
    for (int a = 0; a < 2; a++) b.box_max[a] = (b.box_min[a] = a ? y : x) + 0.012;
    OK(tobi_world_add_body(world, &b, &err));
}

static tobi_world *make_world(const char *method)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_world *world;
    w.method = method;
    w.dimension = 2;
    w.domain_max[0] = w.domain_max[1] = WIDTH;
    w.domain_max[2] = w.gravity[2] = 0;
    w.gravity[1] = -9.81;
    w.spacing = 0.005;
    w.threads = 1;
    fill.box_max[0] = WIDTH;
    fill.box_max[1] = 0.04;
    OK(tobi_world_create(&w, NULL, &world, &err));
    if (strcmp(method, "mlsmpm") == 0) OK(tobi_world_add_solid(world, &solid, &fill, 1, &err));
    else OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
    add_body(world, "pushed", 0.06, 0.06, TOBI_CONTROLLED);
    add_body(world, "swinging", 0.02, 0.045, TOBI_PRESCRIBED);
    return world;
}

static void assert_same_step(tobi_world *a, tobi_world *b)
{
    for (int k = 0; k < 3; k++) {
        OK(tobi_world_step(a, 0, NULL, &err));
        OK(tobi_world_step(b, 0, NULL, &err));
    }
    assert_true(tobi_world_hash(a) == tobi_world_hash(b));
}

/* In the first step and later. */
static void motions(void **state)
{
    (void)state;
    static const tobi_status fails[] = { TOBI_SCRIPT, TOBI_NO_MEMORY, TOBI_INVALID };
    for (int m = 0; m < 3; m++) {
        tobi_world *world = make_world(methods[m]), *other = make_world(methods[m]);
        for (int k = 0; k < 3; k++) {
            OK(tobi_world_start(world, &err));
            const uint64_t hash = tobi_world_hash(world);
            motion_fails = fails[k];
            REFUSED(tobi_world_step(world, 0, NULL, &err), (int)fails[k], "the motion has no answer");
            REFUSED(tobi_world_advance(world, 1, NULL, &err), (int)fails[k], "the motion has no answer");
            assert_int_equal(tobi_world_step(world, 0, NULL, NULL), fails[k]);
            motion_fails = TOBI_OK;
            assert_true(tobi_world_hash(world) == hash);
            assert_same_step(world, other);
        }
        tobi_world_destroy(world);
        tobi_world_destroy(other);
    }
}

/* It is asked after the particles have moved: the world steps no more, and says why. */
static void controls(void **state)
{
    (void)state;
    char path[] = "/tmp/tobiuo_failures_XXXXXX";
    close(mkstemp(path));
    for (int m = 0; m < 3; m++) {
        tobi_world *world = make_world(methods[m]), *other = make_world(methods[m]);
        double place[3*1000];
        OK(tobi_world_step(world, 0, NULL, &err));
        OK(tobi_world_step(other, 0, NULL, &err));
        OK(tobi_world_save(world, path, &err));
        control_fails = TOBI_SCRIPT;
        REFUSED(tobi_world_step(world, 0, NULL, &err), TOBI_SCRIPT, "the program has no answer");
        control_fails = TOBI_OK;
        const char *words = "the simulation cannot go on: the program has no answer";
        REFUSED(tobi_world_step(world, 0, NULL, &err), TOBI_SCRIPT, words);
        REFUSED(tobi_world_save(world, path, &err), TOBI_SCRIPT, words);
        REFUSED(tobi_world_set_gravity(world, (double[3]){ 0 }, &err), TOBI_SCRIPT, words);
        OK(tobi_world_read(world, TOBI_FLUID, "position", place, 1000, &err));
        OK(tobi_world_load(world, path, &err));
        assert_same_step(world, other);
        tobi_world_destroy(world);
        tobi_world_destroy(other);
    }
    unlink(path);
}

/* Every allocation of the first three steps: the step says so, and the next one is either taken or says so
   again. A world that can go on has lost nothing. */
static void memory(void **state)
{
    (void)state;
    for (int m = 0; m < 3; m++) {
        tobi_world *whole = make_world(methods[m]);
        for (int k = 0; k < 3; k++) OK(tobi_world_step(whole, 0, NULL, &err));
        const uint64_t hash = tobi_world_hash(whole);
        int left = 1, went_on = 0, stuck = 0;
        for (long n = 1; left; n++) {
            tobi_world *world = make_world(methods[m]);
            tobi_error why = { 0 };
            tobi_status status = TOBI_OK;
            OK(tobi_world_start(world, &err));
            allocations = 0;
            fail_at = n;
            int k = 0;
            while (k < 3 && (status = tobi_world_step(world, 0, NULL, &why)) == TOBI_OK) k++;
            left = status != TOBI_OK;
            fail_at = 0;
            if (left && status != TOBI_NO_MEMORY) fail_msg("%s, allocation %ld: %s", methods[m], n, why.text);
            if (left) status = tobi_world_step(world, 0, NULL, &why);
            if (left && status == TOBI_OK) k++;
            while (status == TOBI_OK && k++ < 3) OK(tobi_world_step(world, 0, NULL, &err));
            if (status == TOBI_OK) assert_true(tobi_world_hash(world) == hash);
            else assert_int_equal(status, TOBI_NO_MEMORY);
            went_on += status == TOBI_OK;
            stuck += status != TOBI_OK;
            tobi_world_destroy(world);
        }
        print_message("%s: %d go on, %d do not\n", methods[m], went_on, stuck);
        assert_true(went_on + stuck > 3);
        tobi_world_destroy(whole);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(motions),
        cmocka_unit_test(controls),
        cmocka_unit_test(memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

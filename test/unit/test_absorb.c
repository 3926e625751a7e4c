/* Pistons that absorb: the law's numbers, the same bits after a restart, a wave that comes back, what is
   told and refused. */
#include "calls.h"
#include "rigid/waves.h"
#include "scene/scene.h"
#include "world/absorb.h"
#include "world/world.h"
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

static void the_law_has_its_limits(void **state)
{
    (void)state;
    tobi_wave_maker_def d = { .direction = { 1, 0, 0 }, .depth = 0.5, .gravity = 9.81, .order = 1,
                              .absorb = 1 };
    tobi_waves *w;
    tobi_absorption how;
    OK(tobi_waves_create(&d, &w, &err));
    assert_true(tobi_waves_absorption(w, &how));
    assert_true(fabs(how.gain - sqrt(9.81/0.5)) < 1e-12);      /* in a long wave u = eta sqrt(g/h) */
    assert_true(tobi_waves_displacement(w, 1) == 0 && tobi_waves_level(w, 1, 0) == 0);
    tobi_waves_free(w);
    d.absorb_period = 60;
    OK(tobi_waves_create(&d, &w, &err));
    tobi_waves_absorption(w, &how);
    assert_true(fabs(how.gain/sqrt(9.81/0.5) - 1) < 1e-3);
    tobi_waves_free(w);
    d.absorb = 0;
    REFUSED(tobi_waves_create(&d, &w, &err), TOBI_INVALID, "absorb_period is for a piston that absorbs");
    d.absorb_period = 0;
    d.height = 0.01;
    d.period = 2;
    OK(tobi_waves_create(&d, &w, &err));
    assert_false(tobi_waves_absorption(w, &how));
    tobi_waves_free(w);
    d.flap = d.absorb = 1;
    REFUSED(tobi_waves_create(&d, &w, &err), TOBI_UNSUPPORTED, "a flap does not absorb; a piston does");
}

/* The scene owns the motion: it outlives the world. */
typedef struct tank { tobi_scene *scene; tobi_world *w; } tank;

static tank make(const char *method, const char *matter)
{
    char text[2000];
    tank t;
    snprintf(text, sizeof text, "{ \"dimension\": 2, \"method\": \"%s\", \"spacing\": 0.02,"
             "\"end_time\": 2, \"threads\": 1, \"gravity\": [0, -9.81],"
             "\"domain\": { \"min\": [-0.3, 0], \"max\": [0.8, 0.4] }, %s"
             "\"bodies\": [ { \"name\": \"piston\", \"box\": { \"min\": [-0.12, 0], \"max\": [0, 0.38] },"
             "  \"motion\": { \"piston\": { \"depth\": 0.2, \"absorb\": true,"
             "    \"regular\": { \"height\": 0.02, \"period\": 0.8 } } } } ] }", method, matter);
    OK(tobi_scene_parse("s.json", text, strlen(text), NULL, &t.scene, NULL, &err));
    OK(tobi_scene_build(t.scene, &t.w, &err));
    return t;
}

static void end(tank t)
{
    tobi_world_destroy(t.w);
    tobi_scene_free(t.scene);
}

#define WATER \
    "\"fluids\": [ { \"name\": \"w\"," \
    "  \"fill\": [ { \"box\": { \"min\": [0, 0], \"max\": [0.8, 0.2] } } ] } ],"
#define SAND \
    "\"solids\": [ { \"name\": \"s\"," \
    "  \"fill\": [ { \"box\": { \"min\": [0, 0], \"max\": [0.8, 0.2] } } ] } ],"

static uint64_t run(const char *method, int halfway)
{
    tank t = make(method, WATER);
    char file[] = "/tmp/tobiuo_absorb_XXXXXX";
    OK(tobi_world_advance(t.w, 0.5, NULL, &err));
    if (halfway) {
        close(mkstemp(file));
        OK(tobi_world_save(t.w, file, &err));
        end(t);
        t = make(method, WATER);
        OK(tobi_world_load(t.w, file, &err));
        unlink(file);
    }
    OK(tobi_world_advance(t.w, 1, NULL, &err));
    const double *state = tobi_absorb_state(t.w, 0);
    assert_true(state[0] != 0 && fabs(state[0]) < 0.05);
    const uint64_t hash = tobi_world_hash(t.w);
    end(t);
    return hash;
}

static void a_restart_has_the_same_bits(void **state)
{
    (void)state;
    static const char *const methods[] = { "dfsph", "isph", "eisph", "wcsph" };
    for (int k = 0; k < 4; k++)
        if (run(methods[k], 1) != run(methods[k], 0)) fail_msg("%s: other bits after a restart", methods[k]);
}

static void a_damaged_state_is_refused(void **state)
{
    (void)state;
    tank t = make("dfsph", WATER);
    char file[] = "/tmp/tobiuo_absorb_XXXXXX";
    OK(tobi_world_advance(t.w, 0.01, NULL, &err));
    tobi_absorb_state(t.w, 0)[1] = NAN;
    close(mkstemp(file));
    OK(tobi_world_save(t.w, file, &err));
    REFUSED(tobi_world_load(t.w, file, &err), TOBI_DAMAGED, "way of the piston 'piston' is no number");
    unlink(file);
    end(t);
}

static void methods_that_damp_waves_are_told(void **state)
{
    (void)state;
    static const char *const methods[] = { "dfsph", "wcsph", "isph", "eisph" };
    for (int k = 0; k < 4; k++) {
        tank t = make(methods[k], WATER);
        int told = 0;
        OK(tobi_world_start(t.w, &err));
        for (int n = 0; tobi_world_note(t.w, n); n++)
            told += !!strstr(tobi_world_note(t.w, n), "its waves come out too low");
        assert_int_equal(told, k < 2);
        end(t);
    }
}

/* Its stroke is for a depth of 0.2 m. */
static void another_depth_is_told(void **state)
{
    static const char deep[] = "\"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"box\": { \"min\": [0, 0],"
                               "\"max\": [0.8, 0.3] } } ] } ],";
    (void)state;
    for (int k = 0; k < 2; k++) {
        tank t = make("isph", k ? deep : WATER);
        int told = 0;
        OK(tobi_world_start(t.w, &err));
        for (int n = 0; tobi_world_note(t.w, n); n++)
            told += !!strstr(tobi_world_note(t.w, n), "a depth of 0.2 m, and the liquid starts 0.3 m high");
        assert_int_equal(told, k);
        end(t);
    }
}

static void solids_do_not_know_it(void **state)
{
    (void)state;
    tank t = make("mlsmpm", SAND);
    REFUSED(tobi_world_start(t.w, &err), TOBI_UNSUPPORTED,
            "absorbs waves, which the method mlsmpm does not know");
    end(t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_law_has_its_limits),
        cmocka_unit_test(a_restart_has_the_same_bits),
        cmocka_unit_test(a_damaged_state_is_refused),
        cmocka_unit_test(methods_that_damp_waves_are_told), cmocka_unit_test(another_depth_is_told),
        cmocka_unit_test(solids_do_not_know_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Every number of every definition at its worst: worlds are created, filled and stepped with it. They answer
   in words, or compute numbers. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "calls.h"
#include "scene/motions.h"
#include "scene/scene.h"
#include "mpm/mlsmpm.h"
#include "sph/dfsph.h"
#include "sph/wcsph.h"
#include "base/param.h"
#include "world/world.h"

enum { ROOM = 1000 };

/* All definitions of a small world: matter in a box with a body that moves. */
typedef struct setup {
    tobi_world_def world;
    tobi_dfsph_def dfsph;
    tobi_wcsph_def wcsph;
    tobi_mlsmpm_def mlsmpm;
    tobi_fluid_def fluid;
    tobi_solid_def solid;
    tobi_fill_def fill;
    tobi_body_def body;
    tobi_plane_def plane;
    tobi_probe_def probe;
} setup;

static const struct { const tobi_param_table *table; size_t at; } parts[] = {
    { &tobi_world_table, offsetof(setup, world) },   { &tobi_dfsph_table, offsetof(setup, dfsph) },
    { &tobi_wcsph_table, offsetof(setup, wcsph) },   { &tobi_mlsmpm_table, offsetof(setup, mlsmpm) },
    { &tobi_fluid_table, offsetof(setup, fluid) },   { &tobi_solid_table, offsetof(setup, solid) },
    { &tobi_fill_table, offsetof(setup, fill) },     { &tobi_body_table, offsetof(setup, body) },
    { &tobi_plane_table, offsetof(setup, plane) },   { &tobi_probe_table, offsetof(setup, probe) },
};
enum { PARTS = sizeof parts/sizeof *parts };

static void make_setup(setup *s, const char *method)
{
    for (int k = 0; k < PARTS; k++) tobi_param_defaults(parts[k].table, (char *)s + parts[k].at);
    s->world.method = method;
    s->world.end_time = 1;
    s->world.spacing = 0.1;
    s->world.threads = 1;
    s->body.dynamics = TOBI_FREE;
    s->probe.position[2] = 0.1;
    s->plane.normal[2] = 1;
    for (int a = 0; a < 3; a++) {
        s->world.domain_max[a] = 0.6;
        s->fill.box_max[a] = a == 2 ? 0.3 : 0.6;
        s->body.box_min[a] = 0.2;
        s->body.box_max[a] = 0.4;
        s->plane.point[a] = 0.01;
    }
}

static tobi_status fill_world(tobi_world *w, setup *s, tobi_error *err)
{
    const int solids = strcmp(s->world.method, "mlsmpm") == 0;
    if (solids) TOBI_TRY(tobi_world_add_solid(w, &s->solid, &s->fill, 1, err));
    else TOBI_TRY(tobi_world_add_fluid(w, &s->fluid, &s->fill, 1, err));
    TOBI_TRY(tobi_world_add_body(w, &s->body, err));
    if (solids) TOBI_TRY(tobi_world_add_plane(w, &s->plane, err));
    else TOBI_TRY(tobi_world_add_probe(w, &s->probe, err));
    int64_t fluid, bodies, bytes;
    TOBI_TRY(tobi_world_estimate(w, &fluid, &bodies, &bytes, err));
    if (fluid > ROOM || bodies > ROOM) return TOBI_NO_MEMORY;        /* for a test */
    return tobi_world_start(w, err);
}

/* 1 if all numbers that a step leaves are some. */
static int is_sound(tobi_world *w)
{
    static double buffer[3*(ROOM + 100)];
    const int64_t n = tobi_world_count(w, TOBI_FLUID);
    const tobi_step_info *info = tobi_world_info(w);
    int sound = isfinite(info->time) && info->time > 0 && info->dt > 0 && isfinite(info->kinetic_energy);
    for (int f = 0; f < 2; f++) {
        if (tobi_world_read(w, TOBI_FLUID, f ? "velocity" : "position", buffer, n, NULL) != TOBI_OK) return 0;
        for (int64_t i = 0; i < 3*n; i++) sound &= isfinite(buffer[i]);
    }
    return sound;
}

/* Refused, stopped in words, or sound after two steps. */
static tobi_status try_setup(setup *s, const char *what, double value)
{
    tobi_world *w = NULL;
    tobi_error err = { 0 };
    tobi_step_info info;
    const void *method = strcmp(s->world.method, "dfsph") == 0   ? (void *)&s->dfsph
                         : strcmp(s->world.method, "wcsph") == 0 ? (void *)&s->wcsph
                                                                 : (void *)&s->mlsmpm;
    tobi_status status = tobi_world_create(&s->world, method, &w, &err);
    if (status == TOBI_OK) status = fill_world(w, s, &err);
    for (int k = 0; k < 2 && status == TOBI_OK; k++) status = tobi_world_step(w, 0, &info, &err);
    if (status == TOBI_OK && !is_sound(w))
        fail_msg("%s, %s = %g: a step leaves what is no number", s->world.method, what, value);
    if (status != TOBI_OK && status != TOBI_NO_MEMORY && !err.text[0])
        fail_msg("%s, %s = %g: status %d without a word", s->world.method, what, value, (int)status);
    tobi_world_destroy(w);
    return status;
}

static void put_value(setup *s, int part, const tobi_param *row, int component, double value)
{
    char *at = (char *)s + parts[part].at + row->offset;
    if (row->type == TOBI_PARAM_REAL) {
        memcpy(at, &value, sizeof value);
    } else if (row->type == TOBI_PARAM_VEC3) {
        memcpy(at + (size_t)component*sizeof value, &value, sizeof value);
    } else {
        const int whole = value >= 2147483647 ? 2147483647 : value <= -2147483648. ? -2147483647 - 1 :
                          isnan(value) ? -1 : (int)value;
        memcpy(at, &whole, sizeof whole);
    }
}

static int is_method(const tobi_param_table *table)
{
    return table == &tobi_dfsph_table || table == &tobi_wcsph_table || table == &tobi_mlsmpm_table;
}

/* A world reads no definition of another method. */
static int is_read(const char *method, const tobi_param_table *table)
{
    return !is_method(table) || table == (strcmp(method, "dfsph") == 0   ? &tobi_dfsph_table
                                          : strcmp(method, "wcsph") == 0 ? &tobi_wcsph_table
                                                                         : &tobi_mlsmpm_table);
}

/* Under the sanitizers each value is tried with one method, in turns. */
static void sweep(const char *method, const double *values, int count)
{
    int turn = *method == 'd' ? 0 : *method == 'w' ? 1 : 2;
    for (int part = 0; part < PARTS; part++)
        for (const tobi_param *row = parts[part].table->rows; row->key; row++) {
            if (row->type == TOBI_PARAM_TEXT || strcmp(row->key, "threads") == 0) continue;
            for (int k = 0; k < count + 2; k++) {
                if (!is_read(method, parts[part].table)) break;
                if (SANITIZED && !is_method(parts[part].table) && turn++%3) continue;
                const double value = k < count ? values[k] : k == count ? row->min : row->max;
                setup s;
                make_setup(&s, method);
                put_value(&s, part, row, k%3, value);
                try_setup(&s, row->key, value);
            }
        }
}

/* Many numbers at once at an end of their range. */
static void corners(const char *method)
{
    uint64_t seed = 1;
    int run = 0;
    for (int round = 0; round < 200; round++) {
        setup s;
        make_setup(&s, method);
        for (int part = 0; part < PARTS; part++)
            for (const tobi_param *row = parts[part].table->rows; row->key; row++) {
                seed = seed*6364136223846793005u + 1442695040888963407u;
                const int draw = (int)(seed >> 33)%60;
                if (row->type == TOBI_PARAM_TEXT || strcmp(row->key, "threads") == 0 || draw > 1) continue;
                if (strstr(row->key, "iterations_max")) continue;      /* a million would be made */
                for (int a = 0; a < (row->type == TOBI_PARAM_VEC3 ? 3 : 1); a++)
                    put_value(&s, part, row, a, draw ? row->max : row->min);
            }
        run += try_setup(&s, "round", round) == TOBI_OK;
    }
    assert_true(run > 10);
}

static const double worst[] = { 0, -1, 5e-324, 1e-300, 1e30, -1e308, 1e308, NAN, INFINITY };
enum { WORST = sizeof worst/sizeof *worst };

static void try_method(const char *method)
{
    setup s;
    make_setup(&s, method);
    assert_int_equal(try_setup(&s, "nothing", 0), TOBI_OK);
    sweep(method, worst, WORST);
    corners(method);
}

static void dfsph(void **state) { (void)state; try_method("dfsph"); }
static void wcsph(void **state) { (void)state; try_method("wcsph"); }
static void mlsmpm(void **state) { (void)state; try_method("mlsmpm"); }

static void numbers_that_do_not_fit_each_other(void **state)
{
    (void)state;
    setup s;
    tobi_world *w;
    make_setup(&s, "dfsph");
    s.world.spacing = 1e-6;
    REFUSED(tobi_world_create(&s.world, NULL, &w, &err), TOBI_INVALID,
            "spacing: is 1e-06 m and goes 6e+05 times into the domain along x; dfsph allows up");
    s.world.method = "mlsmpm";
    s.world.spacing = 1e-7;
    s.world.domain_min[1] = -2e5;
    REFUSED(tobi_world_create(&s.world, NULL, &w, &err), TOBI_INVALID,
            "spacing: is 1e-07 m, and the domain lies up to 2e+12 times that from the origin along y");
    make_setup(&s, "dfsph");
    s.world.end_time = 1e-300;
    REFUSED(tobi_world_create(&s.world, NULL, &w, &err), TOBI_INVALID,
            "end_time: is 1e-300 s; allowed are 0, the start alone, and 1e-12 s and more");
    s.world.end_time = 0;
    OK(tobi_world_create(&s.world, NULL, &w, &err));
    tobi_world_destroy(w);
    make_setup(&s, "dfsph");
    s.world.time_step = 1e-10;
    REFUSED(tobi_world_create(&s.world, NULL, &w, &err), TOBI_INVALID,
            "time_step: is 1e-10 s and makes 1e+10 steps until end_time, 1 s; allowed are up to 1e+09");
    s.world.time_step = 0;
    s.world.time_step_max = 1e-11;
    REFUSED(tobi_world_create(&s.world, NULL, &w, &err), TOBI_INVALID, "time_step_max: is 1e-11 s and");
    make_setup(&s, "mlsmpm");
    s.world.domain_max[2] = 1e7;
    s.world.gravity[2] = -1e6;
    REFUSED(tobi_world_create(&s.world, NULL, &w, &err), TOBI_INVALID,
            "gravity: makes what falls through the domain 4.47e+06 m/s fast; allowed are up");
}

/* A world of the setup with its matter, not started. */
static tobi_world *make_world(setup *s)
{
    tobi_world *w;
    OK(tobi_world_create(&s->world, NULL, &w, &err));
    OK(tobi_world_add_fluid(w, &s->fluid, &s->fill, 1, &err));
    return w;
}

static void steps_that_lead_nowhere(void **state)
{
    (void)state;
    setup s;
    make_setup(&s, "dfsph");
    s.fluid.viscosity = 1e9;
    tobi_world *w = make_world(&s);
    tobi_error err = { 0 };
    tobi_status status = TOBI_OK;
    for (int k = 0; k < 98; k++) OK(tobi_world_step(w, 0, NULL, &err));
    OK(tobi_world_step(w, 1e-12, NULL, &err));            /* as short as asked for: counting begins anew */
    int steps = 0;
    for (; status == TOBI_OK && steps < 200; steps++) status = tobi_world_step(w, 0, NULL, &err);
    assert_int_equal(status, TOBI_STALLED);
    assert_non_null(strstr(err.text, "the simulation gets nowhere: at t = "));
    assert_int_equal(steps, 100);
    OK(tobi_world_step(w, 0, NULL, &err));                /* who wants to go on may */
    REFUSED(tobi_world_advance(w, 1, NULL, &err), TOBI_STALLED, "and the end lies ");
    w->sim.time = 1e9;
    REFUSED(tobi_world_step(w, 0, NULL, &err), TOBI_STALLED, "the simulation stands still at t = 1e+09 s");
    tobi_world_destroy(w);
}

/* Puts all points where user, three doubles, says, times t. */
static tobi_status put(void *user, double t, int64_t n, const double (*rest)[3], double (*position)[3],
                       tobi_error *err)
{
    const double *v = user;
    (void)err;
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++) position[i][a] = rest[i][a] + v[a]*t;
    return TOBI_OK;
}

/* Velocities of three doubles. */
static tobi_status flow(void *user, int64_t n, const double (*place)[3], double (*velocity)[3],
                        tobi_error *err)
{
    (void)place;
    (void)err;
    for (int64_t i = 0; i < n; i++) memcpy(velocity[i], user, sizeof velocity[i]);
    return TOBI_OK;
}

static void answers_of_callbacks(void **state)
{
    (void)state;
    double wild[3] = { 0, NAN, 0 }, fast[3] = { 2e6, 0, 0 }, still[3] = { 0 };
    setup s;
    make_setup(&s, "dfsph");
    s.body.dynamics = TOBI_PRESCRIBED;
    s.body.motion = put;
    s.body.motion_rigid = 1;
    s.body.motion_user = wild;
    tobi_world *w = make_world(&s);
    REFUSED(tobi_world_add_body(w, &s.body, &err), TOBI_INVALID,
            "body 'body': its motion puts a point at (0.2, nan, 0.2) m at t = 0 s; allowed are");
    s.body.motion_user = fast;
    OK(tobi_world_add_body(w, &s.body, &err));
    REFUSED(tobi_world_start(w, &err), TOBI_INVALID,
            "body 'body' moves at 2e+06 m/s at t = 0 s; allowed are up to 1e+06 m/s");
    tobi_world_destroy(w);

    w = make_world(&s);
    s.body.motion_user = still;
    OK(tobi_world_add_body(w, &s.body, &err));
    OK(tobi_world_step(w, 0, NULL, &err));
    still[2] = INFINITY;
    REFUSED(tobi_world_step(w, 0, NULL, &err), TOBI_INVALID, "its motion puts a point at (");
    tobi_world_destroy(w);

    s.fill.flow = flow;
    s.fill.flow_user = wild;
    w = make_world(&s);
    REFUSED(tobi_world_start(w, &err), TOBI_INVALID,
            "the flow of fill[0] answers (0, nan, 0) m/s at (0.05, 0.05, 0.05) m; allowed");
    tobi_world_destroy(w);
    s.fill.flow = NULL;
    for (int a = 0; a < 3; a++) s.fill.velocity[a] = 1e6;
    w = make_world(&s);
    REFUSED(tobi_world_start(w, &err), TOBI_INVALID,
            "a region starts with 1.73205e+06 m/s, by velocity, spin and flow together; allowed are up to");
    tobi_world_destroy(w);
}

static const char liquid[] =
    "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [0.6, 0.6, 0.6] }, \"spacing\": 0.1, \"end_time\": 1,"
    " \"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"box\": { \"min\": [0, 0, 0],"
    " \"max\": [0.6, 0.6, 0.3] } } ] } ], \"probes\": [ { \"name\": \"p\", \"position\": [0, 0, 0] } ],"
    " \"bodies\": [ { \"name\": \"box\", \"dynamics\": \"free\", \"box\": { \"min\": [0.2, 0.2, 0.2],"
    " \"max\": [0.4, 0.4, 0.4] } } ] }";
static const char solid[] =
    "{ \"method\": \"mlsmpm\", \"domain\": { \"min\": [0, 0, 0], \"max\": [0.6, 0.6, 0.6] },"
    " \"spacing\": 0.1, \"end_time\": 1,"
    " \"planes\": [ { \"point\": [0, 0, 0.01], \"normal\": [0, 0, 1] } ],"
    " \"solids\": [ { \"name\": \"jelly\", \"fill\": [ { \"sphere\": { \"centre\": [0.3, 0.3, 0.3],"
    " \"radius\": 0.2 } } ] } ] }";

/* Reads the scene with one value changed, and steps what comes of it. */
static void try_scene(const char *text, const char *override)
{
    const char *const overrides[] = { override, NULL };
    tobi_scene *scene = NULL;
    tobi_world *w = NULL;
    tobi_error err = { 0 };
    int64_t fluid = 0, bodies, bytes;
    tobi_status status = tobi_scene_parse("scene.json", text, strlen(text), overrides, &scene, NULL, &err);
    if (status == TOBI_OK) status = tobi_scene_build(scene, &w, &err);
    if (status == TOBI_OK) status = tobi_world_estimate(w, &fluid, &bodies, &bytes, &err);
    if (status == TOBI_OK && fluid + bodies < ROOM) status = tobi_world_step(w, 0, NULL, &err);
    if (status != TOBI_OK && !err.text[0]) fail_msg("%s: status %d without a word", override, (int)status);
    tobi_world_destroy(w);
    tobi_scene_free(scene);
}

static void sweep_scene(const char *text, const tobi_param_table *table, const char *prefix)
{
    static const char *const values[] = { "0", "-1", "5e-324", "1e-300", "1e30", "-1e308", "1e308" };
    for (const tobi_param *row = table->rows; row->key; row++)
        for (size_t k = 0; k < sizeof values/sizeof *values; k++) {
            char override[200];
            const char *v = values[k];
            if (row->type == TOBI_PARAM_TEXT || strcmp(row->key, "threads") == 0) continue;
            if (row->type == TOBI_PARAM_VEC3)
                snprintf(override, sizeof override, "%s%s=[%s, %s, %s]", prefix, row->key, v, v, v);
            else snprintf(override, sizeof override, "%s%s=%s", prefix, row->key, v);
            try_scene(text, override);
        }
}

static void scenes(void **state)
{
    (void)state;
    sweep_scene(liquid, &tobi_world_table, "");
    sweep_scene(liquid, &tobi_dfsph_table, "dfsph.");
    sweep_scene(liquid, &tobi_fluid_table, "fluids[0].");
    sweep_scene(liquid, &tobi_fill_table, "fluids[0].fill[0].");
    sweep_scene(liquid, &tobi_body_table, "bodies[0].");
    sweep_scene(liquid, &tobi_probe_table, "probes[0].");
    sweep_scene(liquid, &tobi_output_table, "output.");
    sweep_scene(solid, &tobi_world_table, "");
    sweep_scene(solid, &tobi_mlsmpm_table, "mlsmpm.");
    sweep_scene(solid, &tobi_solid_table, "solids[0].");
    sweep_scene(solid, &tobi_plane_table, "planes[0].");
    for (int k = 0; tobi_motion_table(k); k++) {
        char prefix[80];
        snprintf(prefix, sizeof prefix, "bodies[0].motion.%s.", tobi_motion_table(k)->name);
        sweep_scene(liquid, tobi_motion_table(k), prefix);
    }
}

/* Returns how many mistakes there are with one value that is wrong. */
static int count_mistakes(const char *text, const char *override, char line[400])
{
    const char *const overrides[] = { override, NULL };
    tobi_scene *scene = NULL;
    tobi_report *report = NULL;
    tobi_scene_parse("scene.json", text, strlen(text), overrides, &scene, &report, NULL);
    const int count = tobi_report_count(report);
    snprintf(line, 400, "%s", count ? tobi_report_line(report, count - 1) : "");
    tobi_report_free(report);
    tobi_scene_free(scene);
    return count;
}

static void mistake_in_each(const char *text, const tobi_param_table *table, const char *prefix)
{
    static const char *const wrong[] = { "true", "[[]]", "{}", "1e300", "null" };
    for (const tobi_param *row = table->rows; row->key; row++)
        for (size_t k = 0; k < sizeof wrong/sizeof *wrong; k++) {
            char override[200], line[400];
            if (row->type == TOBI_PARAM_BOOL && k == 0) continue;
            if (strcmp(row->key, "method") == 0) continue;      /* every key may be wrong without it */
            snprintf(override, sizeof override, "%s%.*s=%s", prefix, (int)strcspn(row->key, "["), row->key,
                     wrong[k]);
            const int count = count_mistakes(text, override, line);
            if (count != 1) fail_msg("%s makes %d mistakes, the last: %s", override, count, line);
        }
}

static void one_wrong_value_is_one_mistake(void **state)
{
    static const char flat[] =
        "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [0.6, 0.6] }, \"spacing\": 0.1,"
        " \"end_time\": 1, \"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"box\": { \"min\": [0, 0],"
        " \"max\": [0.6, 0.3] } } ] } ] }";
    (void)state;
    mistake_in_each(flat, &tobi_world_table, "");
    mistake_in_each(flat, &tobi_dfsph_table, "dfsph.");
    mistake_in_each(flat, &tobi_fluid_table, "fluids[0].");
    mistake_in_each(flat, &tobi_output_table, "output.");
    mistake_in_each(liquid, &tobi_world_table, "");
    mistake_in_each(liquid, &tobi_probe_table, "probes[0].");
    mistake_in_each(solid, &tobi_world_table, "");
    mistake_in_each(solid, &tobi_mlsmpm_table, "mlsmpm.");
    mistake_in_each(solid, &tobi_plane_table, "planes[0].");
}

static void check_ranges(const tobi_param_table *table)
{
    for (const tobi_param *row = table->rows; row->key; row++)
        if (row->type != TOBI_PARAM_TEXT && !(isfinite(row->min) && isfinite(row->max)))
            fail_msg("%s.%s has no limit", table->name, row->key);
}

static void every_number_has_a_range(void **state)
{
    (void)state;
    for (int t = 0; tobi_param_table_at(t); t++) check_ranges(tobi_param_table_at(t));
    for (int t = 0; tobi_motion_table(t); t++) check_ranges(tobi_motion_table(t));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_number_has_a_range),
        cmocka_unit_test(numbers_that_do_not_fit_each_other),
        cmocka_unit_test(steps_that_lead_nowhere),
        cmocka_unit_test(answers_of_callbacks),
        cmocka_unit_test(scenes),
        cmocka_unit_test(one_wrong_value_is_one_mistake),
        cmocka_unit_test(dfsph),
        cmocka_unit_test(wcsph),
        cmocka_unit_test(mlsmpm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

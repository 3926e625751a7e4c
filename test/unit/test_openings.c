/* Inlets and outlets: mass to the last particle, restarts, threads, and what is refused in words. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "scene_text.h"
#include "tobiuo/drawing.h"
#include "world/world.h"

#define IN "{ \"name\": \"in\", \"centre\": [0.2, 0.1], \"normal\": [1, 0], \"width\": 0.2, "
#define PATCH "{ \"name\": \"in\", "
#define OUT "{ \"name\": \"out\", \"centre\": [0.8, 0.1], \"normal\": [1, 0], \"width\": 0.2 }"

static tobi_status make(const char *method, int threads, const char *in, const char *out, const char *more,
                        tobi_world **w, tobi_error *err)
{
    char text[3000];
    snprintf(text, sizeof text, "{ \"dimension\": 2, \"method\": \"%s\", \"domain\": { \"min\": [0, 0],\n"
             "\"max\": [1, 0.2] }, \"spacing\": 0.02, \"end_time\": 1, \"threads\": %d, %s \"fluids\": [ {\n"
             "\"name\": \"water\", \"fill\": [ { \"box\": { \"min\": [0, 0], \"max\": [1, 0.1] } } ] } ],\n"
             "\"inlets\": [ %s ], \"outlets\": [ %s ] }", method, threads, more, in, out);
    return start_scene(text, w, err);
}

static void must(tobi_status status, const tobi_error *err)
{
    if (status != TOBI_OK) fail_msg("%s", err->text);
}

/* Runs to 0.25 s, halfway by a checkpoint. */
static void run_halfway(const char *method, int threads, int halfway, const char *in, const char *out,
                        tobi_world **w, tobi_step_info *first, tobi_step_info *last)
{
    tobi_error err = { 0 };
    char file[] = "/tmp/tobiuo_openings_XXXXXX";
    must(make(method, threads, in, out, "", w, &err), &err);
    *first = *tobi_world_info(*w);
    must(tobi_world_advance(*w, 0.1, NULL, &err), &err);
    if (halfway) {
        close(mkstemp(file));
        must(tobi_world_save(*w, file, &err), &err);
        tobi_world_destroy(*w);
        must(make(method, threads, in, out, "", w, &err), &err);
        must(tobi_world_load(*w, file, &err), &err);
        unlink(file);
    }
    must(tobi_world_advance(*w, 0.25, last, &err), &err);
}

/* Returns the hash. */
static uint64_t run(const char *method, int threads, int halfway)
{
    tobi_world *w;
    tobi_step_info first, last;
    run_halfway(method, threads, halfway, IN "\"speed\": 0.5 }", OUT, &w, &first, &last);
    assert_true(last.particles_in > 50);
    assert_true(last.particles_out > 20);
    assert_int_equal(last.fluid_particles, first.fluid_particles + last.particles_in - last.particles_out);
    const double off = last.mass_held - first.mass_held - last.mass_in + last.mass_out;
    if (!(fabs(off) < 1e-11*last.mass_held)) fail_msg("the masses are off by %g kg", off);
    /* 10 columns of golden phases: not a particle of each off the flow */
    assert_float_equal(last.mass_in, 0.25*0.5*0.2*1000, 10*0.4);
    const uint64_t hash = tobi_world_hash(w);
    tobi_world_destroy(w);
    return hash;
}

/* Writes a table to a new file, whose name is in `path` then. */
static void write_flow(char path[64], const char *text)
{
    snprintf(path, 64, "%s", "/tmp/tobiuo_openings_XXXXXX");
    FILE *f = fdopen(mkstemp(path), "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

/* A flow that rises, stops and comes again: what is in is the integral of the rows, for every method, any
   number of threads and after a restart. */
static uint64_t run_table(const char *method, int threads, int halfway)
{
    tobi_world *w;
    tobi_error err = { 0 };
    tobi_step_info first, last;
    char file[] = "/tmp/tobiuo_openings_XXXXXX", in[300], table[64];
    write_flow(table, "time [ms], flow_rate [l/s]\n50, 0\n100, 200\n150, 0\n200, 0\n250, 100\n");
    snprintf(in, sizeof in, IN "\"file\": \"%s\" }", table);
    must(make(method, threads, in, OUT, "", &w, &err), &err);
    first = *tobi_world_info(w);
    must(tobi_world_advance(w, 0.12, NULL, &err), &err);
    if (halfway) {
        close(mkstemp(file));
        must(tobi_world_save(w, file, &err), &err);
        tobi_world_destroy(w);
        must(make(method, threads, in, OUT, "", &w, &err), &err);
        must(tobi_world_load(w, file, &err), &err);
        unlink(file);
    }
    must(tobi_world_advance(w, 0.3, &last, &err), &err);
    const double off = last.mass_held - first.mass_held - last.mass_in + last.mass_out;
    if (!(fabs(off) < 1e-11*last.mass_held)) fail_msg("the masses are off by %g kg", off);
    /* 0.1 s under the triangle, 0.05 s of a rise, 0.05 s of what stays; a particle of each of 10 columns */
    assert_float_equal(last.mass_in, 1000*(0.5*0.1*0.2 + 0.5*0.05*0.1 + 0.05*0.1), 10*0.4);
    const uint64_t hash = tobi_world_hash(w);
    tobi_world_destroy(w);
    unlink(table);
    return hash;
}

static void test_flow_in_time(void **state)
{
    (void)state;
    static const char *const method[] = { "dfsph", "isph", "eisph", "wcsph" };
    for (int k = 0; k < 4; k++) {
        const uint64_t hash = run_table(method[k], 1, 0);
        if (run_table(method[k], 2, 1) != hash) fail_msg("%s: other bits after a restart", method[k]);
    }
}

static void test_same_bits(void **state)
{
    (void)state;
    static const char *const method[] = { "dfsph", "isph", "eisph", "wcsph" };
    for (int k = 0; k < 4; k++) {
        const uint64_t hash = run(method[k], 1, 0);
        if (run(method[k], 3, 0) != hash) fail_msg("%s: other bits with 3 threads", method[k]);
        if (run(method[k], 1, 1) != hash) fail_msg("%s: other bits after a restart", method[k]);
    }
}

static int64_t count_before(const tobi_world *w, double x)
{
    int64_t count = 0;
    for (int64_t i = 0; i < w->system[0].particles.count; i++)
        count += w->system[0].particles.position[i].x < x;
    return count;
}

#define POOL "{ \"name\": \"out\", \"centre\": [0.8, 0.1], \"normal\": [1, 0], \"width\": 0.2, \"level\": "

/* An outlet whose level is 40 mm higher than the pool lets water in; returns the hash. */
static uint64_t run_back(const char *method, int threads, int halfway)
{
    tobi_world *w;
    tobi_step_info first, last;
    run_halfway(method, threads, halfway, "", POOL "0.14 }", &w, &first, &last);
    /* at most by all of the difference, as fast as a wave of 0.14 m */
    const double in = ((double)count_before(w, 0.8) - 40*5)*0.4;
    if (!(in > 0.5 && in < 0.04*1.18*0.25*1000)) fail_msg("%s: %g kg came in", method, in);
    const double off = last.mass_held - first.mass_held - last.mass_in + last.mass_out;
    if (!(fabs(off) < 1e-11*last.mass_held)) fail_msg("the masses are off by %g kg", off);
    const uint64_t hash = tobi_world_hash(w);
    tobi_world_destroy(w);
    return hash;
}

static void test_water_comes_back(void **state)
{
    (void)state;
    static const char *const method[] = { "dfsph", "isph", "eisph", "wcsph" };
    for (int k = 0; k < 4; k++) {
        const uint64_t hash = run_back(method[k], 1, 0);
        if (run_back(method[k], 3, 1) != hash) fail_msg("%s: other bits after a restart", method[k]);
    }
}

/* A pool at the level of its outlet keeps all particles. */
static void test_rest(void **state)
{
    (void)state;
    tobi_world *w;
    tobi_error err = { 0 };
    tobi_step_info last;
    must(make("isph", 1, "", POOL "0.1 }", "", &w, &err), &err);
    must(tobi_world_advance(w, 0.5, &last, &err), &err);
    assert_int_equal(count_before(w, 0.8), 40*5);
    if (!(last.speed_max < 0.004)) fail_msg("the pool moves at %g m/s", last.speed_max);
    tobi_world_destroy(w);
}

static void test_damaged(void **state)
{
    (void)state;
    tobi_world *w;
    tobi_error err = { 0 };
    char file[] = "/tmp/tobiuo_openings_XXXXXX";
    must(make("dfsph", 1, IN "\"speed\": 0.5 }", OUT, "", &w, &err), &err);
    w->sim.openings[0].way = -1;
    close(mkstemp(file));
    must(tobi_world_save(w, file, &err), &err);
    assert_int_equal(tobi_world_load(w, file, &err), TOBI_DAMAGED);
    assert_non_null(strstr(err.text, "the flow of an inlet is no length"));
    unlink(file);
    tobi_world_destroy(w);
}

/* A disc in 3-D, a ramp, and an end of the flow. */
static void test_disc(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    tobi_world_def def = tobi_default_world_def();
    tobi_world *w;
    tobi_step_info info;
    def.domain_max[0] = def.domain_max[1] = def.domain_max[2] = 1;
    def.spacing = 0.05;
    def.end_time = 1;
    must(tobi_world_create(&def, NULL, &w, &err), &err);
    tobi_fluid_def water = tobi_default_fluid_def();
    must(tobi_world_add_fluid(w, &water, NULL, 0, &err), &err);
    tobi_inlet_def in = tobi_default_inlet_def();
    in.name = "hose";
    in.centre[0] = in.centre[1] = 0.5;
    in.centre[2] = 0.7;
    in.normal[2] = -1;
    in.radius = 0.15;
    in.flow_rate = 0.05;
    in.ramp = 0.1;
    in.stop = 0.2;
    in.profile = TOBI_PROFILE_PARABOLIC;
    must(tobi_world_add_inlet(w, &in, &err), &err);
    must(tobi_world_advance(w, 0.3, &info, &err), &err);
    /* 0.05 m3/s for 0.15 s, of 32 columns */
    assert_float_equal(info.mass_in, 1000*0.05*0.15, 2);
    tobi_world_destroy(w);
}

static void refuse(const char *in, const char *out, const char *more, const char *words)
{
    tobi_world *w;
    tobi_error err = { 0 };
    if (make("dfsph", 1, in, out, more, &w, &err) == TOBI_OK) fail_msg("not refused: %s", words);
    if (!strstr(err.text, words)) fail_msg("%s\nexpected: %s", err.text, words);
    tobi_world_destroy(w);
}

static void test_mistakes(void **state)
{
    (void)state;
    const char *block = "\"bodies\": [ { \"name\": \"block\", \"box\": { \"min\": [0.1, 0.05, 0], "
                        "\"max\": [0.25, 0.1, 1] } } ],";
    refuse(IN "\"speed\": 1, \"flow_rate\": 1 }", "", "",
           "inlet 'in' needs a speed, a flow_rate or a file, one of them");
    refuse(IN "\"flow_rate\": 1e6 }", "", "", "inlet 'in' needs 5e+06 m/s at its fastest place");
    refuse(IN "\"speed\": 1, \"start\": 0.5, \"stop\": 0.2 }", "", "", "inlet 'in' stops before it starts");
    refuse(IN "\"speed\": 1, \"fluid\": \"oil\" }", "", "", "inlet 'in' lets 'oil' in, which is no fluid");
    refuse(IN "\"speed\": 1 }", "", block,
           "s.json:4:29: inlets[0].centre: inlet 'in' lies inside body 'block' with its buffer, at (");
    refuse(PATCH "\"centre\": [0.01, 0.1], \"normal\": [1, 0], \"width\": 0.1, \"speed\": 1 }", "", "",
           "inlet 'in' reaches out of the domain at x = ");
    refuse(PATCH "\"centre\": [0.2, 0.1], \"normal\": [0, 0], \"width\": 0.1, \"speed\": 1 }", "", "",
           "inlet 'in' has a normal of zero");
    refuse(PATCH "\"centre\": [0.2, 0.1], \"normal\": [1, 0], \"speed\": 1 }", "", "",
           "inlet 'in' has no width");
    refuse("", POOL "0.1 }", "\"gravity\": [0, 0],", "outlet 'out' has a level, and without gravity");
    /* an outlet that takes what an inlet gives; two inlets at one place */
    refuse(IN "\"speed\": 1 }", "{ \"name\": \"out\", \"centre\": [0.2, 0.1], \"normal\": [-1, 0], "
           "\"width\": 0.2 }", "", "inlet 'in' has its buffer where outlet 'out' has its own");
    refuse(IN "\"speed\": 1 }, { \"name\": \"next\", \"centre\": [0.24, 0.1], \"normal\": [1, 0], "
           "\"width\": 0.2, \"speed\": 1 }", "", "", "has its buffer where inlet 'next' has its own");
    refuse("", POOL "0.1, \"pressure\": 5 }", "",
           "outlets[0].pressure: outlet 'out' has a level and a pressure; it may have one");
    refuse("", "{ \"name\": \"out\", \"centre\": [0.4, 0.1], \"normal\": [1, 0], \"width\": 0.2 }",
           "\"bodies\": [ { \"name\": \"block\", \"box\": { \"min\": [0.2, 0, 0], "
           "\"max\": [0.4, 0.2, 1] } } ],",
           "outlet 'out' faces inwards: liquid lies on the side that its normal points to");
    refuse(PATCH "\"centre\": [0.6, 0.1], \"normal\": [1, 0], \"width\": 0.2, \"speed\": 1 }", "",
           "\"bodies\": [ { \"name\": \"block\", \"box\": { \"min\": [0.6, 0, 0], "
           "\"max\": [1, 0.2, 1] } } ],",
           "inlet 'in' faces away from the liquid, which lies behind it");
}

/* What --set gave is told as that, after the caller's texts are gone. */
static void test_set(void **state)
{
    (void)state;
    const char *text = "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": 0.05, "
                       "\"end_time\": 1, \"fluids\": [ { \"name\": \"water\" } ], \"inlets\": [ ] }";
    char set[] =
        "inlets=[{\"centre\":[0,0,0],\"normal\":[1,0,0],\"radius\":0.1,\"speed\":1,\"name\":\"in\"}]";
    const char *const overrides[] = { set, NULL };
    tobi_scene *scene;
    tobi_world *w;
    tobi_error err = { 0 };
    must(tobi_scene_parse("s.json", text, strlen(text), overrides, &scene, NULL, &err), &err);
    memset(set, '?', sizeof set - 1);
    assert_int_equal(tobi_scene_build(scene, &w, &err), TOBI_INVALID);
    assert_ptr_equal(strstr(err.text, "--set inlets=[{"), err.text);
    assert_non_null(strstr(err.text, ": inlets[0].centre: inlet 'in' reaches out of the domain at "));
    tobi_scene_free(scene);
}

static void test_wrong_tables(void **state)
{
    (void)state;
    static const struct { const char *table, *more, *words; } wrong[] = {
        { "time, speed\n0, 1\n", ", \"ramp\": 1", "has a file, which has times of its own" },
        { "time, speed\n0, 0\n1, 0\n", "", "has a file in which nothing flows" },
        { "time, speed\n0, 1\n1, -1\n", "", "the flow is below 0: an inlet lets nothing out" },
        { "time, speed\n1, 1\n0, 1\n", "", "time 0 s does not come after 1 s of the row before" },
        { "time, speed\n1, 1\n0, 1\n", "", "s.json:4:83: inlets[0].file: flow " },
        { "time, x\n0, 1\n", "", "a flow has the columns time (s) and one of speed (m/s) and flow_rate" },
        { "time, speed, flow_rate\n0, 1, 1\n", "", "and one of speed (m/s) and flow_rate (m3/s)" },
        { "time, flow_rate [gpm]\n0, 1\n", "", "flow_rate is in [gpm]; allowed is [m3/s], [m2/s], [l/s]" },
    };
    for (size_t k = 0; k < sizeof wrong/sizeof *wrong; k++) {
        char in[300], table[64];
        write_flow(table, wrong[k].table);
        snprintf(in, sizeof in, IN "\"file\": \"%s\"%s }", table, wrong[k].more);
        refuse(in, "", "", wrong[k].words);
        unlink(table);
    }
    refuse(IN "\"file\": \"no_such.csv\" }", "", "", "no_such.csv");
}

static void refuse_inlet(tobi_world *w, const tobi_inlet_def *in, tobi_status status, const char *words)
{
    tobi_error err = { 0 };
    assert_int_equal(tobi_world_add_inlet(w, in, &err), status);
    if (!strstr(err.text, words)) fail_msg("%s\nexpected: %s", err.text, words);
}

static void test_wrong_calls(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    tobi_world_def def = tobi_default_world_def();
    tobi_world *w;
    def.domain_max[0] = def.domain_max[1] = def.domain_max[2] = 1;
    def.spacing = 0.05;
    def.end_time = 1;
    must(tobi_world_create(&def, NULL, &w, &err), &err);
    tobi_fluid_def water = tobi_default_fluid_def();
    must(tobi_world_add_fluid(w, &water, NULL, 0, &err), &err);
    tobi_inlet_def in = tobi_default_inlet_def(), bad;
    in.name = "in";
    in.centre[0] = in.centre[1] = in.centre[2] = in.normal[0] = 0.5;
    in.speed = 1;
    in.width = 0.2;
    refuse_inlet(w, &in, TOBI_INVALID, "needs a height beside its width");
    bad = in;
    bad.radius = 0.1;
    refuse_inlet(w, &bad, TOBI_INVALID, "needs a width and a height, or a radius");
    in.height = 0.1;
    bad = in;
    bad.along[0] = 1;
    refuse_inlet(w, &bad, TOBI_INVALID, "has its width along its normal; allowed is across");
    for (int k = 0; k < TOBI_INLET_LIMIT; k++) {
        char name[16];
        snprintf(name, sizeof name, "in%d", k);
        bad = in;
        bad.name = name;
        bad.centre[1] = 0.1 + 0.2*(k%5);
        bad.centre[2] = 0.05 + 0.1*(k/5);
        must(tobi_world_add_inlet(w, &bad, &err), &err);
    }
    refuse_inlet(w, &in, TOBI_UNSUPPORTED, "more than 32 inlets");
    must(tobi_world_start(w, &err), &err);
    refuse_inlet(w, &in, TOBI_INVALID, "a started world takes no more inlets and outlets");
    tobi_world_destroy(w);
    def.method = "mlsmpm";
    must(tobi_world_create(&def, NULL, &w, &err), &err);
    tobi_outlet_def out = tobi_default_outlet_def();
    out.name = "out";
    memcpy(out.centre, in.centre, sizeof out.centre);
    out.normal[0] = 1;
    out.radius = 0.1;
    assert_int_equal(tobi_world_add_outlet(w, &out, &err), TOBI_UNSUPPORTED);
    assert_non_null(strstr(err.text, "mlsmpm has no inlets and outlets; the SPH methods have"));
    assert_int_equal(tobi_world_add_inlet(w, &in, &err), TOBI_UNSUPPORTED);
    tobi_world_destroy(w);
}

/* A body that comes after the inlet: the start finds it. */
static void test_body_later(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def water = tobi_default_fluid_def();
    tobi_inlet_def in = tobi_default_inlet_def();
    tobi_body_def block = tobi_default_body_def();
    tobi_world *w;
    in.name = "in";
    block.name = "block";
    def.spacing = 0.05;
    def.end_time = 1;
    in.normal[0] = in.speed = 1;
    in.radius = 0.1;
    for (int a = 0; a < 3; a++) {
        def.domain_max[a] = 1;
        in.centre[a] = 0.5;
        block.box_min[a] = 0.2;
        block.box_max[a] = 0.8;
    }
    must(tobi_world_create(&def, NULL, &w, &err), &err);
    must(tobi_world_add_fluid(w, &water, NULL, 0, &err), &err);
    must(tobi_world_add_inlet(w, &in, &err), &err);
    must(tobi_world_add_body(w, &block, &err), &err);
    assert_int_equal(tobi_world_start(w, &err), TOBI_INVALID);
    assert_ptr_equal(strstr(err.text, "inlet 'in' lies inside body 'block' with its buffer, at ("), err.text);
    tobi_world_destroy(w);
}

/* A pipe without a free surface: every method but isph and wcsph leaves a note. */
static void test_full_pipe(void **state)
{
    static const char *const methods[] = { "dfsph", "wcsph", "isph", "eisph" };
    const char *scene = "{ \"dimension\": 2, \"method\": \"%s\","
                        "\"domain\": { \"min\": [0, 0], \"max\": [1, %s] },"
                        "\"spacing\": 0.02, \"end_time\": 1, \"fluids\": [ { \"name\": \"water\","
                        "\"fill\": [ { \"box\": { \"min\": [0, 0], \"max\": [1, 0.2] } } ] } ],"
                        "\"inlets\": [ " IN "\"speed\": 0.1 } ], \"outlets\": [ " OUT " ] }";
    (void)state;
    for (int k = 0; k < 8; k++) {
        char text[1000];
        tobi_error err = { 0 };
        tobi_scene *parsed;
        tobi_world *w;
        int notes = 0;
        snprintf(text, sizeof text, scene, methods[k/2], k % 2 ? "0.4" : "0.2");
        must(tobi_scene_parse("s.json", text, strlen(text), NULL, &parsed, NULL, &err), &err);
        must(tobi_scene_build(parsed, &w, &err), &err);
        must(tobi_world_start(w, &err), &err);
        for (int n = 0; tobi_world_note(w, n); n++)
            notes += strstr(tobi_world_note(w, n), "no free surface") != NULL;
        if (notes != (k % 2 == 0 && !strstr("isph wcsph", methods[k/2])))
            fail_msg("%s, %s: %d notes", methods[k/2], k % 2 ? "open" : "full", notes);
        tobi_world_destroy(w);
        tobi_scene_free(parsed);
    }
}

static void test_lists(void **state)
{
    (void)state;
    tobi_world *w;
    tobi_error err = { 0 };
    char many[3000] = "";
    assert_int_equal(make("dfsph", 1, "", "", "\"inlets\": 3,", &w, &err), TOBI_INVALID);
    for (int k = 0; k < TOBI_INLET_LIMIT + 1; k++) strcat(strcat(many, k ? ", " : ""), "{}");
    refuse(many, "", "", "inlets: has 33 entries, allowed are 32");
}

/* Particles that pictures leave out. */
static int64_t count_hidden(tobi_world *w, const tobi_looks *looks, double time)
{
    const int64_t n = tobi_world_count(w, TOBI_FLUID);
    double (*x)[3] = malloc((size_t)n*sizeof *x);
    int64_t hidden = 0;
    tobi_error err = { 0 };
    must(tobi_world_read(w, TOBI_FLUID, "position", x[0], 3*n, &err), &err);
    for (int64_t i = 0; i < n; i++) hidden += tobi_looks_hides(looks, time, x[i]);
    free(x);
    return hidden;
}

/* What an inlet holds is not drawn while nothing flows: all that the method holds. */
static void test_idle(void **state)
{
    (void)state;
    char path[64], table[200];
    write_flow(path, "time,speed\n0,0\n0.02,0\n0.03,0.4\n0.05,0.4\n0.06,0\n0.1,0\n");
    snprintf(table, sizeof table, IN "\"file\": \"%s\" }", path);
    const char *const cases[] = { IN "\"speed\": 0.4, \"start\": 0.02, \"stop\": 0.06 }", table };
    for (int k = 0; k < 2; k++) {
        tobi_world *w;
        tobi_looks looks;
        int64_t held = 0;
        tobi_error err = { 0 };
        must(make("dfsph", 1, cases[k], "", "", &w, &err), &err);
        must(tobi_world_looks(w, &looks, &err), &err);
        assert_int_equal(looks.inlet_count, 1);
        assert_true(count_hidden(w, &looks, 0) > 20);
        assert_int_equal(count_hidden(w, &looks, 0.02), 0);
        assert_int_equal(count_hidden(w, &looks, 0.04), 0);
        must(tobi_world_advance(w, 0.08, NULL, &err), &err);
        const tobi_particles *p = &w->system[0].particles;
        for (int64_t i = 0; i < p->count; i++) {
            const double x[3] = { p->position[i].x, p->position[i].y, p->position[i].z };
            held += tobi_opening_find(w->sim.openings, 1, x) == 0;
        }
        assert_int_equal(count_hidden(w, &looks, tobi_world_time(w)), held);
        assert_int_equal(count_hidden(w, &looks, 0.06), count_hidden(w, &looks, 9));
        assert_int_equal(count_hidden(w, &looks, 0.0599), 0);
        tobi_looks_free(&looks);
        tobi_world_destroy(w);
    }
    unlink(path);
}

/* A domain that inlets have filled ends the run in words that name them, by every method: where the liquid
   has no room any more, or before, where pockets without a free surface throw it. */
static void test_overfull(void **state)
{
    static const char *const methods[] = { "dfsph", "wcsph", "isph", "eisph" };
    int overfilled = 0;
    (void)state;
    for (int k = 0; k < 4; k++) {
        tobi_world *w;
        tobi_error err = { 0 };
        must(make(methods[k], 1, IN "\"speed\": 6 }", "", "", &w, &err), &err);
        assert_int_equal(tobi_world_advance(w, 1, NULL, &err), TOBI_DIVERGED);
        overfilled += strstr(err.text, "the inlets have overfilled the domain at t = 0.")
                   && strstr(err.text, "m2 of liquid, the domain has 0.2 m2");
        if (!strstr(err.text, "overfilled") && !strstr(err.text, "The inlets have all but filled the domain"))
            fail_msg("%s", err.text);
        tobi_world_destroy(w);
    }
    assert_true(overfilled > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_bits), cmocka_unit_test(test_disc),  cmocka_unit_test(test_mistakes),
        cmocka_unit_test(test_wrong_calls), cmocka_unit_test(test_lists), cmocka_unit_test(test_idle),
        cmocka_unit_test(test_set), cmocka_unit_test(test_body_later),
        cmocka_unit_test(test_water_comes_back), cmocka_unit_test(test_rest),
        cmocka_unit_test(test_damaged), cmocka_unit_test(test_flow_in_time),
        cmocka_unit_test(test_wrong_tables), cmocka_unit_test(test_full_pipe),
        cmocka_unit_test(test_overfull),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

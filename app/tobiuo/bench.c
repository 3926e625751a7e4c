/* tobiuo bench [CASE]: the speed of this machine, through the public interface alone. */
#define _GNU_SOURCE
#include "bench.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { KEY_THREADS = KEY_OWN, KEY_STEPS, KEY_SETTLE, KEY_SCENE, KEY_PROJECT,
       KEY_BODIES, KEY_SIZE, KEY_FIXED, KEY_METHOD, KEY_CSV };
enum { MORE_ITERATIONS = 12 };

static const struct argp_option options[] = {
    { "threads", KEY_THREADS, "N", 0, "processor cores to use; 0 = all", 0 },
    { "steps", KEY_STEPS, "N", 0, "steps to measure", 0 },
    { "settle", KEY_SETTLE, "N", 0, "steps before the measurement", 0 },
    { "spacing", KEY_SPACING, "M", 0, "particle spacing, m", 0 },
    { "scene", KEY_SCENE, "SCENE", 0, "fish: the scene (scenes/flying_fish)", 0 },
    { "project", KEY_PROJECT, "S", 0, "fish: project the wall clock to this time (0.8 s)", 0 },
    { "bodies", KEY_BODIES, "N", 0, "bodies_in_water: how many bodies (1000)", 0 },
    { "size", KEY_SIZE, "X", 0, "bodies_in_water: edge of a body in spacings (2)", 0 },
    { "fixed", KEY_FIXED, NULL, 0, "bodies_in_water: bodies that do not move", 0 },
    { "method", KEY_METHOD, "NAME", 0, "bodies_in_water: dfsph (default), wcsph, isph or eisph", 0 },
    { "csv", KEY_CSV, "FILE", 0, "append a row per measurement to this table", 0 },
    { 0 }
};

static int parse_count(struct argp_state *state, const char *option, const char *text)
{
    double value = parse_positive(state, option, text);
    if (value != (int)value) usage_error(state, tr("%s: '%s' is not a whole number"), option, text);
    return (int)value;
}

static error_t parse(int key, char *value, struct argp_state *state)
{
    bench_options *o = state->input;
    switch (key) {
    case KEY_THREADS: o->threads = parse_threads(state, value); break;
    case KEY_STEPS: o->steps = parse_count(state, "--steps", value); break;
    case KEY_SETTLE: o->settle = parse_count(state, "--settle", value); break;
    case KEY_SPACING: o->spacing = parse_positive(state, "--spacing", value); break;
    case KEY_PROJECT: o->project = parse_positive(state, "--project", value); break;
    case KEY_SCENE: o->scene = value; break;
    case KEY_BODIES: o->bodies = parse_count(state, "--bodies", value); break;
    case KEY_SIZE: o->size = parse_positive(state, "--size", value); break;
    case KEY_FIXED: o->fixed = 1; break;
    case KEY_METHOD: o->method = value; break;
    case KEY_CSV: o->csv = value; break;
    case ARGP_KEY_ARG:
        if (o->which) usage_error(state, tr("one CASE only"));
        o->which = value;
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

/* The settled tank: fluid 0.584 x 0.284 x 0.182 m from wall to wall, air above. */
static tobi_world *make_tank(const bench_options *o, const char *method, double spacing, int more)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_dfsph_def m = tobi_default_dfsph_def();
    tobi_fluid_def f = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    const double top[3] = { 0.584, 0.284, 0.232 }, water[3] = { 0.584, 0.284, 0.182 };
    tobi_world *world = NULL;
    tobi_error err = { 0 };
    for (int a = 0; a < 3; a++) {
        w.domain_max[a] = top[a];
        fill.box_max[a] = water[a];
    }
    w.method = method;
    w.spacing = spacing;
    w.threads = o->threads;
    w.end_time = 1.0;
    m.support = 2.0;
    m.density_iterations_min += more;
    m.divergence_iterations_min += more;
    f.name = "water";
    const int dfsph = strcmp(method, "dfsph") == 0;
    if (tobi_world_create(&w, dfsph ? &m : NULL, &world, &err) != TOBI_OK ||
        tobi_world_add_fluid(world, &f, &fill, 1, &err) != TOBI_OK) {
        complain("%s", err.text);
        tobi_world_destroy(world);
        return NULL;
    }
    return world;
}

/* Hands the settled state from one tank to another through a checkpoint file. */
static int copy_state(tobi_world *from, tobi_world *to)
{
    char path[] = P_tmpdir "/tobiuo-bench-XXXXXX";
    tobi_error err = { 0 };
    int file = mkstemp(path), failed = 0;
    if (file < 0) return complain("no temporary file %s", path);
    close(file);
    if (tobi_world_save(from, path, &err) != TOBI_OK ||
        tobi_world_load(to, path, &err) != TOBI_OK) failed = complain("%s", err.text);
    unlink(path);
    return failed;
}

/* What a further pressure iteration costs: a like tank that does more of them, step by step in turn,
   so that both meet the same disturbances. */
static void print_iterations(const bench_result *base, const bench_result *more, int threads)
{
    double n = (double)base->particles * base->steps, did = base->density_iterations +
                                                             base->divergence_iterations;
    double extra = more->density_iterations + more->divergence_iterations - did;
    if (extra < 1.0) {
        printf("further iteration      not known: both tanks did as many\n");
        return;
    }
    double each = 1e6 * (more->solve_seconds - base->solve_seconds) / n / extra;
    double cost = 1e6 * base->seconds / n;
    printf("further iteration      %.4f us per particle (%.2f density + %.2f divergence against "
           "the above)\n", each, more->density_iterations, more->divergence_iterations);
    printf("cost at 2 + 1          %.4f us per particle and step, the mean less %.2f iterations\n",
           cost - (did - 3.0) * each, did - 3.0);
    n *= threads > 0 ? threads : (double)sysconf(_SC_NPROCESSORS_ONLN);
    each = 1e6 * (more->processor - base->processor) / n / extra;
    cost = 1e6 * base->processor / n;
    printf("  in processor time    %.4f us and %.4f us per thread\n", each,
           cost - (did - 3.0) * each);
}

static int step_in_turn(bench_run *base, bench_run *more, int steps)
{
    int failed = 0;
    for (int k = 0; k < steps && !failed; k++) {
        failed = bench_step(base);
        if (!failed) failed = bench_step(more);
    }
    return failed;
}

static int compare_tanks(const bench_options *o, tobi_world *world, tobi_world *second, int steps)
{
    bench_run base, more = { 0 };
    int failed = bench_begin(&base, world, steps);
    if (!failed) failed = copy_state(world, second);
    if (!failed) failed = bench_begin(&more, second, steps);
    if (!failed) failed = step_in_turn(&base, &more, steps);
    bench_end(&base);
    bench_end(&more);
    if (failed) return failed;
    const bench_result *r = &base.result;
    bench_print(&base, o->threads);
    print_iterations(r, &more.result, o->threads);
    printf("wall force / weight    %.4f to %.4f, mean %.4f\n", r->force_least, r->force_most,
           r->force_mean);
    printf("state                  %016llx\n", (unsigned long long)tobi_world_hash(world));
    return bench_write(o, o->which, &base);
}

static int measure_tank(const bench_options *o, double spacing, int settle)
{
    settle = o->settle ? o->settle : settle;
    spacing = o->spacing > 0.0 ? o->spacing : spacing;
    printf("case                   settled tank 0.584 x 0.284 x 0.182 m at %g m, after %d steps\n",
           spacing, settle);
    fflush(stdout);
    tobi_world *world = make_tank(o, "dfsph", spacing, 0);
    tobi_world *more = world ? make_tank(o, "dfsph", spacing, MORE_ITERATIONS) : NULL;
    int failed = !more ? EXIT_ERROR : bench_settle(world, settle);
    if (!failed) failed = compare_tanks(o, world, more, o->steps ? o->steps : 60);
    tobi_world_destroy(world);
    tobi_world_destroy(more);
    return failed;
}

/* That tank by another method. */
static int measure_method(const bench_options *o, const char *method)
{
    const double spacing = o->spacing > 0.0 ? o->spacing : 0.008;
    const int settle = o->settle ? o->settle : 100, steps = o->steps ? o->steps : 200;
    bench_run run = { 0 };
    printf("case                   tank 0.584 x 0.284 x 0.182 m at %g m by %s, after %d steps\n", spacing,
           method, settle);
    fflush(stdout);
    tobi_world *world = make_tank(o, method, spacing, 0);
    int failed = world ? bench_settle(world, settle) : EXIT_ERROR;
    if (!failed) failed = bench_begin(&run, world, steps);
    for (int k = 0; k < steps && !failed; k++) failed = bench_step(&run);
    bench_end(&run);
    if (!failed) {
        bench_print(&run, o->threads);
        printf("state                  %016llx\n", (unsigned long long)tobi_world_hash(world));
        failed = bench_write(o, method, &run);
    }
    tobi_world_destroy(world);
    return failed;
}

static int run_fish(tobi_scene *scene, const bench_options *o)
{
    tobi_error err = { 0 };
    tobi_world *world = NULL;
    bench_run run = { 0 };
    int settle = o->settle ? o->settle : 10, steps = o->steps ? o->steps : 50;
    double end = o->project > 0.0 ? o->project : 0.8;
    if (tobi_scene_build(scene, &world, &err) != TOBI_OK) return complain("%s", err.text);
    printf("case                   %s at %g m, after %d steps\n", tobi_scene_name(scene),
           tobi_scene_world_def(scene)->spacing, settle);
    fflush(stdout);
    int failed = bench_settle(world, settle);
    double from = tobi_world_time(world);
    if (!failed) failed = bench_begin(&run, world, steps);
    for (int k = 0; k < steps && !failed; k++) failed = bench_step(&run);
    bench_end(&run);
    if (!failed) {
        bench_print(&run, o->threads);
        char text[32];
        printf("simulated              %.4f to %.4f s\n", from, tobi_world_time(world));
        printf("state                  %016llx\n", (unsigned long long)tobi_world_hash(world));
        printf("projected to %.3g s     %s of wall clock, without output, if all steps were like "
               "these\n", end, duration_text(end / run.result.simulated * run.result.seconds, text));
        failed = bench_write(o, o->which, &run);
    }
    tobi_world_destroy(world);
    return failed;
}

static int measure_fish(const bench_options *o)
{
    overrides set = { 0 };
    overrides_add(&set, "threads=%d", o->threads);
    if (o->spacing > 0.0) overrides_add(&set, "spacing=%.17g", o->spacing);
    tobi_scene *scene = load_scene(o->scene ? o->scene : "scenes/flying_fish", &set);
    int code = scene ? run_fish(scene, o) : EXIT_ERROR;
    tobi_scene_free(scene);
    return code;
}

const struct argp bench_argp = {
    .options = options,
    .parser = parse,
    .args_doc = "[CASE]",
    .doc = "Measure the speed of this machine.\n"
           "CASE is\n"
           "  small   the settled tank at 8 mm, 55 000 particles, seconds (default)\n"
           "  tank    the settled tank at 4 mm, 466 000 particles, a minute\n"
           "  wcsph   that tank at 8 mm by wcsph, seconds\n"
           "  isph    that tank at 8 mm by isph, seconds\n"
           "  eisph   that tank at 8 mm by eisph, seconds\n"
           "  fish    the flying fish at --spacing, --steps steps\n"
           "  ball    an elastic ball by mlsmpm at 5 mm, 268 000 particles, seconds\n"
           "  cut     a ball that a blade goes through, and the same without, half a minute\n"
           "  bodies  200 rigid boxes fall into a bin, seconds\n"
           "  bodies_in_water   a pool of 100 000 particles with one small body and with 1000\n"
           "  frame   a picture of 68 000 and of 500 000 particles, per stage, on --threads (1), seconds\n"
           "  surface the surface of 500 000 particles at two cells, on --threads (1), seconds\n"
           "\nTimes are wall clock; run it on a machine that does nothing else."
};

int tobiuo_bench(int argc, char **argv)
{
    bench_options o = { 0 };
    parse_arguments(&bench_argp, argc, argv, &o);
    const char *which = o.which = o.which ? o.which : "small";
    int tank = strcmp(which, "tank") == 0, small = strcmp(which, "small") == 0;
    int ball = strcmp(which, "ball") == 0, bodies = strcmp(which, "bodies") == 0;
    int cut = strcmp(which, "cut") == 0,
        other = !strcmp(which, "wcsph") || !strcmp(which, "isph") || !strcmp(which, "eisph");
    int in_water = strcmp(which, "bodies_in_water") == 0, frame = strcmp(which, "frame") == 0;
    int surface = strcmp(which, "surface") == 0;
    if (!tank && !small && !other && !ball && !cut && !bodies && !in_water && !frame && !surface &&
        strcmp(which, "fish") != 0) {
        complain("bench: there is no case '%s'; known are small, tank, wcsph, isph, eisph, fish, ball, "
                 "cut, bodies, bodies_in_water, frame and surface", which);
        return EXIT_USAGE;
    }
    bench_find_machine(o.threads, &o.machine);
    bench_print_machine(&o.machine);
    if (ball) return bench_ball(&o);
    if (cut) return bench_cut(&o);
    if (bodies) return bench_bodies(&o);
    if (in_water) return bench_bodies_in_water(&o);
    if (frame) return bench_frame(&o);
    if (surface) return bench_surface(&o);
    if (other) return measure_method(&o, which);
    if (tank) return measure_tank(&o, 0.004, 100);
    return small ? measure_tank(&o, 0.008, 100) : measure_fish(&o);
}

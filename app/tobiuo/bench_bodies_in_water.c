/* A pool with many small bodies, against the same pool with one: what a body costs. The two take their steps
   in turn, so that both meet the same disturbances. Drawback: bodies take the place of particles, so the two
   pools differ by some thousand of them; the cost of both is given per step. */
#include "bench.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MANY = 1000 };
/* Spacings: the water, from wall to wall; above it lie 10 of air. */
static const int SIZE[3] = { 52, 52, 38 };

typedef struct pool { tobi_world *world; bench_run run; int bodies; } pool;

static const char *method_of(const bench_options *o) { return o->method ? o->method : "dfsph"; }

/* Bodies stand on a lattice that fills the water: the fewest places per edge that hold all. */
static tobi_status add_bodies(tobi_world *world, const bench_options *o, double spacing, int count,
                              tobi_error *err)
{
    const int edge = (int)ceil(cbrt(count) - 1e-9);
    const double half = 0.5 * (o->size > 0.0 ? o->size : 2.0) * spacing;
    tobi_status status = TOBI_OK;
    for (int k = 0; k < count && status == TOBI_OK; k++) {
        const int place[3] = { k % edge, k / edge % edge, k / (edge * edge) };
        tobi_body_def b = tobi_default_body_def();
        char name[20];
        snprintf(name, sizeof name, "box%d", k);
        b.name = name;
        b.density = 1000.0;
        b.dynamics = o->fixed ? TOBI_PRESCRIBED : TOBI_FREE;
        for (int a = 0; a < 3; a++) {
            b.box_min[a] = -half;
            b.box_max[a] = half;
            b.translation[a] = (place[a] + 0.5) / edge * SIZE[a] * spacing;
        }
        status = tobi_world_add_body(world, &b, err);
    }
    return status;
}

static tobi_world *make_pool(const bench_options *o, int bodies)
{
    const double spacing = o->spacing > 0.0 ? o->spacing : 0.01;
    tobi_world_def w = tobi_default_world_def();
    tobi_fluid_def f = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *world = NULL;
    tobi_error err = { 0 };
    for (int a = 0; a < 3; a++) {
        fill.box_max[a] = SIZE[a] * spacing;
        w.domain_max[a] = fill.box_max[a] + (a == 2 ? 10.0 * spacing : 0.0);
    }
    w.method = method_of(o);
    w.spacing = spacing;
    w.threads = o->threads;
    w.end_time = 10.0;
    f.name = "water";
    if (tobi_world_create(&w, NULL, &world, &err) == TOBI_OK &&
        add_bodies(world, o, spacing, bodies, &err) == TOBI_OK &&
        tobi_world_add_fluid(world, &f, &fill, 1, &err) == TOBI_OK) return world;
    complain("%s", err.text);
    tobi_world_destroy(world);
    return NULL;
}

static double stage_seconds(const bench_run *run, const char *name)
{
    for (int k = 0; k < run->stages.count; k++)
        if (strcmp(run->stages.name[k], name) == 0) return run->stages.seconds[k];
    return 0.0;
}

static void print_row(const char *name, double one, double many)
{
    printf("  %-22s %10.3f %10.3f %10.2f\n", name, one, many, one > 0.0 ? many / one : 0.0);
}

static void print_pools(const pool *one, const pool *many)
{
    const bench_result *a = &one->run.result, *b = &many->run.result;
    const double each = 1e3 / a->steps;
    printf("fluid particles        %lld and %lld\n", (long long)a->particles, (long long)b->particles);
    printf("iterations per step    %.2f and %.2f density, %.2f and %.2f divergence\n",
           a->density_iterations, b->density_iterations, a->divergence_iterations, b->divergence_iterations);
    printf("time step              %.3g and %.3g s\n", a->simulated / a->steps, b->simulated / b->steps);
    printf("memory                 %.1f and %.1f MB in arrays\n",
           1e-6 * (double)tobi_world_bytes(one->world), 1e-6 * (double)tobi_world_bytes(many->world));
    printf("\n  ms per step %8s %10d %10d %10s\n", "bodies:", one->bodies, many->bodies, "ratio");
    for (int k = 0; k < many->run.stages.count; k++) {
        const char *name = many->run.stages.name[k];
        print_row(name, each * stage_seconds(&one->run, name), each * many->run.stages.seconds[k]);
    }
    print_row("all (mean)", each * a->seconds, each * b->seconds);
    print_row("all (median step)", 1e3 * a->median, 1e3 * b->median);
    print_row("processor time", each * a->processor, each * b->processor);
    printf("\nstate                  %016llx and %016llx\n", (unsigned long long)tobi_world_hash(one->world),
           (unsigned long long)tobi_world_hash(many->world));
}

int bench_bodies_in_water(const bench_options *o)
{
    const int settle = o->settle ? o->settle : 5, steps = o->steps ? o->steps : 20;
    pool p[2] = { { .bodies = 1 }, { .bodies = o->bodies ? o->bodies : MANY } };
    int failed = 0;
    printf("case                   pool of %d x %d x %d spacings by %s, boxes of %g, %s, after %d steps\n",
           SIZE[0], SIZE[1], SIZE[2], method_of(o), o->size > 0.0 ? o->size : 2.0,
           o->fixed ? "fixed" : "free", settle);
    fflush(stdout);
    for (int k = 0; k < 2 && !failed; k++) {
        p[k].world = make_pool(o, p[k].bodies);
        failed = !p[k].world ? EXIT_ERROR : bench_settle(p[k].world, settle);
        if (!failed) failed = bench_begin(&p[k].run, p[k].world, steps);
    }
    for (int k = 0; k < 2 * steps && !failed; k++) failed = bench_step(&p[k % 2].run);
    for (int k = 0; k < 2; k++)
        if (p[k].world) bench_end(&p[k].run);
    if (!failed) print_pools(&p[0], &p[1]);
    for (int k = 0; k < 2 && !failed; k++) {
        char name[64];
        snprintf(name, sizeof name, "%d_bodies_in_water%s%s", p[k].bodies, o->method ? "_" : "",
                 o->method ? o->method : "");
        failed = bench_write(o, name, &p[k].run);
    }
    for (int k = 0; k < 2; k++) tobi_world_destroy(p[k].world);
    return failed;
}

/* 200 boxes that fall into a bin and come to rest, at 60 steps a second: contact of rigid bodies. */
#include "bench.h"
#include <math.h>
#include <stdio.h>

enum { BOXES = 200 };

static tobi_status add_box(tobi_world *world, const char *name, const double side[3], const double at[3],
                           int turned, tobi_error *err)
{
    tobi_body_def b = tobi_default_body_def();
    b.name = name;
    b.dynamics = turned >= 0 ? TOBI_FREE : TOBI_PRESCRIBED;
    b.rotation_angle = turned > 0 ? 17.0 * turned : 0.0;
    b.rotation_axis[0] = 1.0;
    b.rotation_axis[1] = turned % 3;
    b.rotation_axis[2] = 0.5;
    for (int a = 0; a < 3; a++) {
        b.box_min[a] = -0.5 * side[a];
        b.box_max[a] = 0.5 * side[a];
        b.translation[a] = at[a];
    }
    return tobi_world_add_body(world, &b, err);
}

static tobi_status add_bodies(tobi_world *world, tobi_error *err)
{
    const double wall[2][3] = { { 0.2, 2.4, 2.0 }, { 2.0, 0.2, 2.0 } }, box[3] = { 0.3, 0.25, 0.2 };
    char name[20];
    tobi_status status = TOBI_OK;
    for (int k = 0; k < 4 && status == TOBI_OK; k++) {
        double at[3] = { 3.0, 3.0, 1.2 };
        at[k / 2] += k % 2 ? 1.1 : -1.1;
        snprintf(name, sizeof name, "wall%d", k);
        status = add_box(world, name, wall[k / 2], at, -1, err);
    }
    for (int k = 0; k < BOXES && status == TOBI_OK; k++) {
        double at[3] = { 2.3 + 0.45 * (k % 4), 2.3 + 0.45 * (k / 4 % 4), 0.3 + 0.42 * (k / 16) };
        snprintf(name, sizeof name, "box%d", k);
        status = add_box(world, name, box, at, k, err);
    }
    return status;
}

static tobi_world *make_pile(const bench_options *o)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_world *world = NULL;
    tobi_error err = { 0 };
    w.method = "mlsmpm";
    for (int a = 0; a < 3; a++) w.domain_max[a] = 6.0;
    w.spacing = 0.1;
    w.time_step = 1.0 / 60;
    w.end_time = 10.0;
    w.threads = o->threads;
    if (tobi_world_create(&w, NULL, &world, &err) == TOBI_OK && add_bodies(world, &err) == TOBI_OK)
        return world;
    complain("%s", err.text);
    tobi_world_destroy(world);
    return NULL;
}

static void print_pile(const bench_run *run)
{
    const bench_result *r = &run->result;
    double fastest = 0.0;
    tobi_body_info info;
    for (int k = 0; tobi_world_body(run->world, k, &info) == TOBI_OK; k++)
        for (int a = 0; a < 3; a++) fastest = fmax(fastest, fabs(info.velocity[a]));
    printf("measured               %d steps, %.3g s simulated, %.2f s of wall clock\n", r->steps,
           r->simulated, r->seconds);
    printf("steps per second       %.0f (mean), %.0f (median step)\n", r->steps / r->seconds,
           1.0 / r->median);
    printf("processor time         %.2f ms per step\n", 1e3 * r->processor / r->steps);
    printf("fastest body at end    %.2g m/s\n", fastest);
    printf("state                  %016llx\n", (unsigned long long)tobi_world_hash(run->world));
}

int bench_bodies(const bench_options *o)
{
    int settle = o->settle ? o->settle : 1, steps = o->steps ? o->steps : 360;
    bench_run run = { 0 };
    printf("case                   %d boxes fall into a bin, 60 steps a second\n", BOXES);
    fflush(stdout);
    tobi_world *world = make_pile(o);
    int failed = !world ? EXIT_ERROR : bench_settle(world, settle);
    if (!failed) failed = bench_begin(&run, world, steps);
    for (int k = 0; k < steps && !failed; k++) failed = bench_step(&run);
    bench_end(&run);
    if (!failed) print_pile(&run);
    if (!failed) failed = bench_write(o, "bodies", &run);
    tobi_world_destroy(world);
    return failed;
}

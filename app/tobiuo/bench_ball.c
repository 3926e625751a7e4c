/* A ball of neo-Hookean solid that flies and turns: 8 particles per cell, the grid only around it. */
#include "bench.h"
#include <stdio.h>
#include <unistd.h>

static tobi_world *make_ball(const bench_options *o, double spacing)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *world = NULL;
    tobi_error err = { 0 };
    w.method = "mlsmpm";
    for (int a = 0; a < 3; a++) {
        w.domain_min[a] = -0.5;
        w.domain_max[a] = 0.5;
        w.wall_min[a] = w.wall_max[a] = TOBI_WALL_SEPARATE;
    }
    w.spacing = spacing;
    w.threads = o->threads;
    w.end_time = 1.0;
    solid.name = "ball";
    solid.youngs_modulus = 1e5;
    fill.radius = 0.2;
    fill.velocity[0] = 1.0;
    fill.spin[2] = 5.0;
    if (tobi_world_create(&w, NULL, &world, &err) != TOBI_OK ||
        tobi_world_add_solid(world, &solid, &fill, 1, &err) != TOBI_OK) {
        complain("%s", err.text);
        tobi_world_destroy(world);
        return NULL;
    }
    return world;
}

static void print_ball(const bench_run *run, int threads)
{
    const bench_result *r = &run->result;
    double n = (double)r->particles, each = 1e9 / n;
    double cores = threads > 0 ? threads : (double)sysconf(_SC_NPROCESSORS_ONLN);
    printf("solid particles        %lld, 8 in a cell\n", (long long)r->particles);
    printf("measured               %d steps, %.3g s simulated, %.2f s of wall clock\n", r->steps,
           r->simulated, r->seconds);
    printf("time step              %.3g to %.3g s\n", r->dt_least, r->dt_most);
    printf("cost                   %.1f ns per particle and step and core (mean), %.1f (median step)\n",
           r->seconds / r->steps * each * cores, r->median * each * cores);
    printf("processor time         %.1f ns per particle and step (without other programs: the cost)\n",
           r->processor / r->steps * each);
    printf("memory                 %.0f bytes per particle in arrays, %.0f of the whole process\n",
           (double)tobi_world_bytes(run->world) / n, bench_peak_rss() / n);
    bench_print_stages(run);
    bench_print_memory(run->world, n);
    printf("state                  %016llx\n", (unsigned long long)tobi_world_hash(run->world));
}

int bench_ball(const bench_options *o)
{
    double spacing = o->spacing > 0.0 ? o->spacing : 0.005;
    int settle = o->settle ? o->settle : 50, steps = o->steps ? o->steps : 120;
    bench_run run = { 0 };
    printf("case                   elastic ball of 0.4 m at %g m by mlsmpm, after %d steps\n", spacing,
           settle);
    fflush(stdout);
    tobi_world *world = make_ball(o, spacing);
    int failed = !world ? EXIT_ERROR : bench_settle(world, settle);
    if (!failed) failed = bench_begin(&run, world, steps);
    for (int k = 0; k < steps && !failed; k++) failed = bench_step(&run);
    bench_end(&run);
    if (!failed) print_ball(&run, o->threads);
    if (!failed) failed = bench_write(o, "ball", &run);
    tobi_world_destroy(world);
    return failed;
}

/* A ball that a blade goes through, against the same ball alone: what cutting and contact cost over the whole
   pass, and half way, where they cost most. The two take turns, so that other programs cost both the same. */
#include "bench.h"
#include <stdio.h>
#include <string.h>

static const double RADIUS = 0.039, SPEED = 0.5, START = 0.005;

/* Down at a constant speed. */
static tobi_status lower(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                         tobi_error *err)
{
    (void)user;
    (void)err;
    for (int64_t i = 0; i < n; i++) {
        memcpy(out[i], rest[i], sizeof out[i]);
        out[i][2] -= SPEED*t;
    }
    return TOBI_OK;
}

/* A plate of 3 mm whose lower edge cuts; it starts above the ball. */
static tobi_body_def make_blade(void)
{
    tobi_body_def blade = tobi_default_body_def();
    const double low[3] = { -0.0015, -0.12, 2*RADIUS + START }, high[3] = { 0.0015, 0.12, low[2] + 0.1 };
    blade.name = "blade";
    memcpy(blade.box_min, low, sizeof low);
    memcpy(blade.box_max, high, sizeof high);
    blade.blade = 1;
    blade.edge_resistance = 250;
    blade.friction_coefficient = 0.3;
    blade.edge_start[1] = low[1];
    blade.edge_end[1] = high[1];
    blade.edge_start[2] = blade.edge_end[2] = low[2];
    blade.motion = lower;
    blade.motion_rigid = 1;
    return blade;
}

static tobi_world *make_ball(const bench_options *o, int cut)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def blade = make_blade();
    tobi_mlsmpm_def m = tobi_default_mlsmpm_def();
    tobi_world *world = NULL;
    tobi_error err = { 0 };
    w.method = "mlsmpm";
    for (int a = 0; a < 3; a++) {
        w.domain_min[a] = a < 2 ? -0.3 : 0;
        w.domain_max[a] = a < 2 ? 0.3 : 0.6;
        w.wall_min[a] = w.wall_max[a] = TOBI_WALL_SEPARATE;
    }
    w.spacing = o->spacing > 0.0 ? o->spacing : 0.6/256;
    w.threads = o->threads;
    w.friction = 0.3;
    solid.name = "ball";
    solid.density = 787;
    solid.youngs_modulus = 3e6;
    solid.poissons_ratio = 0.17;
    fill.radius = RADIUS;
    fill.centre[2] = RADIUS;
    m.gradient = TOBI_GRADIENT_MLS;      /* that of scenes with blades: like with like */
    if (tobi_world_create(&w, &m, &world, &err) != TOBI_OK ||
        tobi_world_add_solid(world, &solid, &fill, 1, &err) != TOBI_OK ||
        (cut && tobi_world_add_body(world, &blade, &err) != TOBI_OK)) {
        complain("%s", err.text);
        tobi_world_destroy(world);
        return NULL;
    }
    return world;
}

enum { BEFORE, HALF, AFTER, PARTS };

/* Steps both balls in turn to a time, or, time 0, a number of steps. */
static int step_both(bench_run run[2], tobi_world *world[2], double time, int steps)
{
    int failed = 0, left = 2;
    for (int k = 0; k < 2 && !failed; k++) failed = bench_begin(&run[k], world[k], steps);
    for (int n = 0; left > 0 && !failed; n++) {
        left = 0;
        for (int k = 0; k < 2 && !failed; k++) {
            if (time > 0 ? tobi_world_time(world[k]) >= time : n == steps) continue;
            failed = bench_step(&run[k]);
            left++;
        }
    }
    for (int k = 0; k < 2; k++) bench_end(&run[k]);
    return failed;
}

/* ns of processor time per particle and step, of the parts from first to last. */
static double find_cost(bench_run run[PARTS][2], int first, int last, int cut)
{
    double seconds = 0, items = 0;
    for (int part = first; part <= last; part++) {
        const bench_result *r = &run[part][cut].result;
        seconds += r->processor;
        items += (double)r->particles*r->steps;
    }
    return 1e9*seconds/items;
}

static void print_cost(const char *when, bench_run run[PARTS][2], int first, int last)
{
    const double alone = find_cost(run, first, last, 0), cut = find_cost(run, first, last, 1);
    printf("%-22s %.1f ns of processor time per particle and step, alone %.1f: %.0f %% more\n", when, cut,
           alone, 100*(cut/alone - 1));
}

int bench_cut(const bench_options *o)
{
    int steps = o->steps ? o->steps : 400, failed = 0;
    bench_run run[PARTS][2] = { 0 };
    tobi_world *world[2] = { 0 };
    for (int k = 0; k < 2 && !failed; k++) failed = (world[k] = make_ball(o, k)) ? 0 : EXIT_ERROR;
    if (!failed) failed = step_both(run[BEFORE], world, (START + RADIUS)/SPEED, 0);
    if (!failed) failed = step_both(run[HALF], world, 0, steps);
    if (!failed) failed = bench_write(o, "cut_alone", &run[HALF][0]);
    if (!failed) failed = bench_write(o, "cut", &run[HALF][1]);
    const uint64_t half = failed ? 0 : tobi_world_hash(world[1]);
    if (!failed) failed = step_both(run[AFTER], world, 2*(START + RADIUS)/SPEED, 0);
    if (!failed) {
        printf("case                   ball of 78 mm by mlsmpm, %lld particles, cut by 3 mm at %g m/s\n",
               (long long)tobi_world_count(world[1], TOBI_FLUID), SPEED);
        print_cost("whole pass", run, BEFORE, AFTER);
        print_cost("while half cut", run, HALF, HALF);
        bench_print_stages(&run[HALF][1]);
        printf("state                  %016llx half cut, %016llx at the end\n", (unsigned long long)half,
               (unsigned long long)tobi_world_hash(world[1]));
    }
    for (int k = 0; k < 2; k++) tobi_world_destroy(world[k]);
    return failed;
}

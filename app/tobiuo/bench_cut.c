/* A ball that a blade is half through, against the same ball alone: what cutting and contact cost. The two
   take turns, so that other programs cost both the same. */
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
    if (tobi_world_create(&w, NULL, &world, &err) != TOBI_OK ||
        tobi_world_add_solid(world, &solid, &fill, 1, &err) != TOBI_OK ||
        (cut && tobi_world_add_body(world, &blade, &err) != TOBI_OK) ||
        tobi_world_advance(world, (START + RADIUS)/SPEED, NULL, &err) != TOBI_OK) {
        complain("%s", err.text);
        tobi_world_destroy(world);
        return NULL;
    }
    return world;
}

static void print_cost(const bench_run run[2])
{
    double cost[2];
    for (int k = 0; k < 2; k++) {
        const bench_result *r = &run[k].result;
        cost[k] = r->processor/r->steps*1e9/(double)r->particles;
        printf("%s%.1f ns of processor time per particle and step\n", k ? "half cut               "
                                                                        : "alone                  ", cost[k]);
    }
    printf("cutting and contact    %.0f %% of a step without them\n", 100*(cost[1]/cost[0] - 1));
    bench_print_stages(&run[1]);
    printf("state                  %016llx\n", (unsigned long long)tobi_world_hash(run[1].world));
}

int bench_cut(const bench_options *o)
{
    int steps = o->steps ? o->steps : 400, failed = 0;
    bench_run run[2] = { 0 };
    for (int k = 0; k < 2 && !failed; k++) {
        tobi_world *world = make_ball(o, k);
        failed = world ? bench_begin(&run[k], world, steps) : EXIT_ERROR;
    }
    if (!failed)
        printf("case                   ball of 78 mm by mlsmpm, %lld particles, cut half through by 3 mm\n",
               (long long)tobi_world_count(run[1].world, TOBI_FLUID));
    fflush(stdout);
    for (int n = 0; n < steps && !failed; n++)
        for (int k = 0; k < 2 && !failed; k++) failed = bench_step(&run[k]);
    for (int k = 0; k < 2; k++) bench_end(&run[k]);
    if (!failed) print_cost(run);
    for (int k = 0; k < 2; k++) tobi_world_destroy(run[k].world);
    return failed;
}

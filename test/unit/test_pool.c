/* Water at rest among many small boxes of its own density keeps its volume. */
#include "calls.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>

enum { EDGE = 5 };
static const double END = 0.1;                                   /* s */
static const double SPACING = 0.01, SIZE[3] = {26, 26, 19};      /* spacings: the water from wall to wall */

/* Boxes of two spacings on a lattice that does not fit that of the particles. */
static tobi_world *make_pool(int dynamics)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_fluid_def f = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *world;
    w.method = "dfsph";
    w.spacing = SPACING;
    for (int a = 0; a < 3; a++) {
        fill.box_max[a] = SIZE[a]*SPACING;
        w.domain_max[a] = fill.box_max[a] + (a == 2 ? 10*SPACING : 0);
    }
    f.name = "water";
    OK(tobi_world_create(&w, NULL, &world, &err));
    for (int k = 0; k < EDGE*EDGE*EDGE; k++) {
        const int place[3] = {k%EDGE, k/EDGE%EDGE, k/EDGE/EDGE};
        tobi_body_def b = tobi_default_body_def();
        char name[20];
        snprintf(name, sizeof name, "box%d", k);
        b.name = name;
        b.density = 1000;
        b.dynamics = dynamics;
        for (int a = 0; a < 3; a++) {
            b.box_min[a] = -SPACING;
            b.box_max[a] = SPACING;
            b.translation[a] = (place[a] + 0.5)/EDGE*SIZE[a]*SPACING;
        }
        OK(tobi_world_add_body(world, &b, &err));
    }
    OK(tobi_world_add_fluid(world, &f, &fill, 1, &err));
    OK(tobi_world_start(world, &err));
    return world;
}

/* The mean height of water and boxes together over half the level that their volume makes, less 1. */
static double swelling(const tobi_world *world)
{
    const tobi_particles *p = &world->system[0].particles;
    double height = 0, volume = 0;
    for (int64_t i = 0; i < p->count; i++) height += p->position[i].z*pow(SPACING, 3);
    volume += (double)p->count*pow(SPACING, 3);
    for (int k = 0; k < world->sim.body_count; k++) {
        height += world->sim.bodies[k].rigid.position[2]*pow(2*SPACING, 3);
        volume += pow(2*SPACING, 3);
    }
    return 2*height/volume*SIZE[0]*SIZE[1]*SPACING*SPACING/volume - 1;
}

static void keeps_its_volume(void **state)
{
    static const int dynamics[2] = {TOBI_PRESCRIBED, TOBI_FREE};
    (void)state;
    for (int k = 0; k < 2; k++) {
        tobi_world *world = make_pool(dynamics[k]);
        OK(tobi_world_advance(world, END, NULL, &err));
        const double gain = swelling(world);
        printf("%s boxes: the mean height is off by %.2f %%\n", k ? "free" : "fixed", 100*gain);
        if (!(fabs(gain) < 0.01)) fail_msg("the mean height is off by %.2f %%", 100*gain);
        tobi_world_destroy(world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(keeps_its_volume) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

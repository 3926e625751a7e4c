/* Water at rest among many small boxes of its own density keeps its volume. It presses bodies that reach into
   each other where it wets them, and nowhere else. */
#include "calls.h"
#include "scene_text.h"
#include <math.h>
#include <stdio.h>

enum { EDGE = 5 };
static const double END = SANITIZED ? 0.02 : 0.1;                /* s */
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
        if (!SANITIZED && !(fabs(gain) < 0.01)) fail_msg("the mean height is off by %.2f %%", 100*gain);
        tobi_world_destroy(world);
    }
}

/* A hull with a fin under it: the fin covers a part of the hull's bottom, the hull the fin's upper end. One
   method sees it in the fin, another flush with it, and joined bodies as those that stand. */
static void presses_what_is_wet(void **state)
{
    static const struct { const char *method, *joint; double top; } run[] = {
        {"isph", "", -0.09}, {"dfsph", "", -0.12}, {"wcsph", "", -0.09},
        {"isph", "'dynamics': 'free', 'locked': 'shift,turn'", -0.09}};
    static const double PRESSURE = 9810*0.12, FIN = 0.04, WIDTH = 0.3, DEEPER = 9810*0.18;    /* Pa, m */
    (void)state;
    for (int k = 0; k < 4; k++) {
        char text[1200];
        const int joined = *run[k].joint != 0;
        snprintf(text, sizeof text,
                 "{'method': '%s', 'dimension': 2, 'spacing': 0.01, 'end_time': 1,"
                 "'domain': {'min': [-0.4, -0.4], 'max': [0.4, 0.2]},"
                 "'fluids': [{'name': 'sea', 'fill': [{'box': {'min': [-0.4, -0.4], 'max': [0.4, 0]}}]}],"
                 "'bodies': [{'name': 'hull', 'box': {'min': [-0.15, -0.12], 'max': [0.15, 0.12]}%s%s},"
                 "{'name': 'fin', 'box': {'min': [-0.02, -0.18], 'max': [0.02, %g]}%s%s}]%s}",
                 run[k].method, joined ? ", " : "", run[k].joint, run[k].top, joined ? ", " : "",
                 run[k].joint, joined ? ", 'joints': [{'name': 'weld', 'kind': 'fixed', 'body': 'fin',"
                                        " 'to_body': 'hull', 'point': [0, -0.12]}]" : "");
        for (char *c = text; *c; c++)
            if (*c == '\'') *c = '"';
        tobi_world *world;
        OK(start_scene(text, &world, &err));
        OK(tobi_world_advance(world, 0.05, NULL, &err));
        const double hull = world->sim.bodies[0].info.pressure_force[1]/(PRESSURE*(WIDTH - FIN)) - 1;
        const double fin = world->sim.bodies[1].info.pressure_force[1]/(DEEPER*FIN) - 1;
        printf("%s: hull off by %.2f %%, fin by %.2f %%\n", run[k].method, 100*hull, 100*fin);
        if (!(fabs(hull) < 0.015 && fabs(fin) < 0.015)) fail_msg("hull %.4f, fin %.4f", hull, fin);
        tobi_world_destroy(world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(keeps_its_volume),
                                        cmocka_unit_test(presses_what_is_wet) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Solids beside liquids: with a spacing of their own, periodic sides, bodies that go, liquids of two
   densities; what is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include "calls.h"
#include "world/world.h"

/* A block of water, and a jelly above it, in a box without gravity; 2-D. */
static tobi_world *make_world(const char *method, double spacing, int periodic, double jelly_x)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_mlsmpm_def m = tobi_default_mlsmpm_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def water = tobi_default_fill_def(), jelly = tobi_default_fill_def();
    tobi_world *world;
    w.method = method;
    w.dimension = 2;
    w.spacing = 0.01;
    w.time_step_max = 1e-3;
    if (periodic) w.wall_min[0] = w.wall_max[0] = TOBI_WALL_PERIODIC;
    for (int a = 0; a < 3; a++) w.gravity[a] = 0;
    for (int a = 0; a < 2; a++) w.domain_max[a] = 0.5;
    solid.name = "jelly";
    solid.youngs_modulus = 2e4;
    solid.density = 700;
    m.spacing = spacing;
    water.box_min[0] = 0.15; water.box_max[0] = 0.25; water.box_min[1] = 0.05; water.box_max[1] = 0.11;
    water.velocity[1] = 0.5;
    jelly.box_min[0] = jelly_x; jelly.box_max[0] = jelly_x + 0.05;
    jelly.box_min[1] = 0.12; jelly.box_max[1] = 0.17;
    OK(tobi_world_create(&w, NULL, &world, &err));
    OK(tobi_world_use_solids(world, &m, &err));
    OK(tobi_world_add_fluid(world, &fluid, &water, 1, &err));
    OK(tobi_world_add_solid(world, &solid, &jelly, 1, &err));
    return world;
}

static double find_momentum(tobi_world *w, int system)
{
    tobi_system_measure(&w->system[system]);
    return w->system[system].info.momentum[1];
}

/* Momentum goes over to rounding whatever the spacings, and a restart has the same bits. */
static void finer_solids(void **state)
{
    (void)state;
    static const char *const methods[] = { "dfsph", "wcsph", "isph", "eisph" };
    for (int k = 0; k < 4; k++) {
        tobi_world *w = make_world(methods[k], 0.005, 0, 0.175),
                   *later = make_world(methods[k], 0.005, 0, 0.175);
        double before[2], after[2];
        OK(tobi_world_start(w, &err));
        assert_true(w->system[0].smoothing.spacing == 0.01 && w->system[1].smoothing.spacing == 0.005);
        assert_int_equal(w->system[1].particles.count, 10*10);
        for (int s = 0; s < 2; s++) before[s] = find_momentum(w, s);
        OK(tobi_world_advance(w, 0.06, NULL, &err));
        OK(tobi_world_save(w, "beside.h5", &err));
        OK(tobi_world_load(later, "beside.h5", &err));
        OK(tobi_world_advance(w, 0.08, NULL, &err));
        OK(tobi_world_advance(later, 0.08, NULL, &err));
        assert_true(tobi_world_hash(w) == tobi_world_hash(later));
        for (int s = 0; s < 2; s++) after[s] = find_momentum(w, s);
        const double given = after[1] - before[1], lost = after[0] + after[1] - before[0] - before[1];
        print_message("%s: %.3g of %.3g N s/m went over, %.2g of it was lost\n", methods[k], given, before[0],
                      lost/given);
        assert_true(given > 0.02*before[0]);
        if (k < 2) assert_true(fabs(lost) < 1e-6*before[0]);
        tobi_world_destroy(w);
        tobi_world_destroy(later);
    }
    remove("beside.h5");
}

static void coarser_solids_are_refused(void **state)
{
    (void)state;
    tobi_world_def w = tobi_default_world_def();
    tobi_mlsmpm_def m = tobi_default_mlsmpm_def();
    tobi_world *world;
    w.spacing = 0.01;
    m.spacing = 0.012;
    for (int a = 0; a < 3; a++) w.domain_max[a] = 0.5;
    OK(tobi_world_create(&w, NULL, &world, &err));
    REFUSED(tobi_world_use_solids(world, &m, &err), TOBI_INVALID,
            "mlsmpm.spacing: is 0.012 m, must not be above the spacing of the fluids, 0.01 m");
    tobi_world_destroy(world);
}

/* The liquid goes through periodic sides; a solid that would is told of. */
static void periodic_sides(void **state)
{
    (void)state;
    tobi_world *w = make_world("dfsph", 0, 1, 0.175);
    OK(tobi_world_advance(w, 0.05, NULL, &err));
    tobi_world_destroy(w);
    w = make_world("dfsph", 0.0005, 1, 0.175);      /* more sums than a new world has room for */
    OK(tobi_world_start(w, &err));
    tobi_world_destroy(w);
    w = make_world("dfsph", 0, 1, 0.01);
    REFUSED(tobi_world_start(w, &err), TOBI_UNSUPPORTED, "solid 'jelly' comes to x = 0.015 m; solids do not "
            "go through periodic sides");
    tobi_world_destroy(w);
    w = make_world("dfsph", 0, 1, 0.175);
    tobi_body_def raft = tobi_default_body_def();
    raft.name = "raft";
    raft.box_min[0] = 0.41; raft.box_max[0] = 0.49; raft.box_min[1] = 0.3; raft.box_max[1] = 0.34;
    raft.box_min[2] = -0.5; raft.box_max[2] = 0.5;
    raft.density = 500;
    raft.dynamics = TOBI_FREE;
    raft.velocity[0] = 1;
    OK(tobi_world_add_body(w, &raft, &err));
    raft.name = "tied";
    raft.locked = "x";
    raft.velocity[0] = 0;
    raft.box_min[0] = 0.01; raft.box_max[0] = 0.05;
    OK(tobi_world_add_body(w, &raft, &err));
    OK(tobi_world_start(w, &err));
    int told = 0;
    for (int k = 0; tobi_world_note(w, k); k++) {
        told += strstr(tobi_world_note(w, k), "body 'raft': does not go through the periodic sides along "
                       "x: the run ends where it comes to one") != NULL;
        assert_null(strstr(tobi_world_note(w, k), "body 'tied': does not go"));
    }
    assert_int_equal(told, 1);
    REFUSED(tobi_world_advance(w, 0.05, NULL, &err), TOBI_UNSUPPORTED, "unless they reach from side to side; "
            "keep it there with \"locked\": \"x\", or lengthen the domain");
    tobi_world_destroy(w);
}

/* A blade may start in the water beside a solid: what it may not start in is the solid. */
static void a_blade_under_water(void **state)
{
    (void)state;
    for (int in = 0; in < 2; in++) {
        tobi_world *w = make_world("dfsph", 0, 0, 0.175);
        tobi_body_def knife = tobi_default_body_def();
        knife.name = "knife";
        knife.blade = 1;
        knife.box_min[0] = 0.197; knife.box_max[0] = 0.203;
        knife.box_min[1] = 0.06; knife.box_max[1] = in ? 0.14 : 0.1;
        knife.box_min[2] = -0.1; knife.box_max[2] = 0.1;
        knife.edge_start[0] = knife.edge_end[0] = 0.2;
        knife.edge_start[1] = knife.edge_end[1] = knife.box_max[1];
        OK(tobi_world_add_body(w, &knife, &err));
        if (in) REFUSED(tobi_world_start(w, &err), TOBI_INVALID,
                        "body 'knife' is a blade and starts inside solid 'jelly'");
        else OK(tobi_world_start(w, &err));
        tobi_world_destroy(w);
    }
}

/* A body that drifts through a periodic side would be seen on one side of it alone. A wall reaches through
   both. */
static void bodies_at_periodic_sides(void **state)
{
    (void)state;
    for (int wall = 0; wall < 2; wall++) {
        tobi_world *w = make_world("dfsph", 0, 1, 0.175);
        tobi_body_def raft = tobi_default_body_def();
        raft.name = "raft";
        raft.dynamics = TOBI_FREE;
        raft.velocity[0] = 1;
        raft.box_min[0] = wall ? -0.2 : 0.4; raft.box_max[0] = wall ? 0.7 : 0.47;
        raft.box_min[1] = 0.3; raft.box_max[1] = 0.35;
        OK(tobi_world_add_body(w, &raft, &err));
        OK(tobi_world_advance(w, 0.02, NULL, &err));
        if (wall) OK(tobi_world_advance(w, 0.05, NULL, &err));
        else REFUSED(tobi_world_advance(w, 0.05, NULL, &err), TOBI_UNSUPPORTED,
                     "body 'raft' reaches from x = 0.43");
        tobi_world_destroy(w);
    }
}

/* A jelly lies on a table, with and without a liquid in the scene, and falls when it is taken away. */
static void a_table_is_taken_away(void **state)
{
    (void)state;
    for (int both = 0; both < 2; both++) {
        tobi_world_def w = tobi_default_world_def();
        tobi_fluid_def fluid = tobi_default_fluid_def();
        tobi_solid_def solid = tobi_default_solid_def();
        tobi_fill_def water = tobi_default_fill_def(), jelly = tobi_default_fill_def();
        tobi_body_def table = tobi_default_body_def();
        tobi_world *world;
        w.method = both ? "dfsph" : "mlsmpm";
        w.dimension = 2;
        w.spacing = 0.01;
        w.gravity[1] = -10; w.gravity[2] = 0;
        for (int a = 0; a < 2; a++) w.domain_max[a] = 0.8;
        solid.youngs_modulus = 1e5;
        water.box_min[0] = 0.6;
        water.box_max[0] = 0.8; water.box_max[1] = 0.05;
        jelly.box_min[0] = 0.2; jelly.box_max[0] = 0.3;
        jelly.box_min[1] = 0.6; jelly.box_max[1] = 0.7;
        table.name = "table";
        table.box_min[0] = 0.1; table.box_max[0] = 0.4;
        table.box_min[1] = 0.56; table.box_max[1] = 0.6;
        table.box_min[2] = -0.1; table.box_max[2] = 0.1;
        table.absent_from = 0.2;
        OK(tobi_world_create(&w, NULL, &world, &err));
        OK(tobi_world_add_body(world, &table, &err));
        if (both) OK(tobi_world_add_fluid(world, &fluid, &water, 1, &err));
        OK(tobi_world_add_solid(world, &solid, &jelly, 1, &err));
        OK(tobi_world_advance(world, 0.2, NULL, &err));
        const double lies = find_momentum(world, both);
        assert_true(fabs(lies) < 0.05*solid.density*0.01);
        OK(tobi_world_advance(world, 0.4, NULL, &err));
        const double falls = find_momentum(world, both)/(solid.density*0.01);
        print_message("%s: falls with %.3f m/s\n", w.method, falls);
        assert_true(fabs(falls + 10*0.2) < 0.06);
        tobi_world_destroy(world);
    }
}

/* A disc between two liquids floats where what it displaces of both weighs as much as it. */
static void float_between_liquids(const char *method)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def water = tobi_default_fill_def(), oil = tobi_default_fill_def(),
                  disc = tobi_default_fill_def();
    tobi_world *world;
    w.method = method;
    w.dimension = 2;
    w.spacing = 0.01;
    w.gravity[1] = -9.81; w.gravity[2] = 0;
    w.domain_max[0] = 0.3; w.domain_max[1] = 0.35;
    water.box_max[0] = oil.box_max[0] = 0.3;
    water.box_max[1] = oil.box_min[1] = 0.15; oil.box_max[1] = 0.3;
    disc.centre[0] = disc.centre[1] = 0.15; disc.radius = 0.04;
    fluid.viscosity = 1e-2;
    fluid.name = "water";
    OK(tobi_world_create(&w, NULL, &world, &err));
    OK(tobi_world_add_fluid(world, &fluid, &water, 1, &err));
    fluid.name = "oil";
    fluid.density = 500;
    OK(tobi_world_add_fluid(world, &fluid, &oil, 1, &err));
    solid.youngs_modulus = 1e5;
    solid.density = 750;
    OK(tobi_world_add_solid(world, &solid, &disc, 1, &err));
    OK(tobi_world_advance(world, SANITIZED ? 0.05 : 0.7, NULL, &err));
    const tobi_system *s = &world->system[1];
    double height = 0;
    for (int64_t i = 0; i < s->particles.count; i++) height += s->particles.position[i].y;
    height /= (double)s->particles.count;
    print_message("%s: the disc floats at %.4f m, 0.15 is right\n", method, height);
    assert_true(fabs(height - 0.15) < 0.3*w.spacing);
    tobi_world_destroy(world);
}

static void between_two_liquids(void **state)
{
    (void)state;
    float_between_liquids("dfsph");
    float_between_liquids("isph");
    float_between_liquids("eisph");
}

/* A stationary solid holds by its mass: one as light as what it holds is told of. */
static void light_clamps(void **state)
{
    (void)state;
    for (int heavy = 0; heavy < 2; heavy++) {
        tobi_solid_def clamp = tobi_default_solid_def();
        tobi_fill_def fill = tobi_default_fill_def();
        tobi_world *w = make_world("dfsph", 0, 0, 0.175);
        int told = 0;
        clamp.name = "clamp";
        clamp.model = TOBI_STATIONARY;
        clamp.density = heavy ? 1e6 : 1000;
        fill.box_min[0] = 0.175; fill.box_max[0] = 0.225;
        fill.box_min[1] = 0.17; fill.box_max[1] = 0.2;
        OK(tobi_world_add_solid(w, &clamp, &fill, 1, &err));
        OK(tobi_world_start(w, &err));
        for (int k = 0; tobi_world_note(w, k); k++)
            told |= strstr(tobi_world_note(w, k), "solid 'clamp': holds what is bonded to it by its mass: "
                           "lighter than 7e+05 kg/m3") != NULL;
        assert_int_equal(told, !heavy);
        tobi_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finer_solids),
        cmocka_unit_test(coarser_solids_are_refused),
        cmocka_unit_test(periodic_sides),
        cmocka_unit_test(a_blade_under_water), cmocka_unit_test(bodies_at_periodic_sides),
        cmocka_unit_test(a_table_is_taken_away),
        cmocka_unit_test(between_two_liquids),
        cmocka_unit_test(light_clamps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Still water: its pressure in the first steps, the level that it follows, gaps that no particle fits into,
   and what is told of starts that are not still. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "calls.h"
#include "scene_text.h"
#include "sph/state.h"
#include "sph/reference.h"
#include "world/world.h"

#define D 0.01
#define G 9.81

/* Water in a square tank from the height `lower` up, 0.1 m deep. */
static tobi_world *make_pool(double side, double lower)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *world;
    w.dimension = 3;
    w.spacing = D;
    w.threads = 2;
    w.domain_max[0] = w.domain_max[1] = fill.box_max[0] = fill.box_max[1] = side;
    w.domain_max[2] = 0.2;
    fill.box_min[2] = lower;
    fill.box_max[2] = lower + 0.1;
    OK(tobi_world_create(&w, NULL, &world, &err));
    OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
    return world;
}

static void the_first_steps_feel_the_pressure_of_rest(void **state)
{
    (void)state;
    tobi_world *world = make_pool(0.1, 0);
    tobi_probe_def probe = tobi_default_probe_def();
    tobi_probe_info seen;
    probe.position[0] = probe.position[1] = 0.05;
    OK(tobi_world_add_probe(world, &probe, &err));
    for (int k = 1; k <= 8; k++) {
        OK(tobi_world_step(world, 0, NULL, &err));
        OK(tobi_world_probe(world, 0, &seen, &err));
        const double part = seen.pressure/(1000*G*0.1);
        if (!(fabs(part - 1) < 0.05)) fail_msg("step %d: %g times the pressure of rest", k, part);
    }
    tobi_world_destroy(world);
}

static void the_level_falls_no_faster_than_the_liquid(void **state)
{
    (void)state;
    const double speed = 0.5, void_below = 0.15;
    double level;
    tobi_reference before;
    tobi_world *world = make_pool(0.1, 0);
    OK(tobi_world_step(world, 0, NULL, &err));
    level = sph_of(&world->system[0])->reference.level + 0.5*D;
    const double start = level;
    for (int k = 1; k <= 3; k++) sph_reference_move(&world->system[0], &before, void_below, 0, speed, &level);
    assert_true(fabs(level - start - 3*speed*world->sim.dt) < 1e-9);
    sph_reference_move(&world->system[0], &before, start, 0, speed, &level);
    assert_true(level > start);                                                    /* up slowly */
    tobi_world_destroy(world);
}

/* Up at that speed, m/s, from 0.02 s on. */
static tobi_status draw_up(void *user, double t, int64_t n, const double (*rest)[3], double (*x)[3],
                           tobi_error *err)
{
    (void)err;
    for (int64_t k = 0; k < n; k++) {
        memcpy(x[k], rest[k], sizeof *x);
        x[k][1] += *(double *)user*fmax(t - 0.02, 0);
    }
    return TOBI_OK;
}

/* 2-D, 0.8 m long. */
static tobi_world_def flat_world(double height)
{
    tobi_world_def w = tobi_default_world_def();
    w.dimension = 2;
    w.spacing = D;
    w.threads = 1;
    w.domain_max[0] = 0.8;
    w.domain_max[1] = height;
    w.gravity[1] = -G;
    w.gravity[2] = w.domain_max[2] = 0;
    return w;
}

/* J/m of the water, 0.2 m deep, behind a gate that is drawn up so far that all of it is free at the end; with
   a soft block in it that is as dense. */
static double run_out(const char *method, int still_water, double speed, int soft)
{
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_world_def w = flat_world(0.4);
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def gate = tobi_default_body_def();
    tobi_dfsph_def dfsph = tobi_default_dfsph_def();
    tobi_wcsph_def wcsph = tobi_default_wcsph_def();
    tobi_world *world;
    tobi_step_info info;
    dfsph.still_water = wcsph.still_water = still_water;
    w.method = method;
    fluid.name = "water";
    fill.box_max[0] = 0.29;
    fill.box_max[1] = 0.2;
    fill.box_max[2] = 0;
    gate.name = "gate";
    memcpy(gate.box_min, (double[3]){ 0.29, 0, 0 }, sizeof gate.box_min);
    memcpy(gate.box_max, (double[3]){ 0.31, 0.35, 0 }, sizeof gate.box_max);
    gate.motion = draw_up;
    gate.motion_rigid = 1;
    gate.motion_user = &speed;
    OK(tobi_world_create(&w, strcmp(method, "dfsph") == 0 ? (void *)&dfsph : &wcsph, &world, &err));
    OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
    OK(tobi_world_add_body(world, &gate, &err));
    memcpy(fill.box_min, (double[3]){ 0.06, 0.06, 0 }, sizeof fill.box_min);
    memcpy(fill.box_max, (double[3]){ 0.12, 0.12, 0 }, sizeof fill.box_max);
    if (soft) OK(tobi_world_add_solid(world, &solid, &fill, 1, &err));
    OK(tobi_world_advance(world, SANITIZED ? 0.04 : 0.02 + 0.2/speed, &info, &err));
    tobi_world_destroy(world);
    return info.kinetic_energy;
}

/* Water that opens in the depth does not stand like a wall until the level has come down to there: its energy
   was 0.36 of that without still water. */
static void water_runs_out_under_a_gate(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        const char *method = k%2 ? "wcsph" : "dfsph";
        const double part = run_out(method, 1, 1.5, k/2)/run_out(method, 0, 1.5, k/2);
        printf("%s%s: %.2f of the energy without still water\n", method, k/2 ? ", with a soft block" : "",
               part);
        assert_true(SANITIZED || (part > 0.7 && part < 1.2));
    }
}

/* A ball 8 spacings across that stands on the floor, where particles do not fit in. */
static void water_in_gaps_presses(void **state)
{
    (void)state;
    tobi_world *world = make_pool(0.2, 0);
    tobi_body_def ball = tobi_default_body_def();
    tobi_body_info info;
    double force = 0, volume = acos(-1)/6*8e-6*64;
    ball.name = "ball";
    ball.mesh = TOBI_SOURCE_DIR "/test/meshes/sphere.obj";
    for (int a = 0; a < 3; a++) ball.scale[a] = 0.08, ball.translation[a] = a < 2 ? 0.1 : 0.04;
    OK(tobi_world_add_body(world, &ball, &err));
    OK(tobi_world_advance(world, SANITIZED ? 0.01 : 0.2, NULL, &err));
    for (int k = 1; k <= 20; k++) {
        OK(tobi_world_step(world, 0, NULL, &err));
        OK(tobi_world_body(world, 0, &info));
        force += info.pressure_force[2]/20;
    }
    const double part = force/(1000*G*volume*0.98);      /* the sphere's facets hold 2 % less */
    printf("buoyancy on the floor: %.3f of the exact one\n", part);
    assert_true(SANITIZED || (part > 0.9 && part < 1.05));
    tobi_world_destroy(world);
}

#define MIDDLE 0.075

static tobi_status jump(void *user, double t, int64_t n, const double (*rest)[3], double (*x)[3],
                        tobi_error *err)
{
    (void)err;
    for (int64_t k = 0; k < n; k++) {
        memcpy(x[k], rest[k], sizeof *x);
        x[k][0] += *(double *)user*t;
    }
    return TOBI_OK;
}

/* About the middle of the pool's bodies, along z, rad/s. */
static tobi_status spin(void *user, double t, int64_t n, const double (*rest)[3], double (*x)[3],
                        tobi_error *err)
{
    const double c = cos(*(double *)user*t), s = sin(*(double *)user*t);
    (void)err;
    for (int64_t k = 0; k < n; k++) {
        x[k][0] = MIDDLE + c*(rest[k][0] - MIDDLE) - s*(rest[k][1] - MIDDLE);
        x[k][1] = MIDDLE + s*(rest[k][0] - MIDDLE) + c*(rest[k][1] - MIDDLE);
        x[k][2] = rest[k][2];
    }
    return TOBI_OK;
}

/* A slab 0.2 m high sets off at 1 m/s, with its upper edge 0.2 m below the surface. The void behind it is
   higher than the first part of a look, and no free surface. */
static void a_void_behind_a_body_is_no_surface(void **state)
{
    (void)state;
    double speed = 1;
    int voids = 0, surfaces = 0;
    tobi_world_def w = flat_world(0.7);
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def slab = tobi_default_body_def();
    tobi_world *world;
    fill.box_max[0] = 0.8;
    fill.box_max[1] = 0.5;
    slab.name = "slab";
    memcpy(slab.box_min, (double[3]){ 0.3, 0.1, 0 }, sizeof slab.box_min);
    memcpy(slab.box_max, (double[3]){ 0.34, 0.3, 0 }, sizeof slab.box_max);
    slab.motion = jump;
    slab.motion_rigid = 1;
    slab.motion_user = &speed;
    OK(tobi_world_create(&w, NULL, &world, &err));
    OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
    OK(tobi_world_add_body(world, &slab, &err));
    const tobi_system *s = &world->system[0];
    OK(tobi_world_step(world, 0, NULL, &err));
    while (world->sim.time < 0.1) {
        const tobi_reference *r = &sph_of(s)->reference;
        const double before = r->level;
        tobi_step_info info;
        OK(tobi_world_step(world, 0, &info, &err));
        assert_true(r->level < before + 2*fmax(info.speed_max, speed)*world->sim.dt);
        voids += sph_of(s)->lowest > 0.2 + 0.2;
        for (int64_t i = 0; i < s->particles.count; i++)
            surfaces += sph_fields_of(&s->particles)->surface[i] != 0 &&
                        s->particles.position[i].y < 0.29 && s->particles.position[i].y > 0.11;
    }
    printf("a void in %d steps, %d particles at a surface in it\n", voids, surfaces);
    assert_true(voids > 0 && surfaces == 0);
    tobi_world_destroy(world);
}

static int count_notes(tobi_world *world, const char *text)
{
    int found = 0;
    for (int k = 0; tobi_world_note(world, k); k++) found += strstr(tobi_world_note(world, k), text) != NULL;
    return found;
}

static tobi_body_def make_cube(tobi_motion_fn motion, double *rate)
{
    tobi_body_def box = tobi_default_body_def();
    box.name = "box";
    for (int a = 0; a < 3; a++) box.box_min[a] = MIDDLE - 0.025, box.box_max[a] = MIDDLE + 0.025;
    box.motion = motion;
    box.motion_rigid = 1;
    box.motion_user = rate;
    return box;
}

static void restless_starts_are_told(void **state)
{
    (void)state;
    double speed = 0.5;
    tobi_world *world = make_pool(0.2, 0.02);
    const tobi_body_def box = make_cube(jump, &speed);
    OK(tobi_world_add_body(world, &box, &err));
    OK(tobi_world_start(world, &err));
    assert_int_equal(count_notes(world, "sets off at 0.5 m/s"), 1);
    assert_int_equal(count_notes(world, "fill[0] begins 0.02 m from the side at the lower z"), 1);
    tobi_world_destroy(world);
}

/* Full of liquid, 2-D, 20 mm from particle to particle, for 1 s. */
static tobi_world *make_square(double side, int floor, double viscosity)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *world;
    def.dimension = 2;
    def.spacing = 0.02;
    def.end_time = 1;
    def.wall_min[1] = floor;
    for (int a = 0; a < 2; a++) def.domain_max[a] = fill.box_max[a] = side;
    fluid.viscosity = viscosity;
    OK(tobi_world_create(&def, NULL, &world, &err));
    OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
    return world;
}

/* Sides of the body go through places of the lattice, or beside them: its volume is cut out either way. */
static void places_on_a_body_are_not_cut_raggedly(void **state)
{
    (void)state;
    for (int kind = 0; kind < 8; kind++) {
        tobi_body_def box = tobi_default_body_def();
        tobi_world *world = make_square(0.6, TOBI_WALL_SLIP, 1e-3);
        box.name = "box";
        for (int a = 0; a < 2; a++) {
            box.box_min[a] = 0.25 + 0.02*(kind%4) + (a ? 1e-3*(kind/4) : 0);
            box.box_max[a] = box.box_min[a] + 0.12;
        }
        OK(tobi_world_add_body(world, &box, &err));
        OK(tobi_world_start(world, &err));
        assert_int_equal(tobi_world_info(world)->fluid_particles, 30*30 - 6*6);
        tobi_world_destroy(world);
    }
}

/* A layer that grows to half a spacing, one of three, and that beside a wall that holds it. */
static void thick_liquids_that_slip_everywhere_are_told(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        tobi_world *world = make_square(0.2, kind == 2 ? TOBI_WALL_NO_SLIP : TOBI_WALL_SLIP,
                                        kind == 0 ? 0.1 : 3.6);
        OK(tobi_world_start(world, &err));
        assert_int_equal(count_notes(world, "a layer of 0.06 m along"), kind == 1);
        assert_int_equal(count_notes(world, "slips along all sides and bodies"), kind == 1);
        tobi_world_destroy(world);
    }
}

/* Without gravity nothing falls, and the walls of a vessel are no sides of the domain. */
static void gaps_that_nothing_falls_into_are_not_told(void **state)
{
    (void)state;
    for (int round = 0; round < 3; round++) {
        tobi_world *world;
        char text[700];
        snprintf(text, sizeof text, "{ \"dimension\": 2, \"spacing\": 0.05, \"end_time\": 1, "
                 "\"domain\": { \"min\": [0, 0], \"max\": [2, 2] }, \"gravity\": [0, %s], "
                 "\"fluids\": [ { \"name\": \"oil\", \"fill\": [ { \"sphere\": { \"centre\": [1, 1], "
                 "\"radius\": 0.85 } } ] } ] %s }", round == 1 ? "0" : "-9.81",
                 round == 2 ? ", \"bodies\": [ { \"name\": \"v\", \"vessel\": true, "
                              "\"sphere\": { \"centre\": [1, 1], \"radius\": 0.86 } } ]" : "");
        OK(start_scene(text, &world, &err));
        assert_int_equal(count_notes(world, "m from the side at the"), round == 0);
        tobi_world_destroy(world);
    }
}

/* A cube that turns strikes the water with its faces; a round body slides along it. */
static void what_turns_about_its_axis_is_not_told(void **state)
{
    (void)state;
    double rate = 40;
    for (int round = 0; round < 2; round++) {
        tobi_world *world = make_pool(0.2, 0.02);
        tobi_body_def b = make_cube(spin, &rate);
        if (round) {
            b.cylinder_start[0] = b.cylinder_end[0] = b.cylinder_start[1] = b.cylinder_end[1] = MIDDLE;
            b.cylinder_start[2] = 0.05, b.cylinder_end[2] = 0.1, b.cylinder_radius = 0.025;
            for (int a = 0; a < 3; a++) b.box_min[a] = b.box_max[a] = 0;
        }
        OK(tobi_world_add_body(world, &b, &err));
        OK(tobi_world_start(world, &err));
        assert_int_equal(count_notes(world, "sets off at"), !round);
        tobi_world_destroy(world);
    }
}

/* Water 3 m deep by wcsph, whose sound is that of 50 kPa unless somebody says otherwise. */
static void compression_is_told(void **state)
{
    (void)state;
    for (int stiff = 0; stiff < 2; stiff++) {
        tobi_world *world;
        char text[500];
        snprintf(text, sizeof text, "{ \"method\": \"wcsph\", \"dimension\": 2, \"spacing\": 0.25, "
                 "\"domain\": { \"min\": [0, 0], \"max\": [4, 4] }, \"end_time\": 1, "
                 "\"gravity\": [0, -9.81], \"wcsph\": { \"stiffness\": %g }, \"fluids\": [ { "
                 "\"name\": \"water\", \"fill\": [ { \"box\": { \"min\": [0, 0], \"max\": [4, 3] } } ] } ] }",
                 stiff ? 8.5e5 : 5e4);
        OK(start_scene(text, &world, &err));
        const char *words = "'water': its weight compresses it: sound goes through it at 18.7 m/s, a fall "
                            "from its height ends at 7.67 m/s; 17 times the wcsph.stiffness";
        assert_int_equal(count_notes(world, words), !stiff);
        tobi_world_destroy(world);
    }
}

/* A contact angle is of a free surface with tension; 90 degrees says nothing. */
static void angles_without_tension_are_told(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        tobi_world *world;
        char text[700];
        const double angle = k == 2 ? 90 : 60;
        snprintf(text, sizeof text, "{ \"dimension\": 2, \"spacing\": 0.1, \"end_time\": 1, "
                 "\"domain\": { \"min\": [0, 0], \"max\": [1, 1], \"contact_angle\": %g }, "
                 "\"gravity\": [0, -9.81], \"fluids\": [ { \"name\": \"water\", \"surface_tension\": %s, "
                 "\"fill\": [ { \"box\": { \"min\": [0, 0], \"max\": [1, 0.5] } } ] } ], "
                 "\"bodies\": [ { \"name\": \"cup\", \"contact_angle\": %g, \"box\": { "
                 "\"min\": [0.3, 0.3], \"max\": [0.6, 0.6] } } ] }", angle, k == 1 ? "0.07" : "\"none\"",
                 angle);
        OK(start_scene(text, &world, &err));
        assert_int_equal(count_notes(world, "world 'domain.contact_angle': does nothing"), k == 0);
        assert_int_equal(count_notes(world, "contact_angle of 'cup': does nothing: no"), k == 0);
        tobi_world_destroy(world);
    }
}

/* A box in the dry, on the floor before a dam or on a shelf behind a gate: below the level, not in water. */
static void the_dry_feels_no_water(void **state)
{
    (void)state;
    static const char *const methods[] = { "dfsph", "wcsph" };
    for (int k = 0; k < 4; k++) {
        tobi_world *world;
        tobi_body_info info;
        char text[1000];
        const double floor = k < 2 ? 0 : 0.1;
        snprintf(text, sizeof text, "{ \"method\": \"%s\", \"dimension\": 2, \"spacing\": 0.01, "
                 "\"domain\": { \"min\": [0, 0], \"max\": [0.6, 0.3] }, \"end_time\": 1, "
                 "\"gravity\": [0, -9.81], \"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"box\": { "
                 "\"min\": [0, 0], \"max\": [0.1, 0.2] } } ] } ], \"bodies\": [ { \"name\": \"box\", "
                 "\"box\": { \"min\": [0.43, %g], \"max\": [0.47, %g] }, \"dynamics\": \"free\" }%s ] }",
                 methods[k%2], floor, floor + 0.04, k < 2 ? "" : ", { \"name\": \"shelf\", \"box\": { "
                 "\"min\": [0.4, 0.05], \"max\": [0.5, 0.1] } }, { \"name\": \"gate\", \"box\": { "
                 "\"min\": [0.1, 0], \"max\": [0.13, 0.28] } }");
        OK(start_scene(text, &world, &err));
        for (double t = 0.01; t < 0.035; t += 0.01) {
            OK(tobi_world_advance(world, t, NULL, &err));
            OK(tobi_world_body(world, 0, &info));
            assert_true(info.pressure_force[1] == 0);
        }
        assert_true(fabs(info.position[1] - floor - 0.02) < 1e-5);
        tobi_world_destroy(world);
    }
}

static void spray_has_a_large_surface(void **state)
{
    (void)state;
    tobi_step_info pool, drop;
    tobi_world *world = make_pool(0.2, 0);
    OK(tobi_world_step(world, 0, &pool, &err));
    tobi_world_destroy(world);
    world = make_pool(0.02, 0.05);
    OK(tobi_world_step(world, 0, &drop, &err));
    tobi_world_destroy(world);
    printf("share at a free surface: pool %.3f, column %.3f\n", pool.surface_share, drop.surface_share);
    assert_true(pool.surface_share < 0.2 && drop.surface_share > pool.surface_share);
}

/* A column falls apart in a domain of any height: the level is known to a part of a spacing, not of the
   height. */
static void high_domains_change_nothing(void **state)
{
    (void)state;
    double speed[2];
    for (int high = 0; high < 2; high++) {
        tobi_world_def w = tobi_default_world_def();
        tobi_fluid_def fluid = tobi_default_fluid_def();
        tobi_fill_def fill = tobi_default_fill_def();
        tobi_step_info info;
        tobi_world *world;
        w.dimension = 2;
        w.spacing = D;
        w.threads = 1;
        w.gravity[1] = -G, w.gravity[2] = 0;
        w.domain_max[0] = 1;
        w.domain_max[1] = high ? 200 : 1;
        fill.box_max[0] = fill.box_max[1] = 0.2;
        OK(tobi_world_create(&w, NULL, &world, &err));
        OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
        OK(tobi_world_advance(world, 0.1, &info, &err));
        speed[high] = info.speed_max;
        tobi_world_destroy(world);
    }
    print_message("front at %.3f and %.3f m/s\n", speed[0], speed[1]);
    assert_true(fabs(speed[1]/speed[0] - 1) < 0.1);
}

/* Nor does it cost anything to look for the forces on sides where no liquid is: 1e9 places here. */
static void wide_domains_cost_nothing(void **state)
{
    (void)state;
    tobi_world_def w = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_step_info info;
    tobi_world *world;
    w.method = "isph";
    w.spacing = D;
    w.threads = 1;
    for (int a = 0; a < 3; a++) w.domain_max[a] = 300, fill.box_max[a] = 0.1;
    OK(tobi_world_create(&w, NULL, &world, &err));
    OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
    OK(tobi_world_advance(world, 0.002, &info, &err));
    assert_true(info.wall_force[2] < -0.2*info.weight);
    tobi_world_destroy(world);
}

/* A slope of 45 degrees through places of the lattice. The first step took some at its foot for a surface,
   and the level of still water rose from there for seconds. */
static void the_foot_of_a_slope_is_no_surface(void **state)
{
    tobi_world *world;
    (void)state;
    OK(start_scene("{ \"dimension\": 2, \"spacing\": 0.02, \"end_time\": 1, \"domain\": { \"min\": [0, 0],"
                   "\"max\": [3, 1.2] }, \"bodies\": [ { \"name\": \"slope\", \"outline\": { \"points\":"
                   "[[0, 0], [0, 1.1], [1.1, 0]] } } ], \"fluids\": [ { \"name\": \"water\", \"fill\":"
                   "[ { \"box\": { \"min\": [0, 0], \"max\": [3, 0.6] } } ] } ] }", &world, &err));
    OK(tobi_world_advance(world, 0.05, NULL, &err));
    assert_true(fabs(sph_of(&world->system[0])->reference.level - 0.6) < 0.01);
    tobi_world_destroy(world);
}

/* Sand 0.12 m wide from x on, 0.24 m high, in water 0.3 m deep. */
static tobi_world *make_sand(double spacing, double x)
{
    char text[1000];
    tobi_world *world;
    snprintf(text, sizeof text,
             "{ \"dimension\": 2, \"spacing\": %g, \"end_time\": 1, \"gravity\": [0, -9.81],"
             "\"domain\": { \"min\": [0, 0], \"max\": [0.6, 0.4],"
             "\"walls\": { \"y\": [\"no-slip\", \"slip\"] } }, \"solids\": [ { \"name\": \"sand\","
             "\"model\": \"sand\", \"density\": 1900, \"fill\": [ { \"box\": { \"min\": [%g, 0],"
             "\"max\": [%g, 0.24] } } ] } ], \"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"box\":"
             "{ \"min\": [0, 0], \"max\": [0.6, 0.3] } } ] } ] }", spacing, x, x + 0.12);
    OK(start_scene(text, &world, &err));
    return world;
}

/* A solid's lattice is not that of the water: gaps of up to two spacings are between them. Still water was
   below all, and the pressure of the depth held the sand as a foil would (decision 121). */
static void gaps_beside_soft_solids_are_no_surface(void **state)
{
    (void)state;
    for (int k = 0; k < 12; k++) {
        tobi_world *world = make_sand(0.008, 0.24 + 0.001*k);
        OK(tobi_world_advance(world, 0.001, NULL, &err));
        assert_true(fabs(sph_of(&world->system[0])->soft.still.level - 0.1) < 0.012);
        tobi_world_destroy(world);
    }
}

/* And at the side the pores have the pressure of the water: it pressed the first layer of sand to the side,
   which stood there as a wall. */
static void sand_falls_under_water(void **state)
{
    double top = 0;
    tobi_world *world = make_sand(0.012, 0);
    (void)state;
    OK(tobi_world_advance(world, SANITIZED ? 0.05 : 1, NULL, &err));
    const tobi_particles *p = &world->system[1].particles;
    for (int64_t i = 0; i < p->count; i++) top = fmax(top, p->position[i].y);
    print_message("sand: %.3f m high\n", top);
    assert_true(SANITIZED || top < 0.19);
    tobi_world_destroy(world);
}

/* A jelly of 475 J at rest under water. The kinetic energy of each kick counted as work and was lost in the
   same substep: 35 J. */
static void water_does_no_work_on_what_rests(void **state)
{
    tobi_world *world;
    tobi_step_info info;
    (void)state;
    OK(start_scene("{ \"dimension\": 2, \"spacing\": 0.02, \"end_time\": 1, \"domain\": { \"min\": [0, 0],"
                   "\"max\": [0.6, 0.5] }, \"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"box\":"
                   "{ \"min\": [0, 0], \"max\": [0.6, 0.4] } } ] } ], \"solids\": [ { \"name\": \"jelly\","
                   "\"density\": 1100, \"youngs_modulus\": 1e5, \"fill\": [ { \"box\":"
                   "{ \"min\": [0.2, 0], \"max\": [0.4, 0.2] } } ] } ] }", &world, &err));
    OK(tobi_world_advance(world, SANITIZED ? 0.05 : 0.5, &info, &err));
    print_message("work %.3g J, lost %.3g J\n", info.work_bodies, info.energy_lost);
    assert_true(fabs(info.work_bodies) < 0.5 && fabs(info.energy_lost) < 0.5);
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_steps_feel_the_pressure_of_rest),
        cmocka_unit_test(the_level_falls_no_faster_than_the_liquid),
        cmocka_unit_test(water_runs_out_under_a_gate),
        cmocka_unit_test(a_void_behind_a_body_is_no_surface),
        cmocka_unit_test(water_in_gaps_presses),
        cmocka_unit_test(restless_starts_are_told),
        cmocka_unit_test(places_on_a_body_are_not_cut_raggedly),
        cmocka_unit_test(thick_liquids_that_slip_everywhere_are_told),
        cmocka_unit_test(compression_is_told),
        cmocka_unit_test(angles_without_tension_are_told),
        cmocka_unit_test(the_dry_feels_no_water),
        cmocka_unit_test(gaps_that_nothing_falls_into_are_not_told),
        cmocka_unit_test(what_turns_about_its_axis_is_not_told),
        cmocka_unit_test(spray_has_a_large_surface),
        cmocka_unit_test(high_domains_change_nothing),
        cmocka_unit_test(wide_domains_cost_nothing),
        cmocka_unit_test(the_foot_of_a_slope_is_no_surface),
        cmocka_unit_test(gaps_beside_soft_solids_are_no_surface),
        cmocka_unit_test(sand_falls_under_water),
        cmocka_unit_test(water_does_no_work_on_what_rests),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Where the energy of solids goes: the columns add up, for every transfer and model, with sides, bodies and
   blades, for any number of threads and across a restart. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "solid_rig.h"

/* What differs between the worlds; the rest is a block of 20 x 20 particles in a box of 1 m, 2-D. */
typedef struct setup {
    int model, transfer, measure, threads, open;
    double damping, velocity[2], gravity, strength;
    int body;                           /* 0 none, 1 rough floor, 2 free box above, 3 floor and blade      */
} setup;

static tobi_status go_down(void *user, double t, int64_t n, const double (*rest)[3], double (*position)[3],
                           tobi_error *err)
{
    (void)user;
    (void)err;
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++) position[i][a] = rest[i][a] - (a == 1 ? 2*t : 0);
    return TOBI_OK;
}

static void add_box(tobi_world *world, tobi_body_def b, double x0, double y0, double x1, double y1)
{
    tobi_error err = { 0 };
    const double min[3] = { x0, y0, -0.1 }, max[3] = { x1, y1, 0.1 };
    memcpy(b.box_min, min, sizeof min);
    memcpy(b.box_max, max, sizeof max);
    if (tobi_world_add_body(world, &b, &err)) fail_msg("%s", err.text);
}

static void add_bodies(tobi_world *world, int kind)
{
    tobi_body_def b = tobi_default_body_def();
    b.name = "low";
    if (kind == 1 || kind == 3) add_box(world, b, 0.1, 0.1, 0.9, 0.2);
    b.name = "high";
    b.density = 500;
    b.dynamics = TOBI_FREE;
    if (kind == 2) add_box(world, b, 0.45, 0.65, 0.55, 0.75);
    if (kind != 3) return;
    b.dynamics = TOBI_PRESCRIBED;
    b.motion = go_down;
    b.motion_rigid = 1;
    b.blade = 1;
    b.edge_resistance = 250;
    b.edge_start[0] = 0.495;
    b.edge_start[1] = 0.63;
    add_box(world, b, 0.49, 0.63, 0.50, 0.95);
}

static tobi_world *make_world(setup s)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_mlsmpm_def m = tobi_default_mlsmpm_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *world;
    tobi_error err = { 0 };
    w.method = "mlsmpm";
    w.dimension = 2;
    w.spacing = 0.02;
    w.friction = 0.3;
    w.threads = s.threads;
    w.gravity[1] = -s.gravity;
    w.gravity[2] = 0;
    m.transfer = s.transfer;
    m.measure_transfer = s.measure;
    solid.model = s.model;
    solid.youngs_modulus = 1e5;
    solid.yield_stress = 2000;
    solid.viscosity = 20;
    solid.damping = s.damping;
    solid.strength = s.strength;
    if (s.strength > 0) solid.fracture_energy = 10;
    for (int a = 0; a < 2; a++) {
        w.domain_max[a] = 1;
        w.wall_min[a] = w.wall_max[a] = TOBI_WALL_SEPARATE;
        fill.box_min[a] = a == 0 ? 0.3 : s.body ? 0.2 : 0.05;
        fill.box_max[a] = fill.box_min[a] + 0.4;
        fill.velocity[a] = s.velocity[a];
    }
    if (s.open) w.wall_max[0] = TOBI_WALL_OPEN;
    if (tobi_world_create(&w, &m, &world, &err) || tobi_world_add_solid(world, &solid, &fill, 1, &err))
        fail_msg("%s", err.text);
    add_bodies(world, s.body);
    return world;
}

static double sum_parts(const tobi_step_info *i)
{
    return i->transfer_dissipation + i->plastic_work + i->step_work + i->damping_work + i->friction_work +
           i->fracture_work + i->side_work;
}

/* The parts of energy_lost add up at several times to `tolerance` of what was lost in all. */
static tobi_step_info check_closure(setup s, double end, double tolerance)
{
    tobi_world *world = make_world(s);
    tobi_step_info info;
    tobi_error err = { 0 };
    for (int k = 1; k <= 4; k++) {
        if (tobi_world_advance(world, end*k/4, &info, &err)) fail_msg("%s", err.text);
        double total = info.kinetic_energy + info.elastic_energy + fabs(info.energy_lost);
        if (fabs(info.energy_lost - sum_parts(&info)) > tolerance*total)
            fail_msg("model %d, transfer %d, body %d, t %g: lost %g J, parts %g J", s.model, s.transfer,
                     s.body, info.time, info.energy_lost, sum_parts(&info));
    }
    tobi_world_destroy(world);
    return info;
}

/* Nothing is left over but the rounding of floats: seen 3e-5. */
static void parts_add_up_without_bodies(void **state)
{
    (void)state;
    for (int transfer = TOBI_APIC; transfer <= TOBI_XPIC; transfer++)
        for (int model = TOBI_NEO_HOOKEAN; model <= TOBI_SAND; model++) {
            setup s = { .model = model, .transfer = transfer, .measure = 1, .threads = 2, .gravity = 9.81,
                        .damping = 2, .velocity = { 1, -2 } };
            const tobi_step_info i = check_closure(s, 0.2, 1e-4);
            assert_true(i.damping_work > 1 && i.transfer_dissipation > 0.1 && i.side_work > 0.01);
            int elastic = model == TOBI_NEO_HOOKEAN || model == TOBI_COROTATED;
            assert_true(elastic ? i.plastic_work == 0 : i.plastic_work > 1);
            assert_true(i.friction_work == 0 && i.fracture_work == 0 && i.work_bodies == 0);
        }
}

/* A block that breaks when it hits the floor. */
static void cracks_take_theirs(void **state)
{
    (void)state;
    setup s = { .measure = 1, .threads = 2, .velocity = { 0, -4 }, .strength = 2000 };
    const tobi_step_info i = check_closure(s, 0.15, 1e-3);
    assert_true(i.fracture_work > 1);
}

/* What leaves takes its energy along. */
static void leavers_take_theirs(void **state)
{
    (void)state;
    setup s = { .measure = 1, .threads = 1, .open = 1, .velocity = { 3, 0 } };
    const tobi_step_info i = check_closure(s, 0.2, 2e-5);
    assert_true(i.particles_lost > 50 && i.particles_lost < 400 && fabs(i.energy_lost) < 5);
}

/* Contacts are solved to a tolerance, and particles in bodies are pushed out: seen 2e-4. */
static void parts_add_up_with_bodies(void **state)
{
    (void)state;
    setup s = { .measure = 1, .threads = 2, .gravity = 9.81, .velocity = { 1, -1 }, .body = 1 };
    tobi_step_info i = check_closure(s, 0.3, 1e-3);
    assert_true(i.friction_work > 5);
    s = (setup){ .measure = 1, .threads = 2, .gravity = 9.81, .damping = 5, .body = 2 };
    i = check_closure(s, 0.3, 1e-3);
    assert_true(i.work_bodies > 0.5);
    s = (setup){ .measure = 1, .threads = 2, .damping = 20, .body = 3 };
    i = check_closure(s, 0.15, 1e-3);
    assert_true(i.fracture_work > 40 && i.work_bodies > i.fracture_work);
}

/* A rigid spin-free flight loses 1 - exp(-2 c t) of its energy to damping, measured or not. */
static void damping_is_exact(void **state)
{
    (void)state;
    for (int measure = 0; measure < 2; measure++) {
        setup s = { .measure = measure, .threads = 1, .damping = 3, .velocity = { 0.5, 0.5 } };
        tobi_world *world = make_world(s);
        tobi_step_info i;
        assert_int_equal(tobi_world_advance(world, 0.2, &i, NULL), TOBI_OK);
        double expected = 0.5*160*0.5*(1 - exp(-2*3*0.2));
        assert_true(fabs(i.damping_work - expected) < 1e-4*expected);
        assert_true(measure || (i.transfer_dissipation == 0 && i.step_work == 0 && i.plastic_work == 0));
        tobi_world_destroy(world);
    }
}

/* The edge is at a surface where one row of nodes has 1e-12 of the mass of others. */
static void light_nodes_do_no_work(void **state)
{
    enum { HIGH = 12 };
    const double d = 0.01, cell = 2*d, resistance = 1000, top = 20.5*cell*(1 + 1e-7);
    const double start = 21.1*cell, speed = 2;
    solid_setup s = solid_default(2, d, 1);
    tobi_body_def b = tobi_default_body_def();
    (void)state;
    s.world.gravity[2] = 0;
    s.solid.youngs_modulus = 1e5;
    s.fill.box_min[0] = 0.4;
    s.fill.box_max[0] = 0.6;
    s.fill.box_max[1] = top + 0.5*d;
    s.fill.box_min[1] = s.fill.box_max[1] - HIGH*d;
    tobi_world *world = solid_world(&s);
    b.name = "blade";
    b.motion = go_down;
    b.motion_rigid = 1;
    b.blade = 1;
    b.edge_resistance = resistance;
    b.edge_start[0] = 0.505;
    b.edge_start[1] = start;
    add_box(world, b, 0.504, start, 0.506, 0.9);
    double before = 0;
    while (tobi_world_time(world)*speed < cell) {
        solid_step(world, 1);
        const double work = tobi_world_info(world)->fracture_work;
        assert_true(work >= before);
        assert_true(work <= 1.05*resistance*speed*tobi_world_time(world));
        before = work;
    }
    assert_true(before > 0.5*resistance*(top - start + cell));
    tobi_world_destroy(world);
}

/* Whether a blade is told of whose edge ends `past` (m) past the lower y side, on which a block lies. */
static int tells_of_stop(tobi_wall wall, double past)
{
    const double high = 0.21;
    solid_setup s = solid_default(2, 0.01, 1);
    tobi_body_def b = tobi_default_body_def();
    int told = 0;
    s.world.wall_min[1] = wall;
    s.world.end_time = (high + past)/2;
    s.fill.box_max[1] = 0.2;
    tobi_world *world = solid_world(&s);
    b.name = "blade";
    b.motion = go_down;
    b.motion_rigid = 1;
    b.blade = 1;
    b.edge_start[0] = 0.505;
    b.edge_start[1] = high;
    add_box(world, b, 0.504, high, 0.506, 0.9);
    OK(tobi_world_start(world, &err));
    for (int k = 0; tobi_world_note(world, k); k++)
        told |= strstr(tobi_world_note(world, k), "'blade': its edge comes to ") != NULL;
    tobi_world_destroy(world);
    return told;
}

static void blades_that_stop_early_are_told(void **state)
{
    (void)state;
    assert_true(tells_of_stop(TOBI_WALL_NO_SLIP, 0) && tells_of_stop(TOBI_WALL_SLIP, 0.002));
    assert_true(tells_of_stop(TOBI_WALL_NO_SLIP, -0.009) && tells_of_stop(TOBI_WALL_SEPARATE, -0.005));
    assert_false(tells_of_stop(TOBI_WALL_NO_SLIP, 0.005) || tells_of_stop(TOBI_WALL_SEPARATE, 0));
    assert_false(tells_of_stop(TOBI_WALL_NO_SLIP, -0.1) || tells_of_stop(TOBI_WALL_OPEN, 0));
}

static void threads_and_restarts_agree(void **state)
{
    (void)state;
    char path[] = "/tmp/tobiuo_work_XXXXXX";
    setup s = { .model = TOBI_VON_MISES, .measure = 1, .threads = 1, .gravity = 9.81, .damping = 1, .body = 1,
                .velocity = { 1, -1 } };
    tobi_step_info a, b, c;
    tobi_error err = { 0 };
    close(mkstemp(path));
    tobi_world *one = make_world(s);
    s.threads = 4;
    tobi_world *four = make_world(s), *later = make_world(s);
    assert_int_equal(tobi_world_advance(one, 0.1, NULL, &err), TOBI_OK);
    if (tobi_world_save(one, path, &err) || tobi_world_load(later, path, &err)) fail_msg("%s", err.text);
    assert_int_equal(tobi_world_advance(one, 0.2, &a, &err), TOBI_OK);
    assert_int_equal(tobi_world_advance(four, 0.1, NULL, &err), TOBI_OK);
    assert_int_equal(tobi_world_advance(four, 0.2, &b, &err), TOBI_OK);
    assert_int_equal(tobi_world_advance(later, 0.2, &c, &err), TOBI_OK);
    assert_true(a.energy_lost > 1 && sum_parts(&a) == sum_parts(&b) && sum_parts(&a) == sum_parts(&c));
    assert_true(a.energy_lost == b.energy_lost && a.energy_lost == c.energy_lost);
    assert_true(a.damping_work == c.damping_work && a.step_work == c.step_work && a.step_work == b.step_work);
    unlink(path);
    tobi_world_destroy(one);
    tobi_world_destroy(four);
    tobi_world_destroy(later);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_add_up_without_bodies),
        cmocka_unit_test(cracks_take_theirs),
        cmocka_unit_test(leavers_take_theirs),
        cmocka_unit_test(parts_add_up_with_bodies),
        cmocka_unit_test(damping_is_exact),
        cmocka_unit_test(light_nodes_do_no_work),
        cmocka_unit_test(blades_that_stop_early_are_told),
        cmocka_unit_test(threads_and_restarts_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

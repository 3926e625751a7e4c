/* Probes: a linear field is read exactly in the fluid, an even pressure nearly so on walls; levels; what is
   told of points in bodies. */
#include "tobiuo/tobiuo.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

static tobi_world *make_tank(int dimension, double gravity)
{
    tobi_error err;
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    w.dimension = dimension;
    w.spacing = 0.01;
    w.domain_min[0] = -0.1;
    w.domain_max[0] = 0.1; w.domain_max[1] = 0.2; w.domain_max[2] = dimension == 3 ? 0.2 : 0;
    for (int a = 0; a < 3; a++) w.gravity[a] = 0;
    w.gravity[dimension - 1] = gravity;
    assert_int_equal(tobi_world_create(&w, NULL, &world, &err), TOBI_OK);
    tobi_fluid_def f = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    fill.box_min[0] = -0.1;
    fill.box_max[0] = 0.1; fill.box_max[1] = dimension == 3 ? 0.2 : 0.08; fill.box_max[2] = 0.08;
    assert_int_equal(tobi_world_add_fluid(world, &f, &fill, 1, &err), TOBI_OK);
    return world;
}

static const char *const names[] = { "a", "b", "c", "d" };

static int add(tobi_world *world, const char *name, int kind, double x, double y, double z)
{
    tobi_error err;
    tobi_probe_def p = tobi_default_probe_def();
    p.name = name;
    p.kind = kind;
    p.position[0] = x; p.position[1] = y; p.position[2] = z;
    assert_int_equal(tobi_world_add_probe(world, &p, &err), TOBI_OK);
    return tobi_world_probe_count(world) - 1;
}

static double field_at(const double *x) { return 1000 + 3000*x[0] - 2000*x[1] + 500*x[2]; }
static double even(const double *x) { (void)x; return 1000; }

static void set_pressure(tobi_world *world, double (*field)(const double *))
{
    tobi_error err;
    assert_int_equal(tobi_world_start(world, &err), TOBI_OK);
    int64_t n = tobi_world_count(world, TOBI_FLUID);
    double (*x)[3] = malloc((size_t)n*sizeof *x), *p = malloc((size_t)n*sizeof *p);
    assert_int_equal(tobi_world_read(world, TOBI_FLUID, "position", &x[0][0], n, &err), TOBI_OK);
    for (int64_t i = 0; i < n; i++) p[i] = field(x[i]);
    assert_int_equal(tobi_world_write(world, "pressure", p, n, &err), TOBI_OK);
    free(x);
    free(p);
}

static void reads_a_linear_field(void **state)
{
    (void)state;
    const double at[][3] = {{0, 0.1, 0.04}, {0.094, 0.05, 0.006}, {-0.09, 0.01, 0.07}, {0.031, 0.19, 0.08}};
    tobi_world *world = make_tank(3, -9.81);
    tobi_error err;
    tobi_probe_info info;
    for (int k = 0; k < 4; k++) add(world, names[k], TOBI_PROBE_POINT, at[k][0], at[k][1], at[k][2]);
    int dry = add(world, "dry", TOBI_PROBE_POINT, 0, 0.1, 0.19);
    set_pressure(world, field_at);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(tobi_world_probe(world, k, &info, &err), TOBI_OK);
        assert_true(fabs(info.pressure - field_at(at[k])) < 0.01);   /* float pressures of 1000 Pa */
    }
    assert_int_equal(tobi_world_probe(world, dry, &info, &err), TOBI_OK);
    assert_true(info.pressure == 0 && info.velocity[0] == 0);
    tobi_world_destroy(world);
}

/* On a wall the sensor is the fluid's force per area. With particles on the lattice, half a spacing away,
   what is left is the unevenness between them and of the product rule of corners. */
static void reads_walls_and_corners(void **state)
{
    (void)state;
    const double at[][3] = {{0.1, 0.1, 0.04}, {0, 0.1, 0}, {-0.1, 0, 0.04}, {0.1, 0.2, 0.001}};
    const double within[] = {20, 60, 60, 120};      /* a face, two edges, a corner */
    tobi_world *world = make_tank(3, 0);
    tobi_error err;
    tobi_probe_info info;
    for (int k = 0; k < 4; k++) add(world, names[k], TOBI_PROBE_POINT, at[k][0], at[k][1], at[k][2]);
    set_pressure(world, even);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(tobi_world_probe(world, k, &info, &err), TOBI_OK);
        assert_true(fabs(info.pressure - 1000) < within[k]);
    }
    tobi_world_destroy(world);
}

static void measures_the_level(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        tobi_world *world = make_tank(dimension, -9.81);
        tobi_error err;
        tobi_probe_info info;
        add(world, "middle", TOBI_PROBE_LEVEL, 0.004, dimension == 3 ? 0.1 : 0, 0);
        add(world, "wall", TOBI_PROBE_LEVEL, -0.1, dimension == 3 ? 0.1 : 0.2, 0);
        for (int k = 0; k < 2; k++) {
            assert_int_equal(tobi_world_probe(world, k, &info, &err), TOBI_OK);
            if (!(fabs(info.level - 0.08) < 0.05*0.01)) fail_msg("level %g",
                info.level);      /* 0.05 spacings */
        }
        tobi_world_destroy(world);
    }
}

static void refuses_probes_outside(void **state)
{
    (void)state;
    tobi_error err;
    tobi_world *world = make_tank(3, -9.81);
    tobi_probe_def p = tobi_default_probe_def();
    tobi_probe_info info;
    p.name = "far";
    p.position[0] = 0.11;
    assert_int_equal(tobi_world_add_probe(world, &p, &err), TOBI_INVALID);
    assert_string_equal(err.text,
                        "probe 'far' sits outside the domain: x = 0.11 m, allowed is -0.1 to 0.1 m");
    assert_int_equal(tobi_world_probe(world, 0, &info, &err), TOBI_NOT_FOUND);
    tobi_world_destroy(world);
}

/* 0.08 m deep, with a block on the floor. */
static tobi_world *make_tank_with_block(const char *method)
{
    tobi_error err;
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    tobi_fluid_def f = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def b = tobi_default_body_def();
    w.method = method;
    w.dimension = 2;
    w.spacing = 0.01;
    w.domain_max[0] = w.domain_max[1] = 0.2;
    w.gravity[1] = -9.81, w.gravity[2] = 0;
    fill.box_max[0] = 0.2, fill.box_max[1] = 0.08;
    b.name = "block";
    b.box_min[0] = 0.06, b.box_max[0] = 0.12, b.box_max[1] = 0.06;
    assert_int_equal(tobi_world_create(&w, NULL, &world, &err), TOBI_OK);
    assert_int_equal(tobi_world_add_fluid(world, &f, &fill, 1, &err), TOBI_OK);
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_OK);
    return world;
}

/* Where it stands there is no floor that liquid presses; beside it and on its faces all counts. A mean over
   the face above its foot is that of half a spacing higher. */
static void reads_the_foot_of_a_body(void **state)
{
    const double x[] = { 0.06, 0.0625, 0.0575, 0.06, 0.12, 0.09 }, y[] = { 0, 0.001, 0, 0.001, 0, 0 };
    const double bottom = 0.08*9810, within[] = { 0.01, 0.01, 0.01, 0.07, 0.01, 0 };
    tobi_world *world = make_tank_with_block("isph");
    tobi_error err;
    tobi_probe_info info;
    (void)state;
    for (int k = 0; k < 3; k++) assert_int_equal(tobi_world_step(world, 0, NULL, &err), TOBI_OK);
    for (int k = 0; k < 6; k++) {
        char name[] = "a";
        name[0] = (char)(name[0] + k);
        const int probe = add(world, name, TOBI_PROBE_POINT, x[k], y[k], 0);
        const double expected = k < 5 ? bottom : 0;
        assert_int_equal(tobi_world_probe(world, probe, &info, &err), TOBI_OK);
        if (!(fabs(info.pressure - expected) <= within[k]*bottom))
            fail_msg("%g, %g: %g Pa, not %g", x[k], y[k], info.pressure, expected);
    }
    tobi_world_destroy(world);
}

/* 2 cm deep in a block is more than half a spacing, 5 mm; on its face is where sensors sit. Its face on the
   floor is none. */
static void tells_points_in_bodies(void **state)
{
    static const struct { double x, y; const char *note; } cases[] = {
        { 0.06, 0.02, NULL }, { 0.08, 0.02, "probe 'p': lies deep in body 'block'" },
        { 0.06, 0, NULL }, { 0.064, 0.002, NULL }, { 0.05, 0, NULL },
        { 0.08, 0, "probe 'p': lies between a side of the domain and body 'block'" },
        { 0.08, 0.003, "probe 'p': lies between a side of the domain and body 'block'" },
    };
    (void)state;
    for (size_t k = 0; k < sizeof cases/sizeof *cases; k++) {
        tobi_world *world = make_tank_with_block("dfsph");
        tobi_error err;
        int told = 0;
        add(world, "p", TOBI_PROBE_POINT, cases[k].x, cases[k].y, 0);
        assert_int_equal(tobi_world_start(world, &err), TOBI_OK);
        for (int n = 0; tobi_world_note(world, n); n++)
            told += !!strstr(tobi_world_note(world, n), cases[k].note ? cases[k].note : "probe 'p'");
        assert_int_equal(told, cases[k].note != NULL);
        tobi_world_destroy(world);
    }
}

/* A patch on the block's face; one that lies across it, whose last two of four places are in the block. */
static void tells_patches_in_bodies(void **state)
{
    tobi_world *world = make_tank_with_block("dfsph");
    tobi_error err;
    tobi_probe_def p = tobi_default_probe_def();
    const char *note = NULL;
    int told = 0;
    (void)state;
    p.kind = TOBI_PROBE_PATCH, p.length = 0.04;
    p.position[0] = 0.06, p.position[1] = 0.03;
    p.name = "face", p.normal[0] = -1;
    assert_int_equal(tobi_world_add_probe(world, &p, &err), TOBI_OK);
    p.name = "across", p.normal[0] = 0, p.normal[1] = 1;
    assert_int_equal(tobi_world_add_probe(world, &p, &err), TOBI_OK);
    assert_int_equal(tobi_world_start(world, &err), TOBI_OK);
    for (int n = 0; tobi_world_note(world, n); n++)
        if (strstr(tobi_world_note(world, n), "probe '") && ++told) note = tobi_world_note(world, n);
    assert_int_equal(told, 1);
    assert_non_null(strstr(note, "probe 'across': 2 of its 4 places lie in body 'block'"));
    tobi_world_destroy(world);
}

/* A soft block is ground as a body is: water stands on it, or the level is its top. It was 0 there. */
static void levels_stand_on_soft_solids(void **state)
{
    static const double height[] = { 0.04, 0.12 }, level[] = { 0.08, 0.12 };
    (void)state;
    for (int k = 0; k < 2; k++) {
        tobi_world *world = make_tank(2, -9.81);
        tobi_error err;
        tobi_probe_info info;
        tobi_solid_def solid = tobi_default_solid_def();
        tobi_fill_def fill = tobi_default_fill_def();
        solid.youngs_modulus = 1e5;
        fill.box_min[0] = -0.05;
        fill.box_max[0] = 0.05;
        fill.box_max[1] = height[k];
        assert_int_equal(tobi_world_add_solid(world, &solid, &fill, 1, &err), TOBI_OK);
        const int gauge = add(world, "a", TOBI_PROBE_LEVEL, 0.002, 0.1, 0);
        assert_int_equal(tobi_world_advance(world, 0.005, NULL, &err), TOBI_OK);
        assert_int_equal(tobi_world_probe(world, gauge, &info, &err), TOBI_OK);
        if (!(fabs(info.level - level[k]) < 0.008)) fail_msg("%g in place of %g m", info.level, level[k]);
        tobi_world_destroy(world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_a_linear_field),
        cmocka_unit_test(reads_walls_and_corners),
        cmocka_unit_test(measures_the_level),
        cmocka_unit_test(levels_stand_on_soft_solids),
        cmocka_unit_test(refuses_probes_outside),
        cmocka_unit_test(reads_the_foot_of_a_body),
        cmocka_unit_test(tells_points_in_bodies),
        cmocka_unit_test(tells_patches_in_bodies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

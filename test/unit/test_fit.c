/* Boxes of liquid whose sides are no multiples of the spacing: all of the liquid is there, and presses as it
   should. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "calls.h"
#include "world/world.h"

#define D 0.01

typedef struct box { double min[3], max[3]; } box;

/* One fluid per box, in a domain of this size. */
static tobi_world *make_world(int dimension, const double size[3], const box *boxes, int count)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *world;
    char name[20];
    w.dimension = dimension;
    w.spacing = D;
    w.threads = 1;
    w.gravity[2] = 0;
    w.gravity[dimension - 1] = -9.81;
    memcpy(w.domain_max, size, sizeof w.domain_max);
    OK(tobi_world_create(&w, NULL, &world, &err));
    for (int k = 0; k < count; k++) {
        snprintf(name, sizeof name, "water_%d", k);
        fluid.name = name;
        memcpy(fill.box_min, boxes[k].min, sizeof fill.box_min);
        memcpy(fill.box_max, boxes[k].max, sizeof fill.box_max);
        OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
    }
    return world;
}

static double volume_of(int dimension, const box *b)
{
    double volume = 1;
    for (int a = 0; a < dimension; a++) volume *= b->max[a] - b->min[a];
    return volume;
}

/* Starts it; what the particles weigh over rho g V. */
static double weigh(tobi_world *world, double volume)
{
    OK(tobi_world_start(world, &err));
    return tobi_world_info(world)->weight/(1000*9.81*volume);
}

static void what_fits_stays(void **state)
{
    (void)state;
    const box pool = { { 0, 0, 0 }, { 0.1, 0.2, 0.07 } };
    tobi_world *world = make_world(3, (double[3]){ 0.1, 0.2, 0.2 }, &pool, 1);
    OK(tobi_world_start(world, &err));
    assert_true(world->sim.smoothing.spacing == D);      /* to the bit */
    assert_int_equal(tobi_world_count(world, TOBI_FLUID), 1400);
    assert_null(tobi_world_note(world, 0));
    tobi_world_destroy(world);
}

static void all_of_the_liquid_is_there(void **state)
{
    (void)state;
    const struct { int dimension; box b; double stretch; } at[] = {
        { 2, { { 0, 0, 0 }, { 0.1037, 0.08, 0 } }, 0.02 },
        { 2, { { 0, 0, 0 }, { 0.1037, 0.1037, 0 } }, 0 },
        { 3, { { 0, 0, 0 }, { 0.1037, 0.1037, 0.1037 } }, 0 },
        { 3, { { 0, 0, 0 }, { 0.105, 0.1, 0.12 } }, 0.031 },
        { 3, { { 0, 0, 0 }, { 0.6, 0.3037, 0.1937 } }, 0.004 },
        { 2, { { 0.1, 0, 0 }, { 0.25, 0.1249, 0 } }, 0.021 },
    };
    for (size_t k = 0; k < sizeof at/sizeof *at; k++) {
        tobi_world *world = make_world(at[k].dimension, (double[3]){ 0.6, 0.31, 0.2 }, &at[k].b, 1);
        assert_true(fabs(weigh(world, volume_of(at[k].dimension, &at[k].b)) - 1) < 1e-9);
        const double d = world->sim.smoothing.spacing;
        assert_true(fabs(d/D - 1) < 0.05 && d != D);
        for (int a = 0; a < at[k].dimension; a++) {
            const double side = at[k].b.max[a] - at[k].b.min[a], layers = floor(side/d + 0.5);
            assert_true(fabs(side/(layers*d) - 1) < at[k].stretch + 1e-3);
        }
        const char *note = tobi_world_note(world, 0);
        if (!note || !strstr(note, "world 'spacing': 0.0") || !strstr(note, "m is taken instead of 0.01 m, "))
            fail_msg("%s", note);
        assert_int_equal(strstr(note, "some are stretched by 3.") != NULL, at[k].stretch > 0.03);
        tobi_world_destroy(world);
    }
}

/* The sum is exact; of two boxes with different needs each is not. Where nothing near fits, that is told. */
static void several_boxes_and_thin_ones(void **state)
{
    (void)state;
    const box two[2] = { { { 0, 0, 0 }, { 0.305, 0.1, 0 } }, { { 0.4, 0, 0 }, { 0.434, 0.034, 0 } } };
    tobi_world *world = make_world(2, (double[3]){ 0.6, 0.2, 0 }, two, 2);
    assert_true(fabs(weigh(world, volume_of(2, &two[0]) + volume_of(2, &two[1])) - 1) < 1e-9);
    assert_string_equal(tobi_world_note(world, 0),
                        "fluid 'water_1': its particles hold 22.7 % less than its boxes");
    tobi_world_destroy(world);

    const box thin = { { 0, 0, 0 }, { 0.1, 0.015, 0 } };
    world = make_world(2, (double[3]){ 0.1, 0.1, 0 }, &thin, 1);
    assert_true(fabs(weigh(world, volume_of(2, &thin)) - 4.0/3) < 1e-9);
    assert_string_equal(tobi_world_note(world, 0),
                        "world 'spacing': 0.01 m: whole layers do not fit, so that the particles hold 33.3 % "
                        "more than the boxes of liquid; 0.0075955 m would fit");
    tobi_world_destroy(world);
}

/* Pressure on the floor of a pool 10.37 spacings wide, and the density of a full vessel of that width, as in
   vessels that fit: 1.004 and 0.005; they were 0.969 and 0.058. */
static void at_rest(void **state)
{
    (void)state;
    const box pool = { { 0, 0, 0 }, { 0.1037, 0.08, 0 } }, full = { { 0, 0, 0 }, { 0.1037, 0.1037, 0 } };
    tobi_world *world = make_world(2, (double[3]){ 0.1037, 0.15, 0 }, &pool, 1);
    tobi_probe_def floor = tobi_default_probe_def();
    tobi_probe_info seen;
    floor.position[0] = 0.05;
    OK(tobi_world_add_probe(world, &floor, &err));
    double sum = 0;
    OK(tobi_world_advance(world, 1, NULL, &err));
    for (int k = 1; k <= 10; k++) {
        OK(tobi_world_advance(world, 1 + 0.02*k, NULL, &err));
        OK(tobi_world_probe(world, 0, &seen, &err));
        sum += seen.pressure/10;
    }
    const double floor_error = sum/(1000*9.81*0.08) - 1;
    if (!(fabs(floor_error) < 0.01)) fail_msg("the floor feels %g of its pressure too much", floor_error);
    tobi_world_destroy(world);

    tobi_step_info info;
    world = make_world(2, (double[3]){ 0.1037, 0.1037, 0 }, &full, 1);
    OK(tobi_world_advance(world, 0.1, &info, &err));
    if (!(info.density_error_mean < 0.01)) fail_msg("the density is off by %g", info.density_error_mean);
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_fits_stays),
        cmocka_unit_test(all_of_the_liquid_is_there),
        cmocka_unit_test(several_boxes_and_thin_ones),
        cmocka_unit_test(at_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

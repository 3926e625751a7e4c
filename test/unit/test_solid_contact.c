/* Free bodies that fall on solids. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>
#include "tobiuo/tobiuo.h"

/* A slab of 0.2 m on the floor of a narrow vessel and a box above it, from low to high. */
static tobi_world *put_box(tobi_world_def *w, tobi_solid_def *solid, tobi_body_def *body, double low,
                           double high)
{
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *world;
    tobi_error err = { 0 };
    w->method = "mlsmpm";
    w->spacing = 0.05;
    for (int a = 0; a < 3; a++) {
        w->domain_max[a] = a == 2 ? 0.6 : 0.4;
        fill.box_max[a] = a == 2 ? 0.2 : 0.4;
        body->box_min[a] = a == 2 ? low : 0.1;
        body->box_max[a] = a == 2 ? high : 0.3;
    }
    body->name = "box";
    assert_int_equal(tobi_world_create(w, NULL, &world, NULL), TOBI_OK);
    assert_int_equal(tobi_world_add_solid(world, solid, &fill, 1, NULL), TOBI_OK);
    if (tobi_world_add_body(world, body, &err)) fail_msg("%s", err.text);
    return world;
}

/* From a height of two spacings: who looks for contacts only where the body was at the start finds none. */
static void a_falling_box_is_caught(void **state)
{
    (void)state;
    tobi_world_def w = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_body_def body = tobi_default_body_def();
    tobi_body_info info;
    tobi_error err = { 0 };
    body.dynamics = TOBI_FREE;
    tobi_world *world = put_box(&w, &solid, &body, 0.3, 0.5);
    if (tobi_world_advance(world, 0.4, NULL, &err)) fail_msg("%s", err.text);
    tobi_world_body(world, 0, &info);
    /* 8 kg on 0.04 m2 of 1e6 Pa: it sinks 0.4 mm and half a spacing is the gap's uncertainty. */
    if (!(info.position[2] > 0.27 && info.position[2] < 0.33)) fail_msg("it is at %g m", info.position[2]);
    tobi_world_destroy(world);
}

/* What a control program is told of the contact force, and of the steps, after `from`. */
typedef struct told { double from, time, least, most, shortest, longest; } told;

static tobi_status listen(void *user, const tobi_control_input *in, tobi_control_output *out, tobi_error *err)
{
    told *k = user;
    (void)err;
    out->force[2] = -10;
    if (in->time > k->from) {
        k->least = fmin(k->least, in->contact_force[2]);
        k->most = fmax(k->most, in->contact_force[2]);
        k->shortest = fmin(k->shortest, in->time - k->time);
        k->longest = fmax(k->longest, in->time - k->time);
    }
    k->time = in->time;
    return TOBI_OK;
}

/* A body at rest on a solid feels its load whatever the steps: a step half as long as the one before told
   1.7 times as much, since the contact answers the pull of the step before. */
static void shortened_steps_tell_the_same_force(void **state)
{
    (void)state;
    tobi_world_def w = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_body_def body = tobi_default_body_def();
    told k = { .from = 0.8, .least = INFINITY, .shortest = INFINITY };
    tobi_error err = { 0 };
    w.gravity[2] = -9.81;
    solid.youngs_modulus = 1e5;
    solid.damping = 20;
    body.dynamics = TOBI_CONTROLLED;
    body.mass = 2;
    body.control = listen;
    body.control_user = &k;
    tobi_world *world = put_box(&w, &solid, &body, 0.21, 0.4);
    double last = 0;
    for (int n = 0; tobi_world_time(world) < 1.2; n++) {
        const double before = tobi_world_time(world);
        if (tobi_world_step(world, n%3 == 2 ? 0.5*last : 0, NULL, &err)) fail_msg("%s", err.text);
        last = tobi_world_time(world) - before;
    }
    print_message("contact force %.2f to %.2f N in steps of %.3g to %.3g ms; the load is 29.62 N\n", k.least,
                  k.most, 1e3*k.shortest, 1e3*k.longest);
    assert_true(k.shortest < 0.7*k.longest);
    assert_true(k.least > 0.95*29.62 && k.most < 1.05*29.62);
    tobi_world_destroy(world);
}

/* The share of a block's weight that a plate on the floor carries, 2-D. *told: a note says it is too thin. */
static double rest_on_plate(double cells, int *told)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def plate = tobi_default_body_def();
    tobi_world *world;
    tobi_body_info info;
    tobi_error err = { 0 };
    w.method = "mlsmpm";
    w.dimension = 2;
    w.spacing = 0.05;
    w.gravity[1] = -9.81;
    w.gravity[2] = 0;
    w.domain_max[0] = 2;
    w.domain_max[1] = 1.5;
    w.wall_min[1] = TOBI_WALL_SEPARATE;
    solid.youngs_modulus = 1e5;
    solid.damping = 20;
    plate.name = "plate";
    plate.box_min[0] = 0.4;
    plate.box_max[0] = 1.6;
    plate.box_min[2] = -(plate.box_max[2] = 0.5);
    plate.box_max[1] = cells*2*w.spacing;
    fill.box_min[0] = 0.7;
    fill.box_max[0] = 1.3;
    fill.box_min[1] = plate.box_max[1];
    fill.box_max[1] = plate.box_max[1] + 0.4;
    assert_int_equal(tobi_world_create(&w, NULL, &world, NULL), TOBI_OK);
    assert_int_equal(tobi_world_add_solid(world, &solid, &fill, 1, NULL), TOBI_OK);
    assert_int_equal(tobi_world_add_body(world, &plate, NULL), TOBI_OK);
    if (tobi_world_advance(world, 1, NULL, &err)) fail_msg("%s", err.text);
    tobi_world_body(world, 0, &info);
    const char *note;
    *told = 0;
    for (int k = 0; (note = tobi_world_note(world, k)); k++)
        *told |= strstr(note, "body 'plate': lies within") && strstr(note, "of the side at the lower y");
    tobi_world_destroy(world);
    return -info.pressure_force[1]/(1000*0.6*0.4*9.81);
}

/* The side's nodes reach through a thin plate: said, and all of the load from 1.5 cells on. */
static void a_side_is_gathered_through_a_thin_plate(void **state)
{
    (void)state;
    const struct { double cells, share; int told; } cases[] = { { 0.5, 0, 1 }, { 1.5, 1, 0 }, { 2, 1, 0 } };
    for (int k = 0; k < 3; k++) {
        int told;
        const double share = rest_on_plate(cases[k].cells, &told);
        print_message("%g cells: the plate carries %.4f of the weight\n", cases[k].cells, share);
        assert_true(fabs(share - cases[k].share) < 0.01);
        assert_int_equal(told, cases[k].told);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(a_falling_box_is_caught),
                                        cmocka_unit_test(shortened_steps_tell_the_same_force),
                                        cmocka_unit_test(a_side_is_gathered_through_a_thin_plate) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

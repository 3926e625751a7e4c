/* The drift of a body without forces: implicit midpoint in the body frame. */
#include "core/rigid.h"
#include "geom/vec3.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static tobi_body_def free_def(void)
{
    tobi_body_def def;
    memset(&def, 0, sizeof def);
    def.name = "top";
    def.dynamics = TOBI_FREE;
    def.density = 1000;
    return def;
}

static void make(tobi_rigid *r, const tobi_body_def *def)
{
    static const double origin[3];
    tobi_massprops rest = { .volume = 1, .inertia = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };
    tobi_error err = { 0 };
    tobi_status status = tobi_rigid_init(r, def, &rest, origin, 3, &err);
    if (status != TOBI_OK) print_message("%s\n", err.text);
    assert_int_equal(status, TOBI_OK);
}

static void step(tobi_rigid *r, double dt)
{
    tobi_rigid_drift(r, dt);
    memcpy(r->position, r->next_position, sizeof r->position);
    memcpy(r->orientation, r->next_orientation, sizeof r->orientation);
    tobi_rigid_apply_locks(r);
}

/* docs/theory/rigid.md: momentum to round-off, energy to 1e-12 over 1e5 steps at omega dt = 0.05. */
static void test_top(void **state)
{
    (void)state;
    tobi_body_def def = free_def();
    tobi_rigid r;
    memcpy(def.inertia, (double[3]){ 1.5, 2, 2.9 }, sizeof def.inertia);
    memcpy(def.inertia_products, (double[3]){ 0.2, -0.1, 0.3 }, sizeof def.inertia_products);
    memcpy(def.angular_velocity, (double[3]){ 0.3, 0.9, 0.3162 }, sizeof def.angular_velocity);
    make(&r, &def);
    double dt = 0.05/vec3_length(r.angular_velocity), L[3], worst = 0;
    double before = tobi_rigid_kinetic_energy(&r), size = 0;
    memcpy(L, r.momentum, sizeof L);
    for (int k = 0; k < 100000; k++) {
        step(&r, dt);
        worst = fmax(worst, fabs(tobi_rigid_kinetic_energy(&r)/before - 1));
    }
    for (int k = 0; k < 4; k++) size += r.orientation[k]*r.orientation[k];
    print_message("energy %.2g, momentum %.2g, |q|^2 - 1 %.2g\n", worst,
                  sqrt(vec3_distance2(L, r.momentum))/vec3_length(L), size - 1);
    assert_true(worst < 1e-12);
    assert_true(vec3_distance2(L, r.momentum) == 0);
    assert_true(fabs(size - 1) < 1e-14);
}

/* A symmetric top precesses about its momentum by |L|/I_1: the phase is met to second order. */
static double precession_error(int steps)
{
    tobi_body_def def = free_def();
    tobi_rigid r;
    memcpy(def.inertia, (double[3]){ 2, 2, 1 }, sizeof def.inertia);
    memcpy(def.angular_velocity, (double[3]){ 0.6, 0, 1.5 }, sizeof def.angular_velocity);
    make(&r, &def);
    double m[3][3], L[3], axis[3], turned[3], T = 4, rate = vec3_length(r.momentum)/2;
    memcpy(L, r.momentum, sizeof L);
    vec3_normalize(L);
    for (int k = 0; k < steps; k++) step(&r, T/steps);
    tobi_quaternion_matrix(r.orientation, m);
    for (int a = 0; a < 3; a++) axis[a] = m[a][2];
    /* Rodrigues: the body's z axis, at first e_z, turned about L by rate T */
    double z[3] = { 0, 0, 1 }, side[3], c = cos(rate*T), s = sin(rate*T);
    vec3_cross(side, L, z);
    for (int a = 0; a < 3; a++) turned[a] = c*z[a] + s*side[a] + (1 - c)*vec3_dot(L, z)*L[a];
    return sqrt(vec3_distance2(axis, turned));
}

static void test_precession(void **state)
{
    (void)state;
    double coarse = precession_error(100), fine = precession_error(200);
    for (int steps = 100; steps <= 1600; steps *= 2)
        print_message("%d steps: precession error %.3g\n", steps, precession_error(steps));
    print_message("order %.3f\n", log2(coarse/fine));
    assert_true(coarse < 2e-3 && fabs(log2(coarse/fine) - 2) < 0.1);
}

/* A step of many turns still ends, and keeps momentum and energy. */
static void test_fast(void **state)
{
    (void)state;
    tobi_body_def def = free_def();
    tobi_rigid r;
    memcpy(def.inertia, (double[3]){ 1, 2, 2.9 }, sizeof def.inertia);
    memcpy(def.angular_velocity, (double[3]){ 40, 3, 60 }, sizeof def.angular_velocity);
    make(&r, &def);
    double before = tobi_rigid_kinetic_energy(&r);
    for (int k = 0; k < 100; k++) step(&r, 0.5);
    assert_true(fabs(tobi_rigid_kinetic_energy(&r)/before - 1) < 1e-9);
}

static void test_locks(void **state)
{
    (void)state;
    char unknown[32];
    assert_int_equal(tobi_rigid_axes("x,turn_z", unknown), 1 | 32);
    assert_int_equal(tobi_rigid_axes("shift, turn", unknown), 63);
    assert_int_equal(tobi_rigid_axes(NULL, unknown), 0);
    assert_int_equal(tobi_rigid_axes("x,twist_z", unknown), -1);
    assert_string_equal(unknown, "twist_z");
    tobi_body_def def = free_def();
    tobi_rigid r;
    def.locked = "z,turn_x,turn_y";
    memcpy(def.inertia, (double[3]){ 2, 2, 4 }, sizeof def.inertia);
    memcpy(def.velocity, (double[3]){ 1, 2, 0 }, sizeof def.velocity);
    memcpy(def.angular_velocity, (double[3]){ 0, 0, 0.25 }, sizeof def.angular_velocity);
    make(&r, &def);
    r.velocity[2] = 3;                   /* as of a force that acts along a locked axis */
    r.momentum[0] = r.momentum[1] = 2;
    tobi_rigid_apply_locks(&r);
    for (int k = 0; k < 1000; k++) step(&r, 0.001);
    assert_true(fabs(r.position[0] - 1) < 1e-12 && fabs(r.position[1] - 2) < 1e-12 && r.position[2] == 0);
    assert_true(fabs(2*atan2(r.orientation[3], r.orientation[0]) - 0.25) < 1e-12);
    assert_true(r.orientation[1] == 0 && r.orientation[2] == 0);
}

static void refuse(const tobi_body_def *def, const char *words)
{
    static const double origin[3];
    tobi_massprops rest = { .volume = 1, .inertia = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };
    tobi_error err = { 0 };
    tobi_rigid r;
    assert_int_not_equal(tobi_rigid_init(&r, def, &rest, origin, 3, &err), TOBI_OK);
    if (!strstr(err.text, words)) print_message("%s\n", err.text);
    assert_non_null(strstr(err.text, words));
}

static tobi_status no_motion(void *user, double t, int64_t n, const double (*rest)[3], double (*position)[3],
                             tobi_error *err)
{
    (void)user; (void)t; (void)err;
    memcpy(position, rest, (size_t)n*sizeof *position);
    return TOBI_OK;
}

static tobi_status no_control(void *user, const tobi_control_input *in, tobi_control_output *out,
                              tobi_error *err)
{
    (void)user; (void)in; (void)out; (void)err;
    return TOBI_OK;
}

static void test_mistakes(void **state)
{
    (void)state;
    tobi_body_def def = free_def();
    tobi_massprops rest = { .volume = 1, .inertia = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };
    const double centre[3] = { 0, 0, 0 };
    tobi_rigid plate;
    tobi_error err = { 0 };
    memcpy(def.inertia, (double[3]){ 1, -1, 1 }, sizeof def.inertia);
    refuse(&def, "not positive definite");
    memcpy(def.inertia, (double[3]){ 1, 1, 1 }, sizeof def.inertia);
    def.inertia_products[0] = 1.5;
    refuse(&def, "not positive definite");
    def.inertia_products[0] = 0.5;       /* moments 0.5, 1, 1.5: a thin plate */
    assert_int_equal(tobi_rigid_init(&plate, &def, &rest, centre, 3, &err), TOBI_OK);
    def.inertia_products[0] = 0.6;
    refuse(&def, "no body has the inertia (1, 1, 1) kg m2 with products (0.6, 0, 0)");
    def.inertia_products[0] = 0;
    memcpy(def.inertia, (double[3]){ 1, 1, 5 }, sizeof def.inertia);
    refuse(&def, "no body has the inertia (1, 1, 5) kg m2 with products (0, 0, 0): each of its principal "
                 "moments must be at most the sum of the other two");
    memset(def.inertia, 0, sizeof def.inertia);
    def.inertia_products[0] = 1;
    refuse(&def, "products of inertia need");
    def = free_def();
    def.locked = "x,roll";
    refuse(&def, "locked has 'roll'");
    def.locked = "turn_y";
    refuse(&def, "about one axis is locked");
    def.locked = "z,turn";
    assert_int_equal(tobi_rigid_init(&plate, &def, &rest, centre, 2, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "locked is 'z,turn', and in 2-D there are x, y and turn_z"));
    def.locked = "x,turn_x,turn_z";
    def.velocity[0] = 1.5;
    refuse(&def, "cannot start with that velocity: what is locked stays at rest");
    def.velocity[0] = 0;
    def.angular_velocity[2] = 0.1;
    refuse(&def, "cannot start with that angular_velocity: what is locked");
    def = free_def();
    def.motion = no_motion;
    def.motion_rigid = 1;
    refuse(&def, "has a rigid motion");
    def = free_def();
    def.control = no_control;
    refuse(&def, "is not controlled");
    def.dynamics = TOBI_PRESCRIBED;
    refuse(&def, "is not controlled");
    def = free_def();
    def.dynamics = TOBI_CONTROLLED;
    refuse(&def, "no control program");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_top),   cmocka_unit_test(test_precession), cmocka_unit_test(test_fast),
        cmocka_unit_test(test_locks), cmocka_unit_test(test_mistakes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

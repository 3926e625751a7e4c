/* Particles against a plate much thinner than a step's way: whatever side it ends on, it keeps its own. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include "sph/boundary/boundary.h"
#include "sph/state.h"
#include "world/world.h"

static const double SPACING = 0.01, THICKNESS = 1e-4;

typedef struct course { double velocity[3], spin; } course;

/* Moves along and turns about y, around x = y = z = 0. */
static tobi_status move(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                        tobi_error *err)
{
    const course *c = user;
    (void)err;
    double cosine = cos(c->spin*t), sine = sin(c->spin*t);
    for (int64_t i = 0; i < n; i++) {
        double x = rest[i][0], z = rest[i][2];
        out[i][0] = cosine*x + sine*z + c->velocity[0]*t;
        out[i][1] = rest[i][1] + c->velocity[1]*t;
        out[i][2] = -sine*x + cosine*z + c->velocity[2]*t;
    }
    return TOBI_OK;
}

/* A plate of 0.1 x 0.1 m across x = 0, and one particle at x, y = z = 0.005 m. */
static tobi_world *make_world(int dimension, double x, course *course)
{
    tobi_error err;
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    w.dimension = dimension;
    w.spacing = SPACING;
    w.threads = 1;
    for (int a = 0; a < 3; a++) {
        w.domain_min[a] = -0.2;
        w.domain_max[a] = 0.2;
        w.gravity[a] = 0;
    }
    assert_int_equal(tobi_world_create(&w, NULL, &world, &err), TOBI_OK);
    tobi_fluid_def f = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    for (int a = 0; a < 3; a++) fill.box_max[a] = SPACING;
    fill.box_min[0] = x - SPACING/2;
    fill.box_max[0] = x + SPACING/2;
    assert_int_equal(tobi_world_add_fluid(world, &f, &fill, 1, &err), TOBI_OK);
    tobi_body_def b = tobi_default_body_def();
    b.box_min[0] = -THICKNESS/2; b.box_min[1] = b.box_min[2] = -0.05;
    b.box_max[0] = THICKNESS/2;  b.box_max[1] = b.box_max[2] = 0.05;
    b.motion = move;
    b.motion_user = course;
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_OK);
    assert_int_equal(tobi_world_start(world, &err), TOBI_OK);
    assert_int_equal(tobi_world_count(world, TOBI_FLUID), 1);
    return world;
}

/* One step of dt = 1 s of particle and plate, without the fluid's own forces; x: where the particle is. */
static void step(tobi_system *s, const double way[3], double x[3])
{
    tobi_error err;
    double speed = 0;
    s->dt = 1;
    assert_int_equal(tobi_body_predict(&s->sim->bodies[0], 0, s->dt, &speed, &err), TOBI_OK);
    tobi_cells_sort(&s->cells, &s->box, &s->particles, NULL, &s->sim->exec);
    assert_int_equal(tobi_boundary_search(s, &err), TOBI_OK);
    assert_int_equal(tobi_boundary_measure(s, &err), TOBI_OK);
    double *p = &s->particles.position[0].x;
    float *v = &s->particles.velocity[0].x;
    for (int a = 0; a < 3; a++) {
        p[a] += way[a];
        v[a] = (float)way[a];
    }
    assert_int_equal(tobi_body_advance(&s->sim->bodies[0], s->dt, s->dt, &err), TOBI_OK);
    tobi_push_out(s);
    for (int a = 0; a < 3; a++) x[a] = p[a] - 0.2;
}

/* Both meet: the particle goes 6 mm one way, the plate 3 mm the other. */
static void stays_on_its_side(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++)
        for (int side = -1; side <= 1; side += 2) {
            double way[3] = {-side*0.006, 0.001, 0}, x[3];
            course c = {.velocity = {side*0.003, 0, 0}};
            tobi_world *world = make_world(dimension, side*SPACING/2, &c);
            tobi_system *s = &world->system[0];
            step(s, way, x);
            double gap = side*(x[0] - side*0.003) - THICKNESS/2;
            assert_true(fabs(gap - 0.2*SPACING) < 1e-9);
            assert_int_equal(sph_of(s)->links.contacts, 1);
            assert_true(fabs(s->particles.velocity[0].x - side*0.003) < 1e-8);   /* the plate's */
            assert_true(fabs(s->particles.velocity[0].y - 0.001) < 1e-8);
            double mass = s->smoothing.volume*1000;
            assert_true(fabs(s->sim->bodies[0].load[0].pressure[0] + side*mass*0.009) < 1e-6*mass);
            tobi_world_destroy(world);
        }
}

/* A plate that turns by half a radian past the particle. */
static void stays_ahead_of_a_turn(void **state)
{
    (void)state;
    double way[3] = {0, 0, 0}, x[3];
    course c = {.spin = 0.5};
    tobi_world *world = make_world(3, 0.002, &c);
    tobi_system *s = &world->system[0];
    s->particles.position[0].z = 0.2 + 0.04;      /* the plate there moves 19 mm */
    step(s, way, x);
    assert_true(cos(0.5)*x[0] - sin(0.5)*x[2] > THICKNESS/2 + 0.19*SPACING);
    tobi_world_destroy(world);
}

/* Past the edge there is nothing in the way, and one that goes along or away is left alone. */
static void goes_where_nothing_is(void **state)
{
    (void)state;
    double past[3] = {-0.008, 0, 0}, away[3] = {0.009, -0.004, 0}, x[3];
    course c = {.spin = 0};
    for (int k = 0; k < 2; k++) {
        tobi_world *world = make_world(3, SPACING/2, &c);
        tobi_system *s = &world->system[0];
        double start = SPACING/2;
        if (k == 0) s->particles.position[0].y = 0.2 + (start = 0.0525);
        step(s, k ? away : past, x);
        assert_true(fabs(x[0] - (SPACING/2 + (k ? away : past)[0])) < 1e-12);
        assert_true(fabs(x[1] - (start + (k ? away : past)[1])) < 1e-12);
        assert_int_equal(sph_of(s)->links.contacts, 0);
        tobi_world_destroy(world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stays_on_its_side),
        cmocka_unit_test(stays_ahead_of_a_turn),
        cmocka_unit_test(goes_where_nothing_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

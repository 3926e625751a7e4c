/* Solids that a body holds which changes its shape by a motion: they go along, the body feels their mass, and
   what is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include "calls.h"
#include "mpm/contact/clamp.h"
#include "mpm/particle_fields.h"
#include "clamp_rig.h"
#include "world/world.h"

static const double SPACING = 0.0125;

/* A tile of rubber of 0.2 m x 0.05 m, half of it in a bar that bends; no gravity. */
static setup make_setup(int dimension, tobi_motion_fn motion)
{
    setup s = { solid_default(dimension, SPACING, 0.1), tobi_default_body_def() };
    for (int a = 0; a < dimension; a++) {
        s.solid.world.domain_min[a] = -0.5;
        s.solid.world.domain_max[a] = 0.5;
        s.solid.fill.box_min[a] = a == 0 ? -0.1 : -0.025;
        s.solid.fill.box_max[a] = a == 0 ? 0.1 : 0.025;
        s.body.box_min[a] = a == 0 ? -0.2 : -0.1;
        s.body.box_max[a] = a == 0 ? 0.2 : a == 1 ? 0 : 0.1;
    }
    for (int a = 0; a < 3; a++) s.solid.world.gravity[a] = 0;
    s.solid.solid.name = "tile";
    s.solid.solid.youngs_modulus = 1e5;
    s.solid.solid.clamped_to = s.body.name = "bar";
    s.body.motion = motion;
    return s;
}

static pthread_t asking;
static int asked_elsewhere;              /* 1: by another thread than that which steps the world */

/* A wave along x, of its full height from the start, so that the bar begins bent; it sets off within
   0.1 s. */
static tobi_status wave(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                        tobi_error *err)
{
    (void)user, (void)err;
    if (!pthread_equal(asking, pthread_self())) asked_elsewhere = 1;
    const double phase = t < 0.1 ? 10*t*t/0.1 : 20*t - 1;
    for (int64_t i = 0; i < n; i++) {
        memcpy(out[i], rest[i], sizeof out[i]);
        out[i][1] += 0.005*sin(12*rest[i][0] - phase + 1);
        out[i][0] += 0.03*rest[i][1]*cos(phase);
    }
    return TOBI_OK;
}

/* Held particles stay where the motion has the places in which they started, also by way of a file. */
static void a_tile_goes_with_the_wave(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        setup s = make_setup(dimension, wave);
        tobi_world *world = make_world(&s);
        const tobi_system *solids = tobi_world_solids(world);
        const tobi_particles *p = &solids->particles;
        const tobi_body *b = &world->sim.bodies[0];
        int64_t held = 0;
        for (int64_t i = 0; i < p->count; i++) held += mpm_clamp_body(solids, i) >= 0;
        if (dimension == 2) assert_in_range(held, 16*2, 16*4);
        double most = 0, first = 0;
        while (world->sim.time < 0.4) {
            for (int64_t i = 0; i < p->count; i++) {
                double rest[1][3], now[1][3], square = 0;
                if (mpm_clamp_body(solids, i) < 0) continue;
                for (int a = 0; a < 3; a++)
                    rest[0][a] = b->rest.centre[a] + (double)(&mpm_fields_of(p)->clamp[i].x)[a];
                wave(NULL, world->sim.time, 1, (const double (*)[3])rest, now, NULL);
                for (int a = 0; a < dimension; a++)
                    square += pow(now[0][a] - b->lower[a] - (&p->position[i].x)[a], 2);
                most = fmax(most, sqrt(square));
            }
            if (world->sim.time == 0) first = most;
            solid_step(world, 10);
        }
        if (!(first < 1e-4*SPACING)) fail_msg("a particle starts %g m from its place", first);
        if (!(most < 0.1*SPACING)) fail_msg("%d-D: a particle strays by %g m", dimension, most);
        tobi_world_destroy(world);
    }
}

/* x = a t^2/2 of what lies at y = 0, and a shear that grows with it: what deforms feels the force of its
   mass as a rigid body does, in each step what the tile gets. */
static const double ACCELERATION = 10;

static tobi_status drive(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                         tobi_error *err)
{
    (void)user, (void)err;
    const double w = 3.14159265358979/0.02;
    const double more = t - 0.02;
    const double way = more < 0 ? 0.5*ACCELERATION*(0.5*t*t - (1 - cos(w*t))/(w*w))
                                : 0.5*ACCELERATION*(2e-4 - 2/(w*w) + 0.02*more + more*more);
    for (int64_t i = 0; i < n; i++) {
        memcpy(out[i], rest[i], sizeof out[i]);
        out[i][0] += way*(1 + 0.5*rest[i][1]);
    }
    return TOBI_OK;
}

static void a_deforming_body_feels_the_mass(void **state)
{
    (void)state;
    setup s = make_setup(2, drive);
    tobi_world *world = make_world(&s);
    tobi_system *solids = tobi_world_solids(world);
    double mean = 0, span = 0;
    while (world->sim.time < 0.15) {
        tobi_body_info info;
        tobi_system_measure(solids);
        const double before = solids->info.momentum[0];
        solid_step(world, 1);
        tobi_system_measure(solids);
        tobi_world_body(world, 0, &info);
        const double force = info.pressure_force[0], dt = world->sim.dt;
        assert_float_equal(-force*dt, solids->info.momentum[0] - before, 1e-5);
        if (world->sim.time < 0.05) continue;
        mean += force*dt;
        span += dt;
    }
    assert_float_equal(mean/span, -10*ACCELERATION, 0.01*10*ACCELERATION);
    tobi_world_destroy(world);
}

static tobi_status turn(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                        tobi_error *err)
{
    (void)user, (void)err;
    const double angle = 40*t*t, c = cos(angle), d = sin(angle);
    for (int64_t i = 0; i < n; i++) {
        out[i][0] = c*rest[i][0] - d*rest[i][1];
        out[i][1] = d*rest[i][0] + c*rest[i][1];
        out[i][2] = rest[i][2];
    }
    return TOBI_OK;
}

/* A turn that does not tell that it is rigid does what one does that tells. */
static void a_rigid_motion_is_the_same(void **state)
{
    (void)state;
    double *at[2], most = 0, torque[2];
    int64_t count = 0;
    for (int rigid = 0; rigid < 2; rigid++) {
        setup s = make_setup(2, turn);
        tobi_body_info info;
        s.body.motion_rigid = rigid;
        tobi_world *world = make_world(&s);
        for (int k = 0; k < 300; k++) OK(tobi_world_step(world, 3e-4, NULL, &err));
        count = tobi_world_count(world, TOBI_FLUID);
        at[rigid] = solid_read(world, "position", 3);
        tobi_world_body(world, 0, &info);
        torque[rigid] = info.pressure_torque[2];
        tobi_world_destroy(world);
    }
    for (int64_t i = 0; i < 3*count; i++) most = fmax(most, fabs(at[1][i] - at[0][i]));
    assert_true(most < 1e-5*SPACING);
    assert_true(fabs(torque[1]) > 1);
    assert_float_equal(torque[0], torque[1], 1e-4);
    for (int k = 0; k < 2; k++) free(at[k]);
}

/* Also: a script has one channel, so that one thread asks. */
static void the_same_bits(void **state)
{
    (void)state;
    asking = pthread_self();
    asked_elsewhere = 0;
    setup s = make_setup(2, wave);
    tobi_world *world[3];
    for (int n = 0; n < 3; n++) {
        s.solid.world.threads = (int[]){ 1, 3, 2 }[n];
        world[n] = make_world(&s);
    }
    solid_check_bits(world[0], world[1], world[2]);
    for (int n = 0; n < 3; n++) tobi_world_destroy(world[n]);
    assert_false(asked_elsewhere);
}

/* Nothing comes to lie below the fold, whence the tile sticks out of the bar. */
static tobi_status fold(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                        tobi_error *err)
{
    (void)user, (void)err, (void)t;
    for (int64_t i = 0; i < n; i++) {
        memcpy(out[i], rest[i], sizeof out[i]);
        out[i][1] = -fabs(rest[i][1]);
    }
    return TOBI_OK;
}

static void a_fold_is_refused(void **state)
{
    (void)state;
    setup s = make_setup(2, fold);
    tobi_world *world = solid_world(&s.solid);
    OK(tobi_world_add_body(world, &s.body, &err));
    REFUSED(tobi_world_start(world, &err), TOBI_INVALID, "the motion of body 'bar' takes no place to");
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tile_goes_with_the_wave), cmocka_unit_test(a_deforming_body_feels_the_mass),
        cmocka_unit_test(a_rigid_motion_is_the_same), cmocka_unit_test(the_same_bits),
        cmocka_unit_test(a_fold_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

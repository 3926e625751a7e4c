/* Solids that a rigid body holds: forces on a body that is moved, momentum with a free one, turns, restarts,
   water beside them; what is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "calls.h"
#include "mpm/contact/clamp.h"
#include "mpm/particle_fields.h"
#include "clamp_rig.h"
#include "world/world.h"

static const double PI = 3.14159265358979;

/* A block of 0.1 m and 1 kg that stands on a plate of 0.2 m, half of it inside; no gravity. */
static setup make_setup(void)
{
    setup s = { solid_default(3, 0.0125, 0.1), tobi_default_body_def() };
    for (int a = 0; a < 3; a++) {
        s.solid.world.domain_min[a] = -1;
        s.solid.world.domain_max[a] = 1;
        s.solid.world.gravity[a] = 0;
        s.solid.fill.box_min[a] = -0.05;
        s.solid.fill.box_max[a] = 0.05;
        s.body.box_min[a] = -0.1;
        s.body.box_max[a] = a == 2 ? 0 : 0.1;
    }
    s.solid.solid.name = "block";
    s.solid.solid.youngs_modulus = 1e5;
    s.solid.solid.clamped_to = s.body.name = "plate";
    return s;
}

/* Largest distance of held particles from their places, m; *held: how many there are. */
static double find_stray(const tobi_world *world, int64_t *held)
{
    const tobi_system *s = tobi_world_solids(world);
    const tobi_rigid *r = &world->sim.bodies[0].rigid;
    double most = 0, m[3][3];
    tobi_quaternion_matrix(r->orientation, m);
    *held = 0;
    for (int64_t i = 0; i < s->particles.count; i++) {
        const tobi_float4 rest = mpm_fields_of(&s->particles)->clamp[i];
        double square = 0;
        if (mpm_clamp_body(s, i) < 0) continue;
        for (int a = 0; a < 3; a++) {
            const double place = r->position[a] + m[a][0]*rest.x + m[a][1]*rest.y + m[a][2]*rest.z,
                         way = (&s->particles.position[i].x)[a] - place;
            square += way*way;
        }
        most = fmax(most, sqrt(square));
        *held += 1;
    }
    return most;
}

static double find_momentum(tobi_world *world, int axis)
{
    tobi_system *s = tobi_world_solids(world);
    tobi_system_measure(s);
    return s->info.momentum[axis];
}

/* x = a t^2/2, smoothly from rest within 0.02 s. */
static const double ACCELERATION = 20, EASE = 0.02;

static double find_way(double t)
{
    const double w = PI/EASE;
    if (t < EASE) return 0.5*ACCELERATION*(0.5*t*t - (1 - cos(w*t))/(w*w));
    return find_way(EASE*(1 - 1e-15)) + 0.5*ACCELERATION*EASE*(t - EASE) +
           0.5*ACCELERATION*(t - EASE)*(t - EASE);
}

static tobi_status drive(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                         tobi_error *err)
{
    (void)user, (void)err;
    for (int64_t i = 0; i < n; i++) {
        memcpy(out[i], rest[i], sizeof out[i]);
        out[i][0] += find_way(t);
    }
    return TOBI_OK;
}

/* The plate feels mass times acceleration, and what it loses the block gets, in every step. */
static void a_driven_body_feels_the_mass(void **state)
{
    (void)state;
    setup s = make_setup();
    s.body.motion = drive;
    s.body.motion_rigid = 1;
    tobi_world *world = make_world(&s);
    double mean = 0, span = 0;
    int64_t held;
    while (world->sim.time < 0.2) {
        const double before = find_momentum(world, 0);
        tobi_body_info info;
        solid_step(world, 1);
        tobi_world_body(world, 0, &info);
        const double force = info.pressure_force[0], dt = world->sim.dt;
        assert_float_equal(-force*dt, find_momentum(world, 0) - before, 1e-5);
        if (world->sim.time < 0.08) continue;
        mean += force*dt;
        span += dt;
    }
    assert_float_equal(mean/span, -1.0*ACCELERATION, 0.02*ACCELERATION);
    const double stray = find_stray(world, &held);
    if (!(stray < 0.03*0.0125)) fail_msg("a particle strays by %g m", stray);
    assert_int_equal(held, 8*8*5);             /* those inside, and a layer above */
    tobi_world_destroy(world);
}

static tobi_status turn(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                        tobi_error *err)
{
    (void)user, (void)err;
    const double angle = 2*PI*(t - sin(2*PI*t/0.4)*0.4/(2*PI))/0.4, c = cos(angle), d = sin(angle);
    for (int64_t i = 0; i < n; i++) {
        out[i][0] = rest[i][0];
        out[i][1] = c*rest[i][1] - d*rest[i][2];
        out[i][2] = d*rest[i][1] + c*rest[i][2];
    }
    return TOBI_OK;
}

/* After one turn about x within 0.4 s all is where it was. */
static void a_turn_brings_it_back(void **state)
{
    (void)state;
    setup s = make_setup();
    s.body.motion = turn;
    s.body.motion_rigid = 1;
    tobi_world *world = make_world(&s);
    int64_t held;
    double most = 0;
    OK(tobi_world_advance(world, 0.2, NULL, &err));
    assert_true(find_stray(world, &held) < 0.02*0.0125);
    OK(tobi_world_advance(world, 0.4, NULL, &err));
    assert_true(find_stray(world, &held) < 0.01*0.0125);
    const tobi_particles *p = &tobi_world_solids(world)->particles;
    for (int64_t i = 0; i < p->count; i++) {
        const tobi_float4 rest = mpm_fields_of(p)->rest[i];
        for (int a = 0; a < 3; a++)
            most = fmax(most, fabs((&p->position[i].x)[a] - (double)(&rest.x)[a]));
    }
    if (!(most < 0.004)) fail_msg("a particle is %g m away", most);     /* it still swings a little */
    tobi_world_destroy(world);
}

/* Body and block fall and turn together. Momentum is that of gravity, and a body of a hundredth of the mass
   stays with what it holds. */
static void a_free_body_keeps_momentum(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        setup s = make_setup();
        s.body.dynamics = TOBI_FREE;
        s.body.mass = (double[]){ 10, 1, 0.01 }[k];
        s.body.angular_velocity[1] = k < 2 ? 3 : 0;
        s.body.velocity[0] = 0.3;
        s.solid.fill.velocity[0] = 0.3;
        s.solid.world.gravity[2] = -9.81;
        tobi_world *world = make_world(&s);
        const tobi_rigid *r = &world->sim.bodies[0].rigid;
        int64_t held;
        for (double t = 0.05; t < 0.301; t += 0.05) {
            OK(tobi_world_advance(world, t, NULL, &err));
            const double mass = r->mass, fall = -9.81*world->sim.time;
            const double along = mass*r->velocity[0] + find_momentum(world, 0),
                         down = mass*r->velocity[2] + find_momentum(world, 2);
            assert_float_equal(along, 0.3*(mass + 1), 1e-4*(mass + 1));
            assert_float_equal(down, fall*(mass + 1), 1e-3*(mass + 1));
            const double stray = find_stray(world, &held);
            if (!(stray < 0.02*0.0125)) fail_msg("mass %g: a particle strays by %g m", mass, stray);
        }
        tobi_world_destroy(world);
    }
}

/* Without gravity nothing pushes: no force, and nothing moves against anything. */
static void a_free_fall_has_no_force(void **state)
{
    (void)state;
    setup s = make_setup();
    s.body.dynamics = TOBI_FREE;
    s.solid.world.gravity[2] = -9.81;
    tobi_world *world = make_world(&s);
    for (int k = 0; k < 200; k++) {
        tobi_body_info info;
        solid_step(world, 1);
        tobi_world_body(world, 0, &info);
        if (k > 1) assert_float_equal(info.pressure_force[2], 0, 0.02*9.81);
    }
    tobi_world_destroy(world);
}

static void the_same_bits(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        setup s = make_setup();
        tobi_world *world[3];
        s.solid.world.gravity[2] = -9.81;
        if (k == 0) s.body.motion = turn, s.body.motion_rigid = 1;
        else s.body.dynamics = TOBI_FREE;
        for (int n = 0; n < 3; n++) {
            s.solid.world.threads = (int[]){ 1, 3, 2 }[n];
            world[n] = make_world(&s);
        }
        solid_check_bits(world[0], world[1], world[2]);
        for (int n = 0; n < 3; n++) tobi_world_destroy(world[n]);
    }
}

static void refuse(setup s, tobi_status status, const char *words)
{
    tobi_world *world = solid_world(&s.solid);
    OK(tobi_world_add_body(world, &s.body, &err));
    REFUSED(tobi_world_start(world, &err), status, words);
    tobi_world_destroy(world);
}

static void what_is_refused(void **state)
{
    (void)state;
    setup s = make_setup();
    s.solid.solid.clamped_to = "plat";
    refuse(s, TOBI_NOT_FOUND, "is clamped to 'plat', which is no body");
    s = make_setup();
    s.solid.solid.model = TOBI_STATIONARY;
    refuse(s, TOBI_INVALID, "can not be held");
    s = make_setup();
    s.body.absent_from = 1;
    refuse(s, TOBI_UNSUPPORTED, "is absent for a time; such a body holds no solid");
    s = make_setup();
    s.solid.fill.box_min[2] = 0.02;
    s.solid.fill.box_max[2] = 0.1;
    refuse(s, TOBI_INVALID, "nearer than a spacing, 0.0125 m, to it");
}

/* Water beside a block on a plate that moves: the same with the substeps of the solid, and particles inside
   the plate are none for the water. */
static void water_sees_what_is_outside(void **state)
{
    (void)state;
    setup s = make_setup();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def water = tobi_default_fill_def();
    tobi_world *world;
    int64_t held;
    s.solid.world.method = "dfsph";
    s.solid.world.spacing = 0.0125;
    s.solid.world.time_step = 0.1;       /* one step of the water, before the block meets it */
    s.body.motion = drive;
    s.body.motion_rigid = 1;
    for (int a = 0; a < 3; a++) {
        s.solid.world.domain_min[a] = -0.2;
        s.solid.world.domain_max[a] = a == 0 ? 0.6 : 0.2;
        water.box_min[a] = a == 0 ? 0.15 : -0.1;
        water.box_max[a] = a == 0 ? 0.3 : 0.1;
    }
    OK(tobi_world_create(&s.solid.world, NULL, &world, &err));
    OK(tobi_world_add_fluid(world, &fluid, &water, 1, &err));
    OK(tobi_world_add_solid(world, &s.solid.solid, &s.solid.fill, 1, &err));
    OK(tobi_world_add_body(world, &s.body, &err));
    OK(tobi_world_start(world, &err));
    OK(tobi_world_advance(world, 0.1, NULL, &err));
    assert_true(find_stray(world, &held) < 0.02*0.0125);
    tobi_system *solids = tobi_world_solids(world);
    OK(solids->method->points(solids, &err));          /* rows may have been sorted since */
    for (int64_t i = 0; i < solids->particles.count; i++) {
        const int inside = mpm_fields_of(&solids->particles)->rest[i].z < 0.2;
        assert_int_equal(world->sim.soft.size[i].volume == 0, inside);
    }
    tobi_world_destroy(world);
}

/* J: of the block on its plate, which bears its weight for half a second, with sides of the domain at the
   plate's lower end and, in a corner, at its left. */
static double strain_at_sides(tobi_wall wall, double low, int corner)
{
    setup s = make_setup();
    s.solid.world.gravity[2] = -9.81;
    s.solid.world.domain_min[2] = low;
    s.body.box_min[2] = fmax(low, -0.1);
    if (corner) s.solid.world.domain_min[0] = s.body.box_min[0] = -0.05;
    s.solid.world.wall_min[0] = s.solid.world.wall_min[2] = wall;
    tobi_world *world = make_world(&s);
    OK(tobi_world_advance(world, 0.5, NULL, &err));
    const double strain = tobi_world_info(world)->elastic_energy;
    tobi_world_destroy(world);
    return strain;
}

/* What a clamp holds obeys no side: each stopped what the other moved, and the strain of what both held grew
   without bound. */
static void a_side_leaves_what_is_clamped(void **state)
{
    (void)state;
    static const tobi_wall walls[] = { TOBI_WALL_SLIP, TOBI_WALL_NO_SLIP, TOBI_WALL_SEPARATE };
    const double alone = strain_at_sides(TOBI_WALL_SEPARATE, -1, 0);
    for (size_t k = 0; k < sizeof walls/sizeof *walls; k++)
        for (int corner = 0; corner < 2; corner++) {
            const double strain = strain_at_sides(walls[k], corner ? -0.05 : -0.0625, corner);
            if (fabs(strain/alone - 1) > 0.1)
                fail_msg("side %d, corner %d: %g J, %g J without sides", walls[k], corner, strain, alone);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_side_leaves_what_is_clamped),
        cmocka_unit_test(a_driven_body_feels_the_mass), cmocka_unit_test(a_turn_brings_it_back),
        cmocka_unit_test(a_free_body_keeps_momentum), cmocka_unit_test(a_free_fall_has_no_force),
        cmocka_unit_test(the_same_bits), cmocka_unit_test(what_is_refused),
        cmocka_unit_test(water_sees_what_is_outside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Solids that several bodies hold: the pull of a band on each, momenta, whose a particle is, joints between
   the bodies, restarts; what is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "calls.h"
#include "mpm/contact/clamp.h"
#include "mpm/particle_fields.h"
#include "solid_rig.h"
#include "momenta_rig.h"
#include "world/world.h"

static const double SPACING = 0.0125, FREE = 0.2, DEEP = 0.025, WIDTH = 0.05, MODULUS = 1e5;

/* A band of rubber along x between two blocks; it reaches DEEP into each. No gravity. */
typedef struct setup { solid_setup solid; tobi_body_def body[2]; int dimension; } setup;

static setup make_setup(int dimension)
{
    setup s = { solid_default(dimension, SPACING, 0.1), { tobi_default_body_def(), tobi_default_body_def() },
                dimension };
    for (int a = 0; a < dimension; a++) {
        s.solid.world.domain_min[a] = -0.6;
        s.solid.world.domain_max[a] = 0.6;
        s.solid.fill.box_min[a] = -0.5*WIDTH;
        s.solid.fill.box_max[a] = 0.5*WIDTH;
        for (int k = 0; k < 2; k++) {
            s.body[k].box_min[a] = -0.05;
            s.body[k].box_max[a] = 0.05;
        }
    }
    for (int a = 0; a < 3; a++) s.solid.world.gravity[a] = 0;
    s.solid.fill.box_min[0] = -0.5*FREE - DEEP;
    s.solid.fill.box_max[0] = 0.5*FREE + DEEP;
    for (int k = 0; k < 2; k++) {
        s.body[k].box_min[0] = k ? 0.5*FREE : -0.5*FREE - 0.1;
        s.body[k].box_max[0] = s.body[k].box_min[0] + 0.1;
        s.body[k].name = k ? "right" : "left";
        s.body[k].density = k ? 2000 : 500;
    }
    s.solid.solid.name = "band";
    s.solid.solid.youngs_modulus = MODULUS;
    s.solid.solid.poissons_ratio = 0;
    s.solid.solid.clamped_to = "left,right";
    return s;
}

static tobi_world *make_world(const setup *s, int joined)
{
    tobi_world *world = solid_world(&s->solid);
    for (int k = 0; k < 2; k++) OK(tobi_world_add_body(world, &s->body[k], &err));
    if (joined) {
        tobi_joint_def joint = tobi_default_joint_def();
        joint.name = "pin";
        joint.body = "left";
        joint.to_body = "right";
        joint.point[1] = 0.1;
        OK(tobi_world_add_joint(world, &joint, &err));
    }
    OK(tobi_world_start(world, &err));
    return world;
}

/* Two bodies that the band pulls together while they turn, in 2-D, 3-D and with a pin between them. APIC: the
   other transfers lose a little of what particles turn. Over the momentum of all at 0.5 m/s. */
static void two_free_bodies_and_a_band_keep_their_momenta(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        const int dimension = k == 1 ? 3 : 2;
        setup s = make_setup(dimension);
        for (int b = 0; b < 2; b++) {
            s.body[b].dynamics = TOBI_FREE;
            s.body[b].velocity[0] = b ? 0.4 : -0.5;
            s.body[b].velocity[1] = 0.3;
            s.body[b].angular_velocity[2] = b ? 2 : -3;
            if (dimension == 3) s.body[b].angular_velocity[0] = b ? 1 : 4;
        }
        if (k == 2) s.body[0].velocity[0] = s.body[1].velocity[0] = 0;
        s.solid.fill.velocity[1] = 0.3;
        s.solid.method.transfer = TOBI_APIC;
        tobi_world *world = make_world(&s, k == 2);
        double momentum[2][3], spin[2][3], size = 0, turn = 0, most = 0, off = 0;
        find_momenta(world, momentum[0], spin[0]);
        for (int b = 0; b < 2; b++) {
            size += world->sim.bodies[b].rigid.mass*0.5;
            turn += world->sim.bodies[b].rigid.mass*0.5*0.15;
        }
        while (world->sim.time < 0.3) {
            solid_step(world, 1);
            find_momenta(world, momentum[1], spin[1]);
            for (int a = 0; a < 3; a++) {
                most = fmax(most, fabs(momentum[1][a] - momentum[0][a])/size);
                off = fmax(off, fabs(spin[1][a] - spin[0][a])/turn);
            }
        }
        if (!(most < 1e-6)) fail_msg("case %d: momentum is off by %g", k, most);
        if (!(off < 3e-6)) fail_msg("case %d: angular momentum is off by %g", k, off);
        tobi_world_destroy(world);
    }
}

/* The right block goes STRETCH away within 0.1 s; at rest the band pulls each by E A (s - 1/s)/2, s = 1.02:
   that of neo-Hookean rubber without lateral strain. */
static const double STRETCH = 0.004;

static tobi_status pull(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                        tobi_error *err)
{
    (void)user, (void)err;
    const double share = t < 0.1 ? 0.5 - 0.5*cos(31.41592653589793*t) : 1;
    for (int64_t i = 0; i < n; i++) {
        memcpy(out[i], rest[i], sizeof out[i]);
        out[i][0] += STRETCH*share;
    }
    return TOBI_OK;
}

static void a_band_pulls_both_bodies(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        setup s = make_setup(dimension);
        s.body[1].motion = pull;
        s.body[1].motion_rigid = 1;
        s.solid.solid.damping = 30;
        tobi_world *world = make_world(&s, 0);
        const double area = dimension == 2 ? WIDTH : WIDTH*WIDTH, longer = 1 + STRETCH/FREE,
                     force = 0.5*MODULUS*area*(longer - 1/longer);
        double sum[2] = { 0 }, span = 0;
        while (world->sim.time < 0.5) {
            solid_step(world, 1);
            if (world->sim.time < 0.4) continue;
            for (int k = 0; k < 2; k++) {
                tobi_body_info info;
                tobi_world_body(world, k, &info);
                sum[k] += info.pressure_force[0]*world->sim.dt;
            }
            span += world->sim.dt;
        }
        for (int k = 0; k < 2; k++) assert_float_equal(sum[k]/span/force, k ? -1 : 1, 0.02);
        tobi_world_destroy(world);
    }
}

static void the_same_bits(void **state)
{
    (void)state;
    setup s = make_setup(2);
    tobi_world *world[3];
    s.body[0].dynamics = TOBI_FREE;
    s.body[0].velocity[1] = 0.5;
    s.body[1].motion = pull;
    s.body[1].motion_rigid = 1;
    for (int n = 0; n < 3; n++) {
        s.solid.world.threads = (int[]){ 1, 3, 2 }[n];
        world[n] = make_world(&s, 0);
    }
    solid_check_bits(world[0], world[1], world[2]);
    for (int n = 0; n < 3; n++) tobi_world_destroy(world[n]);
}

static int64_t count_held(const tobi_world *world, int body)
{
    const tobi_system *s = tobi_world_solids(world);
    int64_t held = 0;
    for (int64_t i = 0; i < s->particles.count; i++) held += mpm_clamp_body(s, i) == body;
    return held;
}

/* Two blocks that overlap, as beams of a frame do at a corner. What lies in both belongs to the first named,
   what lies in one and near the other to the one that it lies in; and nothing moves. */
static void the_first_named_holds_what_lies_in_two(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        setup s = make_setup(2);
        s.body[0].box_max[0] = 0.2*SPACING;           /* the band: 20 x 4 particles, the middle at 0 */
        s.body[1].box_min[0] = k ? -3.8*SPACING : 0.2*SPACING;
        s.solid.solid.clamped_to = k ? "right,left" : "left,right";
        tobi_world *world = make_world(&s, 0);
        assert_int_equal(count_held(world, 0), k ? 4*6 : 4*10);
        assert_int_equal(count_held(world, 1), k ? 4*14 : 4*10);
        solid_step(world, 100);
        const tobi_particles *p = &tobi_world_solids(world)->particles;
        for (int64_t i = 0; i < p->count; i++)
            for (int a = 0; a < 2; a++)
                assert_float_equal((&p->position[i].x)[a] - (double)(&mpm_fields_of(p)->rest[i].x)[a], 0,
                                   1e-6*SPACING);
        tobi_world_destroy(world);
    }
}

static void refuse(setup s, tobi_status status, const char *words, const char *key)
{
    tobi_world *world = solid_world(&s.solid);
    tobi_error err = { 0 };
    for (int k = 0; k < 2; k++) OK(tobi_world_add_body(world, &s.body[k], &err));
    assert_int_equal(tobi_world_start(world, &err), status);
    if (!strstr(err.text, words)) fail_msg("'%s' without '%s'", err.text, words);
    assert_string_equal(err.key, key);
    tobi_world_destroy(world);
}

static void what_is_refused(void **state)
{
    (void)state;
    setup s = make_setup(2);
    s.solid.solid.clamped_to = "left,right,left";
    refuse(s, TOBI_INVALID, "is clamped to 'left' twice", "solids[0].clamped_to[2]");
    s.solid.solid.clamped_to = "left,,right";
    refuse(s, TOBI_NOT_FOUND, "is clamped to '', which is no body", "solids[0].clamped_to[1]");
    s.solid.solid.clamped_to = "left,right";
    for (int k = 0; k < 2; k++) s.body[1].box_min[0] += 0.1, s.body[1].box_max[0] += 0.1;
    refuse(s, TOBI_INVALID, "and belongs to no body named before", "solids[0].clamped_to[1]");
}

/* The band begins at the faces of the blocks, so that all of it is there whoever holds it. */
static void a_file_of_other_clamps_is_refused(void **state)
{
    (void)state;
    setup s = make_setup(2);
    char path[] = "/tmp/tobiuo_clamp_XXXXXX";
    s.solid.fill.box_min[0] += DEEP;
    s.solid.fill.box_max[0] -= DEEP;
    tobi_world *both = make_world(&s, 0);
    s.solid.solid.clamped_to = "left";
    tobi_world *one = make_world(&s, 0);
    close(mkstemp(path));
    OK(tobi_world_save(both, path, &err));
    REFUSED(tobi_world_load(one, path, &err), TOBI_INVALID, "is held by a body to which this one does not");
    OK(tobi_world_save(one, path, &err));
    OK(tobi_world_load(both, path, &err));
    unlink(path);
    tobi_world_destroy(both);
    tobi_world_destroy(one);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_free_bodies_and_a_band_keep_their_momenta),
        cmocka_unit_test(a_band_pulls_both_bodies), cmocka_unit_test(the_same_bits),
        cmocka_unit_test(the_first_named_holds_what_lies_in_two), cmocka_unit_test(what_is_refused),
        cmocka_unit_test(a_file_of_other_clamps_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

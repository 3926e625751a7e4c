/* Swimmers and soft solids: contact and clamps keep the momenta of both together, what a swimmer touches
   stays outside, what it holds stays in its place; restarts and threads, in water too. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include "calls.h"
#include "clamp_rig.h"
#include "mpm/contact/clamp.h"
#include "momenta_rig.h"

static const double SPACING = 0.025, BEAT = 24, BEATEN = 0.27;
enum { TOUCHES, HOLDS };

/* A plate of 0.4 m by 0.06 m about (0, 0) that beats its ends, from rest. */
static tobi_status beat(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                        tobi_error *err)
{
    (void)user, (void)err;
    for (int64_t i = 0; i < n; i++) {
        memcpy(out[i], rest[i], sizeof out[i]);
        out[i][1] += 0.5*rest[i][0]*rest[i][0]*(1 - cos(BEAT*t));
    }
    return TOBI_OK;
}

/* A block of rubber above one end of the plate, or a fin that starts in its other end; no gravity. */
static setup make_setup(int kind, int dimension)
{
    setup s = { solid_default(dimension, SPACING, 0.1), tobi_default_body_def() };
    for (int a = 0; a < dimension; a++) {
        s.solid.world.domain_min[a] = -0.6;
        s.solid.world.domain_max[a] = 0.6;
        s.solid.fill.box_min[a] = -0.025;
        s.solid.fill.box_max[a] = 0.025;
        s.body.box_min[a] = a == 0 ? -0.2 : -0.03;
        s.body.box_max[a] = a == 0 ? 0.2 : 0.03;
    }
    s.solid.fill.box_min[0] = kind == HOLDS ? -0.4 : 0;
    s.solid.fill.box_max[0] = kind == HOLDS ? -0.16 : 0.2;
    if (kind == TOUCHES) s.solid.fill.box_min[1] = 0.0425;
    if (kind == TOUCHES) s.solid.fill.box_max[1] = 0.1675;
    for (int a = 0; a < 3; a++) s.solid.world.gravity[a] = 0;
    s.solid.method.transfer = TOBI_APIC;
    s.solid.solid.name = "rubber";
    s.solid.solid.youngs_modulus = 1e5;
    s.solid.solid.clamped_to = kind == HOLDS ? "fish" : NULL;
    s.body.name = "fish";
    s.body.density = 1000;
    s.body.dynamics = TOBI_FREE;
    s.body.motion = beat;
    return s;
}

/* m: how deep a particle lies in the swimmer. */
static double find_depth(tobi_world *world)
{
    const tobi_particles *p = &tobi_world_solids(world)->particles;
    double deepest = 0;
    for (int64_t i = 0; i < p->count; i++) {
        tobi_bvh_hit hit;
        const double x[3] = {p->position[i].x, p->position[i].y, p->position[i].z};
        if (!tobi_bvh_closest(world->sim.bodies[0].bvh, x, SPACING, &hit)) continue;
        deepest = fmax(deepest, -hit.signed_distance);
    }
    return deepest;
}

/* Over the momenta of the swimmer's mass at 0.5 m/s, 0.2 m from the origin. Its ends come up by 0.04 m at up
   to 0.48 m/s: what it touches stays outside. */
static void momenta_are_kept(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        setup s = make_setup(k%2, 2 + k/2);
        if (k%2 == TOUCHES) s.body.velocity[1] = 0.1;
        tobi_world *world = make_world(&s);
        const tobi_rigid *r = &world->sim.bodies[0].rigid;
        double momentum[2][3], spin[2][3], start[3], most = 0, off = 0, given = 0, deepest = 0;
        memcpy(start, r->velocity, sizeof start);
        find_momenta(world, momentum[0], spin[0]);
        while (world->sim.time < BEATEN) {
            solid_step(world, 1);
            if (k%2 == TOUCHES) deepest = fmax(deepest, find_depth(world));
            find_momenta(world, momentum[1], spin[1]);
            for (int a = 0; a < 3; a++) {
                most = fmax(most, fabs(momentum[1][a] - momentum[0][a])/(0.5*r->mass));
                off = fmax(off, fabs(spin[1][a] - spin[0][a])/(0.2*r->mass));
                given = fmax(given, fabs(r->velocity[a] - start[a]));
            }
        }
        print_message("%d-D, %s: momentum is off by %.2g, angular momentum by %.2g; the swimmer's velocity "
                      "changed by %.2g m/s\n", 2 + k/2, k%2 == HOLDS ? "holds" : "touches", most, off, given);
        if (!(deepest == 0)) fail_msg("case %d: a particle lies %g m in the swimmer", k, deepest);
        if (!(given > 0.02)) fail_msg("case %d: the swimmer's velocity changed by %g m/s only", k, given);
        if (!(most < 1e-6)) fail_msg("case %d: momentum is off by %g", k, most);
        if (!(off < 3e-6)) fail_msg("case %d: angular momentum is off by %g", k, off);
        tobi_world_destroy(world);
    }
}

/* m: how far held particles are at most from where the swimmer has their places. */
static double find_stray(tobi_world *world)
{
    const tobi_system *s = tobi_world_solids(world);
    const tobi_particles *p = &s->particles;
    const tobi_body *b = &world->sim.bodies[0];
    double most = 0;
    for (int64_t i = 0; i < p->count; i++) {
        double rest[1][3], now[1][3], square = 0;
        if (mpm_clamp_body(s, i) < 0) continue;
        for (int a = 0; a < 3; a++)
            rest[0][a] = b->rest.centre[a] + (double)(&mpm_fields_of(p)->clamp[i].x)[a];
        OK(tobi_body_locate(b, world->sim.time, 1, (const double (*)[3])rest, now, &err));
        for (int a = 0; a < s->box.dimension; a++)
            square += pow(now[0][a] - b->lower[a] - (&p->position[i].x)[a], 2);
        most = fmax(most, sqrt(square));
    }
    return most;
}

/* The farthest that a held particle strays while the body beats, over spacings. */
static double beat_and_watch(int dimension, int dynamics)
{
    setup s = make_setup(HOLDS, dimension);
    s.body.dynamics = dynamics;
    tobi_world *world = make_world(&s);
    double most = find_stray(world);
    assert_true(most < 1e-4*SPACING);
    while (world->sim.time < BEATEN) {
        solid_step(world, 5);
        most = fmax(most, find_stray(world));
    }
    tobi_world_destroy(world);
    return most/SPACING;
}

/* As that of a body which a motion moves by the same shapes. */
static void what_it_holds_goes_along(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        const double most = beat_and_watch(dimension, TOBI_FREE);
        const double driven = beat_and_watch(dimension, TOBI_PRESCRIBED);
        print_message("%d-D: a held particle strays by %.3g spacings, from a driven body by %.3g\n",
                      dimension, most, driven);
        assert_true(most < 0.5 && most < 1.2*driven);
    }
}

/* As a shape that does not change. */
static tobi_status stand(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                         tobi_error *err)
{
    (void)user, (void)t, (void)err;
    memcpy(out, rest, (size_t)n*sizeof *out);
    return TOBI_OK;
}

/* The same in a box of water around both; with gravity the plate stands, and the water has a surface. */
static tobi_world *make_wet_world(const char *method, int kind, double gravity, int threads)
{
    setup s = make_setup(kind, 2);
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def water = tobi_default_fill_def();
    tobi_world *world;
    s.solid.world.method = method;
    s.solid.world.threads = threads;
    fluid.name = "water";
    for (int a = 0; a < 2; a++) {
        s.solid.world.domain_min[a] = water.box_min[a] = -0.45;
        s.solid.world.domain_max[a] = water.box_max[a] = 0.45;
    }
    s.solid.world.gravity[1] = -gravity;
    if (gravity > 0) {
        s.body.motion = stand;
        water.box_max[1] = 0.35;
    }
    OK(tobi_world_create(&s.solid.world, NULL, &world, &err));
    OK(tobi_world_add_fluid(world, &fluid, &water, 1, &err));
    OK(tobi_world_add_solid(world, &s.solid.solid, &s.solid.fill, 1, &err));
    OK(tobi_world_add_body(world, &s.body, &err));
    OK(tobi_world_start(world, &err));
    return world;
}

/* By isph both are pushed in water at rest, which is told; its figure is a miss that has no limit yet. By
   dfsph they sway. */
static void a_push_is_told(void **state)
{
    static const char *const methods[] = { "dfsph", "isph" };
    (void)state;
    for (int k = 0; k < 2; k++) {
        tobi_world *world = make_wet_world(methods[k], HOLDS, 9.81, 1);
        const tobi_rigid *r = &world->sim.bodies[0].rigid;
        int told = 0;
        for (int n = 0; tobi_world_note(world, n); n++)
            told += strstr(tobi_world_note(world, n), "between it and body 'fish' does not cancel") != NULL;
        assert_int_equal(told, k);
        OK(tobi_world_advance(world, SANITIZED ? 0.03 : 0.3, NULL, &err));
        print_message("%s: a plate with a fin goes at %.2g m/s in water at rest\n", methods[k],
                      r->velocity[0]);
        if (k == 0) assert_true(fabs(r->velocity[0]) < 0.05);
        tobi_world_destroy(world);
    }
}

static void bits(void **state)
{
    (void)state;
    static const char *const methods[] = { NULL, "dfsph", "isph" };
    for (int k = 0; k < 2*3; k++) {
        if (SANITIZED && (k == 3 || k == 4)) continue;
        setup s = make_setup(k%2, 2);
        tobi_world *world[3];
        for (int n = 0; n < 3; n++) {
            s.solid.world.threads = 1 + n;
            world[n] = k < 2 ? make_world(&s) : make_wet_world(methods[k/2], k%2, 0, 1 + n);
        }
        solid_check_bits(world[0], world[1], world[2]);
        for (int n = 0; n < 3; n++) tobi_world_destroy(world[n]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(momenta_are_kept),
        cmocka_unit_test(what_it_holds_goes_along),
        cmocka_unit_test(a_push_is_told),
        cmocka_unit_test(bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Joints where liquids and solids are in one scene: Archimedes, bodies that are held without joints,
   momentum, the same bits where nothing touches and after a restart. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "calls.h"
#include "world/world.h"

static const char *const methods[] = { "dfsph", "wcsph", "isph", "eisph", "mlsmpm" };
enum { METHODS = 4, BESIDE = 5 };           /* of liquids; with that of solids alone */
enum { STRIDE = SANITIZED ? METHODS : 2 };  /* in the long runs, 2: dfsph, isph; momentum_is_kept has all */
static const double SPACING = 0.0125, GRAVITY = 9.81;

/* A tank of 0.6 m, water in it, one block; 2-D. Boxes: x0, y0, x1, y1. */
typedef struct scene {
    const char *method;
    double gravity, water[4], stream;       /* m/s2; m; m/s, of the water along y                  */
    double block[4], density, modulus;
    const char *clamped_to;
    double step;                            /* s, the longest                                      */
} scene;

static void place(const double box[4], double lower[3], double upper[3])
{
    for (int a = 0; a < 2; a++) {
        lower[a] = box[a];
        upper[a] = box[2 + a];
    }
}

static void add_body(tobi_world *world, const char *name, const double box[4], double density)
{
    tobi_body_def def = tobi_default_body_def();
    def.name = name;
    def.dynamics = density > 0 ? TOBI_FREE : TOBI_PRESCRIBED;
    if (density > 0) def.density = density;
    place(box, def.box_min, def.box_max);
    OK(tobi_world_add_body(world, &def, &err));
}

static void join(tobi_world *world, const char *name, const char *body, const char *to, double x, double y)
{
    tobi_joint_def def = tobi_default_joint_def();
    def.name = name;
    def.body = body;
    def.to_body = to;
    def.point[0] = x;
    def.point[1] = y;
    OK(tobi_world_add_joint(world, &def, &err));
}

static tobi_world *open_world(const scene *s)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def water = tobi_default_fill_def();
    tobi_world *world;
    w.method = s->method;
    w.dimension = 2;
    w.spacing = SPACING;
    w.time_step_max = s->step;
    w.gravity[1] = -s->gravity;
    w.gravity[2] = 0;
    for (int a = 0; a < 2; a++) w.domain_max[a] = 0.6;
    place(s->water, water.box_min, water.box_max);
    water.velocity[1] = s->stream;
    OK(tobi_world_create(&w, NULL, &world, &err));
    if (strcmp(s->method, "mlsmpm") != 0) OK(tobi_world_add_fluid(world, &fluid, &water, 1, &err));
    return world;
}

/* After the bodies that hold it, as a scene does. */
static void add_block(tobi_world *world, const scene *s)
{
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    solid.name = "block";
    solid.youngs_modulus = s->modulus;
    solid.density = s->density;
    solid.clamped_to = s->clamped_to;
    place(s->block, fill.box_min, fill.box_max);
    OK(tobi_world_add_solid(world, &solid, &fill, 1, &err));
}

/* N, upward: means of what all joints do to their bodies, and of liquid and solids on the first body. */
typedef struct means { double joints, load, gap; } means;

static means average(tobi_world *world, double from, double to)
{
    means m = { 0 };
    double span = 0;
    while (world->sim.time < to) {
        tobi_body_info body;
        tobi_joint_info joint;
        OK(tobi_world_step(world, 1, NULL, &err));
        for (int k = 0; k < tobi_world_joint_count(world); k++) {
            tobi_world_joint(world, k, &joint);
            m.gap = fmax(m.gap, joint.gap);
            if (world->sim.time > from) m.joints += joint.force[1]*world->sim.dt;
        }
        if (world->sim.time <= from) continue;
        tobi_world_body(world, 0, &body);
        m.load += (body.pressure_force[1] + body.viscous_force[1])*world->sim.dt;
        span += world->sim.dt;
    }
    m.joints /= span;
    m.load /= span;
    return m;
}

/* A rod on a pin in deep water, with a soft bob clamped to its lower end. The pin carries weight less
   buoyancy; within 0.5 % what holds the same rod without a joint. */
static void a_pin_carries_weight_less_buoyancy(void **state)
{
    (void)state;
    const double rod[4] = { 0.275, 0.25, 0.325, 0.4 }, weight = 2000*0.05*0.15*GRAVITY,
                 archimedes = GRAVITY*(1000*0.05*0.15 + 500*0.1*0.1);
    for (int k = 0; k < METHODS; k += STRIDE) {
        means m[2];
        for (int joined = 0; joined < 2; joined++) {
            const scene s = { methods[k], GRAVITY, { 0, 0, 0.6, 0.5 }, 0, { 0.25, 0.15, 0.35, 0.25 }, 1500,
                              5e4, "rod", 1e-3 };
            tobi_world *world = open_world(&s);
            add_body(world, "rod", rod, joined ? 2000 : 0);
            add_block(world, &s);
            if (joined) join(world, "pin", "rod", NULL, 0.3, 0.4);
            OK(tobi_world_start(world, &err));
            m[joined] = average(world, 0.15, 0.3);
            tobi_world_destroy(world);
        }
        print_message("%s: the pin carries %.2f N/m, %.2f held without a joint, %.2f by Archimedes\n",
                      methods[k], m[1].joints, weight - m[0].load, archimedes);
        assert_float_equal(m[1].joints, weight - m[0].load, 0.005*archimedes);
        assert_float_equal(m[1].joints, archimedes, 0.08*archimedes);
        assert_float_equal(m[1].joints + m[1].load, weight, 0.003*weight);
        assert_true(m[1].gap < 1e-9*SPACING);
    }
}

/* A hub under water holds a fin. No water presses on the hub where the fin is: by isph it feels 1 +- 0.05 of
   the pressure on the root. Where forces are those of pairs both together feel less than 0.05 of it. */
static void a_held_fin_hides_its_root(void **state)
{
    (void)state;
    const double hub[4] = { 0.2, 0.1, 0.3, 0.25 }, root = 1000*GRAVITY*0.325*0.025;
    for (int k = 0; k < METHODS; k += STRIDE) {
        const scene s = { methods[k], GRAVITY, { 0, 0, 0.6, 0.5 }, 0, { 0.2, 0.1625, 0.4, 0.1875 }, 1000, 5e5,
                          "hub", 1e-3 };
        tobi_world *world = open_world(&s);
        double own = 0, both = 0, span = 0;
        add_body(world, "hub", hub, 0);
        add_block(world, &s);
        OK(tobi_world_start(world, &err));
        while (world->sim.time < 0.2) {
            OK(tobi_world_step(world, 1, NULL, &err));
            const tobi_body_load *load = world->sim.bodies[0].load;
            if (world->sim.time < 0.1) continue;
            own += load[0].pressure[0]*world->sim.dt/root;
            both += (load[0].pressure[0] + load[1].pressure[0])*world->sim.dt/root;
            span += world->sim.dt;
        }
        print_message("%s: over the pressure on the root the hub feels %.3f, with the fin %.3f\n", methods[k],
                      own/span, both/span);
        if (k < 2) assert_true(fabs(both/span) < 0.05);
        else assert_float_equal(own/span, 1, 0.05);
        tobi_world_destroy(world);
    }
}

/* A block lies on a bed under water. The inside of a bed thicker than two spacings counted as air beside the
   block: then all of the water's pressure held it down. Both are lifted as by Archimedes. */
static void a_block_on_a_bed_is_lifted(void **state)
{
    (void)state;
    const double bed[4] = { 0.1, 0, 0.5, 0.1 }, block = 1000*GRAVITY*0.15*0.1,
                 both = 1000*GRAVITY*0.4*0.1 + block - 1900*GRAVITY*0.15*0.1;
    for (int k = 0; k < METHODS; k++) {
        const scene s = { methods[k], GRAVITY, { 0, 0, 0.6, 0.5 }, 0, { 0.225, 0.1, 0.375, 0.2 }, 1900, 5e5,
                          NULL, 1e-3 };
        tobi_world *world = open_world(&s);
        double lift = 0;
        add_body(world, "bed", bed, 0);
        add_block(world, &s);
        OK(tobi_world_start(world, &err));
        const means m = average(world, SANITIZED ? 0.02 : 0.1, SANITIZED ? 0.04 : 0.2);
        for (int64_t i = 0; i < world->sim.soft.count; i++) lift += world->sim.soft.push[i].y;
        print_message("%s: the block is lifted by %.2f, both by %.2f of Archimedes\n", methods[k], lift/block,
                      m.load/both);
        assert_true(fabs(lift/block - 1) < (SANITIZED ? 0.35 : 0.2) && fabs(m.load/both - 1) < 0.1);
        tobi_world_destroy(world);
    }
}

static double find_height(const tobi_world *world)
{
    const tobi_particles *p = &tobi_world_solids(world)->particles;
    double sum = 0;
    for (int64_t i = 0; i < p->count; i++) sum += p->position[i].y;
    return sum/(double)p->count;
}

/* A plank of 2 kg/m on two pins bears a block of 30 kg/m, that lies on it or is clamped to it, as one does
   that is held without joints: pressed as if it were free it would give way. */
static void bear_block(const char *method, const char *clamped_to)
{
    const double plank[4] = { 0.15, 0.15, 0.45, 0.175 }, own = 300*0.3*0.025*GRAVITY;
    means m[2];
    double height[2];
    for (int joined = 0; joined < 2; joined++) {
        const scene s = { method, GRAVITY, { 0, 0, 0.6, 0.3 }, 0, { 0.25, 0.175, 0.35, 0.275 }, 3000, 1e5,
                          clamped_to, 1e-3 };
        tobi_world *world = open_world(&s);
        add_body(world, "plank", plank, joined ? 300 : 0);
        add_block(world, &s);
        if (joined) join(world, "left", "plank", NULL, 0.15, 0.1625);
        if (joined) join(world, "right", "plank", NULL, 0.45, 0.1625);
        OK(tobi_world_start(world, &err));
        m[joined] = average(world, 0.12, 0.3);
        height[joined] = find_height(world);
        tobi_world_destroy(world);
    }
    print_message("%s%s: pins carry %.1f N/m, %.1f held without joints; the block is at %.5f and %.5f m\n",
                  method, clamped_to ? ", clamped" : "", m[1].joints, own - m[0].load, height[1], height[0]);
    assert_float_equal(m[1].joints, own - m[0].load, 0.03*(own - m[0].load));
    assert_float_equal(height[1], height[0], 0.02*SPACING);
    assert_true(m[1].gap < 1e-9*SPACING);
}

static void a_light_plank_bears_a_heavy_block(void **state)
{
    (void)state;
    for (int k = 0; k < BESIDE; k++) {
        if (k < METHODS && k%STRIDE) continue;
        if (k != 2) bear_block(methods[k], NULL);             /* isph is slow */
        bear_block(methods[k], "plank");
    }
}

static double find_momentum(tobi_world *world)
{
    double sum = 0;
    for (int k = 0; k < world->system_count; k++) {
        tobi_system_measure(&world->system[k]);
        sum += world->system[k].info.momentum[1];
    }
    for (int k = 0; k < world->sim.body_count; k++)
        sum += world->sim.bodies[k].rigid.mass*world->sim.bodies[k].rigid.velocity[1];
    return sum;
}

/* Two joined bodies with a block on one, or clamped to it, without gravity; water hits them. */
static tobi_world *make_raft(const char *method, int clamped)
{
    const double left[4] = { 0.15, 0.3, 0.28, 0.34 }, right[4] = { 0.3, 0.3, 0.43, 0.34 };
    const scene s = { method, 0, { 0.2, 0.2, 0.4, 0.285 }, 0.5, { 0.32, 0.34, 0.4, 0.4 }, 900, 3e4,
                      clamped ? "right" : NULL, 1e-3 };
    tobi_world *world = open_world(&s);
    add_body(world, "left", left, 700);
    add_body(world, "right", right, 300);
    add_block(world, &s);
    join(world, "hinge", "left", "right", 0.29, 0.32);
    return world;
}

/* What the water loses the others get; a restart has the same bits. */
static void momentum_is_kept(void **state)
{
    (void)state;
    for (int k = 0; k < METHODS; k++)
        for (int clamped = 0; clamped < 2; clamped++) {
            tobi_world *world = make_raft(methods[k], clamped), *later = make_raft(methods[k], clamped);
            tobi_joint_info joint;
            OK(tobi_world_start(world, &err));
            const double before = find_momentum(world);
            OK(tobi_world_advance(world, 0.04, NULL, &err));
            OK(tobi_world_save(world, "soft_joints.h5", &err));
            OK(tobi_world_load(later, "soft_joints.h5", &err));
            OK(tobi_world_advance(world, 0.07, NULL, &err));
            OK(tobi_world_advance(later, 0.07, NULL, &err));
            assert_true(tobi_world_hash(world) == tobi_world_hash(later));
            tobi_system_measure(&world->system[0]);
            const double lost = find_momentum(world) - before,
                         given = before - world->system[0].info.momentum[1];
            print_message("%s%s: %.3g of %.3g N s/m went over, %.2g of it was lost\n", methods[k],
                          clamped ? ", clamped" : "", given, before, lost/given);
            assert_true(given > 0.15*before);
            if (k < 2) assert_true(fabs(lost) < 1e-6*before);
            tobi_world_joint(world, 0, &joint);
            assert_true(joint.gap < 1e-9*SPACING);
            tobi_world_destroy(world);
            tobi_world_destroy(later);
        }
    remove("soft_joints.h5");
}

/* The softness of a block that nothing touches changes nothing in joined bodies on the water. */
static void a_block_far_away_changes_nothing(void **state)
{
    (void)state;
    const double left[4] = { 0.15, 0.17, 0.28, 0.24 }, right[4] = { 0.3, 0.17, 0.43, 0.24 };
    for (int k = 0; k < METHODS; k++) {
        tobi_body_info body[2];
        for (int stiff = 0; stiff < 2; stiff++) {
            const scene s = { methods[k], GRAVITY, { 0, 0, 0.6, 0.2 }, 0, { 0.25, 0.5, 0.35, 0.58 }, 900,
                              stiff ? 1e5 : 1e4, NULL, 1e-4 };
            tobi_world *world = open_world(&s);
            add_body(world, "left", left, 700);
            add_body(world, "right", right, 200);
            join(world, "hinge", "left", "right", 0.29, 0.2);
            add_block(world, &s);
            OK(tobi_world_start(world, &err));
            OK(tobi_world_advance(world, 0.02, NULL, &err));
            tobi_world_body(world, 0, &body[stiff]);
            tobi_world_destroy(world);
        }
        assert_memory_equal(body[0].position, body[1].position, sizeof body->position);
        assert_memory_equal(body[0].velocity, body[1].velocity, sizeof body->velocity);
        assert_true(fabs(body[0].velocity[1]) > 1e-4);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pin_carries_weight_less_buoyancy),
        cmocka_unit_test(a_held_fin_hides_its_root),
        cmocka_unit_test(a_block_on_a_bed_is_lifted),
        cmocka_unit_test(a_light_plank_bears_a_heavy_block),
        cmocka_unit_test(momentum_is_kept),
        cmocka_unit_test(a_block_far_away_changes_nothing)
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

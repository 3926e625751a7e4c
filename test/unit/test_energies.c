/* Energies that close: what bodies, springs and lines have, and what motors, dampers, contact, liquids and
   motions give them, against closed solutions, in 2-D and 3-D. */
#include "calls.h"
#include "geom/vec3.h"
#include "rigid/lines.h"
#include "tobiuo/tobiuo.h"
#include <math.h>

/* Without a liquid; 4 m in all directions. */
static tobi_world *open_world(int dimension, double fall, double step)
{
    tobi_world_def d = tobi_default_world_def();
    tobi_world *w = NULL;
    d.dimension = dimension;
    d.spacing = 0.1;
    d.threads = 1;
    d.time_step_max = step;
    for (int a = 0; a < 3; a++) {
        d.domain_max[a] = a < dimension ? 4 : 0;
        d.gravity[a] = a == dimension - 1 ? -fall : 0;
    }
    OK(tobi_world_create(&d, NULL, &w, &err));
    return w;
}

/* A brick of unequal sides around a middle, 0.4 m wide. */
static tobi_body_def make_brick(int dimension, const double middle[3])
{
    const double half[3] = { 0.2, 0.15, 0.05 };
    tobi_body_def def = tobi_default_body_def();
    def.name = "brick";
    def.dynamics = TOBI_FREE;
    def.density = 500;
    def.spacing = 0.05;
    for (int a = 0; a < dimension; a++) {
        def.box_min[a] = middle[a] - half[a];
        def.box_max[a] = middle[a] + half[a];
    }
    return def;
}

static const double middle[3] = { 2, 2, 2 };

/* Energies, and the work of all steps since `start`. */
typedef struct ledger {
    tobi_energy now, start;
    double joints, lines, motions, forces, work, contact, given, air, field;
} ledger;

static void open_ledger(ledger *l, tobi_world *w)
{
    *l = (ledger){ 0 };
    OK(tobi_world_start(w, &err));
    OK(tobi_world_energy(w, &l->start));
}

static void follow(ledger *l, tobi_world *w, double until)
{
    tobi_body_energy b;
    while (tobi_world_time(w) < until) {
        tobi_step_info info;
        OK(tobi_world_step(w, until - tobi_world_time(w), &info, &err));
        OK(tobi_world_energy(w, &l->now));
        OK(tobi_world_body_energy(w, 0, &b));
        l->joints += info.dt*l->now.joint_power;
        l->lines += info.dt*l->now.line_power;
        l->motions += info.dt*l->now.motion_power;
        l->forces += info.dt*l->now.force_power;
        l->air += info.dt*l->now.air_power;
        l->field += info.dt*l->now.field_power;
        l->given += info.dt*b.force_power;
        l->work += info.dt*b.power;
        l->contact += info.dt*b.contact_power;
    }
}

static double sum_of(const tobi_energy *e) { return e->kinetic + e->potential + e->springs; }

static double gain_of(const ledger *l) { return sum_of(&l->now) - sum_of(&l->start); }

/* m g h and half of m v^2 + I w^2, and so they stay. */
static void a_body_that_falls_and_tumbles_keeps_its_energy(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        tobi_world *w = open_world(dimension, 10, 1e-3);
        tobi_body_def def = make_brick(dimension, middle);
        ledger l;
        tobi_body_info i;
        def.velocity[0] = 0.5;
        def.angular_velocity[2] = 3;
        if (dimension == 3) def.angular_velocity[0] = 2;
        OK(tobi_world_add_body(w, &def, &err));
        open_ledger(&l, w);
        OK(tobi_world_body(w, 0, &i));
        double turning = 9*i.inertia[8] + (dimension == 3 ? 4*i.inertia[0] : 0);
        assert_true(fabs(l.start.kinetic/(0.5*(i.mass*0.25 + turning)) - 1) < 1e-12);
        assert_true(fabs(l.start.potential/(i.mass*10*2) - 1) < 1e-12);
        follow(&l, w, 0.4);
        assert_true(l.now.kinetic > l.start.kinetic + 0.9*i.mass*10*0.8);
        if (fabs(gain_of(&l)) > 1e-12*l.now.kinetic) fail_msg("%d-D: %g J of %g", dimension, gain_of(&l),
                                                              l.now.kinetic);
        assert_true(l.work == 0 && l.contact == 0 && l.joints == 0 && l.lines == 0);
        tobi_world_destroy(w);
    }
}

/* What contact takes of a brick that falls on the floor, bounces and slides is what it loses. */
static void contact_takes_what_a_body_loses(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        tobi_world *w = open_world(dimension, 10, 1e-4);
        double place[3] = { 1, 1, 1 };
        place[dimension - 1] = 0.5;
        tobi_body_def def = make_brick(dimension, place);
        ledger l;
        def.velocity[0] = 1;
        def.restitution = 0.5;
        OK(tobi_world_add_body(w, &def, &err));
        open_ledger(&l, w);
        follow(&l, w, 0.8);
        assert_true(gain_of(&l) < -0.2*l.start.potential);
        /* a bounce is within a step: its contact lifts by the velocities after it */
        if (fabs(gain_of(&l) - l.contact) > 5e-3*fabs(l.contact))
            fail_msg("%d-D: %g J lost, contact did %g", dimension, gain_of(&l), l.contact);
        tobi_world_destroy(w);
    }
}

/* A torque at a hinge gives the energy of the turn, on a joint and on a body's own hinge; at its weight. */
static void the_work_of_a_motor_is_the_energy_gained(void **state)
{
    (void)state;
    for (int n = 0; n < 4; n++) {
        const int dimension = 2 + n/2, own = n%2;
        const double rest[3] = { 1.8, 2, 2 };
        tobi_world *w = open_world(dimension, 10, 1e-3);
        tobi_body_def def = make_brick(dimension, middle);
        tobi_joint_def joint = tobi_default_joint_def();
        ledger l;
        joint.name = "hinge";
        joint.body = "brick";
        joint.axis[2] = 1;
        joint.motor.torque = 4000;
        if (dimension == 3) joint.axis[1] = 1, joint.axis[2] = 0, joint.motor.torque = 400;
        memcpy(joint.point, rest, sizeof rest);
        if (own) {
            memcpy(def.hinge_axis, joint.axis, sizeof joint.axis);
            memcpy(def.hinge_point, rest, sizeof rest);
            def.hinge_motor = joint.motor;
        }
        OK(tobi_world_add_body(w, &def, &err));
        if (!own) OK(tobi_world_add_joint(w, &joint, &err));
        open_ledger(&l, w);
        follow(&l, w, 0.2);
        assert_true(l.now.kinetic > 1 && l.joints < -1);
        if (fabs(gain_of(&l) + l.joints) > 1e-4*fabs(l.joints))
            fail_msg("%d-D, own %d: gained %g J, the motor gave %g", dimension, own, gain_of(&l), -l.joints);
        tobi_world_destroy(w);
    }
}

/* A force that swings and a torque against the turn, of some N and N m. */
static tobi_status push(void *user, const tobi_control_input *in, tobi_control_output *out, tobi_error *err)
{
    (void)user;
    (void)err;
    out->force[0] = 30*cos(20*in->time);
    out->force[1] = 10;
    out->torque[2] = -0.5*in->angular_velocity[2];
    return TOBI_OK;
}

/* Free, on a hinge beside its middle, and over the floor, which it meets: all gained is of forces and
   contact. A hinge takes the mean of a program's force before and now. */
static void the_work_of_forces_is_the_energy_gained(void **state)
{
    (void)state;
    for (int n = 0; n < 12; n++) {
        const int dimension = 2 + n/6, controlled = n/3%2, held = n%3;
        tobi_world *w = open_world(dimension, 10, 1e-4);
        double place[3] = { 2, 2, 2 };
        if (held == 2) place[dimension - 1] = 0.4;
        tobi_body_def def = make_brick(dimension, place);
        ledger l;
        def.dynamics = controlled ? TOBI_CONTROLLED : TOBI_FREE;
        if (controlled) def.control = push;
        def.mass = 3;
        def.force[0] = 20;
        def.torque[2] = 0.4;
        def.angular_velocity[2] = held == 1 ? 0 : 2;
        if (held == 1) {
            def.hinge_axis[2] = 1;
            memcpy(def.hinge_point, place, sizeof place);
            def.hinge_point[0] += 0.1;
        }
        OK(tobi_world_add_body(w, &def, &err));
        open_ledger(&l, w);
        follow(&l, w, 0.4);
        assert_true(l.forces == l.given && fabs(l.forces) > 0.05);
        if (held == 2) assert_true(l.contact < -0.1);
        const double wrong = gain_of(&l) - l.forces - l.contact;
        const double allowed = held == 1 ? (controlled ? 2e-3*fabs(l.forces) : 2e-4*l.now.kinetic) :
                               held == 2 ? 5e-3*fabs(l.contact) :
                               controlled ? 1e-6 : 1e-9;     /* its first drift knows no program yet */
        if (fabs(wrong) > allowed)
            fail_msg("%d-D, case %d: gained %g J, forces gave %g, contact %g: %g too many", dimension, n,
                     gain_of(&l), l.forces, l.contact, wrong);
        tobi_world_destroy(w);
    }
}

/* A body that falls from rest, and turns, in air: v = (g/k)(1 - e), e = exp(-k t), and its turn decays by
   itself. */
static void air_takes_what_a_body_loses(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        const double k = 3, t = 0.5, e = exp(-k*t), place[3] = { 2, 3, 3 };
        tobi_world *w = open_world(dimension, 10, 1e-4);
        tobi_body_def def = make_brick(dimension, place);
        ledger l;
        tobi_body_info i;
        def.air_resistance = k;
        def.angular_velocity[2] = 4;
        OK(tobi_world_add_body(w, &def, &err));
        open_ledger(&l, w);
        OK(tobi_world_body(w, 0, &i));
        follow(&l, w, t);
        const double square = t - 2*(1 - e)/k + (1 - e*e)/(2*k), turn = 0.5*i.inertia[8]*16*(1 - e*e);
        const double expected = -i.mass*k*(10/k)*(10/k)*square - turn;
        if (fabs(l.air/expected - 1) > 3e-4)
            fail_msg("%d-D: air gave %g J, not %g", dimension, l.air, expected);
        if (fabs(gain_of(&l) - l.air) > 1e-9*fabs(l.air))
            fail_msg("%d-D: lost %.12g J, air gave %.12g", dimension, gain_of(&l), l.air);
        assert_true(l.field == 0 && l.forces == 0 && l.contact == 0);
        tobi_world_destroy(w);
    }
}

/* A pendulum with a hinge of its own, damped and not; a slide on a guide. */
static void air_takes_what_a_joint_loses(void **state)
{
    (void)state;
    for (int n = 0; n < 3; n++) {
        tobi_world *w = open_world(3, 10, 1e-4);
        tobi_body_def def = make_brick(3, middle);
        ledger l;
        def.air_resistance = 2;
        if (n == 2) {
            def.guide_axis[0] = 0.6, def.guide_axis[2] = 0.8;
        } else {
            def.hinge_axis[1] = 1;
            memcpy(def.hinge_point, middle, sizeof middle);
            def.hinge_point[0] -= 0.5;
            def.hinge_damping = n == 1 ? 3 : 0;
        }
        OK(tobi_world_add_body(w, &def, &err));
        open_ledger(&l, w);
        follow(&l, w, 0.4);
        assert_true(l.air < -0.05*l.now.kinetic && (l.joints > 0.05*l.now.kinetic) == (n == 1));
        if (fabs(gain_of(&l) - l.air + l.joints) > 5e-4*fabs(l.air))
            fail_msg("case %d: lost %g J, air gave %g, the damper took %g", n, gain_of(&l), l.air, l.joints);
        tobi_world_destroy(w);
    }
}

/* Without gravity: from rest at r it swings as r cos(w t), and has m w^2/2 (r^2 - x^2). */
static void a_central_force_gives_what_a_body_gains(void **state)
{
    tobi_world *w = open_world(3, 0, 1e-4);
    tobi_body_def def = make_brick(3, middle);
    tobi_central_def centre = { .centre = { 1.2, 2, 2 }, .rate = 2 };
    ledger l;
    tobi_body_info i;
    (void)state;
    OK(tobi_world_set_central_force(w, &centre, &err));
    OK(tobi_world_add_body(w, &def, &err));
    open_ledger(&l, w);
    follow(&l, w, 0.6);
    OK(tobi_world_body(w, 0, &i));
    const double speed = 0.8*2*sin(1.2), expected = 0.5*i.mass*speed*speed;
    if (fabs(l.field/expected - 1) > 1e-3) fail_msg("the force gave %g J, not %g", l.field, expected);
    if (fabs(gain_of(&l) - l.field) > 1e-9*l.field) fail_msg("gained %g J of %g", gain_of(&l), l.field);
    tobi_world_destroy(w);
}

static tobi_status rock(void *user, double t, int64_t n, const double (*rest)[3], double (*position)[3],
                        tobi_error *error)
{
    const double angle = 0.3*(1 - cos(4*t));
    (void)user;
    (void)error;
    for (int64_t i = 0; i < n; i++) {
        const double x = rest[i][0] - 1, z = rest[i][2] - 1;
        position[i][0] = 1 + cos(angle)*x + sin(angle)*z;
        position[i][1] = rest[i][1];
        position[i][2] = 1 - sin(angle)*x + cos(angle)*z;
    }
    return TOBI_OK;
}

/* Free in a frame that rocks, with gravity and air: what it gains is what they give; in the domain's axes. */
static void a_rocking_frame_gives_what_a_body_gains(void **state)
{
    tobi_world *w = open_world(3, 10, 1e-4);
    tobi_body_def def = make_brick(3, middle);
    ledger l;
    (void)state;
    def.air_resistance = 0.5;
    def.angular_velocity[0] = 1;
    OK(tobi_world_set_frame(w, rock, NULL, &err));
    OK(tobi_world_add_body(w, &def, &err));
    open_ledger(&l, w);
    follow(&l, w, 0.5);
    assert_true(fabs(l.field) > 0.05*l.now.kinetic && l.air < 0);
    if (fabs(gain_of(&l) - l.field - l.air) > 1e-4*fabs(l.field))
        fail_msg("gained %.9g J, the frame gave %.9g, air %.9g", gain_of(&l), l.field, l.air);
    tobi_world_destroy(w);
}

/* A guide with a spring along gravity, without and with a damper, from where the spring is at rest: first it
   falls. */
static void a_spring_pendulum_keeps_its_energy_but_for_the_damper(void **state)
{
    (void)state;
    for (int n = 0; n < 4; n++) {
        const int dimension = 2 + n/2, damped = n%2;
        tobi_world *w = open_world(dimension, 10, 1e-4);
        tobi_body_def def = make_brick(dimension, middle);
        ledger l;
        def.mass = 2;
        def.guide_axis[dimension - 1] = 1;
        def.guide_stiffness = 200;
        def.guide_damping = damped ? 8 : 0;
        OK(tobi_world_add_body(w, &def, &err));
        open_ledger(&l, w);
        follow(&l, w, acos(-1)/10);              /* half a period: 20 N / 200 N/m = 0.1 m, twice */
        const double far = 200*0.2*0.2/2;                    /* J */
        if (!damped) assert_true(fabs(l.now.springs/far - 1) < 1e-3 && l.joints == 0);
        else assert_true(l.joints > 0.1*far && l.now.springs < 0.9*far);
        if (fabs(gain_of(&l) + l.joints) > 2e-4*far)
            fail_msg("%d-D: gained %g J, the damper took %g", dimension, gain_of(&l), l.joints);
        tobi_world_destroy(w);
    }
}

/* The same for a spring line beside the centre of mass, a slack rope, and a hinge with a spring. */
static void lines_and_hinges_keep_energy_too(void **state)
{
    (void)state;
    for (int n = 0; n < 8; n++) {
        const int dimension = 2 + n/4, up = dimension - 1, damped = n%2, hinge = n%4 >= 2;
        tobi_world *w = open_world(dimension, 10, 1e-4);
        tobi_body_def def = make_brick(dimension, middle);
        tobi_line_def line = tobi_default_line_def();
        tobi_joint_def joint = tobi_default_joint_def();
        ledger l;
        def.mass = 2;
        OK(tobi_world_add_body(w, &def, &err));
        line.name = joint.name = "held";
        line.body = joint.body = "brick";
        line.kind = damped ? TOBI_LINE_ROPE : TOBI_LINE_SPRING;
        line.stiffness = 200;
        line.damping = joint.damping = damped ? 4 : 0;
        memcpy(line.point, middle, sizeof middle);
        line.point[0] += 0.1;
        memcpy(line.to, line.point, sizeof line.to);
        line.to[up] += 1;
        line.length = 1;
        joint.stiffness = 30;
        joint.rest = 20;
        joint.axis[3 - up] = 1;
        memcpy(joint.point, line.point, sizeof joint.point);
        if (hinge) OK(tobi_world_add_joint(w, &joint, &err));
        else OK(tobi_world_add_line(w, &line, &err));
        open_ledger(&l, w);
        follow(&l, w, 0.3);
        const double taken = hinge ? l.joints : l.lines, other = hinge ? l.lines : l.joints;
        assert_true(other == 0 && (damped ? taken > 0.05 : taken == 0));
        if (!(fabs(l.now.springs - l.start.springs) > 0.2))
            fail_msg("case %d: springs have %g J, had %g", n, l.now.springs, l.start.springs);
        if (fabs(gain_of(&l) + taken) > 2e-3 + 5e-3*taken)
            fail_msg("case %d: gained %g J, %g taken", n, gain_of(&l), taken);
        tobi_world_destroy(w);
    }
}

/* The energy of a mooring line: its slopes are its pulls, as it hangs, lies on the floor and is slack. */
static void a_catenary_has_the_energy_of_its_pulls(void **state)
{
    (void)state;
    static const double ends[][2] = { { 8, 5 }, { 5, 6 }, { 9, 3 }, { 2, 4 }, { 4, 9.5 } };
    for (int n = 0; n < 10; n++) {
        const double step = 1e-4, size = 100;
        double slope[2], pull[2];
        tobi_line line = { .kind = TOBI_LINE_CATENARY, .length = 10, .weight = 10, .stiffness = 1e4,
                           .rests = n < 5, .up = { 0, 0, 1 } };
        tobi_catenary(&line, ends[n%5][0], ends[n%5][1], pull);
        for (int k = 0; k < 2; k++) {
            double energy[2];
            for (int side = 0; side < 2; side++) {
                double at[2] = { ends[n%5][0], ends[n%5][1] };
                at[k] += side ? step : -step;
                line.info.point[0] = at[0];
                line.info.point[2] = at[1];
                energy[side] = tobi_line_energy(&line);
            }
            slope[k] = (energy[1] - energy[0])/(2*step);
            if (fabs(slope[k] - pull[k]) > 1e-3*size)
                fail_msg("case %d: the energy grows by %g J/m, the pull is %g N", n, slope[k], pull[k]);
        }
    }
}

/* A tank, 1 m of water; a float beside nothing, or a block with a motion. */
static tobi_world *open_tank(int dimension, double spacing)
{
    tobi_world_def d = tobi_default_world_def();
    tobi_fluid_def water = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *w = NULL;
    const int up = dimension - 1;
    d.dimension = dimension;
    d.spacing = spacing;
    d.threads = 1;
    d.time_step_max = 1e-3;
    for (int a = 0; a < 3; a++) {
        d.domain_max[a] = a < dimension ? 1 : 0;
        d.gravity[a] = a == up ? -10 : 0;
        fill.box_max[a] = a == up ? 0.6 : d.domain_max[a];
    }
    OK(tobi_world_create(&d, NULL, &w, &err));
    water.name = "water";
    OK(tobi_world_add_fluid(w, &water, &fill, 1, &err));
    return w;
}

/* What a float gains, the water gives. The drift of a step knows the velocity at its end: the balance is of
   first order, and closes to m g dt v. */
static void a_float_gains_what_the_water_gives(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        tobi_world *w = open_tank(dimension, dimension == 2 ? 0.04 : 0.05);
        double place[3] = { 0.5, 0.5, 0.5 };
        place[dimension - 1] = 0.3;
        tobi_body_def def = make_brick(dimension, place);
        tobi_body_info i;
        ledger l;
        OK(tobi_world_add_body(w, &def, &err));
        open_ledger(&l, w);
        OK(tobi_world_body(w, 0, &i));
        follow(&l, w, 0.25);
        const double weight = 10*i.mass, height = (l.now.potential - l.start.potential)/weight;
        if (!(height > 0.01)) fail_msg("%d-D: the float rose by %g m", dimension, height);
        if (fabs(gain_of(&l) - l.work) > 0.02*l.work)
            fail_msg("%d-D: the float gained %g J, the water gave %g", dimension, gain_of(&l), l.work);
        tobi_world_destroy(w);
    }
}

/* Sinks along -y at 0.25 m/s. */
static tobi_status sink(void *user, double t, int64_t n, const double (*rest)[3], double (*position)[3],
                        tobi_error *err)
{
    (void)user;
    (void)err;
    for (int64_t k = 0; k < n; k++) {
        memcpy(position[k], rest[k], sizeof rest[k]);
        position[k][1] -= 0.25*t;
    }
    return TOBI_OK;
}

/* A block pressed into still water lifts it: the work is the water's gain of height, and some speed. */
static void a_motion_gives_the_energy_that_the_water_gains(void **state)
{
    (void)state;
    tobi_world *w = open_tank(2, 0.04);
    const double place[3] = { 0.5, 0.76 };
    tobi_body_def def = make_brick(2, place);
    ledger l;
    def.dynamics = TOBI_PRESCRIBED;
    def.motion = sink;
    def.motion_rigid = 1;
    OK(tobi_world_add_body(w, &def, &err));
    open_ledger(&l, w);
    const tobi_step_info start = *tobi_world_info(w);
    follow(&l, w, 1);
    const tobi_step_info *i = tobi_world_info(w);
    const double gained = i->kinetic_energy + i->potential_energy - start.kinetic_energy -
                          start.potential_energy;
    assert_true(l.now.kinetic == 0 && l.now.potential == 0);
    assert_true(l.motions == -l.work);
    /* 1000 kg/m3 x 10 m/s2 x 0.4 m x 0.25 m under water: 1000 N on the way, half of it in the mean. The flat
       side meets the water at once, which costs some. */
    if (!(l.motions > 60 && fabs(gained - l.motions) < 0.12*l.motions))
        fail_msg("the water gained %g J, the motion gave %g", gained, l.motions);
    tobi_world_destroy(w);
}

static void what_is_not_there_has_no_energy(void **state)
{
    (void)state;
    tobi_world *w = open_world(2, 10, 1e-3);
    tobi_body_energy b;
    tobi_energy e;
    assert_int_equal(tobi_world_body_energy(w, 0, &b), TOBI_NOT_FOUND);
    assert_int_equal(tobi_world_body_energy(NULL, 0, &b), TOBI_INVALID);
    assert_int_equal(tobi_world_energy(NULL, &e), TOBI_INVALID);
    tobi_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_body_that_falls_and_tumbles_keeps_its_energy),
        cmocka_unit_test(contact_takes_what_a_body_loses),
        cmocka_unit_test(the_work_of_a_motor_is_the_energy_gained),
        cmocka_unit_test(the_work_of_forces_is_the_energy_gained),
        cmocka_unit_test(air_takes_what_a_body_loses),
        cmocka_unit_test(air_takes_what_a_joint_loses),
        cmocka_unit_test(a_central_force_gives_what_a_body_gains),
        cmocka_unit_test(a_rocking_frame_gives_what_a_body_gains),
        cmocka_unit_test(a_spring_pendulum_keeps_its_energy_but_for_the_damper),
        cmocka_unit_test(lines_and_hinges_keep_energy_too),
        cmocka_unit_test(a_catenary_has_the_energy_of_its_pulls),
        cmocka_unit_test(a_float_gains_what_the_water_gives),
        cmocka_unit_test(a_motion_gives_the_energy_that_the_water_gains),
        cmocka_unit_test(what_is_not_there_has_no_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

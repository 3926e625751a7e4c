/* Motors of hinges and guides: closed solutions by torque, speed and angle, of joints, of a body's own hinge
   and of its guide; momentum, work, stops; what is refused. */
#include "rigid_rig.h"
#include "mistakes.h"

static const double weightless[3] = { 0 };

enum { JOINT, HINGE, GUIDE, WAYS };

/* A bar 1 m long from (2, 2, 2) along x; about its end along z it turns by a joint or its own hinge, or
   slides along a slant. */
static tobi_constraint *add_arm(rig *g, int own)
{
    const double slant[3] = { 0.6, 0, 0.8 };
    tobi_body_def def = rig_def();
    def.spacing = 0.05;
    def.hinge_axis[2] = own == HINGE;
    for (int a = 0; a < 3; a++) def.hinge_point[a] = 2, def.guide_axis[a] = own == GUIDE ? slant[a] : 0;
    rig_box(g, def, (double[3]){ 1, 0.1, 0.1 }, (double[3]){ 2.5, 2, 2 });
    tobi_constraint *j = g->joints.at = calloc(1, sizeof *g->joints.at);
    *j = (tobi_constraint){ .kind = own ? TOBI_BETWEEN_MOTOR : TOBI_BETWEEN_HINGE, .body = { 0, -1 },
                            .point = { { -0.5 }, { 2, 2, 2 } }, .axis = { { 0, 0, 1 }, { 0, 0, 1 } } };
    j->slides = own == GUIDE;
    if (j->slides) memcpy(j->axis[0], slant, sizeof slant), memset(j->point, 0, sizeof j->point);
    j->motor.most = INFINITY;
    g->joints.count = 1;
    return j;
}

/* About the end, or of a guide the mass. */
static double moment_of(const rig *g)
{
    const tobi_rigid *r = &g->bodies[0].rigid;
    return g->joints.at->slides ? r->mass : r->inertia[8] + 0.25*r->mass;
}

static double angle_of(const rig *g) { return tobi_constraint_place(g->joints.at, g->bodies, 0); }
static double torque_of(const rig *g)
{
    const tobi_joint_info *i = &g->joints.at->info;
    return g->joints.at->slides ? i->motor_force : i->motor_torque;
}
static double rate_of(const rig *g) { return tobi_constraint_rate(g->joints.at, g->bodies); }

/* As a world does: what the step begins and ends with. */
static void drive(rig *g, double before, double value, double dt)
{
    g->joints.at[0].motor.before = before;
    g->joints.at[0].motor.value = value;
    rig_step(g, dt);
}

static void a_constant_torque_turns_by_half_alpha_t2(void **state)
{
    (void)state;
    for (int own = 0; own < WAYS; own++) {
        rig g;
        rig_open(&g, 5, weightless);
        tobi_constraint *j = add_arm(&g, own);
        j->motor.kind = TOBI_MOTOR_TORQUE;
        j->motor.before = j->motor.value = 3;
        rig_start(&g);
        double work = 0;
        for (int n = 0; n < 100; n++) {
            rig_step(&g, 0.01);
            work -= 0.01*j->info.power;
        }
        const double off = angle_of(&g)/(0.5*3/moment_of(&g)) - 1, lost = work/rig_energy(&g) - 1;
        /* the arc of a joint between bodies is of second order */
        if (fabs(off) > (own ? 1e-12 : 1e-5) || fabs(lost) > 1e-10)
            fail_msg("off by %g, %g of the work lost", off, lost);
        assert_true(torque_of(&g) == 3);
        rig_close(&g);
    }
}

/* Full torque until t = I w/T, then none. */
static void a_speed_is_reached_by_the_largest_torque(void **state)
{
    (void)state;
    for (int own = 0; own < WAYS; own++) {
        rig g;
        rig_open(&g, 5, weightless);
        tobi_constraint *j = add_arm(&g, own);
        const double w = own == GUIDE ? 0.3 : 1.5, most = 4, I = moment_of(&g), due = I*w/most;
        const double dt = due/100.5;
        j->motor = (tobi_motor){ .kind = TOBI_MOTOR_SPEED, .most = most, .before = w, .value = w };
        rig_start(&g);
        double work = 0;
        for (int n = 1; n <= 200; n++) {
            rig_step(&g, dt);
            work -= dt*j->info.power;
            const double expected = fmin(most*g.time/I, w);
            if (fabs(rate_of(&g) - expected) > 1e-12) fail_msg("%g rad/s at %g s", rate_of(&g), g.time);
            const double torque = n <= 100 ? most : n == 101 ? 0.5*most : 0;
            if (fabs(torque_of(&g) - torque) > 1e-9) fail_msg("%g N m", torque_of(&g));
        }
        assert_true(fabs(work/(0.5*I*w*w) - 1) < 1e-10);
        assert_true(fabs(angle_of(&g) - (w*g.time - 0.5*w*due)) < w*dt);
        rig_close(&g);
    }
}

static double swing(double t) { return 0.6*sin(3*t); }

static void an_angle_is_kept_to_rounding_and_takes_the_torque_of_its_acceleration(void **state)
{
    (void)state;
    for (int own = 0; own < WAYS; own++) {
        rig g;
        rig_open(&g, 5, weightless);
        tobi_constraint *j = add_arm(&g, own);
        j->motor.kind = TOBI_MOTOR_ANGLE;
        rig_start(&g);
        for (int n = 0; n < 500; n++) {
            drive(&g, swing(g.time), swing(g.time + 0.002), 0.002);
            const double off = angle_of(&g) - swing(g.time);
            if (fabs(off) > 1e-12) fail_msg("off by %g", off);
            const double exact = -9*swing(g.time - 0.002)*moment_of(&g);
            if (n > 0 && fabs(torque_of(&g) - exact) > 1e-4*9*0.6*moment_of(&g))
                fail_msg("%g N m, exact %g", torque_of(&g), exact);
        }
        rig_close(&g);
    }
}

/* By its largest torque it goes to an angle far away and stays there, without going past it. */
static void an_angle_far_away_is_reached_without_overshoot(void **state)
{
    (void)state;
    for (int own = 0; own < WAYS; own++) {
        rig g;
        rig_open(&g, 5, weightless);
        tobi_constraint *j = add_arm(&g, own);
        j->motor = (tobi_motor){ .kind = TOBI_MOTOR_ANGLE, .most = 20 };
        rig_start(&g);
        double most = 0;
        for (int n = 0; n < 2000; n++) {
            drive(&g, 1, 1, 1e-3);
            most = fmax(most, angle_of(&g));
            assert_true(fabs(torque_of(&g)) <= 20*(1 + 1e-9));
        }
        assert_true(most < 1 + 1e-5 && fabs(angle_of(&g) - 1) < 1e-12 && fabs(rate_of(&g)) < 1e-9);
        rig_close(&g);
    }
}

/* Two bodies in free space: each turns as the other lets it. */
static void a_motor_keeps_angular_momentum(void **state)
{
    (void)state;
    const tobi_motor motors[] = {
        { .kind = TOBI_MOTOR_SPEED, .most = 0.02, .before = 1.5, .value = 1.5 },
        { .kind = TOBI_MOTOR_SPEED, .most = INFINITY, .before = 1.5, .value = 1.5 },
        { .kind = TOBI_MOTOR_TORQUE, .most = INFINITY, .before = 0.02, .value = 0.02 } };
    for (int k = 0; k < 3; k++) {
        rig g;
        rig_open(&g, 5, weightless);
        tobi_constraint *j = add_arm(&g, 0);
        tobi_body_def def = rig_def();
        def.density = 300;
        rig_box(&g, def, (double[3]){ 0.6, 0.3, 0.1 }, (double[3]){ 1.7, 2, 2 });
        j->body[1] = 1;
        memcpy(j->point[1], (double[3]){ 0.3, 0, 0 }, sizeof j->point[1]);
        j->motor = motors[k];
        rig_start(&g);
        for (int n = 0; n < 400; n++) rig_step(&g, 2e-3);
        double L = 0, size = 0;
        for (int b = 0; b < 2; b++) {
            const tobi_rigid *r = &g.bodies[b].rigid;
            const double orbit = r->mass*(r->position[0]*r->velocity[1] - r->position[1]*r->velocity[0]);
            L += orbit + r->momentum[2];
            size += fabs(orbit) + fabs(r->momentum[2]);
        }
        if (!(size > 1e-3) || fabs(L) > 1e-12*size) fail_msg("motor %d: %g of %g kg m2/s", k, L, size);
        if (k == 1) assert_true(fabs(rate_of(&g) - 1.5) < 1e-12);
        rig_close(&g);
    }
}

/* It goes to the stop, rests there, and comes back when it is told to. */
static void a_motor_stops_at_stops(void **state)
{
    (void)state;
    for (int own = 0; own < WAYS; own++) {
        rig g;
        rig_open(&g, 5, weightless);
        tobi_constraint *j = add_arm(&g, own);
        double *const lower = own ? &g.bodies[0].rigid.joint.lower : &j->lower;
        double *const upper = own ? &g.bodies[0].rigid.joint.upper : &j->upper;
        *lower = -0.4;
        *upper = 0.3;
        j->motor = (tobi_motor){ .kind = TOBI_MOTOR_SPEED, .most = 30 };
        rig_start(&g);
        for (int n = 0; n < 500; n++) drive(&g, 2, 2, 2e-3);
        assert_true(fabs(angle_of(&g) - 0.3) < 1e-9 && fabs(rate_of(&g)) < 1e-9);
        for (int n = 0; n < 1000; n++) drive(&g, -2, -2, 2e-3);
        assert_true(fabs(angle_of(&g) + 0.4) < 1e-9 && fabs(rate_of(&g)) < 1e-9);
        rig_close(&g);
    }
}

/* --- on a body with a motion ----------------------------------------------------------------------- */

/* It goes along y by b t^2/2, or turns about z at (at, 2) by rate t + sway sin(3 t). */
typedef struct course { double b, at, rate, sway; } course;

static tobi_status follow(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                          tobi_error *err)
{
    const course *c = user;
    const double turn = c->rate*t + c->sway*sin(3*t);
    (void)err;
    for (int64_t i = 0; i < n; i++) {
        const double x = rest[i][0] - c->at, y = rest[i][1] - 2;
        out[i][0] = c->at + cos(turn)*x - sin(turn)*y;
        out[i][1] = 2 + sin(turn)*x + cos(turn)*y + 0.5*c->b*t*t;
        out[i][2] = rest[i][2];
    }
    return TOBI_OK;
}

/* The bar on a hull about its end; at the velocities of the hull from the start on, or at rest. */
static tobi_constraint *add_hull(rig *g, course *c, int along)
{
    tobi_constraint *j = add_arm(g, JOINT);
    tobi_body_def def = rig_def();
    tobi_rigid *r = &g->bodies[0].rigid;
    const double spin = along ? c->rate + 3*c->sway : 0;
    def.dynamics = TOBI_PRESCRIBED;
    def.motion = follow, def.motion_user = c, def.motion_rigid = 1;
    rig_box(g, def, (double[3]){ 0.2, 0.2, 0.2 }, (double[3]){ 2, 2, 2 });
    r = &g->bodies[0].rigid;
    r->velocity[1] = spin*(2.5 - c->at);
    r->angular_velocity[2] = spin;
    r->momentum[2] = spin*r->inertia[8];
    j->body[1] = 1;
    memset(j->point[1], 0, sizeof j->point[1]);
    return j;
}

/* A hull accelerates across the bar, which a motor keeps where it is, or swings. */
static void a_moved_hull_takes_the_torque_of_the_bar(void **state)
{
    (void)state;
    course c = { .b = 3 };
    rig g;
    rig_open(&g, 5, weightless);
    tobi_constraint *j = add_hull(&g, &c, 0);
    j->motor.kind = TOBI_MOTOR_ANGLE;
    rig_start(&g);
    const double exact = 0.5*3*g.bodies[0].rigid.mass;
    for (int n = 0; n < 200; n++) {
        drive(&g, 0, 0, 2e-3);
        if (fabs(angle_of(&g)) > 1e-12) fail_msg("off by %g", angle_of(&g));
        if (n > 1 && fabs(torque_of(&g)/exact - 1) > 1e-9) fail_msg("%g N m, exact %g", torque_of(&g), exact);
    }
    for (int n = 0; n < 200; n++) {
        const double t = g.time - 0.4;
        drive(&g, swing(t), swing(t + 2e-3), 2e-3);
        const double off = angle_of(&g) - swing(g.time - 0.4);
        if (fabs(off) > 1e-12) fail_msg("off by %g", off);
    }
    rig_close(&g);
}

/* A hull turns, steadily or not, and the motor turns the bar on it. */
static void an_angle_on_a_turning_hull_is_kept(void **state)
{
    (void)state;
    course c = { .at = 1.4, .rate = 0.7, .sway = 0.4 };
    for (int kind = TOBI_MOTOR_SPEED; kind <= TOBI_MOTOR_ANGLE; kind++) {
        rig g;
        rig_open(&g, 5, weightless);
        tobi_constraint *j = add_hull(&g, &c, 1);
        j->motor.kind = kind;
        rig_start(&g);
        for (int n = 0; n < 500; n++) {
            if (kind == TOBI_MOTOR_SPEED) drive(&g, 0.9, 0.9, 2e-3);
            else drive(&g, swing(g.time), swing(g.time + 2e-3), 2e-3);
            const double off = angle_of(&g) - (kind == TOBI_MOTOR_SPEED ? 0.9*g.time : swing(g.time));
            if (fabs(off) > 1e-11) fail_msg("kind %d: off by %g", kind, off);
            const double rate = kind == TOBI_MOTOR_SPEED ? rate_of(&g) : 0.9;
            if (fabs(rate - 0.9) > 1e-11) fail_msg("%g rad/s", rate);
        }
        rig_close(&g);
    }
}

/* The bar stands across the way from the axis of the hull: what pulls it outwards has a moment. */
static void a_brake_on_a_turning_hull_has_the_moment_of_the_centrifugal_force(void **state)
{
    (void)state;
    course c = { .at = 1.4, .rate = 0.7 };
    rig g;
    rig_open(&g, 5, weightless);
    tobi_constraint *j = add_hull(&g, &c, 1);
    j->motor.kind = TOBI_MOTOR_SPEED;
    rig_start(&g);
    for (int n = 0; n < 1000; n++) drive(&g, acos(0), acos(0), 1e-3);
    const tobi_rigid *r = &g.bodies[0].rigid;
    for (int n = 0; n < 100; n++) drive(&g, 0, 0, 1e-3);
    const double exact = r->mass*0.49*0.5*0.6;
    if (fabs(torque_of(&g)/exact - 1) > 1e-4) fail_msg("%.9g N m, exact %.9g", torque_of(&g), exact);
    assert_true(fabs(j->info.power) < 1e-9);
    rig_close(&g);
}

/* About its hinge the hull turns at W. Full torque until the bar turns at W + w, then none. */
static void the_largest_torque_brings_a_bar_to_a_turning_hull(void **state)
{
    (void)state;
    const double W = 0.5, w = 0.4, most = 8;
    course c = { .at = 2, .rate = W };
    rig g;
    rig_open(&g, 5, weightless);
    tobi_constraint *j = add_hull(&g, &c, 0);
    const double I = moment_of(&g), due = I*(W + w)/most, dt = due/100.5;
    j->motor = (tobi_motor){ .kind = TOBI_MOTOR_SPEED, .most = most, .before = w, .value = w };
    rig_start(&g);
    double work = 0;
    for (int n = 1; n <= 200; n++) {
        rig_step(&g, dt);
        if (n > 1) work -= dt*j->info.power;
        const double spin = g.bodies[0].rigid.angular_velocity[2], exact = fmin(most*g.time/I, W + w);
        if (fabs(spin - exact) > 1e-6) fail_msg("%.9g rad/s at %g s, exact %.9g", spin, g.time, exact);
        const double torque = n <= 100 ? most : n == 101 ? 0.5*most : 0;
        if (fabs(torque_of(&g) - torque) > 1e-3*most) fail_msg("step %d: %g N m", n, torque_of(&g));
    }
    /* at the start nobody knows the speed of the hull */
    const double first = most*dt*(0.5*most*dt/I - W), exact = 0.5*I*(w*w - W*W) - first;
    if (fabs(work - exact) > 1e-4*I*W*W) fail_msg("work %g J, exact %g", work, exact);
    rig_close(&g);
}

/* --- what is refused ----------------------------------------------------------------------------- */

static const char head[] =
    "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": 0.1, \"end_time\": 1,"
    "  \"fluids\": [ { \"name\": \"water\","
    "    \"fill\": [ { \"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 0.5] } } ] } ],"
    "  \"bodies\": [ { \"name\": \"flap\", \"box\": { \"min\": [0.2, 0, 0], \"max\": [0.3, 1, 1] },"
    "      \"dynamics\": \"free\", \"hinge\": { \"point\": [0, 0, 0], \"axis\": [0, 1, 0], \"motor\": %s } },"
    "    { \"name\": \"boat\", \"box\": { \"min\": [0.4, 0, 0], \"max\": [1, 1, 1] },"
    "      \"dynamics\": \"free\" } ],"
    "  \"joints\": [ { \"name\": \"a\", \"body\": \"boat\", \"point\": [0, 0, 0], %s } ] }";

static void mistakes_in_a_scene_are_told(void **state)
{
    (void)state;
    static const char *const cases[][3] = {
        { "{ \"speed\": 5, \"torque\": 2 }", "\"axis\": [0, 1, 0]",
          "bodies[0].hinge.motor: a motor has one of speed, angle, torque and file; this one has several" },
        { "{ \"torque_max\": 2 }", "\"axis\": [0, 1, 0]",
          "hinge.motor: a motor has one of speed, angle, torque and file; this one has none" },
        { "{ \"speed\": 5, \"torque_max\": -1 }", "\"axis\": [0, 1, 0]",
          "bodies[0].hinge.motor.torque_max: is -1, allowed is 1e-15 to 1e15 N m, or \"unlimited\"" },
        { "{ \"torque\": 5, \"torque_max\": 1 }", "\"axis\": [0, 1, 0]",
          "hinge.motor.torque_max: torque_max is for a motor by speed or angle; this one has a torque" },
        { "{ \"angle\": 0, \"amplitude\": 5 }", "\"axis\": [0, 1, 0]",
          "hinge.motor.amplitude: a motor that swings has an amplitude and a period" },
        { "{ \"angle\": 0, \"period\": 5 }", "\"axis\": [0, 1, 0]",
          "hinge.motor.period: a motor that swings has an amplitude and a period" },
        { "{ \"angle\": 30 }", "\"axis\": [0, 1, 0]",
          "hinge.motor.angle: the motor asks for 30 degrees at time 0" },
        { "{ \"speed\": 0 }", "\"kind\": \"ball\", \"motor\": { \"speed\": 5 }",
          "joints[0].motor: is of a hinge or slide, a ball joint has none" },
        { "{ \"speed\": 0 }", "\"kind\": \"fixed\", \"motor\": { \"speed\": 5 }",
          "joints[0].motor: is of a hinge or slide, a fixed joint has none" },
        { "{ \"speed\": 0 }", "\"axis\": [0, 1, 0], \"motor\": { \"file\": \"a.csv\", \"ramp\": 5 }",
          "joints[0].motor.file: a motor with a file has no amplitude, period, phase, start and ramp" },
        { "{ \"speed\": 0 }", "\"axis\": [0, 1, 0], \"motor\": { \"spede\": 5 }",
          "joints[0].motor.spede: unknown key; did you mean \"speed\"?" },
    };
    for (size_t k = 0; k < sizeof cases/sizeof *cases; k++) {
        char text[2000];
        snprintf(text, sizeof text, head, cases[k][0], cases[k][1]);
        expect_mistakes(text, &cases[k][2], 1);
    }
}

static void mistakes_in_a_guide_are_told(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        { "{ \"speed\": 5, \"force\": 2 }",
          "guide.motor: a motor has one of speed, position, force and file; this one has several" },
        { "{ \"force\": 5, \"force_max\": 1 }",
          "guide.motor.force_max: force_max is for a motor by speed or position; this one has a force" },
        { "{ \"position\": 0.3 }", "guide.motor.position: the motor asks for 0.3 m at time 0, where the "
          "guide is at 0; allowed are 0, or a ramp or force_max in which it gets there" },
        { "{ \"angle\": 3 }", "guide.motor.angle: unknown key" },
        { "{ \"position\": 0, \"force_max\": -1 }",
          "guide.motor.force_max: is -1, allowed is 1e-15 to 1e15 N, or \"unlimited\"" },
    };
    for (size_t k = 0; k < sizeof cases/sizeof *cases; k++) {
        char text[2000];
        snprintf(text, sizeof text, "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, "
                 "\"spacing\": 0.1, \"end_time\": 1, \"fluids\": [ { \"name\": \"water\", "
                 "\"fill\": [ { \"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 0.5] } } ] } ], "
                 "\"bodies\": [ { \"name\": \"buoy\", \"box\": { \"min\": [0.2, 0, 0], "
                 "\"max\": [0.3, 1, 1] }, \"dynamics\": \"free\", "
                 "\"guide\": { \"axis\": [0, 0, 1], \"motor\": %s } } ] }", cases[k][0]);
        expect_mistakes(text, &cases[k][1], 1);
    }
}

/* Whether a joint of a C program is refused in such words, at such a key. */
static void refuse(const tobi_joint_def *def, const char *key, const char *words)
{
    tobi_error err = { 0 };
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    w.spacing = 0.05;
    for (int a = 0; a < 3; a++) w.domain_max[a] = 1;
    assert_int_equal(tobi_world_create(&w, NULL, &world, &err), TOBI_OK);
    tobi_body_def b = tobi_default_body_def();
    b.name = "flap", b.dynamics = TOBI_FREE;
    for (int a = 0; a < 3; a++) b.box_min[a] = 0.2, b.box_max[a] = 0.4;
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_OK);
    const tobi_status status = tobi_world_add_joint(world, def, &err);
    if (status == TOBI_OK || !strstr(err.text, words) || strcmp(err.key, key) != 0)
        fail_msg("'%s' at '%s': %s at %s", words, key, err.text, err.key);
    tobi_world_destroy(world);
}

/* A file of a motor. */
static const char *write_file(const char *rows)
{
    FILE *f = fopen("motor.csv", "w");
    assert_non_null(f);
    fputs(rows, f);
    fclose(f);
    return "motor.csv";
}

static void mistakes_in_c_are_told(void **state)
{
    (void)state;
    tobi_joint_def right = tobi_default_joint_def(), d;
    right.name = "j", right.body = "flap", right.axis[1] = 1;
    d = right, d.motor.speed = 5, d.motor.angle = 5;
    refuse(&d, "motor", "a motor has one of speed");
    d = right, d.motor.speed = 5, d.motor.torque_max = -1;
    refuse(&d, "", "torque_max");
    d = right, d.motor.speed = 5, d.kind = TOBI_BETWEEN_BALL, d.axis[1] = 0;
    refuse(&d, "motor", "joint 'j': a ball joint has no motor; a hinge or slide has");
    d = right, d.motor.file = write_file("time,torque\n0,1\n1,2\n"), d.motor.torque_max = 5;
    refuse(&d, "motor.torque_max", "this one has a torque");
    d = right, d.motor.file = write_file("time,angle [deg]\n0,1\n1,2\n");
    refuse(&d, "motor.file", "the motor asks for 1 degrees at time 0");
    d = right, d.motor.file = write_file("time,angle,speed\n0,1,2\n");
    refuse(&d, "motor.file", "a motor has the columns time (s) and one of angle (degrees), speed");
    d = right, d.motor.file = write_file("time,x\n0,1\n");
    refuse(&d, "motor.file", "there is no column \"x\"; allowed are time (s) and one of angle");
    remove("motor.csv");
}

/* A motor of a body with a joint of the other kind, and a mistake in a file. */
static void refuse_body(const char *key, const char *words, double hinge, const tobi_motor_def *motor)
{
    tobi_error err = { 0 };
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    tobi_body_def b = tobi_default_body_def();
    w.spacing = 0.05;
    for (int a = 0; a < 3; a++) w.domain_max[a] = 1, b.box_min[a] = 0.2, b.box_max[a] = 0.4;
    assert_int_equal(tobi_world_create(&w, NULL, &world, &err), TOBI_OK);
    b.name = "flap", b.dynamics = TOBI_FREE;
    b.hinge_axis[1] = hinge, b.guide_axis[1] = 1 - hinge;
    if (strcmp(key, "hinge.motor") == 0) b.hinge_motor = *motor;
    else b.guide_motor = *motor;
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_INVALID);
    if (!strstr(err.text, words) || strncmp(err.key, key, strlen(key)) != 0)
        fail_msg("'%s' at '%s': %s at %s", words, key, err.text, err.key);
    tobi_world_destroy(world);
}

static void a_motor_is_of_the_joint_that_the_body_has(void **state)
{
    (void)state;
    tobi_motor_def by_load = tobi_default_body_def().hinge_motor, by_file = by_load;
    by_load.torque = 5;
    refuse_body("hinge.motor", "body 'flap' has a motor and no hinge that it turns", 0, &by_load);
    refuse_body("guide.motor", "body 'flap' has a motor and no guide that it moves it along", 1, &by_load);
    by_file.file = write_file("time,angle\n0,0\n1,2\n");
    refuse_body("guide.motor.file", "there is no column \"angle\"; allowed are time (s) and one of position "
                "(m), speed (m/s) and force (N), as it is of a guide", 0, &by_file);
    by_file.file = write_file("time,speed [degrees/s]\n0,0\n1,2\n");
    refuse_body("guide.motor.file", "column speed is in [degrees/s]; allowed is [m/s]", 0, &by_file);
    by_file.file = write_file("time,position\n0,1\n1,2\n");
    refuse_body("guide.motor.file", "the motor asks for 1 m at time 0, where the guide is at 0", 0, &by_file);
    remove("motor.csv");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_constant_torque_turns_by_half_alpha_t2),
        cmocka_unit_test(a_speed_is_reached_by_the_largest_torque),
        cmocka_unit_test(an_angle_is_kept_to_rounding_and_takes_the_torque_of_its_acceleration),
        cmocka_unit_test(an_angle_far_away_is_reached_without_overshoot),
        cmocka_unit_test(a_motor_keeps_angular_momentum),
        cmocka_unit_test(a_motor_stops_at_stops),
        cmocka_unit_test(a_moved_hull_takes_the_torque_of_the_bar),
        cmocka_unit_test(an_angle_on_a_turning_hull_is_kept),
        cmocka_unit_test(a_brake_on_a_turning_hull_has_the_moment_of_the_centrifugal_force),
        cmocka_unit_test(the_largest_torque_brings_a_bar_to_a_turning_hull),
        cmocka_unit_test(mistakes_in_a_scene_are_told),
        cmocka_unit_test(mistakes_in_c_are_told),
        cmocka_unit_test(mistakes_in_a_guide_are_told),
        cmocka_unit_test(a_motor_is_of_the_joint_that_the_body_has),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Springs, dampers and stops of joints between bodies: closed solutions of the damped oscillator, what a stop
   carries, energy that a stop never adds; what is refused. */
#include "rigid_rig.h"

static const double weightless[3] = { 0 };

static void open_rig(rig *g, int dimension, const double gravity[3])
{
    static const int periodic[3];
    const double lower[3] = { 0 }, upper[3] = { 4, 4, dimension == 2 ? 1 : 4 };
    rig_open(g, 4, gravity);
    if (dimension == 3) return;
    tobi_box_init(&g->box, 2, lower, upper, periodic, 0.4);
    g->world.dimension = 2;
}

/* A bar 1 m long from the hinge along x, 2 cm thick; along z is the axis. */
static tobi_body *add_bar(rig *g, double from)
{
    tobi_body_def def = rig_def();
    def.spacing = 0.05;
    return rig_box(g, def, (double[3]){ 1, 0.02, g->world.dimension == 2 ? 1 : 0.02 },
                   (double[3]){ from + 0.5, 2, g->world.dimension == 2 ? 0 : 2 });
}

static tobi_constraint *join(rig *g, int body, int to, double x)
{
    tobi_constraints *c = &g->joints;
    c->at = realloc(c->at, (size_t)(c->count + 1)*sizeof *c->at);
    tobi_constraint *j = &c->at[c->count++];
    *j = (tobi_constraint){ .kind = TOBI_BETWEEN_HINGE, .body = { body, to } };
    for (int side = 0; side < 2; side++) {
        const double point[3] = { x, 2, 2 };
        const int k = j->body[side];
        memcpy(j->point[side], point, sizeof point);
        if (k >= 0) vec3_sub(j->point[side], point, g->bodies[k].rigid.position);
        if (g->world.dimension == 2) j->point[side][2] = 0;
        j->axis[side][2] = 1;
    }
    return j;
}

/* About the end of a bar. */
static double moment_of(const tobi_body *b) { return b->rigid.inertia[8] + b->rigid.mass*0.25; }

static double angle_of(const rig *g, int joint)
{
    return tobi_constraint_angle(&g->joints.at[joint], g->bodies, 0);
}

/* q = rest (1 - e^(-zwt) (cos vt + zw/v sin vt)), v = w sqrt(1 - z^2). */
static double oscillate(double rest, double w, double z, double t)
{
    const double v = w*sqrt(1 - z*z);
    return rest*(1 - exp(-z*w*t)*(cos(v*t) + z*w/v*sin(v*t)));
}

static void a_spring_and_damper_swing_as_they_must(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++)
        for (int damped = 0; damped < 2; damped++) {
            rig g;
            open_rig(&g, dimension, weightless);
            tobi_body *b = add_bar(&g, 2);
            tobi_constraint *j = join(&g, 0, -1, 2);
            const double w = 3, z = 0.15*damped, I = moment_of(b), dt = 2*acos(-1)/w/1000;
            double most = 0;
            j->stiffness = I*w*w;
            j->damping = 2*z*w*I;
            j->rest = 0.6;
            rig_start(&g);
            for (int n = 1; n <= 3000; n++) {
                rig_step(&g, dt);
                most = fmax(most, fabs(angle_of(&g, 0) - oscillate(j->rest, w, z, g.time)));
            }
            /* the spring is of second order, the damper of first */
            if (most > (damped ? 3e-3 : 1e-4)*j->rest)
                fail_msg("%d-D: off by %g of %g", dimension, most, j->rest);
            rig_close(&g);
        }
}

/* Two bars on one axis through the middles of both: the frequency is that of both moments, momentum stays. */
static void free_bodies_swing_against_each_other(void **state)
{
    (void)state;
    rig g;
    open_rig(&g, 3, weightless);
    tobi_body_def def = rig_def();
    def.density = 300;
    rig_box(&g, def, (double[3]){ 1, 0.1, 0.1 }, (double[3]){ 2, 2, 2 });
    rig_box(&g, def, (double[3]){ 0.6, 0.3, 0.1 }, (double[3]){ 2, 2, 2 });
    tobi_constraint *j = join(&g, 0, 1, 2);
    const double I[2] = { g.bodies[0].rigid.inertia[8], g.bodies[1].rigid.inertia[8] };
    const double w = 5;
    j->stiffness = w*w/(1/I[0] + 1/I[1]);
    j->rest = 0.4;
    rig_start(&g);
    double most = 0;
    for (int n = 0; n < 3000; n++) {
        rig_step(&g, 1e-3);
        most = fmax(most, fabs(angle_of(&g, 0) - oscillate(j->rest, w, 0, g.time)));
    }
    assert_true(most < 1e-4*j->rest);
    assert_true(fabs(g.bodies[0].rigid.momentum[2] + g.bodies[1].rigid.momentum[2]) < 1e-12);
    rig_close(&g);
}

/* However stiff, steps are short enough: the energy of the spring stays. */
static void a_stiff_spring_is_stable(void **state)
{
    (void)state;
    for (double stiffness = 1; stiffness < 1e10; stiffness *= 1000) {
        rig g;
        open_rig(&g, 2, weightless);
        add_bar(&g, 2);
        tobi_constraint *j = join(&g, 0, -1, 2);
        j->stiffness = stiffness;
        j->rest = 0.1;
        rig_start(&g);
        const double energy = 0.5*stiffness*0.01;
        for (int n = 0; n < 2000; n++) {
            rig_step(&g, tobi_rigid_step_limit(g.state));
            const double off = angle_of(&g, 0) - j->rest,
                         now = (rig_energy(&g) + 0.5*stiffness*off*off)/energy;
            if (!(now > 0.9 && now < 1.1)) fail_msg("%g N m/rad: %g of the energy", stiffness, now);
        }
        rig_close(&g);
    }
}

static double energy_of(const rig *g)
{
    double sum = rig_energy(g);
    for (int k = 0; k < g->count; k++) sum += 10*g->bodies[k].rigid.mass*g->bodies[k].rigid.position[1];
    return sum;
}

static const double downward[3] = { 0, -10, 0 };

/* A bar falls onto its stop at -0.5 rad, lies there and tells what the stop carries. Pushed up, it leaves. */
static void a_stop_holds_a_bar(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        rig g;
        open_rig(&g, dimension, downward);
        tobi_body *b = add_bar(&g, 2);
        tobi_constraint *j = join(&g, 0, -1, 2);
        j->lower = -0.5;
        j->upper = 0.2;
        rig_start(&g);
        const double before = energy_of(&g);
        for (int n = 0; n < 1000; n++) {
            rig_step(&g, 1e-3);
            if (!(angle_of(&g, 0) >= j->lower - 1e-9)) fail_msg("the stop is at %g", angle_of(&g, 0));
            assert_true(energy_of(&g) < before + 1e-3*fabs(before));
        }
        const double moment = b->rigid.mass*10*0.5*cos(0.5);
        assert_true(fabs(angle_of(&g, 0) - j->lower) < 1e-9 && fabs(b->rigid.angular_velocity[2]) < 1e-9);
        if (!(fabs(j->info.moment[2]/moment - 1) < 1e-6))
            fail_msg("%g N m of %g", j->info.moment[2], moment);
        b->rigid.torque[2] = 3*moment;
        for (int n = 0; n < 2000; n++) {
            rig_step(&g, 1e-3);
            assert_true(angle_of(&g, 0) <= j->upper + 1e-9);
        }
        assert_true(fabs(angle_of(&g, 0) - j->upper) < 1e-9);
        rig_close(&g);
    }
}

/* Two bars that may bend by a tenth of a radian against each other: the energy never grows. */
static void an_elbow_loses_energy_only(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        rig g;
        open_rig(&g, dimension, downward);
        add_bar(&g, 2);
        add_bar(&g, 3);
        join(&g, 0, -1, 2);
        join(&g, 1, 0, 3);
        g.joints.at[1].lower = -0.1;
        g.joints.at[1].upper = 0.1;
        rig_start(&g);
        double before = energy_of(&g), most = 0, widest = 0;
        const double scale = fabs(10*g.bodies[0].rigid.mass);
        for (int n = 0; n < 5000; n++) {
            rig_step(&g, 1e-3);
            const double now = energy_of(&g);
            most = fmax(most, now - before);
            before = fmin(before, now);
            widest = fmax(widest, fabs(angle_of(&g, 1)));
        }
        if (!(most < 2e-3*scale)) fail_msg("the energy grew by %g of %g J", most, scale);
        assert_true(widest > 0.0999 && widest < 0.1 + 1e-9);
        assert_true(g.joints.at[0].info.gap < 1e-12 && g.joints.at[1].info.gap < 1e-12);
        rig_close(&g);
    }
}

static void refuse(const tobi_joint_def *def, const char *words)
{
    tobi_error err = { 0 };
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    tobi_body_def b = tobi_default_body_def();
    w.spacing = 0.05;
    for (int a = 0; a < 3; a++) w.domain_max[a] = 1;
    assert_int_equal(tobi_world_create(&w, NULL, &world, &err), TOBI_OK);
    b.name = "flap";
    b.dynamics = TOBI_FREE;
    for (int a = 0; a < 3; a++) b.box_min[a] = 0.2, b.box_max[a] = 0.4;
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_OK);
    assert_int_equal(tobi_world_add_joint(world, def, &err), TOBI_INVALID);
    if (!strstr(err.text, words)) fail_msg("'%s' is not in '%s'", words, err.text);
    tobi_world_destroy(world);
}

static void wrong_stops_and_springs_are_refused(void **state)
{
    (void)state;
    const tobi_joint_def right = { .name = "j", .body = "flap", .point = { 0.3, 0.3, 0.3 },
                                   .axis = { 0, 1, 0 } };
    tobi_joint_def d = right;
    d.lower = 5;
    refuse(&d, "lower");
    d = right, d.upper = 200;
    refuse(&d, "upper");
    d = right, d.stiffness = -1;
    refuse(&d, "stiffness");
    d = right, d.rest = 5;
    refuse(&d, "joint 'j': rest is of a spring, which needs a stiffness");
    d = right, d.kind = TOBI_BETWEEN_BALL, d.axis[1] = 0, d.damping = 1;
    refuse(&d, "joint 'j': a ball joint has no stops, spring or damper; a hinge or slide has");
}

/* About z at (1, 2) by user[0] rad/s. */
static tobi_status turn(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                        tobi_error *err)
{
    const double angle = t**(const double *)user;
    (void)err;
    for (int64_t i = 0; i < n; i++) {
        const double x = rest[i][0] - 1, y = rest[i][1] - 2;
        out[i][0] = 1 + cos(angle)*x - sin(angle)*y;
        out[i][1] = 2 + sin(angle)*x + cos(angle)*y;
        out[i][2] = rest[i][2];
    }
    return TOBI_OK;
}

/* A hub turns away below a bar that rests; from the stop on it takes the bar along, without a moment. The
   rate of its frame is the sine of the turn in a step: of second order. */
static void a_stop_of_a_turning_hub_takes_the_bar_along(void **state)
{
    (void)state;
    double rate = 0.8;
    rig g;
    open_rig(&g, 3, weightless);
    add_bar(&g, 1);
    tobi_body_def hub = rig_def();
    hub.dynamics = TOBI_PRESCRIBED;
    hub.motion = turn, hub.motion_user = &rate, hub.motion_rigid = 1;
    rig_box(&g, hub, (double[3]){ 0.1, 0.1, 0.1 }, (double[3]){ 1, 2, 2 });
    tobi_constraint *j = join(&g, 0, 1, 1);
    j->lower = -0.3, j->upper = 0.3;
    rig_start(&g);
    for (int n = 0; n < 1000; n++) {
        rig_step(&g, 1e-3);
        const double exact = fmax(-0.3, -rate*g.time), spin = g.bodies[0].rigid.angular_velocity[2];
        const double off = angle_of(&g, 0) - exact;
        if (fabs(off) > 1e-6) fail_msg("off by %g rad at %g s", off, g.time);
        const double moment = j->info.moment[2];
        if (g.time > 0.38 && (fabs(spin - rate) > 1e-6 || fabs(moment) > 1e-6))
            fail_msg("%.12g rad/s, %g N m at %g s", spin, moment, g.time);
    }
    rig_close(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_spring_and_damper_swing_as_they_must),
        cmocka_unit_test(free_bodies_swing_against_each_other),
        cmocka_unit_test(a_stiff_spring_is_stable),
        cmocka_unit_test(a_stop_holds_a_bar),
        cmocka_unit_test(a_stop_of_a_turning_hub_takes_the_bar_along),
        cmocka_unit_test(an_elbow_loses_energy_only),
        cmocka_unit_test(wrong_stops_and_springs_are_refused)
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

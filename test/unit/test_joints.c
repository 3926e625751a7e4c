/* Hinges and guides against closed solutions: a pendulum of finite amplitude, its energy, springs, dampers,
   stops, slides, contact; what is refused. */
#include "rigid_rig.h"

static const double weightless[3] = { 0 }, downward[3] = { 0, 0, -10 };

/* A rod of 1 kg, 1 m long, that hangs from a hinge at its upper end, turned by an angle about y. */
static tobi_body *hang_rod(rig *g, tobi_body_def def, double angle)
{
    const double degrees = angle*180/acos(-1);
    def.density = 1/(0.02*0.02);
    def.spacing = 0.05;
    def.hinge_point[0] = def.hinge_point[1] = def.hinge_point[2] = 2;
    def.hinge_axis[1] = 3;
    def.rotation_axis[1] = 1;
    def.rotation_axis[2] = 0;
    def.rotation_angle = degrees;
    return rig_box(g, def, (double[3]){ 0.02, 0.02, 1 },
                   (double[3]){ 2 - 0.5*sin(angle), 2, 2 - 0.5*cos(angle) });
}

/* s, from rising zeros of x about `about`. */
static double find_period(rig *g, double about, double dt, int cycles)
{
    double first = 0, last = 0, before = g->bodies[0].rigid.position[0] - about;
    for (int found = 0; found <= cycles;) {
        const double t = g->time;
        rig_step(g, dt);
        const double now = g->bodies[0].rigid.position[0] - about;
        if (before < 0 && now >= 0) {
            last = t + (g->time - t)*before/(before - now);
            if (found++ == 0) first = last;
        }
        before = now;
    }
    return (last - first)/cycles;
}

/* Arithmetic-geometric mean: T = T0/agm(1, cos(theta/2)). */
static double lengthen(double angle)
{
    double a = 1, b = cos(0.5*angle);
    for (int k = 0; k < 10; k++) {
        const double mean = 0.5*(a + b);
        b = sqrt(a*b);
        a = mean;
    }
    return 1/a;
}

/* J, with the height of the centre over the hinge. */
static double energy(const rig *g)
{
    return rig_energy(g) + 10*(g->bodies[0].rigid.position[2] - 2);
}

static void a_pendulum_has_its_period_at_any_amplitude(void **state)
{
    (void)state;
    const double inertia = 1.0/12*(1 + 0.02*0.02) + 0.25, angles[] = { 0.1, 1, 2.5 };
    for (int k = 0; k < 3; k++) {
        rig g;
        rig_open(&g, 4, downward);
        hang_rod(&g, rig_def(), angles[k]);
        rig_start(&g);
        const double exact = 2*acos(-1)*sqrt(inertia/(10*0.5))*lengthen(angles[k]);
        assert_true(fabs(find_period(&g, 2, 1e-3, 10)/exact - 1) < 2e-5);
        rig_close(&g);
    }
}

static void a_pendulum_keeps_its_energy_and_its_axis(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 4, downward);
    tobi_body *b = hang_rod(&g, rig_def(), 2);
    rig_start(&g);
    const double start = energy(&g);
    double most = 0;
    for (int k = 0; k < 40000; k++) {
        rig_step(&g, 2e-3);
        if (k > 30000) most = fmax(most, fabs(energy(&g) - start));
    }
    assert_true(most < 1e-4*10);                       /* it swings about the start, and does not fade */
    const double *x = b->rigid.position;
    assert_true(fabs(hypot(x[0] - 2, x[2] - 2) - 0.5) < 1e-12 && fabs(x[1] - 2) < 1e-12);
    rig_close(&g);
}

/* Half the period and the energy of both: no error of the first order. */
static void the_period_is_of_second_order(void **state)
{
    (void)state;
    const double inertia = 1.0/12*(1 + 0.02*0.02) + 0.25, exact = 2*acos(-1)*sqrt(inertia/5)*lengthen(1);
    double error[2];
    for (int k = 0; k < 2; k++) {
        rig g;
        rig_open(&g, 4, downward);
        hang_rod(&g, rig_def(), 1);
        rig_start(&g);
        error[k] = fabs(find_period(&g, 2, k ? 0.01 : 0.02, 20) - exact);
        rig_close(&g);
    }
    assert_true(error[0]/error[1] > 3.5 && error[0]/error[1] < 4.6);
}

static void a_spring_at_a_hinge_has_its_period(void **state)
{
    (void)state;
    rig g;
    tobi_body_def def = rig_def();
    def.hinge_stiffness = 30;
    def.angular_velocity[1] = 0.5;
    rig_open(&g, 4, weightless);
    hang_rod(&g, def, 0);
    rig_start(&g);
    const double inertia = 1.0/12*(1 + 0.02*0.02) + 0.25, w = sqrt(30/inertia);
    assert_true(tobi_rigid_step_limit(g.state) <= 1/(3*w) + 1e-12);
    assert_true(fabs(find_period(&g, 2, 1e-3, 10)*w/(2*acos(-1)) - 1) < 2e-5);
    double far = 0;
    for (int k = 0; k < 1000; k++) {
        rig_step(&g, 1e-3);
        far = fmax(far, fabs(tobi_joint_position(&g.bodies[0].rigid)));
    }
    assert_true(fabs(far/(0.5/w) - 1) < 1e-3);
    rig_close(&g);
}

static void dampers_brake_exactly(void **state)
{
    (void)state;
    rig g;
    tobi_body_def def = rig_def();
    def.hinge_damping = 0.2;
    def.angular_velocity[1] = 1;
    rig_open(&g, 4, weightless);
    tobi_body *b = hang_rod(&g, def, 0);
    rig_start(&g);
    rig_advance(&g, 2);
    const double inertia = 1.0/12*(1 + 0.02*0.02) + 0.25;
    assert_true(fabs(b->rigid.angular_velocity[1]/exp(-0.2*2/inertia) - 1) < 1e-9);
    rig_close(&g);
}

static tobi_body *slide_cube(rig *g, tobi_body_def def)
{
    def.density = 1e3;
    def.spacing = 0.02;
    return rig_box(g, def, (double[3]){ 0.1, 0.1, 0.1 }, (double[3]){ 2, 2, 2 });
}

static void a_body_slides_down_an_inclined_guide(void **state)
{
    (void)state;
    rig g;
    tobi_body_def def = rig_def();
    def.guide_axis[0] = 3;
    def.guide_axis[2] = -4;
    rig_open(&g, 4, downward);
    tobi_body *b = slide_cube(&g, def);
    rig_start(&g);
    rig_advance(&g, 0.5);
    const double way = 0.5*10*0.8*0.25;                /* g sin(slope) t^2/2 */
    assert_true(fabs(b->rigid.position[0] - 2 - 0.6*way) < 1e-12);
    assert_true(fabs(b->rigid.position[2] - 2 + 0.8*way) < 1e-12 && fabs(b->rigid.position[1] - 2) < 1e-12);
    assert_true(b->rigid.orientation[0] == 1);
    rig_close(&g);
}

static void a_line_pulls_a_body_along_its_guide(void **state)
{
    (void)state;
    rig g;
    tobi_body_def def = rig_def();
    tobi_line line = { .kind = TOBI_LINE_SPRING, .stiffness = 40, .length = 0.5, .to_body = -1,
                       .to = { 1.5, 2, 2 } };
    def.guide_axis[0] = 1;
    rig_open(&g, 4, downward);
    tobi_body *b = slide_cube(&g, def);
    b->rigid.position[0] = 2.1;
    g.world.lines = &line;
    g.world.line_count = 1;
    rig_start(&g);
    assert_true(fabs(find_period(&g, 2, 1e-3, 10)*sqrt(40)/(2*acos(-1)) - 1) < 1e-4);
    assert_true(fabs(b->rigid.position[2] - 2) < 1e-12);
    line.damping = 2*sqrt(40);
    rig_advance(&g, 4);
    assert_true(fabs(b->rigid.position[0] - 2) < 1e-6);
    rig_close(&g);
}

static void stops_hold_and_bounce(void **state)
{
    (void)state;
    for (int bounces = 0; bounces < 2; bounces++) {
        rig g;
        tobi_body_def def = rig_def();
        def.guide_axis[2] = 1;
        def.guide_lower = -0.2;
        def.guide_upper = 0.1;
        def.restitution = bounces ? 0.5 : 0;
        rig_open(&g, 4, downward);
        tobi_body *b = slide_cube(&g, def);
        rig_start(&g);
        double least = 0, highest = -1;
        for (int k = 0; k < 800; k++) {
            rig_step(&g, 1e-3);
            const double q = tobi_joint_position(&b->rigid);
            least = fmin(least, q);
            if (least <= -0.2 + 1e-9) highest = fmax(highest, q);
        }
        assert_true(least >= -0.2 - 1e-12);
        assert_true(bounces ? fabs(highest + 0.15) < 2e-3 : fabs(highest + 0.2) < 1e-9);
        tobi_rigid_set_force(g.state, 0, (double[3]){ 0, 0, 30 }, weightless);      /* and lets go */
        rig_advance(&g, 0.1);
        assert_true(tobi_joint_position(&b->rigid) > -0.2 + 0.05);
        rig_close(&g);
    }
}

/* A ball of 1 kg hits a rod of moment of inertia I at a distance a from its hinge: plastic, centre to rod. */
static void a_ball_hits_a_door(void **state)
{
    (void)state;
    rig g;
    tobi_body_def def = rig_def(), ball = rig_def();
    rig_open(&g, 4, weightless);
    tobi_body *rod = hang_rod(&g, def, 0);
    ball.mass = 1;
    ball.spacing = 0.02;
    ball.velocity[0] = 2;
    ball.friction_coefficient = 0;
    ball.restitution = 1;
    tobi_body *b = rig_ball(&g, ball, 0.05, (double[3]){ 1.8, 2, 1.2 });
    rod = &g.bodies[0];
    rig_start(&g);
    rig_advance(&g, 0.3);
    const double inertia = 1.0/12*(1 + 0.02*0.02) + 0.25, arm = 0.8;
    const double spin = 2*2*arm/(inertia + arm*arm);          /* elastic, angular momentum about the hinge */
    assert_true(fabs(fabs(rod->rigid.angular_velocity[1]) - spin) < 2e-3*spin);
    assert_true(fabs(inertia*fabs(rod->rigid.angular_velocity[1]) + arm*b->rigid.velocity[0] - arm*2) < 2e-3);
    rig_close(&g);
}

static void refuse(tobi_body_def def, const char *text)
{
    rig g;
    tobi_body b;
    tobi_error err = { 0 };
    rig_open(&g, 4, downward);
    def.name = "door";
    def.box_max[0] = def.box_max[1] = def.box_max[2] = 1;
    assert_int_equal(tobi_body_create(&b, &def, &g.box, 0.5, &err), TOBI_INVALID);
    if (!strstr(err.text, text)) fail_msg("%s", err.text);
}

static void mistakes_are_refused(void **state)
{
    (void)state;
    tobi_body_def good = rig_def(), def;
    good.hinge_axis[1] = 1;
    def = good;
    def.dynamics = TOBI_PRESCRIBED;
    refuse(def, "hinges and guides are for free and controlled bodies");
    def = good;
    def.guide_axis[0] = 1;
    refuse(def, "has a hinge and a guide; it may have one");
    def = good;
    def.locked = "x";
    refuse(def, "has locked axes and a hinge or guide");
    def = good;
    def.velocity[0] = 1;
    refuse(def, "cannot start with that velocity: its hinge leaves it the turn about the axis, set off by");
    def.velocity[0] = 0;
    def.angular_velocity[2] = 1;
    refuse(def, "cannot start with that angular_velocity: its hinge");
    def = rig_def();
    def.guide_axis[0] = 1;
    def.velocity[2] = 1;
    refuse(def, "cannot start with that velocity: its guide leaves it the way along the axis");
    def = good;
    def.hinge_lower = 5;
    def.hinge_upper = 10;
    refuse(def, "lower is 0 or below, upper is 0 or above");
}

static void axes_in_2d_are_refused(void **state)
{
    (void)state;
    const double lower[3] = { 0 };
    for (int k = 0; k < 2; k++) {
        tobi_body_def def = rig_def();
        tobi_rigid r = { .kind = TOBI_FREE, .mass = 1, .orientation = { 1 } };
        tobi_error err = { 0 };
        if (k) def.guide_axis[2] = 1;
        else def.hinge_axis[0] = 1;
        assert_int_equal(tobi_joint_init(&r, &def, lower, 2, &err), TOBI_INVALID);
        if (!strstr(err.text, k ? "the axis of a guide has no z" : "the axis of a hinge is along z in 2-D"))
            fail_msg("%s", err.text);
    }
}

/* A disc in water in 2-D: by a guide along y, or with x and the turn locked. */
static tobi_world *float_disc(const char *method, int guide, tobi_error *err)
{
    tobi_world_def d = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def disc = tobi_default_body_def();
    tobi_world *w;
    d.method = method;
    d.dimension = 2;
    d.domain_max[0] = d.domain_max[1] = 0.4;
    d.domain_max[2] = 0;
    d.gravity[1] = -9.81;
    d.gravity[2] = 0;
    d.spacing = 0.02;
    d.threads = 1;
    if (tobi_world_create(&d, NULL, &w, err) != TOBI_OK) return NULL;
    fill.box_max[0] = 0.4;
    fill.box_max[1] = 0.24;
    disc.dynamics = TOBI_FREE;
    disc.density = 400;
    disc.sphere_centre[0] = 0.19;
    disc.sphere_centre[1] = 0.2;
    disc.sphere_radius = 0.07;
    disc.guide_axis[1] = guide;
    disc.locked = guide ? NULL : "x,turn";
    assert_int_equal(tobi_world_add_fluid(w, &fluid, &fill, 1, err), TOBI_OK);
    assert_int_equal(tobi_world_add_body(w, &disc, err), TOBI_OK);
    return w;
}

static double find_height(tobi_world *w, double end)
{
    tobi_error err = { 0 };
    tobi_body_info info;
    if (tobi_world_advance(w, end, NULL, &err) != TOBI_OK) fail_msg("%s", err.text);
    tobi_world_body(w, 0, &info);
    return info.position[1];
}

static void water_sees_a_guide_as_locked_axes(void **state)
{
    (void)state;
    static const char *const methods[] = { "dfsph", "isph", "wcsph" };
    for (int k = 0; k < 3; k++) {
        tobi_error err = { 0 };
        tobi_world *a = float_disc(methods[k], 0, &err), *b = float_disc(methods[k], 1, &err);
        if (!a || !b) fail_msg("%s", err.text);
        const double locked = find_height(a, 0.1), guided = find_height(b, 0.1);
        assert_true(locked > 0.202);                   /* it rises */
        if (!(fabs(locked - guided) < 0.01*(locked - 0.2)))
            fail_msg("%s: %.9g %.9g", methods[k], locked, guided);
        tobi_world_destroy(a);
        tobi_world_destroy(b);
    }
}

static void a_restart_has_the_same_bits(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    const char *path = "test_joints.tobi";
    tobi_world *a = float_disc("dfsph", 1, &err), *b = float_disc("dfsph", 1, &err);
    find_height(a, 0.05);
    assert_int_equal(tobi_world_save(a, path, &err), TOBI_OK);
    const double whole = find_height(a, 0.1);
    if (tobi_world_load(b, path, &err) != TOBI_OK) fail_msg("%s", err.text);
    assert_true(find_height(b, 0.1) == whole);
    assert_true(tobi_world_hash(a) == tobi_world_hash(b));
    tobi_world_destroy(a);
    tobi_world_destroy(b);
    remove(path);
}

static tobi_status hold_all(void *user, const tobi_control_input *in, tobi_control_output *out,
                            tobi_error *err)
{
    (void)user, (void)in, (void)err;
    out->hold = "turn";
    return TOBI_OK;
}

static void a_program_cannot_hold_a_hinge(void **state)
{
    (void)state;
    rig g;
    tobi_body_def def = rig_def();
    tobi_error err = { 0 };
    def.dynamics = TOBI_CONTROLLED;
    def.control = hold_all;
    rig_open(&g, 4, downward);
    hang_rod(&g, def, 0.1);
    rig_start(&g);
    assert_int_equal(tobi_rigid_step(g.state, 0, 1e-3, &err), TOBI_SCRIPT);
    if (!strstr(err.text, "nothing can be held of a body on a hinge or guide")) fail_msg("%s", err.text);
    rig_close(&g);
}

/* --- loads of bearings -------------------------------------------------------------------------- */

/* m g along the rod by its angle, and m v^2/L; across it m g sin less m L times the angular acceleration. */
static void a_hinge_tells_the_load_of_a_pendulum(void **state)
{
    (void)state;
    const double inertia = 1.0/12*(1 + 0.02*0.02) + 0.25, dt = 1e-3;
    for (int k = 0; k < 2; k++) {
        rig g;
        rig_open(&g, 4, downward);
        tobi_body *b = hang_rod(&g, rig_def(), k ? 1.2 : 0);
        const tobi_joint_info *info = &b->rigid.joint.info;
        rig_start(&g);
        for (int i = 0; i < 2000; i++) {
            const double before = tobi_joint_position(&b->rigid), rate = tobi_joint_rate(&b->rigid);
            rig_step(&g, dt);
            /* the rod hangs straight down at -1.2 from where it starts */
            const double q = 0.5*(before + tobi_joint_position(&b->rigid)) + (k ? 1.2 : 0),
                         w = 0.5*(rate + tobi_joint_rate(&b->rigid)), s = sin(q), c = cos(q);
            const double along = 10*c + 0.5*w*w, across = 10*s - 0.5*10*0.5*s/inertia;
            const double *f = info->force, *m = info->moment;
            assert_true(fabs(s*f[0] + c*f[2] - along) < 5e-5 && fabs(f[1]) < 1e-12);
            assert_true(fabs(-c*f[0] + s*f[2] - across) < 5e-5);
            assert_true(fabs(m[0]) + fabs(m[1]) + fabs(m[2]) < 1e-10);
        }
        assert_true(k || fabs(info->force[2] - 10) < 1e-12);
        rig_close(&g);
    }
}

/* A rod lies level on its stop: the arm of its weight is half of its length. A spring is not told. */
static void a_stop_tells_its_moment(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        rig g;
        tobi_body_def def = rig_def();
        def.hinge_lower = -0.001;
        def.hinge_upper = 60;
        def.hinge_stiffness = k ? 0.5 : 0;
        rig_open(&g, 4, downward);
        tobi_body *b = hang_rod(&g, def, acos(0));
        rig_start(&g);
        rig_advance(&g, 1);
        const tobi_joint_info *i = &b->rigid.joint.info;
        assert_true(fabs(i->angle + 0.001) < 1e-9);
        assert_true(fabs(i->force[2] - 10) < 1e-9 && fabs(i->force[0]) < 1e-9);
        assert_true(fabs(i->moment[1] - (5 - (k ? 0.5*0.001*acos(-1)/180 : 0))) < 1e-6);
        rig_close(&g);
    }
}

/* A cube of 1 kg slides down a slope of 4 in 5 and is wrung: the guide bears m g cos, and the torque. Air
   brakes along the guide alone. */
static void a_guide_tells_its_load(void **state)
{
    (void)state;
    rig g;
    tobi_body_def def = rig_def();
    def.guide_axis[0] = 3;
    def.guide_axis[2] = -4;
    def.air_resistance = 0.5;
    memcpy(def.torque, (double[3]){ 1, 2, 3 }, sizeof def.torque);
    rig_open(&g, 4, downward);
    const tobi_joint_info *i = &slide_cube(&g, def)->rigid.joint.info;
    rig_start(&g);
    rig_advance(&g, 0.1);
    assert_true(fabs(i->force[0] - 6*0.8) < 1e-9 && fabs(i->force[2] - 6*0.6) < 1e-9);
    for (int a = 0; a < 3; a++) assert_true(fabs(i->moment[a] + 1 + a) < 1e-9);
    rig_close(&g);
}

/* After the joints of the world, by the name of the body, which no joint may have then. */
static void a_world_tells_the_loads(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    tobi_joint_info info;
    tobi_world *w = float_disc("wcsph", 1, &err);
    tobi_joint_def joint = tobi_default_joint_def();
    joint.name = joint.body = "body";
    assert_int_equal(tobi_world_add_joint(w, &joint, &err), TOBI_INVALID);
    assert_string_equal(err.text, "joint 'body': body 0 has that name already");
    assert_int_equal(tobi_world_joint_count(w), 1);
    assert_string_equal(tobi_world_joint(w, 0, NULL), "body");
    find_height(w, 0.01);
    assert_non_null(tobi_world_joint(w, 0, &info));
    assert_true(info.force[0] != 0 && info.force[1] == 0);          /* the water is not even */
    assert_null(tobi_world_joint(w, 1, NULL));
    tobi_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pendulum_has_its_period_at_any_amplitude),
        cmocka_unit_test(a_pendulum_keeps_its_energy_and_its_axis),
        cmocka_unit_test(the_period_is_of_second_order),
        cmocka_unit_test(a_spring_at_a_hinge_has_its_period),
        cmocka_unit_test(dampers_brake_exactly),
        cmocka_unit_test(a_body_slides_down_an_inclined_guide),
        cmocka_unit_test(a_line_pulls_a_body_along_its_guide),
        cmocka_unit_test(stops_hold_and_bounce),
        cmocka_unit_test(a_ball_hits_a_door),
        cmocka_unit_test(water_sees_a_guide_as_locked_axes),
        cmocka_unit_test(a_restart_has_the_same_bits),
        cmocka_unit_test(mistakes_are_refused),
        cmocka_unit_test(axes_in_2d_are_refused),
        cmocka_unit_test(a_program_cannot_hold_a_hinge),
        cmocka_unit_test(a_hinge_tells_the_load_of_a_pendulum),
        cmocka_unit_test(a_stop_tells_its_moment),
        cmocka_unit_test(a_guide_tells_its_load),
        cmocka_unit_test(a_world_tells_the_loads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

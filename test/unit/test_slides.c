/* Slides between bodies: reduced mass, carousel, momentum and energy of bodies that tumble, stops, motors,
   carriages, a slider crank; what is refused. */
#include "rigid_rig.h"
#include "mistakes.h"

static const double weightless[3] = { 0 }, downward[3] = { 0, -10, 0 };

static void open_rig(rig *g, int dimension, const double gravity[3])
{
    static const int periodic[3];
    const double lower[3] = { 0 }, upper[3] = { 8, 8, dimension == 2 ? 1 : 8 };
    rig_open(g, 8, gravity);
    if (dimension == 3) return;
    tobi_box_init(&g->box, 2, lower, upper, periodic, 0.4);
    g->world.dimension = 2;
}

static tobi_body *add_box(rig *g, double density, double side, double x, double y)
{
    const int flat = g->world.dimension == 2;
    tobi_body_def def = rig_def();
    def.spacing = 0.05;
    def.density = density;
    return rig_box(g, def, (double[3]){ side, 0.5*side, flat ? 1 : 0.7*side },
                   (double[3]){ x, y, flat ? 0 : 2 });
}

/* At a place, of bodies that have not turned yet; way: of length 1, NULL: a hinge about z. */
static tobi_constraint *join(rig *g, int body, int to, double x, double y, const double way[3])
{
    tobi_constraints *c = &g->joints;
    c->at = realloc(c->at, (size_t)(c->count + 1)*sizeof *c->at);
    tobi_constraint *j = &c->at[c->count++];
    *j = (tobi_constraint){ .kind = way ? TOBI_BETWEEN_SLIDE : TOBI_BETWEEN_HINGE, .body = { body, to },
                            .slides = way != NULL, .motor.most = INFINITY };
    for (int side = 0; side < 2; side++) {
        const double point[3] = { x, y, g->world.dimension == 2 ? 0 : 2 };
        const int k = j->body[side];
        memcpy(j->point[side], point, sizeof point);
        if (k >= 0) vec3_sub(j->point[side], point, g->bodies[k].rigid.position);
        if (way && g->world.dimension == 3) memcpy(j->axis[side], way, 3*sizeof *way);
        else j->axis[side][2] = 1;
    }
    if (way) memcpy(j->way, way, sizeof j->way);
    return j;
}

static double place_of(const rig *g, int joint)
{
    return tobi_constraint_place(&g->joints.at[joint], g->bodies, 0);
}

static double rate_of(const rig *g, int joint)
{
    return tobi_constraint_rate(&g->joints.at[joint], g->bodies);
}

static void push(rig *g, int body, double x, double y, double z)
{
    const double v[3] = { x, y, z };
    memcpy(g->bodies[body].rigid.velocity, v, sizeof v);
}

static void spin(rig *g, int body, const double w[3])
{
    tobi_rigid *r = &g->bodies[body].rigid;
    memcpy(r->angular_velocity, w, sizeof r->angular_velocity);
    for (int a = 0; a < 3; a++)
        r->momentum[a] = r->inertia[3*a]*w[0] + r->inertia[3*a + 1]*w[1] + r->inertia[3*a + 2]*w[2];
}

/* Both momenta of all bodies, the second about the origin; *size: of the parts. */
static void find_momentum(const rig *g, double p[6], double *size)
{
    memset(p, 0, 6*sizeof *p);
    *size = 0;
    for (int k = 0; k < g->count; k++) {
        const tobi_rigid *r = &g->bodies[k].rigid;
        double orbit[3];
        vec3_cross(orbit, r->position, r->velocity);
        for (int a = 0; a < 3; a++) {
            p[a] += r->mass*r->velocity[a];
            p[3 + a] += r->mass*orbit[a] + r->momentum[a];
            *size += r->mass*fabs(r->velocity[a]) + r->mass*fabs(orbit[a]);
        }
    }
}

static double energy_of(const rig *g)
{
    double sum = rig_energy(g);
    for (int k = 0; k < g->count; k++)
        if (g->bodies[k].rigid.kind != TOBI_PRESCRIBED)
            sum -= g->bodies[k].rigid.mass*vec3_dot(g->world.gravity, g->bodies[k].rigid.position);
    for (int k = 0; k < g->joints.count; k++) sum += tobi_constraint_energy(&g->joints.at[k], g->bodies);
    return sum;
}

static double reduced_mass(const rig *g)
{
    return 1/(1/g->bodies[0].rigid.mass + 1/g->bodies[1].rigid.mass);
}

/* rest (1 - e^(-zwt) (cos vt + zw/v sin vt)), v = w sqrt(1 - z^2). */
static double oscillate(double rest, double w, double z, double t)
{
    const double v = w*sqrt(1 - z*z);
    return rest*(1 - exp(-z*w*t)*(cos(v*t) + z*w/v*sin(v*t)));
}

static const double slant[2][3] = { { 0.6, 0.8, 0 }, { 0.48, 0.64, 0.6 } };

static void two_masses_on_a_spring_swing_by_the_reduced_mass(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++)
        for (int damped = 0; damped < 2; damped++) {
            rig g;
            open_rig(&g, dimension, weightless);
            add_box(&g, 300, 0.5, 2, 2);
            add_box(&g, 1000, 0.4, 2, 2);
            tobi_constraint *j = join(&g, 0, 1, 2, 2, slant[dimension - 2]);
            const double w = 3, z = 0.15*damped, dt = 2*acos(-1)/w/1000;
            double most = 0, p[6], size = 0, work = 0;
            j->stiffness = reduced_mass(&g)*w*w;
            j->damping = 2*z*w*reduced_mass(&g);
            j->rest = 0.3;
            rig_start(&g);
            const double before = energy_of(&g);
            for (int n = 1; n <= 3000; n++) {
                rig_step(&g, dt);
                most = fmax(most, fabs(place_of(&g, 0) - oscillate(j->rest, w, z, g.time)));
                work += dt*j->info.power;
            }
            if (most > (damped ? 3e-3 : 1e-4)*j->rest) fail_msg("%d-D: off by %g m", dimension, most);
            find_momentum(&g, p, &size);
            for (int a = 0; a < 6; a++) assert_true(fabs(p[a]) < 1e-11);
            if (fabs(energy_of(&g) + work - before) > (damped ? 1e-2 : 1e-5)*before)
                fail_msg("%g of %g J left, %g taken", energy_of(&g), before, work);
            assert_true(fabs(j->info.position - place_of(&g, 0)) < 1e-15 && j->info.gap < 1e-12);
            rig_close(&g);
        }
}

/* About z at (2, 2) by rate t + sway sin(3 t), and along x by a t^2/2. */
typedef struct course { double rate, sway, a; } course;

static tobi_status follow(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                          tobi_error *err)
{
    const course *c = user;
    const double turn = c->rate*t + c->sway*sin(3*t);
    (void)err;
    for (int64_t i = 0; i < n; i++) {
        const double x = rest[i][0] - 2, y = rest[i][1] - 2;
        out[i][0] = 2 + cos(turn)*x - sin(turn)*y + 0.5*c->a*t*t;
        out[i][1] = 2 + sin(turn)*x + cos(turn)*y;
        out[i][2] = rest[i][2];
    }
    return TOBI_OK;
}

static void add_hub(rig *g, course *c)
{
    tobi_body_def def = rig_def();
    const int flat = g->world.dimension == 2;
    def.dynamics = TOBI_PRESCRIBED;
    def.motion = follow, def.motion_user = c, def.motion_rigid = 1;
    rig_box(g, def, (double[3]){ 0.2, 0.2, flat ? 1 : 0.2 }, (double[3]){ 2, 2, flat ? 0 : 2 });
}

/* The largest error of a slider on an arm that turns, of r0 cosh(w t). */
static double ride(int dimension, double dt, double point)
{
    const double w = 1.3, r0 = 0.4, along[3] = { 1, 0, 0 };
    course c = { .rate = w };
    rig g;
    open_rig(&g, dimension, weightless);
    add_box(&g, 500, 0.2, 2 + r0, 2);
    add_hub(&g, &c);
    join(&g, 0, 1, 2 + point, 2, along);
    push(&g, 0, 0, w*r0, 0);
    spin(&g, 0, (double[3]){ 0, 0, w });
    rig_start(&g);
    double most = 0;
    while (g.time < 1.5) {
        rig_step(&g, dt);
        const tobi_rigid *r = &g.bodies[0].rigid;
        const double x = r->position[0] - 2, y = r->position[1] - 2, R = r0*cosh(w*g.time);
        most = fmax(most, fabs(sqrt(x*x + y*y)/R - 1) + fabs(x*sin(w*g.time) - y*cos(w*g.time)));
        most = fmax(most, fabs(rate_of(&g, 0)/(r0*w*sinh(w*g.time)) - 1)*fmin(1, g.time));
        const double along_turn = r->velocity[1]*cos(w*g.time) - r->velocity[0]*sin(w*g.time);
        most = fmax(most, fabs(along_turn/(w*R) - 1));
        if (!(g.joints.at[0].info.gap < 1e-12)) fail_msg("a gap of %g m", g.joints.at[0].info.gap);
    }
    rig_close(&g);
    return most;
}

static void a_slider_on_a_carousel_goes_out_by_a_hyperbolic_cosine(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++)
        for (double point = 0; point < 0.9; point += 0.4) {
            const double coarse = ride(dimension, 4e-3, point), fine = ride(dimension, 2e-3, point);
            if (!(fine < 1e-5 && coarse > 3.5*fine)) fail_msg("%d-D: off by %g, %g", dimension, coarse, fine);
        }
}

/* Two bodies in free space tumble, joined off their centres, on a spring: error of the energy. */
static double tumble(int dimension, double dt)
{
    rig g;
    open_rig(&g, dimension, weightless);
    add_box(&g, 300, 0.5, 2, 2);
    add_box(&g, 1000, 0.4, 2.3, 2.2);
    tobi_constraint *j = join(&g, 0, 1, 2.4, 1.7, slant[dimension - 2]);
    j->stiffness = 200;
    j->rest = 0.2;
    push(&g, 0, 0.3, -0.2, dimension == 3 ? 0.4 : 0);
    spin(&g, 1, (double[3]){ dimension == 3 ? 2 : 0, dimension == 3 ? -1 : 0, 3 });
    rig_start(&g);
    rig_step(&g, 1e-9);                                  /* velocities obey from now on */
    const double before = energy_of(&g);
    double most = 0, first[6], last[6], size, widest = 0;
    find_momentum(&g, first, &size);
    while (g.time < 2) {
        rig_step(&g, dt);
        most = fmax(most, fabs(energy_of(&g) - before)/before);
        widest = fmax(widest, fabs(place_of(&g, 0)));
        assert_true(j->info.gap < 1e-11 && fabs(tobi_constraint_angle(j, g.bodies, 0)) < 1e-11);
    }
    find_momentum(&g, last, &size);
    for (int a = 0; a < 6; a++)
        if (fabs(last[a] - first[a]) > 1e-12*size)
            fail_msg("momentum %d: %g of %g", a, last[a] - first[a], size);
    assert_true(widest > 0.1);
    rig_close(&g);
    return most;
}

static void tumbling_bodies_keep_momentum_and_energy(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        const double coarse = tumble(dimension, 4e-3), fine = tumble(dimension, 2e-3);
        if (!(fine < 1e-3 && coarse > 3*fine))
            fail_msg("%d-D: %g and %g of the energy", dimension, coarse, fine);
    }
}

/* A block falls along a leaning rail onto its stop, off its centre, and rests there. */
static void a_stop_holds_a_block(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        rig g;
        open_rig(&g, dimension, downward);
        add_box(&g, 500, 0.4, 4, 4);
        tobi_constraint *j = join(&g, 0, -1, 4.3, 3.9, slant[dimension - 2]);
        j->lower = -0.3;
        j->upper = 0.2;
        rig_start(&g);
        double before = energy_of(&g), most = 0;
        for (int n = 0; n < 1000; n++) {
            rig_step(&g, 1e-3);
            assert_true(place_of(&g, 0) >= j->lower - 1e-9);
            most = fmax(most, energy_of(&g) - before);
            before = fmin(before, energy_of(&g));
        }
        const tobi_rigid *r = &g.bodies[0].rigid;
        assert_true(most < 1e-3*r->mass && fabs(place_of(&g, 0) - j->lower) < 1e-9);
        assert_true(fabs(rate_of(&g, 0)) < 1e-9);
        /* it carries the weight, and the moment of that about the place */
        const double moment = -0.3*r->mass*10;
        if (fabs(j->info.force[1]/(10*r->mass) - 1) > 1e-6 || fabs(j->info.moment[2]/moment - 1) > 1e-6)
            fail_msg("%g N, %g N m of %g", j->info.force[1], j->info.moment[2], moment);
        g.bodies[0].rigid.force[1] = 20*r->mass;
        for (int n = 0; n < 1000; n++) {
            rig_step(&g, 1e-3);
            assert_true(place_of(&g, 0) <= j->upper + 1e-9);
        }
        assert_true(fabs(place_of(&g, 0) - j->upper) < 1e-9);
        rig_close(&g);
    }
}

/* --- motors -------------------------------------------------------------------------------------- */

static double swing(double t) { return 0.3*sin(4*t); }

static void drive(rig *g, double before, double value, double dt)
{
    g->joints.at[0].motor.before = before;
    g->joints.at[0].motor.value = value;
    rig_step(g, dt);
}

/* By a force both part like half F/m t^2, m reduced; by a speed with a bound they have it at m v/F; a place
   is kept to rounding. Momenta stay, the work is the kinetic energy. */
static void motors_act_between_two_free_bodies(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++)
        for (int kind = TOBI_MOTOR_SPEED; kind <= TOBI_MOTOR_TORQUE; kind++) {
            rig g;
            open_rig(&g, dimension, weightless);
            add_box(&g, 300, 0.5, 2, 2);
            add_box(&g, 1000, 0.4, 2, 2);
            tobi_constraint *j = join(&g, 0, 1, 2, 2, slant[dimension - 2]);
            const double m = reduced_mass(&g), F = 5, v = 0.4, due = m*v/F, dt = due/100.5;
            double p[6], size, work = 0;
            j->motor = (tobi_motor){ .kind = kind, .most = kind == TOBI_MOTOR_SPEED ? F : INFINITY };
            if (kind == TOBI_MOTOR_TORQUE) j->motor.before = j->motor.value = F;
            rig_start(&g);
            for (int n = 1; n <= 200; n++) {
                if (kind == TOBI_MOTOR_SPEED) drive(&g, v, v, dt);
                else if (kind == TOBI_MOTOR_TORQUE) drive(&g, F, F, dt);
                else drive(&g, swing(g.time), swing(g.time + dt), dt);
                work -= dt*j->info.power;
                const double t = g.time;
                double off = place_of(&g, 0) - (kind == TOBI_MOTOR_ANGLE ? swing(t) : 0.5*F/m*t*t);
                if (kind == TOBI_MOTOR_SPEED) off = rate_of(&g, 0) - fmin(F*t/m, v);
                if (fabs(off) > 1e-11) fail_msg("kind %d: off by %g at %g s", kind, off, t);
                if (kind == TOBI_MOTOR_TORQUE) assert_true(j->info.motor_force == F);
            }
            find_momentum(&g, p, &size);
            for (int a = 0; a < 6; a++) assert_true(fabs(p[a]) < 1e-11);
            assert_true(fabs(work/rig_energy(&g) - 1) < 1e-9);
            rig_close(&g);
        }
}

/* On a hub that turns and sways, off its axis: a place is kept, and the body turns with the hub. */
static void a_place_on_a_turning_hub_is_kept(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        course c = { .rate = 0.7, .sway = 0.4, .a = 0.5 };
        rig g;
        open_rig(&g, dimension, weightless);
        add_box(&g, 500, 0.2, 2.5, 2.3);
        add_hub(&g, &c);
        tobi_constraint *j = join(&g, 0, 1, 2.6, 2.2, slant[dimension - 2]);
        j->motor.kind = TOBI_MOTOR_ANGLE;
        rig_start(&g);
        for (int n = 0; n < 500; n++) {
            drive(&g, swing(g.time), swing(g.time + 2e-3), 2e-3);
            assert_true(fabs(place_of(&g, 0) - swing(g.time)) < 1e-11 && j->info.gap < 1e-11);
            assert_true(fabs(tobi_constraint_angle(j, g.bodies, 0)) < 1e-11);
        }
        rig_close(&g);
    }
}

/* A carriage accelerates; a post slides up and down on it on a spring, and a hull turns on the post. */
static void a_tow_post_leaves_heave_and_pitch(void **state)
{
    (void)state;
    const double up[3] = { 0, 1, 0 };
    course c = { .a = 0.8 };
    rig g;
    open_rig(&g, 3, downward);
    add_box(&g, 500, 0.4, 2, 3);
    add_hub(&g, &c);
    add_box(&g, 100, 0.1, 2, 2.2);
    tobi_constraint *post = join(&g, 2, 1, 2, 2.2, up);
    const double m = g.bodies[0].rigid.mass + g.bodies[2].rigid.mass, w = 6;
    post->stiffness = m*w*w;
    join(&g, 0, 2, 2, 3, NULL);
    rig_start(&g);
    const double dt = 5e-4;
    for (int n = 1; n <= 2000; n++) {
        rig_step(&g, dt);
        const double t = g.time, x = 2 + 0.4*t*t, y = 3 - 10/(w*w)*(1 - cos(w*t));
        const tobi_rigid *r = &g.bodies[0].rigid;
        if (fabs(r->position[0] - x) > 1e-9 || fabs(r->position[1] - y) > 1e-5)
            fail_msg("at %g, %g; exact %g, %g", r->position[0], r->position[1], x, y);
        const double pull = g.joints.at[0].info.force[0];
        if (n > 3 && fabs(pull/(0.8*m) - 1) > 1e-6) fail_msg("%g N of %g", pull, 0.8*m);
    }
    rig_close(&g);
}

/* A crank, a rod and a piston on a rail of the domain: a closed chain, in 3-D of dependent rows. */
static void a_slider_crank_goes_as_its_formula(void **state)
{
    (void)state;
    const double along[3] = { 1, 0, 0 }, r = 0.3, l = 0.8;
    for (int dimension = 2; dimension <= 3; dimension++) {
        rig g;
        open_rig(&g, dimension, weightless);
        add_box(&g, 500, 0.3, 2.15, 2);
        add_box(&g, 5, 0.8, 2.7, 2);
        add_box(&g, 100, 0.2, 3.1, 2);
        join(&g, 0, -1, 2, 2, NULL);
        join(&g, 1, 0, 2.3, 2, NULL);
        join(&g, 2, 1, 3.1, 2, NULL);
        join(&g, 2, -1, 3.1, 2, along);
        const double w = 5;
        spin(&g, 0, (double[3]){ 0, 0, w });
        rig_start(&g);
        rig_step(&g, 1e-6);
        const double before = rig_energy(&g);
        double least = 0;
        for (int n = 0; n < 3000; n++) {
            rig_step(&g, 1e-3);
            const double q = tobi_constraint_angle(&g.joints.at[0], g.bodies, 0);
            const double x = r*cos(q) + sqrt(l*l - r*r*sin(q)*sin(q)) - 1.1;
            if (fabs(place_of(&g, 3) - x) > 1e-10) fail_msg("%g m, exact %g", place_of(&g, 3), x);
            if (fabs(rig_energy(&g)/before - 1) > 1e-4) fail_msg("%g of %g J", rig_energy(&g), before);
            least = fmin(least, x);
        }
        if (!(least < -0.59)) fail_msg("it went to %g m", least);
        rig_close(&g);
    }
}

/* --- what is refused ------------------------------------------------------------------------------- */

static const char head[] =
    "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": 0.1, \"end_time\": 1,"
    "  \"fluids\": [ { \"name\": \"water\","
    "    \"fill\": [ { \"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 0.5] } } ] } ],"
    "  \"bodies\": [ { \"name\": \"spar\", \"box\": { \"min\": [0.2, 0, 0], \"max\": [0.3, 1, 1] },"
    "      \"dynamics\": \"free\" },"
    "    { \"name\": \"float\", \"box\": { \"min\": [0.4, 0, 0], \"max\": [1, 1, 1] },"
    "      \"dynamics\": \"free\" } ],"
    "  \"joints\": [ { \"name\": \"a\", \"kind\": \"%s\", \"body\": \"float\","
    "      \"point\": [0, 0, 0], %s } ] }";

static void mistakes_in_a_scene_are_told(void **state)
{
    (void)state;
    static const char *const cases[][3] = {
        { "slide", "\"to_body\": \"spar\"", "joints[0]: must have an axis, along which the body slides" },
        { "slide", "\"axis\": [0, 0, 0]", "joints[0]: must have an axis, along which the body slides" },
        { "slide", "\"axis\": [0, 0, 1], \"lower\": 0.5", "joints[0].lower: is 0.5, allowed is -179 to 0" },
        { "slide", "\"axis\": [0, 0, 1], \"upper\": -1", "joints[0].upper: is -1, allowed is 0 to 179" },
        { "slide", "\"axis\": [0, 0, 1], \"to_body\": \"float\"",
          "joints[0].to_body: is the body at the other side too" },
        { "slide", "\"axis\": [0, 0, 1], \"rest\": 1",
          "joints[0].rest: is of a spring, which needs a stiffness" },
        { "slide", "\"axis\": [0, 0, 1], \"motor\": { \"angle\": 0 }",
          "joints[0].motor.angle: is of a hinge, a slide has position" },
        { "slide", "\"axis\": [0, 0, 1], \"motor\": { \"speed\": 1, \"torque_max\": 2 }",
          "joints[0].motor.torque_max: is of a hinge, a slide has force_max" },
        { "slide", "\"axis\": [0, 0, 1], \"motor\": { \"position\": 0.5 }",
          "joints[0].motor.position: the motor asks for 0.5 m at time 0, where the slide is at 0" },
        { "slide", "\"axis\": [0, 0, 1], \"motor\": { \"speed\": 1, \"force\": 2 }",
          "joints[0].motor: a motor has one of speed, position, force and file; this one has several" },
        { "hinge", "\"axis\": [0, 0, 1], \"motor\": { \"force\": 2 }",
          "joints[0].motor.force: is of a slide, a hinge has torque" },
        { "slyde", "\"axis\": [0, 0, 1]",
          "joints[0].kind: is \"slyde\", allowed is hinge, ball, fixed or slide" },
    };
    for (size_t k = 0; k < sizeof cases/sizeof *cases; k++) {
        char text[2000];
        snprintf(text, sizeof text, head, cases[k][0], cases[k][1]);
        expect_mistakes(text, &cases[k][2], 1);
    }
}

static void an_axis_out_of_the_plane_is_told(void **state)
{
    (void)state;
    static const char *const mistake[] = { "joints[0].axis: is 1 in z, must be 0 in a 2-D scene" };
    expect_mistakes("{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [1, 1] }, \"spacing\": 0.1,"
                    "\"end_time\": 1, \"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"box\":"
                    "{ \"min\": [0, 0], \"max\": [1, 0.3] } } ] } ], \"bodies\": [ { \"name\": \"b\","
                    "\"dynamics\": \"free\", \"box\": { \"min\": [0.4, 0.5], \"max\": [0.6, 0.9] } } ],"
                    "\"joints\": [ { \"name\": \"a\", \"kind\": \"slide\", \"body\": \"b\","
                    "\"point\": [0, 0], \"axis\": [0, 0, 1] } ] }",
                    mistake, 1);
}

static void refuse(int dimension, const tobi_joint_def *def, const char *key, const char *words)
{
    tobi_error err = { 0 };
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    tobi_body_def b = tobi_default_body_def();
    w.spacing = 0.05;
    w.dimension = dimension;
    for (int a = 0; a < dimension; a++) w.domain_max[a] = 1;
    assert_int_equal(tobi_world_create(&w, NULL, &world, &err), TOBI_OK);
    b.name = "float", b.dynamics = TOBI_FREE;
    for (int a = 0; a < dimension; a++) b.box_min[a] = 0.2, b.box_max[a] = 0.4;
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_OK);
    const tobi_status status = tobi_world_add_joint(world, def, &err);
    if (status == TOBI_OK || !strstr(err.text, words) || strcmp(err.key, key) != 0)
        fail_msg("'%s' at '%s': %s at %s", words, key, err.text, err.key);
    tobi_world_destroy(world);
}

static void mistakes_in_c_are_told(void **state)
{
    (void)state;
    tobi_joint_def right = tobi_default_joint_def(), d;
    right.name = "j", right.body = "float", right.kind = TOBI_BETWEEN_SLIDE;
    d = right;
    refuse(3, &d, "axis", "joint 'j': a slide has an axis");
    d = right, d.axis[2] = 2;
    refuse(2, &d, "axis", "joint 'j': its axis is 2 in z, must be 0 in 2-D");
    d = right, d.axis[1] = 1, d.lower = 1;
    refuse(3, &d, "", "lower");
    d = right, d.axis[1] = 1, d.to_body = "float";
    refuse(3, &d, "to_body", "joint 'j': both sides are body 'float'");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_masses_on_a_spring_swing_by_the_reduced_mass),
        cmocka_unit_test(a_slider_on_a_carousel_goes_out_by_a_hyperbolic_cosine),
        cmocka_unit_test(tumbling_bodies_keep_momentum_and_energy),
        cmocka_unit_test(a_stop_holds_a_block),
        cmocka_unit_test(motors_act_between_two_free_bodies),
        cmocka_unit_test(a_place_on_a_turning_hub_is_kept),
        cmocka_unit_test(a_tow_post_leaves_heave_and_pitch),
        cmocka_unit_test(a_slider_crank_goes_as_its_formula),
        cmocka_unit_test(mistakes_in_a_scene_are_told),
        cmocka_unit_test(an_axis_out_of_the_plane_is_told),
        cmocka_unit_test(mistakes_in_c_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Joints between bodies: a double pendulum against its differential equation, a chain and a cone against
   closed solutions, momentum and energy, closed loops, moved pivots, contact; what is refused. */
#include "rigid_rig.h"

static const double weightless[3] = { 0 }, downward[3] = { 0, 0, -10 }, along_y[3] = { 0, 1, 0 };

/* Bodies start in their rest axes. to -1: the domain. */
static void join(rig *g, int kind, int body, int to, const double point[3], const double axis[3])
{
    tobi_constraints *c = &g->joints;
    c->at = realloc(c->at, (size_t)(c->count + 1)*sizeof *c->at);
    tobi_constraint *j = &c->at[c->count++];
    *j = (tobi_constraint){ .kind = kind, .body = { body, to } };
    for (int side = 0; side < 2; side++) {
        memcpy(j->point[side], point, sizeof j->point[side]);
        memcpy(j->axis[side], axis, sizeof j->axis[side]);
        const int k = j->body[side];
        if (k >= 0) vec3_sub(j->point[side], point, g->bodies[k].rigid.position);
        if (k >= 0 && g->world.dimension == 2) j->point[side][2] = 0;
    }
}

/* A rod of 0.4 kg/m (2-D: 20 kg) that hangs from a place, turned by an angle about y (2-D: about z). */
static tobi_body *hang_rod(rig *g, tobi_body_def def, const double from[3], double length, double angle)
{
    const int flat = g->world.dimension == 2;
    const double side[3] = { 0.02, flat ? length : 0.02, flat ? 1 : length };
    const double middle[3] = { from[0] + 0.5*length*sin(angle), from[1] - flat*0.5*length*cos(angle),
                               from[2] - !flat*0.5*length*cos(angle) };
    def.spacing = 0.05;
    def.rotation_axis[1] = !flat;
    def.rotation_axis[2] = flat;
    def.rotation_angle = (flat ? 1 : -1)*angle*180/acos(-1);
    return rig_box(g, def, side, middle);
}

/* --- the double pendulum -------------------------------------------------------------------------- */

typedef struct pendulum { double mass[2], moment[2], length[2]; } pendulum;

/* Angles from the vertical and their rates: Lagrange's equations of two rods under 10 m/s2. */
static void differentiate(const pendulum *p, const double y[4], double out[4])
{
    const double *m = p->mass, *L = p->length, d = y[0] - y[1];
    const double a = p->moment[0] + 0.25*m[0]*L[0]*L[0] + m[1]*L[0]*L[0], b = 0.5*m[1]*L[0]*L[1]*cos(d),
                 c = p->moment[1] + 0.25*m[1]*L[1]*L[1], s = 0.5*m[1]*L[0]*L[1]*sin(d);
    const double f = -s*y[3]*y[3] - (0.5*m[0] + m[1])*10*L[0]*sin(y[0]),
                 h = s*y[2]*y[2] - 0.5*m[1]*10*L[1]*sin(y[1]);
    out[0] = y[2];
    out[1] = y[3];
    out[2] = (f*c - b*h)/(a*c - b*b);
    out[3] = (a*h - b*f)/(a*c - b*b);
}

/* Runge-Kutta of fourth order, 2e-5 s: exact beside what it is compared with. */
static void integrate(const pendulum *p, double time, double y[4])
{
    const int steps = (int)round(time/2e-5);
    const double dt = time/steps;
    for (int n = 0; n < steps; n++) {
        double k[4][4], at[4];
        differentiate(p, y, k[0]);
        for (int stage = 1; stage < 4; stage++) {
            for (int i = 0; i < 4; i++) at[i] = y[i] + (stage < 3 ? 0.5 : 1)*dt*k[stage - 1][i];
            differentiate(p, at, k[stage]);
        }
        for (int i = 0; i < 4; i++) y[i] += dt/6*(k[0][i] + 2*k[1][i] + 2*k[2][i] + k[3][i]);
    }
}

enum { FLAT, HINGES, ON_A_HINGE };

/* Two rods at 1.2 and -0.5 rad from the vertical. */
static void hang_pendulum(rig *g, int how, pendulum *p)
{
    const double start[2] = { 1.2, -0.5 };
    rig_open(g, 4, downward);
    double from[3] = { 2, 2, 2 };
    if (how == FLAT) {
        static const int periodic[3];
        double lower[3] = { 0 }, upper[3] = { 4, 4, 4 };
        tobi_box_init(&g->box, 2, lower, upper, periodic, 0.4);
        g->world.dimension = 2;
        g->world.gravity[1] = -10;
        g->world.gravity[2] = from[2] = 0;
    }
    const double along[3] = { 0, how != FLAT, how == FLAT };
    const int up = how == FLAT ? 1 : 2;
    for (int k = 0; k < 2; k++) {
        const double length = k ? 0.7 : 1;
        tobi_body_def def = rig_def();
        if (how == ON_A_HINGE && k == 0) {
            memcpy(def.hinge_point, from, sizeof from);
            memcpy(def.hinge_axis, along_y, sizeof along_y);
        }
        const tobi_rigid *r = &hang_rod(g, def, from, length, start[k])->rigid;
        p->mass[k] = r->mass;
        p->moment[k] = r->inertia[how == FLAT ? 8 : 4];
        p->length[k] = length;
        if (how != ON_A_HINGE || k == 1) join(g, TOBI_BETWEEN_HINGE, k, k - 1, from, along);
        from[0] += length*sin(start[k]);
        from[up] -= length*cos(start[k]);
    }
    rig_start(g);
}

/* Rad, of a rod from the vertical. */
static double find_angle(const rig *g, int rod)
{
    const double *q = g->bodies[rod].rigid.orientation;
    return (rod ? -0.5 : 1.2) + 2*atan2(g->world.dimension == 2 ? q[3] : -q[2], q[0]);
}

static double find_height(const rig *g, int body)
{
    return g->bodies[body].rigid.position[g->world.dimension == 2 ? 1 : 2];
}

static double find_energy(const rig *g)
{
    double sum = rig_energy(g);
    for (int k = 0; k < g->count; k++) sum += 10*g->bodies[k].rigid.mass*find_height(g, k);
    return sum;
}

static double find_largest_gap(rig *g)
{
    double most = 0;
    for (int k = 0; k < g->joints.count; k++) most = fmax(most, g->joints.at[k].info.gap);
    return most;
}

static void a_double_pendulum_obeys_its_equation(void **state)
{
    (void)state;
    for (int how = FLAT; how <= ON_A_HINGE; how++) {
        double error[2], gap = 0;
        for (int k = 0; k < 2; k++) {
            rig g;
            pendulum p;
            double y[4] = { 1.2, -0.5, 0, 0 };
            hang_pendulum(&g, how, &p);
            integrate(&p, 2, y);
            for (int n = 0; n < (k ? 1000 : 500); n++) rig_step(&g, k ? 2e-3 : 4e-3);
            for (int rod = 0; rod < 2; rod++) y[rod] = remainder(find_angle(&g, rod) - y[rod], 2*acos(-1));
            error[k] = hypot(y[0], y[1]);
            gap = fmax(gap, find_largest_gap(&g));
            rig_close(&g);
        }
        /* Of second order: the coefficient is the equation's, 65 rad/s2, after one swing to and fro. */
        if (!(error[1] < 4e-4 && error[0]/error[1] > 3.5 && error[0]/error[1] < 4.5 && gap < 1e-12))
            fail_msg("%d: errors %g, %g rad, gap %g m", how, error[0], error[1], gap);
    }
}

static void a_double_pendulum_keeps_its_energy(void **state)
{
    (void)state;
    for (int how = FLAT; how <= ON_A_HINGE; how++) {
        rig g;
        pendulum p;
        hang_pendulum(&g, how, &p);
        const double start = find_energy(&g), scale = 10*(p.mass[0] + p.mass[1]);
        double first = 0, last = 0;
        for (int k = 0; k < 40000; k++) {
            rig_step(&g, 2e-3);
            if (k < 4000) first = fmax(first, fabs(find_energy(&g) - start));
            if (k >= 36000) last = fmax(last, fabs(find_energy(&g) - start));
        }
        if (!(first < 2e-4*scale && last < 2e-4*scale && find_largest_gap(&g) < 1e-12))
            fail_msg("%d: energy is off by %g, later %g of %g J", how, first, last, scale);
        rig_close(&g);
    }
}

/* --- closed solutions ----------------------------------------------------------------------------- */

static void a_chain_carries_what_hangs_below(void **state)
{
    (void)state;
    enum { LINKS = 20 };
    rig g;
    rig_open(&g, 4, downward);
    double from[3] = { 2, 2, 3.5 };
    for (int k = 0; k < LINKS; k++, from[2] -= 0.1) {
        hang_rod(&g, rig_def(), from, 0.1, 0);
        join(&g, k%2 ? TOBI_BETWEEN_BALL : TOBI_BETWEEN_HINGE, k, k - 1, from, along_y);
    }
    rig_start(&g);
    for (int n = 0; n < 200; n++) rig_step(&g, 2e-3);
    for (int k = 0; k < LINKS; k++) {
        const double *f = g.joints.at[k].info.force, weight = (LINKS - k)*g.bodies[k].rigid.mass*10;
        if (fabs(f[2]/weight - 1) > 1e-9) fail_msg("joint %d carries %g N of %g", k, f[2], weight);
    }
    rig_close(&g);
}

/* Weight on one side of a hinge: the moment across the axis is carried too. */
static void a_hinge_carries_moments_across_its_axis(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 4, downward);
    const double from[3] = { 2, 2, 3 }, along_x[3] = { 1, 0, 0 };
    hang_rod(&g, rig_def(), from, 1, 0.5*acos(-1));           /* along x, which is the axis */
    join(&g, TOBI_BETWEEN_HINGE, 0, -1, from, along_x);
    rig_start(&g);
    for (int n = 0; n < 100; n++) rig_step(&g, 2e-3);
    const tobi_joint_info *i = &g.joints.at[0].info;
    const double weight = g.bodies[0].rigid.mass*10;
    assert_true(fabs(i->force[2]/weight - 1) < 1e-9);
    assert_true(fabs(i->moment[1] + 0.5*weight) < 1e-9*weight && fabs(i->moment[0]) < 1e-12);
    assert_true(fabs(i->angle) < 1e-9 && i->gap < 1e-12);
    rig_close(&g);
}

/* A rod on a ball joint that goes round at a fixed slope: (I - J + m l^2) w^2 cos = m g l. */
static void a_rod_goes_round_on_a_cone(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 4, downward);
    const double slope = 0.7, from[3] = { 2, 2, 3 }, across = 1.0/12*(1 + 4e-4), along = 4e-4/6;
    const double rate = sqrt(10*0.5/((across - along + 0.25)*cos(slope)));
    tobi_body_def def = rig_def();
    def.angular_velocity[2] = rate;
    def.velocity[1] = rate*0.5*sin(slope);
    tobi_body *b = hang_rod(&g, def, from, 1, slope);
    join(&g, TOBI_BETWEEN_BALL, 0, -1, from, weightless);
    rig_start(&g);
    const double turn = 2*acos(-1)/rate;
    for (int n = 0; n < 4000; n++) {
        rig_step(&g, turn/1000);
        assert_true(fabs(b->rigid.position[2] - (3 - 0.5*cos(slope))) < 1e-5);
    }
    assert_true(fabs(b->rigid.position[1] - 2) < 1e-3 && b->rigid.position[0] > 2.3);     /* four rounds */
    rig_close(&g);
}

/* A rod that is fixed at one end bears its weight there, at rest and in place. */
static void a_fixed_rod_carries_its_weight(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 4, downward);
    const double slope = 0.3, from[3] = { 2, 2, 3 };
    const tobi_body *b = hang_rod(&g, rig_def(), from, 1, slope);
    double start[3];
    join(&g, TOBI_BETWEEN_FIXED, 0, -1, from, along_y);
    rig_start(&g);
    memcpy(start, b->rigid.position, sizeof start);
    for (int n = 0; n < 200; n++) rig_step(&g, 1e-3);
    const tobi_joint_info *i = &g.joints.at[0].info;
    const double weight = 10*b->rigid.mass, arm = start[0] - from[0];
    print_message("moves %.1e m, force %.9f, moment %.9f of the weight's\n",
                  sqrt(vec3_distance2(start, b->rigid.position)), i->force[2]/weight,
                  i->moment[1]/weight/arm);
    assert_true(vec3_distance2(start, b->rigid.position) < 1e-20 && fabs(i->angle) < 1e-9);
    assert_true(fabs(i->force[2]/weight - 1) < 1e-9 && fabs(i->moment[1]/(weight*arm) + 1) < 1e-9);
    rig_close(&g);
}

static tobi_status accelerate(void *user, double t, int64_t count, const double (*rest)[3], double (*out)[3],
                              tobi_error *err)
{
    (void)user, (void)err;
    for (int64_t i = 0; i < count; i++) {
        memcpy(out[i], rest[i], sizeof out[i]);
        out[i][0] += 0.5*3*t*t;
    }
    return TOBI_OK;
}

/* In a carriage that accelerates by 3 m/s2 a rod hangs at the angle atan(3/10). */
static void a_moved_pivot_takes_the_body_along(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 8, downward);
    const double from[3] = { 1.5, 2, 3 }, slope = -atan(0.3);
    hang_rod(&g, rig_def(), from, 1, slope);
    tobi_body_def carriage = rig_def();
    carriage.dynamics = TOBI_PRESCRIBED;
    carriage.motion = accelerate;
    carriage.motion_rigid = 1;
    rig_box(&g, carriage, (double[3]){ 0.2, 0.2, 0.2 }, (double[3]){ 1.5, 2, 3.1 });
    join(&g, TOBI_BETWEEN_HINGE, 0, 1, from, along_y);
    rig_start(&g);
    for (int n = 0; n < 1000; n++) rig_step(&g, 1e-3);
    const tobi_rigid *r = &g.bodies[0].rigid;
    const tobi_joint_info *i = &g.joints.at[0].info;
    assert_true(fabs(r->position[0] - (3 + 0.5*sin(slope))) < 2e-3);
    assert_true(fabs(i->angle) < 0.2 && i->gap < 1e-9);
    assert_true(fabs(i->force[0]/(3*r->mass) - 1) < 0.01 && fabs(i->force[2]/(10*r->mass) - 1) < 0.01);
    rig_close(&g);
}

/* --- momentum, loops, contact --------------------------------------------------------------------- */

static void find_momentum(const rig *g, double linear[3], double angular[3])
{
    memset(linear, 0, 3*sizeof *linear);
    memset(angular, 0, 3*sizeof *angular);
    for (int k = 0; k < g->count; k++) {
        const tobi_rigid *r = &g->bodies[k].rigid;
        double orbit[3];
        vec3_cross(orbit, r->position, r->velocity);
        for (int a = 0; a < 3; a++) {
            linear[a] += r->mass*r->velocity[a];
            angular[a] += r->mass*orbit[a] + r->momentum[a];
        }
    }
}

static void free_bodies_keep_momentum_and_energy(void **state)
{
    (void)state;
    for (int kind = TOBI_BETWEEN_HINGE; kind <= TOBI_BETWEEN_FIXED; kind++) {
        rig g;
        double linear[2][3], angular[2][3];
        rig_open(&g, 8, weightless);
        tobi_body_def def = rig_def();
        def.angular_velocity[0] = 3, def.angular_velocity[1] = -2, def.angular_velocity[2] = 5;
        rig_box(&g, def, (double[3]){ 0.4, 0.3, 0.2 }, (double[3]){ 4, 4, 4 });
        def.density = 300;
        def.velocity[1] = 0.1;
        def.angular_velocity[1] = 4;
        rig_box(&g, def, (double[3]){ 0.5, 0.2, 0.3 }, (double[3]){ 4.5, 4.1, 4 });
        join(&g, kind, 0, 1, (double[3]){ 4.22, 4.05, 4.1 },
             kind ? weightless : (double[3]){ 0.6, 0, 0.8 });
        rig_start(&g);                        /* now the velocities obey */
        find_momentum(&g, linear[0], angular[0]);
        const double energy = rig_energy(&g);
        double most = 0;
        for (int n = 0; n < 2000; n++) {
            rig_step(&g, 2e-3);
            most = fmax(most, fabs(rig_energy(&g)/energy - 1));
        }
        find_momentum(&g, linear[1], angular[1]);
        const double size = vec3_length(angular[0]);
        assert_true(size > 1 && sqrt(vec3_distance2(linear[0], linear[1])) < 1e-10*size);
        assert_true(sqrt(vec3_distance2(angular[0], angular[1])) < 1e-10*size);
        if (!(most < 1e-4 && find_largest_gap(&g) < 1e-12)) fail_msg("energy is off by %g", most);
        rig_close(&g);
    }
}

/* Four hinges in a square: rows that others determine. It shears at a constant rate of its sides. */
static void a_closed_loop_moves_as_one(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 4, weightless);
    const double corner[4][3] = { { 1.5, 2, 1.5 }, { 1.5, 2, 2.5 }, { 2.5, 2, 2.5 }, { 2.5, 2, 1.5 } };
    for (int k = 0; k < 3; k++) {
        tobi_body_def def = rig_def();
        double middle[3], side[3] = { k == 1 ? 1 : 0.02, 0.02, k == 1 ? 0.02 : 1 };
        for (int a = 0; a < 3; a++) middle[a] = 0.5*(corner[k][a] + corner[k + 1][a]);
        if (k != 1) def.angular_velocity[1] = 2;
        def.velocity[0] = k == 1 ? 2 : 1;
        rig_box(&g, def, side, middle);
    }
    for (int k = 0; k < 4; k++) join(&g, TOBI_BETWEEN_HINGE, k < 3 ? k : 2, k == 3 ? -1 : k - 1, corner[k],
                                     along_y);
    rig_start(&g);
    for (int n = 0; n < 500; n++) rig_step(&g, 1e-3);
    assert_true(find_largest_gap(&g) < 1e-12);
    for (int k = 0; k < 3; k++)
        assert_true(fabs(g.bodies[k].rigid.angular_velocity[1] - (k == 1 ? 0 : 2)) < 1e-9);
    assert_true(fabs(g.joints.at[0].info.angle - 180/acos(-1)) < 1e-4);         /* 2 rad/s for 0.5 s */
    rig_close(&g);
}

/* Two bars that overlap at their joint fall to the floor: they come to rest and stay joined. */
static void joined_bars_come_to_rest_on_the_floor(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 4, downward);
    tobi_body_def def = rig_def();
    rig_box(&g, def, (double[3]){ 0.6, 0.2, 0.1 }, (double[3]){ 1.8, 2, 0.3 });
    rig_box(&g, def, (double[3]){ 0.6, 0.2, 0.1 }, (double[3]){ 2.3, 2, 0.3 });
    join(&g, TOBI_BETWEEN_HINGE, 0, 1, (double[3]){ 2.05, 2, 0.3 }, along_y);
    rig_start(&g);
    assert_null(strstr(g.notes, "overlap"));
    rig_advance(&g, 3);
    for (int k = 0; k < 2; k++) {
        const tobi_rigid *r = &g.bodies[k].rigid;
        assert_true(fabs(r->position[2] - 0.05) < 1e-3 && vec3_length(r->velocity) < 1e-3);
    }
    assert_true(find_largest_gap(&g) < 1e-12);
    rig_close(&g);
}

/* What lies on a post carries another body beside it, for long. */
static void a_body_that_rests_carries_another(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 4, downward);
    tobi_body_def def = rig_def(), post = rig_def();
    post.dynamics = TOBI_PRESCRIBED;
    rig_box(&g, def, (double[3]){ 1, 0.4, 0.2 }, (double[3]){ 2, 2, 1.1 });
    rig_box(&g, post, (double[3]){ 0.8, 0.4, 1 }, (double[3]){ 1.9, 2, 0.5 });
    const double from[3] = { 2.45, 2, 1.05 };
    hang_rod(&g, def, from, 0.6, 0);
    join(&g, TOBI_BETWEEN_BALL, 2, 0, from, weightless);
    rig_start(&g);
    rig_advance(&g, 5);
    assert_true(fabs(g.bodies[0].rigid.position[2] - 1.1) < 1e-3);
    assert_true(fabs(g.bodies[0].rigid.position[0] - 2) < 1e-3);
    assert_true(fabs(g.joints.at[0].info.force[2]/(10*g.bodies[2].rigid.mass) - 1) < 1e-3);
    rig_close(&g);
}

/* P W of two bodies, column by column: symmetric, at most W, and it obeys. */
static void answers_to_forces_are_symmetric(void **state)
{
    (void)state;
    rig g;
    double answer[12][12];
    rig_open(&g, 8, weightless);
    tobi_body_def def = rig_def();
    rig_box(&g, def, (double[3]){ 0.4, 0.3, 0.2 }, (double[3]){ 4, 4, 4 });
    def.density = 300;
    rig_box(&g, def, (double[3]){ 0.5, 0.2, 0.3 }, (double[3]){ 4.5, 4.1, 4 });
    join(&g, TOBI_BETWEEN_HINGE, 0, 1, (double[3]){ 4.22, 4.05, 4.1 }, (double[3]){ 0.6, 0, 0.8 });
    rig_start(&g);
    tobi_constraints *c = &g.joints;
    for (int i = 0; i < 12; i++) {
        for (int k = 0; k < 12; k++) c->speed[k/6][k%6] = k/6 == i/6 ? c->inverse[k/6][k%6][i%6] : 0;
        tobi_constraints_project(c, 0);
        for (int k = 0; k < 12; k++) answer[i][k] = c->speed[k/6][k%6];
        assert_true(answer[i][i] > 0 && answer[i][i] <= c->inverse[i/6][i%6][i%6]*(1 + 1e-12));
        tobi_constraints_project(c, 0);                          /* once more changes nothing */
        for (int k = 0; k < 12; k++) assert_true(fabs(c->speed[k/6][k%6] - answer[i][k]) < 1e-12);
    }
    for (int i = 0; i < 12; i++)
        for (int k = 0; k < i; k++) assert_true(fabs(answer[i][k] - answer[k][i]) < 1e-12);
    assert_true(fabs(answer[0][6]) > 1e-3);                      /* they do answer each other */
    rig_close(&g);
}

/* --- definitions ---------------------------------------------------------------------------------- */

static void refuse(tobi_world *w, const tobi_joint_def *def, tobi_status status, const char *words)
{
    tobi_error err = { 0 };
    assert_int_equal(tobi_world_add_joint(w, def, &err), status);
    if (!strstr(err.text, words)) fail_msg("'%s' is not in '%s'", words, err.text);
}

static tobi_status wobble(void *user, double t, int64_t count, const double (*rest)[3], double (*out)[3],
                          tobi_error *err)
{
    (void)user, (void)t, (void)err;
    memcpy(out, rest, (size_t)count*sizeof *out);
    return TOBI_OK;
}

static tobi_world *make_world(int dimension)
{
    tobi_error err;
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    w.dimension = dimension;
    w.spacing = 0.05;
    for (int a = 0; a < 3; a++) w.domain_max[a] = 1;
    w.gravity[1] = dimension == 2 ? -10 : 0;
    w.gravity[2] = dimension == 3 ? -10 : 0;
    assert_int_equal(tobi_world_create(&w, NULL, &world, &err), TOBI_OK);
    const char *const names[] = { "boat", "post", "eel", "gate" };
    for (int k = 0; k < 4; k++) {
        tobi_body_def b = tobi_default_body_def();
        b.name = names[k];
        b.dynamics = k ? TOBI_PRESCRIBED : TOBI_FREE;
        b.motion = k == 2 ? wobble : NULL;
        b.absent_from = k == 3;
        for (int a = 0; a < 3; a++) {
            b.box_min[a] = 0.1 + 0.2*k - 0.3*(a == 2)*(dimension == 2);
            b.box_max[a] = 0.2 + 0.2*k;
        }
        if (tobi_world_add_body(world, &b, &err) != TOBI_OK) fail_msg("%s", err.text);
    }
    return world;
}

static void wrong_joints_are_refused(void **state)
{
    (void)state;
    tobi_error err;
    tobi_world *world = make_world(3);
    const tobi_joint_def right = { .name = "j", .body = "boat", .point = { 0.2, 0.2, 0.2 },
                                   .axis = { 0, 2, 0 } };
    tobi_joint_def d = right;
    d.body = "ship";
    refuse(world, &d, TOBI_INVALID, "joint 'j': there is no body 'ship'");
    d.body = "post";
    refuse(world, &d, TOBI_INVALID, "joint 'j': body 'post' is prescribed; a joint holds a free");
    d = right, d.to_body = "boat";
    refuse(world, &d, TOBI_INVALID, "joint 'j': both sides are body 'boat'");
    d.to_body = "eel";
    refuse(world, &d, TOBI_UNSUPPORTED, "joint 'j': body 'eel' deforms; a joint holds rigid ones");
    d.to_body = "gate";
    refuse(world, &d, TOBI_UNSUPPORTED, "joint 'j': body 'gate' is absent at times");
    d = right, d.axis[1] = 0;
    refuse(world, &d, TOBI_INVALID, "joint 'j': a hinge has an axis");
    d = right, d.kind = TOBI_BETWEEN_BALL;
    refuse(world, &d, TOBI_INVALID, "joint 'j': a ball joint has no axis");
    d.kind = 7;
    refuse(world, &d, TOBI_INVALID, "kind");
    d = right, d.kind = TOBI_BETWEEN_FIXED, d.to_body = "post";
    refuse(world, &d, TOBI_UNSUPPORTED, "joint 'j': body 'post' is prescribed; what is fixed to it has");
    d.to_body = NULL;
    refuse(world, &d, TOBI_INVALID, "joint 'j': a fixed joint has no axis");
    d = right, d.to_body = "post";
    char name[16];
    for (int k = 0; k < TOBI_JOINT_LIMIT; k++) {
        assert_int_equal(tobi_world_add_joint(world, &d, &err), TOBI_OK);
        if (k == 0) refuse(world, &d, TOBI_INVALID, "joint 'j': joint 0 has that name already");
        snprintf(name, sizeof name, "j%d", k + 1);
        d.name = name;
    }
    refuse(world, &d, TOBI_UNSUPPORTED, "more than 64 joints");
    assert_int_equal(tobi_world_joint_count(world), 64);
    assert_string_equal(tobi_world_joint(world, 0, NULL), "j");
    assert_null(tobi_world_joint(world, 64, NULL));
    tobi_world_destroy(world);
    world = make_world(2);
    refuse(world, &right, TOBI_INVALID, "joint 'j': its axis is along z in 2-D");
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    fill.box_max[0] = 1, fill.box_max[1] = 0.1;
    assert_int_equal(tobi_world_add_fluid(world, &fluid, &fill, 1, &err), TOBI_OK);
    if (tobi_world_start(world, &err) != TOBI_OK) fail_msg("%s", err.text);
    d = right, d.axis[1] = 0;
    refuse(world, &d, TOBI_INVALID, "a started world takes no more joints");
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_double_pendulum_obeys_its_equation),
        cmocka_unit_test(a_double_pendulum_keeps_its_energy),
        cmocka_unit_test(a_chain_carries_what_hangs_below),
        cmocka_unit_test(a_hinge_carries_moments_across_its_axis),
        cmocka_unit_test(a_rod_goes_round_on_a_cone),
        cmocka_unit_test(a_fixed_rod_carries_its_weight),
        cmocka_unit_test(a_moved_pivot_takes_the_body_along),
        cmocka_unit_test(free_bodies_keep_momentum_and_energy),
        cmocka_unit_test(a_closed_loop_moves_as_one),
        cmocka_unit_test(joined_bars_come_to_rest_on_the_floor),
        cmocka_unit_test(a_body_that_rests_carries_another),
        cmocka_unit_test(answers_to_forces_are_symmetric),
        cmocka_unit_test(wrong_joints_are_refused)
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

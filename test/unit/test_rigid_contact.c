/* Contact of rigid bodies against formulas: bounce, incline, stack, collisions. */
#include "rigid_rig.h"

static const double DOWN[3] = { 0, 0, -9.81 };

static double deepest(const rig *g)
{
    double low = 0;
    for (int k = 0; k < g->count; k++)
        for (int64_t v = 0; v < g->bodies[k].mesh.vertex_count; v++)
            low = fmin(low, g->bodies[k].vertex[v][2]);
    return -low;
}

/* Dropped from h, a ball comes back to e^2 h. */
static void test_bounce(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        double e = (double[]){ 0.5, 0.9, 1 }[k], top = 0;
        rig g;
        rig_open(&g, 10, DOWN);
        tobi_body_def def = rig_def();
        def.restitution = e;
        tobi_body *b = rig_ball(&g, def, 0.1, (double[3]){ 5, 5, 1.1 });
        int bounced = 0;
        rig_start(&g);
        for (int i = 0; i < 3000; i++) {
            rig_step(&g, 1e-3);
            if (b->rigid.velocity[2] > 0) bounced = 1;
            if (bounced && b->rigid.velocity[2] < 0) break;
            if (bounced) top = fmax(top, b->rigid.position[2] - 0.1);
        }
        print_message("restitution %g: back to %.4f m of %.4f m\n", e, top, e*e);
        assert_true(fabs(top/(e*e) - 1) < 0.02);
        rig_close(&g);
    }
}

/* Gravity tilted along a flat floor. Rolls with 5/7 g sin, slides with g (sin - mu cos). */
static double run_incline(double friction, double slope, double *spin)
{
    rig g;
    double gravity[3] = { 9.81*sin(slope), 0, -9.81*cos(slope) };
    rig_open(&g, 10, gravity);
    tobi_body_def def = rig_def();
    def.friction_coefficient = friction;
    tobi_body *b = rig_ball(&g, def, 0.1, (double[3]){ 1, 5, 0.1 });
    rig_start(&g);
    for (int i = 0; i < 1000; i++) rig_step(&g, 1e-3);
    double way = b->rigid.position[0] - 1;
    *spin = b->rigid.angular_velocity[1]*0.1/b->rigid.velocity[0];
    rig_close(&g);
    return way;
}

static void test_incline(void **state)
{
    (void)state;
    double slope = acos(-1)/6, spin;
    double way = run_incline(0.5, slope, &spin), exact = 5.0/14*9.81*sin(slope);
    print_message("rolling: %.5f m, %.5f m (%.2f %%), spin r/v %.5f\n", way, exact, 100*(way/exact - 1),
                  spin);
    assert_true(fabs(way/exact - 1) < 0.02 && fabs(spin - 1) < 1e-6);
    way = run_incline(0.1, slope, &spin);
    exact = 0.5*9.81*(sin(slope) - 0.1*cos(slope));
    print_message("slipping: %.5f m, %.5f m (%.2f %%), spin r/v %.5f\n", way, exact, 100*(way/exact - 1),
                  spin);
    assert_true(fabs(way/exact - 1) < 0.02 && spin < 0.9);
}

/* A box on a slope below and above the angle of friction. */
static void test_box_on_slope(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        rig g;
        double slope = k ? 0.6 : 0.4;      /* tan 0.42 and 0.68 */
        double gravity[3] = { 9.81*sin(slope), 0, -9.81*cos(slope) };
        rig_open(&g, 10, gravity);
        tobi_body_def def = rig_def();
        tobi_body *b = rig_box(&g, def, (double[3]){ 0.4, 0.4, 0.1 }, (double[3]){ 1, 5, 0.05 });
        rig_start(&g);
        for (int i = 0; i < 1000; i++) rig_step(&g, 1e-3);
        double way = b->rigid.position[0] - 1, exact = k ? 0.5*9.81*(sin(slope) - 0.5*cos(slope)) : 0;
        print_message("slope %.2f: slid %.3g m, exact %.3g m\n", slope, way, exact);
        assert_true(fabs(way - exact) < (k ? 0.02*exact : 1e-4));
        rig_close(&g);
    }
}

/* On a fixed plate, as steep as 0.32. One of them gives friction 0.3, the other none: the box slides. Two
   that give one have the root of the product, 0.346: it stays. */
static void test_friction_of_two(void **state)
{
    (void)state;
    const double given[3][2] = { { 0.3, TOBI_NOT_GIVEN }, { TOBI_NOT_GIVEN, 0.3 }, { 0.3, 0.4 } };
    const double slope = atan(0.32), gravity[3] = { 9.81*sin(slope), 0, -9.81*cos(slope) };
    for (int k = 0; k < 3; k++) {
        rig g;
        rig_open(&g, 10, gravity);
        tobi_body_def def = rig_def();
        def.friction_coefficient = given[k][0];
        rig_box(&g, def, (double[3]){ 0.4, 0.4, 0.1 }, (double[3]){ 1, 5, 0.15 });
        def.dynamics = TOBI_PRESCRIBED;
        def.friction_coefficient = given[k][1];
        rig_box(&g, def, (double[3]){ 6, 2, 0.1 }, (double[3]){ 3.2, 5, 0.05 });
        rig_start(&g);
        for (int i = 0; i < 1000; i++) rig_step(&g, 1e-3);
        const double way = g.bodies[0].rigid.position[0] - 1;
        const double exact = k < 2 ? 0.5*9.81*(sin(slope) - 0.3*cos(slope)) : 0;
        print_message("friction %g on %g: slid %.4g m, exact %.4g m\n", given[k][0], given[k][1], way, exact);
        assert_true(fabs(way - exact) < (k < 2 ? 0.01*exact : 1e-4));
        rig_close(&g);
    }
}

/* Ten boxes for ten seconds, at 60 steps a second: stay, and come to rest. */
static void test_stack(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 10, DOWN);
    for (int k = 0; k < 10; k++)
        rig_box(&g, rig_def(), (double[3]){ 1, 1, 1 }, (double[3]){ 5, 5, 0.5 + k*0.9999 + 0.0001*k });
    rig_start(&g);
    double shift = 0, tilt = 0;
    for (int i = 0; i < 600; i++) rig_step(&g, 1.0/60);
    for (int k = 0; k < 10; k++) {
        const tobi_rigid *r = &g.bodies[k].rigid;
        shift = fmax(shift, hypot(r->position[0] - 5, r->position[1] - 5));
        shift = fmax(shift, fabs(r->position[2] - 0.5 - k));
        tilt = fmax(tilt, hypot(r->orientation[1], r->orientation[2]));
    }
    print_message("stack: moved %.2g m, tilted %.2g, energy %.2g J, below floor %.2g m\n", shift, tilt,
                  rig_energy(&g), deepest(&g));
    /* 1000 kg a box, and 13 J is what gravity gives each in one step before contact takes it */
    assert_true(shift < 1e-3 && tilt < 1e-4 && rig_energy(&g) < 1e-5);
    rig_close(&g);
}

/* A box half on a fixed plate that carries a smaller one: every force of contact is a weight, and the plate,
   which moves by no force, is told its load, too. */
static void test_loads(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 10, DOWN);
    tobi_body_def fixed = rig_def();
    fixed.dynamics = TOBI_PRESCRIBED;
    rig_box(&g, fixed, (double[3]){ 2, 2, 0.1 }, (double[3]){ 5, 5, 2 });
    rig_box(&g, rig_def(), (double[3]){ 0.4, 0.4, 0.4 }, (double[3]){ 5.3, 5, 2.25 });
    rig_box(&g, rig_def(), (double[3]){ 0.2, 0.2, 0.2 }, (double[3]){ 5.3, 5, 2.55 });
    rig_start(&g);
    rig_step(&g, 0.01);
    for (int i = 0; i < 100; i++) rig_step(&g, 0.01);
    double weight[2];
    for (int k = 0; k < 2; k++) weight[k] = 9.81*g.bodies[1 + k].rigid.mass;
    const tobi_body_info *plate = &g.bodies[0].info;
    print_message("loads: %.6f N of %.6f N, %.6f N of %.6f N; plate %.6f N, %.6f N m\n",
                  g.bodies[1].info.contact_force[2], weight[0], g.bodies[2].info.contact_force[2], weight[1],
                  plate->contact_force[2], plate->contact_torque[1]);
    for (int k = 0; k < 2; k++)
        assert_true(fabs(g.bodies[1 + k].info.contact_force[2]/weight[k] - 1) < 0.01);
    assert_true(fabs(plate->contact_force[2]/-(weight[0] + weight[1]) - 1) < 0.01);
    assert_true(fabs(plate->contact_torque[1]/(0.3*(weight[0] + weight[1])) - 1) < 0.01);
    rig_close(&g);
}

/* Every box turned against the one below: only edges cross, no corner lies over a face. */
static void test_turned_stack(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 10, DOWN);
    for (int k = 0; k < 6; k++) {
        tobi_body_def def = rig_def();
        def.rotation_angle = 45*(k%2) + 0.3*k;
        rig_box(&g, def, (double[3]){ 1, 1, 0.5 }, (double[3]){ 5, 5, 0.25 + 0.5*k });
    }
    rig_start(&g);
    for (int i = 0; i < 600; i++) rig_step(&g, 1.0/60);
    const tobi_rigid *top = &g.bodies[5].rigid;
    print_message("turned stack: top at %.4f m (2.75), moved %.2g m, energy %.2g J\n", top->position[2],
                  hypot(top->position[0] - 5, top->position[1] - 5), rig_energy(&g));
    assert_true(fabs(top->position[2] - 2.75) < 0.002 && rig_energy(&g) < 1e-5);
    assert_true(hypot(top->position[0] - 5, top->position[1] - 5) < 0.01);
    rig_close(&g);
}

/* Two boxes meet off-centre in free space: momenta are kept, and with e = 1 and no friction the energy. */
static void test_collision(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 10, (double[3]){ 0, 0, 0 });
    tobi_body_def def = rig_def();
    def.restitution = 1;
    def.friction_coefficient = 0;
    memcpy(def.velocity, (double[3]){ 1, 0.1, 0 }, sizeof def.velocity);
    memcpy(def.rotation_axis, (double[3]){ 1, 2, 3 }, sizeof def.rotation_axis);
    def.rotation_angle = 37;
    rig_box(&g, def, (double[3]){ 1, 0.6, 0.4 }, (double[3]){ 4, 5, 5 });
    memcpy(def.velocity, (double[3]){ -2, 0, 0.2 }, sizeof def.velocity);
    def.rotation_angle = -70;
    rig_box(&g, def, (double[3]){ 0.5, 0.7, 0.9 }, (double[3]){ 6, 5.2, 4.8 });
    double P[2][3] = { { 0 } }, L[2][3] = { { 0 } }, E[2], size = 0;
    rig_start(&g);
    for (int when = 0; when < 2; when++) {
        for (int k = 0; k < 2; k++) {
            const tobi_rigid *r = &g.bodies[k].rigid;
            double orbit[3];
            vec3_cross(orbit, r->position, r->velocity);
            for (int a = 0; a < 3; a++) {
                P[when][a] += r->mass*r->velocity[a];
                L[when][a] += r->mass*orbit[a] + r->momentum[a];
                size += r->mass*fabs(orbit[a]);
            }
        }
        E[when] = rig_energy(&g);
        for (int i = 0; i < 1000 && when == 0; i++) rig_step(&g, 1e-3);
    }
    double turned = vec3_length(g.bodies[0].rigid.angular_velocity);
    print_message("collision: momentum %.2g, angular %.2g (relative), energy %.2g, spin after %.3g rad/s\n",
                  sqrt(vec3_distance2(P[0], P[1]))/vec3_length(P[0]), sqrt(vec3_distance2(L[0], L[1]))/size,
                  E[1]/E[0] - 1, turned);
    assert_true(turned > 0.1);
    assert_true(vec3_distance2(P[0], P[1]) < 1e-24*vec3_dot(P[0], P[0]));
    assert_true(vec3_distance2(L[0], L[1]) < 1e-24*size*size);
    assert_true(fabs(E[1]/E[0] - 1) < 0.01);
    rig_close(&g);
}

/* A ball on a ball's top, a ball on a plate, a box on a fixed box: they carry each other. */
static void test_balls(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 10, DOWN);
    tobi_body_def fixed = rig_def();
    fixed.dynamics = TOBI_PRESCRIBED;
    rig_box(&g, fixed, (double[3]){ 4, 4, 0.1 }, (double[3]){ 5, 5, 1 });
    rig_ball(&g, rig_def(), 0.3, (double[3]){ 5, 5, 1.4 });
    rig_ball(&g, rig_def(), 0.2, (double[3]){ 5, 5, 1.9 });
    rig_box(&g, rig_def(), (double[3]){ 0.3, 0.3, 0.3 }, (double[3]){ 6, 6, 1.3 });
    rig_start(&g);
    for (int i = 0; i < 120; i++) rig_step(&g, 1.0/60);
    print_message("balls at %.4f, %.4f m, box at %.4f m\n", g.bodies[1].rigid.position[2],
                  g.bodies[2].rigid.position[2], g.bodies[3].rigid.position[2]);
    assert_true(fabs(g.bodies[1].rigid.position[2] - 1.35) < 0.003);
    assert_true(fabs(g.bodies[2].rigid.position[2] - 1.85) < 0.006);
    assert_true(fabs(g.bodies[3].rigid.position[2] - 1.2) < 0.003);
    assert_non_null(strstr(g.notes, "taken for a ball"));
    rig_close(&g);
}

/* Steps grow with the root of the size: those of a box of 100 m are not those of a box of 1 m. */
static void test_steps_of_large_bodies(void **state)
{
    double limit[2];
    (void)state;
    for (int k = 0; k < 2; k++) {
        const double side = k ? 100 : 1;
        rig g;
        rig_open(&g, 20*side, DOWN);
        tobi_body_def def = rig_def();
        def.spacing = side;
        rig_box(&g, def, (double[3]){ side, side, side }, (double[3]){ 5*side, 5*side, 2*side });
        rig_start(&g);
        limit[k] = tobi_rigid_step_limit(g.state);
        rig_close(&g);
    }
    assert_float_equal(limit[1], 10*limit[0], 1e-6);
    assert_true(limit[0] > 1.0/60 && limit[0] < 0.02);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bounce),    cmocka_unit_test(test_incline),
        cmocka_unit_test(test_box_on_slope), cmocka_unit_test(test_friction_of_two),
        cmocka_unit_test(test_stack),
        cmocka_unit_test(test_turned_stack), cmocka_unit_test(test_collision),
        cmocka_unit_test(test_balls),     cmocka_unit_test(test_loads),
        cmocka_unit_test(test_steps_of_large_bodies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

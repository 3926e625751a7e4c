/* Contact where one convex piece is not enough: rows of tiles, a torus, thin plates at speed, tall towers. */
#include "rigid_rig.h"

static const double DOWN[3] = { 0, 0, -9.81 };

static tobi_body_def fixed_def(void)
{
    tobi_body_def def = rig_def();
    def.dynamics = TOBI_PRESCRIBED;
    return def;
}

/* A ball rolls and a box slides over the cut_faces of a row of tiles as over one floor. */
static void test_cut_faces(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 10, DOWN);
    tobi_body_def def = fixed_def();
    def.friction_coefficient = 0.5;
    for (int k = 0; k < 16; k++)
        rig_box(&g, def, (double[3]){ 0.5, 4, 0.2 }, (double[3]){ 1.25 + 0.5*k, 5, 1 });
    def = rig_def();
    def.velocity[0] = 3;
    def.angular_velocity[1] = 30;
    rig_ball(&g, def, 0.1, (double[3]){ 1.5, 5, 1.2 });
    def = rig_def();
    def.velocity[0] = 5;
    def.friction_coefficient = 0.1;
    rig_box(&g, def, (double[3]){ 0.3, 0.3, 0.1 }, (double[3]){ 1.5, 6, 1.15 });
    rig_start(&g);
    for (int i = 0; i < 1500; i++) rig_step(&g, 1e-3);
    const tobi_rigid *ball = &g.bodies[16].rigid, *box = &g.bodies[17].rigid;
    double slid = 1.5 + 5*1.5 - 0.5*9.81*sqrt(0.1*0.5)*1.5*1.5;
    print_message("ball at %.4f m (6), %.6f m/s (3); box at %.4f m (%.4f)\n", ball->position[0],
                  ball->velocity[0], box->position[0], slid);
    assert_true(fabs(ball->velocity[0] - 3) < 1e-6 && fabs(ball->position[2] - 1.2) < 1e-4);
    assert_true(fabs(box->position[0] - slid) < 0.005 && vec3_length(box->angular_velocity) < 1e-3);
    rig_close(&g);
}

/* A ball drops into the hole of a torus of 1152 triangles and comes to rest where the radii say. */
static void test_torus(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 10, DOWN);
    tobi_body_def torus = fixed_def();
    torus.mesh = TOBI_SOURCE_DIR "/test/meshes/torus.obj";
    torus.spacing = 0.2;
    for (int a = 0; a < 3; a++) {
        torus.scale[a] = 2;
        torus.translation[a] = a == 2 ? 1 : 5;
    }
    rig_add(&g, &torus);
    double low[3], high[3];
    tobi_mesh_box(&g.bodies[0].mesh, low, high);
    double minor = 0.5*(high[2] - low[2]), major = 0.5*(high[0] - low[0]) - minor, r = 0.45;
    double rest = 1 + sqrt((r + minor)*(r + minor) - major*major);
    rig_ball(&g, rig_def(), r, (double[3]){ 5.05, 5, 2.2 });
    rig_start(&g);
    for (int i = 0; i < 4000; i++) rig_step(&g, 1e-3);
    const tobi_rigid *ball = &g.bodies[1].rigid;
    print_message("ball in torus at %.4f %.4f %.4f m, smooth torus %.4f m, energy %.2g J\n",
                  ball->position[0], ball->position[1], ball->position[2], rest, rig_energy(&g));
    /* the torus is a polyhedron: its facets lie up to 1 % of the minor radius inside */
    assert_true(fabs(ball->position[2] - rest) < 0.01 && rig_energy(&g) < 1e-6);
    assert_true(hypot(ball->position[0] - 5, ball->position[1] - 5) < 0.01);
    rig_close(&g);
}

/* 50 m/s at 60 steps a second are 0.8 m a step (shorter ones when they turn fast): nothing passes a plate
   of 20 mm. */
static void test_speed(void **state)
{
    (void)state;
    rig g;
    rig_open(&g, 10, (double[3]){ 0, 0, 0 });
    rig_box(&g, fixed_def(), (double[3]){ 9.9, 9.9, 0.02 }, (double[3]){ 5, 5, 2 });
    for (int k = 0; k < 12; k++) {
        tobi_body_def def = rig_def();
        def.velocity[0] = 0.3*k;
        def.velocity[2] = -50;
        def.rotation_angle = 31*k;
        memcpy(def.rotation_axis, (double[3]){ 1, 0.2*k, 2 }, sizeof def.rotation_axis);
        double at[3] = { 2 + 1.5*(k%4), 2.5 + 2*(k/4), 7.3 + 0.07*k };
        if (k%2) rig_box(&g, def, (double[3]){ 0.3, 0.2, 0.1 }, at);
        else rig_ball(&g, def, 0.1, at);
    }
    rig_start(&g);
    double lowest = 10;
    for (int i = 0; i < 120; i++) {
        rig_advance(&g, 1.0/60);
        for (int k = 1; k < g.count; k++) lowest = fmin(lowest, g.bodies[k].rigid.position[2]);
    }
    print_message("lowest centre %.4f m, the plate's top is at 2.01 m\n", lowest);
    assert_true(lowest > 2.02);
    rig_close(&g);
}

/* Twenty boxes on each other, and two threads as good as one to the last bit. */
static void test_tower(void **state)
{
    (void)state;
    double end[2][3], shift = 0;
    for (int run = 0; run < 2; run++) {
        rig g;
        rig_open(&g, 30, DOWN);
        g.world.threads = 1 + run;
        for (int k = 0; k < 20; k++)
            rig_box(&g, rig_def(), (double[3]){ 1, 1, 1 }, (double[3]){ 5, 5, 0.5 + k });
        rig_start(&g);
        for (int i = 0; i < 300; i++) rig_step(&g, 1.0/60);
        memcpy(end[run], g.bodies[19].rigid.position, sizeof end[run]);
        for (int a = 0; a < 3; a++) shift = fmax(shift, fabs(end[run][a] - (a == 2 ? 19.5 : 5)));
        rig_close(&g);
    }
    print_message("tower of twenty: top moved %.2g m\n", shift);
    assert_true(shift < 1e-3 && memcmp(end[0], end[1], sizeof end[0]) == 0);
}

/* What falls asks for no special shape: rings, wedges, cylinders and boxes of many triangles come to rest. */
static void test_heap(void **state)
{
    (void)state;
    static const char *const names[] = { "torus", "wedge", "cylinder", "box" };
    rig g;
    rig_open(&g, 2.5, DOWN);
    for (int k = 0; k < 12; k++) {
        char path[300];
        tobi_body_def def = rig_def();
        snprintf(path, sizeof path, "%s/test/meshes/%s.obj", TOBI_SOURCE_DIR, names[k%4]);
        def.mesh = path;
        def.spacing = 0.1;
        def.rotation_angle = 17*k;
        memcpy(def.rotation_axis, (double[3]){ 1, k%3, 0.5 }, sizeof def.rotation_axis);
        memcpy(def.translation, (double[3]){ 0.8 + 0.6*(k%2), 0.8 + 0.6*(k/2%2), 0.5 + 0.6*(k/4) },
               sizeof def.translation);
        for (int a = 0; a < 3; a++) def.scale[a] = 0.4;
        rig_add(&g, &def);
    }
    rig_start(&g);
    double under = 0, fastest = 0;
    for (int i = 0; i < 300; i++) rig_advance(&g, 1.0/60);
    for (int k = 0; k < g.count; k++) {
        fastest = fmax(fastest, vec3_length(g.bodies[k].rigid.velocity));
        for (int64_t v = 0; v < g.bodies[k].mesh.vertex_count; v++)
            for (int a = 0; a < 3; a++) {
                under = fmax(under, -g.bodies[k].vertex[v][a]);
                under = fmax(under, g.bodies[k].vertex[v][a] - 2.5);
            }
    }
    print_message("heap: fastest %.2g m/s, through a side by %.2g m\n", fastest, under);
    assert_true(fastest < 1e-3 && under < 2e-3);
    rig_close(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cut_faces), cmocka_unit_test(test_torus), cmocka_unit_test(test_speed),
        cmocka_unit_test(test_tower), cmocka_unit_test(test_heap),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* A centre of mass that is not the middle of the mesh: a pendulum swings by it, the pressure of a full vessel
   turns a body about it, as it does a captive one that was turned; what is refused, and what is told. */
#include "calls.h"
#include "rigid_rig.h"
#include "scene/scene.h"
#include "world/world.h"

/* A rod of 1 kg that hangs from its upper end, its mass 0.2 m below it, 0.1 rad from rest: as a pendulum of
   the same mass there swings, whatever the rod's mesh. */
static void a_pendulum_swings_by_its_centre_of_mass(void **state)
{
    (void)state;
    rig g;
    tobi_body_def def = rig_def();
    const double gravity[3] = { 0, 0, -10 }, set_off = 0.1;
    def.mass = 1;
    memcpy(def.centre_of_mass, (double[3]){ 2, 2, 1.8 }, sizeof def.centre_of_mass);
    memcpy(def.inertia, (double[3]){ 0.03, 0.03, 0.01 }, sizeof def.inertia);
    memcpy(def.hinge_point, (double[3]){ 2, 2, 2 }, sizeof def.hinge_point);
    def.hinge_axis[1] = 1;
    def.angular_velocity[1] = set_off;
    rig_open(&g, 4, gravity);
    const tobi_rigid *r = &rig_box(&g, def, (double[3]){ 0.02, 0.02, 1 }, (double[3]){ 2, 2, 1.5 })->rigid;
    rig_start(&g);
    assert_true(fabs(r->position[2] - 1.8) < 1e-12);
    const double w = sqrt(10*0.2/(0.03 + 0.2*0.2));
    for (double t = 1e-3; t < 3; t += 1e-3) {
        rig_step(&g, 1e-3);
        const double angle = tobi_joint_position(r), exact = set_off/w*sin(w*t);
        if (fabs(angle - exact) > 1e-3*set_off/w) fail_msg("%g rad for %g at %g s", angle, exact, t);
    }
    rig_close(&g);
}

/* Mean moment of the liquid on the body from `begin` to `end`, s. */
static double measure_moment(tobi_world *w, double begin, double end)
{
    double sum = 0;
    OK(tobi_world_advance(w, begin, NULL, &err));
    for (int k = 1; k <= 20; k++) {
        tobi_body_info info;
        OK(tobi_world_advance(w, begin + k*(end - begin)/20, NULL, &err));
        OK(tobi_world_body(w, 0, &info));
        sum += info.pressure_torque[2]/20;
    }
    return sum;
}

/* A captive box in a full vessel turns by 30 degrees and stops, its centre 0.05 m beside its middle. */
static void the_pressure_turns_about_the_centre_of_mass(void **state)
{
    static const char *const methods[] = { "dfsph", "isph" };
    static const char *const text =
        "{ \"dimension\": 2, \"end_time\": 1, "
        "\"domain\": { \"min\": [0, 0], \"max\": [0.6, 0.6] }, \"spacing\": 0.02, "
        "\"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"box\": { \"min\": [0, 0], "
        "\"max\": [0.6, 0.6] } } ] } ], \"bodies\": [ { \"name\": \"box\", "
        "\"box\": { \"min\": [0.2, 0.24], \"max\": [0.4, 0.36] }, \"centre_of_mass\": [0.35, 0.3], "
        "\"motion\": { \"rotation\": { \"centre\": [0.3, 0.3, 0], \"axis\": [0, 0, 1], "
        "\"rate\": 200, \"start\": 0.02, \"ramp\": 0.05, \"stop\": 0.22 } } } ] }";
    const double exact = -0.05*1000*9.81*0.2*0.12;
    (void)state;
    for (int m = 0; m < 2; m++) {
        char method[40];
        const char *const overrides[] = { method, NULL };
        tobi_scene *scene;
        tobi_world *w;
        snprintf(method, sizeof method, "method=%s", methods[m]);
        OK(tobi_scene_parse("s.json", text, strlen(text), overrides, &scene, NULL, &err));
        OK(tobi_scene_build(scene, &w, &err));
        OK(tobi_world_start(w, &err));
        const double level = measure_moment(w, 0, 0.01)/exact, turned = measure_moment(w, 0.3, 0.35)/exact;
        print_message("%s: %.4f level, %.4f turned\n", methods[m], level, turned);
        assert_true(fabs(level - 1) < 0.05 && fabs(turned - cos(acos(-1)/6)) < 0.05);
        tobi_world_destroy(w);
        tobi_scene_free(scene);
    }
}

/* One outside of the mesh is odd, and may be meant. */
static void one_outside_of_the_mesh_is_told(void **state)
{
    tobi_world *w;
    tobi_body_def def = tobi_default_body_def();
    tobi_world_def world = tobi_default_world_def();
    (void)state;
    world.spacing = 0.1;
    for (int a = 0; a < 3; a++) {
        world.domain_max[a] = def.box_max[a] = 1;
        def.centre_of_mass[a] = 0.5;
    }
    OK(tobi_world_create(&world, NULL, &w, &err));
    def.name = "inside";
    OK(tobi_world_add_body(w, &def, &err));
    assert_null(tobi_world_note(w, 0));
    def.name = "in millimetres";
    def.centre_of_mass[1] = 500;
    OK(tobi_world_add_body(w, &def, &err));
    assert_non_null(strstr(tobi_world_note(w, 0), "its centre_of_mass, (0.5, 500, 0.5) m, lies outside"));
    def.name = "nowhere";
    def.centre_of_mass[1] = 1e8;
    REFUSED(tobi_world_add_body(w, &def, &err), TOBI_INVALID, "body.centre_of_mass is 1e+08, allowed is");
    def.centre_of_mass[1] = NAN;
    REFUSED(tobi_world_add_body(w, &def, &err), TOBI_INVALID, "not a finite number");
    tobi_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pendulum_swings_by_its_centre_of_mass),
        cmocka_unit_test(one_outside_of_the_mesh_is_told),
        cmocka_unit_test(the_pressure_turns_about_the_centre_of_mass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

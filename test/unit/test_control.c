/* Control programs in Lua: what they read and answer, and their mistakes. */
#include "rigid_rig.h"
#include "rigid/script.h"
#include "run_to.h"
#include "world/world.h"

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static tobi_status ask(const char *text, tobi_control_output *out, tobi_error *err)
{
    tobi_script *script;
    tobi_control_input in = { .time = 2, .position = { 1, 2, 3 }, .orientation = { 1 },
                              .velocity = { 4, 5, 6 }, .angular_velocity = { 7, 8, 9 },
                              .contact_force = { 10, 11, 12 },
                              .contact_torque = { 13, 14, 15 }, .mass = 16, .phase = 17, .phase_time = 18,
                              .step = 19, .steer = { 20, 21, 22 }, .inertia = { 1, 2, 3, 4, 5, 6 },
                              .state = { 0.5, [15] = 0.25 } };
    write_file("ask.lua", text);
    TOBI_TRY(tobi_script_load_within("ask.lua", NULL, TOBI_CONTROL_SCRIPT, 0.2, &script, err));
    in.joints[0] = (tobi_control_joint){ "elbow", { 30 }, -4, 0 };
    in.joints[1] = (tobi_control_joint){ "flap", { 31 }, 5, 0 };
    in.joints[2] = (tobi_control_joint){ "buoy", { 0.5 }, 6, 1 };
    in.joint_count = 3;
    *out = (tobi_control_output){ .phase = in.phase };
    memcpy(out->state, in.state, sizeof out->state);
    tobi_status status = tobi_script_control(script, &in, out, err);
    out->hold = out->hold && strcmp(out->hold, "x,turn") == 0 ? "x,turn" : "";
    tobi_script_free(script);
    remove("ask.lua");
    return status;
}

static void test_control_script(void **state)
{
    (void)state;
    tobi_control_output out;
    tobi_error err = { 0 };
    assert_int_equal(ask("function control(t, b)\n"
                         "    local sum = t + b.orientation[1] + b.mass + b.phase + b.phase_time\n"
                         "    for k = 1, 3 do\n"
                         "        sum = sum + b.position[k] + b.velocity[k] + b.angular_velocity[k]\n"
                         "        + b.contact_force[k] + b.contact_torque[k] end\n"
                         "    return { force = { sum, b.position[2], b.contact_force[3] },\n"
                         "             torque = b.velocity, phase = 3, hold = 'x,turn',\n"
                         "             steer = { b.steer[1] + b.step, b.steer[3], 7 },\n"
                         "             state = { b.state[1] + b.state[16], b.inertia[6] } }\n"
                         "end\n", &out, &err), TOBI_OK);
    assert_true(out.force[0] == 2 + 1 + 16 + 17 + 18 + 120 && out.force[1] == 2 && out.force[2] == 12);
    assert_true(out.steer[0] == 20 + 19 && out.steer[1] == 22 && out.steer[2] == 7);
    assert_true(out.state[0] == 0.75 && out.state[1] == 6 && out.state[2] == 0 && out.state[15] == 0);
    assert_true(out.torque[0] == 4 && out.torque[2] == 6 && out.phase == 3 && out.hold[0] == 'x');
    assert_int_equal(ask("function control() end", &out, &err), TOBI_OK);
    assert_true(out.force[0] == 0 && out.phase == 17 && !out.hold[0]);
    assert_true(out.state[0] == 0.5 && out.state[15] == 0.25);
    assert_true(out.motor[0] == TOBI_NOT_GIVEN && out.motor[1] == TOBI_NOT_GIVEN);
    assert_int_equal(ask("function control(t, b)\n"
                         "    local buoy = b.joints.buoy\n"
                         "    return { motor = { flap = b.joints.elbow.angle + b.joints.flap.speed,\n"
                         "                       buoy = buoy.angle or buoy.position + buoy.speed } }\n"
                         "end\n", &out, &err), TOBI_OK);
    assert_true(out.motor[0] == TOBI_NOT_GIVEN && out.motor[1] == 35 && out.motor[2] == 6.5);
    static const struct { const char *text, *words; } bad[] = {
        { "function control(t, b) return t.x end", "ask.lua:1: attempt to index" },
        { "function place() return 0, 0, 0 end", "define function control(t, body)" },
        { "function control() return 3 end", "must return a table or nothing" },
        { "function control() return { force = 3 } end", "force of three numbers" },
        { "function control() return { torque = {1, 2} } end", "torque of three numbers" },
        { "function control() return { phase = 0.5 } end", "whole number as phase" },
        { "function control() return { hold = 1 } end", "a text as hold" },
        { "function control() return { steer = {1, 2} } end", "steer of three numbers" },
        { "function control() return { steer = {0/0, 2, 3} } end", "steer that is not finite" },
        { "function control() return { state = { 1, 'a' } } end", "a state of at most 16 numbers" },
        { "function control() local s = {} for k = 1, 17 do s[k] = k end return { state = s } end",
          "a state of at most 16 numbers" },
        { "function control() return { state = 3 } end", "a state of at most 16 numbers" },
        { "function control() return { state = { 1/0 } } end", "state that is not finite" },
        { "function control() return { motor = 3 } end", "a motor as { NAME = number }" },
        { "function control() return { motor = { flap = 'x' } } end", "a motor as { NAME = number }" },
        { "function control() return { motor = { flap = 1/0 } } end", "motor that is not finite" },
        { "function control() return { motor = { knee = 3 } } end",
          "body has no joint 'knee'; it has buoy, elbow, flap" },
        { "function control() return { froce = {0, 0, 0} } end", "unknown key 'froce'" },
        { "function control() return { force = {0/0, 0, 0} } end", "force that is not finite (t = 2 s)" },
        { "function control() return { torque = {0, 1/0, 0} } end", "torque that is not finite" },
        { "function control() while true do end end", "endless loop" },
        { "function control() count = 1 end", "assignment to the global 'count'" },
        { "count = 0 function control() count = count + 1 end",
          "ask.lua:1: assignment to the global 'count': write local; from one time to the next only "
          "phase, steer and state, which control returns, is remembered" },
        { "function control(t, body)\n return { force = { body.speed, 0, 0 } } end",
          "ask.lua:2: body has no 'speed'; it has position, orientation, velocity" },
    };
    for (size_t k = 0; k < sizeof bad/sizeof *bad; k++) {
        assert_int_equal(ask(bad[k].text, &out, &err), TOBI_SCRIPT);
        if (!strstr(err.text, bad[k].words)) print_message("%s\n", err.text);
        assert_non_null(strstr(err.text, bad[k].words));
        assert_non_null(strstr(err.text, "control script"));
    }
    tobi_script *script;
    assert_int_equal(tobi_script_load("nowhere.lua", "[1]", TOBI_CONTROL_SCRIPT, &script, &err),
                     TOBI_INVALID);
    assert_non_null(strstr(err.text, "control script params: must be a JSON object"));
}

static int answer;         /* what the program below tells */

/* From 0.2 s on the flap turns; the bar is told nothing before that. */
static tobi_status drive(void *user, const tobi_control_input *in, tobi_control_output *out, tobi_error *err)
{
    (void)user; (void)err;
    assert_int_equal(in->joint_count, 2);
    assert_string_equal(in->joints[0].name, "knee");
    assert_string_equal(in->joints[1].name, "flap");
    if (in->time > 0.2) out->motor[1] = 90;
    if (in->time > 0.2) out->motor[0] = 10*in->time;
    if (answer == 1) out->motor[1] = 1e9;
    return TOBI_OK;
}

/* A flap with a motor, and a bar on it with a motor, or without. */
static tobi_world *build(int motor)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_joint_def knee = tobi_default_joint_def();
    tobi_world *w;
    tobi_error err = { 0 };
    def.method = "mlsmpm";
    for (int a = 0; a < 3; a++) def.domain_max[a] = 4, def.gravity[a] = 0;
    def.spacing = 0.1;
    def.time_step = 0.005;
    assert_int_equal(tobi_world_create(&def, NULL, &w, &err), TOBI_OK);
    for (int k = 0; k < 2; k++) {
        tobi_body_def b = tobi_default_body_def();
        b.name = k ? "bar" : "flap";
        b.dynamics = k ? TOBI_FREE : TOBI_CONTROLLED;
        b.control = k ? NULL : drive;
        b.hinge_axis[1] = !k;
        for (int a = 0; a < 3; a++) b.hinge_point[a] = b.box_min[a] = 2, b.box_max[a] = 2.2;
        b.box_min[2] += 0.2*k, b.box_max[2] += 0.2*k;
        if (!k) b.hinge_motor.speed = 0, b.hinge_motor.torque_max = 20;
        assert_int_equal(tobi_world_add_body(w, &b, &err), TOBI_OK);
    }
    knee.name = "knee", knee.body = "bar", knee.to_body = "flap", knee.axis[1] = 1;
    for (int a = 0; a < 3; a++) knee.point[a] = 2.2;
    if (motor) knee.motor.angle = 0, knee.motor.torque_max = 20;
    assert_int_equal(tobi_world_add_joint(w, &knee, &err), TOBI_OK);
    return w;
}

/* Speeds and angles are those that the program tells, and a restart knows them. */
static void test_motors(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    tobi_joint_info knee, flap;
    tobi_world *a = build(1), *b = build(1);
    answer = 0;
    run_to(a, 0.1);
    tobi_world_joint(a, 1, &flap);
    assert_true(flap.angle == 0);
    run_to(a, 0.5);
    assert_int_equal(tobi_world_save(a, "motors.h5", &err), TOBI_OK);
    const uint64_t whole = run_to(a, 1);
    tobi_world_joint(a, 0, &knee);
    tobi_world_joint(a, 1, &flap);
    print_message("flap at %g degrees, knee at %g\n", flap.angle, knee.angle);
    assert_true(flap.angle > 50 && flap.angle < 0.8*90 + 1);
    assert_true(fabs(knee.angle - 10*0.995) < 1e-6);
    assert_int_equal(tobi_world_load(b, "motors.h5", &err), TOBI_OK);
    assert_true(run_to(b, 1) == whole);
    a->sim.constraints.at[0].motor.set = NAN;
    assert_int_equal(tobi_world_save(a, "motors.h5", &err), TOBI_OK);
    assert_int_equal(tobi_world_load(b, "motors.h5", &err), TOBI_DAMAGED);
    assert_non_null(strstr(err.text, "the checkpoint's motors are told what is no number"));
    tobi_world_destroy(a);
    tobi_world_destroy(b);
    remove("motors.h5");
}

static tobi_status lift(void *user, const tobi_control_input *in, tobi_control_output *out, tobi_error *err)
{
    (void)user; (void)err;
    assert_true(in->joint_count == 1 && in->joints[0].slides);
    assert_string_equal(in->joints[0].name, "slide");
    if (in->time > 0.2) out->motor[0] = in->joints[0].position < 0.05 ? 0.25 : 0;
    return TOBI_OK;
}

/* A body of 8 kg on a guide, lifted against gravity: full force, then the speed that the program tells. */
static void test_guide(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    tobi_world *w[2];
    tobi_joint_info slide;
    for (int k = 0; k < 2; k++) {
        tobi_world_def def = tobi_default_world_def();
        tobi_body_def b = tobi_default_body_def();
        def.method = "mlsmpm";
        for (int a = 0; a < 3; a++) def.domain_max[a] = 4, b.box_min[a] = 2, b.box_max[a] = 2.2;
        def.spacing = 0.1;
        def.time_step = 0.005;
        assert_int_equal(tobi_world_create(&def, NULL, &w[k], &err), TOBI_OK);
        b.name = "slide", b.dynamics = TOBI_CONTROLLED, b.control = lift, b.guide_axis[2] = 1;
        b.guide_motor.speed = 0, b.guide_motor.force_max = 100;
        assert_int_equal(tobi_world_add_body(w[k], &b, &err), TOBI_OK);
    }
    run_to(w[0], 0.2);
    tobi_world_joint(w[0], 0, &slide);
    assert_true(slide.has_motor && slide.slides && slide.motor_torque == 0);
    assert_true(fabs(slide.motor_force - 8*9.81) < 1e-6 && fabs(slide.power) < 1e-9);
    run_to(w[0], 0.25);
    tobi_world_joint(w[0], 0, &slide);
    const double a = 100/8.0 - 9.81, v = -slide.power/100;       /* told in the step around 0.2 s */
    if (fabs(slide.motor_force - 100) > 1e-6 || v < a*0.037 || v > a*0.05)
        fail_msg("%g N, %g W", slide.motor_force, slide.power);
    assert_int_equal(tobi_world_save(w[0], "motors.h5", &err), TOBI_OK);
    const uint64_t whole = run_to(w[0], 1);
    tobi_world_joint(w[0], 0, &slide);
    assert_true(fabs(slide.motor_force - 8*9.81) < 1e-6);
    assert_int_equal(tobi_world_load(w[1], "motors.h5", &err), TOBI_OK);
    assert_true(run_to(w[1], 1) == whole);
    for (int k = 0; k < 2; k++) tobi_world_destroy(w[k]);
    remove("motors.h5");
}

static void test_wrong_motors(void **state)
{
    (void)state;
    for (answer = 0; answer < 2; answer++) {
        tobi_error err = { 0 };
        tobi_world *w = build(answer);
        assert_int_equal(tobi_world_advance(w, 0.5, NULL, &err), TOBI_SCRIPT);
        const char *words = answer ? "body 'flap': its control program tells the motor of 'flap' 1e+09; al"
                                   : "tells the motor of 'knee', which has none; a hinge has one by the key";
        if (!strstr(err.text, words)) fail_msg("%s", err.text);
        tobi_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_control_script), cmocka_unit_test(test_motors),
                                        cmocka_unit_test(test_wrong_motors),
                                        cmocka_unit_test(test_guide) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

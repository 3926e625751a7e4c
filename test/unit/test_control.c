/* Control programs in Lua: what they read and answer, and their mistakes. */
#include "rigid_rig.h"
#include "rigid/script.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_control_script) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

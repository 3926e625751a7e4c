/* Motions: formulas against their definition, scripts against the same formulas in C, and
   everything a script may not do. Limits of scripts are in test_script.c. */
#include "tobiuo/motion.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#define REST(p) ((const double (*)[3])(p))
#define PI 3.14159265358979323846

/* Writes a script to a fresh file; the path lives until the next call. */
static const char *write_script(const char *text)
{
    static char path[64];
    strcpy(path, "/tmp/tobiuo_motion_XXXXXX");
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, text, strlen(text)), (ssize_t)strlen(text));
    close(fd);
    return path;
}

static tobi_status load(const char *text, const char *params, tobi_motion **motion, tobi_error *err)
{
    const char *path = write_script(text);
    tobi_status status = tobi_motion_script(path, params, motion, err);
    unlink(path);
    return status;
}

/* The script must fail while loading, with this text in the message. */
static void expect_bad(const char *text, const char *part)
{
    tobi_motion *motion = NULL;
    tobi_error err = { 0 };
    tobi_status status = load(text, NULL, &motion, &err);
    if (status != TOBI_SCRIPT || !strstr(err.text, part))
        fail_msg("script <%s>: status %d, message <%s>, expected <%s>", text, status, err.text,
                 part);
    assert_null(motion);
}

/* The script must load, and fail when evaluated at time t. */
static void expect_bad_at(const char *text, double t, const char *part)
{
    tobi_motion *motion = NULL;
    tobi_error err = { 0 };
    if (load(text, NULL, &motion, &err) != TOBI_OK) fail_msg("<%s>: %s", text, err.text);
    double points[50][3], moved[50][3];
    for (int i = 0; i < 50; i++)
        for (int a = 0; a < 3; a++) points[i][a] = 0.1 * i + a;
    tobi_status status = tobi_motion_positions(motion, t, 50, REST(points), moved, &err);
    if (status != TOBI_SCRIPT || !strstr(err.text, part))
        fail_msg("script <%s>: status %d, message <%s>, expected <%s>", text, status, err.text,
                 part);
    tobi_motion_free(motion);
}

static void test_formulas(void **state)
{
    (void)state;
    tobi_motion *m = NULL;
    tobi_error err = { 0 };
    const double rest[2][3] = { { 1, 2, 3 }, { -1, 0.5, 0 } };
    double p[2][3];

    assert_int_equal(tobi_motion_translation((double[3]){ 1, -2, 0.5 }, &m, &err), TOBI_OK);
    assert_int_equal(tobi_motion_positions(m, 2.0, 2, rest, p, &err), TOBI_OK);
    assert_true(p[0][0] == 3 && p[0][1] == -2 && p[0][2] == 4 && p[1][1] == -3.5);
    assert_int_equal(tobi_motion_is_rigid(m), 1);
    tobi_motion_free(m);

    /* 90 degrees about z through (1, 0, 0): (1, 2, 3) -> (-1, 0, 3) */
    const double pivot[3] = { 1, 0, 0 }, axis[3] = { 0, 0, 7 }, along[3] = { 0, 0, -2 };
    assert_int_equal(tobi_motion_rotation(pivot, axis, 45, &m, &err), TOBI_OK);
    assert_int_equal(tobi_motion_positions(m, 2.0, 2, rest, p, &err), TOBI_OK);
    assert_true(fabs(p[0][0] + 1) < 1e-14 && fabs(p[0][1]) < 1e-14 && fabs(p[0][2] - 3) < 1e-14);
    assert_int_equal(tobi_motion_positions(m, 8.0, 2, rest, p, &err), TOBI_OK); /* one full turn */
    assert_true(p[0][0] == 1 && p[0][1] == 2);
    tobi_motion_free(m);

    assert_int_equal(tobi_motion_oscillation(along, 0.1, 4, 30, &m, &err), TOBI_OK);
    assert_int_equal(tobi_motion_positions(m, 0.3, 2, rest, p, &err), TOBI_OK);
    assert_true(fabs(p[0][2] - (3 - 0.1 * sin(2 * PI * 4 * 0.3 + PI / 6))) < 1e-14 && p[0][0] == 1);
    tobi_motion_free(m);

    assert_int_equal(tobi_motion_rotation((double[3]){ 0 }, (double[3]){ 0 }, 1, &m, &err),
                     TOBI_INVALID);
    assert_int_equal(tobi_motion_translation((double[3]){ NAN, 0, 0 }, &m, &err), TOBI_INVALID);
    assert_null(m);
}

/* Where a point is at t. */
static const double *place_at(tobi_motion *m, double t, const double rest[3])
{
    static double p[1][3];
    tobi_error err;
    assert_int_equal(tobi_motion_positions(m, t, 1, REST((const void *)rest), p, &err), TOBI_OK);
    return p[0];
}

static double speed_at(tobi_motion *m, double t, const double rest[3], int axis)
{
    const double e = 1e-5, before = place_at(m, t - e, rest)[axis];
    return (place_at(m, t + e, rest)[axis] - before)/(2*e);
}

/* The speed is what the text of tobi_motion_set_times says, and the way its integral. */
static void test_times(void **state)
{
    (void)state;
    tobi_motion *m = NULL;
    tobi_error err;
    const double rest[3] = { 0.1, 0.2, 0.3 }, start = 0.5, stop = 3, ramp = 0.8, v = 2;
    assert_int_equal(tobi_motion_translation((double[3]){ 0, 0, v }, &m, &err), TOBI_OK);
    assert_int_equal(tobi_motion_set_times(m, start, stop, ramp, &err), TOBI_OK);
    assert_true(place_at(m, 0.5, rest)[2] == 0.3 && place_at(m, 0, rest)[2] == 0.3);
    double way = 0;
    for (double t = 0.01; t < 4; t += 0.01) {
        const double since = t - start, left = stop - t;
        const double share = since <= 0 || left <= 0 ? 0 : since < ramp ? 0.5*(1 - cos(PI*since/ramp))
                             : left < ramp ? 0.5*(1 - cos(PI*left/ramp)) : 1;
        assert_true(fabs(speed_at(m, t, rest, 2) - v*share) < 1e-4);
        way += 0.01*v*share;
        assert_true(fabs(place_at(m, t + 0.005, rest)[2] - 0.3 - way) < 1e-3);
    }
    assert_true(fabs(place_at(m, 9, rest)[2] - 0.3 - v*(stop - start - ramp)) < 1e-12);
    tobi_motion_free(m);

    /* Without a ramp: at once, and at once at rest. */
    assert_int_equal(tobi_motion_rotation((double[3]){ 0 }, (double[3]){ 0, 0, 1 }, 90, &m, &err), TOBI_OK);
    assert_int_equal(tobi_motion_set_times(m, 1, 2, 0, &err), TOBI_OK);
    assert_true(place_at(m, 1, rest)[0] == 0.1);
    for (double t = 2; t < 4; t += 1) assert_true(fabs(place_at(m, t, rest)[0] + 0.2) < 1e-15);
    tobi_motion_free(m);

    assert_int_equal(tobi_motion_oscillation((double[3]){ 1, 0, 0 }, 0.3, 2, 40, &m, &err), TOBI_OK);
    assert_int_equal(tobi_motion_set_times(m, 0.25, INFINITY, 1, &err), TOBI_OK);
    for (double t = 0; t < 3; t += 0.0625) {
        const double s = fmin(fmax(t - 0.25, 0), 1), wave = sin(4*PI*t + 40*PI/180);
        assert_true(fabs(place_at(m, t, rest)[0] - 0.1 - 0.3*0.5*(1 - cos(PI*s))*wave) < 1e-14);
    }
    tobi_motion_free(m);
}

static void test_swing_and_sum(void **state)
{
    (void)state;
    tobi_motion *part[3], *m = NULL;
    tobi_error err;
    const double centre[3] = { 1, 0, 2 }, rest[3] = { 1.5, 0.25, 2 }, about[3] = { 0, 3, 0 };
    assert_int_equal(tobi_motion_swing(centre, about, 20, 0.5, 10, &part[1], &err), TOBI_OK);
    assert_true(tobi_motion_is_rigid(part[1]));
    for (double t = 0; t < 5; t += 0.125) {
        const double angle = PI/9*sin(PI*t + PI/18);
        const double *p = place_at(part[1], t, rest);
        assert_true(fabs(p[0] - 1 - 0.5*cos(angle)) < 1e-14 && p[1] == 0.25);
        assert_true(fabs(p[2] - 2 + 0.5*sin(angle)) < 1e-14);
    }
    /* The shift stands first and is added last: the centre of the turn does not move with it. */
    assert_int_equal(tobi_motion_translation((double[3]){ 0.5, 0, 0 }, &part[0], &err), TOBI_OK);
    assert_int_equal(tobi_motion_rotation(centre, (double[3]){ 0, 0, 1 }, 90, &part[2], &err), TOBI_OK);
    assert_int_equal(tobi_motion_sum(part, 3, &m, &err), TOBI_OK);
    for (double t = 0; t < 5; t += 0.125) {
        const double angle = PI/9*sin(PI*t + PI/18), turn = PI/2*t, x = 0.5*cos(angle), y = 0.25;
        const double *p = place_at(m, t, rest);
        assert_true(fabs(p[0] - (1 + x*cos(turn) - y*sin(turn) + 0.5*t)) < 1e-14);
        assert_true(fabs(p[1] - (x*sin(turn) + y*cos(turn))) < 1e-14);
        assert_true(fabs(p[2] - (2 - 0.5*sin(angle))) < 1e-14);
    }
    assert_true(tobi_motion_is_rigid(m));
    tobi_motion_free(m);

    if (load("function deform(x, y, z, t) return x, y, z*(1 + t) end", NULL, &part[0], &err))
        fail_msg("%s", err.text);
    assert_int_equal(tobi_motion_rotation((double[3]){ 0 }, (double[3]){ 0, 1, 0 }, 90, &part[1], &err), 0);
    assert_int_equal(tobi_motion_sum(part, 2, &m, &err), TOBI_OK);
    assert_false(tobi_motion_is_rigid(m));
    assert_true(fabs(place_at(m, 1, rest)[0] - 4) < 1e-14 && fabs(place_at(m, 1, rest)[2] + 1.5) < 1e-14);
    tobi_motion_free(m);
}

static void expect_refused(tobi_status status, const tobi_error *err, const char *part)
{
    assert_int_equal(status, TOBI_INVALID);
    if (!strstr(err->text, part)) fail_msg("<%s>, expected <%s>", err->text, part);
}

static void test_bad_times_and_sums(void **state)
{
    (void)state;
    tobi_motion *part[2], *m = NULL;
    tobi_error err;
    assert_int_equal(tobi_motion_translation((double[3]){ 1, 0, 0 }, &part[0], &err), TOBI_OK);
    expect_refused(tobi_motion_set_times(part[0], 0, 1, 0.6, &err), &err, "no time for two ramps of 0.6 s");
    expect_refused(tobi_motion_set_times(part[0], 1, 1, 0, &err), &err, "no time for two ramps");
    expect_refused(tobi_motion_set_times(part[0], NAN, 1, 0, &err), &err, "start must be finite");
    expect_refused(tobi_motion_set_times(part[0], 0, 1, -1, &err), &err, "ramp 0 or more");
    expect_refused(tobi_motion_set_times(NULL, 0, 1, 0, &err), &err, "NULL");
    assert_int_equal(load("function deform(x, y, z, t) return x, y, z end", NULL, &part[1], &err), TOBI_OK);
    expect_refused(tobi_motion_set_times(part[1], 0, 1, 0, &err), &err, "times are for motions by numbers");
    expect_refused(tobi_motion_sum(part, 2, &m, &err), &err, "number 2 changes the shape; only the first");
    expect_refused(tobi_motion_sum(part, 0, &m, &err), &err, "NULL");
    assert_int_equal(tobi_motion_sum(part, 1, &m, &err), TOBI_OK);
    expect_refused(tobi_motion_sum(&m, 1, &part[0], &err), &err, "number 1 is a sum already");
    tobi_motion_free(part[1]);
    tobi_motion_free(m);
    assert_int_equal(tobi_motion_swing((double[3]){ 0 }, (double[3]){ 1, 0, 0 }, 5, 1, 0, &m, &err), TOBI_OK);
    expect_refused(tobi_motion_set_times(m, 0, 5, 0, &err), &err, "an oscillation does not stop");
    tobi_motion_free(m);
    expect_refused(tobi_motion_swing((double[3]){ INFINITY }, (double[3]){ 1 }, 5, 1, 0, &m, &err), &err,
                   "centre must be finite");
}

static void test_script_params_and_place(void **state)
{
    (void)state;
    tobi_motion *m = NULL;
    tobi_error err = { 0 };
    const double rest[1][3] = { { 2, 0, 0 } };
    double p[1][3];
    const char *text = "pivot = params.centre\n"
                       "local s = params.deep.speed[2]\n"
                       "function place(t) return s * t, 0, 0, 0, 0, 2, 90 * t end\n";
    const char *params = "{\"centre\": [1, 0, 0],"
                         " \"deep\": {\"speed\": [1, 5.5]}, \"name\": \"x\", \"on\": true}";
    if (load(text, params, &m, &err)) fail_msg("%s", err.text);
    assert_int_equal(tobi_motion_is_rigid(m), 1);
    assert_int_equal(tobi_motion_positions(m, 1.0, 1, rest, p, &err), TOBI_OK);
    assert_true(fabs(p[0][0] - 6.5) < 1e-14 && fabs(p[0][1] - 1) < 1e-14);
    tobi_motion_free(m);

    if (load("function deform(x, y, z, t) return x + t, y * 2, z end", NULL, &m, &err))
        fail_msg("%s", err.text);
    assert_int_equal(tobi_motion_is_rigid(m), 0);
    assert_int_equal(tobi_motion_positions(m, 1.0, 1, rest, p, &err), TOBI_OK);
    assert_true(p[0][0] == 3);
    tobi_motion_free(m);

    assert_int_equal(load("function place(t) return 0,0,0 end", "[1]", &m, &err), TOBI_INVALID);
    assert_int_equal(load("function place(t) return 0,0,0 end", "{", &m, &err), TOBI_INVALID);
    assert_int_equal(tobi_motion_script("/nowhere/motion.lua", NULL, &m, &err), TOBI_NOT_FOUND);
    assert_non_null(strstr(err.text, "/nowhere/motion.lua"));
}

static void test_mistakes_are_named(void **state)
{
    (void)state;
    expect_bad("x = 1\ny = = 2\n", ":2:");
    expect_bad("local a = nil\n\nlocal b = a.x\n", ":3:");
    expect_bad("local a = 1", "define either");
    expect_bad("function place(t) end function deform() end", "not both");
    expect_bad("pivot = 3 function place(t) return 0, 0, 0 end", "pivot");
    expect_bad("\x1bLJ\x02", "not a text file");
    expect_bad("while true do end", ":1: endless loop? stopped after 3 s of processor time");
    expect_bad_at("function deform(x, y, z, t)\n  return x, y\nend", 0, "three numbers");
    expect_bad_at("function deform(x, y, z, t) return x, y, z, 1 end", 0, "three numbers");
    expect_bad_at("function deform(x, y, z, t) return x, y, 'z' end", 0, "three numbers");
    expect_bad_at("function deform(x, y, z, t) return x, y, z / (x - 1) * 0 end", 0,
                  "rest point 1 2 3");
    expect_bad_at("function deform(x, y, z, t) return x, y, 1 / 0 end", 0.25, "t = 0.25 s");
    expect_bad_at("function deform(x, y, z, t)\n  return x, y, q\nend", 0, ":2: unknown name 'q'");
    expect_bad_at("function deform(x, y, z, t)\n  q = 1\n  return x, y, z\nend", 0, "write local");
    expect_bad_at("function place(t) return 1, 2 end", 0, "place must return");
    expect_bad_at("function place(t) return 1, 2, 0 / 0 end", 0, "place must return");
    expect_bad_at("function place(t) return 0, 0, 0, 0, 0, 0, 5 end", 0, "zero axis");
    expect_bad_at("function place(t) error('mine') end", 0, ":1: mine");
    expect_bad_at("function place(t) error({}) end", 0, "without a text");
}

static void test_mathematics_only(void **state)
{
    (void)state;
    static const char *const names[] = {
        "io",           "os",         "require",    "load",        "loadstring",     "loadfile",
        "dofile",       "ffi",        "debug",      "jit",         "package",        "module",
        "getfenv",      "setfenv",    "rawset",     "rawget",      "rawequal",       "setmetatable",
        "getmetatable", "pcall",      "xpcall",     "coroutine",   "collectgarbage", "print",
        "_G",           "newproxy",   "gcinfo",     "string.dump", "string.rep",     "string.gsub",
        "('x').rep",    "('x').dump", "math.random", "next"
    };
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char text[200];
        snprintf(text, sizeof text, "if %s ~= nil then error('FOUND') end", names[k]);
        expect_bad(text, "define either");
    }
    expect_bad("local s = 'x' for i = 1, 60 do s = s .. s end", "64 MiB");
    expect_bad("local t = {} for i = 1, 1e12 do t[i] = {} end", "64 MiB");
}

/* One point at a time in fresh states (interpreted) must give the bits of a long compiled batch:
   a restarted run begins interpreted. */
static void test_compiled_equals_interpreted(void **state)
{
    (void)state;
    const char *text =
        "local sin, sqrt, atan2 = math.sin, math.sqrt, math.atan2\n"
        "function deform(x, y, z, t)\n"
        "  return x ^ 2 + sin(7 * y) * x ^ 3, sqrt(x * x + z * z) % 0.3 + t ^ 2,\n"
        "         atan2(y, z) * math.exp(-x) + (1 - z) ^ 2 / 3 + x ^ 0.5 + 2 ^ y\nend";
    enum { N = 4000 };
    static double rest[N][3], batch[N][3];
    tobi_error err = { 0 };
    tobi_motion *m = NULL, *fresh = NULL;
    srand(3);
    for (int i = 0; i < N; i++)
        for (int a = 0; a < 3; a++) rest[i][a] = (double)rand() / RAND_MAX;
    if (load(text, NULL, &m, &err))
        fail_msg("%s", err.text);
    for (int k = 0; k < 3; k++)
        assert_int_equal(tobi_motion_positions(m, 0.1, N, REST(rest), batch, &err), TOBI_OK);
    for (int i = 0; i < N; i++) {
        double one[1][3];
        if (i % 20 == 0) {
            tobi_motion_free(fresh);
            if (load(text, NULL, &fresh, &err)) fail_msg("%s", err.text);
        }
        assert_int_equal(tobi_motion_positions(fresh, 0.1, 1, REST(&rest[i]), one, &err), TOBI_OK);
        assert_memory_equal(one, batch[i], sizeof one);
    }
    tobi_motion_free(m);
    tobi_motion_free(fresh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_formulas),
        cmocka_unit_test(test_times),
        cmocka_unit_test(test_swing_and_sum),
        cmocka_unit_test(test_bad_times_and_sums),
        cmocka_unit_test(test_script_params_and_place),
        cmocka_unit_test(test_mistakes_are_named),
        cmocka_unit_test(test_mathematics_only),
        cmocka_unit_test(test_compiled_equals_interpreted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

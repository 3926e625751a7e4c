/* The flying fish's motion against the formulas it was written from, and its smoothness: a mesh
   that follows it must not tear. */
#include "tobiuo/motion.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

#define PI 3.14159265358979323846
#define LENGTH 0.2
#define HALF 0.01      /* of the body's width */
#define LEAD 0.06
#define CHORD 0.04
#define WING 0.09
#define RELAX 0.2
#define CYCLE 0.1

static const double centre[3] = { 0.3, 0.15, 0.24 };
static const double start[3] = { 0.4, 0.15, 0.08 };
static const double swim[3] = { 0.227, 0.15, 0.22 };

static tobi_motion *load_fish(double lag_angle)
{
    char params[600];
    snprintf(params, sizeof params,
             "{\"fishLength\": 0.2, \"fishWidth\": 0.02, \"LEPos\": 0.06, \"wingspan\": 0.2,"
             "\"wingchord\": 0.04, \"waveLength\": 0.2, \"freq\": 10, \"amplitude\": 0.02, "
             "\"relax\": 0.2,"
             "\"startPosition\": [0.4, 0.15, 0.08], \"swimmingPosition\": [0.227, 0.15, 0.22],"
             "\"pitchAngle\": 30, \"lagAngle\": %g, \"translation\": [0.3, 0.15, 0.24]}",
             lag_angle);
    tobi_motion *motion = NULL;
    tobi_error err = { 0 };
    if (tobi_motion_script(TOBI_SOURCE_DIR "/scenes/flying_fish/motion.lua", params, &motion, &err))
        fail_msg("%s", err.text);
    return motion;
}

/* Where a point given in the fish's own coordinates is at time t. */
static void locate(tobi_motion *motion, double t, double x, double y, double z, double out[3])
{
    const double rest[1][3] = { { centre[0] + x, centre[1] + y, centre[2] + z } };
    double position[1][3];
    tobi_error err = { 0 };
    if (tobi_motion_positions(motion, t, 1, rest, position, &err)) fail_msg("%s", err.text);
    for (int a = 0; a < 3; a++) out[a] = position[0][a];
}

static double distance(const double a[3], const double b[3])
{
    return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}

/* At the nose there is no wave, and pitch turns it about the centre: the centre's path is that of
   the point (0, 0, 0) without its y. */
static void test_path_and_speeds(void **state)
{
    (void)state;
    tobi_motion *fish = load_fish(80);
    double p[3], before[3], after[3], peak[2] = { 0 };
    locate(fish, 0.0, 0, 0, 0, p);
    assert_true(distance(p, centre) < 1e-15);
    locate(fish, RELAX, 0, 0, 0, p);
    assert_true(fabs(p[0] - start[0]) < 1e-14 && fabs(p[2] - start[2]) < 1e-14);
    locate(fish, 0.8, 0, 0, 0, p);
    assert_true(fabs(p[0] - swim[0]) < 1e-14 && fabs(p[2] - swim[2]) < 1e-14);
    for (double t = 0.001; t < 0.4; t += 0.001) {
        locate(fish, t - 1e-6, 0, 0, 0, before);
        locate(fish, t + 1e-6, 0, 0, 0, after);
        before[1] = after[1] = 0.0;
        peak[t > RELAX] = fmax(peak[t > RELAX], distance(before, after) / 2e-6);
    }
    assert_true(fabs(peak[0] - 1.48) < 0.005 && fabs(peak[1] - 1.75) < 0.005);
    tobi_motion_free(fish);
}

static void test_wave_and_pitch(void **state)
{
    (void)state;
    tobi_motion *fish = load_fish(80);
    double p[3];
    for (double t = 0.0; t < 0.8; t += 0.0137) {
        double x = 0.07, s = x + LENGTH / 2, ramp = fmin(1, t / RELAX), pitch = PI / 6 * ramp;
        double wave = 0.02 / LENGTH * s * sin(2 * PI * (s / 0.2 - 10 * t)) * ramp;
        double ease = t < RELAX ? (1 - cos(PI * t / RELAX)) / 2 : 1;
        double then = t < RELAX ? 0 : (1 - cos(PI * fmin(1, (t - RELAX) / (2 * CYCLE)))) / 2;
        double path[3];
        for (int a = 0; a < 3; a++)
            path[a] = centre[a] + (start[a] - centre[a]) * ease + (swim[a] - start[a]) * then;
        double z = 0.004;
        double expected[3] = { path[0] + cos(pitch) * x + sin(pitch) * z, path[1] + wave,
                               path[2] - sin(pitch) * x + cos(pitch) * z };
        locate(fish, t, x, 0, z, p);
        assert_true(distance(p, expected) < 1e-14);
    }
    double nose[3], tail[3];
    locate(fish, 0.7, -LENGTH / 2, 0, 0, nose);
    locate(fish, 0.7, LENGTH / 2, 0, 0, tail);
    assert_true(nose[2] - tail[2] > 0.09 && nose[0] < tail[0]);      /* the head is up */
    tobi_motion_free(fish);
}

/* Angle of the leading edge against straight outward, seen in the fish at time t (wave removed by
   the symmetry of both sides: its y shift is the same for both wings). */
static double fold_angle(tobi_motion *fish, double t)
{
    double right[3], left[3], root[3];
    locate(fish, t, -LEAD, HALF + WING, 0, right);
    locate(fish, t, -LEAD, -HALF - WING, 0, left);
    locate(fish, t, -LEAD, 0, 0, root);
    double out = (right[1] - left[1]) / 2 - HALF;
    double pitch = PI / 6 * fmin(1, t / RELAX);
    double back = (right[0] - root[0]) * cos(pitch) - (right[2] - root[2]) * sin(pitch);
    return atan2(back, out) * 180 / PI;
}

static void test_wings_fold_like_a_fan(void **state)
{
    (void)state;
    tobi_motion *fish = load_fish(80), *seed = load_fish(72);
    assert_true(fabs(fold_angle(fish, 0)) < 1e-10);
    assert_true(fabs(fold_angle(fish, RELAX / 2) - 40) < 1e-9);
    assert_true(fabs(fold_angle(fish, 0.2) - 80) < 1e-9 && fabs(fold_angle(fish, 0.4) - 80) < 1e-9);
    assert_true(fabs(fold_angle(fish, 0.45) - 40) < 1e-9);
    assert_true(fabs(fold_angle(fish, 0.5)) < 1e-9 && fabs(fold_angle(fish, 0.8)) < 1e-9);
    assert_true(fabs(fold_angle(seed, 0.3) - 72) < 1e-9);
    tobi_motion_free(fish);
    tobi_motion_free(seed);
}

/* Points that are 10 um apart at rest, all over body and wings and over the wing root, stay close,
   and no point jumps in time. */
static void test_nothing_tears(void **state)
{
    (void)state;
    tobi_motion *fish = load_fish(80);
    double a[3], b[3], worst = 0;
    srand(1);
    for (int k = 0; k < 20000; k++) {
        double t = 0.8 * rand() / RAND_MAX, u = (double)rand() / RAND_MAX,
               v = (double)rand() / RAND_MAX;
        int wing = k % 3 != 0;
        double x = wing ? -LEAD + CHORD * u : -LENGTH / 2 + LENGTH * u;
        double y = wing ? HALF + WING * v * v * v : HALF * (2 * v - 1);
        locate(fish, t, x, y, 0.001, a);
        locate(fish, t, x - 7e-6 * wing, y - 7e-6, 0.001, b);
        worst = fmax(worst, distance(a, b) / 1e-5);
        locate(fish, t + 1e-7, x, y, 0.001, b);
        assert_true(distance(a, b) < 1e-7 * 12);
    }
    assert_true(worst < 6.0);
    /* The widest point of the body, beside the wing's front corner, must not turn with the wing. */
    locate(fish, 0.3, -LEAD - 0.003, HALF, 0, a);
    locate(fish, 0.3, -LEAD - 0.003, HALF + 1e-16, 0, b);
    assert_true(distance(a, b) < 1e-9);
    tobi_motion_free(fish);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_path_and_speeds),
        cmocka_unit_test(test_wave_and_pitch),
        cmocka_unit_test(test_wings_fold_like_a_fan),
        cmocka_unit_test(test_nothing_tears),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

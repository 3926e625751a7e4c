/* Keyframes: what the columns mean, exact figures where the curve is exact, smooth rates, and what is said
   about bad files. */
#include "tobiuo/motion.h"
#include "own_folder.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define PI 3.14159265358979323846

static tobi_motion *load(const char *text, const double pivot[3])
{
    static const double none[3] = {0, 0, 0};
    tobi_motion *motion = NULL;
    tobi_error err = {0};
    FILE *f = fopen("rows.csv", "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
    if (tobi_motion_keyframes("rows.csv", pivot ? pivot : none, &motion, &err) != TOBI_OK)
        fail_msg("<%s>: %s", text, err.text);
    return motion;
}

static void place(tobi_motion *m, double t, double x, double y, double z, double out[3])
{
    double rest[1][3] = {{x, y, z}}, now[1][3];
    tobi_error err = {0};
    assert_int_equal(tobi_motion_positions(m, t, 1, (const double (*)[3])rest, now, &err), TOBI_OK);
    memcpy(out, now[0], sizeof now[0]);
}

static void expect_at(tobi_motion *m, double t, const double rest[3], const double expected[3])
{
    double p[3];
    place(m, t, rest[0], rest[1], rest[2], p);
    for (int a = 0; a < 3; a++)
        if (!(fabs(p[a] - expected[a]) < 1e-12))
            fail_msg("t = %g: (%.15g, %.15g, %.15g), expected (%g, %g, %g)", t, p[0], p[1], p[2], expected[0],
                     expected[1], expected[2]);
}

#define AT(m, t, x, y, z, X, Y, Z) expect_at(m, t, (double[3]){x, y, z}, (double[3]){X, Y, Z})

static void constant_acceleration_is_met_exactly(void **state)
{
    (void)state;
    char text[4000] = "# of a test\n\nTime; x; z\n";
    const double times[] = {0, 0.1, 0.35, 0.5, 1.1, 2};
    for (int i = 0; i < 6; i++)
        sprintf(text + strlen(text), "%.17g;%.17g;%.17g\n", times[i], 1 + 2*times[i] - 3*times[i]*times[i],
                -times[i]);
    tobi_motion *m = load(text, NULL);
    assert_true(tobi_motion_is_rigid(m));
    for (double t = 0; t <= 2; t += 0.0625) AT(m, t, 1, 2, 3, 2 + 2*t - 3*t*t, 2, 3 - t);
    AT(m, -5, 1, 2, 3, 2, 2, 3);              /* held */
    AT(m, 7, 1, 2, 3, 1 + 1 + 4 - 12, 2, 1);
    tobi_motion_free(m);
}

static void shifts_have_the_names_of_ships_too(void **state)
{
    (void)state;
    tobi_motion *m = load("time [s],Surge [mm],sway,heave [cm],yaw\n0,0,0,0,0\n1,500,2,-30,90\n", NULL);
    AT(m, 1, 1, 0, 0, 0.5, 3, -0.3);
    tobi_motion_free(m);
}

static void a_constant_turn_is_met_exactly(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "t,ax,ay,az,angle\n0,0,0,2,0\n0.5,0,0,2,45\n2,0,0,2,180\n3,0,0,2,270\n",
        "t,yaw\n0,0\n0.5,45\n2,180\n3,270\n",
        "t,qw,qx,qy,qz\n0,1,0,0,0\n0.5,0.92387953251128674,0,0,0.38268343236508978\n2,0,0,0,7\n"
        "3,0.70710678118654757,0,0,-0.70710678118654757\n",
    };
    const double pivot[3] = {1, 0, 0};
    for (int i = 0; i < 3; i++) {
        tobi_motion *m = load(texts[i], pivot);
        for (double t = 0; t <= 3; t += 0.125) {
            double c = cos(t*PI/2), s = sin(t*PI/2);
            AT(m, t, 3, 1, 5, 1 + 2*c - s, 2*s + c, 5);
        }
        tobi_motion_free(m);
    }
}

static void roll_comes_before_pitch_before_yaw(void **state)
{
    (void)state;
    tobi_motion *m = load("time\troll\tpitch\tyaw\n0\t90\t0\t0\n1\t90\t90\t0\n2\t90\t90\t90\n", NULL);
    AT(m, 0, 0, 1, 0, 0, 0, 1);               /* y to z */
    AT(m, 1, 0, 1, 0, 1, 0, 0);               /* y to z, z to x */
    AT(m, 2, 0, 1, 0, 0, 1, 0);               /* y to z, z to x, x to y */
    AT(m, 2, 1, 0, 0, 0, 0, -1);              /* x to -z */
    tobi_motion_free(m);
}

static void standing_still_is_exact(void **state)
{
    (void)state;
    tobi_motion *m = load("t,x,yaw\n0,0,0\n1,0,0\n2,1,90\n3,1,90\n", NULL);
    AT(m, 0.5, 1, 0, 0, 1, 0, 0);
    AT(m, 2.5, 1, 0, 0, 1, 1, 0);
    AT(m, 1.5, 0, 0, 0, 0.5, 0, 0);
    tobi_motion_free(m);
    m = load("t,x\n1,4\n", NULL);             /* one row: a shift for good */
    AT(m, 0, 1, 0, 0, 5, 0, 0);
    tobi_motion_free(m);
    m = load("t,x\n0,0\n2,1\n", NULL);        /* two rows: constant speed */
    AT(m, 0.5, 0, 0, 0, 0.25, 0, 0);
    tobi_motion_free(m);
}

static void names_may_bring_their_units(void **state)
{
    (void)state;
    tobi_motion *m = load("time [s],\"x [m]\",Y[m],qw [1],qx,qy,qz [1]\n"
                          "0,0,0,1,0,0,0\n2,1,4,1,0,0,0\n", NULL);
    AT(m, 0.5, 0, 0, 0, 0.25, 1, 0);
    tobi_motion_free(m);
    m = load("t (s)\troll [deg]\tyaw  [degrees]\n0\t90\t0\n", NULL);
    AT(m, 0, 0, 1, 0, 0, 0, 1);
    tobi_motion_free(m);
    m = load("time [min],x\n0,0\n2,4\n", NULL);
    AT(m, 30, 0, 0, 0, 1, 0, 0);
    tobi_motion_free(m);
    m = load("time (h),x\n0,0\n1,4\n", NULL);
    AT(m, 900, 0, 0, 0, 1, 0, 0);
    tobi_motion_free(m);
}

/* Rates of both sides of a row agree, for turns about changing axes too. */
static void rates_do_not_jump_at_rows(void **state)
{
    (void)state;
    char text[4000] = "t,x,y,roll,pitch,yaw\n";
    const double times[] = {0, 0.3, 0.4, 0.9, 1.0, 1.7};
    for (int i = 0; i < 6; i++) {
        double s = sin(3*times[i]), c = cos(2*times[i]);
        sprintf(text + strlen(text), "%g,%.17g,%.17g,%.17g,%.17g,%.17g\n", times[i], s, c, 50*s, 40*c,
                70*s*c);
    }
    tobi_motion *m = load(text, NULL);
    const double e = 1e-5;
    for (int i = 1; i < 5; i++) {
        double before[3], at[3], after[3];
        place(m, times[i] - e, 1, 2, 3, before);
        place(m, times[i], 1, 2, 3, at);
        place(m, times[i] + e, 1, 2, 3, after);
        for (int a = 0; a < 3; a++) {
            double jump = (after[a] - at[a])/e - (at[a] - before[a])/e;
            if (fabs(jump) > 0.02) fail_msg("row %d, %c: the rate jumps by %g m/s", i, "xyz"[a], jump);
        }
    }
    tobi_motion_free(m);
}

/* Sampled sines come back better than by one eighth per halving: third order. */
static void finer_rows_come_closer(void **state)
{
    (void)state;
    double error[2] = {0};
    for (int k = 0; k < 2; k++) {
        int rows = 20 << k;
        char *text = malloc((size_t)rows*100 + 100);
        strcpy(text, "t,x,yaw\n");
        for (int i = 0; i <= rows; i++) {
            double t = (double)i/rows;
            sprintf(text + strlen(text), "%.17g,%.17g,%.17g\n", t, sin(6*t), 60*sin(6*t));
        }
        tobi_motion *m = load(text, NULL);
        for (double t = 0; t < 1; t += 0.001) {
            double p[3], s = sin(6*t), a = 60*s*PI/180;
            place(m, t, 1, 0, 0, p);
            error[k] = fmax(error[k], hypot(p[0] - s - cos(a), p[1] - sin(a)));
        }
        tobi_motion_free(m);
        free(text);
    }
    if (!(error[1] < error[0]/6 && error[0] < 5e-3)) fail_msg("errors %g, %g", error[0], error[1]);
}

static void units_are_read(void **state)
{
    (void)state;
    tobi_motion *m = load("time [ms];x (mm);y [cm];z [m];yaw [rad]\n0;0;0;0;0\n500;200;-30;4;1\n", NULL);
    AT(m, 0.5, 0, 0, 1, 0.2, -0.3, 5);
    AT(m, 0.5, 1, 0, 0, 0.2 + cos(1), -0.3 + sin(1), 4);
    tobi_motion_free(m);
}

static void bad_files_are_named_with_their_line(void **state)
{
    (void)state;
    static const struct { const char *text, *says; } bad[] = {
        {"", "no rows"},
        {"time,x\n", "no rows"},
        {"time,x,surge\n0,1,1\n", "rows.csv:1: a column comes twice: x"},
        {"x,y\n1,2\n", "rows.csv:1: there is no column \"time\""},
        {"# note\ntime,q\n0,1\n", "rows.csv:2: there is no column \"q\"; allowed are time (s)"},
        {"time,x,X\n0,1,2\n", "twice: x"},
        {"time\n0\n", "no column says where"},
        {"time,qw,qx\n0,1,0\n", "all of qw, qx, qy, qz"},
        {"time,ax,ay,az\n0,1,0,0\n", "all of ax, ay, az, angle"},
        {"time,yaw,qw,qx,qy,qz\n0,1,0,0,0,0\n", "given twice"},
        {"time,x\n0,1\n1,two\n", "rows.csv:3: \"two\" in column x"},
        {"time,x\n0,1\n1,nan\n", "rows.csv:3: \"nan\""},
        {"time;x\n0,0;1,5\n", "rows.csv:2: \"0,0\" in column time is no finite number; decimals follow a "
         "point"},
        {"time,x\n0,1\n1\n", "rows.csv:3: the row has fewer columns than the header, 2"},
        {"time,x\n0,1,2\n", "more columns"},
        {"time,x\n0,1\n0,2\n", "rows.csv:3: time 0 s does not come after 0 s"},
        {"time,qw,qx,qy,qz\n0,0,0,0,0\n", "no length"},
        {"time,ax,ay,az,angle\n0,0,0,0,5\n", "no length"},
        {"time,x,\n0,1\n", "rows.csv:1: an empty column name (a comma too many?)"},
        {"time [s],x [in]\n0,1\n", "rows.csv:1: column x is in [in]; allowed is [m], [cm], [mm] or no "
         "unit, which is m"},
        {"time [d],x\n0,1\n", "column time is in [d]; allowed is [s], [ms], [min], [h] or no unit"},
        {"time,yaw [turns]\n0,1\n", "column yaw is in [turns]; allowed is [degrees], [deg], [rad] or "
         "no unit, which is degrees"},
        {"time,x [m\n0,1\n", "rows.csv:1: no ] after the unit [m"},
        {"time (d),x\n0,1\n", "column time is in [d]; allowed is [s]"},
        {"time (s,x\n0,1\n", "rows.csv:1: no ) after the unit (s"},
        {"time,[m]\n0,1\n", "rows.csv:1: an empty column name"},
        {"time,x\n0,1\n1,-2e30\n", "rows.csv:3: -2e+30 in column x is too large; allowed is up to 1e+30"},
        {"time,x\n0,0\n1e-200,1e25\n1,0\n", "rows.csv:3: from 0 s of the row before to 1e-200 s the body "
         "moves too fast; allowed is up to 1e+30 m/s"},
        {"time,x\n0,0\n1e-310,1e-10\n", "rows.csv:3: from 0 s"},
        {"time,yaw\n0,0\n1e-40,90\n", "rows.csv:3: from 0 s of the row before to 1e-40 s the body turns too "
         "fast; allowed is up to 1e+30 rad/s"},
    };
    const double none[3] = {0, 0, 0};
    tobi_motion *m;
    tobi_error err = {0};
    for (size_t i = 0; i < sizeof bad/sizeof *bad; i++) {
        FILE *f = fopen("rows.csv", "w");
        fputs(bad[i].text, f);
        fclose(f);
        tobi_status status = tobi_motion_keyframes("rows.csv", none, &m, &err);
        if (status != TOBI_INVALID || !strstr(err.text, bad[i].says))
            fail_msg("<%s>: \"%s\" does not say \"%s\"", bad[i].text, err.text, bad[i].says);
        assert_null(m);
    }
    /* A file that is something else is not quoted at length. */
    FILE *f = fopen("rows.csv", "w");
    fputs("machine example.org login someone password 0123456789\n", f);
    fclose(f);
    assert_int_equal(tobi_motion_keyframes("rows.csv", none, &m, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "rows.csv:1: there is no column \"machine example....\"; allowed are"));

    f = fopen("rows.csv", "w");
    fwrite("t\0,\0x\0\n\0", 1, 8, f);
    fclose(f);
    assert_int_equal(tobi_motion_keyframes("rows.csv", none, &m, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "rows.csv:1: holds a zero byte: no plain text, or UTF-16"));
    assert_int_equal(tobi_motion_keyframes("nowhere.csv", none, &m, &err), TOBI_NOT_FOUND);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constant_acceleration_is_met_exactly),
        cmocka_unit_test(shifts_have_the_names_of_ships_too),
        cmocka_unit_test(a_constant_turn_is_met_exactly),
        cmocka_unit_test(units_are_read),
        cmocka_unit_test(roll_comes_before_pitch_before_yaw),
        cmocka_unit_test(standing_still_is_exact),
        cmocka_unit_test(names_may_bring_their_units),
        cmocka_unit_test(rates_do_not_jump_at_rows),
        cmocka_unit_test(finer_rows_come_closer),
        cmocka_unit_test(bad_files_are_named_with_their_line),
    };
    return cmocka_run_group_tests(tests, enter_own_folder, leave_own_folder);
}

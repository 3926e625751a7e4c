/* Wave makers: theory by numbers that stand in books, and what is refused. */
#include "calls.h"
#include "rigid/waves.h"
#include "tobiuo/tobiuo.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double PI = 3.14159265358979323846;

static void close_to(double value, double expected, double within)
{
    if (!(fabs(value - expected) <= within))
        fail_msg("%.12g is not %.12g within %g", value, expected, within);
}

static tobi_wave_maker_def make_def(void)
{
    return (tobi_wave_maker_def){ .direction = { 1, 0, 0 }, .up = { 0, 1, 0 }, .depth = 1, .gravity = 9.81,
                                  .order = 1, .peakedness = 3.3, .seed = 1, .components = 100 };
}

static void lengths_follow_the_dispersion_relation(void **state)
{
    (void)state;
    for (double period = 0.3; period < 60; period *= 1.3) {
        const double k = tobi_waves_number(9.81, 1, period), omega = 2*PI/period;
        close_to(9.81*k*tanh(k)/(omega*omega), 1, 1e-12);
    }
    close_to(2*PI/tobi_waves_number(9.81, 1, 1), 9.81/(2*PI), 0.01);       /* deep: g T^2/2 pi */
    close_to(2*PI/tobi_waves_number(9.81, 1, 50)/50, sqrt(9.81), 0.01);    /* shallow: sqrt(g h) */
}

/* Dean and Dalrymple, Water Wave Mechanics for Engineers and Scientists, eq. 6.25, 6.26, and their limits. */
static void heights_per_stroke_are_biesels(void **state)
{
    (void)state;
    close_to(tobi_waves_per_stroke(1, 1, INFINITY), 0.98178, 1e-4);
    close_to(tobi_waves_per_stroke(1, 1, 0), 0.52809, 1e-4);
    close_to(tobi_waves_per_stroke(0.01, 1, INFINITY), 0.01, 1e-5);
    close_to(tobi_waves_per_stroke(0.01, 1, 0), 0.005, 1e-5);
    close_to(tobi_waves_per_stroke(30, 1, INFINITY), 2, 1e-9);
    close_to(tobi_waves_per_stroke(1, 1, -1e7), 0.98178, 1e-4);            /* a far hinge is a piston */
    assert_true(tobi_waves_per_stroke(1, 1, 0.5) < tobi_waves_per_stroke(1, 1, 0));
}

static void regular_waves_have_their_stroke(void **state)
{
    tobi_wave_maker_def d = make_def();
    tobi_waves *w;
    (void)state;
    d.height = 0.1;
    d.period = 2;
    const double k = tobi_waves_number(9.81, 1, 2), half = 0.05/tobi_waves_per_stroke(k, 1, INFINITY);
    OK(tobi_waves_create(&d, &w, &err));
    close_to(tobi_waves_displacement(w, 0.5), half, 1e-12);
    const double c = cosh(k), bound = 0.01*k/16*c*(2 + cosh(2*k))/pow(sinh(k), 3);
    close_to(tobi_waves_level(w, 1e-9, 0), 0.05 + bound, 1e-8);
    assert_true(tobi_waves_level(w, 0.5, 0) > 0);         /* local waves; long ones have next to none */
    tobi_waves_free(w);
    d.order = 2;
    OK(tobi_waves_create(&d, &w, &err));
    const double s = sinh(k), more = 0.01/32*(3*cosh(k)/(s*s*s) - 2/tobi_waves_per_stroke(k, 1, INFINITY));
    close_to(tobi_waves_displacement(w, 0.25), half*sin(PI/4) + more, 1e-12);
    tobi_waves_free(w);
    d.order = 1;
    d.ramp = 2;
    d.start = 1;
    OK(tobi_waves_create(&d, &w, &err));
    assert_true(tobi_waves_displacement(w, 0.9) == 0);
    close_to(tobi_waves_displacement(w, 2.5), half*0.5*(1 - cos(0.75*PI))*sin(2.5*PI), 1e-12);
    tobi_waves_free(w);
}

/* Goring: a stroke of sqrt(16 H h/3) in all, and the speed of the water under the crest in the middle. */
static void solitary_waves_have_gorings_stroke(void **state)
{
    tobi_wave_maker_def d = make_def();
    tobi_waves *w;
    (void)state;
    d.solitary_height = 0.2;
    OK(tobi_waves_create(&d, &w, &err));
    close_to(tobi_waves_displacement(w, 100), sqrt(16*0.2/3), 2e-3*sqrt(16*0.2/3));
    assert_true(tobi_waves_displacement(w, 0) == 0);
    const double kappa = sqrt(0.75*0.2), c = sqrt(9.81*1.2), middle = (3.8 + 0.2)/(kappa*c), dt = 1e-4;
    const double way = tobi_waves_displacement(w, middle + dt) - tobi_waves_displacement(w, middle - dt);
    close_to(way/(2*dt), c*0.2/1.2, 1e-6);
    close_to(tobi_waves_level(w, middle, 0), 0.2, 1e-9);
    assert_true(tobi_waves_level(w, 100, 0) == 0);
    tobi_waves_free(w);
}

static void irregular_waves_have_their_height(void **state)
{
    tobi_wave_maker_def d = make_def();
    tobi_waves *w, *other;
    (void)state;
    d.flap = 1;
    d.significant_height = 0.1;
    d.peak_period = 2;
    for (int spectrum = TOBI_JONSWAP; spectrum <= TOBI_PIERSON_MOSKOWITZ; spectrum++) {
        double sum = 0;
        d.spectrum = spectrum;
        d.seed = 1;
        OK(tobi_waves_create(&d, &w, &err));
        for (int n = 0; n < 40000; n++) sum += pow(tobi_waves_level(w, 0.11*n, 0), 2)/40000;
        close_to(4*sqrt(sum), 0.1, 0.002);
        OK(tobi_waves_create(&d, &other, &err));
        assert_true(tobi_waves_displacement(w, 7) == tobi_waves_displacement(other, 7));
        tobi_waves_free(other);
        d.seed = 2;
        OK(tobi_waves_create(&d, &other, &err));
        assert_true(tobi_waves_displacement(w, 7) != tobi_waves_displacement(other, 7));
        tobi_waves_free(other);
        tobi_waves_free(w);
    }
}

/* At the focus the crest is as high as asked for: all cosines are 1 there. Beside it, it is lower, and where
   waves start the group is spread out. */
static void crests_of_a_group_meet(void **state)
{
    tobi_wave_maker_def d = make_def();
    tobi_waves *w;
    (void)state;
    d.flap = 1;
    d.focused_height = 0.08;
    d.peak_period = 1.6;
    d.focus_distance = 6;
    d.focus_time = 12;
    d.ramp = 2;
    for (int spectrum = TOBI_JONSWAP; spectrum <= TOBI_PIERSON_MOSKOWITZ; spectrum++) {
        double most = 0, least = 0;
        d.spectrum = spectrum;
        OK(tobi_waves_create(&d, &w, &err));
        close_to(tobi_waves_level(w, 12, 6), 0.08, 1e-12);
        for (int n = 0; n < 400; n++) {
            const double level = tobi_waves_level(w, 8 + 0.02*n, 5.5);
            most = fmax(most, level);
            least = fmin(least, tobi_waves_level(w, 8 + 0.02*n, 6));
        }
        assert_true(most < 0.079 && most > 0.05);
        assert_true(least < -0.03 && least > -0.07);       /* the troughs beside it are flatter */
        assert_true(fabs(tobi_waves_displacement(w, 0.5)) < 0.01 && tobi_waves_late(w) == 0);
        tobi_waves_free(w);
    }
    d.focus_time = 5;
    OK(tobi_waves_create(&d, &w, &err));
    const double k = tobi_waves_number(9.81, 1, 0.8), speed = PI/(0.8*k)*(1 + 2*k/sinh(2*k));
    close_to(tobi_waves_late(w), 6/speed, 1e-9);
    tobi_waves_free(w);
}

static const char *write_record(const char *text)
{
    static char path[64];
    snprintf(path, sizeof path, "record_%d.csv", (int)getpid());
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
    return path;
}

/* What another maker makes at a distance, written as a gauge has it: uneven in time, about a level of its
   own, beside another column. It comes again, there and further on. */
static void recorded_levels_come_again(void **state)
{
    tobi_wave_maker_def d = make_def(), again = make_def();
    tobi_waves *w, *v;
    char path[64];
    (void)state;
    d.flap = again.flap = 1;
    d.focused_height = 0.05;
    d.peak_period = 1.6;
    d.focus_distance = 6;
    d.focus_time = 20;
    OK(tobi_waves_create(&d, &w, &err));
    snprintf(path, sizeof path, "%s", write_record(""));
    FILE *f = fopen(path, "w");
    fprintf(f, "note;time [ms];G1_level [cm]\n");
    for (double t = 0; t <= 40; t += 0.02 + 0.01*sin(9*t))
        fprintf(f, "word;%.9g;%.9g\n", 1e3*t, 1e2*(1 + tobi_waves_level(w, t, 3)));
    fclose(f);
    again.record_file = path;
    again.record_column = "g1_level";
    again.record_distance = 3;
    OK(tobi_waves_create(&again, &v, &err));
    for (double t = 12; t < 28; t += 0.1) {
        close_to(tobi_waves_level(v, t, 3), tobi_waves_level(w, t, 3), 0.0005);
        close_to(tobi_waves_level(v, t, 6), tobi_waves_level(w, t, 6), 0.0005);
        close_to(tobi_waves_displacement(v, t), tobi_waves_displacement(w, t), 0.0005);
    }
    close_to(tobi_waves_sudden(v), 1.6, 0.05);
    tobi_waves_free(v);
    again.longest_period = 1.2;                            /* without those of the peak */
    OK(tobi_waves_create(&again, &v, &err));
    assert_true(fabs(tobi_waves_level(v, 20, 6)) < 0.02);
    tobi_waves_free(v);
    tobi_waves_free(w);
    remove(path);
}

/* The top of a flap goes where the waves go, by the stroke at the still water. */
static void flaps_turn_about_their_hinge(void **state)
{
    tobi_wave_maker_def d = make_def();
    tobi_motion *m;
    const double rest[1][3] = { { 0.2, 1.3, 0 } };
    double at[1][3];
    (void)state;
    d.flap = 1;
    d.height = 0.1;
    d.period = 2;
    d.hinge[0] = 0.2;
    d.hinge[1] = 0.3;
    OK(tobi_motion_wave_maker(&d, &m, &err));
    OK(tobi_motion_positions(m, 0.5, 1, rest, at, &err));
    const double half = 0.05/tobi_waves_per_stroke(tobi_waves_number(9.81, 1, 2), 1, 0);
    close_to(tan(asin(at[0][0] - 0.2)), half, 1e-12);
    assert_true(at[0][0] > 0.2 && tobi_motion_is_rigid(m));
    tobi_motion_free(m);
}

static tobi_status try(const tobi_wave_maker_def *d, tobi_error *err)
{
    tobi_motion *m;
    const tobi_status status = tobi_motion_wave_maker(d, &m, err);
    if (status == TOBI_OK) tobi_motion_free(m);
    return status;
}

static void what_cannot_be_is_refused(void **state)
{
    tobi_wave_maker_def d = make_def();
    (void)state;
    REFUSED(try(&d, &err), TOBI_INVALID, "makes one kind of waves: regular, solitary, irregular or focused");
    d.height = 0.1;
    REFUSED(try(&d, &err), TOBI_INVALID, "regular waves of a height of 0.1 m have no period");
    d.period = 1;
    d.height = 0.3;
    REFUSED(try(&d, &err), TOBI_INVALID, "break on water 1 m deep: allowed are up to 0.2214 m");
    d.order = 2;
    d.period = 9;
    REFUSED(try(&d, &err), TOBI_INVALID, "are too long for order 2 on 1 m of water");
    d.flap = 1;
    REFUSED(try(&d, &err), TOBI_UNSUPPORTED, "order 2 is for pistons");
    d.hinge_height = 1.5;
    REFUSED(try(&d, &err), TOBI_INVALID, "the hinge is 1.5 m above the bottom");
    d = make_def();
    d.solitary_height = 0.8;
    REFUSED(try(&d, &err), TOBI_INVALID, "a solitary wave 0.8 m high breaks on water 1 m deep");
    d.solitary_height = 0.2;
    d.flap = 1;
    REFUSED(try(&d, &err), TOBI_UNSUPPORTED, "a flap makes no solitary waves");
    d.up[0] = 1;
    d.up[1] = 0;
    REFUSED(try(&d, &err), TOBI_INVALID, "direction, across up, must not be zero");
    d = make_def();
    d.significant_height = 0.1;
    d.peak_period = 2;
    d.components = 0;
    REFUSED(try(&d, &err), TOBI_INVALID, "the waves have 0 components");
    d.depth = 0;
    REFUSED(try(&d, &err), TOBI_INVALID, "needs the depth of the water and gravity");
    d.depth = NAN;
    REFUSED(try(&d, &err), TOBI_INVALID, "every number of a wave maker must be finite");
}

static void groups_that_cannot_be_are_refused(void **state)
{
    tobi_wave_maker_def d = make_def();
    (void)state;
    d.focused_height = 0.05;
    d.peak_period = 1.6;
    REFUSED(try(&d, &err), TOBI_INVALID, "a focused group needs a peak_period and a distance");
    d.focus_distance = 6;
    REFUSED(try(&d, &err), TOBI_INVALID, "are at the focus, 6 m away, at 4.176 s");
    d.focus_time = 12;
    d.focused_height = 0.3;
    REFUSED(try(&d, &err), TOBI_INVALID, "a focused crest 0.3 m high with a peak period of 1.6 s breaks");
    d.focused_height = 0.05;
    d.components = 0;
    REFUSED(try(&d, &err), TOBI_INVALID, "the waves have 0 components");
    d.components = 50;
    d.record_file = "any.csv";
    REFUSED(try(&d, &err), TOBI_INVALID, "given are 2");
}

static void records_that_cannot_be_are_refused(void **state)
{
    tobi_wave_maker_def d = make_def();
    static const struct { const char *text, *why; } bad[] = {
        { "time,x\n0,1\n1,2\n", ":1: there is no column of levels named level; beside the time there are x" },
        { "t\n0\n", ":1: there is no column of levels named level; beside the time there are none" },
        { "level\n0\n1\n", ":1: there is no column \"time\"" },
        { "time,level\n0,1\n0,2\n", ":3: time 0 s does not come after 0 s" },
        { "time,level\n0,a\n", ":2: \"a\" in column level is no finite number" },
        { "time,level [ft]\n0,1\n", ":1: column level is in [ft]; allowed is [m], [cm], [mm]" },
        { "time,level,level\n0,1,1\n", ":1: a column comes twice: level" },
        { "time,level\n0,1\n0.1,1.1\n", "its 0.1 s are less than two periods of the shortest wave" },
        { "time,level\n0,1\n1e5,1.1\n", "have more than 10000 regular waves" },
        { "time,level\n0,1\n20,1\n", "its level does not change" },
    };
    (void)state;
    for (size_t k = 0; k < sizeof bad/sizeof *bad; k++) {
        d.record_file = write_record(bad[k].text);
        REFUSED(try(&d, &err), TOBI_INVALID, bad[k].why);
    }
    d.record_file = write_record("t,level\n0,0\n1,1\n2,0\n3,1\n4,0\n");
    d.longest_period = 1.1;
    d.shortest_period = 1.05;
    REFUSED(try(&d, &err), TOBI_INVALID, "no wave of its 4 s has a period between shortest_period, 1.05 s, "
            "and longest_period, 1.1 s");
    d.longest_period = 1;
    REFUSED(try(&d, &err), TOBI_INVALID, "longest_period, 1 s, is not greater than shortest_period, 1.05 s");
    d.record_distance = -1;
    REFUSED(try(&d, &err), TOBI_INVALID, "must not be below 0; given are -1 m");
    remove(d.record_file);
    d.record_distance = 0;
    d.longest_period = 0;
    REFUSED(try(&d, &err), TOBI_NOT_FOUND, "record");
}

/* A row of many columns, as tables of a laboratory have; too many are refused. */
static void records_have_many_columns(void **state)
{
    tobi_wave_maker_def d = make_def();
    char text[16384] = "time,level";
    (void)state;
    for (int k = 0; k < 1022; k++) snprintf(text + strlen(text), sizeof text - strlen(text), ",G%d", k);
    d.record_file = write_record(text);
    REFUSED(try(&d, &err), TOBI_INVALID, "no rows");
    snprintf(text + strlen(text), sizeof text - strlen(text), ",more");
    d.record_file = write_record(text);
    REFUSED(try(&d, &err), TOBI_INVALID, ":1: more columns than are allowed, 1024");
    remove(d.record_file);
}

/* A piston in front of a side, closer to it than its stroke. */
static void strokes_fit_into_the_tank(void **state)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_body_def b = tobi_default_body_def();
    tobi_wave_maker_def d = make_def();
    tobi_world *world;
    tobi_motion *m;
    (void)state;
    w.dimension = 2;
    w.domain_max[0] = 5;
    w.domain_max[1] = 2;
    w.gravity[2] = 0;
    w.spacing = 0.1;
    w.end_time = 4;
    d.height = 0.1;
    d.period = 2;
    OK(tobi_motion_wave_maker(&d, &m, &err));
    OK(tobi_world_create(&w, NULL, &world, &err));
    b.name = "piston";
    b.box_min[0] = 0.02;
    b.box_max[0] = 0.5;
    b.box_max[1] = 1.9;
    b.motion = tobi_motion_positions;
    b.motion_user = m;
    b.motion_rigid = 1;
    REFUSED(tobi_world_add_body(world, &b, &err), TOBI_INVALID, "the stroke of 'piston' is beyond the tank");
    b.box_min[0] = 0.1;
    OK(tobi_world_add_body(world, &b, &err));
    tobi_world_destroy(world);
    tobi_motion_free(m);
}

/* Another body that moves through a side, as a recorded stroke may, is told; one that is drawn up is not. */
static void other_strokes_are_noted(void **state)
{
    static const double ways[][3] = { { -0.2, 0, 0 }, { -0.02, 0, 0 }, { 0, 2, 0 } };
    (void)state;
    for (int k = 0; k < 3; k++) {
        tobi_world_def w = tobi_default_world_def();
        tobi_body_def b = tobi_default_body_def();
        tobi_fluid_def water = tobi_default_fluid_def();
        tobi_fill_def fill = tobi_default_fill_def();
        tobi_world *world;
        tobi_motion *m;
        int told = 0;
        w.dimension = 2;
        w.domain_max[0] = w.domain_max[1] = 1;
        w.gravity[1] = -9.81;
        w.gravity[2] = 0;
        w.spacing = 0.05;
        w.end_time = 1;
        OK(tobi_motion_translation(ways[k], &m, &err));
        OK(tobi_world_create(&w, NULL, &world, &err));
        fill.box_min[0] = 0.5;
        fill.box_max[0] = 1;
        fill.box_max[1] = 0.5;
        OK(tobi_world_add_fluid(world, &water, &fill, 1, &err));
        b.name = "piston";
        b.box_min[0] = 0.1;
        b.box_max[0] = 0.5;
        b.box_max[1] = 0.9;
        b.motion = tobi_motion_positions;
        b.motion_user = m;
        b.motion_rigid = 1;
        OK(tobi_world_add_body(world, &b, &err));
        OK(tobi_world_start(world, &err));
        for (int n = 0; tobi_world_note(world, n); n++)
            told += !!strstr(tobi_world_note(world, n), "the stroke of 'piston' is beyond the tank: "
                              "at t = 0.505");
        assert_int_equal(told, k == 0);
        tobi_world_destroy(world);
        tobi_motion_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lengths_follow_the_dispersion_relation),
        cmocka_unit_test(heights_per_stroke_are_biesels),
        cmocka_unit_test(regular_waves_have_their_stroke),
        cmocka_unit_test(solitary_waves_have_gorings_stroke),
        cmocka_unit_test(irregular_waves_have_their_height),
        cmocka_unit_test(crests_of_a_group_meet),
        cmocka_unit_test(recorded_levels_come_again),
        cmocka_unit_test(flaps_turn_about_their_hinge),
        cmocka_unit_test(strokes_fit_into_the_tank),
        cmocka_unit_test(other_strokes_are_noted),
        cmocka_unit_test(what_cannot_be_is_refused),
        cmocka_unit_test(groups_that_cannot_be_are_refused),
        cmocka_unit_test(records_that_cannot_be_are_refused),
        cmocka_unit_test(records_have_many_columns),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

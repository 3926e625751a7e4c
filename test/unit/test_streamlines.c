/* Streamlines against flows whose stream function is known: it must be constant along each line. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "view/streamlines.h"

enum { SIDE = 80, DEEP = 24, MOST = SIDE*SIDE*4 };
static double position[MOST][3], flow[MOST][3];
static uint8_t opaque[MOST];
static const double spacing = 1.0/SIDE;

typedef int (*flow_fn)(const double x[3], double v[3]);      /* 0: no water there */

static int turn(const double x[3], double v[3])
{
    v[0] = -(x[1] - 0.5), v[1] = x[0] - 0.5, v[2] = 0;
    return 1;
}

/* Around a stagnation point in the middle of the lower side. */
static int part(const double x[3], double v[3])
{
    v[0] = x[0] - 0.5, v[1] = -x[1], v[2] = 0;
    return 1;
}

/* Past a cylinder of radius 0.15 (potential flow; Lamb, Hydrodynamics, 68). */
static int pass(const double x[3], double v[3])
{
    const double a2 = 0.15*0.15, px = x[0] - 0.5, py = x[1] - 0.5, r2 = px*px + py*py;
    v[0] = 1 - a2*(px*px - py*py)/(r2*r2), v[1] = -2*a2*px*py/(r2*r2), v[2] = 0;
    return r2 > a2;
}

static double turn_function(const double x[3]) { return hypot(x[0] - 0.5, x[1] - 0.5); }
static double part_function(const double x[3]) { return (x[0] - 0.5)*x[1]; }

static double pass_function(const double x[3])
{
    const double px = x[0] - 0.5, py = x[1] - 0.5;
    return py*(1 - 0.15*0.15/(px*px + py*py));
}

/* A square, or a plate of four layers with a flow across it, too. */
static tobi_picture make_frame(flow_fn fn, int dimension)
{
    tobi_picture f = tobi_default_picture();
    f.dimension = dimension;
    f.radius = 0.5*spacing;
    f.positions = (const double (*)[3])position, f.flow = (const double (*)[3])flow, f.opaque = opaque;
    f.streamlines = 20;
    memset(opaque, 0, sizeof opaque);
    for (int a = 0; a < 3; a++) f.box_max[a] = a < dimension ? 1 : 0;
    for (int k = 0; k < (dimension == 3 ? 4 : 1); k++)
        for (int n = 0; n < SIDE*SIDE; n++) {
            const int64_t i = f.particle_count;
            const double x[3] = { (n%SIDE + 0.5)*spacing, (n/SIDE + 0.5)*spacing,
                                  dimension == 3 ? 0.5 + (k - 1.5)*spacing : 0 };
            if (!fn(x, flow[i])) continue;
            memcpy(position[i], x, sizeof x);
            if (dimension == 3) flow[i][2] = 0.7;
            f.particle_count++;
        }
    return f;
}

/* The largest change of the stream function along a line; every step goes with the flow. */
static double judge(const tobi_picture *f, const stream_lines *s, flow_fn fn,
                    double (*function)(const double *), int *closed)
{
    double worst = 0;
    *closed = 0;
    for (int n = 0; n < s->lines; n++) {
        double low = INFINITY, high = -INFINITY;
        const int64_t first = s->first[n], last = s->first[n + 1] - 1;
        for (int64_t k = first; k <= last; k++) {
            const double *x = s->point[k], value = function(x);
            double v[3], with = 0;
            low = fmin(low, value), high = fmax(high, value);
            fn(x, v);
            for (int a = 0; a < 2 && k < last; a++) with += v[a]*(s->point[k + 1][a] - x[a]);
            assert_true(k == last || with > 0);
            if (f->dimension == 3) assert_true(fabs(x[2] - 0.5) < 1e-12);
        }
        worst = fmax(worst, high - low);
        *closed += memcmp(s->point[first], s->point[last], sizeof *s->point) == 0;
    }
    return worst;
}

/* Lines keep half of the distance that seeds have; each place of the water has one within twice of it. */
static void judge_distances(const tobi_picture *f, const stream_lines *s, double apart)
{
    for (int n = 0; n < s->lines; n++)
        for (int64_t k = s->first[n]; k < s->first[n + 1]; k += 3)
            for (int64_t j = 0; j < s->count; j += 3) {
                if (j >= s->first[n] && j < s->first[n + 1]) continue;
                const double *x = s->point[k], *y = s->point[j];
                assert_true(hypot(x[0] - y[0], x[1] - y[1]) > 0.5*apart - 1e-12);
            }
    for (int64_t i = 0; i < f->particle_count; i += 7) {
        double nearest = INFINITY;
        const double *x = f->positions[i];
        for (int64_t j = 0; j < s->count; j++)
            nearest = fmin(nearest, hypot(x[0] - s->point[j][0], x[1] - s->point[j][1]));
        if (!(nearest < 2*apart)) fail_msg("no line near %g %g", x[0], x[1]);
    }
}

static void test_known_flows(void **state)
{
    (void)state;
    static const struct {
        flow_fn fn;
        double (*function)(const double *), most;
        const char *name;
    } cases[] = {
        { turn, turn_function, 0.0005, "rotation" }, { part, part_function, 0.002, "stagnation point" },
        { pass, pass_function, 0.004, "cylinder" } };
    for (int k = 0; k < 3; k++)
        for (int dimension = 2; dimension <= 3; dimension++) {
            int closed;
            stream_lines s;
            tobi_picture f = make_frame(cases[k].fn, dimension);
            f.clip = dimension == 3;
            f.clip_normal[2] = -2, f.clip_point[2] = 0.5;
            assert_true(view_trace_streamlines(&f, &s));
            const double worst = judge(&f, &s, cases[k].fn, cases[k].function, &closed);
            print_message("%s, %d-D: %d lines, %d closed, stream function within %.2g\n", cases[k].name,
                          dimension, s.lines, closed, worst);
            assert_true(s.lines >= 8 && s.lines < 60);
            assert_true(worst < cases[k].most);
            assert_true(k > 0 ? closed == 0 : closed >= 5);
            judge_distances(&f, &s, 1.0/f.streamlines);
            view_free_streamlines(&s);
        }
}

/* What is at rest, solid, or not there has none. */
static void test_none(void **state)
{
    (void)state;
    stream_lines s;
    tobi_picture f = make_frame(turn, 2);
    memset(opaque, 1, sizeof opaque);
    assert_true(view_trace_streamlines(&f, &s));
    assert_int_equal(s.lines, 0);
    view_free_streamlines(&s);
    f = make_frame(turn, 2);
    memset(flow, 0, sizeof flow);
    assert_true(view_trace_streamlines(&f, &s));
    assert_int_equal(s.lines, 0);
    view_free_streamlines(&s);
    f.particle_count = 0;
    assert_true(view_trace_streamlines(&f, &s));
    assert_int_equal(s.lines, 0);
    view_free_streamlines(&s);
    f = make_frame(turn, 2);
    for (int i = 0; i < f.particle_count; i += 3) position[i][i%2] = i%5 ? NAN : 1e300;
    assert_true(view_trace_streamlines(&f, &s));
    view_free_streamlines(&s);
}

static void test_pictures(void **state)
{
    (void)state;
    enum { W = 160, H = 120 };
    static uint8_t without[W*H*3], with[W*H*3];
    tobi_error err = { 0 };
    tobi_picture f = make_frame(turn, 2);
    f.width = W, f.height = H;
    f.streamlines = 201;
    assert_int_equal(tobi_picture_draw(&f, with, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "201 streamlines, allowed are 0 to 200"));
    f.streamlines = 0;
    assert_int_equal(tobi_picture_draw(&f, without, &err), TOBI_OK);
    f.streamlines = 10;
    assert_int_equal(tobi_picture_draw(&f, with, &err), TOBI_OK);
    int changed = 0;
    for (int k = 0; k < W*H; k++) changed += memcmp(with + 3*k, without + 3*k, 3) != 0;
    print_message("%d of %d pixels are in a line\n", changed, W*H);
    assert_true(changed > 500 && changed < W*H/3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_flows), cmocka_unit_test(test_none), cmocka_unit_test(test_pictures),
    };
    return cmocka_run_group_tests_name("view/streamlines", tests, NULL, NULL);
}

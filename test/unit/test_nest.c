/* Nests: rest stays rest, as much liquid comes in as in the outer world, an accelerated liquid and a body
   that goes along are the same in both; what is refused. */
#include "calls.h"
#include "tobiuo/tobiuo.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const methods[] = { "isph", "dfsph" };
enum { METHODS = sizeof methods/sizeof *methods };

/* A 2-D world of `wide` by `high`, m, with water in its lower left, up to `width` and `height`, that has a
   speed along x. Gravity acts along x in a world that is periodic there, else along y. */
typedef struct pool { double wide, high, width, height, gravity, speed, viscosity; int periodic; } pool;

static tobi_world *make_pool(const pool *p, const char *method, double spacing)
{
    tobi_world_def d = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *w = NULL;
    d.method = method;
    d.dimension = 2;
    d.spacing = spacing;
    d.threads = 1;
    if (p->periodic) d.wall_min[0] = d.wall_max[0] = TOBI_WALL_PERIODIC;
    d.gravity[0] = p->periodic ? p->gravity : 0;
    d.gravity[1] = p->periodic ? 0 : -p->gravity;
    d.gravity[2] = d.domain_max[2] = fill.box_max[2] = 0;
    d.domain_max[0] = p->wide;
    d.domain_max[1] = p->high;
    fill.box_max[0] = p->width;
    fill.box_max[1] = p->height;
    fill.velocity[0] = p->speed;
    fluid.viscosity = p->viscosity;
    OK(tobi_world_create(&d, NULL, &w, &err));
    OK(tobi_world_add_fluid(w, &fluid, &fill, 1, &err));
    return w;
}

static tobi_world *make_tank(const char *method, double spacing, double width, double height)
{
    const pool p = { 1, 0.6, width, height, 9.81, 0, 1e-3, 0 };
    return make_pool(&p, method, spacing);
}

static tobi_nest_def make_box(double left, double bottom, double right, double top)
{
    tobi_nest_def n = tobi_default_nest_def();
    n.name = "near";
    n.box_min[0] = left;
    n.box_min[1] = bottom;
    n.box_max[0] = right;
    n.box_max[1] = top;
    return n;
}

static void add_probe(tobi_world *w, double x, double y)
{
    tobi_probe_def probe = tobi_default_probe_def();
    probe.name = "probe";
    probe.position[0] = x;
    probe.position[1] = y;
    OK(tobi_world_add_probe(w, &probe, &err));
}

/* Both to time t, s. */
static void advance(tobi_world *outer, tobi_world *nest, double t)
{
    while (tobi_world_time(outer) < t - 1e-12) {
        OK(tobi_world_step(outer, t - tobi_world_time(outer), NULL, &err));
        OK(tobi_world_advance(nest, tobi_world_time(outer), NULL, &err));
        OK(tobi_world_feed(nest, &err));
    }
}

/* Below the surface and across it. Bounds by first runs: isph 1e-3 m/s, dfsph 6e-3 m/s as without a nest. */
static void rest_stays_rest(void **state)
{
    static const double most[METHODS] = { 2e-3, 2e-2 };
    (void)state;
    for (int m = 0; m < METHODS; m++)
        for (int feedback = 0; feedback < 2; feedback++)
            for (int below = 0; below < 2; below++) {
                tobi_world *outer = make_tank(methods[m], 0.02, 1, 0.4);
                tobi_world *nest = make_tank(methods[m], 0.01, 1, 0.4);
                tobi_nest_def n = below ? make_box(0.3, 0.14, 0.7, 0.26) : make_box(0.3, 0, 0.7, 0.6);
                tobi_probe_info info;
                n.feedback = feedback;
                add_probe(nest, 0.5, 0.2);
                OK(tobi_world_nest(nest, outer, &n, &err));
                advance(outer, nest, 0.3);
                OK(tobi_world_probe(nest, 0, &info, &err));
                const double speed = tobi_world_info(nest)->speed_max;
                if (!(speed < most[m]) || fabs(info.pressure - 1962) > 0.01*1962)
                    fail_msg("%s, below %d: %g m/s, %g Pa", methods[m], below, speed, info.pressure);
                tobi_world_destroy(nest);
                tobi_world_destroy(outer);
            }
}

/* A gauge stands on the box where that ends above the floor; below the surface it reads the rim's top. */
static void a_gauge_stands_on_the_box(void **state)
{
    (void)state;
    for (int below = 0; below < 2; below++) {
        tobi_world *outer = make_tank("isph", 0.02, 1, 0.4), *nest = make_tank("isph", 0.01, 1, 0.4);
        const tobi_nest_def n = make_box(0.3, 0.2, 0.7, below ? 0.3 : 0.6);
        tobi_probe_def gauge = tobi_default_probe_def();
        tobi_probe_info info;
        gauge.name = "gauge";
        gauge.kind = TOBI_PROBE_LEVEL;
        gauge.position[0] = 0.5;
        gauge.position[1] = 0.1;
        OK(tobi_world_add_probe(nest, &gauge, &err));
        OK(tobi_world_nest(nest, outer, &n, &err));
        advance(outer, nest, 0.01);
        OK(tobi_world_probe(nest, 0, &info, &err));
        const double top = below ? 0.3 + nest->sim.nest.rim : 0.4;
        if (fabs(info.level - top) > 0.01) fail_msg("a level of %g m, %g m is right", info.level, top);
        tobi_world_destroy(nest);
        tobi_world_destroy(outer);
    }
}

/* Where layers do not fit, both take another spacing, and the ratio stays. */
static void spacings_give_way_together(void **state)
{
    (void)state;
    tobi_world *outer = make_tank("isph", 0.03, 1, 0.4), *nest = make_tank("isph", 0.015, 1, 0.4);
    const tobi_nest_def n = make_box(0.3, 0, 0.7, 0.6);
    OK(tobi_world_nest(nest, outer, &n, &err));
    OK(tobi_world_start(outer, &err));
    OK(tobi_world_start(nest, &err));
    const double taken = outer->system[0].smoothing.spacing;
    assert_true(fabs(taken - 0.03) > 1e-5);
    assert_true(fabs(2*nest->system[0].smoothing.spacing/taken - 1) < 1e-12);
    tobi_world_destroy(nest);
    tobi_world_destroy(outer);
}

/* m2 of liquid to the right of x, m. */
static double measure_beyond(const tobi_world *w, double x)
{
    const tobi_system *s = &w->system[0];
    double sum = 0;
    for (int64_t i = 0; i < s->particles.count; i++)
        sum += s->particles.position[i].x > x ? s->smoothing.spacing*s->smoothing.spacing : 0;
    return sum;
}

/* A dam breaks towards the right wall, where a nest begins dry. Within 5 %: a row of particles more or
   less. */
static void as_much_comes_in(void **state)
{
    (void)state;
    for (int m = 0; m < METHODS; m++) {
        tobi_world *outer = make_tank(methods[m], 0.02, 0.4, 0.4);
        tobi_world *nest = make_tank(methods[m], 0.01, 0.4, 0.4);
        const tobi_nest_def n = make_box(0.7, 0, 1, 0.6);
        OK(tobi_world_nest(nest, outer, &n, &err));
        OK(tobi_world_start(nest, &err));
        assert_int_equal(tobi_world_count(nest, TOBI_FLUID), 0);
        advance(outer, nest, 0.5);
        const double all = measure_beyond(outer, 0.7), fine = measure_beyond(nest, 0.7);
        if (!(all > 0.02) || fabs(fine/all - 1) > 0.05)
            fail_msg("%s: %g m2 in the nest, %g outside", methods[m], fine, all);
        tobi_world_destroy(nest);
        tobi_world_destroy(outer);
    }
}

/* Liquid that fills a periodic channel falls freely along it: the rim must be as fast as the box at each
   time, or one would push the other. */
static tobi_world *make_fall(const char *method, double spacing)
{
    const pool p = { 1, 0.4, 1, 0.3, 5, 0, tobi_default_fluid_def().viscosity, 1 };
    return make_pool(&p, method, spacing);
}

static void liquid_that_gains_speed_is_not_pushed(void **state)
{
    (void)state;
    for (int m = 0; m < METHODS; m++) {
        tobi_world *outer = make_fall(methods[m], 0.02), *nest = make_fall(methods[m], 0.01);
        const tobi_nest_def n = make_box(0.3, 0, 0.7, 0.4);
        OK(tobi_world_nest(nest, outer, &n, &err));
        advance(outer, nest, 0.2);
        const tobi_system *s = &nest->system[0];
        double most = 0;
        for (int64_t i = 0; i < s->particles.count; i++) {
            most = fmax(most, fabs(s->particles.velocity[i].x - 1.0));
            most = fmax(most, fabs(s->particles.velocity[i].y));
        }
        if (!(most < 0.02)) fail_msg("%s: %g m/s beside the fall", methods[m], most);
        assert_true(fabs(measure_beyond(nest, 0.3) - measure_beyond(nest, 0.7) - 0.12) < 0.004);
        tobi_world_destroy(nest);
        tobi_world_destroy(outer);
    }
}

static tobi_status glide(void *user, double t, int64_t n, const double (*rest)[3], double (*position)[3],
                         tobi_error *err)
{
    (void)user;
    (void)err;
    for (int64_t k = 0; k < n; k++) {
        memcpy(position[k], rest[k], sizeof position[k]);
        position[k][0] += 0.5*t*t;
    }
    return TOBI_OK;
}

/* 0.1 m wide, by its lower left corner. */
static tobi_body_def make_square(double left, double bottom)
{
    tobi_body_def b = tobi_default_body_def();
    b.name = "square";
    b.box_min[0] = left;
    b.box_max[0] = left + 0.1;
    b.box_min[1] = bottom;
    b.box_max[1] = bottom + 0.1;
    return b;
}

static void add_square(tobi_world *w, int free)
{
    tobi_body_def b = make_square(0.25, 0.15);
    b.motion = free ? NULL : glide;
    b.motion_rigid = 1;
    b.density = 600;
    b.dynamics = free ? TOBI_FREE : TOBI_PRESCRIBED;
    OK(tobi_world_add_body(w, &b, &err));
}

/* The box goes along with a body; liquid comes in before it and is left behind it. */
static void a_box_goes_along(void **state)
{
    (void)state;
    tobi_world *outer = make_tank("isph", 0.02, 1, 0.4), *nest = make_tank("isph", 0.01, 1, 0.4);
    tobi_nest_def n = make_box(0.15, 0.05, 0.45, 0.35);
    n.follow = "square";
    add_square(outer, 0);
    add_square(nest, 0);
    OK(tobi_world_nest(nest, outer, &n, &err));
    OK(tobi_world_start(nest, &err));
    const double begin = (double)tobi_world_count(nest, TOBI_FLUID);
    advance(outer, nest, 0.8);
    assert_true(fabs(nest->sim.nest.lower[0] - 0.47) < 2e-3);
    assert_true(fabs((double)tobi_world_count(nest, TOBI_FLUID)/begin - 1) < 0.03);
    double low = 1;
    for (int64_t i = 0; i < nest->system[0].particles.count; i++)
        low = fmin(low, nest->system[0].particles.position[i].x);
    assert_true(low > 0.47 - nest->sim.nest.rim - 0.011);
    tobi_world_destroy(nest);
    tobi_world_destroy(outer);
}

/* A body that the outer world moves by forces is where that has it. */
static void a_body_goes_as_outside(void **state)
{
    (void)state;
    tobi_world *outer = make_tank("isph", 0.02, 1, 0.4), *nest = make_tank("isph", 0.01, 1, 0.4);
    const tobi_nest_def n = make_box(0.1, 0, 0.6, 0.6);
    tobi_nest_body at = { outer, 0 };
    tobi_body_def b = make_square(0.25, 0.15);
    tobi_body_info coarse, fine;
    add_square(outer, 1);
    b.motion = tobi_nest_motion;
    b.motion_user = &at;
    b.motion_rigid = 1;
    OK(tobi_world_add_body(nest, &b, &err));
    OK(tobi_world_nest(nest, outer, &n, &err));
    advance(outer, nest, 0.3);
    assert_int_equal(tobi_world_body(outer, 0, &coarse), TOBI_OK);
    assert_int_equal(tobi_world_body(nest, 0, &fine), TOBI_OK);
    for (int a = 0; a < 2; a++) assert_true(fabs(coarse.position[a] - fine.position[a]) < 1e-9);
    assert_true(coarse.position[1] > 0.21);
    tobi_world_destroy(nest);
    tobi_world_destroy(outer);
}

/* A full periodic channel that flows past a square, with a sensor in its wake. */
static tobi_world *make_wake(double spacing)
{
    const pool p = { 1.2, 0.8, 1.2, 0.8, 0, 0.5, 0.1, 1 };
    tobi_world *w = make_pool(&p, "isph", spacing);
    const tobi_body_def b = make_square(0.4, 0.35);
    OK(tobi_world_add_body(w, &b, &err));
    add_probe(w, 0.55, 0.4);
    return w;
}

/* Where pressure is below 0 and there is no free surface, no void opens; the sensor reads what it reads
   outside, within a quarter of rho U^2: bounds by first runs. */
static void suction_opens_no_void(void **state)
{
    (void)state;
    tobi_world *outer = make_wake(0.025), *nest = make_wake(0.0125);
    const tobi_nest_def n = make_box(0.25, 0.2, 0.8, 0.6);
    tobi_probe_info coarse, fine;
    OK(tobi_world_nest(nest, outer, &n, &err));
    OK(tobi_world_start(nest, &err));
    const double begin = (double)tobi_world_count(nest, TOBI_FLUID);
    advance(outer, nest, 0.6);
    OK(tobi_world_probe(outer, 0, &coarse, &err));
    OK(tobi_world_probe(nest, 0, &fine, &err));
    const double share = (double)tobi_world_count(nest, TOBI_FLUID)/begin;
    if (!(coarse.pressure < 0) || fabs(coarse.pressure - fine.pressure) > 62 || fabs(share - 1) > 0.03)
        fail_msg("%g Pa outside, %g Pa in the nest, %g particles", coarse.pressure, fine.pressure, share);
    tobi_world_destroy(nest);
    tobi_world_destroy(outer);
}

/* Sums over the outer particles need room for more blocks than those of the nest have; builds with assertions
   look. */
static void a_small_nest_in_a_large_world(void **state)
{
    (void)state;
    const pool p = { 2, 1, 2, 1, 0, 0.5, 0, 1 };
    tobi_world *outer = make_pool(&p, "dfsph", 0.0125), *nest = make_pool(&p, "dfsph", 0.00625);
    const tobi_nest_def n = make_box(0.9, 0.4, 1.0, 0.5);
    OK(tobi_world_nest(nest, outer, &n, &err));
    OK(tobi_world_start(nest, &err));
    assert_true(tobi_world_count(nest, TOBI_FLUID) < 4096);
    OK(tobi_world_start(outer, &err));
    assert_true(tobi_world_count(outer, TOBI_FLUID) > 2*4096);
    advance(outer, nest, 0.005);
    for (int64_t i = 0; i < nest->system[0].particles.count; i++)
        assert_true(fabs(nest->system[0].particles.velocity[i].x - 0.5) < 1e-3);
    tobi_world_destroy(nest);
    tobi_world_destroy(outer);
}

static tobi_status try_nest(tobi_world *nest, tobi_world *outer, tobi_nest_def n, tobi_error *err)
{
    return tobi_world_nest(nest, outer, &n, err);
}

static void what_is_refused(void **state)
{
    (void)state;
    tobi_world *outer = make_tank("isph", 0.02, 1, 0.4), *nest = make_tank("isph", 0.01, 1, 0.4);
    tobi_world *other = make_tank("isph", 0.02/3, 1, 0.4), *way = make_tank("wcsph", 0.02, 1, 0.4);
    tobi_world *periodic = make_fall("isph", 0.02), *in = make_fall("isph", 0.01);
    tobi_world *airy = make_tank("isph", 0.02, 1, 0.4), *below = make_tank("isph", 0.01, 1, 0.4);
    tobi_nest_def n = make_box(0.3, 0, 0.7, 0.6);
    REFUSED(try_nest(nest, outer, make_box(-0.1, 0, 0.7, 0.6), &err), TOBI_INVALID,
            "the box reaches from -0.1 to 0.7 m in x, the domain from 0 to 1 m");
    REFUSED(try_nest(nest, outer, make_box(0.3, 0, 0.7, 0.7), &err), TOBI_INVALID, "in y, the domain");
    REFUSED(try_nest(nest, outer, make_box(0.3, 0, 0.35, 0.6), &err), TOBI_INVALID,
            "the box is 0.05 m long in x; allowed are 4 spacings of the scene, 0.08 m, or more");
    REFUSED(try_nest(in, periodic, make_box(0, 0, 0.5, 0.4), &err), TOBI_INVALID,
            "one of the two periodic sides in x");
    REFUSED(try_nest(other, outer, n, &err), TOBI_INVALID, "2 times smaller than that of the outer world");
    REFUSED(try_nest(nest, way, n, &err), TOBI_UNSUPPORTED, "the method wcsph has no nests");
    REFUSED(try_nest(nest, periodic, n, &err), TOBI_INVALID, "domain, method and fluids must be those");
    OK(try_nest(in, periodic, make_box(0, 0, 1, 0.4), &err));
    tobi_fluid_def air = tobi_default_fluid_def();
    tobi_fill_def high = tobi_default_fill_def();
    air.name = "air";
    air.density = 1.2;
    high.box_min[1] = 0.4;
    high.box_max[0] = 1;
    high.box_max[1] = 0.6;
    OK(tobi_world_add_fluid(airy, &air, &high, 1, &err));
    OK(tobi_world_add_fluid(below, &air, &high, 1, &err));
    REFUSED(try_nest(below, airy, n, &err), TOBI_UNSUPPORTED, "a nest takes fluids up to 1 : 2");
    n.name = "../up";
    REFUSED(try_nest(nest, outer, n, &err), TOBI_INVALID, "allowed are letters, digits, _ and -");
    n.name = "near";
    n.follow = "whale";
    REFUSED(try_nest(nest, outer, n, &err), TOBI_INVALID, "no body 'whale' to follow");
    n.follow = NULL;
    REFUSED(tobi_world_feed(nest, &err), TOBI_INVALID, "no nest");
    OK(tobi_world_nest(nest, outer, &n, &err));
    REFUSED(try_nest(other, nest, n, &err), TOBI_UNSUPPORTED, "is a nest itself");
    tobi_world *more[3];
    for (int k = 0; k < 3; k++) {
        more[k] = make_tank("isph", 0.01, 1, 0.4);
        OK(tobi_world_nest(more[k], outer, &n, &err));
    }
    REFUSED(try_nest(other, outer, n, &err), TOBI_INVALID, "a world has 4 nests or fewer");
    for (int k = 0; k < 3; k++) tobi_world_destroy(more[k]);
    OK(tobi_world_start(other, &err));
    REFUSED(try_nest(other, outer, n, &err), TOBI_INVALID, "a started world becomes no nest");
    tobi_world *free = make_tank("isph", 0.01, 1, 0.4);
    add_square(free, 1);
    REFUSED(try_nest(free, outer, n, &err), TOBI_UNSUPPORTED, "body 'square' moves by forces");
    tobi_world *all[] = { free, nest, outer, other, way, periodic, in, airy, below };
    for (size_t k = 0; k < sizeof all/sizeof *all; k++) tobi_world_destroy(all[k]);
}

/* Openings have buffers of their own world. */
static void openings_stay_outside(void **state)
{
    (void)state;
    tobi_world *outer = make_tank("isph", 0.02, 1, 0.4), *nest = make_tank("isph", 0.01, 1, 0.4);
    tobi_outlet_def o = tobi_default_outlet_def();
    o.name = "drain";
    o.centre[0] = 0.85;
    o.centre[1] = 0.1;
    o.normal[0] = 1;
    o.width = 0.2;
    OK(tobi_world_add_outlet(outer, &o, &err));
    REFUSED(try_nest(nest, outer, make_box(0.3, 0, 0.8, 0.6), &err), TOBI_INVALID,
            "outlet 'drain' may lie in the box");
    OK(try_nest(nest, outer, make_box(0.1, 0, 0.4, 0.6), &err));
    tobi_world *with = make_tank("isph", 0.01, 1, 0.4);
    OK(tobi_world_add_outlet(with, &o, &err));
    REFUSED(try_nest(with, outer, make_box(0.1, 0, 0.4, 0.6), &err), TOBI_UNSUPPORTED,
            "a nest has no inlets and outlets");
    tobi_world_destroy(with);
    tobi_world_destroy(nest);
    tobi_world_destroy(outer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rest_stays_rest), cmocka_unit_test(spacings_give_way_together),
        cmocka_unit_test(as_much_comes_in), cmocka_unit_test(a_gauge_stands_on_the_box),
        cmocka_unit_test(liquid_that_gains_speed_is_not_pushed), cmocka_unit_test(a_box_goes_along),
        cmocka_unit_test(a_body_goes_as_outside), cmocka_unit_test(what_is_refused),
        cmocka_unit_test(openings_stay_outside), cmocka_unit_test(suction_opens_no_void),
        cmocka_unit_test(a_small_nest_in_a_large_world)
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Sensors against exact values: still water, uniform flow, a turning rectangle, filters; what is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "calls.h"
#include "tobiuo/tobiuo.h"
#include "tobiuo/scene.h"
#include "record/record.h"

#define D 0.01      /* spacing, m */

static const double pi = 3.14159265358979323846;

/* Water from 0 to x, y and `depth` in a box 0.2 wide and high. */
static tobi_world *make_tank(int dimension, double gravity, double depth, const char *method)
{
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    w.method = method;
    w.dimension = dimension;
    w.spacing = D;
    w.domain_max[0] = w.domain_max[1] = 0.2;
    w.domain_max[2] = dimension == 3 ? 0.2 : 0;
    for (int a = 0; a < 3; a++) w.gravity[a] = a == dimension - 1 ? gravity : 0;
    OK(tobi_world_create(&w, NULL, &world, &err));
    tobi_fluid_def f = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    fill.box_max[0] = fill.box_max[1] = 0.2;
    fill.box_max[2] = dimension == 3 ? depth : 0;
    if (dimension == 2) fill.box_max[1] = depth;
    OK(tobi_world_add_fluid(world, &f, &fill, 1, &err));
    return world;
}

static tobi_probe_def make(const char *name, int kind, double x, double y, double z)
{
    tobi_probe_def p = tobi_default_probe_def();
    p.name = name;
    p.kind = kind;
    p.position[0] = x, p.position[1] = y, p.position[2] = z;
    return p;
}

static void set_sizes(tobi_probe_def *p, double length, double width, double height)
{
    p->length = length, p->width = width, p->height = height;
}

static void set_vector(double v[3], double x, double y, double z) { v[0] = x, v[1] = y, v[2] = z; }

static tobi_probe_info measure(tobi_world *world, const tobi_probe_def *p)
{
    tobi_probe_info info;
    OK(tobi_world_add_probe(world, p, &err));
    OK(tobi_world_probe(world, tobi_world_probe_count(world) - 1, &info, &err));
    return info;
}

/* A field of the particles as a function of their place; velocity has three components. */
static void set_field(tobi_world *world, const char *name, int components,
                      void (*field)(const double x[3], double *value))
{
    const int64_t n = tobi_world_count(world, TOBI_FLUID);
    double (*x)[3] = malloc((size_t)n*sizeof *x), *v = malloc((size_t)(n*components)*sizeof *v);
    OK(tobi_world_read(world, TOBI_FLUID, "position", &x[0][0], n, &err));
    for (int64_t i = 0; i < n; i++) field(x[i], v + i*components);
    OK(tobi_world_write(world, name, v, n, &err));
    free(x);
    free(v);
}

static void assert_close(double got, double wanted, double within, const char *what)
{
    if (!(fabs(got - wanted) <= within)) fail_msg("%s is %.9g, not %.9g within %g", what, got, wanted,
                                                  within);
}

static void at_rest(const double x[3], double *p) { *p = 9810*(0.1 - x[2]); }
static void towards_the_block(const double x[3], double *v) { (void)x, v[0] = -1, v[1] = v[2] = 0; }
static void uniform(const double x[3], double *v) { (void)x, v[0] = 0.5, v[1] = 0.25, v[2] = -1; }

/* A rectangle in the water, away from walls: the fit of a linear pressure is exact. */
static void a_patch_in_still_water(void **state)
{
    (void)state;
    tobi_world *world = make_tank(3, -9.81, 0.1, "dfsph");
    OK(tobi_world_start(world, &err));
    set_field(world, "pressure", 1, at_rest);
    tobi_probe_def p = make("p", TOBI_PROBE_PATCH, 0.103, 0.098, 0.05);
    set_vector(p.normal, -2, 0, 0);
    set_vector(p.along, 0, 0, 1);
    set_sizes(&p, 0.04, 0.06, 0);
    const tobi_probe_info info = measure(world, &p);
    const double area = 0.04*0.06, mean = 9810*0.05;
    assert_close(info.pressure, mean, 1e-3*mean, "pressure");
    assert_close(info.force[0], mean*area, 1e-3*mean*area, "force x");
    assert_close(info.force[1], 0, 1e-9, "force y");
    /* four rows of places: b h^3/12 less what lies within a row */
    assert_close(info.moment[1], -9810*0.06*pow(0.04, 3)/12*(1 - 1.0/16), 1e-5, "moment y");
    tobi_world_destroy(world);
}

/* On a wall, as the solved pressure has it; each method by its own walls. */
static void a_patch_on_a_wall(void **state)
{
    (void)state;
    static const char *const methods[] = { "dfsph", "isph", "eisph", "wcsph" };
    for (int k = 0; k < 4; k++) {
        tobi_world *world = make_tank(3, -9.81, 0.1, methods[k]);
        OK(tobi_world_start(world, &err));
        for (int n = 0; n < 20; n++) OK(tobi_world_step(world, 1, NULL, &err));
        tobi_probe_def p = make("wall", TOBI_PROBE_PATCH, 0.2, 0.1, 0.05);
        set_vector(p.normal, -1, 0, 0);
        set_sizes(&p, 0.1, 0.06, 0);
        const tobi_probe_info info = measure(world, &p);
        assert_close(info.pressure, 9810*0.05, 0.2*9810*0.05, methods[k]);
        assert_close(info.force[0], info.pressure*0.006, 1e-9, "force on the wall");
        p = make("floor", TOBI_PROBE_PATCH, 0.1, 0.1, 0);
        set_sizes(&p, 0.1, 0.1, 0);
        const tobi_probe_info floor = measure(world, &p);
        assert_close(floor.force[2], -9810*0.1*0.01, 0.1*9.81, methods[k]);
        tobi_world_destroy(world);
    }
}

static void uniform_flow_is_exact(void **state)
{
    (void)state;
    tobi_world *world = make_tank(3, 0, 0.1, "wcsph");
    OK(tobi_world_start(world, &err));
    set_field(world, "velocity", 3, uniform);
    tobi_probe_def p = make("through", TOBI_PROBE_FLOW, 0.1, 0.1, 0.05);
    set_vector(p.normal, 1, 0, 0);
    set_sizes(&p, 0.2, 0.1, 0);                       /* all of the channel: along is y */
    assert_close(measure(world, &p).flow, 0.5*0.02, 1e-9, "whole channel");
    p = make("part", TOBI_PROBE_FLOW, 0.1037, 0.0911, 0.0473);
    set_vector(p.normal, 0, 0, -3);
    set_sizes(&p, 0.0531, 0.0377, 0);                 /* at no multiple of a spacing */
    assert_close(measure(world, &p).flow, 1*0.0531*0.0377, 1e-9, "part of it");
    p = make("air", TOBI_PROBE_FLOW, 0.1, 0.1, 0.18);
    set_sizes(&p, 0.1, 0.1, 0);
    assert_close(measure(world, &p).flow, 0, 0, "air");
    tobi_world_destroy(world);
}

static void volumes_are_exact(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        const int flat = dimension == 2;
        tobi_world *world = make_tank(dimension, -9.81, 0.1, "dfsph");
        OK(tobi_world_start(world, &err));
        tobi_probe_def p = make("all", TOBI_PROBE_VOLUME, 0.1, 0.1, flat ? 0 : 0.1);
        set_sizes(&p, 0.2, 0.2, 0.2);
        assert_close(measure(world, &p).volume, flat ? 0.02 : 0.004, 1e-12, "all");
        p = make("part", TOBI_PROBE_VOLUME, 0.0713, flat ? 0.09 : 0.1, flat ? 0 : 0.09);
        set_sizes(&p, 0.0431, 0.0619, 0.06);          /* half above the surface: 0.04 under it */
        assert_close(measure(world, &p).volume, 0.0431*0.04*(flat ? 1 : 0.0619), 1e-9, "part");
        tobi_world_destroy(world);
    }
}

/* Water that is thrown at the sides and at a block comes nearer to them than half a spacing: a box that ends
   there holds all of it still. */
static void a_volume_ends_at_walls(void **state)
{
    (void)state;
    tobi_world *world = make_tank(2, -9.81, 0.1, "dfsph");
    tobi_body_def b = tobi_default_body_def();
    b.name = "block";
    set_vector(b.box_max, 0.05, 0.2, 0);
    OK(tobi_world_add_body(world, &b, &err));
    OK(tobi_world_start(world, &err));
    set_field(world, "velocity", 3, towards_the_block);
    tobi_probe_def p = make("all", TOBI_PROBE_VOLUME, 0.125, 0.1, 0);
    set_sizes(&p, 0.15, 0, 0.2);
    const double whole = measure(world, &p).volume;
    assert_close(whole, 0.15*0.1, 1e-12, "at the start");
    p.name = "again";
    OK(tobi_world_advance(world, 0.08, NULL, &err));
    assert_close(measure(world, &p).volume, whole, 1e-6*whole, "after it was thrown about");
    tobi_world_destroy(world);
}

/* A rectangle on a body that turns in water at rest: minus (omega x r) n times its area. */
static void turn_about(double t, double angle[1]) { *angle = 2*t; }

static tobi_status spin(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                        tobi_error *err)
{
    double a;
    (void)user, (void)err;
    turn_about(t, &a);
    for (int64_t i = 0; i < n; i++) {
        const double x = rest[i][0] - 0.1, y = rest[i][1] - 0.1;
        out[i][0] = 0.1 + cos(a)*x - sin(a)*y;
        out[i][1] = 0.1 + sin(a)*x + cos(a)*y;
        out[i][2] = rest[i][2];
    }
    return TOBI_OK;
}

static void a_turning_rectangle(void **state)
{
    (void)state;
    tobi_world *world = make_tank(3, 0, 0.1, "wcsph");
    tobi_body_def b = tobi_default_body_def();
    b.name = "arm";
    set_vector(b.box_min, 0.09, 0.09, 0.15);          /* above the water */
    set_vector(b.box_max, 0.11, 0.11, 0.17);
    b.motion = spin;
    b.motion_rigid = 1;
    OK(tobi_world_add_body(world, &b, &err));
    OK(tobi_world_start(world, &err));
    OK(tobi_world_step(world, 1e-5, NULL, &err));
    tobi_probe_def p = make("sweep", TOBI_PROBE_FLOW, 0.15, 0.1, 0.05);
    set_vector(p.normal, 0, 1, 0);
    set_sizes(&p, 0.04, 0.04, 0);
    p.body = "arm";
    const tobi_probe_info info = measure(world, &p);
    assert_close(info.flow, -2*0.05*0.04*0.04, 2e-3*2*0.05*0.0016, "flow of the turn");
    tobi_world_destroy(world);
}

/* A point that rides on the body sees another place. */
static void a_point_rides_on_a_body(void **state)
{
    (void)state;
    tobi_world *world = make_tank(3, 0, 0.1, "wcsph");
    tobi_body_def b = tobi_default_body_def();
    b.name = "arm";
    set_vector(b.box_min, 0.09, 0.09, 0.15);
    set_vector(b.box_max, 0.11, 0.11, 0.17);
    b.motion = spin;
    b.motion_rigid = 1;
    OK(tobi_world_add_body(world, &b, &err));
    OK(tobi_world_start(world, &err));
    tobi_probe_def p = make("rides", TOBI_PROBE_VOLUME, 0.15, 0.1, 0.05), q = p;
    set_sizes(&p, 0.02, 0.02, 0.02);
    p.body = "arm";
    while (tobi_world_time(world) < 0.1) OK(tobi_world_step(world, 0.1 - tobi_world_time(world), NULL, &err));
    set_field(world, "pressure", 1, at_rest);
    assert_close(measure(world, &p).volume, 8e-6, 4e-7, "a turned box in the water");
    q = make("out", TOBI_PROBE_VOLUME, 0.1, 0.1, 0.1);      /* a quarter turn brings none of it out */
    set_sizes(&q, 0.02, 0.02, 0.04);
    q.body = "arm";
    assert_close(measure(world, &q).volume, 8e-6, 4e-7, "half of a box");
    tobi_world_destroy(world);
}

/* Levels: on the lattice, with a drop and a sheet above, and over a body. */
static void levels_of_the_main_body_of_water(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        const int flat = dimension == 2;
        tobi_world *world = make_tank(dimension, -9.81, 0.1, "dfsph");
        tobi_fluid_def f = tobi_default_fluid_def();
        tobi_fill_def fill[2] = { tobi_default_fill_def(), tobi_default_fill_def() };
        f.name = "spray";
        fill[0].radius = 0.015;
        set_vector(fill[0].centre, 0.1, flat ? 0.14 : 0.1, flat ? 0 : 0.14);
        set_vector(fill[1].box_min, 0, flat ? 0.17 : 0, flat ? 0 : 0.17);
        set_vector(fill[1].box_max, 0.2, flat ? 0.18 : 0.2, flat ? 0 : 0.18);
        OK(tobi_world_add_fluid(world, &f, fill, 2, &err));
        OK(tobi_world_start(world, &err));
        static const char *const names[] = { "a", "b", "c", "d", "e" };
        const double x[] = { 0.1, 0.1037, 0.05, 0, 0.2 };
        for (int k = 0; k < 5; k++) {
            const tobi_probe_def p = make(names[k], TOBI_PROBE_LEVEL, x[k], flat ? 0 : 0.1, 0);
            assert_close(measure(world, &p).level, 0.1, 0.05*D, "level");
        }
        tobi_world_destroy(world);
    }
}

static void a_dry_floor_and_a_block(void **state)
{
    (void)state;
    tobi_world *world = make_tank(3, -9.81, 0.1, "dfsph");
    tobi_body_def b = tobi_default_body_def();
    b.name = "block";
    set_vector(b.box_min, 0, 0, 0);
    set_vector(b.box_max, 0.06, 0.2, 0.04);           /* under water, on the floor */
    OK(tobi_world_add_body(world, &b, &err));
    b.name = "shelf";
    set_vector(b.box_min, 0.14, 0, 0.04);
    set_vector(b.box_max, 0.2, 0.2, 0.07);            /* water below and above it */
    OK(tobi_world_add_body(world, &b, &err));
    b.name = "island";
    set_vector(b.box_min, 0.08, 0.08, 0);
    set_vector(b.box_max, 0.12, 0.12, 0.15);          /* out of the water */
    OK(tobi_world_add_body(world, &b, &err));
    OK(tobi_world_start(world, &err));
    tobi_probe_def p = make("block", TOBI_PROBE_LEVEL, 0.03, 0.1, 0);
    assert_close(measure(world, &p).level, 0.1, 0.1*D, "over the block");
    p = make("shelf", TOBI_PROBE_LEVEL, 0.17, 0.1, 0);
    assert_close(measure(world, &p).level, 0.1, 0.1*D, "over the shelf");
    p = make("island", TOBI_PROBE_LEVEL, 0.1, 0.1, 0);
    assert_close(measure(world, &p).level, 0.15, 0.5*D, "the dry island");
    tobi_world_destroy(world);

    world = make_tank(3, -9.81, 0.1, "dfsph");
    b.name = "hill";
    set_vector(b.box_min, 0, 0, 0);
    set_vector(b.box_max, 0.12, 0.2, 0.15);           /* its middle is further in than the kernel reaches */
    OK(tobi_world_add_body(world, &b, &err));
    OK(tobi_world_start(world, &err));
    p = make("hill", TOBI_PROBE_LEVEL, 0.04, 0.1, 0);
    assert_close(measure(world, &p).level, 0.15, 0.5*D, "the dry hill");
    tobi_world_destroy(world);
}

static void a_run_up_ends_at_the_surface(void **state)
{
    (void)state;
    tobi_world *world = make_tank(3, -9.81, 0.1, "dfsph");
    OK(tobi_world_start(world, &err));
    tobi_probe_def p = make("slope", TOBI_PROBE_RUN_UP, 0.05, 0.1, 0.05);
    set_vector(p.end, 0.15, 0.1, 0.15);
    const tobi_probe_info info = measure(world, &p);
    assert_close(info.run_up, 0.1, 0.05*D, "run-up");
    assert_close(info.distance, 0.05*sqrt(2), 0.05*sqrt(2)*D, "distance");
    p = make("dry", TOBI_PROBE_RUN_UP, 0.05, 0.1, 0.15);
    set_vector(p.end, 0.15, 0.1, 0.19);
    const tobi_probe_info dry = measure(world, &p);
    assert_true(dry.distance == 0 && dry.run_up == 0.15);
    tobi_world_destroy(world);
}

/* --- filters ------------------------------------------------------------------------------- */

/* Amplitude of a sine of 10 Hz behind a low pass, with unequal steps. */
static double pass_sine(double cutoff, int order, double frequency)
{
    tobi_sensor_state f = { 0 };
    double t = 0, most = 0;
    for (int k = 0; t < 2; k++) {
        const double dt = 1e-4*(1 + k % 3);
        t += dt;
        tobi_sensor_pass(&f, cutoff, order, dt, sin(2*pi*frequency*t));
        if (t > 1) most = fmax(most, fabs(f.y));
    }
    return most;
}

static void low_passes(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        const double f = 2.5*pow(2, k), r = f/10;
        assert_close(pass_sine(10, 0, f), 1/sqrt(1 + r*r), 1e-3, "first order");
        assert_close(pass_sine(10, 1, f), 1/sqrt(1 + r*r*r*r), 1e-3, "Butterworth");
    }
    assert_close(pass_sine(0, 1, 10), 1, 1e-3, "none");
    /* a ramp is exact: it lags by 1/a, and by sqrt(2)/w */
    for (int order = 0; order < 2; order++) {
        tobi_sensor_state f = { 0 };
        tobi_sensor_pass(&f, 5, order, 1, 0);
        double t = 0;
        for (int k = 0; k < 400; k++) {
            t += 0.003*(1 + k % 2);
            tobi_sensor_pass(&f, 5, order, 0.003*(1 + k % 2), t);
        }
        assert_close(f.y, t - (order ? sqrt(2) : 1)/(10*pi), 1e-12, "ramp");
    }
}

/* --- bad input ----------------------------------------------------------------------------- */

static void refuses(tobi_world *world, const tobi_probe_def *p, tobi_status status, const char *words)
{
    REFUSED(tobi_world_add_probe(world, p, &err), status, words);
}

static void bad_sensors_are_refused(void **state)
{
    (void)state;
    tobi_world *world = make_tank(3, 0, 0.1, "wcsph"), *flat = make_tank(2, 0, 0.1, "wcsph");
    tobi_probe_def p = make("p", TOBI_PROBE_RUN_UP, 0.1, 0.1, 0.1);
    set_vector(p.end, 0.1, 0.1, 0.3);
    refuses(world, &p, TOBI_INVALID, "outside the domain: z = 0.3 m");
    memcpy(p.end, p.position, sizeof p.end);
    refuses(world, &p, TOBI_INVALID, "ends where it begins");
    p = make("p", TOBI_PROBE_PATCH, 0.1, 0.1, 0.1);
    refuses(world, &p, TOBI_INVALID, "needs length, width, greater than 0 m");
    p.kind = TOBI_PROBE_VOLUME;
    refuses(world, &p, TOBI_INVALID, "needs length, width, height");
    set_sizes(&p, 0.1, 0.1, 0.1);
    p.position[2] = 0;
    set_vector(p.normal, 0, 0, 1);
    refuses(flat, &p, TOBI_INVALID, "have no z in 2-D");
    p = make("p", TOBI_PROBE_PATCH, 0, 0.1, 0.1);
    set_vector(p.normal, 1, 0, 0);
    set_sizes(&p, 0.1, 0.21, 0);
    refuses(world, &p, TOBI_INVALID, "the patch reaches from -0.005 to 0.205 m in z, the domain "
            "from 0 to 0.2 m");
    set_sizes(&p, 0.2, 0.2, 0);
    OK(tobi_world_add_probe(world, &p, &err));
    p.position[2] = 0;
    set_sizes(&p, 0.21, 0, 0);
    refuses(flat, &p, TOBI_INVALID, "the patch reaches from -0.005 to 0.205 m in y, the domain "
            "from 0 to 0.2 m");
    p = make("p", TOBI_PROBE_POINT, 0.1, 0.1, 0.1);
    p.body = "nobody";
    refuses(world, &p, TOBI_NOT_FOUND, "sits on the body 'nobody', which is not there");
    tobi_body_def b = tobi_default_body_def();
    b.name = "arm";
    set_vector(b.box_max, 0.02, 0.02, 0.02);
    OK(tobi_world_add_body(world, &b, &err));
    b.name = "jelly";
    b.motion = spin;
    OK(tobi_world_add_body(world, &b, &err));
    p.body = "jelly";
    refuses(world, &p, TOBI_UNSUPPORTED, "which deforms");
    p.body = "arm";
    p.kind = TOBI_PROBE_LEVEL;
    refuses(world, &p, TOBI_INVALID, "a level stands still");
    tobi_world_destroy(world);
    tobi_world_destroy(flat);
}

static void rates_and_filters_are_checked(void **state)
{
    (void)state;
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    w.spacing = D;
    w.domain_max[0] = w.domain_max[1] = w.domain_max[2] = 0.2;
    w.time_step = 0.001;
    OK(tobi_world_create(&w, NULL, &world, &err));
    tobi_probe_def p = make("p", TOBI_PROBE_POINT, 0.1, 0.1, 0.1);
    p.rate = 1000;
    OK(tobi_world_add_probe(world, &p, &err));
    p.rate = 2000;
    refuses(world, &p, TOBI_INVALID, "a rate of 2000 Hz is more than a value per time step, 1000 Hz");
    p.rate = 0;
    p.cutoff = 600;
    refuses(world, &p, TOBI_INVALID, "a filter of 600 Hz");
    p.rate = 100;
    p.cutoff = 51;
    refuses(world, &p, TOBI_INVALID, "allowed is up to 50 Hz");
    tobi_world_destroy(world);
}

/* The same in scenes, with the place. */
static void expect(const char *probe, const char *words)
{
    char text[1500];
    tobi_scene *scene;
    tobi_error err;
    snprintf(text, sizeof text,
             "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": 0.1, \"end_time\": 1,\n"
             "\"time_step\": 0.001, \"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"box\": {\n"
             "\"min\": [0, 0, 0], \"max\": [1, 1, 0.5] } } ] } ], \"bodies\": [ { \"name\": \"block\",\n"
             "\"box\": { \"min\": [0.4, 0.4, 0], \"max\": [0.6, 0.6, 0.6] } } ],\n"
             "\"probes\": [ { \"name\": \"p\", \"position\": [0.5, 0.5, 0.5], %s } ] }",
             probe);
    const tobi_status status = tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, &err);
    if (!words) {
        if (status != TOBI_OK) fail_msg("%s", err.text);
        char *resolved = tobi_scene_resolved(scene);      /* what its kind does not read is not in it */
        tobi_scene *again;
        OK(tobi_scene_parse("r.json", resolved, strlen(resolved), NULL, &again, NULL, &err));
        tobi_scene_free(again);
        free(resolved);
        tobi_scene_free(scene);
        return;
    }
    if (status != TOBI_INVALID || !strstr(err.text, words)) fail_msg("'%s' has no '%s'", err.text, words);
}

static void scenes_tell_the_place(void **state)
{
    (void)state;
    expect("\"kind\": \"patch\", \"length\": 0.1, \"width\": 0.1, \"body\": \"block\", \"rate\": 100", NULL);
    expect("\"kind\": \"run-up\", \"end\": [1, 1, 1],\"filter\": { \"cutoff\": 40, \"order\": \"first\" }",
           NULL);
    expect("\"kind\": \"level\"", NULL);
    expect("\"kind\": \"ptch\"", "did you mean \"patch\"?");
    expect("\"length\": 0.1", "s.json:5:57: probes[0].length: is for a patch, a flow or a volume");
    expect("\"kind\": \"flow\", \"length\": 0.1", "probes[0].width: is missing");
    expect("\"kind\": \"flow\", \"width\": 0.1", "probes[0].length: is missing");
    expect("\"kind\": \"volume\", \"length\": 0.1, \"width\": 1", "probes[0].height: is missing");
    expect("\"end\": [0, 0, 0]", "probes[0].end: is for a run-up");
    expect("\"kind\": \"run-up\"", "s.json:5:13: probes[0].end: is missing: a run-up is a line");
    expect("\"kind\": \"run-up\", \"end\": [0, 0, 2]", "probes[0].end: is 2 m in z");
    expect("\"kind\": \"run-up\", \"end\": [0.5, 0.5, 0.5]", "is where the run-up begins");
    expect("\"kind\": \"patch\", \"length\": 1, \"width\": 1, \"height\": 1",
           "probes[0].height: is for a volume");
    expect("\"body\": \"blok\"", "there is no body \"blok\"; did you mean \"block\"?");
    expect("\"body\": \"elephant\"", "there is no body \"elephant\"");
    expect("\"kind\": \"level\", \"body\": \"block\"", "is not for a level");
    expect("\"kind\": \"level\", \"fluid\": \"water\"", NULL);
    expect("\"kind\": \"level\", \"fluid\": \"wter\"", "there is no fluid \"wter\"; did you mean \"water\"?");
    expect("\"fluid\": \"water\"", "probes[0].fluid: is for a level, a run-up, a flow or a volume");
    expect("\"filter\": { \"order\": \"butterworth\" }",
           "probes[0].filter.order: is of a filter, which needs a cutoff");
    expect("\"rate\": 1001", "probes[0].rate: is 1001 Hz, more than a value per time step of 0.001 s");
    expect("\"rate\": 100, \"filter\": { \"cutoff\": 60 }",
           "probes[0].filter.cutoff: is 60 Hz, more than half of 100");
}

static void two_along_x(const double x[3], double *v) { (void)x; v[0] = 2, v[1] = v[2] = 0; }

/* 0.08 m of water, and air up to the lid. The level of the air, which stands on the water, is the lid. */
static void a_sensor_is_of_one_fluid(void **state)
{
    (void)state;
    tobi_world *world = make_tank(2, -9.81, 0.08, "isph");
    tobi_fluid_def air = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_probe_def level = make("level", TOBI_PROBE_LEVEL, 0.1, 0.1, 0);
    tobi_probe_def up = make("run_up", TOBI_PROBE_RUN_UP, 0.06, 0, 0);
    tobi_probe_def volume = make("volume", TOBI_PROBE_VOLUME, 0.1, 0.1, 0);
    tobi_probe_def flow = make("flow", TOBI_PROBE_FLOW, 0.1, 0.1, 0);
    air.name = "air";
    air.density = 1.2;
    set_vector(fill.box_min, 0, 0.08, 0);
    set_vector(fill.box_max, 0.2, 0.2, 0);
    set_vector(up.end, 0.06, 0.18, 0);
    set_vector(flow.normal, 1, 0, 0);
    set_sizes(&volume, 0.1, 0, 0.18);
    set_sizes(&flow, 0.18, 0, 0);
    level.fluid = "air";
    REFUSED(tobi_world_add_probe(world, &level, &err), TOBI_NOT_FOUND,
            "of the fluid 'air', which is not there");
    OK(tobi_world_add_fluid(world, &air, &fill, 1, &err));
    OK(tobi_world_start(world, &err));
    set_field(world, "velocity", 3, two_along_x);
    const double of_all[] = { 0.2, 0.18, 0.018 }, of_water[] = { 0.08, 0.08, 0.007 };
    level.name = "p4";
    level.fluid = "air";
    assert_close(measure(world, &level).level, of_all[0], 0.1*D, "level of the air");
    for (int only = 0; only < 2; only++) {
        const double *expected = only ? of_water : of_all;
        char names[4][8];
        tobi_probe_def *all[] = { &level, &up, &volume, &flow };
        for (int k = 0; k < 4; k++) {
            snprintf(names[k], sizeof names[k], "p%d%d", k, only);
            all[k]->name = names[k];
            all[k]->fluid = only ? tobi_default_fluid_def().name : NULL;
        }
        assert_close(measure(world, &level).level, expected[0], 0.1*D, "level");
        assert_close(measure(world, &up).distance, expected[1], 0.1*D, "run-up");
        assert_close(measure(world, &volume).volume, expected[2], 1e-9, "volume");
        assert_close(measure(world, &flow).flow, 2*expected[2]/0.1, 1e-6, "flow");
    }
    tobi_probe_def point = make("point", TOBI_PROBE_POINT, 0.1, 0.1, 0);
    point.fluid = "air";
    REFUSED(tobi_world_add_probe(world, &point, &err), TOBI_INVALID, "a point or patch feels what is there");
    tobi_world_destroy(world);
}

static void a_deforming_body_holds_no_sensor(void **state)
{
    (void)state;
    static const char text[] =
        "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": 0.1, \"end_time\": 1,\n"
        "\"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"box\": { \"min\": [0, 0, 0],"
        "\"max\": [1, 1, 0.5] } } ] } ],\n"
        "\"bodies\": [ { \"name\": \"fin\", \"box\": { \"min\": [0.4, 0.4, 0], \"max\": [0.6, 0.6, 0.6] },\n"
        "\"motion\": { \"script\": \"sensor_fin.lua\" } } ],\n"
        "\"probes\": [ { \"name\": \"p\", \"position\": [0.5, 0.5, 0.5], \"body\": \"fin\" } ] }";
    FILE *file = fopen("sensor_fin.lua", "w");
    tobi_scene *scene;
    fputs("function deform(x, y, z, t) return x + 0.01*t*z, y, z end\n", file);
    fclose(file);
    REFUSED(tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, &err), TOBI_INVALID,
            "s.json:5:65: probes[0].body: \"fin\" deforms: the sensor would have no place on it; "
            "output.tractions has the pressure on its surface");
    remove("sensor_fin.lua");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_patch_in_still_water), cmocka_unit_test(a_patch_on_a_wall),
        cmocka_unit_test(uniform_flow_is_exact), cmocka_unit_test(volumes_are_exact),
        cmocka_unit_test(a_volume_ends_at_walls),
        cmocka_unit_test(a_turning_rectangle), cmocka_unit_test(a_point_rides_on_a_body),
        cmocka_unit_test(levels_of_the_main_body_of_water), cmocka_unit_test(a_dry_floor_and_a_block),
        cmocka_unit_test(a_run_up_ends_at_the_surface), cmocka_unit_test(low_passes),
        cmocka_unit_test(bad_sensors_are_refused), cmocka_unit_test(rates_and_filters_are_checked),
        cmocka_unit_test(scenes_tell_the_place), cmocka_unit_test(a_sensor_is_of_one_fluid),
        cmocka_unit_test(a_deforming_body_holds_no_sensor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

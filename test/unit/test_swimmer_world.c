/* Swimmers in water, by all methods that know bodies moved by forces: a run equals a run with a restart and
   one with more threads, bit by bit; what the swimmer gains the water loses; checkpoints and motions that do
   not fit are refused. */
#include "core/body.h"
#include "run_to.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const char *const methods[] = { "dfsph", "isph", "wcsph", "steered" };
enum { METHODS = 3 };

/* A plate of 0.6 m by 0.1 m about (1, 0.5) m that beats its tail, from rest. */
static tobi_status beat(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                        tobi_error *err)
{
    const double far = *(const double *)user;      /* 1/m */
    (void)err;
    for (int64_t i = 0; i < n; i++) {
        const double s = rest[i][0] - 0.7;
        memcpy(out[i], rest[i], sizeof out[i]);
        out[i][1] += 0.5*far*s*s*(1 - cos(8*t));
    }
    return TOBI_OK;
}

static double swing = 1, strange = 1.5;

/* The same by a program that lets the phase go on, faster until the plate moves. */
static double steered[3];

static void steer(void *user, const double numbers[3])
{
    (void)user;
    memcpy(steered, numbers, sizeof steered);
}

static tobi_status beat_by_phase(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                                 tobi_error *err)
{
    (void)t;
    return beat(user, steered[0], n, rest, out, err);
}

static tobi_status control(void *user, const tobi_control_input *in, tobi_control_output *out,
                           tobi_error *err)
{
    (void)user;
    (void)err;
    out->steer[0] = in->steer[0] + in->step*(in->velocity[0] > -0.005 ? 1.5 : 0.5);
    return TOBI_OK;
}

static tobi_world *build(const char *method, int threads)
{
    const int steering = strcmp(method, "steered") == 0;
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def b = tobi_default_body_def();
    tobi_world *w;
    def.method = steering ? "dfsph" : method;
    def.dimension = 2;
    def.spacing = 0.04;
    def.threads = threads;
    def.domain_max[0] = fill.box_max[0] = 2;
    def.domain_max[1] = fill.box_max[1] = 1;
    def.domain_max[2] = fill.box_max[2] = 0;
    memset(def.gravity, 0, sizeof def.gravity);
    for (int a = 0; a < 2; a++) def.wall_min[a] = def.wall_max[a] = TOBI_WALL_PERIODIC;
    fluid.name = "water";
    fluid.viscosity = 1;
    b.name = "fish";
    b.dynamics = TOBI_FREE;
    b.motion = beat;
    b.motion_user = &swing;
    b.friction = TOBI_NO_SLIP;
    if (steering) {
        b.dynamics = TOBI_CONTROLLED;
        b.control = control;
        b.motion = beat_by_phase;
        b.motion_steer = steer;
    }
    b.density = 500;
    memcpy(b.box_min, (double[3]){ 0.7, 0.45, 0 }, sizeof b.box_min);
    memcpy(b.box_max, (double[3]){ 1.3, 0.55, 0 }, sizeof b.box_max);
    OK(tobi_world_create(&def, NULL, &w, &err));
    OK(tobi_world_add_fluid(w, &fluid, &fill, 1, &err));
    OK(tobi_world_add_body(w, &b, &err));
    return w;
}

static void test_restart(void **state)
{
    (void)state;
    for (int k = 0; k < METHODS + 1; k++) {
        tobi_world *a = build(methods[k], 1), *b = build(methods[k], 3), *c = build(methods[k], 1);
        run_to(a, 0.15);
        OK(tobi_world_save(a, "fish.h5", &err));
        const uint64_t whole = run_to(a, 0.3);
        if (k == METHODS) {
            const double phase = a->sim.bodies[0].swimmer->steer[0];
            print_message("steered to a phase of %.3g s\n", phase);
            assert_true(phase > 0.16 && phase < 0.44);      /* 0.15 and 0.45 by either rate alone */
        }
        run_to(b, 0.15);
        if (run_to(b, 0.3) != whole) fail_msg("%s: other threads, other bits", methods[k]);
        OK(tobi_world_load(c, "fish.h5", &err));
        if (run_to(c, 0.3) != whole) fail_msg("%s: a restart, other bits", methods[k]);
        tobi_world_destroy(a);
        tobi_world_destroy(b);
        tobi_world_destroy(c);
        remove("fish.h5");
    }
}

/* In a periodic domain nothing else takes momentum. */
static void test_momentum(void **state)
{
    (void)state;
    for (int k = 0; k < METHODS; k++) {
        tobi_world *w = build(methods[k], 2);
        tobi_body_info fish;
        tobi_step_info step = { 0 };
        double worst = 0, most = 0;
        for (int n = 1; n <= 20; n++) {
            OK(tobi_world_advance(w, 0.02*n, &step, &err));
            OK(tobi_world_body(w, 0, &fish));
            for (int a = 0; a < 2; a++) {
                worst = fmax(worst, fabs(step.momentum[a] + fish.mass*fish.velocity[a]));
                most = fmax(most, fish.mass*fabs(fish.velocity[a]));
            }
        }
        print_message("%s: the fish has up to %.3g kg m/s, both together %.2g\n", methods[k], most, worst);
        assert_true(most > 0.3);
        if (k != 1) assert_true(worst < 1e-4*most);       /* mirrors of isph do not keep momentum */
        tobi_world_destroy(w);
    }
}

/* Velocities that are read for the body's particles are those by which they move. */
static void test_read(void **state)
{
    tobi_world *w = build("dfsph", 1);
    tobi_body *b;
    double (*before)[3], *v, worst = 0, most = 0;
    (void)state;
    run_to(w, 0.2);
    b = &w->sim.bodies[0];
    const int64_t n = b->particle_count;
    v = calloc((size_t)(3*n), sizeof *v);
    before = calloc((size_t)n, sizeof *before);
    OK(tobi_body_place_particles(b, w->sim.time, &err));
    memcpy(before, b->particle, (size_t)n*sizeof *before);
    const double from = w->sim.time;
    run_to(w, 0.201);
    OK(tobi_world_read(w, TOBI_BODIES, "velocity", v, n, &err));
    OK(tobi_body_place_particles(b, w->sim.time, &err));
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 2; a++) {
            const double moved = (b->particle[i][a] - before[i][a])/(w->sim.time - from);
            worst = fmax(worst, fabs(moved - v[3*i + a]));
            most = fmax(most, fabs(moved));
        }
    print_message("particles of the body: up to %.3g m/s, read within %.2g\n", most, worst);
    /* Its own momentum is taken out by two layers of particles, not by the mass points: a tenth. Without the
       rigid velocities, or without the shape's, it would be more than a third. */
    assert_true(most > 0.2 && worst < 0.1*most);
    free(v);
    free(before);
    tobi_world_destroy(w);
}

static void test_refused(void **state)
{
    tobi_world *w = build("dfsph", 1);
    tobi_swimmer *swimmer;
    (void)state;
    run_to(w, 0.1);
    swimmer = w->sim.bodies[0].swimmer;
    OK(tobi_world_set_body_motion(w, 0, beat, &swing, &err));
    REFUSED(tobi_world_set_body_motion(w, 0, beat, &strange, &err), TOBI_INVALID, "would jump by");
    swimmer->now[0][0] = NAN;
    OK(tobi_world_save(w, "fish.h5", &err));
    REFUSED(tobi_world_load(w, "fish.h5", &err), TOBI_DAMAGED, "shape of body 'fish' is that of no body");
    remove("fish.h5");
    tobi_world_destroy(w);
}

int main(void)
{
    char folder[] = "/tmp/tobiuo_swimmer_XXXXXX";
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_restart), cmocka_unit_test(test_momentum), cmocka_unit_test(test_read),
        cmocka_unit_test(test_refused),
    };
    if (!mkdtemp(folder) || chdir(folder) != 0) return 1;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    if (chdir("/") == 0) rmdir(folder);
    return failed;
}

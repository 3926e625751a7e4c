/* Gravity in time, and the frame that a tank is seen from. */
#include "calls.h"
#include "tobiuo/motion.h"
#include "tobiuo/scene.h"
#include "world/acceleration.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static tobi_world *make_tank(const char *method, int dimension)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_world *world;
    w.method = method;
    w.dimension = dimension;
    for (int a = 0; a < dimension; a++) w.domain_max[a] = 0.1;
    if (dimension == 2) w.domain_max[2] = 0;
    w.gravity[2] = 0;
    w.gravity[1] = -9.81;
    w.spacing = 0.01;
    w.end_time = 1;
    w.threads = 1;
    solid.youngs_modulus = 1e5;
    for (int a = 0; a < dimension; a++) fill.box_max[a] = a == 1 ? 0.05 : 0.1;
    OK(tobi_world_create(&w, NULL, &world, &err));
    if (strcmp(method, "mlsmpm") == 0) OK(tobi_world_add_solid(world, &solid, &fill, 1, &err));
    else OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
    return world;
}

static void write_file(char *path, const char *text)
{
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

static void close_to(double value, double expected, double within)
{
    if (!(fabs(value - expected) <= within))
        fail_msg("%.12g is not %.12g within %g", value, expected, within);
}

static int is_noted(double amplitude, const char *text)
{
    tobi_world *w = make_tank("dfsph", 2);
    tobi_motion *surge;
    int found = 0;
    OK(tobi_motion_oscillation((double[3]){ 1, 0, 0 }, amplitude, 1, 0, &surge, &err));
    OK(tobi_world_set_frame(w, tobi_motion_positions, surge, &err));
    OK(tobi_world_start(w, &err));
    for (int k = 0; tobi_world_note(w, k); k++) found += strstr(tobi_world_note(w, k), text) != NULL;
    tobi_world_destroy(w);
    tobi_motion_free(surge);
    return found;
}

/* 30 mm that are read as 30 m; 4 pi^2 (1/s2) times that beside gravity. */
static void frames_that_no_tank_bears_are_noted(void **state)
{
    (void)state;
    assert_int_equal(is_noted(30, "frame presses the liquid with up to 1.18e+03 m/s2, 1.2e+02 times"), 1);
    assert_int_equal(is_noted(30, "of its motion, and let it begin and end at rest"), 1);
    assert_int_equal(is_noted(0.03, "frame presses"), 0);
}

/* A turn at 100 degrees/s that begins at once: none of it in the middle, where the axis is. */
static void a_turn_at_once_is_noted(void **state)
{
    (void)state;
    tobi_world *w = make_tank("dfsph", 2);
    tobi_motion *turn;
    int found = 0;
    OK(tobi_motion_rotation((double[3]){ 0.05, 0.05, 0 }, (double[3]){ 0, 0, 1 }, 100, &turn, &err));
    OK(tobi_world_set_frame(w, tobi_motion_positions, turn, &err));
    OK(tobi_world_start(w, &err));
    for (int k = 0; tobi_world_note(w, k); k++)
        found += strstr(tobi_world_note(w, k), "and let it begin and end at rest") != NULL;
    assert_int_equal(found, 1);
    tobi_world_destroy(w);
    tobi_motion_free(turn);
}

static void bad_gravity_is_refused(void **state)
{
    tobi_world *w = make_tank("dfsph", 2);
    tobi_gravity_def g = tobi_default_gravity_def();
    (void)state;
    REFUSED(tobi_world_set_gravity_in_time(w, &g, &err), TOBI_INVALID, "needs a file or an amplitude");
    g.amplitude[0] = 1;
    REFUSED(tobi_world_set_gravity_in_time(w, &g, &err), TOBI_INVALID, "an amplitude without a period");
    g.amplitude[2] = g.period = 1;
    REFUSED(tobi_world_set_gravity_in_time(w, &g, &err), TOBI_INVALID, "swings along z, which a 2-D world");
    g.amplitude[0] = g.amplitude[2] = 0;
    g.file = "gravity.csv";
    REFUSED(tobi_world_set_gravity_in_time(w, &g, &err), TOBI_INVALID, "a period without an amplitude");
    g.period = 0;
    write_file("gravity.csv", "time,x,y\n0,0,-9.81\n1,0,-9.81\n0.5,0,0\n");
    REFUSED(tobi_world_set_gravity_in_time(w, &g, &err), TOBI_INVALID,
           "gravity gravity.csv:4: time 0.5 s does not come after 1 s");
    write_file("gravity.csv", "time,y,yaw\n0,-9.81,1\n");
    REFUSED(tobi_world_set_gravity_in_time(w, &g, &err), TOBI_INVALID, "gravity does not turn");
    write_file("gravity.csv", "time,x [m]\n0,1\n");
    REFUSED(tobi_world_set_gravity_in_time(w, &g, &err), TOBI_INVALID, "x is in [m]; allowed is [m/s2]");
    g.file = "there_is_none.csv";
    REFUSED(tobi_world_set_gravity_in_time(w, &g, &err), TOBI_NOT_FOUND, "there_is_none.csv");
    OK(tobi_world_start(w, &err));
    g.file = NULL;
    REFUSED(tobi_world_set_gravity_in_time(w, &g, &err), TOBI_INVALID, "takes no other gravity");
    tobi_world_destroy(w);
    unlink("gravity.csv");
}

/* A table in place of one component, a swing on another. */
static void gravity_follows_table_and_swing(void **state)
{
    tobi_world *w = make_tank("dfsph", 2);
    tobi_gravity_def g = tobi_default_gravity_def();
    (void)state;
    write_file("gravity.csv", "time,y [m/s2]\n0,-9\n1,-8\n2,-7\n");
    g.file = "gravity.csv";
    g.amplitude[0] = 2;
    g.period = 0.5;
    g.phase[0] = 90;
    OK(tobi_world_set_gravity_in_time(w, &g, &err));
    OK(tobi_world_start(w, &err));
    w->sim.time = 0.25;
    w->sim.dt = 0;
    OK(tobi_world_drive(w, &err));
    const tobi_acceleration *f = &w->sim.acceleration;
    close_to(f->uniform[1], -8.75 + 9.81, 1e-12);
    close_to(f->uniform[0], -2, 1e-12);
    close_to(w->sim.acceleration_most[1], 9, 1e-9);
    tobi_world_destroy(w);
    unlink("gravity.csv");
}

/* -rate^2 (x - centre), of places that count from the lower corner; mlsmpm does not know it. */
static void central_force_points_to_a_place(void **state)
{
    tobi_world *w = make_tank("dfsph", 2), *solids = make_tank("mlsmpm", 2);
    tobi_central_def c = tobi_default_central_def();
    const double x[3] = { 0.01, 0.02, 0 };
    double a[3];
    (void)state;
    REFUSED(tobi_world_set_central_force(w, &c, &err), TOBI_INVALID, "rate");
    c.rate = 3;
    c.centre[0] = 0.05;
    OK(tobi_world_set_central_force(w, &c, &err));
    OK(tobi_world_start(w, &err));
    tobi_acceleration_at(&w->sim.acceleration, x, a);
    close_to(a[0], -9*(0.01 - 0.05), 1e-12);
    close_to(a[1], -9*0.02, 1e-12);
    REFUSED(tobi_world_set_central_force(w, &c, &err), TOBI_INVALID, "takes no other central force");
    OK(tobi_world_set_central_force(solids, &c, &err));
    REFUSED(tobi_world_start(solids, &err), TOBI_UNSUPPORTED, "mlsmpm does not know a central force");
    tobi_world_destroy(w);
    tobi_world_destroy(solids);
}

static void central_force_jumps_nowhere(void **state)
{
    tobi_scene *scene;
    tobi_world *w = NULL;
    const char *text =
        "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [1, 1], \"walls\": { \"x\": "
        "\"periodic\" } }, \"spacing\": 0.1, \"end_time\": 1, \"fluids\": [ { \"name\": \"w\", \"fill\": "
        "[ { \"box\": { \"min\": [0, 0], \"max\": [1, 0.5] } } ] } ], "
        "\"central_force\": { \"centre\": [0, 0], \"rate\": 1 } }";
    (void)state;
    OK(tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, &err));
    OK(tobi_scene_build(scene, &w, &err));
    REFUSED(tobi_world_start(w, &err), TOBI_INVALID, "periodic along x, where a central force");
    tobi_world_destroy(w);
    tobi_scene_free(scene);
}

/* A turn about z at a constant rate about (0.3, 0, 0), and a shift of a constant acceleration along y. */
static tobi_status spin(void *user, double t, int64_t n, const double (*rest)[3], double (*to)[3],
                        tobi_error *err)
{
    const double c = cos(3*t), s = sin(3*t), x0 = 0.3;
    (void)user; (void)err;
    for (int64_t i = 0; i < n; i++) {
        const double x = rest[i][0] - x0, y = rest[i][1];
        to[i][0] = x0 + c*x - s*y;
        to[i][1] = s*x + c*y + t*t;
        to[i][2] = rest[i][2];
    }
    return TOBI_OK;
}

static tobi_status explode(void *user, double t, int64_t n, const double (*rest)[3], double (*to)[3],
                           tobi_error *err)
{
    (void)user; (void)err;
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++) to[i][a] = rest[i][a]/(t > 0.5 ? 0 : 1);
    return TOBI_OK;
}

static void frames_make_fictitious_forces(void **state)
{
    tobi_world *w = make_tank("dfsph", 2);
    (void)state;
    OK(tobi_world_set_frame(w, spin, NULL, &err));
    OK(tobi_world_start(w, &err));
    const double dt = 0.01, t = 0.2, x[3] = { 0.07, 0.02, 0 };
    w->sim.time = t - 0.5*dt;
    w->sim.dt = dt;
    OK(tobi_world_drive(w, &err));
    double a[3], turned[3];
    const double c = cos(3*t), s = sin(3*t), down = -9.81 - 2;
    tobi_acceleration_at(&w->sim.acceleration, x, a);
    close_to(a[0], s*down + 9*(x[0] - 0.3), 1e-6);                /* gravity, centrifugal */
    close_to(a[1], c*down + 9.81 + 9*x[1], 1e-6);
    const float u[3] = { 1, 2, 0 };
    tobi_acceleration_by_velocity(&w->sim.acceleration, u, turned);
    const double after[2] = { u[0] + dt*turned[0], u[1] + dt*turned[1] };
    close_to(hypot(after[0], after[1]), hypot(u[0], u[1]), 1e-12);   /* the size stays */
    close_to(turned[0], 2*3*u[1], 0.2);
    close_to(turned[1], -2*3*u[0], 0.4);
    tobi_world_destroy(w);
}

/* A ball in free fall, seen from a frame that spins, keeps its velocity and spin in the laboratory. */
static void bodies_feel_the_frame(void **state)
{
    tobi_world *w = make_tank("dfsph", 3);
    tobi_body_def b = tobi_default_body_def();
    const double none[3] = { 0 };
    tobi_body_info info;
    (void)state;
    b.name = "block";
    b.dynamics = TOBI_FREE;
    for (int a = 0; a < 3; a++) b.box_max[a] = (b.box_min[a] = 0.06) + 0.02*(1 + 0.3*a);
    b.air_resistance = 0;
    OK(tobi_world_add_body(w, &b, &err));
    OK(tobi_world_set_gravity(w, none, &err));
    OK(tobi_world_set_frame(w, spin, NULL, &err));
    OK(tobi_world_start(w, &err));
    const double start = w->sim.bodies[0].rigid.position[0];
    tobi_rigid *r = &w->sim.bodies[0].rigid;
    /* at rest in the laboratory: in the frame it goes round, and turns, the other way */
    w->sim.dt = 1e-6;
    OK(tobi_world_drive(w, &err));
    const double rx = start - 0.3, ry = r->position[1];
    close_to(r->inertial[0], r->mass*9*rx, 1e-4*r->mass*9);
    close_to(r->inertial[1], r->mass*(9*ry - 2), 1e-4*r->mass*9);
    r->angular_velocity[2] = -3;
    r->velocity[0] = 3*ry;
    r->velocity[1] = -3*rx;
    OK(tobi_world_drive(w, &err));
    close_to(r->inertial[0], -r->mass*9*rx, 1e-3*r->mass*9);      /* as a circle needs */
    close_to(r->inertial[5], 0, 1e-6*r->mass);
    OK(tobi_world_body(w, 0, &info));
    tobi_world_destroy(w);
}

static void bad_frames_are_refused(void **state)
{
    tobi_world *w = make_tank("dfsph", 2), *solids = make_tank("mlsmpm", 2);
    (void)state;
    OK(tobi_world_set_frame(w, explode, NULL, &err));
    REFUSED(tobi_world_start(w, &err), TOBI_INVALID, "the acceleration of the frame is no number");
    OK(tobi_world_set_frame(solids, spin, NULL, &err));
    REFUSED(tobi_world_start(solids, &err), TOBI_UNSUPPORTED, "the frame turns, which mlsmpm does not know");
    tobi_world_destroy(w);
    tobi_world_destroy(solids);
}

/* Free fall of every method: gravity goes at once, the water stays. */
static void every_method_follows(void **state)
{
    static const char *const methods[] = { "dfsph", "wcsph", "isph", "eisph", "mlsmpm" };
    (void)state;
    for (int m = 0; m < 5; m++) {
        tobi_world *w = make_tank(methods[m], 2);
        tobi_gravity_def g = tobi_default_gravity_def();
        tobi_step_info info;
        write_file("gravity.csv", "time,x,y\n0,2,0\n1,2,0\n");
        g.file = "gravity.csv";
        OK(tobi_world_set_gravity_in_time(w, &g, &err));
        OK(tobi_world_advance(w, 0.002, &info, &err));
        assert_true(info.speed_max < 0.006);
        assert_true(info.momentum[0] > 0.1*2*0.002*5);
        assert_true(fabs(info.momentum[1]) < 0.25*2*0.002*5);
        tobi_world_destroy(w);
    }
    unlink("gravity.csv");
}

static tobi_damping_def make_zone(void)
{
    tobi_damping_def d = tobi_default_damping_def();
    d.box_min[0] = 0.05;
    d.box_max[0] = d.box_max[1] = d.box_max[2] = 0.1;
    d.rate = 50;
    return d;
}

/* Nothing before the zone, all of the rate at its end, a quarter in its middle. */
static void zones_damp_velocities(void **state)
{
    tobi_world *w = make_tank("isph", 2);
    tobi_damping_def d = make_zone();
    (void)state;
    OK(tobi_world_add_damping(w, &d, &err));
    OK(tobi_world_start(w, &err));
    tobi_system *s = &w->system[0];
    s->dt = 0.01;
    for (int64_t i = 0; i < s->particles.count; i++) s->particles.velocity[i].x = 1;
    tobi_damping_apply(s);
    for (int64_t i = 0; i < s->particles.count; i++) {
        const double f = fmax(s->particles.position[i].x - 0.05, 0)/0.05;
        close_to(s->particles.velocity[i].x, 1/(1 + 0.5*f*f), 1e-6);
    }
    tobi_world_destroy(w);
}

static void bad_zones_are_refused(void **state)
{
    tobi_world *w = make_tank("dfsph", 2), *solids = make_tank("mlsmpm", 2);
    tobi_damping_def d = make_zone();
    (void)state;
    d.rate = -1;
    REFUSED(tobi_world_add_damping(w, &d, &err), TOBI_INVALID, "rate");
    d.rate = 1;
    d.direction[0] = 0;
    REFUSED(tobi_world_add_damping(w, &d, &err), TOBI_INVALID, "of a damping zone has no length");
    d = make_zone();
    d.box_min[0] += 1;
    d.box_max[0] += 1;
    REFUSED(tobi_world_add_damping(w, &d, &err), TOBI_INVALID, "m in x, outside of the domain");
    d = make_zone();
    REFUSED(tobi_world_add_damping(solids, &d, &err), TOBI_UNSUPPORTED, "mlsmpm knows no damping zones");
    for (int k = 0; k < 16; k++) OK(tobi_world_add_damping(w, &d, &err));
    REFUSED(tobi_world_add_damping(w, &d, &err), TOBI_UNSUPPORTED, "more than 16 damping zones");
    d.box_max[1] = 0;
    w->sim.damping_count = 0;
    REFUSED(tobi_world_add_damping(w, &d, &err), TOBI_INVALID, "reaches from 0 to 0 m in y");
    OK(tobi_world_start(w, &err));
    REFUSED(tobi_world_add_damping(w, &d, &err), TOBI_INVALID, "a started world takes no more damping zones");
    tobi_world_destroy(w);
    tobi_world_destroy(solids);
}

static tobi_status parse(const char *more, tobi_error *err)
{
    char text[1200];
    tobi_scene *scene;
    snprintf(text, sizeof text,
             "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [1, 1] }, \"spacing\": 0.1,\n"
             "\"end_time\": 1, \"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"box\": { \"min\": [0, 0],\n"
             "\"max\": [1, 0.5] } } ] } ],\n%s }", more);
    const tobi_status status = tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, err);
    if (status != TOBI_OK) return status;
    char *resolved = tobi_scene_resolved(scene);
    tobi_world *w = NULL;
    if (!strstr(resolved, "frame") || !strstr(resolved, "gravity_in_time") ||
        !strstr(resolved, "central_force"))
        fail_msg("%s", resolved);
    OK(tobi_scene_build(scene, &w, &err));
    tobi_world_destroy(w);
    free(resolved);
    tobi_scene_free(scene);
    return TOBI_OK;
}

static void scenes_say_it(void **state)
{
    (void)state;
    OK(parse("\"frame\": [ { \"yaw\": { \"amplitude\": 2, \"period\": 1 } } ],\n"
             "\"gravity_in_time\": { \"amplitude\": [1, 0], \"period\": 2 },\n"
             "\"central_force\": { \"centre\": [0.5, 0], \"rate\": 2 }", &err));
    REFUSED(parse("\"gravity_in_time\": { \"amplitude\": [1, 0] }", &err), TOBI_INVALID,
            "gravity in time has an amplitude without a period");
    REFUSED(parse("\"central_force\": { \"centre\": [0, 0] }", &err), TOBI_INVALID, "rate");
    REFUSED(parse("\"damping_zones\": 3", &err), TOBI_INVALID, "list [ { ... } ] of 16 zones at most");
    REFUSED(parse("\"damping_zones\": [ { \"box\": { \"min\": [0, 0], \"max\": [1, 1] }, \"rate\": -1 } ]",
                  &err), TOBI_INVALID, "s.json:4:");
    REFUSED(parse("\"gravity_in_time\": { \"period\": -1 }", &err), TOBI_INVALID, "s.json:4");
    write_file("bend.lua", "function deform(x, y, z, t) return x, y*(1 + t), z end");
    REFUSED(parse("\"frame\": { \"script\": \"bend.lua\" }", &err), TOBI_INVALID, "changes its shape");
    unlink("bend.lua");
}

/* With the key of the scene that is to blame. */
static void refuse_frame(const char *frame, const char *walls, const char *words)
{
    char text[1200];
    tobi_error err = { 0 };
    tobi_scene *scene;
    tobi_world *w = NULL;
    snprintf(text, sizeof text, "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1]%s }, "
             "\"spacing\": 0.1, \"end_time\": 1, \"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"box\": "
             "{ \"min\": [0, 0, 0], \"max\": [1, 1, 0.5] } } ] } ], \"frame\": { %s } }", walls, frame);
    OK(tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, NULL, &err));
    tobi_status status = tobi_scene_build(scene, &w, &err);
    if (status == TOBI_OK) status = tobi_world_start(w, &err);
    if ((status == TOBI_OK) != !words) fail_msg("%s: %s", frame, status == TOBI_OK ? "accepted" : err.text);
    if (words && (!strstr(err.text, words) || strcmp(err.key, "frame") != 0))
        fail_msg("%s: %s", err.key, err.text);
    tobi_world_destroy(w);
    tobi_scene_free(scene);
}

/* The field is that of a frame, whose turn a periodic axis does not know, and no piston hears it. */
static void frames_that_nothing_could_follow(void **state)
{
    static const char periodic[] = ", \"walls\": { \"x\": \"periodic\" }";
    static const char swing[] = "{ \"amplitude\": 2, \"period\": 1, \"ramp\": 1 }";
    char text[200];
    (void)state;
    for (int a = 0; a < 3; a++) {
        snprintf(text, sizeof text, "\"%s\": %s", (const char *[]){ "roll", "pitch", "yaw" }[a], swing);
        refuse_frame(text, periodic, a ? "turns the axis x, along which the domain is periodic" : NULL);
        refuse_frame(text, "", NULL);
    }
    refuse_frame("\"surge\": { \"amplitude\": 0.01, \"period\": 1 }", periodic, NULL);
    refuse_frame("\"piston\": { \"depth\": 0.5, \"absorb\": true }", "", "a frame absorbs no waves");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_that_no_tank_bears_are_noted),
        cmocka_unit_test(a_turn_at_once_is_noted),
        cmocka_unit_test(bad_gravity_is_refused),
        cmocka_unit_test(gravity_follows_table_and_swing),
        cmocka_unit_test(central_force_points_to_a_place),
        cmocka_unit_test(central_force_jumps_nowhere),
        cmocka_unit_test(frames_make_fictitious_forces),
        cmocka_unit_test(bodies_feel_the_frame),
        cmocka_unit_test(bad_frames_are_refused),
        cmocka_unit_test(frames_that_nothing_could_follow),
        cmocka_unit_test(every_method_follows),
        cmocka_unit_test(zones_damp_velocities),
        cmocka_unit_test(bad_zones_are_refused),
        cmocka_unit_test(scenes_say_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Bodies that are absent: a gate holds water, is taken away at once, and what follows is a dam break; a body
   that comes back; a restart in between; what is refused. */
#include "tobiuo/motion.h"
#include "tobiuo/tobiuo.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define D 0.01

/* A column 0.2 m high, m wide as given, in a tank 0.6 m long. */
static tobi_world *make_tank(const char *method, double width)
{
    tobi_error err;
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    w.method = method;
    w.dimension = 2;
    w.spacing = D;
    w.domain_max[0] = 0.6; w.domain_max[1] = 0.3;
    w.gravity[1] = -9.81; w.gravity[2] = 0;
    w.end_time = 1;
    assert_int_equal(tobi_world_create(&w, NULL, &world, &err), TOBI_OK);
    tobi_fluid_def f = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    fill.box_max[0] = width; fill.box_max[1] = 0.2;
    assert_int_equal(tobi_world_add_fluid(world, &f, &fill, 1, &err), TOBI_OK);
    return world;
}

static tobi_body_def make_gate(double from, double until)
{
    tobi_body_def b = tobi_default_body_def();
    b.name = "gate";
    b.box_min[0] = 0.1; b.box_max[0] = 0.13; b.box_max[1] = 0.28;
    b.box_min[2] = -0.1; b.box_max[2] = 0.1;
    b.absent_from = from;
    b.absent_until = until;
    return b;
}

static void advance(tobi_world *world, double t)
{
    tobi_error err;
    if (tobi_world_advance(world, t, NULL, &err) != TOBI_OK) fail_msg("%s", err.text);
}

static double find_front(tobi_world *world)
{
    tobi_error err;
    const int64_t n = tobi_world_count(world, TOBI_FLUID);
    double (*x)[3] = malloc((size_t)n*sizeof *x), front = 0;
    assert_int_equal(tobi_world_read(world, TOBI_FLUID, "position", x[0], n, &err), TOBI_OK);
    for (int64_t i = 0; i < n; i++) front = fmax(front, x[i][0]);
    free(x);
    return front;
}

static int64_t count_triangles(tobi_world *world)
{
    int64_t vertices, triangles;
    const double (*vertex)[3];
    const int32_t (*triangle)[3];
    assert_int_equal(tobi_world_surface(world, 0, &vertices, &vertex, &triangles, &triangle), TOBI_OK);
    assert_int_equal(vertices == 0, triangles == 0);
    return triangles;
}

/* The front after the gate is where that of a dam without one is, to a spacing and a half. */
static void a_gate_is_taken_away(void **state)
{
    (void)state;
    static const char *const methods[] = { "dfsph", "isph", "wcsph" };
    for (int k = 0; k < 3; k++) {
        tobi_error err;
        tobi_body_info info;
        tobi_world *dam = make_tank(methods[k], 0.1);
        tobi_world *world = make_tank(methods[k], 0.1);
        const tobi_body_def gate = make_gate(0.1, 0);
        assert_int_equal(tobi_world_add_body(world, &gate, &err), TOBI_OK);
        advance(world, 0.095);
        assert_true(find_front(world) < 0.1);
        assert_true(count_triangles(world) > 0);
        assert_int_equal(tobi_world_body(world, 0, &info), TOBI_OK);
        const double force = 0.5*1000*9.81*0.2*0.2;
        print_message("%s: force on the gate %.1f N/m, by statics %.1f\n", methods[k], info.pressure_force[0],
                      force);
        assert_true(fabs(info.pressure_force[0]/force - 1) < 0.15);
        advance(world, 0.25);
        advance(dam, 0.15);
        assert_int_equal(count_triangles(world), 0);
        assert_int_equal(tobi_world_body(world, 0, &info), TOBI_OK);
        for (int a = 0; a < 3; a++) assert_true(info.pressure_force[a] == 0);
        print_message("%s: front at %.4f m, without a gate %.4f\n", methods[k], find_front(world),
                      find_front(dam));
        assert_true(fabs(find_front(world) - find_front(dam)) < 1.5*D && find_front(dam) > 0.18);
        tobi_world_destroy(dam);
        tobi_world_destroy(world);
    }
}

/* With a motion: where it would be by now. No particle stays inside. */
static void a_body_comes_back(void **state)
{
    (void)state;
    tobi_error err;
    tobi_motion *motion;
    tobi_world *world = make_tank("dfsph", 0.1);
    tobi_body_def gate = make_gate(0.02, 0.1);
    assert_int_equal(tobi_motion_translation((double[3]){ 1, 0, 0 }, &motion, &err), TOBI_OK);
    gate.motion = tobi_motion_positions;
    gate.motion_user = motion;
    gate.motion_rigid = 1;
    assert_int_equal(tobi_world_add_body(world, &gate, &err), TOBI_OK);
    advance(world, 0.05);
    assert_int_equal(count_triangles(world), 0);
    advance(world, 0.12);
    int64_t vertices, triangles;
    const double (*vertex)[3];
    const int32_t (*triangle)[3];
    assert_int_equal(tobi_world_surface(world, 0, &vertices, &vertex, &triangles, &triangle), TOBI_OK);
    double least = 1;
    for (int64_t i = 0; i < vertices; i++) least = fmin(least, vertex[i][0]);
    assert_true(vertices > 0 && fabs(least - 0.22) < 1e-9);
    tobi_world_destroy(world);
    tobi_motion_free(motion);
}

/* A thick body, or a vessel's walls, in liquid at once: dfsph finds room for what it pushes out; where a run
   ends instead, it says why. */
static void a_thick_body_comes_back_into_water(void **state)
{
    (void)state;
    static const char *const methods[] = { "dfsph", "isph", "wcsph" };
    for (int k = 0; k < 3; k++) {
        tobi_error err = { 0 };
        tobi_world *world = make_tank(methods[k], 0.6);
        tobi_body_def b = make_gate(0.05, 0.15);
        b.name = "block";
        b.box_min[0] = 0.3; b.box_max[0] = 0.4; b.box_min[1] = 0.05;
        assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_OK);
        const tobi_status status = tobi_world_advance(world, 0.2, NULL, &err);
        print_message("%s: %s\n", methods[k], status == TOBI_OK ? "goes on" : err.text);
        if (k == 0) assert_int_equal(status, TOBI_OK);
        else if (status != TOBI_OK)
            assert_non_null(strstr(err.text, "Body 'block' has just come back, and the liquid in it was "
                                             "pushed out at once"));
        tobi_world_destroy(world);
    }
}

/* Solids are not pushed out of a body that comes back, and who has some is told; so is who has a
   body thicker than two spacings that comes back into liquid. */
static void what_comes_back_is_told(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        tobi_error err;
        tobi_world *world = make_tank("dfsph", 0.1);
        tobi_solid_def s = tobi_default_solid_def();
        tobi_fill_def fill = tobi_default_fill_def();
        int told = 0, thrown = 0;
        s.name = "jelly";
        fill.box_min[0] = 0.2; fill.box_max[0] = 0.3; fill.box_max[1] = 0.1;
        tobi_body_def gate = make_gate(0.1, k == 1 ? 0 : 0.2);
        if (k == 3) gate.box_max[0] = gate.box_min[0] + 2*D;
        if (k < 2) assert_int_equal(tobi_world_add_solid(world, &s, &fill, 1, &err), TOBI_OK);
        assert_int_equal(tobi_world_add_body(world, &gate, &err), TOBI_OK);
        assert_int_equal(tobi_world_start(world, &err), TOBI_OK);
        for (int n = 0; tobi_world_note(world, n); n++)
            told += strstr(tobi_world_note(world, n), "comes back at 0.2 s: a solid that lies in it") != NULL;
        for (int n = 0; tobi_world_note(world, n); n++)
            thrown += strstr(tobi_world_note(world, n), "comes back at 0.2 s: liquid that lies in it then is "
                             "thrown about") != NULL;
        assert_int_equal(told, k == 0);
        assert_int_equal(thrown, k == 0 || k == 2);
        tobi_world_destroy(world);
    }
}

/* A block that rests on a shelf falls when the shelf is taken away, and lies on the floor. */
static void a_shelf_is_taken_away(void **state)
{
    (void)state;
    tobi_error err;
    tobi_body_info info;
    tobi_world *world = make_tank("dfsph", 0.1);
    tobi_body_def shelf = make_gate(0.05, 0), wall = make_gate(0, 0), block = make_gate(0, 0);
    shelf.name = "shelf";
    shelf.box_min[0] = 0.3; shelf.box_max[0] = 0.4; shelf.box_min[1] = 0.05; shelf.box_max[1] = 0.1;
    block.name = "block";
    block.box_min[0] = 0.33; block.box_max[0] = 0.37; block.box_min[1] = 0.1; block.box_max[1] = 0.14;
    block.dynamics = TOBI_FREE;
    wall.name = "wall";
    assert_int_equal(tobi_world_add_body(world, &shelf, &err), TOBI_OK);
    assert_int_equal(tobi_world_add_body(world, &block, &err), TOBI_OK);
    assert_int_equal(tobi_world_add_body(world, &wall, &err), TOBI_OK);
    advance(world, 0.05);
    assert_int_equal(tobi_world_body(world, 1, &info), TOBI_OK);
    print_message("rests at %.5f m\n", info.position[1]);
    assert_true(fabs(info.position[1] - 0.12) < 0.1*D);
    advance(world, 0.15);
    assert_int_equal(tobi_world_body(world, 1, &info), TOBI_OK);
    const double fall = 0.12 - info.position[1];
    print_message("fell %.4f m, freely %.4f\n", fall, 0.5*9.81*0.1*0.1);
    assert_true(fabs(fall - 0.5*9.81*0.1*0.1) < 0.3*D);
    tobi_world_destroy(world);
}

/* A run that was stored and loaded, before, while and after the gate is absent, ends in the same bits. */
static void a_restart_is_the_same(void **state)
{
    (void)state;
    static const double stops[] = { 0.03, 0.06, 0.1 };
    for (int moves = 0; moves < 2; moves++) {
        tobi_error err;
        tobi_motion *motion;
        tobi_body_def gate = make_gate(0.05, 0.08);
        assert_int_equal(tobi_motion_translation((double[3]){ 0.1, 0, 0 }, &motion, &err), TOBI_OK);
        if (moves) gate.motion = tobi_motion_positions;
        gate.motion_user = motion;
        gate.motion_rigid = 1;
        tobi_world *world = make_tank("dfsph", 0.1), *second;
        assert_int_equal(tobi_world_add_body(world, &gate, &err), TOBI_OK);
        for (int k = 0; k < 3; k++) {
            char path[64];
            snprintf(path, sizeof path, "absence_%d.h5", (int)getpid());
            advance(world, stops[k]);
            assert_int_equal(tobi_world_save(world, path, &err), TOBI_OK);
            second = make_tank("dfsph", 0.1);
            assert_int_equal(tobi_world_add_body(second, &gate, &err), TOBI_OK);
            if (tobi_world_load(second, path, &err) != TOBI_OK) fail_msg("%s", err.text);
            unlink(path);
            tobi_world_destroy(world);
            world = second;
        }
        advance(world, 0.12);
        const uint64_t hash = tobi_world_hash(world);
        tobi_world_destroy(world);
        world = make_tank("dfsph", 0.1);
        assert_int_equal(tobi_world_add_body(world, &gate, &err), TOBI_OK);
        for (int k = 0; k < 3; k++) advance(world, stops[k]);
        advance(world, 0.12);
        assert_true(tobi_world_hash(world) == hash);
        tobi_world_destroy(world);
        tobi_motion_free(motion);
    }
}

static void refuse(tobi_world *world, const tobi_body_def *b, const char *text)
{
    tobi_error err = { 0 };
    assert_true(tobi_world_add_body(world, b, &err) != TOBI_OK);
    if (!strstr(err.text, text)) fail_msg("<%s>, expected <%s>", err.text, text);
}

static void what_cannot_be_absent_is_refused(void **state)
{
    (void)state;
    tobi_error err;
    tobi_world *world = make_tank("dfsph", 0.1);
    tobi_body_def b = make_gate(0.2, 0.1);
    refuse(world, &b, "is absent from 0.2 s until 0.1 s; the second must be later");
    b = make_gate(0, 0.1);
    refuse(world, &b, "is absent until 0.1 s, and absent.from does not say from when; it is there at");
    b = make_gate(0.2, 0);
    b.dynamics = TOBI_FREE;
    refuse(world, &b, "only a prescribed body can be absent");
    tobi_world_destroy(world);
    b = make_gate(0.2, 0);
    tobi_world_def w = tobi_default_world_def();
    w.dimension = 2;
    w.spacing = D;
    for (int a = 0; a < 2; a++) w.domain_max[a] = 0.3;
    for (int a = 0; a < 2; a++) w.wall_min[a] = w.wall_max[a] = TOBI_WALL_PERIODIC;
    w.gravity[2] = 0;
    assert_int_equal(tobi_world_create(&w, NULL, &world, &err), TOBI_OK);
    refuse(world, &b, "periodic along all axes");
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_gate_is_taken_away),
        cmocka_unit_test(a_body_comes_back),
        cmocka_unit_test(a_thick_body_comes_back_into_water),
        cmocka_unit_test(what_comes_back_is_told),
        cmocka_unit_test(a_shelf_is_taken_away),
        cmocka_unit_test(a_restart_is_the_same),
        cmocka_unit_test(what_cannot_be_absent_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Bodies with a motion after a restart in a world made anew: everything of them, to the last bit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>
#include <unistd.h>
#include "calls.h"
#include "world/world.h"

static const double WIDTH = 0.1;

/* Turns about the middle of the rest pose while it shakes. */
static tobi_status stir(void *user, double t, int64_t count, const double (*rest)[3], double (*out)[3],
                        tobi_error *err)
{
    const double c = cos(40*t), s = sin(40*t), shift = 0.02*sin(90*t);
    (void)user;
    (void)err;
    for (int64_t i = 0; i < count; i++) {
        const double x = rest[i][0] - 0.5*WIDTH, y = rest[i][1] - 0.05;
        out[i][0] = 0.5*WIDTH + c*x - s*y + shift;
        out[i][1] = 0.05 + s*x + c*y;
        out[i][2] = rest[i][2];
    }
    return TOBI_OK;
}

static void add_material(tobi_world *world, const char *method)
{
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_solid_def solid = tobi_default_solid_def();
    fill.box_max[0] = WIDTH;
    fill.box_max[1] = 0.06;
    fluid.name = "water";
    solid.density = 1000;
    solid.youngs_modulus = 1e4;
    if (strcmp(method, "mlsmpm") == 0) OK(tobi_world_add_solid(world, &solid, &fill, 1, &err));
    else OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
}

static tobi_world *make_world(const char *method, int rigid)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_body_def body = tobi_default_body_def();
    tobi_world *world;
    w.method = method;
    w.dimension = 2;
    w.domain_max[0] = w.domain_max[1] = WIDTH;
    w.domain_max[2] = w.gravity[2] = 0;
    w.gravity[1] = -9.81;
    w.spacing = 0.005;
    w.time_step_max = 2e-4;
    w.threads = 1;
    body.name = "rod";
    body.box_min[0] = 0.035;
    body.box_max[0] = 0.065;
    body.box_min[1] = 0.045;
    body.box_max[1] = 0.055;
    body.motion = stir;
    body.motion_rigid = rigid;
    OK(tobi_world_create(&w, NULL, &world, &err));
    add_material(world, method);
    OK(tobi_world_add_body(world, &body, &err));
    OK(tobi_world_start(world, &err));
    return world;
}

static void assert_same_body(const tobi_body *a, const tobi_body *b)
{
    assert_int_equal(a->mesh.vertex_count, b->mesh.vertex_count);
    assert_true(memcmp(a->vertex, b->vertex, (size_t)a->mesh.vertex_count*sizeof *a->vertex) == 0);
    assert_true(memcmp(TOBI_RIGID_STATE(&a->rigid), TOBI_RIGID_STATE(&b->rigid),
                       TOBI_RIGID_DOUBLES*sizeof(double)) == 0);
    assert_true(memcmp(&a->info, &b->info, sizeof a->info) == 0);
}

/* From output to output, at each into a world made anew. */
static void hand_on(const char *method, int rigid)
{
    char path[] = "/tmp/tobiuo_restart_XXXXXX";
    close(mkstemp(path));
    tobi_world *whole = make_world(method, rigid), *part = make_world(method, rigid);
    for (int output = 1; output <= 3; output++) {
        OK(tobi_world_advance(whole, 0.0037*output, NULL, &err));
        OK(tobi_world_advance(part, 0.0037*output, NULL, &err));
        assert_same_body(&whole->sim.bodies[0], &part->sim.bodies[0]);
        assert_true(tobi_world_hash(whole) == tobi_world_hash(part));
        OK(tobi_world_save(part, path, &err));
        tobi_world_destroy(part);
        part = make_world(method, rigid);
        OK(tobi_world_load(part, path, &err));
        assert_same_body(&whole->sim.bodies[0], &part->sim.bodies[0]);
    }
    unlink(path);
    tobi_world_destroy(whole);
    tobi_world_destroy(part);
}

static void bodies_go_on(void **state)
{
    (void)state;
    const char *const methods[] = { "dfsph", "wcsph", "mlsmpm" };
    for (int k = 0; k < 3; k++)
        for (int rigid = 0; rigid < 2; rigid++) hand_on(methods[k], rigid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_go_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

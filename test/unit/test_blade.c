/* The edge that a body gets, and what a blade is refused for. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "calls.h"
#include "world/world.h"

static const char wedge_mesh[] = TOBI_SOURCE_DIR "/test/meshes/wedge.obj";

static tobi_world *make_world(const char *method, int dimension)
{
    tobi_world *world;
    tobi_world_def def = tobi_default_world_def();
    def.method = method;
    def.dimension = dimension;
    for (int a = 0; a < 3; a++) {
        def.domain_min[a] = -1;
        def.domain_max[a] = 1;
    }
    def.spacing = 0.05;
    def.end_time = 1;
    def.threads = 1;
    OK(tobi_world_create(&def, NULL, &world, &err));
    return world;
}

/* A ramp of 1 x 0.5 x 0.5 m with its sharp edge, 26.6 degrees, along y at x = z = 0, moved up. */
static tobi_body_def make_blade(void)
{
    tobi_body_def def = tobi_default_body_def();
    def.name = "knife";
    def.mesh = wedge_mesh;
    def.scale[0] = 0.5;
    def.translation[2] = 0.2;
    def.scale[2] = 0.5;
    def.blade = 1;
    return def;
}

static void found_in_the_mesh(void **state)
{
    (void)state;
    tobi_world *world = make_world("mlsmpm", 3);
    tobi_body_def def = make_blade();
    OK(tobi_world_add_body(world, &def, &err));
    const tobi_body *b = &world->sim.bodies[0];
    assert_int_equal(b->edge_count, 1);
    for (int a = 0; a < 3; a++) {
        double end[3] = { 0, b->edge[0].a[1] + b->rest.centre[1] > 0.25 ? 0.5 : 0, 0.2 };
        assert_true(fabs(b->edge[0].a[a] + b->rest.centre[a] - end[a]) < 1e-9);
        assert_true(fabs(b->edge[0].b[a] + b->rest.centre[a] - (a == 1 ? 0.5 - end[1] : end[a])) < 1e-9);
    }
    const double half = 0.5*atan(0.5);
    assert_true(fabs(b->edge[0].ahead[0] + cos(half)) < 1e-9 && fabs(b->edge[0].ahead[2] + sin(half)) < 1e-9);
    def.blade = 0;
    def.name = "blunt";
    OK(tobi_world_add_body(world, &def, &err));
    assert_int_equal(world->sim.bodies[1].edge_count, 0);
    tobi_world_destroy(world);
}

static void given(void **state)
{
    (void)state;
    tobi_world *world = make_world("mlsmpm", 3);
    tobi_body_def def = make_blade();
    def.edge_start[0] = -0.1;
    def.edge_end[1] = 0.5;
    OK(tobi_world_add_body(world, &def, &err));
    const tobi_body *b = &world->sim.bodies[0];
    assert_int_equal(b->edge_count, 1);
    assert_true(fabs(b->edge[0].a[0] + b->rest.centre[0] + 0.1) < 1e-12);
    assert_true(fabs(b->edge[0].b[1] + b->rest.centre[1] - 0.5) < 1e-12);
    for (int a = 0; a < 3; a++) assert_true(b->edge[0].ahead[a] == 0);

    def.edge_end[1] = 1.2;
    REFUSED(tobi_world_add_body(world, &def, &err), TOBI_INVALID,
            "body 'knife': edge_end lies at y = 1.2 m, farther from the body (0 to 0.5 m) than its "
            "size of 0.5 m; an edge belongs to its body");
    memcpy(def.edge_end, def.edge_start, sizeof def.edge_end);
    REFUSED(tobi_world_add_body(world, &def, &err), TOBI_INVALID,
            "edge_start and edge_end are the same point");
    tobi_world_destroy(world);

    world = make_world("mlsmpm", 2);
    def.mesh = NULL;
    def.box_min[0] = def.box_min[1] = 0.1;
    def.box_max[0] = def.box_max[1] = 0.3;
    def.translation[2] = 0;
    OK(tobi_world_add_body(world, &def, &err));
    b = &world->sim.bodies[0];
    assert_true(fabs(b->edge[0].a[2] + 0.5) < 1e-12 && fabs(b->edge[0].b[2] - 0.5) < 1e-12);
    assert_true(fabs(b->edge[0].a[0] + b->rest.centre[0] + 0.1) < 1e-12);
    tobi_world_destroy(world);
}

static tobi_status waver(void *user, double t, int64_t count, const double (*rest)[3], double (*out)[3],
                          tobi_error *err)
{
    (void)user; (void)t; (void)err;
    memcpy(out, rest, (size_t)count*sizeof *out);
    return TOBI_OK;
}

static void refused(void **state)
{
    (void)state;
    tobi_world *world = make_world("mlsmpm", 3), *water = make_world("dfsph", 3);
    tobi_body_def def = make_blade();
    REFUSED(tobi_world_add_body(water, &def, &err), TOBI_UNSUPPORTED,
            "body 'knife' is a blade, which the method dfsph does not know; blades cut solids of mlsmpm");
    tobi_world_destroy(water);
    def.edge_angle = 20;
    REFUSED(tobi_world_add_body(world, &def, &err), TOBI_INVALID,
            "body 'knife' is a blade without an edge: its faces meet at 26.6 degrees at the sharpest, "
            "edge_angle allows 20;");
    def.edge_angle = 130;
    REFUSED(tobi_world_add_body(world, &def, &err), TOBI_INVALID, "edge_angle");
    def.edge_angle = 60;
    def.edge_resistance = -1;
    REFUSED(tobi_world_add_body(world, &def, &err), TOBI_INVALID, "edge_resistance");
    def.edge_resistance = 250;
    def.motion = waver;
    REFUSED(tobi_world_add_body(world, &def, &err), TOBI_UNSUPPORTED,
            "body 'knife' is a blade, but its motion changes its shape; a blade is rigid");
    tobi_world_destroy(world);
}

/* A blade thinner than the spacing, wherever it stands among the particles. */
static void starts_inside(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        tobi_world *world = make_world("mlsmpm", 3);
        tobi_solid_def solid = tobi_default_solid_def();
        tobi_fill_def fill = tobi_default_fill_def();
        tobi_body_def def = make_blade();
        solid.name = "apple";
        for (int a = 0; a < 3; a++) {
            fill.box_min[a] = -0.5;
            fill.box_max[a] = 0.5;
        }
        def.mesh = NULL;
        def.translation[2] = 0;
        for (int a = 0; a < 3; a++) def.scale[a] = 1;
        def.box_min[0] = 0.0125*k;
        def.box_max[0] = 0.0125*k + 0.026;
        def.box_min[1] = def.box_min[2] = -0.2;
        def.box_max[1] = def.box_max[2] = 0.2;
        def.edge_start[1] = -0.2;
        def.edge_end[1] = 0.2;
        OK(tobi_world_add_solid(world, &solid, &fill, 1, &err));
        OK(tobi_world_add_body(world, &def, &err));
        REFUSED(tobi_world_start(world, &err), TOBI_INVALID,
                "body 'knife' is a blade and starts inside solid 'apple': ");
        tobi_world_destroy(world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(found_in_the_mesh), cmocka_unit_test(given),
        cmocka_unit_test(refused), cmocka_unit_test(starts_inside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Bodies by words: volume, mass, centre and inertia against the formulas of the shapes, in 3-D and 2-D; what
   is refused. */
#include "tobiuo/scene.h"
#include "tobiuo/tobiuo.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "empty_world.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void set(double out[3], double x, double y, double z) { out[0] = x, out[1] = y, out[2] = z; }

static tobi_body_info add(tobi_world *world, const tobi_body_def *def)
{
    tobi_error err;
    tobi_body_info info;
    if (tobi_world_add_body(world, def, &err) != TOBI_OK) fail_msg("%s", err.text);
    assert_int_equal(tobi_world_body(world, tobi_world_body_count(world) - 1, &info), TOBI_OK);
    return info;
}

/* Volume to rounding; inertia, of which the axis is z: within `most`. */
static void expect(const char *what, const tobi_body_info *info, double volume, double across, double about,
                   double most)
{
    const double mass = 2000*volume;
    print_message("%-8s volume %+.1e, inertia %+.5f %+.5f\n", what, info->volume/volume - 1,
                  info->inertia[0]/(mass*across) - 1, info->inertia[8]/(mass*about) - 1);
    assert_true(fabs(info->volume/volume - 1) < 1e-12 && fabs(info->mass/mass - 1) < 1e-12);
    assert_true(fabs(info->inertia[0]/(mass*across) - 1) < most);
    assert_true(fabs(info->inertia[4]/(mass*across) - 1) < most);
    assert_true(fabs(info->inertia[8]/(mass*about) - 1) < most);
    for (int k = 1; k < 8; k++)
        assert_true(k == 4 || fabs(info->inertia[k]) < 1e-6*info->inertia[8]);
}

/* From 4 to 16 spacings across. */
static void shapes_have_their_volume_and_inertia(void **state)
{
    (void)state;
    const double r = 0.1, l = 0.3, ball = 4*M_PI/3*r*r*r, rod = M_PI*r*r*l;
    for (double spacing = 0.05; spacing > 0.01; spacing /= 2) {
        tobi_world *world = make_empty_world(3, spacing, 1);
        tobi_body_def b = tobi_default_body_def();
        b.density = 2000;
        b.name = "sphere";
        set(b.sphere_centre, 0.3, 0.4, 0.5);
        b.sphere_radius = r;
        tobi_body_info info = add(world, &b);
        expect("sphere", &info, ball, 0.4*r*r, 0.4*r*r, 0.001);
        assert_true(fabs(info.position[0] - 0.3) < 1e-12 && fabs(info.position[2] - 0.5) < 1e-12);
        b.sphere_radius = 0;
        b.name = "cylinder";
        set(b.cylinder_start, 0.5, 0.5, 0.2);
        set(b.cylinder_end, 0.5, 0.5, 0.2 + l);
        b.cylinder_radius = r;
        info = add(world, &b);
        expect("cylinder", &info, rod, r*r/4 + l*l/12, r*r/2, 0.001);
        b.cylinder_radius = 0;
        b.name = "capsule";
        set(b.capsule_start, 0.5, 0.5, 0.2);
        set(b.capsule_end, 0.5, 0.5, 0.2 + l);
        b.capsule_radius = r;
        info = add(world, &b);
        expect("capsule", &info, rod + ball,
               (rod*(r*r/4 + l*l/12) + ball*(0.4*r*r + l*l/4 + 3*l*r/8))/(rod + ball),
               (rod*r*r/2 + ball*0.4*r*r)/(rod + ball), 0.004);
        b.capsule_radius = 0;
        b.name = "plate";
        set(b.plate_centre, 0.5, 0.5, 0.5);
        set(b.plate_normal, 0, 0, 2);
        set(b.plate_along, 1, 1, 5);
        b.plate_length = b.plate_width = 0.2;
        b.plate_thickness = 0.02;
        info = add(world, &b);
        expect("plate", &info, 0.2*0.2*0.02, (0.2*0.2 + 0.02*0.02)/12, 0.2*0.2/6, 1e-9);
        b.plate_thickness = 0;
        b.name = "knife";
        set(b.knife_edge, 0.5, 0.5, 0.1);
        set(b.knife_along, 1, 1, 3);
        b.knife_length = 0.2, b.knife_height = 0.3, b.knife_thickness = 0.02;
        b.knife_angle = 53.13010235415598;
        info = add(world, &b);             /* its bevel is as high as it is thick */
        assert_true(fabs(info.volume/(0.2*0.02*(0.3 - 0.01)) - 1) < 1e-9);
        assert_true(fabs(info.position[2] - 0.1 - (0.01*0.04/3 + 0.28*0.16)/0.29) < 1e-9);
        tobi_world_destroy(world);
    }
}

/* Turned: an oblique cylinder has the same moments about its axis. */
static void shapes_lie_along_their_axes(void **state)
{
    (void)state;
    tobi_world *world = make_empty_world(3, 0.05, 1);
    tobi_body_def b = tobi_default_body_def();
    const double r = 0.1, l = 0.3, n[3] = { 2.0/3, 1.0/3, 2.0/3 }, mass = 1000*M_PI*r*r*l;
    set(b.cylinder_start, 0.2, 0.3, 0.2);
    set(b.cylinder_end, 0.2 + l*n[0], 0.3 + l*n[1], 0.2 + l*n[2]);
    b.cylinder_radius = r;
    const tobi_body_info info = add(world, &b);
    double about = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) about += n[i]*n[j]*info.inertia[3*i + j];
    assert_true(fabs(about/(mass*r*r/2) - 1) < 0.001);
    for (int a = 0; a < 3; a++)
        assert_true(fabs(info.position[a] - 0.5*(b.cylinder_start[a] + b.cylinder_end[a])) < 1e-12);
    tobi_world_destroy(world);
}

static void two_dimensions_have_discs_and_plates(void **state)
{
    (void)state;
    tobi_world *world = make_empty_world(2, 0.05, 1);
    tobi_body_def b = tobi_default_body_def();
    set(b.sphere_centre, 0.3, 0.4, 0);
    b.sphere_radius = 0.1;
    tobi_body_info info = add(world, &b);
    int64_t vertices, triangles;
    const double (*vertex)[3];
    const int32_t (*triangle)[3];
    assert_int_equal(tobi_world_surface(world, 0, &vertices, &vertex, &triangles, &triangle), TOBI_OK);
    assert_true(triangles <= 6*24);          /* results have them in each output */
    assert_true(fabs(info.volume/(M_PI*0.01) - 1) < 1e-12);
    assert_true(fabs(info.inertia[8]/(1000*M_PI*0.01*0.005) - 1) < 0.001);
    b.sphere_radius = 0;
    b.name = "plate";
    set(b.plate_centre, 0.5, 0.5, 0);
    set(b.plate_normal, 1, 1, 0);
    b.plate_length = 0.4;
    b.plate_thickness = 0.05;
    info = add(world, &b);
    assert_true(fabs(info.volume/0.02 - 1) < 1e-12);
    assert_true(fabs(info.inertia[8]/(20*(0.4*0.4 + 0.05*0.05)/12) - 1) < 1e-9);
    b.plate_thickness = 0;
    b.name = "knife";
    set(b.knife_edge, 0.5, 0.1, 0);
    b.knife_height = 0.3, b.knife_thickness = 0.02, b.knife_angle = 53.13010235415598;
    info = add(world, &b);
    assert_true(fabs(info.volume/(0.02*0.29) - 1) < 1e-9 && info.position[1] > 0.1);
    tobi_world_destroy(world);
}

static void refuse(tobi_world *world, const tobi_body_def *b, const char *text)
{
    tobi_error err = { 0 };
    assert_true(tobi_world_add_body(world, b, &err) != TOBI_OK);
    if (!strstr(err.text, text)) fail_msg("<%s>, expected <%s>", err.text, text);
}

static void bad_shapes_are_refused(void **state)
{
    (void)state;
    tobi_world *world = make_empty_world(3, 0.05, 1), *flat = make_empty_world(2, 0.05, 1);
    tobi_body_def b = tobi_default_body_def();
    b.cylinder_radius = 0.1;
    refuse(world, &b, "its cylinder has no length");
    refuse(flat, &b, "a 2-D scene has no cylinders and capsules");
    b.sphere_radius = 0.1;
    refuse(world, &b, "has 2 shapes; it may have one");
    b = tobi_default_body_def();
    b.plate_thickness = 0.1;
    refuse(world, &b, "its plate is 0 m long and 0 m wide; both must be above 0");
    b.plate_length = b.plate_width = 0.3;
    set(b.plate_centre, 0.5, 0.5, 0.5);
    set(b.plate_along, 0, 0, 1);
    refuse(world, &b, "along and normal of its plate are parallel");
    set(b.plate_normal, 0, 0, 0);
    refuse(world, &b, "the normal of its plate has no direction");
    b = tobi_default_body_def();
    b.knife_thickness = 0.02;
    refuse(world, &b, "its knife is 0 m long and 0 m high; both must be above 0");
    b.knife_length = 0.2, b.knife_height = 0.05;
    refuse(world, &b, "its knife of 0.02 m is 0.05 m high; with faces at 20 degrees it must be higher than "
           "0.05671 m");
    set(b.knife_along, 0, 0, 1);
    refuse(world, &b, "along and direction of its knife are parallel");
    set(b.knife_direction, 0, 0, 0);
    refuse(world, &b, "the direction of its knife has none");
    tobi_world_destroy(world);
    tobi_world_destroy(flat);
}

static void check_scene(const char *body, const char *line)
{
    char text[1000];
    snprintf(text, sizeof text, "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] },\n"
             "\"spacing\": 0.1, "
             "\"end_time\": 1, \"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"box\": {\n"
             "\"min\": [0, 0, 0], \"max\": [1, 1, 0.5] } } ] } ],\n"
             "\"bodies\": [ { \"name\": \"b\", %s } ] }", body);
    tobi_scene *scene = NULL, *again = NULL;
    tobi_report *report = NULL;
    tobi_error err = { 0 };
    const tobi_status status = tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, &report, &err);
    if (line) {
        assert_int_equal(status, TOBI_INVALID);
        if (!strstr(err.text, line)) fail_msg("<%s>, expected <%s>", err.text, line);
    } else {
        if (status != TOBI_OK) fail_msg("%s", err.text);
        char *resolved = tobi_scene_resolved(scene), *twice;
        if (tobi_scene_parse("s.json", resolved, strlen(resolved), NULL, &again, NULL, &err) != TOBI_OK)
            fail_msg("%s", err.text);
        twice = tobi_scene_resolved(again);
        assert_string_equal(resolved, twice);
        free(resolved);
        free(twice);
        tobi_scene_free(again);
    }
    tobi_report_free(report);
    tobi_scene_free(scene);
}

static void scenes_have_shapes(void **state)
{
    (void)state;
    check_scene("\"sphere\": { \"centre\": [0.5, 0.5, 0.7], \"radius\": 0.1 }", NULL);
    check_scene("\"cylinder\": { \"start\": [0.5, 0.5, 0.2], \"end\": [0.5, 0.5, 0.7],\n\"radius\": 0.1 }",
                NULL);
    check_scene("\"capsule\": { \"start\": [0.5, 0.5, 0.3], \"end\": [0.5, 0.5, 0.7],\n\"radius\": 0.1 }",
                NULL);
    check_scene("\"plate\": { \"centre\": [0.5, 0.5, 0.3], \"length\": 0.2, \"width\": 0.1,\n"
                "\"thickness\": 0.02 }", NULL);
    check_scene("\"sphere\": { \"centre\": [0.5, 0.5, 0.7] }", "bodies[0].sphere: must have a radius");
    check_scene("\"density\": 3", "bodies[0]: must have one of mesh, box, sphere, cylinder, capsule");
    check_scene("\"sphere\": { \"radius\": 1 }, \"plate\": { \"thickness\": 1 }", "it has several");
    check_scene("\"outline\": { \"points\": [[0.1, 0.3], [0.9, 0.30000000000000004], [0.5, 1e-1]],\n"
                "\"from\": 0.2, \"to\": 0.4 }", NULL);
    check_scene("\"outline\": { \"points\": [[0.1, 0.3], [0.9, 0.4]], \"base\": 0,\n\"axis\": \"x\", "
                "\"from\": 0.2, \"to\": 0.4 }", NULL);
    check_scene("\"outline\": { \"from\": 0, \"to\": 1 }",
                "outline: must have points or a file");
    check_scene("\"outline\": { \"points\": [[0, 0], [1, 0], [0, 1]] }",
                "outline: goes from 0 to 0 m along its axis; to must be greater than from");
    check_scene("\"outline\": { \"points\": 3, \"to\": 1 }",
                "outline.points: must be a list of points, each a list of 2 numbers");
    check_scene("\"outline\": { \"points\": [[0, 0], [1, 0, 2]], \"to\": 1 }",
                "outline.points[1]: must be a point, a list of 2 numbers");
    check_scene("\"outline\": { \"points\": [[0, 0], [1, 2e7]], \"to\": 1 }",
                "outline.points[1][1]: is 20000000, allowed is -1e+07 to 1e+07 m");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_have_their_volume_and_inertia),
        cmocka_unit_test(shapes_lie_along_their_axes),
        cmocka_unit_test(two_dimensions_have_discs_and_plates),
        cmocka_unit_test(bad_shapes_are_refused),
        cmocka_unit_test(scenes_have_shapes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

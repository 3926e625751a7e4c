/* Porous zones that are cylinders and rings: what lies in them, radial screens in given flows against
   integrals, what is refused, pictures. */
#include "calls.h"
#include "core/porous.h"
#include "tobiuo/drawing.h"
#include "tobiuo/scene.h"
#include "tobiuo/tobiuo.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double CENTRE[3] = { 0.7, 0.58, 0.5 };

/* u = x from the centre, or turned by 90 degrees, in the plane across an axis. */
typedef struct field { int u, v, turns; } field;

static tobi_status flow(void *user, int64_t n, const double (*place)[3], double (*velocity)[3],
                        tobi_error *err)
{
    const field *f = user;
    (void)err;
    for (int64_t k = 0; k < n; k++) {
        const double du = place[k][f->u] - CENTRE[f->u], dv = place[k][f->v] - CENTRE[f->v];
        velocity[k][f->u] = f->turns ? -dv : du;
        velocity[k][f->v] = f->turns ? du : dv;
    }
    return TOBI_OK;
}

/* Full of water from 0.1 m on, as wide around the centre. */
static tobi_world *make_tank(const char *method, int dimension, field *f)
{
    tobi_world_def d = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *w = NULL;
    d.method = method;
    d.dimension = dimension;
    d.spacing = dimension == 2 ? 0.01 : 0.04;
    d.threads = 1;
    d.time_step = 1e-6;
    for (int a = 0; a < 3; a++) {
        d.domain_min[a] = fill.box_min[a] = a < dimension ? 0.1 : 0;
        d.domain_max[a] = fill.box_max[a] = a < dimension ? 2*CENTRE[a] - 0.1 : 0;
        d.gravity[a] = 0;
    }
    if (f) fill.flow = flow, fill.flow_user = f;
    OK(tobi_world_create(&d, NULL, &w, &err));
    OK(tobi_world_add_fluid(w, &fluid, &fill, 1, &err));
    return w;
}

static tobi_porous_def make_ring(double radius, double inner, int axis)
{
    tobi_porous_def z = tobi_default_porous_def();
    z.name = "ring";
    memcpy(z.cylinder_start, CENTRE, sizeof CENTRE);
    memcpy(z.cylinder_end, CENTRE, sizeof CENTRE);
    z.cylinder_start[axis] += 0.12;
    z.cylinder_end[axis] -= 0.2;
    z.cylinder_radius = radius;
    z.cylinder_inner = inner;
    return z;
}

static void places_are_in_it(void **state)
{
    tobi_porous z = { .lower = { 0.2, 0.3, 0 }, .upper = { 0.6, 0.7, 1 }, .centre = { 0.4, 0.5 },
                      .plane = { 0, 1 }, .axis = 2, .radius = 0.2, .inner = 0.1,
                      .corners = (double[1][2]){ { 0 } }, .corner_count = 1 };
    (void)state;
    assert_true(tobi_porous_holds(&z, 3, (double[]){ 0.4, 0.65, 0.5 }));
    assert_true(tobi_porous_holds(&z, 3, (double[]){ 0.5, 0.6, 0 }));
    assert_false(tobi_porous_holds(&z, 3, (double[]){ 0.5, 0.6, 1 }));
    assert_false(tobi_porous_holds(&z, 3, (double[]){ 0.4, 0.59, 0.5 }));
    assert_false(tobi_porous_holds(&z, 3, (double[]){ 0.55, 0.65, 0.5 }));
    z.inner = 0;
    assert_true(tobi_porous_holds(&z, 2, (double[]){ 0.4, 0.5, 0 }));
}

/* The power of a first step, b sum m |u|^3 of the velocity that the zone sees: with u the distance from the
   axis that is 2 pi rho b (R^5 - r^5)/5. A screen sees none of a flow around the axis. */
static void rings_see_what_flows_through(void **state)
{
    const char *const methods[] = { "wcsph", "isph" };
    (void)state;
    for (int m = 0; m < 2; m++)
        for (int axis = m == 0 ? 0 : 2; axis < 3; axis++)
            for (int turns = 0; turns < 2; turns++) {
                const int dimension = m == 0 ? 3 : 2;
                field f = { axis == 0 ? 1 : 0, axis == 2 ? 1 : 2, turns };
                tobi_world *w = make_tank(methods[m], dimension, &f);
                tobi_porous_def z = make_ring(0.36, 0.2, axis);
                tobi_porous_info info;
                z.screen_loss = 3.2;
                OK(tobi_world_add_porous(w, &z, &err));
                OK(tobi_world_step(w, 0, NULL, &err));
                assert_non_null(tobi_world_porous(w, 0, &info));
                const double length = dimension == 3 ? 0.32 : 1;
                const double all = length*2*M_PI*1000*10*(pow(0.36, 5) - pow(0.2, 5))/5;
                assert_true(fabs(info.quadratic - 10) < 1e-9 && info.radial && info.along);
                assert_true(info.direction[axis] == 1);
                assert_true(fabs(info.extent - length*M_PI*(0.36*0.36 - 0.2*0.2)) < 1e-12);
                if (m == 0 && !turns && fabs(info.power/all - 1) > 0.06)
                    fail_msg("axis %d: %g W, not %g", axis, info.power, all);
                if (turns && !(fabs(info.power) < 0.001*all))
                    fail_msg("%s, axis %d: %g W of %g, flow around it", methods[m], axis, info.power, all);
                tobi_world_destroy(w);
            }
}

/* Stones in a disc, which is full inside; stems in a ring stand along its axis and see all of such flows. */
static void contents_without_a_thin_side(void **state)
{
    field f = { 0, 1, 1 };
    tobi_world *w = make_tank("wcsph", 2, &f);
    tobi_porous_def z = make_ring(0.3, 0, 2);
    tobi_porous_info info;
    (void)state;
    z.quadratic = 10;
    OK(tobi_world_add_porous(w, &z, &err));
    z = make_ring(0.45, 0.3, 2);
    z.name = "piles";
    z.stem_number = 200;
    z.stem_diameter = 0.1;
    z.direction[2] = 1;
    OK(tobi_world_add_porous(w, &z, &err));
    OK(tobi_world_step(w, 0, NULL, &err));
    tobi_world_porous(w, 0, &info);
    const double disc = 2*M_PI*1000*10*pow(0.3, 5)/5, ring = 2*M_PI*1000*10*(pow(0.45, 5) - pow(0.3, 5))/5;
    assert_true(fabs(info.power/disc - 1) < 0.03 && !info.radial);
    tobi_world_porous(w, 1, &info);
    assert_true(fabs(info.power/ring - 1) < 0.03);
    tobi_world_destroy(w);
}

/* The net of a cage and its bottom; a flat ring lies across its axis. */
static void cages_have_a_bottom(void **state)
{
    tobi_world *w = make_tank("dfsph", 3, NULL);
    tobi_porous_def net = make_ring(0.36, 0.32, 2), bottom = make_ring(0.36, 0, 2);
    tobi_porous_def flat = make_ring(0.5, 0.4, 2);
    tobi_porous_info info;
    (void)state;
    net.screen_loss = bottom.screen_loss = flat.screen_loss = 2;
    bottom.name = "bottom", flat.name = "flat";
    bottom.cylinder_start[2] = net.cylinder_end[2], bottom.cylinder_end[2] = net.cylinder_end[2] - 0.04;
    flat.cylinder_start[2] = 0.6, flat.cylinder_end[2] = 0.65;
    OK(tobi_world_add_porous(w, &net, &err));
    OK(tobi_world_add_porous(w, &bottom, &err));
    OK(tobi_world_add_porous(w, &flat, &err));
    tobi_world_porous(w, 0, &info);
    assert_true(info.radial && fabs(info.quadratic - 25) < 1e-9);
    for (int k = 1; k < 3; k++) {
        tobi_world_porous(w, k, &info);
        assert_true(!info.radial && info.direction[2] == 1);
        assert_true(fabs(info.quadratic - (k == 1 ? 25 : 20)) < 1e-9);
    }
    tobi_world_destroy(w);
}

static void wrong_cylinders_are_refused(void **state)
{
    tobi_world *w = make_tank("dfsph", 3, NULL), *flat = make_tank("dfsph", 2, NULL);
    tobi_porous_def z = make_ring(0.3, 0.3, 0);
    (void)state;
    z.linear = 1;
    REFUSED(tobi_world_add_porous(w, &z, &err), TOBI_INVALID, "its inner radius is 0.3 m, its radius 0.3 m");
    z = make_ring(0.3, 0.2, 0);
    z.linear = 1;
    z.cylinder_end[1] = 0;
    REFUSED(tobi_world_add_porous(w, &z, &err), TOBI_INVALID, "allowed are cylinders along x, y or z");
    memcpy(z.cylinder_end, z.cylinder_start, sizeof z.cylinder_end);
    REFUSED(tobi_world_add_porous(w, &z, &err), TOBI_INVALID, "allowed are cylinders along x, y or z");
    OK(tobi_world_add_porous(flat, &z, &err));
    z.box_max[0] = 1;
    REFUSED(tobi_world_add_porous(w, &z, &err), TOBI_INVALID, "has 2 shapes; it may have one");
    z = make_ring(0.1, 0, 2);
    z.name = "inside";
    z.linear = 1;
    z.cylinder_start[0] = 5;
    REFUSED(tobi_world_add_porous(flat, &z, &err), TOBI_INVALID, "lies from 4.9 to 5.1 m in x, outside");
    z.cylinder_start[0] = CENTRE[0] + 0.12 + 0.2;
    tobi_error error = { 0 };
    assert_int_equal(tobi_world_add_porous(flat, &z, &error), TOBI_INVALID);
    assert_non_null(strstr(error.text, "the section of porous zone 'inside' overlaps that of 'ring' by 0.0"));
    assert_string_equal(error.key, "cylinder");
    z.cylinder_start[0] = CENTRE[0] + 0.12;
    z.linear = 0;
    z.screen_loss = 1;
    REFUSED(tobi_world_add_porous(flat, &z, &err), TOBI_INVALID, "without an inner radius has no thin side");
    z.direction[0] = 1;
    OK(tobi_world_add_porous(flat, &z, &err));      /* within the ring */
    tobi_world_destroy(w);
    tobi_world_destroy(flat);
}

/* Two circles at both ends and four lines along each. */
static void pictures_have_circles(void **state)
{
    tobi_world *w = make_tank("dfsph", 3, NULL);
    tobi_porous_def z = make_ring(0.3, 0.2, 1);
    tobi_looks looks;
    (void)state;
    z.linear = 1;
    OK(tobi_world_add_porous(w, &z, &err));
    OK(tobi_world_looks(w, &looks, &err));
    assert_int_equal(looks.edge_count, 4*96 + 2*4);
    for (int64_t k = 0; k < looks.edge_count; k++) {
        const double *x = looks.edges[k][0], r = hypot(x[0] - CENTRE[0], x[2] - CENTRE[2]);
        assert_true(fabs(r - 0.3) < 1e-9 || fabs(r - 0.2) < 1e-9);
    }
    tobi_looks_free(&looks);
    tobi_world_destroy(w);
}

static void scene_says(const char *shape, const char *why)
{
    char text[1000];
    tobi_scene *scene = NULL;
    tobi_report *report = NULL;
    tobi_error error = { 0 };
    snprintf(text, sizeof text, "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [1, 1] }, "
             "\"spacing\": 0.1, \"end_time\": 1, \"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"box\": "
             "{ \"min\": [0, 0], \"max\": [1, 0.5] } } ] } ], \"porous_zones\": [ { \"name\": \"a\", "
             "\"stones\": { \"size\": 0.1, \"porosity\": 0.4 }, %s } ] }", shape);
    const tobi_status status = tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, &report, &error);
    if (why) {
        assert_int_not_equal(status, TOBI_OK);
        const char *line = tobi_report_line(report, 0);
        if (!strstr(line, why)) fail_msg("%s: not '%s'", line, why);
        tobi_report_free(report);
        return;
    }
    assert_int_equal(status, TOBI_OK);
    char *resolved = tobi_scene_resolved(scene);
    assert_non_null(strstr(resolved, "\"inner_radius\""));
    assert_null(strstr(strstr(resolved, "\"porous_zones\""), "\"box\""));
    free(resolved);
    tobi_scene_free(scene);
}

static void scenes_say_it(void **state)
{
    (void)state;
    scene_says("\"cylinder\": { \"start\": [0.5, 0.5] }", "porous_zones[0].cylinder: must have a radius");
    scene_says("\"cylinder\": { \"start\": [0.5, 0.5], \"radius\": 0.3, \"inner_radius\": 0.2 }", NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_are_in_it), cmocka_unit_test(rings_see_what_flows_through),
        cmocka_unit_test(contents_without_a_thin_side), cmocka_unit_test(cages_have_a_bottom),
        cmocka_unit_test(wrong_cylinders_are_refused), cmocka_unit_test(pictures_have_circles),
        cmocka_unit_test(scenes_say_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

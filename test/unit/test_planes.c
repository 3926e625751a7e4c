/* Fixed planes in the domain: what is refused, what is cut out, what rests on them. */
#include "rigid_rig.h"
#include "scene/scene.h"
#include "world/world.h"

static const char start[] =
    "{ \"method\": \"mlsmpm\", \"domain\": { \"min\": [-1, -1, -1], \"max\": [1, 1, 1] },\n"
    "\"spacing\": 0.1, \"end_time\": 1, \"solids\": [ { \"name\": \"it\", \"fill\": [\n"
    "{ \"box\": { \"min\": [-0.5, -0.5, -0.5], \"max\": [0.5, 0.5, 0.5] } } ] } ],\n";
static const char flat[] =
    "{ \"method\": \"mlsmpm\", \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [1, 1] },\n"
    "\"spacing\": 0.1, \"end_time\": 1, \"solids\": [ { \"name\": \"it\", \"fill\": [\n"
    "{ \"box\": { \"min\": [0, 0], \"max\": [1, 0.5] } } ] } ],\n";
static const char water[] =
    "{ \"domain\": { \"min\": [-1, -1, -1], \"max\": [1, 1, 1] },\n"
    "\"spacing\": 0.1, \"end_time\": 1, \"fluids\": [ { \"name\": \"it\", \"fill\": [\n"
    "{ \"box\": { \"min\": [-0.5, -0.5, -0.5], \"max\": [0.5, 0.5, 0.5] } } ] } ],\n";

/* The one mistake of a scene with these planes, at this place and with this text in it. */
static void refuse(const char *begin, const char *planes, const char *place, const char *part)
{
    char text[2048];
    tobi_scene *scene;
    tobi_report *report;
    tobi_error err = { 0 };
    snprintf(text, sizeof text, "%s\"planes\": [ %s ] }", begin, planes);
    tobi_status status = tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, &report, &err);
    assert_int_equal(status, TOBI_INVALID);
    if (tobi_report_count(report) != 1 || !strstr(err.text, part) || !strstr(err.text, place))
        fail_msg("%d mistakes: %s\nexpected at %s: %s", tobi_report_count(report), err.text, place, part);
    tobi_report_free(report);
}

static void test_scene_mistakes(void **state)
{
    (void)state;
    const char good[] = "{ \"point\": [0, 0, 0], \"normal\": [0, 0, 1] }";
    char many[1500] = "";
    refuse(start, "{ \"point\": [0, 0, 0], \"normal\": [0, 0, 0] }", "planes[0].normal: ",
           "is zero, must have a direction");
    refuse(start, "{ \"point\": [0, 2, 0], \"normal\": [0, 0, 1] }", "planes[0].point: ",
           "is 2 m in y, the domain reaches from -1 to 1 m");
    refuse(start, "{ \"point\": [0, 0, 0] }", "planes[0].normal: ", "is missing");
    refuse(start, "{ \"point\": [0, 0, 0], \"normal\": [0, 0, 1], \"kind\": \"open\" }", "planes[0].kind: ",
           "allowed is separate, slip or no-slip");
    refuse(start, "{ \"point\": [0, 0, 0], \"normal\": [0, 0, 1], \"friction\": -1 }",
           "planes[0].friction: ", "is -1, allowed is");
    refuse(flat, "{ \"point\": [0, 0], \"normal\": [0, 1, 1] }", "planes[0].normal: ",
           "is 1 in z, must be 0 in a 2-D scene");
    refuse(water, good, "planes: ", "are for solids and bodies of mlsmpm; dfsph knows sides of the domain");
    for (int k = 0; k < TOBI_PLANE_LIMIT + 1; k++) {
        strcat(many, k ? ", " : "");
        strcat(many, good);
    }
    refuse(start, many, "planes: ", "26");
}

static void refuse_plane(tobi_world *w, const tobi_plane_def *def, tobi_status status, const char *words)
{
    tobi_error err = { 0 };
    assert_int_equal(tobi_world_add_plane(w, def, &err), status);
    if (!strstr(err.text, words)) fail_msg("%s without %s", err.text, words);
}

static void test_world_mistakes(void **state)
{
    (void)state;
    tobi_world_def def = tobi_default_world_def();
    tobi_plane_def plane = tobi_default_plane_def();
    tobi_error err = { 0 };
    tobi_world *w;
    def.spacing = 0.1;
    def.domain_max[0] = def.domain_max[1] = def.domain_max[2] = 1;
    for (int dimension = 2; dimension <= 3; dimension++) {
        def.method = "mlsmpm";
        def.dimension = dimension;
        def.gravity[2] = dimension == 2 ? 0 : -9.81;
        assert_int_equal(tobi_world_create(&def, NULL, &w, &err), TOBI_OK);
        memcpy(plane.normal, (double[3]){ 0, 0, 0 }, sizeof plane.normal);
        refuse_plane(w, &plane, TOBI_INVALID, "has no direction");
        memcpy(plane.normal, (double[3]){ 0, 1, dimension == 2 }, sizeof plane.normal);
        if (dimension == 2) refuse_plane(w, &plane, TOBI_INVALID, "has 1 in z, must be 0 in 2-D");
        plane.normal[2] = 0;
        plane.point[1] = 3;
        refuse_plane(w, &plane, TOBI_INVALID, "outside the domain: y = 3 m, allowed is 0 to 1 m");
        plane.point[1] = 0.5;
        for (int k = 0; k < TOBI_PLANE_LIMIT; k++)
            assert_int_equal(tobi_world_add_plane(w, &plane, &err), TOBI_OK);
        refuse_plane(w, &plane, TOBI_UNSUPPORTED, "more than 26 planes");
        tobi_body_def b = tobi_default_body_def();
        for (int a = 0; a < 3; a++) b.box_max[a] = 0.5;
        assert_int_equal(tobi_world_add_body(w, &b, &err), TOBI_OK);
        assert_int_equal(tobi_world_step(w, 0.01, NULL, &err), TOBI_OK);
        refuse_plane(w, &plane, TOBI_INVALID, "a started world takes no more planes");
        tobi_world_destroy(w);
    }
    def.method = "wcsph";
    assert_int_equal(tobi_world_create(&def, NULL, &w, &err), TOBI_OK);
    refuse_plane(w, &plane, TOBI_UNSUPPORTED, "wcsph knows no planes; allowed are sides of the domain");
    tobi_world_destroy(w);
}

/* A scene's planes come back from its resolved form; particles behind them are cut out, and this is said. */
static void test_fill(void **state)
{
    (void)state;
    char text[2048];
    tobi_scene *scene, *again;
    tobi_report *report;
    tobi_error err = { 0 };
    tobi_world *w;
    snprintf(text, sizeof text,
             "%s\"planes\": [ { \"point\": [0, 0.2, -0.2], \"normal\": [0, 0, 5], \"friction\": 0.3 },\n"
             "{ \"point\": [0.3, 0, 0], \"normal\": [-1, 0, 0], \"kind\": \"slip\" } ] }", start);
    if (tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, &report, &err) != TOBI_OK)
        fail_msg("%s", err.text);
    char *resolved = tobi_scene_resolved(scene);
    assert_int_equal(tobi_scene_parse("r.json", resolved, strlen(resolved), NULL, &again, &report, &err),
                     TOBI_OK);
    assert_int_equal(again->plane_count, 2);
    assert_int_equal(memcmp(again->planes, scene->planes, 2*sizeof *scene->planes), 0);
    assert_int_equal(tobi_scene_build(scene, &w, &err), TOBI_OK);
    assert_int_equal(tobi_world_start(w, &err), TOBI_OK);
    assert_int_equal(w->system[0].particles.count, 8*10*7);
    assert_non_null(tobi_world_note(w, 0));
    print_message("%s\n", tobi_world_note(w, 0));
    assert_non_null(strstr(tobi_world_note(w, 0), "440 particles that would start behind planes were cut"));
    for (int64_t i = 0; i < w->system[0].particles.count; i++) {
        tobi_double3 x = w->system[0].particles.position[i];      /* from the domain's lower corner */
        assert_true(x.z - 1 > -0.2 && x.x - 1 < 0.3);
    }
    tobi_world_destroy(w);
    free(resolved);
    tobi_scene_free(scene);
    tobi_scene_free(again);
}

/* A ball in a groove of two planes, a box on one of them: they rest, carried along the normals. */
static void test_groove(void **state)
{
    (void)state;
    rig g;
    const double half = sqrt(0.5);
    tobi_fixed_plane groove[2] = { { .normal = { half, 0, half }, .offset = half*10, .friction = 0.9 },
                                   { .normal = { -half, 0, half }, .kind = TOBI_PLANE_SLIP } };
    rig_open(&g, 10, (double[3]){ 0, 0, -9.81 });
    g.world.planes = groove;
    g.world.plane_count = 2;
    rig_ball(&g, rig_def(), 0.5, (double[3]){ 5, 5, 5 + 0.5/half });
    tobi_body_def def = rig_def();
    def.friction_coefficient = 2;        /* with the plane's sqrt(1.8): steeper than 45 degrees */
    memcpy(def.rotation_axis, (double[3]){ 0, 1, 0 }, sizeof def.rotation_axis);
    def.rotation_angle = 45;
    rig_box(&g, def, (double[3]){ 1, 1, 0.4 }, (double[3]){ 2 + 0.2*half, 5, 8 + 0.2*half });
    def.friction_coefficient = 0;
    rig_box(&g, def, (double[3]){ 0.4, 0.4, 0.4 }, (double[3]){ 1, 2, 9 });
    rig_start(&g);
    const tobi_rigid *ball = &g.bodies[0].rigid, *box = &g.bodies[1].rigid;
    print_message("%s", g.notes);
    assert_non_null(strstr(g.notes, "'b2' reaches 0.2 m behind a side or plane at the start"));
    rig_advance(&g, 1);
    double sunk = ball->position[2] - 5 - 0.5/half,
           crept = hypot(box->position[0] - 2 - 0.2*half, box->position[2] - 8 - 0.2*half);
    print_message("ball moved %.2g m, box %.2g m; force on ball %.3f N of %.3f N\n", sunk, crept,
                  g.bodies[0].info.contact_force[2], 9.81*ball->mass);
    assert_true(fabs(sunk) < 1e-6 && fabs(ball->position[0] - 5) < 1e-6 && crept < 1e-5);
    assert_true(fabs(g.bodies[0].info.contact_force[2]/(9.81*ball->mass) - 1) < 1e-6);
    assert_true(g.bodies[2].rigid.position[2] < 8.5);      /* without friction it slides away */
    rig_close(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scene_mistakes), cmocka_unit_test(test_world_mistakes),
        cmocka_unit_test(test_fill), cmocka_unit_test(test_groove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

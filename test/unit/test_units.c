/* Numbers that are likely in other units are told, tanks are not. */
#include "calls.h"
#include "scene_text.h"
#include "tobiuo/tobiuo.h"
#include <math.h>

/* Of a column of water 0.4 m high and a box in it; each number times the usual one. */
typedef struct factors { double length, density, body, viscosity, gravity; } factors;

static const factors USUAL = { 1, 1, 1, 1, 1 };

/* How many notes have these words; how many there are at all. */
static int count_notes(const char *method, factors x, const char *words, int *all)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def b = tobi_default_body_def();
    tobi_world *w;
    int found = 0;
    def.method = method;
    def.dimension = 2;
    def.spacing = 0.02*x.length;
    def.end_time = 1;
    def.gravity[1] = -9.81*x.gravity;
    def.gravity[2] = def.domain_max[2] = 0;
    def.domain_max[0] = x.length;
    def.domain_max[1] = 0.6*x.length;
    fluid.name = "water";
    fluid.density = 1000*x.density;
    fluid.viscosity = 0.001*x.viscosity;
    fill.box_max[0] = x.length;
    fill.box_max[1] = 0.4*x.length;
    fill.box_max[2] = 0;
    b.name = "box";
    b.dynamics = TOBI_FREE;
    b.density = 500*x.body;
    for (int a = 0; a < 2; a++) b.box_min[a] = 0.3*x.length, b.box_max[a] = 0.4*x.length;
    OK(tobi_world_create(&def, NULL, &w, &err));
    OK(tobi_world_add_fluid(w, &fluid, &fill, 1, &err));
    OK(tobi_world_add_body(w, &b, &err));
    OK(tobi_world_start(w, &err));
    for (*all = 0; tobi_world_note(w, *all); ++*all) found += strstr(tobi_world_note(w, *all), words) != NULL;
    tobi_world_destroy(w);
    return found;
}

static void expect(factors x, const char *words)
{
    static const char *methods[] = { "dfsph", "isph", "eisph", "wcsph" };
    int all;
    for (int k = 0; k < 4; k++)
        if (count_notes(methods[k], x, words, &all) != 1) fail_msg("%s: no note on '%s'", methods[k], words);
}

static void other_units_are_told(void **state)
{
    factors x = USUAL;
    (void)state;
    x.length = 1000;
    expect(x, "end_time': is 1 s, in which things fall by 4.91 m, and the liquid is 400 m high");
    x = USUAL, x.density = 1e-3, x.body = 1e-3;
    expect(x, "'water': its density is 1 kg/m3, that of a gas");
    x = USUAL, x.body = 1e-3;
    expect(x, "'box': its density is 0.5 kg/m3, 0.0005 times that of the liquid");
    x = USUAL, x.density = 1e-3;
    expect(x, "'box': its density is 500 kg/m3, 500 times that of the liquid");
    x = USUAL, x.viscosity = 1e7;
    expect(x, "'water': its viscosity, 1e+04 Pa s, allows steps of");
    x = USUAL, x.gravity = 1000;
    expect(x, "gravity': is 9810 m/s2, 1000 times that of the earth");
    x = USUAL, x.gravity = -1;
    expect(x, "gravity': points upwards: its y is 9.81 m/s2");
}

static void a_tank_is_not(void **state)
{
    int all;
    (void)state;
    count_notes("dfsph", USUAL, "", &all);
    if (all > 1) fail_msg("%d notes", all);               /* particles that were cut out */
    factors x = USUAL;
    x.length = 20, x.body = 15, x.viscosity = 1e4;        /* a harbour, of steel, in honey */
    count_notes("isph", x, "", &all);
    if (all > 1) fail_msg("%d notes", all);
}

/* A started pool by isph, 1 x 1 m; inlet: NULL = none. Returns how many of its notes have the text. */
static int count_in_pool(const tobi_isph_def *isph, double spacing, double deep, const tobi_inlet_def *inlet,
                         const char *text)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *w;
    int found = 0;
    def.method = "isph";
    def.spacing = spacing;
    fluid.name = "water";
    for (int a = 0; a < 3; a++) def.domain_max[a] = 1, fill.box_max[a] = a < 2 ? 1 : deep;
    OK(tobi_world_create(&def, isph, &w, &err));
    OK(tobi_world_add_fluid(w, &fluid, &fill, 1, &err));
    if (inlet) OK(tobi_world_add_inlet(w, inlet, &err));
    OK(tobi_world_start(w, &err));
    for (int k = 0; tobi_world_note(w, k); k++) found += strstr(tobi_world_note(w, k), text) != NULL;
    tobi_world_destroy(w);
    return found;
}

static int notes_of_surface(int rule, double height)
{
    tobi_isph_def isph = tobi_default_isph_def();
    isph.surface_rule = rule;
    isph.surface_height = height;
    return count_in_pool(&isph, 0.1, 0.5, NULL, "'isph.surface_height': is p = 0 at the particles");
}

static void a_rough_surface_is_told(void **state)
{
    (void)state;
    assert_int_equal(notes_of_surface(TOBI_SURFACE_COUNT, 0), 1);
    assert_int_equal(notes_of_surface(TOBI_SURFACE_COUNT, 0.2), 0);
    assert_int_equal(notes_of_surface(TOBI_SURFACE_LOSS, 0), 0);
}

/* Litres per second. */
static void a_jet_is_told(void **state)
{
    (void)state;
    tobi_inlet_def inlet = tobi_default_inlet_def();
    inlet.name = "pipe";
    memcpy(inlet.centre, (double[3]){ 0.5, 0.5, 0.5 }, sizeof inlet.centre);
    memcpy(inlet.normal, (double[3]){ 0, 0, -1 }, sizeof inlet.normal);
    inlet.radius = 0.1;
    inlet.flow_rate = 2;
    assert_int_equal(count_in_pool(NULL, 0.05, 0.2, &inlet, "'pipe': lets liquid in at up to 6"), 1);
}

/* Below the level its buffer is a hole that the pool falls into. */
static void an_inlet_in_a_pool_is_told(void **state)
{
    (void)state;
    for (int deep = 0; deep < 2; deep++) {
        tobi_inlet_def inlet = tobi_default_inlet_def();
        inlet.name = "pipe";
        memcpy(inlet.centre, (double[3]){ 0.5, 0.5, 0.5 }, sizeof inlet.centre);
        memcpy(inlet.normal, (double[3]){ 1, 0, 0 }, sizeof inlet.normal);
        inlet.radius = 0.1;
        inlet.flow_rate = 0.01;
        assert_int_equal(count_in_pool(NULL, 0.05, deep ? 0.7 : 0.3, &inlet, "'pipe': lies in liquid"), deep);
    }
}

static int count_in_scene(const char *scene, const char *text)
{
    tobi_world *w;
    int found = 0;
    OK(start_scene(scene, &w, &err));
    for (int k = 0; tobi_world_note(w, k); k++) found += strstr(tobi_world_note(w, k), text) != NULL;
    tobi_world_destroy(w);
    return found;
}

static void a_support_that_is_short_for_tension_is_told(void **state)
{
    (void)state;
    static const char *const methods[] = { "dfsph", "wcsph", "isph", "eisph" };
    for (int k = 0; k < 4; k++)
        for (int tension = 0; tension < 2; tension++)
            for (int full = 0; full < 2; full++) {
                char text[500];
                snprintf(text, sizeof text, "{ \"method\": \"%s\", \"dimension\": 2, \"spacing\": 0.05, "
                         "\"domain\": { \"min\": [0, 0], \"max\": [1, 1] }, \"end_time\": 1, "
                         "\"fluids\": [ { \"name\": \"w\", \"surface_tension\": %d, "
                         "\"fill\": [ { \"box\": { \"min\": [0, 0], \"max\": [1, 0.5] } } ] } ], "
                         "\"%s\": { \"support\": %s } }", methods[k], tension, methods[k],
                         full ? "3" : "2.5");
                assert_int_equal(count_in_scene(text, "and drops swing too fast below 3"), tension && !full);
            }
}

/* A drop of 10 spacings at rest: where tension was a force by isph, it shook itself apart in this time. Its
   surface energy is 2.3e-3 J/m. */
static void drops_by_isph_rest(void **state)
{
    (void)state;
    static const char text[] = "{ \"method\": \"isph\", \"isph\": { \"support\": 3 }, \"dimension\": 2,"
        "\"domain\": { \"min\": [0, 0], \"max\": [0.02, 0.02] }, \"spacing\": 5e-4, \"gravity\": [0, 0],"
        "\"end_time\": 1, \"fluids\": [ { \"name\": \"w\", \"surface_tension\": 0.0728, \"fill\": ["
        "{ \"sphere\": { \"centre\": [0.01, 0.01], \"radius\": 0.005 } } ] } ] }";
    tobi_world *w;
    tobi_error err = { 0 };
    if (start_scene(text, &w, &err) != TOBI_OK || tobi_world_advance(w, 0.1, NULL, &err) != TOBI_OK)
        fail_msg("%s", err.text);
    const double energy = tobi_world_info(w)->kinetic_energy;
    print_message("kinetic energy of a drop at rest: %g J/m\n", energy);
    assert_true(energy < 1e-6);
    tobi_world_destroy(w);
}

/* Liquid that leaves the plane of a reservoir would meet no pressure there. */
static void a_reservoir_without_liquid_is_told(void **state)
{
    (void)state;
    static const struct { double from, speed, gravity; int told; } cases[] = {
        { 0.2, 0, 0, 1 }, { 0.2, 0.5, 0, 1 }, { 0.2, -0.5, 0, 0 }, { 0.2, 0, -9.81, 0 },
        { 0.2, 0.5, -9.81, 1 }, { 0, 0.5, 0, 0 } };
    for (size_t k = 0; k < sizeof cases/sizeof *cases; k++) {
        char text[600];
        snprintf(text, sizeof text, "{ \"method\": \"isph\", \"dimension\": 2, \"spacing\": 0.02, "
                 "\"domain\": { \"min\": [0, 0], \"max\": [1, 0.1] }, \"end_time\": 1, \"gravity\": [0, %g], "
                 "\"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"velocity\": [%g, 0], \"box\": { "
                 "\"min\": [%g, 0], \"max\": [1, 0.1] } } ] } ], \"outlets\": [ { \"name\": \"lake\", "
                 "\"centre\": [0.2, 0.05], \"normal\": [-1, 0], \"width\": 0.1, \"pressure\": 100 } ] }",
                 cases[k].gravity, cases[k].speed, cases[k].from);
        assert_int_equal(count_in_scene(text, "'lake': presses by the liquid beyond"), cases[k].told);
        assert_int_equal(count_in_scene(text, "'lake': drives a full pipe"), 0);
    }
}

#define SLAB "{ \"name\": \"slab\", \"box\": { \"min\": [0, 0.1], \"max\": [1, 0.16] } }"

/* One between two outlets with a pressure, by wcsph; where it is half empty, levels drive it. */
static void a_pipe_without_an_inlet_is_told(void **state)
{
    (void)state;
    static const struct { const char *method; double full, high; int told; } cases[] = {
        { "wcsph", 0.06, 0.1, 0 }, { "wcsph", 0.1, 0.1, 1 }, { "isph", 0.1, 0.1, 0 },
        { "wcsph", 0.1, 0.16, 1 }, { "wcsph", 0.06, 0.16, 0 } };        /* the last two under a slab */
    for (size_t k = 0; k < sizeof cases/sizeof *cases; k++) {
        char text[900];
        snprintf(text, sizeof text, "{ \"method\": \"%s\", \"dimension\": 2, \"spacing\": 0.02, "
                 "\"domain\": { \"min\": [0, 0], \"max\": [1, %g] }, \"end_time\": 1, \"bodies\": [ %s ], "
                 "\"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"box\": { \"min\": [0, 0], "
                 "\"max\": [1, %g] } } ] } ], \"outlets\": [ { \"name\": \"lake\", \"centre\": [0.2, 0.05], "
                 "\"normal\": [-1, 0], \"width\": 0.1, \"pressure\": 200 }, { \"name\": \"end\", "
                 "\"centre\": [0.8, 0.05], \"normal\": [1, 0], \"width\": 0.1, \"pressure\": 100 } ] }",
                 cases[k].method, cases[k].high, cases[k].high > 0.1 ? SLAB : "", cases[k].full);
        assert_int_equal(count_in_scene(text, "'lake': drives a full pipe by its pressure"), cases[k].told);
    }
}

/* A barge, 0.2 m wide, with a draught of 0.1 m: GM is 0.0833 m less KG. Its farthest corner from a centre of
   mass 0.04 m above the keel is 0.189 m away. */
static int count_of_barge(const char *keys, const char *text)
{
    char scene[1000];
    snprintf(scene, sizeof scene, "{ \"dimension\": 2, \"method\": \"isph\", \"domain\": { \"min\": [0, 0], "
             "\"max\": [1, 0.8] }, \"spacing\": 0.02, \"end_time\": 1, "
             "\"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"box\": { "
             "\"min\": [0, 0], \"max\": [1, 0.4] } } ] } ], "
             "\"bodies\": [ { \"name\": \"barge\", \"mass\": 20, \"dynamics\": \"free\", "
             "\"box\": { \"min\": [0.4, 0.3], \"max\": [0.6, 0.5] }, %s } ] }", keys);
    return count_in_scene(scene, text);
}

/* A hinge by the body's own axes, or in millimetres. */
static void hinges_outside_are_told(void **state)
{
    (void)state;
    static const char *const keys[] = {
        "\"hinge\": { \"point\": [%s] }",
        "\"restitution\": 0 } ], \"joints\": [ { \"name\": \"pin\", \"body\": \"barge\", \"point\": [%s]" };
    static const char *const told[] = { "body 'barge': 'hinge.point', (500, 0.4, 0) m, lies outside",
                                        "joint 'pin': 'point', (500, 0.4, 0) m, lies outside" };
    for (int k = 0; k < 2; k++) {
        char given[200];
        snprintf(given, sizeof given, keys[k], "500, 0.4");
        assert_int_equal(count_of_barge(given, told[k]), 1);
        snprintf(given, sizeof given, keys[k], "0.5, 0.8");
        assert_int_equal(count_of_barge(given, "outside of the domain"), 0);
    }
}

static void ships_that_cannot_be_are_told(void **state)
{
    (void)state;
    const char *capsizes = "'barge': it capsizes about z: its GM is -0.0967 m, below 0";
    const char *spread = "'barge': its radius of gyration about z is 0.316 m, and no part of it is "
                         "farther than 0.189";
    assert_int_equal(count_of_barge("\"centre_of_mass\": [0.5, 0.48]", capsizes), 1);
    assert_int_equal(count_of_barge("\"centre_of_mass\": [0.5, 0.48], \"locked\": \"turn_z\"", capsizes), 0);
    assert_int_equal(count_of_barge("\"centre_of_mass\": [0.5, 0.34]", "capsizes"), 0);
    assert_int_equal(count_of_barge("\"restitution\": 0", "capsizes"), 0);      /* none is given */
    assert_int_equal(count_of_barge("\"centre_of_mass\": [0.5, 0.34], \"inertia\": [2, 2, 2]", spread), 1);
    assert_int_equal(count_of_barge("\"centre_of_mass\": [0.5, 0.34], \"inertia\": [0.2, 0.2, 0.2]",
                                    "gyration"), 0);
}

static void friction_without_a_partner_is_told(void **state)
{
    (void)state;
    static const struct { const char *own, *other; int told; } cases[] = {
        { "\"surface_friction\": 0.5", NULL, 1 }, { "\"surface_friction\": 0.3", NULL, 0 },
        { "\"surface_friction\": 0.5", "\"bonded\": true", 1 },
        { "\"surface_friction\": 0.5", "\"bonded\": false", 0 },
        { "\"surface_friction\": 0.5, \"bonded\": false", "\"model\": \"liquid\"", 1 },
        { "\"surface_friction\": 0.5, \"bonded\": false", "\"bonded\": true", 0 } };
    for (size_t k = 0; k < sizeof cases/sizeof *cases; k++) {
        char text[1000], other[300] = "";
        if (cases[k].other)
            snprintf(other, sizeof other, ", { \"name\": \"b\", %s, \"fill\": [ { \"box\": { \"min\": "
                     "[0.6, 0], \"max\": [0.8, 0.2] } } ] }", cases[k].other);
        snprintf(text, sizeof text, "{ \"method\": \"mlsmpm\", \"dimension\": 2, "
                 "\"domain\": { \"min\": [0, 0], \"max\": [1, 1] }, \"spacing\": 0.1, \"end_time\": 1, "
                 "\"solids\": [ { \"name\": \"a\", %s, \"fill\": [ { \"box\": { \"min\": [0.2, 0], "
                 "\"max\": [0.4, 0.2] } } ] }%s ] }", cases[k].own, other);
        assert_int_equal(count_in_scene(text, "'a': its surface_friction does nothing"), cases[k].told);
    }
}

static void a_sudden_wave_maker_is_told(void **state)
{
    (void)state;
    static const struct { const char *waves; int told; } cases[] = {
        { "\"regular\": { \"height\": 0.04, \"period\": 1 }", 1 },
        { "\"regular\": { \"height\": 0.04, \"period\": 1 }, \"ramp\": 1", 0 },
        { "\"solitary\": { \"height\": 0.04 }", 0 } };
    for (size_t k = 0; k < sizeof cases/sizeof *cases; k++) {
        char text[1000];
        snprintf(text, sizeof text, "{ \"method\": \"isph\", \"dimension\": 2, "
                 "\"domain\": { \"min\": [-0.1, 0], \"max\": [2, 0.6] }, \"spacing\": 0.05, "
                 "\"end_time\": 1, \"gravity\": [0, -9.81], "
                 "\"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"box\": { \"min\": [0.1, 0], "
                 "\"max\": [2, 0.3] } } ] } ], "
                 "\"bodies\": [ { \"name\": \"board\", \"box\": { \"min\": [0, 0], \"max\": [0.1, 0.6] }, "
                 "\"motion\": { \"piston\": { \"depth\": 0.3, %s } } } ] }", cases[k].waves);
        assert_int_equal(count_in_scene(text, "'board': its waves begin at full height"), cases[k].told);
        assert_int_equal(count_in_scene(text, "sets off at"), 0);
    }
}

/* Young's modulus in kPa, of sand too; and its friction angle in radians. */
static void solids_in_other_units_are_told(void **state)
{
    static const char *const modulus[] = { "20", "2e4", "20, \"model\": \"sand\", \"friction_angle\": 0.55",
                                           "2e4, \"model\": \"sand\"" };
    char text[600];
    (void)state;
    for (int k = 0; k < 4; k++) {
        snprintf(text, sizeof text, "{ \"method\": \"mlsmpm\", \"dimension\": 2, "
                 "\"domain\": { \"min\": [0, 0], \"max\": [0.2, 0.2] }, \"spacing\": 0.01, "
                 "\"end_time\": 1, \"gravity\": [0, -9.81], "
                 "\"solids\": [ { \"name\": \"gel\", \"density\": 1050, \"youngs_modulus\": %s, \"fill\": "
                 "[ { \"box\": { \"min\": [0.05, 0], \"max\": [0.15, 0.1] } } ] } ] }", modulus[k]);
        assert_int_equal(count_in_scene(text, "'gel': its own weight presses with"), k%2 == 0);
        assert_int_equal(count_in_scene(text, "'gel': its friction_angle is 0.55 degrees"), k == 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_units_are_told),
        cmocka_unit_test(a_tank_is_not),
        cmocka_unit_test(a_rough_surface_is_told),
        cmocka_unit_test(a_jet_is_told),
        cmocka_unit_test(an_inlet_in_a_pool_is_told),
        cmocka_unit_test(a_support_that_is_short_for_tension_is_told), cmocka_unit_test(drops_by_isph_rest),
        cmocka_unit_test(a_reservoir_without_liquid_is_told),
        cmocka_unit_test(a_pipe_without_an_inlet_is_told),
        cmocka_unit_test(hinges_outside_are_told),
        cmocka_unit_test(ships_that_cannot_be_are_told),
        cmocka_unit_test(friction_without_a_partner_is_told),
        cmocka_unit_test(a_sudden_wave_maker_is_told),
        cmocka_unit_test(solids_in_other_units_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* How easily water moves a body, and sound: what bounds the steps of an explicit coupling. */
#include "calls.h"
#include "sph/couple.h"
#include "world/world.h"
#include <math.h>

/* Of a box of these sides and a density of 500 kg/m3, over the exact eigenvalue. */
static double softness(const double size[3], const tobi_body_def *more, int dimension)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def b = *more;
    tobi_world *w;
    def.method = "wcsph";
    def.dimension = dimension;
    def.spacing = 0.02;
    fluid.name = "water";
    b.name = "box";
    b.density = 500;
    for (int a = 0; a < 3; a++) {
        def.domain_max[a] = 1;
        fill.box_max[a] = a ? 0.1 : 1;
        b.box_min[a] = 0.5 - size[a]/2;
        b.box_max[a] = 0.5 + size[a]/2;
    }
    if (dimension == 2) def.domain_max[2] = def.gravity[2] = 0;
    OK(tobi_world_create(&def, NULL, &w, &err));
    OK(tobi_world_add_fluid(w, &fluid, &fill, 1, &err));
    OK(tobi_world_add_body(w, &b, &err));
    double value = tobi_couple_softness(&w->system[0]);
    tobi_world_destroy(w);
    return value;
}

static void expect(double value, double exact)
{
    if (!(value >= exact*(1 - 1e-3) && value <= 1.07*exact)) fail_msg("%.9g, expected %.9g", value, exact);
}

static void boxes(void **state)
{
    (void)state;
    tobi_body_def b = tobi_default_body_def();
    const double cube[3] = {0.2, 0.2, 0.2}, plate[3] = {0.4, 0.4, 0.05};
    b.dynamics = TOBI_FREE;
    /* a shift along one axis is answered by two faces, and so is a turn of a cube */
    expect(softness(cube, &b, 3), 2*0.04/(500*0.008));
    expect(softness(plate, &b, 3), 2*0.16/(500*0.16*0.05));
    expect(softness(cube, &b, 2), 2*0.2/(500*0.04));
    b.rotation_angle = 30;
    memcpy(b.rotation_axis, (double[3]){1, 2, 3}, sizeof b.rotation_axis);
    expect(softness(cube, &b, 3), 2*0.04/(500*0.008));
    b.mass = 8;
    expect(softness(cube, &b, 3), 2*0.04/8);
    b.locked = "turn";
    expect(softness(cube, &b, 3), 2*0.04/8);
}

/* Water at rest: cfl d over sound, 0.4*0.02/c. A step above it is told. */
static void a_step_longer_than_sound_allows_is_told(void **state)
{
    (void)state;
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_wcsph_def liquid = tobi_default_wcsph_def();
    tobi_world *w;
    def.method = "wcsph";
    def.spacing = 0.02;
    def.time_step = 0.01;
    fluid.name = "water";
    for (int a = 0; a < 3; a++) {
        def.domain_max[a] = 1;
        fill.box_max[a] = a ? 0.1 : 1;
    }
    OK(tobi_world_create(&def, &liquid, &w, &err));
    OK(tobi_world_add_fluid(w, &fluid, &fill, 1, &err));
    const double exact = 0.4*0.02/sqrt(liquid.exponent*liquid.stiffness/1000);
    assert_true(fabs(tobi_world_stable_step(w)/exact - 1) < 1e-6);
    OK(tobi_world_note_time_step(w, &err));
    assert_non_null(strstr(tobi_world_note(w, 0), "that sound in the liquid allows: the run may run away"));
    tobi_world_destroy(w);
}

static void prescribed_bodies_have_none(void **state)
{
    (void)state;
    tobi_body_def b = tobi_default_body_def();
    assert_true(softness((double[3]){0.2, 0.2, 0.2}, &b, 3) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes),
        cmocka_unit_test(a_step_longer_than_sound_allows_is_told),
        cmocka_unit_test(prescribed_bodies_have_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* A body that its control program holds and then lets go: what pushed it while it was held is not its. */
#include "calls.h"
#include "tobiuo/tobiuo.h"
#include <math.h>
#include <string.h>

static const double HELD = 0.05;                           /* s */

static tobi_status hold(void *user, const tobi_control_input *in, tobi_control_output *out, tobi_error *e)
{
    (void)user; (void)e;
    out->hold = in->time < HELD ? "shift,turn" : NULL;
    return TOBI_OK;
}

/* A disc of 0.1 m, 0.15 m under the surface of water. */
static tobi_world *make_world(const char *method, double density, double level)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def b = tobi_default_body_def();
    tobi_world *w;
    def.method = method;
    def.dimension = 2;
    def.spacing = 0.0125;
    def.threads = 1;
    def.gravity[1] = -9.81;
    def.gravity[2] = def.domain_max[2] = 0;
    def.domain_max[0] = def.domain_max[1] = 0.5;
    fluid.name = "water";
    fill.box_max[0] = 0.5;
    fill.box_max[1] = level;
    fill.box_max[2] = 0;
    b.name = "disc";
    memcpy(b.sphere_centre, (double[3]){ 0.25, 0.2, 0 }, sizeof b.sphere_centre);
    b.sphere_radius = 0.05;
    b.density = density;
    b.dynamics = TOBI_CONTROLLED;
    b.control = hold;
    OK(tobi_world_create(&def, NULL, &w, &err));
    OK(tobi_world_add_fluid(w, &fluid, &fill, 1, &err));
    OK(tobi_world_add_body(w, &b, &err));
    return w;
}

/* m/s upwards at that time. */
static double rise(tobi_world *w, double time)
{
    tobi_body_info info;
    OK(tobi_world_advance(w, time, NULL, &err));
    OK(tobi_world_body(w, 0, &info));
    return info.velocity[1];
}

/* It sets off as its added mass allows, and is not thrown by the force that held it: once 0.9 m/s by dfsph
   and isph, at 0.05 of the water's density. */
static void under_water(void **state)
{
    static const char *methods[] = { "dfsph", "isph", "eisph", "wcsph" };
    (void)state;
    for (int k = 0; k < 4; k++) {
        tobi_world *w = make_world(methods[k], 50, 0.4);
        assert_true(rise(w, HELD - 0.001) == 0);
        for (double t = 0.0005; t < 0.0101; t += 0.0005) {
            const double v = rise(w, HELD + t), most = 9.81*(1000 - 50)/(1000 + 50)*(t + 0.002);
            if (!(v > -0.01 && v <= 1.3*most))
                fail_msg("%s: %g m/s %g s after, at most %g", methods[k], v, t, most);
        }
        tobi_world_destroy(w);
    }
}

/* In the air it falls from rest: not by a step's worth of gravity at once. */
static void in_the_air(void **state)
{
    (void)state;
    tobi_world *w = make_world("isph", 50, 0.05);
    assert_true(rise(w, HELD) == 0);
    const double v = rise(w, HELD + 0.01);
    if (fabs(v + 0.0981) > 1e-9) fail_msg("%.12g m/s", v);
    tobi_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(under_water),
        cmocka_unit_test(in_the_air),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Friction of a liquid on no-slip sides and bodies, eq. (14) and (14b), over one short step. */
#include "calls.h"
#include "core/smoothing.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>

static const double D = 0.002, LENGTH = 0.18, SPEED = 1, DENSITY = 1000;

/* A sheet of liquid slides over the floor of a box, or over a body with its top at the same height: force on
   either along the flow, N per metre of depth. */
static double find_force(double viscosity, int body)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def plate = tobi_default_body_def();
    tobi_step_info info;
    tobi_body_info force = {0};
    tobi_world *w;
    def.dimension = 2;
    def.spacing = D;
    def.domain_min[1] = body ? -0.05 : 0;
    def.domain_max[0] = 0.3;
    def.domain_max[1] = 0.1;
    def.domain_max[2] = def.gravity[2] = 0;
    def.wall_min[1] = TOBI_WALL_NO_SLIP;
    def.time_step = 1e-5;
    fluid.name = "water";
    fluid.density = DENSITY;
    fluid.viscosity = viscosity;
    fill.box_min[0] = 0.06;
    fill.box_max[0] = 0.06 + LENGTH;
    fill.box_max[1] = 0.04;
    fill.velocity[0] = SPEED;
    plate.name = "plate";
    plate.friction = TOBI_NO_SLIP;
    plate.box_min[0] = 0.02;
    plate.box_max[0] = 0.28;
    plate.box_min[1] = -0.02;
    OK(tobi_world_create(&def, NULL, &w, &err));
    OK(tobi_world_add_fluid(w, &fluid, &fill, 1, &err));
    if (body) OK(tobi_world_add_body(w, &plate, &err));
    OK(tobi_world_start(w, &err));
    OK(tobi_world_step(w, 1, &info, &err));
    if (body) OK(tobi_world_body(w, 0, &force));
    tobi_world_destroy(w);
    return body ? force.viscous_force[0] : info.wall_force[0];
}

/* The layers of the lattice within the support, each with its share 2 sigma d of the wall and the stress that
   it sees: mu u/s, or u_tau^2 of a turbulent layer, u = 8.3 u_tau (s u_tau/nu)^(1/7). */
static double expect_force(double viscosity, int turbulent)
{
    tobi_smoothing_constants c;
    double sum = 0, nu = viscosity/DENSITY;
    tobi_smoothing_init(&c, TOBI_KERNEL_WENDLAND_C2, 2, D, 2);
    for (double s = D/2; s < c.h; s += D) {
        const double at = s/c.h*TOBI_PLANE_SAMPLES, share = 2*D*(double)c.plane.sigma[(int)lround(at)];
        const double stress = turbulent ? pow(SPEED/8.3, 7.0/4)*pow(nu/s, 0.25) : nu*SPEED/s;
        sum += share*stress;
    }
    return DENSITY*LENGTH*sum;
}

static void check(double viscosity, int turbulent)
{
    for (int body = 0; body < 2; body++) {
        const double force = find_force(viscosity, body), expected = expect_force(viscosity, turbulent);
        printf("%g Pa s, %s: %.5g N/m, by (14%s) %.5g\n", viscosity, body ? "body" : "floor", force,
               turbulent ? "b" : "", expected);
        if (!(fabs(force/expected - 1) < 0.002)) fail_msg("%g, expected %g N/m", force, expected);
    }
}

static void layers_of_viscous_liquids_are_linear(void **state) { (void)state; check(0.1, 0); }

static void layers_of_water_are_turbulent(void **state) { (void)state; check(1e-3, 1); }

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(layers_of_viscous_liquids_are_linear),
                                        cmocka_unit_test(layers_of_water_are_turbulent) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

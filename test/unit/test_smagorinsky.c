/* Turbulence below the spacing. A steady shear flow has the stress mu S + rho (Cs d S)^2, so that shear
   between plates and channels have exact solutions. */
#include "calls.h"
#include "scene_text.h"
#include "sph/sensor/tractions.h"
#include <math.h>
#include <stdio.h>

static const char *const methods[] = { "dfsph", "isph", "wcsph", "eisph" };

static const double RHO = 1000, D = 0.002, CS = 0.3;                    /* kg/m3, m, 1 */

/* Periodic along x (and y), between the sides y (z) = 0 and `layers` spacings. The lower side is that of the
   domain, or of a box. MORE: keys of the fluid. */
static tobi_world *make(const char *method, int dimension, int layers, int box, double lid, double pull,
                        double mu, const char *more, int threads)
{
    const double side = 8*D, floor = box ? -5*D : 0, out = 3*D, top = layers*D;
    const int flat = dimension == 2;
    char low[80], high[120], body[400] = "", text[1400];
    tobi_world *w;
    if (flat) snprintf(high, sizeof high, "%.17g, %.17g", side, top);
    else snprintf(high, sizeof high, "%.17g, %.17g, %.17g", side, side, top);
    snprintf(low, sizeof low, "%s, %.17g", flat ? "0" : "0, 0", floor);
    if (box && flat)
        snprintf(body, sizeof body, ", \"bodies\": [{\"name\": \"floor\", \"friction\": \"no-slip\","
                 " \"box\": {\"min\": [%.17g, %.17g, 0], \"max\": [%.17g, 0, 0]}}]", -out, floor, side + out);
    else if (box)
        snprintf(body, sizeof body, ", \"bodies\": [{\"name\": \"floor\", \"friction\": \"no-slip\","
                 " \"box\": {\"min\": [%.17g, %.17g, %.17g], \"max\": [%.17g, %.17g, 0]}}]", -out, -out,
                 floor, side + out, side + out);
    snprintf(text, sizeof text,
             "{\"dimension\": %d, \"domain\": {\"min\": [%s], \"max\": [%s], \"walls\": {\"x\": \"periodic\","
             " %s \"no-slip\"}, \"wall_velocity\": {\"%s\": [[0, 0, 0], [%.17g, 0, 0]]}},"
             " \"gravity\": [%.17g, 0%s], \"spacing\": %.17g, \"end_time\": 100, \"threads\": %d,"
             " \"method\": \"%s\", \"implicit_viscosity\": true,"
             " \"fluids\": [{\"name\": \"water\", \"density\": %g, \"viscosity\": %g%s, \"fill\": [{\"box\":"
             " {\"min\": [%s], \"max\": [%s]}}]}]%s}",
             dimension, low, high, flat ? "\"y\":" : "\"y\": \"periodic\", \"z\":", flat ? "y" : "z", lid,
             pull, flat ? "" : ", 0", D, threads, method, RHO, mu, more, flat ? "0, 0" : "0, 0, 0", high,
             body);
    OK(start_scene(text, &w, &err));
    return w;
}

enum { MOST = 400 };

/* Speed along x of a particle at y (z). */
typedef double (*profile)(const void *user, double y);

static void set_off(tobi_world *w, profile speed, const void *user)
{
    double x[3*MOST], v[3*MOST] = { 0 };
    const int64_t count = w->system[0].particles.count;
    OK(tobi_world_read(w, TOBI_FLUID, "position", x, count, &err));
    for (int64_t i = 0; i < count; i++) v[3*i] = speed(user, x[3*i + w->sim.def.dimension - 1]);
    OK(tobi_world_write(w, "velocity", v, count, &err));
}

static double find_linear(const void *user, double y) { return *(const double *)user*y; }

/* Pa, in the middle of the floor. */
static double find_traction(const tobi_world *w)
{
    const int up = w->sim.def.dimension - 1;
    sph_place place = { .x = { 4*D, 4*D } };
    double pressure, shear[3];
    place.x[up] = 5*D;
    place.normal[up] = 1;
    sph_surface_look(&w->system[0], &w->sim.bodies[0], &place, &pressure, shear);
    return shear[0];
}

/* Sheared from the start as theory has it: the force on the floor, a body, N/m2, and the viscosity of a
   particle in the middle. */
static double shear(const char *method, int dimension, double lid, double mu, const char *more,
                    double *apparent, double *traction)
{
    enum { LAYERS = 6 };
    const double rate = lid/(LAYERS*D);
    tobi_world *w = make(method, dimension, LAYERS, 1, lid, 0, mu, more, 1);
    const int64_t count = w->system[0].particles.count;
    tobi_body_info floor;
    double viscosity[MOST];
    set_off(w, find_linear, &rate);
    OK(tobi_world_advance(w, 1e-3, NULL, &err));
    OK(tobi_world_body(w, 0, &floor));
    *apparent = mu;
    if (*more) {
        OK(tobi_world_read(w, TOBI_FLUID, "apparent_viscosity", viscosity, count, &err));
        *apparent = viscosity[count/2];
    }
    *traction = find_traction(w);
    tobi_world_destroy(w);
    return floor.viscous_force[0]/(dimension == 2 ? 8*D : 64*D*D);
}

/* The floor, a body, bears what it would of a liquid that is as viscous everywhere. */
static void plates_bear_the_stress(void **state)
{
    static const double tolerance[] = { 0.03, 0.06, 0.03, 0.06 };       /* of bodies, as without the key */
    const double lid = 0.4, rate = lid/(6*D), mu = 0.01, all = mu + RHO*pow(CS*D, 2)*rate;
    (void)state;
    for (int m = 0; m < 4; m++)
        for (int dimension = 2; dimension <= 3; dimension++) {
            double apparent, plain, local, even;
            const double with = shear(methods[m], dimension, lid, mu, ", \"smagorinsky\": 0.3", &apparent,
                                      &local);
            const double without = shear(methods[m], dimension, lid, all, "", &plain, &even);
            print_message("%s, %d-D: viscosity %.5f, stress %.4f, in the middle %.4f of theory, %.5f and "
                          "%.5f of a thicker liquid's\n", methods[m], dimension, apparent/all,
                          with/(all*rate), local/(all*rate), with/without, local/even);
            assert_float_equal(local/even, 1, 1e-3);
            assert_float_equal(local/(all*rate), 1, 0.06);
            assert_float_equal(apparent/all, 1, 2e-4);
            assert_float_equal(with/without, 1, 1e-3);
            assert_float_equal(with/(all*rate), 1, tolerance[m]);
        }
}

typedef struct channel { double half, pull, mu, eddy; } channel;

/* Between sides at 0 and 2 half that `pull` drives: the sum over the shear rates from a side on. */
static double find_speed(const void *user, double y)
{
    enum { PARTS = 200 };
    const channel *c = user;
    const double from = fabs(y - c->half), part = (c->half - from)/PARTS;
    double speed = 0;
    for (int k = 0; k < PARTS; k++) {
        const double stress = RHO*c->pull*(from + (k + 0.5)*part);
        speed += part*2*stress/(c->mu + sqrt(c->mu*c->mu + 4*c->eddy*stress));
    }
    return speed;
}

static double find_flow(tobi_world *w, const channel *c)
{
    const tobi_particles *p = &w->system[0].particles;
    double sum = 0, exact = 0;
    for (int64_t i = 0; i < p->count; i++) {
        sum += p->velocity[i].x;
        exact += find_speed(c, p->position[i].y);
    }
    return sum/exact;
}

/* Forces balance where the liquid is set off as theory has it. Then it leaves its rows, which brakes it as
   it brakes Newtonian liquids at such a Reynolds number, some 100. */
static void channels_flow_as_theory_says(void **state)
{
    enum { LAYERS = 8 };
    static const double tolerance[] = { 0.2, 0.12 };
    const channel c = { 0.5*LAYERS*D, 2, 1e-4, RHO*pow(CS*D, 2) };
    double mean = 0;
    for (int k = 0; k < LAYERS; k++) mean += find_speed(&c, (k + 0.5)*D)/LAYERS;
    (void)state;
    for (int m = 0; m < 2; m++) {
        tobi_world *w = make(methods[m], 2, LAYERS, 0, 0, c.pull, c.mu, ", \"smagorinsky\": 0.3", 1);
        set_off(w, find_speed, &c);
        const double before = find_flow(w, &c);
        OK(tobi_world_step(w, 1, NULL, &err));
        const double lacks = mean*(find_flow(w, &c) - before)/(w->sim.dt*c.pull);
        OK(tobi_world_advance(w, 0.6, NULL, &err));
        const double flow = find_flow(w, &c);
        print_message("%s: friction %.3f of theory, then flow %.3f of it\n", methods[m], 1 - lacks, flow);
        assert_float_equal(lacks, 0, 0.08);
        assert_float_equal(flow, 1, tolerance[m]);
        tobi_world_destroy(w);
    }
}

static uint64_t hash_after(const char *method, const char *more, int threads, int restart)
{
    tobi_world *w = make(method, 3, 4, 1, 0.4, 2, 0.01, more, threads);
    if (restart > 1) OK(tobi_world_load(w, "smagorinsky.h5", &err));
    else OK(tobi_world_advance(w, 0.01, NULL, &err));
    if (restart == 1) OK(tobi_world_save(w, "smagorinsky.h5", &err));
    OK(tobi_world_advance(w, 0.02, NULL, &err));
    const uint64_t hash = tobi_world_hash(w);
    tobi_world_destroy(w);
    return hash;
}

static void threads_and_restarts_do_not_matter(void **state)
{
    const char *all = ", \"smagorinsky\": 0.12, \"yield_stress\": 0.2, \"flow_index\": 0.8";
    (void)state;
    for (int m = 0; m < 2; m++) {
        const uint64_t hash = hash_after(methods[m], all, 1, 1);
        assert_true(hash == hash_after(methods[m], all, 3, 0));
        assert_true(hash == hash_after(methods[m], all, 1, 2));
    }
    remove("smagorinsky.h5");
}

/* Which is every scene of before. */
static void none_is_no_model(void **state)
{
    (void)state;
    const uint64_t hash = hash_after("dfsph", "", 1, 0);
    assert_true(hash == hash_after("dfsph", ", \"smagorinsky\": 0", 1, 0));
    assert_true(hash == hash_after("dfsph", ", \"smagorinsky\": \"none\"", 1, 0));
    assert_true(hash != hash_after("dfsph", ", \"smagorinsky\": 0.1", 1, 0));
}

static void explicit_viscosity_is_refused(void **state)
{
    static const char text[] =
        "{\"domain\": {\"min\": [0, 0, 0], \"max\": [1, 1, 1]}, \"spacing\": 0.1, \"end_time\": 1,"
        " \"fluids\": [{\"name\": \"water\", \"smagorinsky\": 0.12,"
        " \"fill\": [{\"box\": {\"min\": [0, 0, 0], \"max\": [1, 1, 0.5]}}]}]}";
    tobi_world *w = NULL;
    (void)state;
    REFUSED(start_scene(text, &w, &err), TOBI_UNSUPPORTED, "smagorinsky is 0.12, and implicit_viscosity is "
            "false; allowed without it is 0");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plates_bear_the_stress),
        cmocka_unit_test(channels_flow_as_theory_says),
        cmocka_unit_test(threads_and_restarts_do_not_matter),
        cmocka_unit_test(none_is_no_model),
        cmocka_unit_test(explicit_viscosity_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

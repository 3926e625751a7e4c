/* The memory that is estimated before a run against what the account of the world has after some steps: for
   each method, at two sizes, in 2-D and 3-D. */
#include "calls.h"
#include "tobiuo/tobiuo.h"
#include <math.h>

/* A tank half full of water, or of jelly, 1 m wide. */
static tobi_world *open_tank(const char *method, int dimension, double spacing)
{
    tobi_world_def d = tobi_default_world_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *w = NULL;
    const int up = dimension - 1;
    d.method = method;
    d.dimension = dimension;
    d.spacing = spacing;
    d.threads = 1;
    for (int a = 0; a < 3; a++) {
        d.domain_max[a] = a < dimension ? 1 : 0;
        d.gravity[a] = a == up ? -10 : 0;
        fill.box_max[a] = a == up ? 0.5 : d.domain_max[a];
    }
    OK(tobi_world_create(&d, NULL, &w, &err));
    if (strcmp(method, "mlsmpm") == 0) {
        tobi_solid_def jelly = tobi_default_solid_def();
        jelly.name = "jelly";
        jelly.youngs_modulus = 1e5;
        OK(tobi_world_add_solid(w, &jelly, &fill, 1, &err));
        return w;
    }
    tobi_fluid_def water = tobi_default_fluid_def();
    water.name = "water";
    OK(tobi_world_add_fluid(w, &water, &fill, 1, &err));
    return w;
}

static void say_parts(const tobi_world *w, double particles)
{
    int64_t bytes;
    const char *name;
    for (int k = 0; (name = tobi_world_memory(w, k, &bytes)); k++)
        print_message("    %8.1f bytes per particle: %s\n", (double)bytes/particles, name);
}

static int go_on(void *user) { return user != NULL; }

/* The most in some steps, one of which copies the state to be taken back, as in a run. */
static double measure(tobi_world *w)
{
    double most = 0;
    tobi_world_set_stop(w, go_on, NULL);
    for (int k = 0; k < 3; k++) {
        OK(tobi_world_step(w, 1, NULL, &err));
        most = fmax(most, (double)tobi_world_bytes(w));
    }
    return most;
}

static void the_estimate_is_what_a_run_takes(void **state)
{
    (void)state;
    static const char *const methods[] = { "dfsph", "wcsph", "isph", "eisph", "mlsmpm" };
    static const double spacings[2][2] = { { 0.01, 0.005 }, { 1.0/26, 0.025 } };
    int wrong = 0;
    for (int n = 0; n < 20; n++) {
        const char *method = methods[n/4];
        const int dimension = 2 + n/2%2;
        int64_t fluid, bodies, bytes;
        /* the grid of solids is in blocks, which few particles do not fill */
        if (strcmp(method, "mlsmpm") == 0 && n%2 == 0) continue;
        tobi_world *w = open_tank(method, dimension, spacings[dimension - 2][n%2]);
        OK(tobi_world_estimate(w, &fluid, &bodies, &bytes, &err));
        const double due = measure(w), off = (double)bytes/due - 1;
        if (fabs(off) > 0.1) {
            print_message("%s, %d-D, %lld particles: %.1f bytes each, %.1f are taken\n", method, dimension,
                          (long long)fluid, (double)bytes/(double)fluid, due/(double)fluid);
            say_parts(w, (double)fluid);
            wrong++;
        }
        tobi_world_destroy(w);
    }
    assert_int_equal(wrong, 0);
}

/* A solver with vectors of its own, and a domain that is mostly dry, which the grid covers all the same. */
static void choices_of_isph_count(void **state)
{
    (void)state;
    int64_t bytes[3], n;
    for (int k = 0; k < 3; k++) {
        tobi_world_def d = tobi_default_world_def();
        tobi_isph_def isph = tobi_default_isph_def();
        tobi_fill_def fill = tobi_default_fill_def();
        tobi_fluid_def water = tobi_default_fluid_def();
        tobi_world *w = NULL;
        d.method = "isph";
        d.dimension = 2;
        d.spacing = 0.01;
        d.threads = 1;
        d.domain_max[0] = k == 2 ? 8 : 1;
        d.domain_max[1] = 1;
        d.domain_max[2] = 0;
        fill.box_max[0] = 1;
        fill.box_max[1] = 0.5;
        water.name = "water";
        if (k == 1) isph.solver = TOBI_GMRES;
        OK(tobi_world_create(&d, &isph, &w, &err));
        OK(tobi_world_add_fluid(w, &water, &fill, 1, &err));
        OK(tobi_world_estimate(w, &n, &n, &bytes[k], &err));
        const double due = measure(w), off = (double)bytes[k]/due - 1;
        if (fabs(off) > 0.1) {
            print_message("case %d: %lld bytes, %.0f are taken\n", k, (long long)bytes[k], due);
            say_parts(w, 5000);
            fail();
        }
        tobi_world_destroy(w);
    }
    assert_true(bytes[1] > bytes[0] && bytes[2] > bytes[0]);
}

/* The mesh of a body counts: a ball of some 20 000 triangles takes more than its particles. */
static void meshes_count(void **state)
{
    (void)state;
    int64_t bytes[2], n;
    for (int k = 0; k < 2; k++) {
        tobi_world *w = open_tank("dfsph", 3, 0.05);
        tobi_body_def ball = tobi_default_body_def();
        ball.name = "ball";
        ball.sphere_radius = 0.1;
        ball.sphere_centre[0] = ball.sphere_centre[1] = 0.5;
        ball.sphere_centre[2] = 0.8;
        ball.spacing = 0.003;
        if (k) OK(tobi_world_add_body(w, &ball, &err));
        OK(tobi_world_estimate(w, &n, &n, &bytes[k], &err));
        if (k) {
            const double due = measure(w);
            assert_true(fabs((double)bytes[k]/due - 1) < 0.1);
        }
        tobi_world_destroy(w);
    }
    if (bytes[1] - bytes[0] < 10000000) fail_msg("%lld bytes", (long long)(bytes[1] - bytes[0]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_estimate_is_what_a_run_takes),
        cmocka_unit_test(choices_of_isph_count), cmocka_unit_test(meshes_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

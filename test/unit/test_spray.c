/* Drops that fall into a tank become water again: sparse liquid comes together until it has its density. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <cmocka.h>
#include "scene_text.h"
#include "world/world.h"

enum { ACROSS = 12, LAYERS = 20 };

/* Single particles of 1 cm, 1.6 cm apart, in a tank 20 cm wide. */
static tobi_world *start_rain(int threads)
{
    static char text[40000];
    const int room = sizeof text;
    tobi_world *w = NULL;
    tobi_error err = { 0 };
    int used = snprintf(text, sizeof text,
                        "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [0.2, 0.5] },\n"
                        "\"spacing\": 0.01, \"end_time\": 2, \"threads\": %d,\n"
                        "\"fluids\": [ { \"name\": \"water\", \"fill\": [", threads);
    for (int k = 0; k < ACROSS*LAYERS; k++) {
        const int row = k/ACROSS;
        const double x = 0.004 + 0.016*(k % ACROSS) + (row % 2 ? 0.003 : 0), y = 0.02 + 0.016*row;
        used += snprintf(text + used, (size_t)(room - used),
                         "%s\n{ \"box\": { \"min\": [%.3f, %.3f], \"max\": [%.3f, %.3f] } }",
                         k ? "," : "", x, y, x + 0.01, y + 0.01);
    }
    snprintf(text + used, (size_t)(room - used), " ] } ] }");
    if (start_scene(text, &w, &err) != TOBI_OK) fail_msg("%s", err.text);
    return w;
}

/* Without (10f) they hang in each other's supports: a foam of 0.4 times the density, 28 cm high. */
static void rain_fills_a_tank(void **state)
{
    (void)state;
    uint64_t hash[2];
    for (int k = 0; k < 2; k++) {
        tobi_world *w = start_rain(1 + k);
        tobi_step_info info;
        tobi_error err = { 0 };
        assert_int_equal(tobi_world_info(w)->fluid_particles, ACROSS*LAYERS);
        if (tobi_world_advance(w, 1.2, &info, &err) != TOBI_OK) fail_msg("%s", err.text);
        /* as a pool: its weight times half its height */
        const double mass = 1000*0.01*0.01*ACROSS*LAYERS, height = 0.01*0.01*ACROSS*LAYERS/0.2;
        const double energy = info.kinetic_energy + info.potential_energy;
        if (fabs(energy/(mass*9.81*height/2) - 1) > 0.03)
            fail_msg("the water has %g J, not %g", energy, mass*9.81*height/2);
        hash[k] = tobi_world_hash(w);
        tobi_world_destroy(w);
    }
    assert_true(hash[0] == hash[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(rain_fills_a_tank) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

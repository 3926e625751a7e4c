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

/* 0 to 1 */
static double draw(uint64_t *seed)
{
    *seed = *seed*6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11)*0x1p-53;
}

/* Chains of three drops that fly into each other, far from other chains. Pressures of alternating sign make
   no force in a chain, and (10f) asks for what no pressure makes: without (10g) the run ends in its second
   step. */
static void drops_that_touch_gain_no_energy(void **state)
{
    (void)state;
    const char *text = "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [4, 4] },"
                       "\"spacing\": 0.01, \"end_time\": 1, \"gravity\": [0, 0],"
                       "\"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"velocity\": [2.8, 0],"
                       "\"box\": { \"min\": [0, 0], \"max\": [0.4, 0.75] } } ] } ] }";
    const double d = 0.01;
    tobi_world *w = NULL;
    tobi_error err = { 0 };
    tobi_step_info info;
    uint64_t seed = 1;
    double before = 0;
    if (start_scene(text, &w, &err) != TOBI_OK) fail_msg("%s", err.text);
    tobi_particles *p = &w->system[0].particles;
    assert_int_equal(p->count, 3000);
    for (int64_t chain = 0; chain < p->count/3; chain++) {
        double x = 0.05 + 0.12*(double)(chain % 32), y = 0.05 + 0.12*(double)(chain/32);
        const double turn = 6.2832*draw(&seed);
        for (int64_t i = 3*chain; i < 3*chain + 3; i++) {
            const double way = (0.9 + 0.9*draw(&seed))*d, angle = turn + draw(&seed) - 0.5;
            p->position[i].x = x += way*cos(angle);
            p->position[i].y = y += way*sin(angle);
            p->velocity[i].x = (float)(4*draw(&seed) - 2);
            p->velocity[i].y = (float)(4*draw(&seed) - 2);
            before += 0.5*1000*d*d*(pow(p->velocity[i].x, 2) + pow(p->velocity[i].y, 2));
        }
    }
    for (int k = 0; k < 20; k++) {
        if (tobi_world_step(w, 0.001, &info, &err) != TOBI_OK) fail_msg("%s", err.text);
        if (info.kinetic_energy > 1.001*before)
            fail_msg("step %d: %g J of %g", k, info.kinetic_energy, before);
    }
    print_message("%g J of %g\n", info.kinetic_energy, before);
    tobi_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(rain_fills_a_tank),
                                        cmocka_unit_test(drops_that_touch_gain_no_energy) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

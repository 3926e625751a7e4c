/* Bodies that move by forces in thick liquid with implicit viscosity (decision 109): they do not bound the
   step, and what they lose the liquid gains. */
#include "calls.h"
#include "scene_text.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const methods[] = {"dfsph", "isph", "wcsph", "eisph"};

static tobi_world *make(const char *text)
{
    tobi_world *w;
    OK(start_scene(text, &w, &err));
    return w;
}

/* A round patch of oil, 24 cm and 30 particles across, around a disc of 10 cm. No gravity. */
#define PATCH \
    "{\"dimension\": 2, \"domain\": {\"min\": [-0.3, -0.3], \"max\": [0.3, 0.3]}, \"gravity\": [0, 0]," \
    " \"spacing\": 0.008, \"end_time\": 1, \"method\": \"%s\", \"implicit_viscosity\": true," \
    " \"threads\": %d," \
    " \"time_step_max\": %g, \"fluids\": [{\"name\": \"oil\", \"viscosity\": 200, \"fill\": [{\"mesh\": \"" \
    TOBI_SOURCE_DIR "/test/meshes/cylinder.obj\", \"scale\": 0.24}]}], \"bodies\": [%s]%s}"
#define DISC(NAME, SCALE, MORE) \
    "{\"name\": \"" NAME "\", \"mesh\": \"" TOBI_SOURCE_DIR "/test/meshes/cylinder.obj\", \"scale\": " SCALE \
    ", \"friction\": \"no-slip\", \"dynamics\": \"free\", \"density\": 300, " MORE "}"

static tobi_world *make_patch(const char *method, const char *bodies, const char *joints, double step_max,
                              int threads)
{
    char text[3000];
    snprintf(text, sizeof text, PATCH, method, threads, step_max, bodies, joints);
    return make(text);
}

/* Of oil and bodies about the origin, per metre: N s/m, N s. */
static void sum_momenta(tobi_world *w, double momentum[2], double *spin)
{
    const tobi_particles *p = &w->system[0].particles;
    const double mass = 1000*0.008*0.008, middle = 0.3;      /* places are from the corner of the domain */
    momentum[0] = momentum[1] = *spin = 0;
    for (int64_t i = 0; i < p->count; i++) {
        const tobi_float4 u = p->velocity[i];
        momentum[0] += mass*u.x;
        momentum[1] += mass*u.y;
        *spin += mass*((p->position[i].x - middle)*u.y - (p->position[i].y - middle)*u.x);
    }
    for (int k = 0; k < w->sim.body_count; k++) {
        tobi_body_info b;
        OK(tobi_world_body(w, k, &b));
        momentum[0] += b.mass*b.velocity[0];
        momentum[1] += b.mass*b.velocity[1];
        *spin += b.inertia[8]*b.angular_velocity[2] +
                 b.mass*(b.position[0]*b.velocity[1] - b.position[1]*b.velocity[0]);
    }
}

/* It spins and flies. tobi_couple_dt would take 3000 steps of 20 us. Then all go on as one. By isph the
   pressure beside bodies keeps momentum to a few per cent only. */
static void what_a_body_loses_the_oil_gains(void **state)
{
    static const double lose[] = {1e-6, 0.04, 1e-6};
    (void)state;
    for (int m = 0; m < 3; m++) {
        tobi_world *w = make_patch(methods[m], DISC("disc", "0.1", "\"velocity\": [0.5, 0],"
                                                    " \"angular_velocity\": [0, 0, 20]"), "", 0.004, 2);
        double before[2], after[2], spin, spin_after;
        tobi_step_info info;
        tobi_body_info b;
        sum_momenta(w, before, &spin);
        OK(tobi_world_advance(w, SANITIZED ? 0.02 : 0.06, &info, &err));
        sum_momenta(w, after, &spin_after);
        OK(tobi_world_body(w, 0, &b));
        const double all = b.mass + (double)w->system[0].particles.count*0.064, common = before[0]/all;
        const double lost = hypot(after[0] - before[0], after[1] - before[1])/before[0];
        printf("%s: %lld steps, momentum lost %.1e, spin left %.4f, velocity over the common one %.4f\n",
               methods[m], (long long)info.step, lost, spin_after/spin, b.velocity[0]/common);
        if (!(info.step < 400)) fail_msg("%s: %lld steps", methods[m], (long long)info.step);
        if (!(lost < lose[m])) fail_msg("%s: momentum is not kept", methods[m]);
        if (!(fabs(spin_after/spin - 1) < 0.02)) fail_msg("%s: spin is not kept", methods[m]);
        if (!SANITIZED && !(fabs(b.velocity[0]/common - 1) < 0.05)) fail_msg("%s: not as one", methods[m]);
        tobi_world_destroy(w);
    }
}

static const double END = SANITIZED ? 4e-3 : 2e-2;               /* s */

/* Spin of the first body then, rad/s. */
static double end_spin(const char *method, int scene, double step_max, int threads, uint64_t *hash)
{
    static const char *const bodies[] = {
        DISC("disc", "0.1", "\"angular_velocity\": [0, 0, 20]"),
        DISC("disc", "0.1", "\"angular_velocity\": [0, 0, 20], \"hinge\": {\"point\": [0.02, 0, 0]}"),
        DISC("disc", "0.1", "\"angular_velocity\": [0, 0, 20]") ", "
        DISC("other", "0.05", "\"translation\": [0.07, 0, 0]")};
    static const char *const joints[] = {"", "", ", \"joints\": [{\"name\": \"elbow\", \"body\": \"disc\","
                                         " \"to_body\": \"other\", \"point\": [0.05, 0]}]"};
    tobi_world *w = make_patch(method, bodies[scene], joints[scene], step_max, threads);
    tobi_body_info b;
    OK(tobi_world_advance(w, END, NULL, &err));
    OK(tobi_world_body(w, 0, &b));
    if (hash) *hash = tobi_world_hash(w);
    tobi_world_destroy(w);
    return b.angular_velocity[2];
}

/* Alone, on a hinge, joined to another. */
static void the_step_does_not_count(void **state)
{
    (void)state;
    for (int m = 0; m < 2; m++)
        for (int k = 0; k < 3; k++) {
            const double many = end_spin(methods[m], k, 4e-4, 1, NULL);
            const double few = end_spin(methods[m], k, 2e-3, 1, NULL);
            printf("%s: spin after %g s %.4f, in a fifth of the steps %.4f\n", methods[m], END, many, few);
            if (!SANITIZED && !(fabs(few/many - 1) < 0.1))
                fail_msg("%s, scene %d: the step counts", methods[m], k);
        }
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    for (int m = 0; m < 4; m++) {
        uint64_t one, three;
        end_spin(methods[m], 2, 4e-3, 1, &one);
        end_spin(methods[m], 2, 4e-3, 3, &three);
        assert_true(one == three);
    }
}

/* By wcsph still oil was thrown out: its equation of state took again what viscosity had taken. */
static void still_oil_stays_still(void **state)
{
    (void)state;
    for (int m = 0; m < 4; m++) {
        char text[500];
        snprintf(text, sizeof text,
                 "{\"dimension\": 2, \"domain\": {\"min\": [0, 0], \"max\": [0.1, 0.15], \"walls\": {\"x\":"
                 " \"no-slip\", \"y\": \"no-slip\"}}, \"spacing\": 0.005, \"end_time\": 1,"
                 " \"method\": \"%s\","
                 " \"implicit_viscosity\": true, \"fluids\": [{\"name\": \"oil\", \"viscosity\": 100,"
                 " \"fill\": [{\"box\": {\"min\": [0, 0], \"max\": [0.1, 0.1]}}]}]}", methods[m]);
        tobi_world *w = make(text);
        tobi_step_info info;
        OK(tobi_world_advance(w, SANITIZED ? 0.02 : 0.1, &info, &err));
        printf("%s: %.2g m/s\n", methods[m], info.speed_max);
        if (!(info.speed_max < 0.01)) fail_msg("%s: %g m/s", methods[m], info.speed_max);
        tobi_world_destroy(w);
    }
}

/* A stirrer that slips feels next to no torque. */
static void a_body_that_slips_is_told(void **state)
{
    (void)state;
    for (int slips = 0; slips < 2; slips++) {
        const char *disc = slips ? "{\"name\": \"disc\", \"sphere\": {\"centre\": [0, 0], \"radius\": 0.05}}"
                                 : DISC("disc", "0.1", "\"velocity\": [0, 0]");
        tobi_world *w = make_patch("dfsph", disc, "", 0.004, 1);
        int told = 0;
        for (int n = 0; tobi_world_note(w, n); n++)
            told += strstr(tobi_world_note(w, n), "'disc': the liquid slips along it") != NULL;
        assert_int_equal(told, slips);
        tobi_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_a_body_loses_the_oil_gains),
        cmocka_unit_test(the_step_does_not_count),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(still_oil_stays_still),
        cmocka_unit_test(a_body_that_slips_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

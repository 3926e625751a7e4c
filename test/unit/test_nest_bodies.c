/* Bodies that move by forces in nests: the finer liquid moves them, as long as they are in the box; energies
   close; swimmers have the outer shape. */
#include "calls.h"
#include "nest_rig.h"
#include "record_rig.h"
#include "sph/sensor/probe.h"
#include "world/world.h"
#include <math.h>

/* A thin plate in a full vessel, 8 spacings of the outer world wide, pulled across. */
static const char plate[] =
    "{\"method\": \"%s\", \"dimension\": 2, \"domain\": {\"min\": [0, 0], \"max\": [0.8, 0.8]},"
    " \"gravity\": [0, 0],"
    " \"spacing\": %g, \"end_time\": 1, \"threads\": 1, \"fluids\": [{\"name\": \"water\", \"viscosity\": 0,"
    " \"fill\": [{\"box\": {\"min\": [0, 0], \"max\": [0.8, 0.8]}}]}],"
    " \"bodies\": [{\"name\": \"plate\", \"box\": {\"min\": [0.32, 0.398], \"max\": [0.48, 0.402]},"
    " \"dynamics\": \"free\", \"mass\": 10, \"force\": [0, 10, 0], \"friction\": \"slip\","
    " \"locked\": \"x,turn_z\"}]%s}";
static const char nest_around[] =
    ", \"nests\": [{\"name\": \"near\", \"box\": {\"min\": [0.2, 0.28], \"max\": [0.6, 0.52]}}]";
static const char nest_beside[] =
    ", \"nests\": [{\"name\": \"near\", \"box\": {\"min\": [0.2, 0.28], \"max\": [0.46, 0.52]}}]";

static nest_rig make_plate(const char *method, double spacing, const char *nests)
{
    char text[1200];
    nest_rig a;
    snprintf(text, sizeof text, plate, method, spacing, nests);
    OK(nest_rig_build(text, &a, &err));
    OK(tobi_nests_create(a.scene, a.world, &a.nests, &err));
    return a;
}

typedef struct gone { double velocity, kinetic, given, by_nest; } gone;

static gone pull(nest_rig *a, double t)
{
    gone g = { 0 };
    tobi_body_info b;
    tobi_body_energy e;
    while (tobi_world_time(a->world) < t - 1e-12) {
        OK(tobi_world_step_to(a->world, t, &err));
        OK(tobi_world_body_energy(a->world, 0, &e));
        const double dt = tobi_world_info(a->world)->dt;
        g.given += dt*(e.power + e.force_power + e.nest_power);
        g.by_nest += dt*e.nest_power;
        OK(tobi_nests_follow(a->nests, &err));
    }
    OK(tobi_world_body(a->world, 0, &b));
    g.velocity = b.velocity[1];
    g.kinetic = e.kinetic;
    return g;
}

static gone pull_plate(const char *method, double spacing, const char *nests)
{
    nest_rig a = make_plate(method, spacing, nests);
    const gone g = pull(&a, 0.3);
    nest_rig_drop(&a);
    return g;
}

/* The coarse liquid makes the plate too heavy. In a nest a third of that is left at most, by a first run. */
static void the_finer_liquid_moves_a_body(void **state)
{
    (void)state;
    const gone coarse = pull_plate("isph", 0.02, ""), fine = pull_plate("isph", 0.01, ""),
               nest = pull_plate("isph", 0.02, nest_around);
    const double off = (nest.velocity - fine.velocity)/(fine.velocity - coarse.velocity);
    if (!(fine.velocity > 1.05*coarse.velocity) || !(fabs(off) < 0.35))
        fail_msg("%g m/s in a coarse liquid, %g in a fine one, %g in a nest", coarse.velocity, fine.velocity,
                 nest.velocity);
    assert_true(nest.by_nest > 0);
    assert_true(coarse.by_nest == 0);
    assert_true(fabs(nest.given - nest.kinetic) < 1e-9*nest.kinetic);
}

/* A light plate that fills half of its tank is kicked. The liquid takes the velocity away: it does not swing.
   With all of the difference, or half of it, in each step, it swung ever more. */
static const char kicked[] =
    "{\"method\": \"isph\", \"dimension\": 2, \"domain\": {\"min\": [0, 0], \"max\": [0.8, 0.6]},"
    " \"gravity\": [0, 0], \"spacing\": 0.0125, \"end_time\": 1, \"threads\": 1,"
    " \"fluids\": [{\"name\": \"water\", \"viscosity\": 0.001,"
    " \"fill\": [{\"box\": {\"min\": [0, 0], \"max\": [0.8, 0.6]}}]}],"
    " \"bodies\": [{\"name\": \"plate\", \"box\": {\"min\": [0.175, 0.295], \"max\": [0.625, 0.305]},"
    " \"dynamics\": \"free\", \"mass\": 0.125, \"velocity\": [0, 0.1, 0]}],"
    " \"nests\": [{\"name\": \"near\", \"box\": {\"min\": [0.125, 0.15], \"max\": [0.675, 0.45]}}]}";

static void a_light_body_does_not_swing(void **state)
{
    (void)state;
    nest_rig a;
    OK(nest_rig_build(kicked, &a, &err));
    OK(tobi_nests_create(a.scene, a.world, &a.nests, &err));
    pull(&a, 0.1);
    for (int k = 0; k < 10; k++) {
        const gone g = pull(&a, 0.11 + 0.01*k);
        if (!(fabs(g.velocity) < 1e-3)) fail_msg("%g m/s after %g s", g.velocity, 0.11 + 0.01*k);
    }
    nest_rig_drop(&a);
}

/* Nor by a nest of dfsph, which measures alone. */
static void a_body_half_in_a_box_is_not_moved_by_it(void **state)
{
    (void)state;
    const gone coarse = pull_plate("isph", 0.02, ""), half = pull_plate("isph", 0.02, nest_beside);
    assert_true(half.velocity == coarse.velocity);
    assert_true(half.by_nest == 0);
    assert_true(pull_plate("dfsph", 0.02, nest_around).velocity == pull_plate("dfsph", 0.02, "").velocity);
}

/* A body that leaves the box is rid of what the nest gave, and so is one whose nest is gone. */
static void a_body_that_leaves_a_box_is_free_of_it(void **state)
{
    (void)state;
    nest_rig a = make_plate("isph", 0.02, nest_around);
    pull(&a, 0.05);
    tobi_rigid *r = &a.world->sim.bodies[0].rigid;
    assert_int_equal(r->finer_by, 1);
    assert_true(r->finer[1] != 0);
    OK(tobi_world_step_to(a.world, 0.06, &err));
    tobi_nests_world(a.nests, 0, NULL)->sim.nest.upper[1] = 0.3;      /* the box ends below the plate */
    OK(tobi_nests_follow(a.nests, &err));
    assert_int_equal(r->finer_by, 0);
    for (int k = 0; k < 6; k++) assert_true(r->finer[k] == 0);
    nest_rig_drop(&a);
    a = make_plate("isph", 0.02, nest_around);
    pull(&a, 0.05);
    r = &a.world->sim.bodies[0].rigid;
    assert_int_equal(r->finer_by, 1);
    tobi_nests_free(a.nests);
    a.nests = NULL;
    assert_int_equal(r->finer_by, 0);
    assert_true(r->finer[1] == 0);
    nest_rig_drop(&a);
}

static const char eel[] =
    "{\"method\": \"isph\", \"dimension\": 2, \"domain\": {\"min\": [0, 0], \"max\": [1, 0.6]},"
    " \"gravity\": [0, 0],"
    " \"spacing\": 0.02, \"end_time\": 1, \"threads\": 1,"
    " \"fluids\": [{\"name\": \"water\", \"viscosity\": 0.1,"
    " \"fill\": [{\"box\": {\"min\": [0, 0], \"max\": [1, 0.6]}}]}],"
    " \"bodies\": [{\"name\": \"eel\", \"dynamics\": \"free\", \"density\": 1000, \"box\": "
    "{\"min\": [0.3, 0.26], \"max\": [0.7, 0.34]}, \"motion\": {\"script\": \"%s\"}}],"
    " \"nests\": [{\"name\": \"near\", \"box\": {\"min\": [0.15, 0.12], \"max\": [0.85, 0.48]},"
    " \"follow\": \"eel\"}]}";

static double find_gap(const tobi_body *outer, const tobi_body *fine, double t, double *speed)
{
    const int64_t n = fine->mesh.vertex_count;
    double (*at)[3] = malloc((size_t)n*sizeof *at), most = 0;
    OK(tobi_body_locate(outer, t, n, (const double (*)[3])fine->mesh.vertices, at, &err));
    *speed = 0;
    for (int64_t k = 0; k < n; k++)
        for (int a = 0; a < 2; a++) {
            most = fmax(most, fabs(fine->vertex[k][a] + fine->lower[a] - at[k][a]));
            *speed = fmax(*speed, fabs(fine->vertex_velocity[k][a]));
        }
    free(at);
    return most;
}

/* Its tail goes at 0.08*0.4*8 = 0.26 m/s at most: a jump from step to step would be a greater speed. */
static void a_swimmer_has_the_outer_shape(void **state)
{
    (void)state;
    char text[1400];
    nest_rig a;
    write_file(at("swim.lua"), "function deform(x, y, z, t)\n"
               "    return x, y + 0.08*(x - 0.3)*math.sin(8*t - 6*x), z\nend\n");
    snprintf(text, sizeof text, eel, at("swim.lua"));
    OK(nest_rig_build(text, &a, &err));
    OK(tobi_nests_create(a.scene, a.world, &a.nests, &err));
    const tobi_body *outer = &a.world->sim.bodies[0];
    const tobi_body *fine = &tobi_nests_world(a.nests, 0, NULL)->sim.bodies[0];
    for (int k = 1; k <= 10; k++) {
        double speed;
        OK(tobi_world_step_to(a.world, 0.02*k, &err));
        OK(tobi_nests_follow(a.nests, &err));
        if (tobi_world_time(a.world) < 0.02*k - 1e-12) k--;
        const double gap = find_gap(outer, fine, tobi_world_time(a.world), &speed);
        if (!(gap < 1e-9) || !(speed < 0.4)) fail_msg("%g m off, at %g m/s", gap, speed);
    }
    assert_int_equal(outer->rigid.finer_by, 1);
    nest_rig_drop(&a);
}

/* A plate that is towed, and a nest that goes along: liquid comes in through the front of its box. */
static const char towed[] =
    "{\"method\": \"isph\", \"dimension\": 2, \"domain\": {\"min\": [0, 0], \"max\": [1.6, 0.8]},"
    " \"spacing\": %g, \"end_time\": 1, \"threads\": 1,"
    " \"fluids\": [{\"name\": \"water\", \"viscosity\": 0.001,"
    " \"fill\": [{\"box\": {\"min\": [0, 0], \"max\": [1.6, 0.7]}}]}],"
    " \"bodies\": [{\"name\": \"plate\", \"box\": {\"min\": [0.49, 0.3], \"max\": [0.51, 0.46]},"
    " \"motion\": {\"translation\": {\"velocity\": [0.8, 0, 0], \"ramp\": 0.05}}}]%s}";
static const char nest_along[] =
    ", \"nests\": [{\"name\": \"near\", \"box\": {\"min\": [0.3, 0.15], \"max\": [0.75, 0.6]},"
    " \"follow\": \"plate\"}]";

static nest_rig tow(double spacing, const char *nests)
{
    char text[1200];
    nest_rig a;
    snprintf(text, sizeof text, towed, spacing, nests);
    OK(nest_rig_build(text, &a, &err));
    OK(tobi_nests_create(a.scene, a.world, &a.nests, &err));
    while (tobi_world_time(a.world) < 0.1 - 1e-12) {
        OK(tobi_world_step_to(a.world, 0.1, &err));
        OK(tobi_nests_follow(a.nests, &err));
    }
    return a;
}

/* m/s, along x: mean of some heights. */
static double speed_at(const tobi_world *w, double x)
{
    double sum = 0;
    for (int k = 0; k < 9; k++) {
        const double at[3] = { x, 0.2 + 0.05*k, 0 };
        double pressure, u[3], change[3], scalar[TOBI_SCALAR_LIMIT];
        assert_true(tobi_probe_liquid(&w->system[0], at, &pressure, u, change, scalar) > 0);
        sum += u[0]/9;
    }
    return sum;
}

/* One spacing inside, the nest is far too slow, four inside a tenth too fast: docs/nests.md. The bound is by
   a first run. */
static void flow_through_the_side_of_a_box(void **state)
{
    (void)state;
    nest_rig a = tow(0.02, nest_along), fine = tow(0.01, "");
    const tobi_world *nest = tobi_nests_world(a.nests, 0, NULL);
    const double front = nest->sim.nest.upper[0];
    double off[2];
    for (int k = 0; k < 2; k++) {
        const double x = front - (k ? 0.04 : 0.01);
        off[k] = speed_at(nest, x)/speed_at(fine.world, x) - 1;
    }
    print_message("against the fine run: %.2f one spacing inside, %.2f four inside\n", off[0], off[1]);
    assert_true(fabs(off[1]) < 0.15);
    nest_rig_drop(&fine);
    nest_rig_drop(&a);
}

static int enter(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int leave(void **state)
{
    (void)state;
    return remove(at("swim.lua")) == 0 ? rmdir(folder) : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_finer_liquid_moves_a_body),
        cmocka_unit_test(a_light_body_does_not_swing),
        cmocka_unit_test(a_body_half_in_a_box_is_not_moved_by_it),
        cmocka_unit_test(a_body_that_leaves_a_box_is_free_of_it),
        cmocka_unit_test(a_swimmer_has_the_outer_shape), cmocka_unit_test(flow_through_the_side_of_a_box)
    };
    return cmocka_run_group_tests(tests, enter, leave);
}

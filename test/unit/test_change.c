/* What a program changes between steps: gravity, forces, motions. Stopping in between changes no bit. */
#include "calls.h"
#include "sph/state.h"
#include "sph/hydrostatic.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const char *const methods[] = { "dfsph", "wcsph", "mlsmpm" };
static const double WIDTH = 0.1, DOWN[3] = { 0, -9.81, 0 }, SLOPE[3] = { 3, -6, 0 };
enum { ROD, LEFT, RIGHT };      /* bodies: with a motion, and free ones */

static tobi_status swing(void *user, double t, int64_t n, const double (*rest)[3], double (*to)[3],
                         tobi_error *err)
{
    const double *far = user;
    (void)err;
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++) to[i][a] = rest[i][a] + (a == 0 ? *far*sin(20*t) : 0);
    return TOBI_OK;
}

/* Stands where the swing is at the time *user. */
static tobi_status hold(void *user, double t, int64_t n, const double (*rest)[3], double (*to)[3],
                        tobi_error *err)
{
    double far = 0.01;
    (void)t;
    return swing(&far, *(const double *)user, n, rest, to, err);
}

static double far = 0.01;

static void add_body(tobi_world *world, const char *name, double x, double y, int dynamics)
{
    tobi_body_def b = tobi_default_body_def();
    b.name = name;
    b.dynamics = dynamics;
    b.motion = dynamics == TOBI_PRESCRIBED ? swing : NULL;
    b.motion_user = &far;
    b.motion_rigid = 1;
    for (int a = 0; a < 2; a++) b.box_max[a] = (b.box_min[a] = a ? y : x) + 0.012;
    OK(tobi_world_add_body(world, &b, &err));
}

static tobi_world_def make_def(const char *method, const double gravity[3])
{
    tobi_world_def w = tobi_default_world_def();
    w.method = method;
    w.dimension = 2;
    w.domain_max[0] = w.domain_max[1] = WIDTH;
    w.domain_max[2] = 0;
    memcpy(w.gravity, gravity, sizeof w.gravity);
    w.spacing = 0.005;
    w.threads = 1;
    return w;
}

/* A pool up to `height`, or a block of a solid. */
static tobi_world *make_pool(const char *method, const double gravity[3], double height)
{
    const tobi_world_def w = make_def(method, gravity);
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_world *world;
    solid.youngs_modulus = 1e5;
    fill.box_max[0] = WIDTH;
    fill.box_max[1] = height;
    OK(tobi_world_create(&w, NULL, &world, &err));
    if (strcmp(method, "mlsmpm") == 0) OK(tobi_world_add_solid(world, &solid, &fill, 1, &err));
    else OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
    return world;
}

static tobi_world *make_world(const char *method, const double gravity[3])
{
    tobi_world *world = make_pool(method, gravity, 0.05);
    add_body(world, "rod", 0.02, 0.055, TOBI_PRESCRIBED);
    add_body(world, "left", 0.06, 0.06, TOBI_FREE);
    add_body(world, "right", 0.0725, 0.062, TOBI_FREE);
    return world;
}

/* Set before the start, or before the first step, is as good as defined. */
static void like_a_definition(void **state)
{
    (void)state;
    for (int m = 0; m < 3; m++) {
        tobi_world *world[3] = { make_pool(methods[m], SLOPE, 0.05), make_pool(methods[m], DOWN, 0.05),
                                 make_pool(methods[m], DOWN, 0.05) };
        OK(tobi_world_start(world[2], &err));
        tobi_world_hash(world[2]);
        for (int k = 1; k < 3; k++) OK(tobi_world_set_gravity(world[k], SLOPE, &err));
        for (int k = 0; k < 3; k++) OK(tobi_world_advance(world[k], 0.01, NULL, &err));
        assert_true(tobi_world_hash(world[0]) == tobi_world_hash(world[1]));
        assert_true(tobi_world_hash(world[0]) == tobi_world_hash(world[2]));
        for (int k = 0; k < 3; k++) tobi_world_destroy(world[k]);
    }
}

/* What gravity has set in motion goes on without it. */
static void gravity_that_ends(void **state)
{
    (void)state;
    static const char *const all[] = { "dfsph", "wcsph", "isph", "eisph", "mlsmpm" };
    for (int m = 0; m < 5; m++) {
        tobi_world *world = make_pool(all[m], SLOPE, 0.05);
        OK(tobi_world_advance(world, 0.05, NULL, &err));
        OK(tobi_world_set_gravity(world, (double[3]){ 0 }, &err));
        OK(tobi_world_advance(world, 0.07, NULL, &err));
        tobi_world_destroy(world);
    }
}

static void set_motion(tobi_world *world)
{
    static double since = 0.01;
    OK(tobi_world_set_body_motion(world, ROD, hold, &since, &err));
}

static void set_all(tobi_world *world)
{
    OK(tobi_world_set_gravity(world, SLOPE, &err));
    OK(tobi_world_set_body_force(world, LEFT, (double[3]){ 2, 1, 0 }, (double[3]){ 0, 0, 1e-3 }, &err));
    set_motion(world);
}

static void assert_same(tobi_world *a, tobi_world *b)
{
    tobi_body_info p, q;
    assert_true(tobi_world_hash(a) == tobi_world_hash(b));
    assert_true(tobi_world_info(a)->energy_lost == tobi_world_info(b)->energy_lost);
    assert_true(tobi_world_info(a)->potential_energy == tobi_world_info(b)->potential_energy);
    for (int k = 0; k < 3; k++) {
        OK(tobi_world_body(a, k, &p) ? TOBI_INVALID : TOBI_OK);
        OK(tobi_world_body(b, k, &q) ? TOBI_INVALID : TOBI_OK);
        assert_memory_equal(&p, &q, sizeof p);
    }
}

/* One world goes on, one is loaded after the change, one before it. */
static void stopped_and_not(void **state)
{
    (void)state;
    char before[] = "/tmp/tobiuo_change_XXXXXX", after[] = "/tmp/tobiuo_change_XXXXXX";
    close(mkstemp(before));
    close(mkstemp(after));
    for (int m = 0; m < 3; m++) {
        tobi_world *whole = make_world(methods[m], DOWN), *late = make_world(methods[m], DOWN),
                   *early = make_world(methods[m], DOWN);
        OK(tobi_world_advance(whole, 0.01, NULL, &err));
        OK(tobi_world_save(whole, before, &err));
        set_all(whole);
        OK(tobi_world_save(whole, after, &err));
        OK(tobi_world_advance(whole, 0.02, NULL, &err));
        OK(tobi_world_load(early, before, &err));
        set_all(early);
        OK(tobi_world_advance(early, 0.02, NULL, &err));
        assert_same(whole, early);
        OK(tobi_world_load(late, after, &err));
        REFUSED(tobi_world_step(late, 0, NULL, &err), TOBI_INVALID,
                "body 'rod' had its motion set before the checkpoint was written; set it again");
        set_motion(late);
        OK(tobi_world_advance(late, 0.02, NULL, &err));
        assert_same(whole, late);
        tobi_world_destroy(whole);
        tobi_world_destroy(late);
        tobi_world_destroy(early);
    }
    unlink(before);
    unlink(after);
}

static double *read_all(tobi_world *world, const char *field, int components)
{
    const int64_t n = tobi_world_count(world, TOBI_FLUID);
    double *out = calloc((size_t)(n*components) + 1, sizeof *out);
    assert_non_null(out);
    OK(tobi_world_read(world, TOBI_FLUID, field, out, n, &err));
    return out;
}

/* What the method has, and what still water adds, without the mean over neighbours that is read. */
static double *read_pressure(tobi_world *world)
{
    double *out = read_all(world, "pressure", 1);
    const tobi_particles *p = &world->system[0].particles;
    const sph_fields *f = sph_fields_of(p);
    for (int64_t r = 0; r < p->count; r++) {
        const int64_t i = world->system[0].row_of[r];
        const double x[3] = { p->position[i].x, p->position[i].y, p->position[i].z };
        out[r] = f->pressure[i] + sph_hydrostatic(&world->system[0], x);
    }
    return out;
}

/* The pressure is what it was until the next step, whichever part of it still water explains. */
static void pressures_stay(void **state)
{
    (void)state;
    for (int m = 0; m < 2; m++) {
        tobi_world *world = make_pool(methods[m], DOWN, 0.08);
        OK(tobi_world_advance(world, 0.02, NULL, &err));
        double *before = read_pressure(world), most = 0, worst = 0;
        OK(tobi_world_set_gravity(world, SLOPE, &err));
        double *after = read_pressure(world);
        for (int64_t i = 0; i < tobi_world_count(world, TOBI_FLUID); i++) {
            most = fmax(most, fabs(before[i]));
            worst = fmax(worst, fabs(after[i] - before[i]));
        }
        print_message("%s: pressures up to %g Pa change by %g\n", methods[m], most, worst);
        assert_true(most > 400 && worst < 1e-5*most);
        free(before);
        free(after);
        tobi_world_destroy(world);
    }
}

/* A pool, and a vessel full of water, at rest stay at rest under less and more gravity, and press with the
   new weight. */
static void water_takes_the_new_weight(void **state)
{
    (void)state;
    for (int full = 0; full < 2; full++)
        for (int more = 0; more < 2; more++) {
            const double gravity[3] = { 0, more ? -20 : -4, 0 };
            tobi_world *world = make_pool("dfsph", DOWN, full ? WIDTH : 0.08);
            tobi_step_info info;
            double share = 0, speed = 0;
            OK(tobi_world_advance(world, 0.1, &info, &err));
            const double weight = info.weight;
            OK(tobi_world_set_gravity(world, gravity, &err));
            for (int k = 0; k < 20; k++) {
                OK(tobi_world_step(world, 0, &info, &err));
                share += -info.wall_force[1]/info.weight/20;
                speed = fmax(speed, info.speed_max);
            }
            print_message("full %d, gravity %g: wall force %.4f of the weight, speed %.4f m/s\n", full,
                          gravity[1], share, speed);
            assert_true(fabs(info.weight/weight + gravity[1]/9.81) < 1e-9);
            assert_true(fabs(share - 1) < 0.05 && speed < 0.05);
            tobi_world_destroy(world);
        }
}

/* The work of the change is neither lost nor won by a solid. */
static void energy_of_solids(void **state)
{
    (void)state;
    tobi_world *world = make_pool("mlsmpm", DOWN, 0.05);
    OK(tobi_world_advance(world, 0.02, NULL, &err));
    const tobi_step_info before = *tobi_world_info(world);
    OK(tobi_world_set_gravity(world, (double[3]){ 0, -20, 0 }, &err));
    const tobi_step_info after = *tobi_world_info(world);
    assert_true(after.potential_energy > 1.9*before.potential_energy);
    assert_true(fabs(after.energy_lost - before.energy_lost) < 1e-9*after.potential_energy);
    tobi_world_destroy(world);
}

/* A body that flies: what it feels from the next step on, to the last place. */
static void bodies_feel_it(void **state)
{
    (void)state;
    tobi_world_def def = make_def("mlsmpm", DOWN);
    tobi_world *world;
    tobi_body_info a, b;
    def.domain_max[0] = def.domain_max[1] = 10;
    OK(tobi_world_create(&def, NULL, &world, &err));
    add_body(world, "left", 5, 5, TOBI_FREE);
    OK(tobi_world_step(world, 1e-3, NULL, &err));
    REFUSED(tobi_world_set_gravity(world, (double[3]){ 0, 0, 7 }, &err), TOBI_INVALID,
            "gravity is 7 m/s2 in z, must be 0 in a 2-D world");
    OK(tobi_world_set_gravity(world, (double[3]){ 0 }, &err));
    OK(tobi_world_body(world, 0, &a));
    OK(tobi_world_step(world, 1e-3, NULL, &err));
    OK(tobi_world_body(world, 0, &b));
    assert_true(a.velocity[1] < 0 && memcmp(a.velocity, b.velocity, sizeof a.velocity) == 0);
    assert_true(fabs(b.position[1] - a.position[1] - 1e-3*a.velocity[1]) < 1e-14);
    OK(tobi_world_set_body_force(world, 0, (double[3]){ 3*b.mass, 0, 0 }, (double[3]){ 0, 0, b.inertia[8] },
                                 &err));
    REFUSED(tobi_world_set_body_force(world, 0, (double[3]){ 0, 0, -9 }, (double[3]){ 0 }, &err),
            TOBI_INVALID,
            "body 'left': the force is -9 N in z, the torque (0, 0) N m about x and y; in a 2-D world");
    OK(tobi_world_step(world, 1e-3, NULL, &err));
    OK(tobi_world_body(world, 0, &a));
    assert_true(fabs(a.velocity[0] - 3e-3) < 1e-15 && fabs(a.angular_velocity[2] - 1e-3) < 1e-12);
    assert_true(fabs(a.position[0] - b.position[0] - 0.5*3e-6) < 1e-14);
    tobi_world_destroy(world);
}

static tobi_status mute(void *user, double t, int64_t n, const double (*rest)[3], double (*to)[3],
                        tobi_error *err)
{
    (void)user, (void)t, (void)n, (void)rest, (void)to;
    if (err) snprintf(err->text, sizeof err->text, "mute");
    return TOBI_SCRIPT;
}

/* That of the defaults, which a 2-D world has not. */
static void gravity_along_z_is_told(void)
{
    const tobi_world_def spare = make_def("dfsph", (double[3]){ 0, 0, -9.81 });
    tobi_world *w;
    OK(tobi_world_create(&spare, NULL, &w, &err));
    assert_non_null(strstr(tobi_world_note(w, 0), "'gravity': is along z alone, and a 2-D world has no z"));
    tobi_world_destroy(w);
}

static void refusals(void **state)
{
    (void)state;
    const double zero[3] = { 0, 0, 0 }, nan[3] = { 0, NAN, 0 }, much[3] = { 0, 1e7, 0 };
    static double wide = 0.05;
    tobi_world *world = make_world("dfsph", DOWN);
    OK(tobi_world_advance(world, 0.01, NULL, &err));
    const uint64_t hash = tobi_world_hash(world);
    gravity_along_z_is_told();
    REFUSED(tobi_world_set_gravity(NULL, zero, &err), TOBI_INVALID, "world is NULL");
    REFUSED(tobi_world_set_gravity(world, NULL, &err), TOBI_INVALID, "the gravity is NULL");
    REFUSED(tobi_world_set_gravity(world, nan, &err), TOBI_INVALID,
            "gravity is (0, nan, 0) m/s2; allowed are numbers from -1e+06 to 1e+06");
    REFUSED(tobi_world_set_gravity(world, much, &err), TOBI_INVALID, "gravity is (0, 1e+07, 0) m/s2");
    REFUSED(tobi_world_set_body_force(world, LEFT, NULL, zero, &err), TOBI_INVALID, "is NULL");
    REFUSED(tobi_world_set_body_force(world, 3, zero, zero, &err), TOBI_NOT_FOUND,
            "there is no body 3; they count from 0, and the world has 3");
    REFUSED(tobi_world_set_body_force(world, -1, zero, zero, &err), TOBI_NOT_FOUND, "there is no body -1");
    REFUSED(tobi_world_set_body_force(world, ROD, zero, zero, &err), TOBI_INVALID,
            "body 'rod' is prescribed; free and controlled bodies take forces");
    REFUSED(tobi_world_set_body_force(world, LEFT, zero, nan, &err), TOBI_INVALID,
            "body 'left': the force is (0, 0, 0) N, the torque (0, nan, 0) N m; allowed are");
    REFUSED(tobi_world_set_body_motion(world, ROD, NULL, NULL, &err), TOBI_INVALID, "the motion is NULL");
    REFUSED(tobi_world_set_body_motion(world, 9, swing, &wide, &err), TOBI_NOT_FOUND, "there is no body 9");
    REFUSED(tobi_world_set_body_motion(world, LEFT, swing, &wide, &err), TOBI_INVALID,
            "body 'left' has no motion that could be replaced");
    REFUSED(tobi_world_set_body_motion(world, ROD, swing, &wide, &err), TOBI_INVALID,
            "body 'rod' would jump by 0.00795 m: its new motion has it elsewhere at t = 0.01 s; allowed are "
            "0.0005 m");
    REFUSED(tobi_world_set_body_motion(world, ROD, mute, NULL, &err), TOBI_SCRIPT, "mute");
    assert_true(tobi_world_hash(world) == hash);
    tobi_world *other = make_world("dfsph", DOWN);
    OK(tobi_world_advance(other, 0.01, NULL, &err));
    OK(tobi_world_step(world, 0, NULL, &err));
    OK(tobi_world_step(other, 0, NULL, &err));
    assert_true(tobi_world_hash(world) == tobi_world_hash(other));
    tobi_world_destroy(world);
    tobi_world_destroy(other);
}

/* Domains that fast gravity makes too long to fall through. */
static void too_deep(void **state)
{
    (void)state;
    tobi_world_def def = make_def("mlsmpm", DOWN);
    tobi_world *world;
    def.domain_max[0] = def.domain_max[1] = 1e6;
    def.spacing = 1e3;
    OK(tobi_world_create(&def, NULL, &world, &err));
    REFUSED(tobi_world_set_gravity(world, (double[3]){ 9e5, 9e5, 0 }, &err), TOBI_INVALID,
            "gravity makes what falls through the domain 1.9e+06 m/s fast");
    tobi_world_destroy(world);
}

/* Ids name particles in the order of the rows, as integers and as numbers, by either name. */
static void ids(void **state)
{
    (void)state;
    tobi_world *world = make_world("dfsph", DOWN);
    OK(tobi_world_advance(world, 0.01, NULL, &err));
    const int64_t fluid = tobi_world_count(world, TOBI_FLUID), bodies = tobi_world_count(world, TOBI_BODIES);
    int64_t *id = calloc((size_t)(fluid + bodies), sizeof *id);
    double *by_name = read_all(world, "id", 1), *by_other = read_all(world, "particle_id", 1);
    OK(tobi_world_read_ids(world, TOBI_FLUID, id, fluid, &err));
    OK(tobi_world_read_ids(world, TOBI_BODIES, id + fluid, bodies, &err));
    for (int64_t i = 0; i < fluid; i++) assert_true(by_name[i] == (double)id[i] && by_other[i] == by_name[i]);
    for (int64_t i = 0; i < fluid + bodies; i++) assert_int_equal(id[i], i);
    OK(tobi_world_read(world, TOBI_BODIES, "id", by_name, fluid, &err));
    assert_true(bodies > 0 && bodies < fluid && by_name[bodies - 1] == (double)(fluid + bodies - 1));
    REFUSED(tobi_world_read_ids(world, TOBI_FLUID, id, 3, &err), TOBI_INVALID, "field 'id' has");
    REFUSED(tobi_world_read_ids(NULL, TOBI_FLUID, id, 3, &err), TOBI_INVALID, "world is NULL");
    REFUSED(tobi_world_read_ids(world, TOBI_FLUID, NULL, 3, &err), TOBI_INVALID, "the buffer is NULL");
    free(id);
    free(by_name);
    free(by_other);
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(like_a_definition), cmocka_unit_test(gravity_that_ends),
        cmocka_unit_test(stopped_and_not),
        cmocka_unit_test(pressures_stay),    cmocka_unit_test(water_takes_the_new_weight),
        cmocka_unit_test(energy_of_solids),  cmocka_unit_test(bodies_feel_it),
        cmocka_unit_test(refusals),          cmocka_unit_test(too_deep),
        cmocka_unit_test(ids),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

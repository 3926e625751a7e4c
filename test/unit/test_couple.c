/* How easily water moves a body, and sound: what bounds the steps of an explicit coupling; the loads on a
   body, and their sums over what particles see of it. */
#include "calls.h"
#include "mpm/contact/contact.h"
#include "sph/boundary/boundary.h"
#include "sph/hydrostatic.h"
#include "sph/state.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>

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
    double value = tobi_couple_compliance(&w->system[0]);
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

/* A pool with a box that floats in it, after a step. */
static tobi_world *make_pool(void)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def b = tobi_default_body_def();
    tobi_world *w;
    def.spacing = 0.02;
    b.name = "box";
    b.density = 500;
    b.dynamics = TOBI_FREE;
    for (int a = 0; a < 3; a++) {
        def.domain_max[a] = fill.box_max[a] = 0.2;
        b.box_min[a] = 0.06;
        b.box_max[a] = 0.14;
    }
    def.domain_max[2] = 0.3;
    OK(tobi_world_create(&def, NULL, &w, &err));
    OK(tobi_world_add_fluid(w, &fluid, &fill, 1, &err));
    OK(tobi_world_add_body(w, &b, &err));
    OK(tobi_world_step(w, 1e-3, NULL, &err));
    return w;
}

/* The force on a body in two liquids is the sum, and each of them gives the body the impulse of its own. */
static void loads_of_two_systems_add_up(void **state)
{
    (void)state;
    tobi_world *w = make_pool();
    tobi_system *s = &w->system[0];
    tobi_body *b = &w->sim.bodies[0];
    tobi_contacts none = {0};
    const tobi_contact_step solids = {.dt = s->dt, .whole = s->dt, .system = 1, .dimension = 3};
    tobi_contact_work work = {0};
    double far = 0;
    assert_true(b->info.pressure_force[2] > 2);      /* N, of 5 N at rest */
    assert_true(b->info.pressure_force[2] == b->load[0].pressure[2]);
    tobi_body_clear_loads(b);
    for (s->number = 0; s->number < 2; s->number++) {
        tobi_boundary_load(s);
        sph_add_hydrostatic(s);
    }
    tobi_contact_finish(&none, &s->particles, b, &solids, &far, &work, &s->sim->exec);
    const double *one = b->load[0].pressure;
    assert_memory_equal(&b->load[1], &b->load[0], sizeof b->load[0]);
    tobi_body_sum_loads(b);
    for (int a = 0; a < 3; a++) {
        assert_true(b->info.pressure_force[a] == 2*one[a] && b->info.pressure_torque[a] == 2*one[3 + a]);
        assert_true(b->info.viscous_force[a] == 2*b->load[0].friction[a]);
    }
    memset(b->rigid.impulse, 0, sizeof b->rigid.impulse);
    for (s->number = 0; s->number < 2; s->number++) {
        tobi_couple_finish(s);
        const double own = s->dt*(one[2] + b->load[0].friction[2]);
        assert_true(fabs(b->rigid.impulse[2]/((s->number + 1)*own) - 1) < 1e-12);
    }
    s->number = 0;
    tobi_world_destroy(w);
}

/* A pool of 16 spacings with 4^3 boxes of two. */
static tobi_world *make_boxes(void)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *w;
    def.spacing = 0.02;
    for (int a = 0; a < 3; a++) def.domain_max[a] = fill.box_max[a] = 0.32;
    def.domain_max[2] = 0.4;
    OK(tobi_world_create(&def, NULL, &w, &err));
    OK(tobi_world_add_fluid(w, &fluid, &fill, 1, &err));
    for (int k = 0; k < 64; k++) {
        const int place[3] = {k%4, k/4%4, k/16};
        tobi_body_def b = tobi_default_body_def();
        char name[16];
        snprintf(name, sizeof name, "box%d", k);
        b.name = name;
        b.dynamics = TOBI_FREE;
        for (int a = 0; a < 3; a++) {
            b.box_min[a] = 0.08*place[a] + 0.0201;
            b.box_max[a] = b.box_min[a] + 0.04;
        }
        OK(tobi_world_add_body(w, &b, &err));
    }
    OK(tobi_world_step(w, 1e-4, NULL, &err));
    return w;
}

typedef struct chosen { const tobi_system *s; int body; } chosen;

/* Of the entries of one body, or with body < 0 of all. */
static void sum_gradients(const void *view, int64_t begin, int64_t end, double *t)
{
    const chosen *c = view;
    for (int64_t k = begin; k < end; k++) {
        const tobi_boundary_link *e = &sph_of(c->s)->links.link[k];
        if (c->body >= 0 && e->body != c->body) continue;
        for (int a = 0; a < 3; a++) t[a] += e->gradient[a];
    }
}

/* More particles see bodies than there are particles: sums have room for them, and each is to the bit that of
   a launch for its body alone. */
static void sums_of_all_bodies_at_once(void **state)
{
    (void)state;
    tobi_world *w = make_boxes();
    tobi_system *s = &w->system[0];
    tobi_boundary_links *n = &sph_of(s)->links;
    double t[TOBI_TOTALS];
    assert_true(n->count > 5000 && n->count > s->particles.count);
    assert_int_equal(n->first[64], n->count);
    OK(tobi_exec_reserve(&s->sim->exec, n->count, &err));
    for (int own = 0; own < 2; own++) {
        tobi_boundary_sum(s, TOBI_HOST(sum_gradients, 3, 0), &(chosen){s, -1}, own);
        for (int k = 0; k < 64; k++) {
            const chosen one = {s, k};
            tobi_launch(&s->sim->exec, TOBI_HOST(sum_gradients, 3, 0), &one, own ? n->first[k] : 0,
                        own ? n->first[k + 1] : n->count, t);
            assert_true(t[0] != 0);
            assert_memory_equal(t, n->total[k], 3*sizeof *t);
        }
    }
    tobi_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loads_of_two_systems_add_up),
        cmocka_unit_test(sums_of_all_bodies_at_once),
        cmocka_unit_test(boxes),
        cmocka_unit_test(a_step_longer_than_sound_allows_is_told),
        cmocka_unit_test(prescribed_bodies_have_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Contacts found with the memory of earlier searches are those of a search that remembers nothing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "tobiuo/tobiuo.h"
#include "mpm/contact/contact.h"
#include "mpm/particle_fields.h"
#include "world/world.h"
#include <math.h>
#include <string.h>

static const double SPACING = 0.01;

/* A block of particles and beside it a small body: a bar that is far from round, or a blade. */
static tobi_world *make_world(int dimension, int blade)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def body = tobi_default_body_def();
    tobi_world *world = NULL;
    tobi_error err = { 0 };
    w.method = "mlsmpm";
    w.dimension = dimension;
    w.spacing = SPACING;
    w.threads = 2;
    for (int a = 0; a < dimension; a++) {
        w.domain_max[a] = 0.4;
        fill.box_min[a] = 0.05;
        fill.box_max[a] = 0.35;
        body.box_min[a] = a == 0 ? 0.375 : 0.15;
        body.box_max[a] = a == 0 ? 0.385 : 0.25;
    }
    body.name = "bar";
    if (blade) {
        body.blade = 1;
        body.edge_start[0] = body.edge_end[0] = 0.38;
        body.edge_start[1] = body.edge_end[1] = 0.15;
        if (dimension == 3) {
            body.edge_start[2] = 0.15;
            body.edge_end[2] = 0.25;
        }
    }
    if (tobi_world_create(&w, NULL, &world, &err) || tobi_world_add_solid(world, &solid, &fill, 1, &err) ||
        tobi_world_add_body(world, &body, &err) || tobi_world_start(world, &err))
        fail_msg("%s", err.text);
    return world;
}

/* A number from -1 to 1 that looks random. */
static double draw(uint32_t *seed)
{
    *seed = *seed*1664525u + 1013904223u;
    return (*seed >> 8)/8388608.0 - 1;
}

/* Moves the particles by at most `way` along each axis, and the body by about as much; it turns, too. */
static void move_all(tobi_world *world, double way, uint32_t *seed)
{
    tobi_system *s = &world->system[0];
    tobi_rigid *r = &s->sim->bodies[0].rigid;
    double q[4] = {1, 0, 0, way/0.05*draw(seed)}, length = 0;
    for (int64_t i = 0; i < s->particles.count; i++)
        for (int a = 0; a < s->box.dimension; a++) (&s->particles.position[i].x)[a] += way*draw(seed);
    for (int a = 0; a < s->box.dimension; a++) r->position[a] += way*draw(seed);
    for (int a = 1; a < 3 && s->box.dimension == 3; a++) q[a] = way/0.05*draw(seed);
    for (int a = 0; a < 4; a++) length += q[a]*q[a];
    for (int a = 0; a < 4; a++) q[a] /= sqrt(length);
    tobi_quaternion_product(q, r->orientation, r->orientation);
}

/* Two particles in three remember the blade's cut: either side of it, up to 1.5 spacings from it. */
static void mark_some(tobi_system *s, uint32_t *seed)
{
    s->sim->bodies[0].rigid.cut = 1;
    for (int64_t i = 0; i < s->particles.count; i++) {
        const float side = draw(seed) < 0 ? -1 : 1, away = (float)(0.75*SPACING*(1 + draw(seed)));
        mpm_fields_of(&s->particles)->cuts[i].c[0] = (tobi_float4){away, 0, 0, draw(seed) < 0.33 ? side : 0};
    }
}

static int64_t compare(const tobi_contacts *a, const tobi_contacts *b)
{
    assert_int_equal(a->count, b->count);
    for (int64_t k = 0; k < a->count; k++) {
        assert_int_equal(a->list[k].particle, b->list[k].particle);
        assert_true(a->list[k].gap == b->list[k].gap);
        assert_memory_equal(a->list[k].normal, b->list[k].normal, sizeof a->list[k].normal);
    }
    return a->count;
}

/* A walk of 60 steps in which particles and body move by `way` spacings each. blade: 2 is one whose edge cuts
   one way, whichever way it goes. */
static int64_t walk(int dimension, int blade, double way)
{
    tobi_world *world = make_world(dimension, blade);
    tobi_system *s = &world->system[0];
    tobi_exec *x = &s->sim->exec;
    tobi_contacts fast = { 0 }, fresh = { 0 };
    const tobi_contact_step step = { .dt = 1e-4, .radius = 0.5*SPACING, .reach = 2*SPACING,
                                     .margin = way*SPACING, .rest_speed = 0.01, .dimension = dimension };
    uint32_t seed = 1;
    int64_t found = 0;
    s->sim->bodies[0].rigid.position[0] -= 0.18;            /* into the middle of the block */
    if (blade) s->sim->bodies[0].rigid.velocity[1] = -1;
    if (blade == 2) s->sim->bodies[0].edge->ahead[1] = -1;
    for (int n = 0; n < 60; n++) {
        if (n > 0) move_all(world, way*SPACING, &seed);
        if (blade && n%25 == 5) {                      /* five steps with nothing cut */
            mark_some(s, &seed);
            fast.marked = 1;
        }
        assert_int_equal(tobi_contact_begin(&fast, &s->particles, n*way*SPACING, x, NULL), TOBI_OK);
        assert_int_equal(tobi_contact_begin(&fresh, &s->particles, 0, x, NULL), TOBI_OK);
        assert_int_equal(tobi_contact_find(&fast, &s->particles, &s->sim->bodies[0], &step, x, NULL),
                         TOBI_OK);
        assert_int_equal(tobi_contact_find(&fresh, &s->particles, &s->sim->bodies[0], &step, x, NULL),
                         TOBI_OK);
        found += compare(&fast, &fresh);
    }
    tobi_contact_free(&fast);
    tobi_contact_free(&fresh);
    tobi_world_destroy(world);
    return found;
}

static void memory_changes_no_contact(void **state)
{
    (void)state;
    const double ways[] = { 0.003, 0.03, 0.3 };
    for (int dimension = 2; dimension <= 3; dimension++)
        for (int blade = 0; blade < 3; blade++)
            for (int k = 0; k < 3; k++) assert_true(walk(dimension, blade, ways[k]) > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(memory_changes_no_contact) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Solids that are not bonded: they part without force, meet only when they touch, keep momentum, slide on one
   another with friction, and neither threads nor a restart change a bit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/param.h"
#include "world/world.h"

#define SPACING 0.01
#define OK(call)                                                          \
    do {                                                                  \
        tobi_error err = { 0 };                                           \
        if ((call) != TOBI_OK) fail_msg("%s: %s", #call, err.text);       \
    } while (0)

/* Two blocks, and how they start: the second at `gap` above the first along the last axis. */
typedef struct pair {
    int dimension, transfer, threads, bonded, lower;   /* lower: model of the first           */
    double gap, speed, aside, mu;                      /* m; m/s apart; m/s, of the second    */
    double gravity[2];                                 /* m/s2, along the first, the last     */
    double shift, long_side;                           /* cells into the grid; m              */
} pair;

static tobi_world *make_pair(const pair *p)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_mlsmpm_def method;
    tobi_world *world;
    const int up = p->dimension - 1;
    tobi_param_defaults(tobi_method_table("mlsmpm"), &method);
    method.transfer = p->transfer;
    w.method = "mlsmpm";
    w.dimension = p->dimension;
    w.spacing = SPACING;
    w.threads = p->threads;
    w.time_step = 2e-4;
    for (int a = 0; a < p->dimension; a++) {
        w.domain_min[a] = -0.4;
        w.domain_max[a] = a == 0 ? 0.4 + p->long_side : 0.6;
        w.wall_min[a] = w.wall_max[a] = TOBI_WALL_OPEN;
        w.gravity[a] = a == 0 ? p->gravity[0] : a == up ? p->gravity[1] : 0;
    }
    if (p->dimension == 2) w.gravity[2] = 0;
    OK(tobi_world_create(&w, &method, &world, &err));
    for (int k = 0; k < 2; k++) {
        const double base = 2*p->shift*SPACING + k*(8*SPACING + p->gap);
        solid.name = k ? "upper" : "lower";
        solid.model = k ? TOBI_NEO_HOOKEAN : p->lower;
        solid.bonded = p->bonded;
        solid.surface_friction = p->mu;
        for (int a = 0; a < p->dimension; a++) {
            fill.box_min[a] = a == up ? base : 0;
            fill.box_max[a] = fill.box_min[a] + 8*SPACING;
            fill.velocity[a] = a == up ? (k ? p->speed : -p->speed) : a == 0 && k ? p->aside : 0;
        }
        if (k == 0) fill.box_max[0] += p->long_side;
        OK(tobi_world_add_solid(world, &solid, &fill, 1, &err));
    }
    OK(tobi_world_start(world, &err));
    return world;
}

static void wait(tobi_world *world, double seconds)
{
    OK(tobi_world_advance(world, tobi_world_time(world) + seconds, NULL, &err));
}

/* Mean velocity of a block along an axis, m/s. */
static double speed_of(tobi_world *world, int block, int axis)
{
    const int64_t n = tobi_world_count(world, TOBI_FLUID);
    double (*u)[3] = malloc((size_t)n*sizeof *u), *material = malloc((size_t)n*sizeof *material), sum = 0;
    int64_t count = 0;
    OK(tobi_world_read(world, TOBI_FLUID, "velocity", u[0], n, &err));
    OK(tobi_world_read(world, TOBI_FLUID, "material", material, n, &err));
    for (int64_t i = 0; i < n; i++)
        if ((int)material[i] == block) { sum += u[i][axis]; count++; }
    free(u);
    free(material);
    return sum/(double)count;
}

static void they_part_without_force(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (int transfer = TOBI_APIC; transfer <= TOBI_XPIC; transfer++)
            for (int bonded = 0; bonded < 2; bonded++) {
                const pair p = { .dimension = dim, .transfer = transfer, .threads = 2, .bonded = bonded,
                                 .speed = 0.2, .shift = 0.3 };
                tobi_world *world = make_pair(&p);
                wait(world, 4e-3);
                const double lost = 1 - speed_of(world, 1, dim - 1)/p.speed;
                printf("%d-D, transfer %d, %s: %.1e of the speed lost in parting\n", dim, transfer,
                       bonded ? "bonded" : "apart", lost);
                if (bonded) assert_true(lost > 0.01);
                else assert_true(fabs(lost) < 1e-6);
                tobi_world_destroy(world);
            }
}

static void they_meet_when_they_touch(void **state)
{
    (void)state;
    for (int o = 0; o < 4; o++) {
        const pair p = { .dimension = 2, .threads = 1, .gap = 1.5*SPACING, .speed = -0.5, .shift = 0.25*o };
        tobi_world *world = make_pair(&p);
        wait(world, 1.2*SPACING);                          /* 0.3 spacings before they touch */
        const double early = 1 - speed_of(world, 1, 1)/p.speed;
        /* Normals at corners are a little off: one node of twenty may push. */
        assert_true(fabs(early) < 1e-3);
        wait(world, 0.02);
        const double up = speed_of(world, 1, 1), low = speed_of(world, 0, 1);
        printf("at %.2f cells: %.1e of the speed lost before, then %.3f and %.3f m/s\n", 0.25*o, early, up,
               low);
        assert_true(up > 0.1 && fabs(up + low) < 1e-5*fabs(p.speed));
        tobi_world_destroy(world);
    }
}

/* A block on a long one that does not move: g (sin - mu cos) at 30 degrees. */
static void they_slide(void **state)
{
    (void)state;
    const double mu[] = {0, 0.3, 0.7};
    for (int k = 0; k < 3; k++) {
        const pair p = { .dimension = 2, .threads = 1, .mu = mu[k], .gravity = {4.905, -8.4957},
                         .shift = 0.4, .long_side = 0.3, .lower = TOBI_STATIONARY };
        tobi_world *world = make_pair(&p);
        wait(world, 0.06);
        const double begin = speed_of(world, 1, 0);
        wait(world, 0.14);
        const double got = (speed_of(world, 1, 0) - begin)/0.14, want = fmax(0, 4.905 - mu[k]*8.4957);
        printf("friction %.1f: %.3f m/s2, expected %.3f\n", mu[k], got, want);
        /* 0.03 seen; a block that welds does not slide, and a wrong normal takes a tenth. */
        assert_true(fabs(got - want) < 0.1);
        assert_true(fabs(speed_of(world, 1, 1)) < 0.01);
        tobi_world_destroy(world);
    }
}

static void bits_stay(void **state)
{
    (void)state;
    char path[] = "/tmp/tobiuo_meet_XXXXXX";
    pair p = { .dimension = 3, .threads = 1, .speed = -0.3, .aside = 0.2, .mu = 0.3, .shift = 0.1 };
    close(mkstemp(path));
    tobi_world *one = make_pair(&p), *again = make_pair(&p);
    p.threads = 4;
    tobi_world *four = make_pair(&p);
    for (int n = 0; n < 30; n++) assert_int_equal(tobi_world_step(one, 0, NULL, NULL), TOBI_OK);
    OK(tobi_world_save(one, path, &err));
    OK(tobi_world_load(again, path, &err));
    for (int n = 0; n < 25; n++) {
        assert_int_equal(tobi_world_step(one, 0, NULL, NULL), TOBI_OK);
        assert_int_equal(tobi_world_step(again, 0, NULL, NULL), TOBI_OK);
    }
    for (int n = 0; n < 55; n++) assert_int_equal(tobi_world_step(four, 0, NULL, NULL), TOBI_OK);
    assert_true(tobi_world_hash(one) == tobi_world_hash(four));
    assert_true(tobi_world_hash(one) == tobi_world_hash(again));
    unlink(path);
    tobi_world_destroy(one);
    tobi_world_destroy(again);
    tobi_world_destroy(four);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(they_part_without_force),
        cmocka_unit_test(they_meet_when_they_touch),
        cmocka_unit_test(they_slide),
        cmocka_unit_test(bits_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

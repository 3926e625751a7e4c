/* Several systems in one world: a pool of dfsph or wcsph and a block of mlsmpm step together, each with the
   bits that it has alone. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "calls.h"
#include "world/world.h"

enum { POOL = 1, BLOCK = 2 };

static tobi_world *make_world(const char *method, int what, int threads)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def pool = tobi_default_fill_def(), block = tobi_default_fill_def();
    tobi_world *world;
    w.method = what == BLOCK ? "mlsmpm" : method;
    w.threads = threads;
    w.spacing = 0.01;
    w.time_step = strcmp(method, "dfsph") ? 2e-4 : 1e-3;
    for (int a = 0; a < 3; a++) {
        w.domain_max[a] = a == 0 ? 0.4 : 0.2;
        pool.box_max[a] = 0.1;
        block.box_min[a] = a == 0 ? 0.25 : 0.05;
        block.box_max[a] = a == 0 ? 0.35 : 0.15;
    }
    block.velocity[2] = -0.5;
    solid.youngs_modulus = 1e5;
    OK(tobi_world_create(&w, NULL, &world, &err));
    if (what & POOL) OK(tobi_world_add_fluid(world, &fluid, &pool, 1, &err));
    if (what & BLOCK) OK(tobi_world_add_solid(world, &solid, &block, 1, &err));
    return world;
}

/* Fields of n particles from row `first` on, owned by the caller. */
static double *read_rows(tobi_world *w, const char *field, int components, int64_t first, int64_t n)
{
    const int64_t all = tobi_world_count(w, TOBI_FLUID);
    double *rows = malloc((size_t)(all*components + 1)*sizeof *rows);
    OK(tobi_world_read(w, TOBI_FLUID, field, rows, all, &err));
    memmove(rows, rows + first*components, (size_t)(n*components)*sizeof *rows);
    return rows;
}

/* Those of `one` are the rows of `both` from `first` on, to the bit. */
static void compare(tobi_world *both, tobi_world *one, int64_t first, const char *field, int components)
{
    const int64_t n = tobi_world_count(one, TOBI_FLUID);
    double *a = read_rows(both, field, components, first, n), *b = read_rows(one, field, components, 0, n);
    if (memcmp(a, b, (size_t)(n*components)*sizeof *a) != 0) fail_msg("%s differs", field);
    free(a);
    free(b);
}

static void each_as_if_alone(void **state)
{
    (void)state;
    const char *const methods[] = { "dfsph", "wcsph" };
    for (int k = 0; k < 2; k++)
        for (int threads = 1; threads <= 2; threads++) {
            tobi_world *both = make_world(methods[k], POOL | BLOCK, threads);
            tobi_world *pool = make_world(methods[k], POOL, 1), *block = make_world(methods[k], BLOCK, 1);
            OK(tobi_world_start(both, &err));
            OK(tobi_world_advance(both, 0.02, NULL, &err));
            OK(tobi_world_advance(pool, 0.02, NULL, &err));
            OK(tobi_world_advance(block, 0.02, NULL, &err));
            const int64_t n = tobi_world_count(pool, TOBI_FLUID);
            assert_int_equal(tobi_world_count(both, TOBI_FLUID), n + tobi_world_count(block, TOBI_FLUID));
            compare(both, pool, 0, "position", 3);
            compare(both, pool, 0, "velocity", 3);
            compare(both, pool, 0, "pressure", 1);
            compare(both, block, n, "position", 3);
            compare(both, block, n, "velocity", 3);
            compare(both, block, n, "deformation_gradient", 9);
            tobi_world_destroy(both);
            tobi_world_destroy(pool);
            tobi_world_destroy(block);
        }
}

static void energies_are_sums(void **state)
{
    (void)state;
    tobi_step_info both, pool, block;
    tobi_world *w[3] = { make_world("dfsph", POOL | BLOCK, 1), make_world("dfsph", POOL, 1),
                         make_world("dfsph", BLOCK, 1) };
    OK(tobi_world_advance(w[0], 0.01, &both, &err));
    OK(tobi_world_advance(w[1], 0.01, &pool, &err));
    OK(tobi_world_advance(w[2], 0.01, &block, &err));
    assert_true(both.kinetic_energy == pool.kinetic_energy + block.kinetic_energy);
    assert_true(both.weight == pool.weight + block.weight);
    assert_true(both.elastic_energy == block.elastic_energy && block.elastic_energy > 0);
    assert_int_equal(both.divergence_iterations, pool.divergence_iterations);
    assert_int_equal(both.fluid_particles, pool.fluid_particles + block.fluid_particles);
    for (int k = 0; k < 3; k++) tobi_world_destroy(w[k]);
}

static void rows_ids_and_materials(void **state)
{
    (void)state;
    tobi_world *w = make_world("dfsph", POOL | BLOCK, 1);
    OK(tobi_world_start(w, &err));
    const int64_t n = tobi_world_count(w, TOBI_FLUID);
    double *id = read_rows(w, "particle_id", 1, 0, n), *material = read_rows(w, "material", 1, 0, n);
    for (int64_t r = 0; r < n; r++) {
        assert_true(id[r] == (double)r);
        assert_true(material[r] == (r < 1000 ? 0 : 1));
    }
    assert_int_equal(n, 2000);
    free(id);
    free(material);
    tobi_world_destroy(w);
}

static void a_restart_changes_nothing(void **state)
{
    (void)state;
    const char *path = "systems.h5";
    tobi_world *whole = make_world("dfsph", POOL | BLOCK, 1), *later = make_world("dfsph", POOL | BLOCK, 2);
    OK(tobi_world_advance(whole, 0.01, NULL, &err));
    OK(tobi_world_save(whole, path, &err));
    OK(tobi_world_load(later, path, &err));
    assert_true(tobi_world_hash(later) == tobi_world_hash(whole));
    OK(tobi_world_advance(whole, 0.03, NULL, &err));
    OK(tobi_world_advance(later, 0.03, NULL, &err));
    assert_true(tobi_world_hash(later) == tobi_world_hash(whole));
    tobi_world_destroy(whole);
    tobi_world_destroy(later);
    remove(path);
}

static void what_is_not_known_yet(void **state)
{
    (void)state;
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *dry = make_world("dfsph", 0, 1);
    for (int a = 0; a < 3; a++) fill.box_max[a] = 0.05;
    OK(tobi_world_add_solid(dry, &solid, &fill, 1, &err));
    REFUSED(tobi_world_start(dry, &err), TOBI_INVALID,
            "dfsph has no fluid; the method of solids alone is mlsmpm");
    tobi_world_destroy(dry);
}

/* A cube of 4 x 4 x 4 new particles in the air beside what is there. */
static void insert_cube(tobi_system *s, double x)
{
    const double d = s->smoothing.spacing;
    const tobi_start start = { .volume = d*d*d, .mass = 1000*d*d*d };
    int64_t first;
    OK(tobi_system_insert(s, 64, &first, &err));
    for (int k = 0; k < 64; k++) {
        s->particles.position[first + k] =
            (tobi_double3){ x + d*(k%4), 0.1 + d*(k/4%4), 0.1 + d*(k/16) };
        s->particles.velocity[first + k] = (tobi_float4){ 0.5f, 0, 0, 0 };
        if (s->method->place) s->method->place(s, first + k, &start);
    }
}

/* Sums are made block by block: there is memory for those of all rows that fit, however they came. */
static void memory_of_sums_grows_with_rows(void **state)
{
    (void)state;
    tobi_world *world = make_world("dfsph", POOL, 1);
    OK(tobi_world_start(world, &err));
    tobi_system *s = &world->system[0];
    for (int k = 0; k < 400; k++) {
        insert_cube(s, 0.3);
        assert_true(world->sim.exec.partial_blocks*TOBI_BLOCK >= s->particles.count);
    }
    tobi_world_destroy(world);
}

/* Rows come while the world runs: nobody's id changes, the new ones fall as everything does, and the result
   is the same for any number of threads. */
static void rows_can_be_inserted(void **state)
{
    static const char *const methods[] = { "dfsph", "wcsph", "mlsmpm", "isph", "eisph" };
    uint64_t hash[2];
    (void)state;
    for (int m = 0; m < 5; m++) {
        for (int threads = 1; threads <= 2; threads++) {
            tobi_world *world = make_world(methods[m], m == 2 ? BLOCK : POOL, threads);
            tobi_step_info info;
            for (int k = 0; k < 5; k++) OK(tobi_world_step(world, 0, NULL, &err));
            const int64_t before = tobi_world_count(world, TOBI_FLUID), after = before + 64;
            const double start = tobi_world_time(world);
            insert_cube(&world->system[0], m == 2 ? 0.05 : 0.3);
            for (int k = 0; k < 20; k++) OK(tobi_world_step(world, 0, &info, &err));
            assert_int_equal(tobi_world_count(world, TOBI_FLUID), after);
            assert_int_equal(info.fluid_particles, after);
            int64_t *ids = malloc((size_t)after*sizeof *ids);
            OK(tobi_world_read_ids(world, TOBI_FLUID, ids, after, &err));
            for (int64_t k = 0; k < after; k++) assert_int_equal(ids[k], k);
            free(ids);
            double *v = read_rows(world, "velocity", 3, before, 64);
            const double fallen = -9.81*(tobi_world_time(world) - start);
            for (int k = 0; k < 64; k++)
                if (!(fabs(v[3*k + 2] - fallen) < 0.05 && fabs(v[3*k] - 0.5) < 0.05))
                    fail_msg("%s: %g %g after %g", methods[m], v[3*k], v[3*k + 2], fallen);
            free(v);
            hash[threads - 1] = tobi_world_hash(world);
            OK(tobi_world_save(world, "inserted.h5", &err));
            tobi_world *later = make_world(methods[m], m == 2 ? BLOCK : POOL, threads);
            OK(tobi_world_load(later, "inserted.h5", &err));
            remove("inserted.h5");
            for (int k = 0; k < 2; k++) {
                tobi_world *w = k ? later : world;
                insert_cube(&w->system[0], m == 2 ? 0.2 : 0.05);
                for (int n = 0; n < 3; n++) OK(tobi_world_step(w, 0, NULL, &err));
            }
            assert_true(tobi_world_hash(later) == tobi_world_hash(world));
            tobi_world_destroy(world);
            tobi_world_destroy(later);
        }
        assert_true(hash[0] == hash[1]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_as_if_alone),
        cmocka_unit_test(energies_are_sums),
        cmocka_unit_test(rows_ids_and_materials),
        cmocka_unit_test(a_restart_changes_nothing),
        cmocka_unit_test(what_is_not_known_yet),
        cmocka_unit_test(rows_can_be_inserted),
        cmocka_unit_test(memory_of_sums_grows_with_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Worlds of solids and what several tests do with them: step, read, go on from a file. */
#pragma once
#include "calls.h"
#include "tobiuo/tobiuo.h"
#include <stdlib.h>
#include <unistd.h>

/* One solid of one fill in a world of mlsmpm, to be changed before solid_world. */
typedef struct solid_setup {
    tobi_world_def world;
    tobi_mlsmpm_def method;
    tobi_solid_def solid;
    tobi_fill_def fill;
} solid_setup;

/* The domain and the fill are boxes from 0 to `size` (m) along every axis. */
static inline solid_setup solid_default(int dimension, double spacing, double size)
{
    solid_setup s = { tobi_default_world_def(), tobi_default_mlsmpm_def(), tobi_default_solid_def(),
                      tobi_default_fill_def() };
    s.world.method = "mlsmpm";
    s.world.dimension = dimension;
    s.world.spacing = spacing;
    for (int a = 0; a < dimension; a++) s.world.domain_max[a] = s.fill.box_max[a] = size;
    return s;
}

static inline tobi_world *solid_world(const solid_setup *s)
{
    tobi_world *world;
    OK(tobi_world_create(&s->world, &s->method, &world, &err));
    OK(tobi_world_add_solid(world, &s->solid, &s->fill, 1, &err));
    return world;
}

static inline void solid_step(tobi_world *world, int steps)
{
    for (int k = 0; k < steps; k++) OK(tobi_world_step(world, 0, NULL, &err));
}

/* A field of all particles; the caller frees. */
static inline double *solid_read(tobi_world *world, const char *field, int components)
{
    int64_t n = tobi_world_count(world, TOBI_FLUID);
    double *out = malloc((size_t)(n*components)*sizeof *out + 1);
    assert_non_null(out);
    OK(tobi_world_read(world, TOBI_FLUID, field, out, n, &err));
    return out;
}

/* Puts the state of one world into another by way of a file. */
static inline void solid_copy(tobi_world *from, tobi_world *to)
{
    char path[] = "/tmp/tobiuo_solid_XXXXXX";
    close(mkstemp(path));
    OK(tobi_world_save(from, path, &err));
    OK(tobi_world_load(to, path, &err));
    unlink(path);
    assert_true(tobi_world_hash(from) == tobi_world_hash(to));
}

/* Three worlds that differ in their threads: the same bits after 117 steps, of which `later` makes the last
   60, from a file that was written in the middle between two sorts. */
static inline void solid_check_bits(tobi_world *one, tobi_world *other, tobi_world *later)
{
    solid_step(one, 57);
    solid_copy(one, later);
    solid_step(one, 60);
    solid_step(other, 117);
    solid_step(later, 60);
    assert_true(tobi_world_hash(one) == tobi_world_hash(other));
    assert_true(tobi_world_hash(one) == tobi_world_hash(later));
}

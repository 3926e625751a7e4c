/* A world without matter, a cube or square of a side, for bodies that are looked at before the first step. */
#pragma once
#include "tobiuo/tobiuo.h"

static inline tobi_world *make_empty_world(int dimension, double spacing, double side)
{
    tobi_error err;
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    w.dimension = dimension;
    w.spacing = spacing;
    for (int a = 0; a < dimension; a++) w.domain_max[a] = side;
    w.gravity[2] = 0;
    w.gravity[dimension - 1] = -9.81;
    if (tobi_world_create(&w, NULL, &world, &err) != TOBI_OK) fail_msg("%s", err.text);
    return world;
}

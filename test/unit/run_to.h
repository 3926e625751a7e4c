/* A world's state at a time, as bits: to compare threads, and runs with and without a restart. */
#pragma once
#include "calls.h"
#include "world/world.h"

static inline uint64_t run_to(tobi_world *w, double t)
{
    OK(tobi_world_advance(w, t, NULL, &err));
    return tobi_world_hash(w);
}

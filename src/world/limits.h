/* What a world can compute at all: combinations of values, each of which is in its own range, and steps that
   lead somewhere. */
#pragma once
#include "core/simulation.h"

/* Refuses, in words, numbers that do not fit each other. *key is that of the scene to blame. sph: the method
   keeps positions in fixed point. */
tobi_status tobi_limits_check(const tobi_world_def *def, int sph, const char **key, tobi_error *err);

/* TOBI_STALLED when time stands still, or has advanced for a hundred steps so little that `left` s would take
   more than a billion steps. steps: the caller's count of such steps in a row. max_dt: of the call, s. */
tobi_status tobi_limits_progress(const tobi_simulation *s, double before, double max_dt, double left,
                                 int *steps, tobi_error *err);

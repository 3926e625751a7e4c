/* The grid as users see it: what the particles make of its nodes at the present time. */
#pragma once
#include "base/error.h"
#include "mpm/view.h"
#include "tobiuo/tobiuo.h"

/* Velocity, mass and mean stress of every node that one of `count` particles reaches, in the order of their
   places (x, then y, then z). Positions from the domain's lower corner. Arrays are the caller's (free()). */
tobi_status mpm_nodes_find(const mpm_view *v, int64_t count, int dimension, tobi_grid *grid, tobi_error *err);

/* Divergence-free SPH: velocity and density constraint, both by one matrix-free operator. */
#pragma once
#include "core/system.h"

extern const tobi_method tobi_dfsph;

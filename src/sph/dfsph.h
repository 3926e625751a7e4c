/* Divergence-free SPH: velocity and density constraint, both by one matrix-free operator. */
#pragma once
#include "core/simulation.h"

extern const tobi_method tobi_dfsph;

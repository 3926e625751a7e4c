/* Divergence-free SPH: velocity and density constraint, both by one matrix-free operator. */
#pragma once
#include "base/param.h"
#include "core/system.h"

extern const tobi_method tobi_dfsph;
extern const tobi_param_table tobi_dfsph_table;

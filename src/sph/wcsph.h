/* Weakly compressible SPH: the pressure follows the density by an equation of state. */
#pragma once
#include "base/param.h"
#include "core/system.h"

extern const tobi_method tobi_wcsph;
extern const tobi_param_table tobi_wcsph_table;

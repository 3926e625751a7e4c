/* Weakly compressible SPH: the pressure follows the density by an equation of state. */
#pragma once
#include "core/simulation.h"

extern const tobi_method tobi_wcsph;

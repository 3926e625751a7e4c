/* Weakly compressible SPH: the pressure follows the density by an equation of state. */
#pragma once
#include "core/system.h"

extern const tobi_method tobi_wcsph;

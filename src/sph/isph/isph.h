/* Incompressible SPH: a compact Poisson equation for the pressure. */
#pragma once
#include "base/param.h"
#include "core/system.h"

extern const tobi_method tobi_isph;
extern const tobi_param_table tobi_isph_table;

/* The same with an explicit update of the pressure. */
extern const tobi_method tobi_eisph;
extern const tobi_param_table tobi_eisph_table;

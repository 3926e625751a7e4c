/* The method "mlsmpm": the material point method for solids, liquids, snow and sand. */
#pragma once
#include "base/param.h"
#include "core/system.h"

extern const tobi_method tobi_mlsmpm;
extern const tobi_param_table tobi_mlsmpm_table;

/* The method "mlsmpm": the material point method for solids, liquids, snow and sand. */
#pragma once
#include "core/simulation.h"

extern const tobi_method tobi_mlsmpm;

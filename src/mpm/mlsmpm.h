/* The method "mlsmpm": the material point method for solids, liquids, snow and sand. */
#pragma once
#include "core/system.h"

extern const tobi_method tobi_mlsmpm;

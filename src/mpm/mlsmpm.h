/* The method "mlsmpm": the material point method for solids, liquids, snow and sand. */
#pragma once
#include "base/param.h"
#include "core/system.h"

extern const tobi_method tobi_mlsmpm;
extern const tobi_param_table tobi_mlsmpm_table;

/* m, of the particles: that of its definition, or `common`, the world's. */
static inline double mpm_spacing(const tobi_mlsmpm_def *d, double common)
{
    return d->spacing > 0 ? d->spacing : common;
}

/* The wall beside a particle, as eq. (7b) of docs/theory/boundaries.md needs it: its normal, and what (7)
   lacks along it. */
#pragma once
#include "exec/pairs.h"
#include "sph/view.h"

typedef struct sph_axis { lane x, y, z, lack; int due; } sph_axis;

TOBI_FN sph_axis sph_axis_of(const sph_view *v, int64_t i)
{
    tobi_float4 n = {0, 0, 0, 0};
    int due = v->axis && (v->full || v->beside[i]);
    if (due) n = v->axis[i];
    sph_axis axis = {lane_set(n.x), lane_set(n.y), lane_set(n.z), lane_set(n.w), due};
    return axis;
}

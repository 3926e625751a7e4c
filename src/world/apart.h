/* Regions that share no place at the start. */
#pragma once
#include "world/fill.h"

/* After the regions of a system, by its number, were filled in their order: TOBI_INVALID where two overlap of
   which one is a mesh or an outline; TOBI_NO_MEMORY. */
tobi_status tobi_regions_check_apart(const tobi_system *s, int system, const tobi_region *regions, int count,
                                     tobi_error *err);

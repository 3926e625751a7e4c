/* What vessels hold up to a level: regions of liquid. */
#pragma once
#include "world/world.h"

/* Gives every region of a vessel that waits for it the boxes or lattice points of the vessel's compartments,
   as bodies stand at the start; one region becomes several where there are several. TOBI_INVALID in words for
   a vessel that is none, runs over or out, or holds other liquid already. On failure nothing has changed. */
tobi_status tobi_vessel_resolve(tobi_world *w, tobi_error *err);

/* What bodies, and solids beside a liquid, may not do while a world runs. */
#pragma once
#include "world/world.h"

/* Notes each body that may drift to a periodic side. */
tobi_status tobi_beside_note(tobi_world *w, tobi_error *err);

/* TOBI_UNSUPPORTED when a body goes through one periodic side, or a solid comes so near to one that the
   liquid beyond it would feel the solid, or the solid would leave. Costs nothing without periodic sides. */
tobi_status tobi_beside_check(tobi_world *w, tobi_error *err);

/* Whether solids start whole. */
#pragma once
#include "world/world.h"

/* Adds a note for each region of a solid that starts in more pieces than it has parts. Of a world that has
   just started: particles stand in the order of their regions. */
tobi_status tobi_world_note_pieces(tobi_world *w, tobi_error *err);

/* Water in gaps that are too narrow for particles: between a body and a side, or two bodies. */
#pragma once

struct tobi_system;
/* Marks with TOBI_WET_GAP the points of bodies below the level of still water that no particle sees and that
   face a side of the domain or another body within a support radius. At the poses of tobi_near_measure. */
void tobi_gap_wet(struct tobi_system *s);

/* The drag of porous zones in a step of the SPH methods, docs/theory/porous.md. */
#pragma once
#include "core/system.h"

/* After the last sort of a step, and after openings are marked: which zone each particle is in, and how much
   it resists in this step. Nothing without zones, as in the next two. */
void sph_porous_begin(tobi_system *s);
/* Before the pressure, or after it where the method knows it beforehand: u becomes M (u + dt b |u0| u0), eq.
   (2). */
void sph_porous_brake(tobi_system *s);
/* After the pressure: force and power of each zone. */
void sph_porous_measure(tobi_system *s);

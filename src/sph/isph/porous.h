/* What porous zones take from the liquid in a step of isph; nothing without zones. */
#pragma once
#include "sph/isph/solve.h"
#include "sph/porous.h"

/* sph_porous_brake, and what it takes. */
void isph_porous_brake(tobi_system *s);
/* Before the velocities get the pressure: what they would be without zones. They stay as they are. */
void isph_porous_compare(isph_solver *m, tobi_system *s);
/* After it: force and power of each zone. */
void isph_porous_measure(const isph_solver *m, tobi_system *s);

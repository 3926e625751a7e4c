/* Solids as a liquid sees them, and what it does to them (docs/decisions/0064). */
#pragma once
#include "mpm/state.h"

/* The verb `points` of tobi_method. */
tobi_status mpm_liquid_points(tobi_system *s, tobi_error *err);
/* Before a substep: gives the particles the impulse of the liquid in it. */
void mpm_liquid_kick(tobi_system *s);
/* J: the sum of force times place. By how much it rises in a substep is the work of the liquid. */
double mpm_liquid_reach(const tobi_system *s);

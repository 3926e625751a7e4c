/* Implicit viscosity, docs/theory/viscosity.md: within the forces of a step. All do nothing where the scene
   has it explicit. */
#pragma once
#include "core/system.h"
#include "sph/kernels.h"

/* Keeps the velocities before all forces, from which the solve starts. */
void sph_viscosity_begin(tobi_system *s, sph_view *v, const sph_kernels *k);
/* v = the velocities that viscosity makes of those that all other forces have made. `expect` adds what the
   rest of the step is expected to add: gravity, and the pressure of the last step. The solve sees that, then
   it is taken off. NULL: the pressure alone, by the sums of dfsph. */
void sph_viscosity_solve(tobi_system *s, sph_view *v, const sph_kernels *k, void (*expect)(tobi_system *s),
                         double *clock);
/* After the solve: v += share of what was expected. An equation of state follows the velocities with the
   pressure that viscosity has seen: without it what viscosity has taken of it would be taken again. */
void sph_viscosity_expect(tobi_system *s, double share);
/* v += s->dt times the acceleration by viscosity at the velocities kept. */
void sph_viscosity_add(tobi_system *s, sph_view *v, const sph_kernels *k);
/* Adds the friction of the step to the force on the sides of the domain. */
void sph_viscosity_load(tobi_system *s);

/* Energies of bodies, springs and lines, and the power that goes through them; not state: all follows from
   poses, velocities and the loads of the last step. */
#pragma once
#include "tobiuo/types.h"

struct tobi_world;

/* Kinetic and potential energy of the bodies, the power of those with a motion and of given
   forces; the rest is 0. */
void tobi_energy_sum_bodies(const struct tobi_world *w, tobi_energy *sum);
/* W: of the damping of all lines. */
double tobi_energy_line_power(const struct tobi_world *w);

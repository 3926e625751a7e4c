/* Particles in the rim of a nest: pressure and velocity are those of the outer liquid (core/nest.h). */
#pragma once
#include "core/system.h"

/* w of `held` in the rim: beyond the numbers of openings. */
enum { SPH_NEST_MARK = -(TOBI_OPENING_LIMIT + 1) };

/* After the marks of openings: those of the rim, with the velocity and the pressure that the outer liquid has
   now. */
void sph_nest_mark(tobi_system *s);
/* Gives the rim the velocity of its marks again. */
void sph_nest_hold(tobi_system *s);
/* Gives the outer liquid in the midst of the box the velocity that the nest has there. */
void sph_nest_feed(const tobi_system *s, tobi_system *outer);

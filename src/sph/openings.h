/* Particles in the buffers of inlets and outlets, as the SPH methods treat them: velocities and pressures
   there are given, not found. */
#pragma once
#include "core/system.h"
#include "sph/view.h"

/* Whether the world has openings. */
int sph_has_openings(const tobi_system *s);
/* After a search: marks what lies in buffers, at the end of the step at hand, and gives it its velocity and
   pressure. Inlets: the profile; the pressure of the free liquid beside, as it continues at rest. Outlets:
   the velocity that they have; the pressure of their level. The view sees the marks until the next sort. */
void sph_openings_mark(tobi_system *s, sph_view *v);
/* Pressures of inlets go on by `share` to those of the free liquid beside them; in the records too. */
void sph_openings_continue(tobi_system *s, double share);
/* The same of outlets that give a pressure, after which it goes on along the normal as it changes before the
   plane. Once for each time that it is given. */
void sph_openings_slope(tobi_system *s);
/* How much farther beyond the plane of an outlet that gives a pressure a held particle is than i is before
   it: 0 where there is none. still: Pa, of liquid at rest, how much more i has than the held one. */
double sph_openings_stretch(const tobi_system *s, int64_t i, int64_t held, double *still);
/* After forces: gives inlets their velocities again, outlets that of the free liquid around or their own. */
void sph_openings_hold(tobi_system *s);
/* After pressure, before positions: the same of inlets; outlets get the mean velocity of the free liquid
   around, inwards only where their pressure is given. No shift of inlets. */
void sph_openings_drive(tobi_system *s);
/* Ends of buffers are no free surface: takes them out of the depths from which its level is found. */
void sph_openings_hide_surface(tobi_system *s);
/* Pa, of the outlets with a pressure, at their centres; 0 without one. */
double sph_openings_mean_pressure(const tobi_system *s);
/* Before the first step of liquid without a free surface: it has the mean pressure that outlets give. */
void sph_openings_start(tobi_system *s);

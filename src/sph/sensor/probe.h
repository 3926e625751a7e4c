/* Sensors: what the fluid does at a point or on a wall, and how high it stands. A sensor looks only at the
   cells around it, in serial. Drawback: a point in the fluid near a thin plate mixes both sides. */
#pragma once
#include "core/system.h"

/* Pressure (Pa) and velocity (m/s) at x (m, world coordinates). In the fluid: a linear moving least squares
   fit through the particles within 3 spacings (Lancaster & Salkauskas 1981), their weighted mean where
   there are too few for a fit, 0 without any. On a side of the domain or a body (nearer than half a
   spacing): the pressure is what the fluid exerts there per area, mean over a disc of one spacing's
   radius, the same sums that make up the forces on walls and bodies. Positions may have moved since
   the last sort by less than a spacing. Returns how many particles were used. */
int tobi_probe_point(const tobi_system *s, const double x[3], double *pressure, double velocity[3],
                     double scalar[TOBI_SCALAR_LIMIT]);

/* The same in the liquid, whatever walls are near, with the acceleration of the liquid in the last step,
   m/s2, which is 0 unless the world has nests. local: m, from the lower corner of the domain. */
int tobi_probe_liquid(const tobi_system *s, const double local[3], double *pressure, double velocity[3],
                      double acceleration[3], double scalar[TOBI_SCALAR_LIMIT]);

/* Pressure at a place, Pa, without the mean over a disc; on a side or a body, *normal becomes its
   direction out
   of the wall. 0 where there is no fluid. */
double tobi_probe_place(const tobi_system *s, const double x[3], double normal[3]);

/* Of a launch over a side: the caller has reserved TOBI_BLOCK times as many. */
enum { TOBI_PROBE_PIECES = 64 };

/* N, of the pressure on all sides of the domain: the sum over places, one per spacing. Between a step and
   what moves or loads particles. */
void tobi_probe_sides(tobi_system *s, double force[3]);

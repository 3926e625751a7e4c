/* Hydrostatic pressure beside the one that is solved for: still water, vessels without a free surface. */
#pragma once
#include "core/system.h"

/* Gravity at x less what still water holds of it, and what acts besides, m/s2; mirrors of isph: all of it. */
void sph_gravity_at(const tobi_system *s, const double x[3], int fluid, double gravity[3]);
/* Takes gravity along axes with walls from what the particles of a full vessel feel. */
void sph_remove_gravity(tobi_system *s);
/* That pressure at x (m, from the lower corner), Pa: 0 at the middle of the box, and 0 in other vessels. */
double sph_hydrostatic(const tobi_system *s, const double x[3]);
/* Pa: what still water presses a point of a body with, at x, beside its particles: the reference pressure; in
   a narrow gap (gap.c) all of the depth, by the share that particles do not cover. 0 where it is dry. */
double sph_still_pressure(const tobi_system *s, const tobi_body *b, int64_t point, const double *x);
/* Adds its forces to those on the walls and to this system's load on the bodies. */
void sph_add_hydrostatic(tobi_system *s);
/* Adds that on one body to force and torque f, N and N m. */
void sph_body_hydrostatic(const tobi_system *s, int body, double f[6]);

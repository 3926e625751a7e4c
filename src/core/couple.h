/* Bodies that move by forces, inside the pressure equation of a liquid (docs/theory/rigid.md, R.11 to R.14).
   Order of a step: tobi_near_measure, the forces of the particles, tobi_couple_begin, the pressure,
   tobi_near_body_forces, tobi_couple_correct, tobi_body_advance, tobi_couple_finish. A solve for the pressure
   has tobi_couple_product after each product; an equation of state has it known from tobi_couple_begin, and
   the step bounded by tobi_couple_softness (docs/theory/wcsph.md, eq. 25). */
#pragma once
#include "base/error.h"

struct tobi_system;
/* The bodies' velocities by all forces but this step's pressure, and the flux of the walls that they are,
   into particles.wall. */
void tobi_couple_begin(struct tobi_system *s);
/* Adds to particles.product how the bodies answer the pressures in the particles' records. totals (or NULL):
   [0] and [1] receive what this adds to record.w times product and to the sum of products. */
void tobi_couple_product(struct tobi_system *s, double *totals);
/* Lets the bodies drift by the velocities that this system's load makes, not by those of the step's
   start: the liquid was solved for these. Bodies that no particle sees fall freely. */
void tobi_couple_correct(struct tobi_system *s);
/* Impulse and twist of this step for tobi_rigid_step, from this system's load on the bodies. */
void tobi_couple_finish(struct tobi_system *s);
/* The longest step for the explicit friction between bodies and liquid, s; INFINITY without. */
double tobi_couple_dt(const struct tobi_system *s);
/* How fast a layer of water around a moving body would move it, were the layer a spring: the largest
   eigenvalue of the inverse mass and inertia times the integral of (n, r x n) (n, r x n)^T over the surface,
   of the worst body, up to 6 % too much; m2/kg, 0 without such bodies. At the bodies' present pose. */
double tobi_couple_softness(const struct tobi_system *s);

/* Bodies in the solve of implicit viscosity, docs/theory/viscosity.md, eq. (3), (5): their friction on the
   particles, and those that move by forces as unknowns. For conjugate gradients, sph/viscosity.c. All do
   nothing in a scene without bodies. */
#pragma once
#include "core/system.h"
#include "sph/view.h"

/* Vectors are velocities, m/s and rad/s; impulses are over the volume of a particle, kg/m2/s and kg/m/s. */
typedef struct sph_viscous_body {
    double expected[6];                  /* what all else adds to its velocities in the step            */
    double drag[6][6];                   /* S of eq. (5)                                            */
    double factor[6][6];                 /* (1 + W S)^-1                                            */
    double change[6], impulse[6];        /* by friction: the unknown, and W^-1 times it             */
    double residual[6];
    double z[6], z_impulse[6];           /* P residual, and W^-1 times it                           */
    double direction[6], direction_impulse[6];
    double product[6];
} sph_viscous_body;

/* Before the first residual: what bodies are expected to do, without friction. */
void sph_viscous_bodies_begin(tobi_system *s);
/* Bodies go as they do, without an answer: for what is read between steps. */
void sph_viscous_bodies_rest(tobi_system *s);
/* What bodies add to the sums of velocity gradients, between sph_strain and sph_apparent. */
void sph_viscous_bodies_strain(tobi_system *s);
/* What bodies add to the shapes of neighbourhoods, between sph_viscous_shape and sph_viscous_close. */
void sph_viscous_bodies_shape(tobi_system *s);
/* And to the rotations of v->viscous.operand, after sph_viscous_spin. moving: 1 bodies go as they do, with
   what friction changes; 0 by the direction of the search. */
void sph_viscous_bodies_spin(tobi_system *s, const sph_view *v, int moving);
/* Adds the friction at the present velocities to residual and diagonal of the particles, and finds the
   residuals of the bodies. first: 1 in the first call of a solve. */
void sph_viscous_bodies_residual(tobi_system *s, int first);
/* P r of the bodies. r . P r is added to *rz, and what squares of the residual over the density are to a
   particle, m2/s2, to *square. */
void sph_viscous_bodies_measure(tobi_system *s, double *rz, double *square);
/* direction = P r + beta direction. */
void sph_viscous_bodies_turn(tobi_system *s, double beta);
/* Adds the friction of the direction to the product of the particles, and finds that of the bodies; before
   the particles are read. Answers direction . product of the bodies. */
double sph_viscous_bodies_apply(tobi_system *s);
void sph_viscous_bodies_advance(tobi_system *s, double alpha);
/* The friction at the velocities found, for the reaction. */
void sph_viscous_bodies_keep(tobi_system *s);

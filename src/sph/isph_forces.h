/* Forces of isph on bodies. In the order of a step: see, foresee, the solve with yield after each product,
   follow, press. */
#pragma once
#include "sph/isph_bodies.h"

/* How the particles grip the bodies, eq. (12) and (13). After isph_bodies_see. */
tobi_status isph_forces_see(isph_solver *m, tobi_system *s, tobi_error *err);
/* Bodies that move by forces: their mirrors get the velocities that all but the pressure makes. After
   friction is known, before the solve. */
void isph_forces_foresee(isph_solver *m, tobi_system *s);
/* product += how they answer pressures, Pa, one per particle, eq. (15). */
void isph_forces_yield(isph_solver *m, double *product, const double *pressure);
/* After the solve: their mirrors get the velocities that the pressure makes. */
void isph_forces_follow(isph_solver *m, tobi_system *s);
/* The pressure's force and torque on each body; friction is there already. */
void isph_forces_press(isph_solver *m, tobi_system *s);
int64_t isph_forces_bytes(const isph_solver *m);
void isph_forces_free(isph_solver *m);

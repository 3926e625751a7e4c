/* Forces of isph on bodies. In the order of a step: find_coupling, predict, the solve with add_answer after
   each product, correct, load. */
#pragma once
#include "sph/isph/bodies.h"

/* How pressures of particles act on bodies, eq. (12) and (13). After isph_bodies_find_mirrors. */
tobi_status isph_forces_find_coupling(isph_solver *m, tobi_system *s, tobi_error *err);
/* Bodies that move by forces: their mirrors get the velocities that the pressure of the last step would make.
   After friction is known, before the solve. Overwrites view.solution. */
void isph_forces_predict(isph_solver *m, tobi_system *s);
/* Into the sources, when rows are made: of the answer only what differs from that is new. */
void isph_forces_add_expected(isph_solver *m);
/* After the solve: whether motors of joints are beyond their bound with it. Then it is as before
   isph_forces_predict but for that, and the solve is to be made again. */
int isph_forces_overrun(isph_solver *m, tobi_system *s);
/* product += how they answer pressures, Pa, one per particle, eq. (15b). */
void isph_forces_add_answer(isph_solver *m, double *product, const double *pressure);
/* At least the largest eigenvalue of what they add to the equation, over its diagonal; 0 without them. */
double isph_forces_answer_bound(isph_solver *m);
/* After the solve: their mirrors get the velocities that the pressure makes. */
void isph_forces_correct(isph_solver *m, tobi_system *s);
/* The pressure's force and torque on each body; friction is there already. */
void isph_forces_load(isph_solver *m, tobi_system *s);
int64_t isph_forces_bytes(const isph_solver *m);
void isph_forces_free(isph_solver *m);

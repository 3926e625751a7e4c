/* The control program of a body, once in a step. */
#pragma once
#include "rigid/dynamics.h"

/* At time t after a step of dt: adds to force and torque; *bits: the axes to hold from now on. Tells motors.
   TOBI_SCRIPT if the program fails or answers nonsense. */
tobi_status tobi_control_run(const tobi_dynamics_state *d, tobi_body *b, double t, double dt, double force[3],
                             double torque[3], double *bits, tobi_error *err);

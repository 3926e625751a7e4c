/* Damping zones: beaches, where waves end. */
#pragma once
#include "tobiuo/types.h"

enum { TOBI_DAMPING_LIMIT = 16 };

typedef struct tobi_damping {
    double lower[3], upper[3];      /* m, from the lower corner of the box of the world   */
    double direction[3];            /* unit vector: where the rate grows                  */
    double begin, length;           /* m along it: from where, over how much              */
    double rate;                    /* 1/s, at the end                                    */
} tobi_damping;

struct tobi_system;
/* Takes from the velocities of liquid in zones what a step of the system does: u/(1 + dt rate f^2) with f
   from 0 to 1 over the length. */
void tobi_damping_apply(struct tobi_system *s);

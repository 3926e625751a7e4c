/* What particles feel besides the constant gravity: gravity that changes with time, and the fictitious forces
   of a frame that moves. An affine map of place and velocity; decision 58. */
#pragma once
#include "exec/portable.h"

typedef struct tobi_acceleration {
    int acts;                   /* 0: there is none of it                                       */
    double uniform[3];          /* m/s2, at the lower corner of the box                         */
    double gradient[3][3];      /* 1/s2, centrifugal and Euler, by place from that corner       */
    double turning[3][3];       /* 1/s, Coriolis, by velocity: implicit midpoint over the step  */
} tobi_acceleration;

/* At a place x, m from the lower corner, without the Coriolis part, m/s2. */
TOBI_FN void tobi_acceleration_at(const tobi_acceleration *a, const double *x, double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = a->uniform[c] + a->gradient[c][0]*x[0] + a->gradient[c][1]*x[1] + a->gradient[c][2]*x[2];
}

/* The Coriolis part at a velocity u, m/s. */
TOBI_FN void tobi_acceleration_by_velocity(const tobi_acceleration *a, const float *u, double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = a->turning[c][0]*u[0] + a->turning[c][1]*u[1] + a->turning[c][2]*u[2];
}

/* Porous zones: boxes whose contents resist liquids. */
#pragma once
#include "tobiuo/types.h"

enum { TOBI_POROUS_ALL, TOBI_POROUS_ACROSS, TOBI_POROUS_ALONG };

typedef struct tobi_porous {
    char name[64];
    double lower[3], upper[3];      /* m, from the lower corner of the box of the world; upper is outside */
    int kind;                       /* which velocities feel it, against `direction`: TOBI_POROUS_*       */
    double direction[3];            /* unit vector                                                        */
    double per_viscosity;           /* 1/m2: a over the kinematic viscosity, of stones                    */
    double linear, quadratic;       /* 1/s: the rest of a; 1/m: b                                         */
    double porosity, size;          /* of stones, 0 without                                               */
    double force[3], power, volume; /* N, W, m3 of the last step, see tobi_porous_info                    */
} tobi_porous;

/* A node with two velocities: those of the two sides of a cut, or of two solids that meet. */
#pragma once
#include <stdint.h>

typedef struct mpm_seam {
    float normal[3];                   /* from the face of the first to that of the second        */
    float gap;                         /* m, between the faces                                     */
    float friction;                    /* 1, Coulomb                                               */
    int   fixed;                       /* 1: the first is of a stationary solid, 2: the second, 0: none */
    float push[3];                     /* N s, on the second in this step                          */
    int32_t first, second;             /* places of the two velocities in the nodes' array         */
} mpm_seam;

/* Points of soft solids as a particle sees them (docs/decisions/0064-water-and-soft-solids.md). */
#pragma once
#include "exec/portable.h"

/* One particle sees one point. */
typedef struct sph_soft_link {
    int32_t particle, point;         /* point: of sph_soft.wet                                      */
    int32_t previous;                /* the particle's link to an earlier point, -1 = none          */
    float share;                     /* V_b W: of the kernel                                        */
    float gradient[3];               /* V_b grad W, 1/m: from the particle to the point             */
    float push[3];                   /* 1/m: the same, of forces of pressure; isph balances it      */
    float rate;                      /* V_b F, 1/m2: gradient = rate (x_b - x_i)                    */
} sph_soft_link;

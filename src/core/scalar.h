/* Temperature and concentration that liquids carry, and how they change its weight. */
#pragma once
#include "exec/portable.h"
#include "tobiuo/scalar.h"

typedef struct tobi_scalar {
    int given;                      /* 1: the liquids have it                                          */
    double value;                   /* at the start                                                    */
    double diffusivity;             /* m2/s                                                            */
    double expansion;               /* 1/unit                                                          */
    double capacity;                /* amount per kg and unit                                          */
    double turbulent_number;        /* 1                                                               */
    double thinning;                /* 1/unit                                                          */
} tobi_scalar;

enum { TOBI_SCALAR_AT_BOX, TOBI_SCALAR_AT_FLUID, TOBI_SCALAR_AT_INLET, TOBI_SCALAR_AT_SIDE,
       TOBI_SCALAR_AT_BODY };

/* What a wall does to a scalar in the liquid, without mass and capacity. */
typedef struct tobi_scalar_wall {
    float fixed;                    /* 1: it has a value, 0: a flux                                    */
    float value, flux;              /* unit, from that at the start; kg unit/(m2 s) into the liquid    */
    float resistance;               /* m2 s/kg, of the transfer; 0: liquid on it is as the wall        */
} tobi_scalar_wall;

typedef struct tobi_scalar_place {
    char name[64];
    int field, kind;                /* tobi_scalar_field, TOBI_SCALAR_AT_*                             */
    int number;                     /* of fluid, opening or body; of a side 2 axis, 1 more of the upper */
    double lower[3], upper[3];      /* m, from the lower corner of the box of the world                */
    double value;
    tobi_scalar_wall wall;
    double flow;                    /* amount/s of the last step, see tobi_scalar_flow                 */
    double capacity, power;         /* amount per unit, amount/s; 0: the wall keeps its value          */
    double stored;                  /* value of a wall with a capacity, from that at the start         */
} tobi_scalar_place;

/* What it does to gravity: `per_unit` is -expansion times gravity, m/s2. */
typedef struct tobi_scalar_lift {
    int acts;
    double value[TOBI_SCALAR_LIMIT];
    float per_unit[TOBI_SCALAR_LIMIT][3];
    float share[TOBI_SCALAR_LIMIT];            /* -expansion, 1/unit                                   */
} tobi_scalar_lift;

TOBI_FN void tobi_scalar_add_lift(const tobi_scalar_lift *l, tobi_double2 c, float g[3])
{
    const float warmer = (float)(c.x - l->value[TOBI_TEMPERATURE]),
                denser = (float)(c.y - l->value[TOBI_CONCENTRATION]);
    for (int a = 0; a < 3; a++)
        g[a] += warmer*l->per_unit[TOBI_TEMPERATURE][a] + denser*l->per_unit[TOBI_CONCENTRATION][a];
}

/* The same to what acts besides gravity, such as a frame that moves: `more`, m/s2. */
TOBI_FN void tobi_scalar_add_share(const tobi_scalar_lift *l, tobi_double2 c, const double more[3],
                                   float g[3])
{
    const float warmer = (float)(c.x - l->value[TOBI_TEMPERATURE]),
                denser = (float)(c.y - l->value[TOBI_CONCENTRATION]),
                share = warmer*l->share[TOBI_TEMPERATURE] + denser*l->share[TOBI_CONCENTRATION];
    for (int a = 0; a < 3; a++) g[a] += share*(float)more[a];
}

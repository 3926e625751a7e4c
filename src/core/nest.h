/* A nest: liquid that a world computes again with a smaller spacing, in a box. Around the box lies a rim
   whose liquid follows that of the outer world. */
#pragma once

struct tobi_system;

/* Places are those of the domain's box, which both worlds share. */
typedef struct tobi_nest {
    const struct tobi_system *outer; /* whose liquid surrounds the box; NULL: the world is no nest      */
    double lower[3], upper[3];       /* m: the box, without end where it meets a side of the domain     */
    double lift;                     /* Pa: that the nest's pressures are higher by                     */
    double rim;                      /* m: how far the rim reaches beyond the box                       */
    double start[2][3];              /* m: the corners at time 0                                        */
    int number;                      /* among the nests of the outer world, from 1                      */
    int body;                        /* of the outer world, that the box goes along with; -1: it stays  */
    double middle[3];                /* m: where the middle of that body was at time 0                  */
} tobi_nest;

/* m: how far a place lies outside of the box, along the axis where that is most; below 0: inside. */
double tobi_nest_outside(const tobi_nest *n, int dimension, const double x[3]);
/* Whether the world has liquid there, free or in the rim. */
int tobi_nest_covers(const tobi_nest *n, int dimension, const double x[3]);

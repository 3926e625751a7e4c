/* Nests: types of tobiuo.h, which includes this file. */
#ifndef TOBIUO_NEST_H
#define TOBIUO_NEST_H

#ifdef __cplusplus
extern "C" {
#endif

/* A nest: a box in which the liquid of a world is computed again with a smaller spacing. */
enum { TOBI_NEST_LIMIT = 4, TOBI_REFINEMENT_LIMIT = 4 };
typedef struct tobi_nest_def {
    const char *name;
    double box_min[3], box_max[3];    /* m, at time 0                                                      */
    int refinement;                   /* 1: spacing of the world over that of the nest                     */
    int feedback;                     /* 1: the liquid of the world takes the nest's velocity in the box   */
    const char *follow;               /* the body that the box goes along with; NULL = it stays            */
} tobi_nest_def;

#ifdef __cplusplus
}
#endif
#endif

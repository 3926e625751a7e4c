/* Porous zones: types of tobiuo.h, which includes this file. */
#ifndef TOBIUO_POROUS_H
#define TOBIUO_POROUS_H
#include "tobiuo/outline.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A porous zone: a box, an outline or a cylinder whose contents resist liquids. The pressure falls by
   rho (a u + b |u| u) per metre, u the filter velocity. What is in it is one of four; of the others all
   numbers are 0. */
enum { TOBI_POROUS_LIMIT = 16 };
typedef struct tobi_porous_def {
    const char *name;
    double box_min[3], box_max[3];    /* m; both 0 with another shape                                  */
    tobi_outline_def outline;         /* instead of the box                                            */
    double cylinder_start[3], cylinder_end[3];     /* m: likewise, middles of the ends along x, y or z; in 2-D
                                         the first is the middle of a disc                             */
    double cylinder_radius, cylinder_inner;        /* m; 0 = no cylinder; above 0 = a ring             */
    double stone_size, porosity;      /* m, 1: of stones, a and b by van Gent (1995)                   */
    double linear_coefficient, quadratic_coefficient;    /* 1: alpha and beta of that                  */
    double stem_number, stem_diameter, stem_drag;        /* 1/m2, m, 1: of stems                       */
    double screen_loss;               /* 1: of a screen, pressure over rho u^2/2                       */
    double linear, quadratic;         /* 1/s, 1/m: a and b themselves                                  */
    double direction[3];              /* of stems, or across a screen; 0 = upwards, or the thin side */
    const char *body;                 /* name of one added before, that it goes along with; NULL: it stays */
} tobi_porous_def;

/* A porous zone; force, power and volume of the last step, in 2-D per m; 0 after a load. */
typedef struct tobi_porous_info {
    double force[3];                  /* N, of the liquid on what is in the zone                       */
    double power;                     /* W, that it takes from the liquid                              */
    double volume;                    /* m3, of the liquid in it                                       */
    double linear, quadratic;         /* 1/s, 1/m: a and b, of the first fluid                         */
    double direction[3];              /* 0: all directions resist alike                                */
    int    along;                     /* 1: the direction resists, 0: what is across it                */
    int    radial;                    /* 1: what resists is away from an axis, which has the direction */
    double extent;                    /* m3, in 2-D m2: of the zone itself                             */
    const char *body;                 /* that carries it; NULL = none                                  */
} tobi_porous_info;

#ifdef __cplusplus
}
#endif
#endif

/* Porous zones: boxes, prisms over polygons and cylinders whose contents resist liquids. */
#pragma once
#include "geom/polygon.h"
#include "tobiuo/types.h"

enum { TOBI_POROUS_ALL, TOBI_POROUS_ACROSS, TOBI_POROUS_ALONG };
enum { TOBI_POROUS_FACETS = 96 };       /* of a circle: its corners begin anew after so many and one */

/* Where a zone that a body carries is in the step at hand, against where it started. */
typedef struct tobi_porous_pose {
    double start[3];                /* m, middle of its box at the start                                  */
    double reach;                   /* m, from there to the corners of the box                            */
    double arm[3];                  /* m, from the centre of the body to the middle, at the start         */
    double frame[3][3];             /* tobi_body.frame at the start                                       */
    double middle[3], centre[3];    /* m, of the zone and of the body                                     */
    double turn[3][3];              /* from axes at the start to those now                                */
    double speed[6];                /* m/s, rad/s, of the body: that the drag is linearised about         */
    double now[6];                  /* m/s, rad/s: that the liquid of the zone is dragged with            */
    int away;                       /* 1: the body is absent                                              */
} tobi_porous_pose;

/* How all zones of a body drag it in a step, about its centre. */
typedef struct tobi_porous_answer {
    int leads;                      /* 1: the first of its zones                                          */
    double known[6];                /* N s, N m s: D, by liquid that moves as it does without the body    */
    double drag[6][6];              /* kg, kg m, kg m2: S                                                 */
    double factor[6][6];            /* (1 + W S)^-1                                                       */
} tobi_porous_answer;

/* Places from the lower corner of the box of the world. */
typedef struct tobi_porous {
    char name[64];
    double lower[3], upper[3];      /* m, of its box; upper is outside                                    */
    double (*corners)[2];           /* m, owned by the world: of its outline, about that of its cylinder;
                                       NULL = all of its box                                              */
    int64_t corner_count;
    int axis, plane[2];             /* of the outline: of its extrusion, and of its corners               */
    double centre[2];               /* m, in that plane, of its cylinder                                  */
    double radius, inner;           /* m; 0 = no cylinder                                                 */
    int radial;                     /* 1: the direction is that away from the centre                      */
    double extent, thickness;       /* m3, in 2-D m2, of the zone; m, of its thin direction               */
    int kind;                       /* which velocities feel it, against `direction`: TOBI_POROUS_*       */
    double direction[3];            /* unit vector                                                        */
    double per_viscosity;           /* 1/m2: a over the kinematic viscosity, of stones                    */
    double linear, quadratic;       /* 1/s: the rest of a; 1/m: b                                         */
    double porosity, size;          /* of stones, 0 without                                               */
    double force[3], power, volume; /* N, W, m3 of the last step, see tobi_porous_info                    */
    int carrier;                    /* the number of the body that it goes along with, from 1; 0 = none   */
    tobi_porous_pose pose;          /* of a zone with a carrier                                           */
    tobi_porous_answer answer;      /* of the first zone of each carrier                                  */
} tobi_porous;

struct tobi_body;
/* porous.c: at the start, where zone and body are placed. */
void tobi_porous_attach(tobi_porous *z, const struct tobi_body *b);
/* When a step begins: where the body has taken it. */
void tobi_porous_follow(tobi_porous *z, const struct tobi_body *b);
/* Where it is now of a place, or a direction, at the start. */
void tobi_porous_move(const tobi_porous *z, const double start[3], double now[3]);
void tobi_porous_turn(const tobi_porous *z, const double start[3], double now[3]);
/* m, from the body to a place, through periodic sides if that is nearer to the zone: size is that of the box
   along periodic axes, 0 along others. */
void tobi_porous_arm(const tobi_porous *z, const double x[3], const double size[3], double arm[3]);
/* Where a place with that arm was at the start; 0: farther from the zone than its corners. */
int tobi_porous_recall(const tobi_porous *z, const double arm[3], double start[3]);

static inline tobi_polygon tobi_porous_polygon(const tobi_porous *z)
{
    return (tobi_polygon){ (const double (*)[2])z->corners, z->corner_count };
}

/* 1: x lies in the zone. */
static inline int tobi_porous_holds(const tobi_porous *z, int dimension, const double *x)
{
    int inside = 1;
    for (int a = 0; a < dimension; a++) inside &= x[a] >= z->lower[a] && x[a] < z->upper[a];
    if (!inside || !z->corners) return inside;
    if (z->radius > 0) {
        const double u = x[z->plane[0]] - z->centre[0], v = x[z->plane[1]] - z->centre[1], r2 = u*u + v*v;
        return r2 < z->radius*z->radius && r2 >= z->inner*z->inner;
    }
    return tobi_polygon_holds(tobi_porous_polygon(z), (double[]){ x[z->plane[0]], x[z->plane[1]] });
}

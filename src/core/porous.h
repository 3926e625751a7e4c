/* Porous zones: boxes, prisms over polygons and cylinders whose contents resist liquids. */
#pragma once
#include "geom/polygon.h"
#include "tobiuo/types.h"

enum { TOBI_POROUS_ALL, TOBI_POROUS_ACROSS, TOBI_POROUS_ALONG };
enum { TOBI_POROUS_FACETS = 96 };       /* of a circle: its corners begin anew after so many and one */

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
} tobi_porous;

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

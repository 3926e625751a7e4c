/* How a closed mesh floats upright: the level of still liquid below which a given volume of it lies. */
#pragma once
#include "geom/mesh.h"

typedef struct tobi_flotation {
    double draught;          /* m, of its lowest place below the level                                 */
    double buoyancy;         /* m, of the centre of what lies below, upwards from the lowest place     */
    double lowest;           /* m, of the lowest place: coordinate along the axis upwards              */
    double inertia[3];       /* m4 (2-D: m3) of the waterplane about the axes through its middle; 0 upwards */
} tobi_flotation;

/* An oriented mesh; in 2-D its section with z = 0. up: the axis upwards, sign: 1 or -1. TOBI_INVALID if the
   volume (2-D: area, m2) is more than there is. */
tobi_status tobi_flotation_find(const tobi_mesh *mesh, int dimension, int up, int sign, double volume,
                                tobi_flotation *out, tobi_error *err);

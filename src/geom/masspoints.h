/* Points with signed volumes that stand for the inside of a closed mesh: sums over them are integrals. */
#pragma once
#include "geom/mesh.h"

typedef struct tobi_mass_points {
    int64_t count;
    double (*at)[3];          /* m, in the mesh's coordinates; 2-D: z = 0                  */
    double *volume;           /* m3, of either sign; 2-D: m2                               */
} tobi_mass_points;

/* Makes the points of an oriented closed mesh, in 2-D of its section with z = 0. Polynomials up to degree 2
   are integrated exactly, so that volume, centre and inertia are those of tobi_massprops_volume. Where parts
   of the mesh overlap, what they share counts twice. The caller owns the arrays. */
tobi_status tobi_mass_points_make(const tobi_mesh *mesh, int dimension, tobi_mass_points *out,
                                  tobi_error *err);
void tobi_mass_points_free(tobi_mass_points *points);

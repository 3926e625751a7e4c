/* Exact integrals over the inside of a closed mesh, for unit density; they know nothing of
   particles. */
#pragma once
#include "geom/mesh.h"

typedef struct tobi_massprops {
    double volume;        /* m3; 2-D: area of the section, m2                                     */
    double area;          /* m2 of surface; 2-D: length of the outline, m                         */
    double centre[3];     /* m, centre of the volume (2-D: of the section, z = 0)                 */
    double inertia[9];    /* m5 about the centre, row-major; times density = kg m2.
                             2-D: of the section as a lamina, m4; [8] is the polar moment         */
} tobi_massprops;

/* Volume, centre and inertia of an oriented closed mesh by sums over the tetrahedra that its
   triangles span with one fixed point (Mirtich, J. Graphics Tools 1 (1996); Blow & Binstock 2004
   for the covariance form). Where parts overlap (mesh->overlapping) what they share counts once; that
   share is taken by lines a 1000th of the box apart, the rest stays exact. A mesh without volume is
   TOBI_INVALID. */
tobi_status tobi_massprops_volume(const tobi_mesh *mesh, tobi_massprops *out, tobi_error *err);

/* The same per metre of depth for the section of the mesh with the plane z = 0 (Green's theorem over
   the outline). A mesh that the plane does not cut is TOBI_INVALID. */
tobi_status tobi_massprops_section(const tobi_mesh *mesh, tobi_massprops *out, tobi_error *err);

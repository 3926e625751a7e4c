/* Where fluids and solids start: lattice points of boxes, spheres and meshes, minus those inside bodies. */
#pragma once
#include "core/simulation.h"

/* One region of one fluid or solid; its mesh is owned. */
typedef struct tobi_region {
    int owner;                     /* number of the fluid or solid */
    double lower[3], upper[3];     /* m, world; the box, or the mesh's box */
    tobi_mesh shape;               /* placed and oriented; without triangles: the box */
    double radius;                 /* m, of the sphere in the middle of that box; 0 = none */
    double volume;                 /* m3, exact; 2-D: m2 */
    double velocity[3], spin[3];   /* m/s, rad/s about the middle of the box */
} tobi_region;

/* Counts the lattice points of a region, an upper bound (bodies are not cut out). */
int64_t tobi_region_count(const tobi_simulation *s, const tobi_region *r);
/* Appends the region's particles to s->particles (capacity must suffice). *cut: how many more would be there
   if no body and no side of the domain were. */
tobi_status tobi_region_fill(tobi_simulation *s, const tobi_region *r, int64_t *cut, tobi_error *err);

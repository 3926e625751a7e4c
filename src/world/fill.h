/* Where fluids and solids start: lattice points of boxes, spheres and meshes, or as many scattered ones,
   minus those inside bodies and behind planes. */
#pragma once
#include "core/system.h"
#include "geom/bvh.h"

/* One region of one fluid or solid; its mesh is owned. */
typedef struct tobi_region {
    int system;                    /* number of the system that computes it */
    int owner;                     /* number of the fluid or solid there */
    int number;                    /* of the region among those of its owner */
    double lower[3], upper[3];     /* m, world; the box, or the mesh's box */
    tobi_mesh shape;               /* placed and oriented; without triangles: the box */
    double radius;                 /* m, of the sphere in the middle of that box; 0 = none */
    char vessel[64];               /* body whose compartments are still to be found; "" = none */
    double level, seed[3];         /* m, see tobi_fill_def */
    int in_vessel;                 /* 1: it is a compartment of one */
    double (*points)[3];           /* owned, m, world: the lattice in a compartment; NULL = that of the box */
    int64_t point_count;
    double volume;                 /* m3, exact; 2-D: m2 */
    double velocity[3], spin[3];   /* m/s, rad/s about the middle of the box */
    tobi_flow_fn flow;             /* what is added to them, NULL = nothing */
    void *flow_user;
    double flow_speed;             /* m/s, the most that it added */
    int64_t placed;                /* particles */
    int64_t outside, covered, behind;   /* points left out beyond the domain, inside bodies, behind planes */
    int64_t soaked;                /* the same, of a fluid, inside solids */
    int blade;                     /* 1 + number of a blade that stands in it, 0 = none */
    int64_t cut;                   /* points in that blade, or nearer than a quarter spacing */
} tobi_region;

/* Layers of a box along an axis. */
double tobi_region_layers(const tobi_region *r, int axis, double spacing);
/* Counts the lattice points of a region, an upper bound (bodies are not cut out). */
int64_t tobi_region_count(const tobi_system *s, const tobi_region *r);
/* How deep a point of the world lies in a region, m, at most `most`; 0 or less: outside. tree: of its mesh;
   NULL without one. */
double tobi_region_depth(const tobi_region *r, const tobi_bvh *tree, const double x[3], int dimension,
                         double most);
/* Appends the region's particles to s->particles (capacity must suffice); counts what it left out. */
tobi_status tobi_region_fill(tobi_system *s, tobi_region *r, tobi_error *err);

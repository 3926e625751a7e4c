/* Blue noise: points without a lattice's directions, at even distances, as many as the lattice has. */
#pragma once
#include "geom/bvh.h"

/* Where the points belong: the inside of tree, or the sphere (2-D: disc) in the middle of the box, or the
   box from lower to upper (m). */
typedef struct tobi_seed_shape {
    double lower[3], upper[3];
    double radius;                     /* m; 0 = no sphere                                        */
    const tobi_bvh *tree;              /* NULL = no mesh                                          */
    int dimension;                     /* 2: z of the points stays                                */
} tobi_seed_shape;

/* Moves `count` points (m), which come from a lattice of the given spacing (m) inside the shape: scatters
   them by random numbers that depend on `number` and their order alone, then lets them repel each other and
   their images behind the surface, so that they fill the shape evenly (in the manner of Colagrossi et al.
   2012, Comput. Phys. Commun. 183, 1641). Nearest neighbours end up 0.95 spacings apart on average, seldom
   less than 0.75. The same points for any number of threads. */
tobi_status tobi_seed_scatter(const tobi_seed_shape *shape, double spacing, uint64_t number, int64_t count,
                              double (*points)[3], int threads, tobi_error *err);

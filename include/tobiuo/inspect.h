/* Looking into a world of an SPH method: its smoothing kernel and its neighbour search. */
#ifndef TOBIUO_INSPECT_H
#define TOBIUO_INSPECT_H
#include "tobiuo/tobiuo.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Smoothing kernels by number, as tobi_smoothing counts them: the name as in scenes, cut to size, into name;
   1, or 0 past the end. */
TOBI_API int tobi_kernel_name(int kernel, char *name, size_t size);
/* W(r) in 1/m^dimension and dW/dr in 1/m^(dimension + 1), zero from the support radius (m) on. The integral
   of W is 1: particles use it times a constant near 1, so that sums over their lattice are 1. NaN for a
   number that is no kernel, another dimension than 2 or 3, support <= 0 and r < 0. */
TOBI_API double tobi_kernel_value(int kernel, int dimension, double support, double r);
TOBI_API double tobi_kernel_slope(int kernel, int dimension, double support, double r);

/* The search of a world's fluid. Space is cut into cells at least one support radius wide; a particle's
   neighbours lie in its own cell and those that touch it. */
typedef struct tobi_search {
    int     kernel;                 /* tobi_smoothing                                              */
    double  support;                /* m, radius                                                   */
    int64_t particles;
    int     cells[3];               /* per axis                                                    */
    int     periodic[3];            /* 1: the cells at the two ends touch                          */
    double  lower[3], width[3];     /* m, lower corner of the first cell, width of each            */
} tobi_search;

/* All functions below start the world, and bring the search to the present positions. TOBI_UNSUPPORTED
   for a world without SPH fluids. */
TOBI_API tobi_status tobi_world_search(tobi_world *world, tobi_search *search, tobi_error *err);
/* The cell of each particle in the order of ids: x + cells[0]*(y + cells[1]*z). cell has room for `count`
   numbers, at least search.particles: TOBI_INVALID. */
TOBI_API tobi_status tobi_world_cells(tobi_world *world, int64_t *cell, int64_t count, tobi_error *err);
/* Ids of the particles nearer than the support radius to one of them, rising, without itself: the first
   `room` of them into ids, their number into *count. TOBI_NOT_FOUND if the fluid has no such particle. */
TOBI_API tobi_status tobi_world_neighbours(tobi_world *world, int64_t id, int64_t *ids, int64_t room,
                                           int64_t *count, tobi_error *err);
/* Writes the search of one particle into dir, which is made if missing, as points (VTP, zlib):
     all.vtp                  all particles
     center.vtp               the particle
     inCell.vtp               particles in the cells that it looks into, itself included
     inSphere.vtp             those within the support radius, itself included
     each_cell.vtp            all particles, sorted by cell
     each_cell_position.vtp   middles of the cells with particles in them
   Points have particle_id and cell (as above); inCell and inSphere distance (m) and weight (W, 1/m3 or
   1/m2) too; each_cell_position has cell, particles (their number) and searched (1: inCell has them).
   Fails as tobi_world_neighbours does, or with TOBI_IO. */
TOBI_API tobi_status tobi_world_write_search(tobi_world *world, int64_t id, const char *dir, tobi_error *err);

#ifdef __cplusplus
}
#endif
#endif

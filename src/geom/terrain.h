/* Heights over a rectangle, and the body below them. */
#pragma once
#include "geom/mesh.h"

/* z[j*nx + i] at x[i], y[j], both of which rise, m. All owned. */
typedef struct tobi_terrain { double *x, *y, *z; int64_t nx, ny; } tobi_terrain;

/* An ESRI ASCII grid, which begins with "ncols", or a CSV table of x, y and z of all points of a lattice.
   Heights of the former are of the middles of cells; its outer half cells are level. Free it in any case.
   TOBI_NOT_FOUND, TOBI_IO, TOBI_INVALID with the place. */
tobi_status tobi_terrain_read(const char *path, tobi_terrain *out, tobi_error *err);
void tobi_terrain_free(tobi_terrain *terrain);
/* terrain_fit.c: cuts off what lies outside of a rectangle, m; was_cut: 1 if there was something.
   TOBI_NOT_FOUND without a text: nothing lies inside. TOBI_NO_MEMORY. */
tobi_status tobi_terrain_cut(tobi_terrain *terrain, const double lower[2], const double upper[2],
                             int *was_cut, tobi_error *err);
/* Of lines along x and y that are all nearer than a quarter of the spacing, m, one in factor stays: at most
   half of it apart but for the last. factor 1: all. */
void tobi_terrain_thin(tobi_terrain *terrain, const double spacing[2], int64_t factor[2]);
/* The body between the heights and `base`, closed. TOBI_INVALID, with name: a height not above the base. */
tobi_status tobi_mesh_terrain(const char *name, const tobi_terrain *terrain, double base, tobi_mesh *out,
                              tobi_error *err);

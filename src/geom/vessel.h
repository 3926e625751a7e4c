/* Meshes of vessels: surfaces seen from inside get walls. */
#pragma once
#include "geom/mesh.h"

/* Makes a closed mesh of a vessel's walls, oriented outwards, out of a mesh as it was read and placed. A
   mesh that has walls of its own stays as it is, unless thickness > 0 (m) says that it is the inner surface.
   Then, and where it has none, the walls lie outside of it, `thickness` or else `usual` deep, and its holes
   stay open; so does its flat side towards `open`, if that is not 0. In 2-D only what the plane z = 0 sees
   counts as a wall of its own. name goes into error texts. Errors: those of tobi_mesh_orient, and
   TOBI_INVALID where no side is flat or a mesh with walls of its own is to be opened. */
tobi_status tobi_mesh_make_vessel(tobi_mesh *mesh, double thickness, double usual, const double open[3],
                                  int dimension, const char *name, tobi_error *err);

/* Triangle surfaces: reading, placing, checking, refining.

   A tobi_mesh owns its two arrays (malloc); tobi_mesh_free releases them. Coordinates in metres.
   A triangle's vertices run counter-clockwise seen from outside once tobi_mesh_orient has passed.
   Every function that fails leaves its output empty or its mesh as it was. */
#pragma once
#include "base/error.h"

typedef struct tobi_mesh {
    int64_t vertex_count, triangle_count;
    double  (*vertices)[3];
    int32_t (*triangles)[3];
} tobi_mesh;

/* Reads an OBJ, STL (ASCII or binary) or PLY file; all its groups become one surface, duplicate
   vertices are welded and collapsed triangles dropped. The import runs in a child process, so that
   a crash or a hang of the importer on a damaged file is an error text here.
   Errors: TOBI_NOT_FOUND, TOBI_IO, TOBI_INVALID (format, no triangles, not finite, bad index),
   TOBI_NO_MEMORY. The file must not change while it is read. */
tobi_status tobi_mesh_read(const char *path, tobi_mesh *out, tobi_error *err);

/* Makes a mesh from raw arrays (copied): checks every number and index, welds vertices closer than
   1e-9 of the box, drops triangles with two equal corners and vertices no triangle uses. Flat
   triangles with three different corners stay, since dropping them would open the surface.
   name goes into error texts. */
tobi_status tobi_mesh_build(const char *name, int64_t vertex_count, const double (*vertices)[3],
                            int64_t triangle_count, const int32_t (*triangles)[3],
                            tobi_mesh *out, tobi_error *err);

tobi_status tobi_mesh_copy(const tobi_mesh *mesh, tobi_mesh *out, tobi_error *err);
/* NULL and an empty mesh are fine; the mesh is empty after. */
void tobi_mesh_free(tobi_mesh *mesh);

/* Scales per axis, then rotates by degrees about the direction axis through the origin, then
   translates. A mirroring scale turns the triangles, so that outside stays outside. A zero axis
   with a non-zero angle, a zero scale or a number that is not finite is TOBI_INVALID. */
tobi_status tobi_mesh_transform(tobi_mesh *mesh, const double scale[3], const double axis[3],
                                double degrees, const double translation[3], tobi_error *err);

void tobi_mesh_box(const tobi_mesh *mesh, double min[3], double max[3]);

/* Checks that every edge belongs to exactly two triangles, makes the triangles of each connected
   shell agree, and turns the outermost shells outward, shells inside one other shell inward
   (cavities), and so on by depth. name goes into error texts. */
tobi_status tobi_mesh_orient(tobi_mesh *mesh, const char *name, tobi_error *err);

/* Splits edges longer than max_edge (m) at their middle, longest first, in both neighbours: the
   shape stays, the surface stays closed. Needs a mesh that passed tobi_mesh_orient. Splitting the
   longest edge of both neighbours is Rivara's bisection (1984), which keeps angles bounded. */
tobi_status tobi_mesh_refine(tobi_mesh *mesh, double max_edge, tobi_error *err);

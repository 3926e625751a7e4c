/* Triangle surfaces: reading, placing, checking, refining.

   A tobi_mesh owns its arrays and its texture (malloc); tobi_mesh_free releases them. Coordinates in metres.
   A triangle's vertices run counter-clockwise seen from outside once tobi_mesh_orient has passed.
   Every function that fails leaves its output empty or its mesh as it was, if it does not say
   otherwise. */
#pragma once
#include "base/error.h"

enum { TOBI_MESH_NOTES = 2000 };

typedef struct tobi_mesh {
    int64_t vertex_count, triangle_count;
    double  (*vertices)[3];
    int32_t (*triangles)[3];
    int     overlapping;               /* parts of the surface lie inside others: inside is where the
                                          winding number is above 0, see bvh.h                      */
    char    notes[TOBI_MESH_NOTES];    /* what was repaired, a line each, with a newline            */
    struct tobi_texture *texture;      /* owned: coordinates that the file has (texture.h), or NULL */
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

/* All but the texture. */
tobi_status tobi_mesh_copy(const tobi_mesh *mesh, tobi_mesh *out, tobi_error *err);
/* NULL and an empty mesh are fine; the mesh is empty after. */
void tobi_mesh_free(tobi_mesh *mesh);

/* Scales per axis, then rotates by degrees about the direction axis through the origin, then
   translates. A mirroring scale turns the triangles, so that outside stays outside. A zero axis
   with a non-zero angle, a zero scale or a number that is not finite is TOBI_INVALID. */
tobi_status tobi_mesh_transform(tobi_mesh *mesh, const double scale[3], const double axis[3],
                                double degrees, const double translation[3], tobi_error *err);

/* Its extent, m. */
void tobi_mesh_box(const tobi_mesh *mesh, double min[3], double max[3]);

/* Makes a surface as CAD writes it a closed one, oriented outwards, and says in mesh->notes what it
   changed: borders that nearly meet are welded, double triangles dropped, edges of more than two
   triangles taken apart, the triangles of each shell made to agree, holes closed by patches, the
   outermost shells turned outward, shells inside one other shell inward (cavities), and so on by depth;
   marks shells that overlap. docs/decisions/0008-meshes-from-cad.md says by which rules. name goes into
   error texts. Errors: TOBI_INVALID when the file does not say what is inside (holes with their number
   and place), TOBI_NO_MEMORY. The mesh may be partly repaired after a failure. */
tobi_status tobi_mesh_orient(tobi_mesh *mesh, const char *name, tobi_error *err);
/* The same, but holes stay open: flat patches over them only tell where outside is. Overlaps are not looked
   for. */
tobi_status tobi_mesh_orient_open(tobi_mesh *mesh, const char *name, tobi_error *err);

/* The same as the first, of walls: that they have a hollow is no news. */
tobi_status tobi_mesh_orient_vessel(tobi_mesh *mesh, const char *name, tobi_error *err);

/* Adds a line to mesh->notes, as far as there is room. */
void tobi_mesh_note(tobi_mesh *mesh, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Compares the mesh with a domain of size (m): 1 if it is more than 10 times larger, -1 if more than 1000
   times smaller, and then text receives a question about the units; 0 and "" if it is neither. */
int tobi_mesh_hint_units(const tobi_mesh *mesh, int dimension, const double size[3], char *text,
                         size_t room);

/* Splits edges longer than max_edge (m) at their middle, longest first, in both neighbours: the
   shape stays, the surface stays closed. Needs a mesh that passed tobi_mesh_orient. Splitting the
   longest edge of both neighbours is Rivara's bisection (1984), which keeps angles bounded. */
tobi_status tobi_mesh_refine(tobi_mesh *mesh, double max_edge, tobi_error *err);

/* Steps of tobi_mesh_orient on surfaces whose edges do not belong to two triangles each. All return
   TOBI_OK or TOBI_NO_MEMORY and may change the number of vertices and triangles. */
#pragma once
#include "geom/edges.h"
#include "geom/mesh.h"

/* Welds vertices closer than tolerance (a part of the longest side of the box) along each axis; only:
   one char per vertex, which may be welded, NULL = all. */
tobi_status tobi_mesh_weld(tobi_mesh *mesh, double tolerance, const char *only);

/* Welds borders that nearly meet, drops double triangles, takes edges of more than two triangles
   apart, where that makes the surface less open; says so in mesh->notes. */
tobi_status tobi_mesh_mend(tobi_mesh *mesh);

/* Holes closed by tobi_mesh_patch, and where they were. */
typedef struct tobi_holes {
    int64_t count, edges;         /* holes; open edges around them                                  */
    int64_t first;                /* the triangles from this one on are patches                     */
    int     listed;               /* of the following, the longest first                            */
    struct { double centre[3], length; int64_t edges; } largest[3];   /* m, m around                 */
} tobi_holes;

/* Closes the holes of a surface whose triangles agree: every loop of open edges gets triangles.
   opposite as from tobi_edges_match. */
tobi_status tobi_mesh_patch(tobi_mesh *mesh, const int32_t (*opposite)[3], tobi_holes *holes);

/* "2 holes (7 open edges): 1.2 m around at (0, 0, 1), ..." */
void tobi_holes_describe(const tobi_holes *holes, char *text, size_t size);

/* What the surface says without its patches, by its generalised winding number (Jacobson, Kavan &
   Sorkine, ACM TOG 32 (2013)): *doubt receives the volume where that lies on the other side of 1/2 than
   with the patches, as a part of the volume inside. mesh must be closed and oriented. */
tobi_status tobi_holes_doubt(const tobi_mesh *mesh, const tobi_holes *holes, double *doubt);

/* A body's surface as quadrature pieces that move with its mesh.

   In 3-D a piece is a part of a triangle, in 2-D a part of the section of the mesh with the plane
   z = 0. Pieces hold barycentric coordinates, so any new pose of the same mesh places them. */
#pragma once
#include "geom/mesh.h"

typedef struct tobi_quadrature {
    int     dimension;       /* 2 or 3                                                            */
    int64_t count;
    int32_t *triangle;       /* of each piece                                                     */
    double  (*a)[3];         /* barycentric: 3-D the middle of the piece; 2-D its first end       */
    double  (*b)[3];         /* 2-D its second end, the inside on the left; NULL in 3-D           */
    double  *fraction;       /* 1, of the triangle's area; NULL in 2-D                            */
    double  spacing;         /* m, that it was cut by                                             */
} tobi_quadrature;

/* Cuts the surface of an oriented mesh into pieces whose longest edge (2-D: length) is at most
   spacing in the mesh's present pose: triangles are halved at their longest edge until they fit, so
   the pieces of a triangle always add up to its area exactly. Errors: TOBI_INVALID (spacing, or the
   plane z = 0 does not cut the mesh in 2-D, or too many pieces), TOBI_NO_MEMORY. */
tobi_status tobi_quadrature_build(const tobi_mesh *mesh, double spacing, int dimension,
                               tobi_quadrature *out, tobi_error *err);
void tobi_quadrature_free(tobi_quadrature *surface);

/* Copies piece `from` over piece `to`, to leave some out; the caller sets count. */
void tobi_quadrature_move(tobi_quadrature *surface, int64_t from, int64_t to);

/* Fills position (m), outward unit normal and area (m2; in 2-D length, m) of every piece for the given
   vertices. A piece that a motion has squeezed to nothing has area 0 and normal 0. In 2-D positions
   and normals lie in the plane z = 0. Any output may be NULL. Parallel, same bits for any number of
   threads. */
void tobi_quadrature_update(const tobi_quadrature *surface, const double (*vertices)[3],
                         const int32_t (*triangles)[3], double (*position)[3], double (*normal)[3],
                         double *area);

/* Where the corners of every piece are, m: corners[3 i] to [3 i + 2] in 3-D, the ends [2 i] and [2 i + 1] in
   2-D. mesh: the one that was cut, in the pose that it was cut in; vertices: of the pose that is wanted. */
void tobi_quadrature_corners(const tobi_quadrature *surface, const tobi_mesh *mesh,
                             const double (*vertices)[3], double (*corners)[3]);

/* Values of the vertices (velocities) at the middle of every piece. */
void tobi_quadrature_interpolate(const tobi_quadrature *surface, const int32_t (*triangles)[3],
                              const double (*vertex_values)[3], double (*out)[3]);

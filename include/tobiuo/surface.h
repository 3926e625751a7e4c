/* The surface of particles as a triangle mesh: of a liquid, of the pieces of solids. Arrays in, mesh out;
   tobi_world_read and tobi_world_pieces give the arrays of a world.

   Level set of a kernel sum on sparse blocks of a grid, marching cubes, short edges merged, weighted
   Laplacian smoothing (Loeschner, Boettcher, Jeske & Bender 2023), each connected part brought back to its
   volume. The mesh is closed and manifold; particles of different groups never share a surface. A particle
   alone becomes a small sphere of its volume. docs/decisions/0054-surfaces.md says why.

   The same input gives the same bits for any number of threads. Positions have the precision of a float
   against the size of the particles' box. 3-D only. */
#ifndef TOBIUO_SURFACE_H
#define TOBIUO_SURFACE_H
#include "tobiuo/base.h"
#include "tobiuo/picture.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Numbers of the particles that the vertices shall have too: mean of the particles around, by the kernel. */
typedef struct tobi_surface_field {
    const char *name;                  /* in files, "velocity"; NULL = "field"                           */
    int components;                    /* 1 to 9                                                         */
    const double *values;              /* particle_count x components                                    */
} tobi_surface_field;

/* Everything borrowed for the call. Obtain from tobi_default_surface and change members. */
typedef struct tobi_surface_def {
    int64_t particle_count;
    const double (*positions)[3];      /* m; not finite = left out                                       */
    const int32_t *group;              /* of each particle, below 2^20: one surface each; negative = left
                                          out; NULL = all are one                                        */
    double spacing;                    /* m between particles                                            */
    const double *spacings;            /* m, of each particle, at most 16 different ones; those of
                                          different spacing share no surface; NULL = all have spacing    */
    double cell;                       /* of the grid, in spacings, 0.1 to 2                             */
    int smoothing;                     /* rounds, 0 to 100                                               */

    double box_min[3], box_max[3];     /* m, the domain; asked only where a surface ends flat            */
    int flat_min[3], flat_max[3];      /* not 0: surfaces end flat at this side of the box, in a cap     */

    const tobi_surface_field *fields;
    int field_count;                   /* at most TOBI_SURFACE_FIELD_LIMIT                               */
    int threads;                       /* 0 = all cores                                                  */
} tobi_surface_def;

enum { TOBI_SURFACE_FIELD_LIMIT = 32 };

/* The mesh. Owned by the caller until tobi_surface_free. Counts may be 0. */
typedef struct tobi_surface {
    int64_t vertex_count, triangle_count;
    double (*vertices)[3];             /* m                                                              */
    float (*normals)[3];               /* unit vectors, outwards; where a cap begins, those of the free
                                          surface beside it                                              */
    int32_t (*triangles)[3];           /* counter-clockwise seen from outside                            */
    int32_t *group;                    /* of each vertex                                                 */
    uint8_t *sides;                    /* of each vertex, a bit for each flat side it lies on: 1, 2, 4 at
                                          box_min of x, y, z; 8, 16, 32 at box_max. A triangle whose three
                                          vertices share a bit belongs to a cap.                         */
    int field_count;
    char field_names[TOBI_SURFACE_FIELD_LIMIT][40];
    int field_components[TOBI_SURFACE_FIELD_LIMIT];
    float *fields[TOBI_SURFACE_FIELD_LIMIT];     /* vertex_count x components each                       */
    const tobi_picture_skin *skins;    /* of tobi_surface_make_skinned, borrowed; NULL = none            */
    int16_t *skin;                     /* of each vertex, -1 = none                                      */
    float (*uv)[2];                    /* of each vertex: coordinates in the image of its skin           */
} tobi_surface;

TOBI_API tobi_surface_def tobi_default_surface(void);

/* TOBI_INVALID for numbers out of range and for NULL where something must stand, TOBI_NO_MEMORY with the
   bytes that the grid would need. On failure *surface is NULL. */
TOBI_API tobi_status tobi_surface_make(const tobi_surface_def *def, tobi_surface **surface, tobi_error *err);
/* Images on the surfaces of solids. */
typedef struct tobi_surface_skins {
    const tobi_picture_skin *skins;    /* must outlive the surface                                       */
    int count;
    const int16_t *skin;               /* of each particle, -1 = none; of a group all have one           */
    const double (*rest)[3];           /* m, where particles with a skin were at rest                    */
} tobi_surface_skins;

/* The same with texture coordinates. Vertices are doubled along seams and where the inside begins, so that
   the mesh is no longer closed there. Of a field "color" of 4 components skins become white, what was inside
   gets the colour of the inside. TOBI_INVALID: there are as many fields as there may be. */
TOBI_API tobi_status tobi_surface_make_skinned(const tobi_surface_def *def, const tobi_surface_skins *skins,
                                               tobi_surface **surface, tobi_error *err);
/* NULL is fine. */
TOBI_API void tobi_surface_free(tobi_surface *surface);

/* Writes a surface as its path ends: .vtp (group, normals and fields), .ply (binary, the same), .obj
   (normals), .stl (binary), .glb (glTF 2.0, one frame of tobi_surface_movie_add). TOBI_INVALID for another
   ending, TOBI_IO. The file appears whole or not at all. */
TOBI_API tobi_status tobi_surface_write(const char *path, const tobi_surface *surface, tobi_error *err);

/* A movie of surfaces as one glTF 2.0 file (.glb): each frame is a mesh of its own, shown by its scale from
   its time to that of the next, as Blender, assimp and viewers in browsers play it. The file appears whole or
   not at all when it is finished, and holds less than 4 GB. */
typedef struct tobi_surface_movie tobi_surface_movie;
/* frames: at most, 1 to 100000. up: direction that is shown upwards, not zero (glTF: y). */
TOBI_API tobi_status tobi_surface_movie_create(const char *path, int frames, const double up[3],
                                               tobi_surface_movie **movie, tobi_error *err);
/* The colours of vertices: those of a field (by number; of 3 components its size) from low to high, or, with
   field -1, the surface's own, or one for each group; then images are shown, too, 16 of them at most.
   Times rise. */
TOBI_API tobi_status tobi_surface_movie_add(tobi_surface_movie *movie, double time,
                                            const tobi_surface *surface,
                                            int field, double low, double high, tobi_error *err);
/* Ends the last frame one frame later and writes the file. The movie must be freed after it too. */
TOBI_API tobi_status tobi_surface_movie_finish(tobi_surface_movie *movie, tobi_error *err);
/* NULL is fine; without finish nothing is left. */
TOBI_API void tobi_surface_movie_free(tobi_surface_movie *movie);

#ifdef __cplusplus
}
#endif
#endif

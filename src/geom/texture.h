/* Texture coordinates of a surface: the triangles of the file that have them, as they were before welding and
   mending. A place gets those of the nearest of these triangles, so that nothing that changes the mesh has to
   carry them along. Drawback: the corners are kept twice. */
#pragma once
#include "geom/bvh.h"
#include "geom/mesh.h"

typedef struct tobi_texture {
    int64_t count;
    double  (*corner)[3][3];       /* m, of each triangle; tobi_mesh_transform moves them */
    float   (*uv)[3][2];           /* 1, at its corners                                   */
    tobi_bvh *tree;                /* NULL before tobi_texture_prepare                    */
    int     front;                 /* 1: places are looked at along -z, as pictures in 2-D show them */
} tobi_texture;

/* Keeps those triangles of a raw mesh whose six coordinates uv are finite; *out is NULL if there are none. */
tobi_status tobi_texture_create(const tobi_mesh *raw, const float (*uv)[3][2], tobi_texture **out,
                                tobi_error *err);
void tobi_texture_free(tobi_texture *texture);

/* Builds the tree that looking needs, once, when nothing moves the mesh any more. */
tobi_status tobi_texture_prepare(tobi_texture *texture, tobi_error *err);
/* The coordinates at the point of the surface nearest to x; returns its distance, m. With `front` those of
   the highest z above x, at no distance, if there are any. Any thread. */
double tobi_texture_look(const tobi_texture *texture, const double x[3], float uv[2]);

/* Coordinates at three places, all in the plane of the triangle that is nearest to their middle: no seam is
   crossed. Any thread. */
void tobi_texture_look_flat(const tobi_texture *texture, const double corner[3][3], float uv[3][2]);
/* A texture of its own, prepared. */
tobi_status tobi_texture_copy(const tobi_texture *texture, tobi_texture **copy, tobi_error *err);
/* By how much coordinates change along the surface, 1/m: of 99 of 100 triangles at most. */
tobi_status tobi_texture_stretch(const tobi_texture *texture, double *stretch, tobi_error *err);

/* A mesh with as many copies of each vertex as it has different coordinates: one more along a seam. */
typedef struct tobi_skin {
    int64_t vertex_count;
    int32_t *vertex;               /* of the mesh                  */
    float   (*uv)[2];
    int32_t (*triangles)[3];       /* as many as the mesh has      */
} tobi_skin;

/* mesh at rest, its texture prepared. */
tobi_status tobi_skin_build(const tobi_mesh *mesh, tobi_skin *out, tobi_error *err);
void tobi_skin_free(tobi_skin *skin);

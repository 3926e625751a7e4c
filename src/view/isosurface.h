/* The grid around particles, shared by the files of the quick surface. */
#pragma once
#include "view/draw.h"

/* locked: a vertex where the free surface meets a wall. */
enum { WATERLINE = 8 };
enum { ROUNDS = 4, APRON = BLOCK_EDGE + 1, BLOCKS_AT_MOST = 1 << 22 };


typedef struct grid {
    const canvas *c;
    const tobi_picture *f;
    double edge, low[3];                 /* m, of a cell; m, of the first node                   */
    float  wall[3][2];                   /* cells from the first node, of the domain             */
    float  reach;                        /* cells                                                */
    float  level;                        /* of the sum, whose value inside is 1                  */
    int    size[3];                      /* blocks                                               */
    int32_t *at;                         /* of each place the block there, or -1                 */
    int64_t blocks, entries;
    float  (*place)[3];                  /* of particles, cells; [0] < 0: outside                */
    int32_t (*block)[3];
    int64_t *first;                      /* blocks + 1                                           */
    int32_t *entry, *colored;
    float  *node, *colors;
    int64_t colored_count;
    int64_t *vertex, *quad;              /* of each block the first; blocks + 1                  */
    int32_t *cell;                       /* of each cell its vertex, or -1                       */
    float  (*point)[3], (*moved)[3];     /* of vertices, cells                                   */
    uint8_t *locked;                     /* axes along which a vertex stays                      */
    int32_t (*corner)[4];                /* of quads                                             */
    float  per_particle;                 /* the sum at a particle that is alone                  */
} grid;

static inline int32_t *block_at(const grid *s, int x, int y, int z)
{
    return &s->at[((int64_t)z*s->size[1] + y)*s->size[0] + x];
}

/* isosurface_faces.c: the finished vertices and quads as vertices and faces of g; false: no memory. */
bool view_add_faces(const grid *s, const surface_request *r, geometry *g);

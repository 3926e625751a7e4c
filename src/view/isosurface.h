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
    int    nest;                         /* of the particles, see tobi_picture                   */
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
    float  *extra;                       /* of particles: by how much more they count; -1: well  */
    uint8_t *touched;                    /* within. Of blocks: one of them counts more. Or NULL  */
} grid;

static inline int32_t *block_at(const grid *s, int x, int y, int z)
{
    return &s->at[((int64_t)z*s->size[1] + y)*s->size[0] + x];
}

/* Share of the kernel on the inner side of a plane at a distance, in reaches, from its middle: the
   integral of (1 - t^2)^4. */
static inline float share_inside(float s)
{
    if (s >= 1) return 1;
    if (s < -0.7f) s = -0.7f;
    const float q = s*s, part = s*(1 - q*(4.0f/3 - q*(6.0f/5 - q*(4.0f/7 - q/9))));
    return 0.5f + 0.5f*part/0.40634921f;
}

/* The blocks that have nodes within `reach` of a particle, at most two along each axis, as offsets into
   grid.at. Most particles have those of the one before. */
typedef struct reached { unsigned low[3], high[3]; int count; int64_t at[8]; } reached;
void view_find_blocks(const grid *s, const float place[3], float reach, reached *r);

/* isosurface_drops.c: the node values between nodes; by how much more each particle must count, of sums not
   yet limited, false: no memory; balls for the particles outside of the surface, false: no memory. */
float view_sum_at(const grid *s, const float place[3]);
bool view_weigh_particles(grid *s, const surface_request *r);
bool view_add_drops(const grid *s, const surface_request *r, geometry *g);

/* isosurface_faces.c: the finished vertices and quads as vertices and faces of g; false: no memory. */
bool view_add_faces(const grid *s, const surface_request *r, geometry *g);

/* The stages of a surface, shared by the files surface_*.c. Lengths inside are in support radii R = 1.7 d,
   counted from the origin of the grid; node i of an axis lies at i cell. */
#pragma once
#include "base/error.h"
#include "tobiuo/surface.h"
#include "view/kernels.h"
#include "view/surface/surface.k.h"
#include <stdbool.h>

/* In sides: a vertex within a cap, made where the grid ends; the other bits are those of tobi_surface. */
enum { SURFACE_WITHIN = 64 };

/* Where the surface crosses the edges that begin at the nodes of a block: a bit for each x in the row (y, z)
   of an axis, and how many vertices of the block come before the row. */
typedef struct surface_rows {
    uint8_t cross[3][SURFACE_SIDE][SURFACE_SIDE];
    uint16_t before[3][SURFACE_SIDE][SURFACE_SIDE];
} surface_rows;

typedef struct surface_work {
    const tobi_surface_def *def;
    tobi_exec exec;
    double radius, origin[3];    /* m: R; of node 0 */
    surface_view view;

    int64_t points;              /* particles and their images, by bin */
    float *x, *y, *z, *count, *strength;
    int32_t *of;                 /* the particle; -1 - particle for an image */
    uint64_t *bin_key, *block_key;
    int32_t *bin_begin;
    float *node;
    int32_t (*beside)[8];        /* blocks at +x + 2 (+y) + 4 (+z), -1 = none */
    surface_rows *rows;
    int64_t *vertex_begin, *triangle_begin;      /* of each block, and of the end */

    int64_t vertices, triangles;
    tobi_float4 *vertex;         /* x, y, z; w: how far it is smoothed, 0 to 1 */
    uint8_t *sides;
    int32_t *block_of;           /* of each vertex */
    int32_t (*triangle)[3];
    int64_t parts;               /* that are connected */
    int32_t *part;               /* of each vertex */
    double *part_volume;         /* before anything was moved */

    int32_t *fan_begin;          /* vertices + 1 */
    int32_t (*fan)[2];           /* of each vertex: the two others of its triangles */
    tobi_float4 *normal;
    float *fields[TOBI_SURFACE_FIELD_LIMIT];

    int64_t drops;               /* particles that become spheres */
    int32_t *drop;
} surface_work;

/* A triangle in the cap of a flat side. */
static inline int surface_in_cap(const uint8_t *sides, const int32_t t[3])
{
    return (sides[t[0]] & sides[t[1]] & sides[t[2]] & ~SURFACE_WITHIN) != 0;
}

/* surface.c: the arrays, not w itself. */
void surface_free_work(surface_work *w);
/* spacings.c: makes the surface of the particles of each spacing and puts all into one. */
typedef tobi_status surface_maker(const tobi_surface_def *def, tobi_surface **surface, tobi_error *err);
tobi_status surface_make_each(const tobi_surface_def *def, surface_maker *make, tobi_surface **surface,
                              tobi_error *err);
/* bins.c */
tobi_status surface_place_points(surface_work *w, tobi_error *err);
/* Sorts keys below limit; order[k]: the old place. */
tobi_status surface_sort(surface_work *w, int64_t n, uint64_t limit, uint64_t *key, int32_t *order,
                         tobi_error *err);
tobi_status surface_no_memory(tobi_error *err, double bytes);
/* blocks.c */
tobi_status surface_list_blocks(surface_work *w, tobi_error *err);
tobi_status surface_find_drops(surface_work *w, tobi_error *err);
int64_t surface_find_block(const surface_view *v, uint64_t key);
/* cases.c */
typedef struct surface_cases {
    uint8_t count[256];          /* triangles                                                     */
    uint8_t edge[256][36];       /* three edges each: 4 axis + its place among the four of the axis */
} surface_cases;
/* 0, or 1 + a case whose polygons cannot be cut without a diagonal in a face. */
int surface_make_cases(surface_cases *cases);
/* cubes.c */
tobi_status surface_march(surface_work *w, tobi_error *err);
/* merge.c */
tobi_status surface_find_parts(surface_work *w, tobi_error *err);
tobi_status surface_merge_short(surface_work *w, tobi_error *err);
/* smooth.c */
tobi_status surface_make_fans(surface_work *w, tobi_error *err);
tobi_status surface_smooth(surface_work *w, tobi_error *err);
void surface_make_normals(surface_work *w);
/* values.c: before vertices are moved. */
tobi_status surface_take_values(surface_work *w, tobi_error *err);
/* result.c */
tobi_status surface_make_result(surface_work *w, tobi_surface **surface, tobi_error *err);

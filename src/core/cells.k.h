/* Kernels of the sort by cell, and what they and the neighbour search (isa_core.c) read and write. */
#pragma once
#include "exec/pairs.h"
#include "exec/strips.h"

/* Where the lists of a block of particles go, in groups of 8 entries. */
typedef struct tobi_list_region {
    int64_t  begin;
    uint32_t room, groups;                    /* how many there may be, how many the last search found */
    int      filled;                          /* 1: the lists are there                             */
} tobi_list_region;

typedef struct tobi_cells_view {
    int64_t count;                            /* particles                                          */
    /* box and cells, see core/cells.h */
    int      n[3], strip, periodic[3];
    int64_t  total;
    double   size[3], inverse[3], to_fixed[3], centre[3];
    float    from_fixed[3];
    int32_t *start;
    uint32_t *keys;                           /* cell of each particle                              */
    /* by particle */
    tobi_double3 *position;
    tobi_record *record;
    const float *payload;                     /* of the records, NULL = 0                           */
    uint32_t *list_start;
    uint16_t *list_groups;
    int32_t *list_far;                        /* exec/list.h                                        */
    /* the list */
    void    *list;
    float    h2;                              /* m2, square of the support radius                   */
    tobi_list_region *region;                 /* of each block of TOBI_BLOCK particles              */
    int *overflow;                            /* set to 1 if a particle has too many neighbours     */
    int *far_apart;                           /* set to 1 if a list cannot be packed                */
} tobi_cells_view;

TOBI_FN int cells_along(const tobi_cells_view *v, int axis, double x)
{
    int k = (int)floor(x*v->inverse[axis]);
    return k < 0 ? 0 : k >= v->n[axis] ? v->n[axis] - 1 : k;
}

TOBI_FN int64_t cells_row(const tobi_cells_view *v, int y, int z)
{
    return tobi_strip_row(v->n, v->strip, y, z);
}

TOBI_FN void cells_wrap(const tobi_cells_view *v, double *x)
{
    for (int a = 0; a < 3; a++)
        if (v->periodic[a]) {
            if (x[a] < 0) x[a] += v->size[a];
            if (x[a] >= v->size[a]) x[a] -= v->size[a];
            if (x[a] < 0 || x[a] >= v->size[a]) x[a] -= v->size[a]*floor(x[a]/v->size[a]);
        }
}

TOBI_FN void cells_key(const tobi_cells_view *v, int64_t i, double *totals)
{
    tobi_double3 *x = &v->position[i];
    (void)totals;
    cells_wrap(v, &x->x);
    v->keys[i] = (uint32_t)(cells_row(v, cells_along(v, 1, x->y), cells_along(v, 2, x->z)) +
                            cells_along(v, 0, x->x));
}

/* Over the sorted particles and one place behind them. */
TOBI_FN void cells_start(const tobi_cells_view *v, int64_t i, double *totals)
{
    const int64_t before = i > 0 ? (int64_t)v->keys[i - 1] : -1;
    const int64_t here = i < v->count ? (int64_t)v->keys[i] : v->total;
    (void)totals;
    for (int64_t cell = before + 1; cell <= here; cell++) v->start[cell] = (int32_t)i;
}

TOBI_FN int32_t cells_fixed(const tobi_cells_view *v, int axis, double x)
{
    return (int32_t)(uint32_t)(int64_t)llrint((x - v->centre[axis])*v->to_fixed[axis]);
}

TOBI_FN void cells_record(const tobi_cells_view *v, int64_t i, double *totals)
{
    const tobi_double3 q = v->position[i];
    tobi_record *r = &v->record[i];
    (void)totals;
    r->x = cells_fixed(v, 0, q.x);
    r->y = cells_fixed(v, 1, q.y);
    r->z = cells_fixed(v, 2, q.z);
    r->w = v->payload ? v->payload[i] : 0;
}

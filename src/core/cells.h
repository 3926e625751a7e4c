/* The box, its cell grid, sorting by cell and the neighbour list.
   A cell is at least one support radius wide, so neighbours lie in the 3^dim cells around. Cells along
   x are contiguous; exec/strips.h orders the rows. */
#pragma once
#include "core/particles.h"
#include "exec/exec.h"
#include "exec/list.h"
#include "exec/strips.h"
#include "linear/grid.h"

/* The simulation box. Positions are measured from its lower corner. */
typedef struct tobi_box {
    int    dimension;
    double lower[3];        /* m, world coordinates of the lower corner               */
    double size[3];         /* m; z of a 2-D box is one support radius                */
    int    periodic[3];
    double to_fixed[3];     /* fixed-point units per metre                            */
    float  from_fixed[3];   /* metres per fixed-point unit                            */
    double centre[3];       /* m from the lower corner: fixed-point zero              */
} tobi_box;

/* A box from lower to upper, m; in 2-D it is h thick. periodic: 1 of axes whose sides are one. h: support
   radius, m. */
void tobi_box_init(tobi_box *b, int dimension, const double lower[3], const double upper[3],
                   const int periodic[3], double h);

typedef struct tobi_cells {
    int      n[3];          /* cells per axis                                         */
    int      strip;         /* rows of cells along y kept together                    */
    int      periodic[3];
    double   inverse[3];    /* cells per metre                                        */
    int64_t  total;         /* cells incl. padding of the last strip                  */
    int32_t *start;         /* [total + 1] first particle of each cell                */
    /* scratch of the sort; shares memory with the neighbour list */
    int64_t *histogram;
    void    *list;          /* neighbours, groups of 8 padded with the own index, see exec/list.h */
    int64_t  list_bytes;
    int64_t  list_used;     /* up to the last entry, gaps between regions included    */
    struct tobi_list_region *region;    /* of each block of particles, see core/cells.k.h */
    int64_t  growths;       /* of the list                                            */
    int64_t  regions;       /* of which the last search says how much they need       */
    /* by particle */
    tobi_record *record;    /* fixed-point position; w: a number that neighbours read  */
    uint32_t *list_start;   /* first neighbour, in groups of 8                        */
    uint16_t *list_groups;  /* groups of 8 neighbours                                 */
    int32_t *list_far;      /* exec/list.h                                            */
    int      wide;          /* 1: the list has whole numbers, list_far is NULL        */
    int64_t  rows;          /* that there is memory for                               */
} tobi_cells;

/* How many cells, without memory for them. */
void tobi_cells_plan(tobi_cells *c, const tobi_box *box, double h, int64_t particles);
/* For as many particles as p has memory for. */
tobi_status tobi_cells_create(tobi_cells *c, const tobi_box *box, double h, const tobi_particles *p,
                              const tobi_exec *x, tobi_error *err);
/* The same after p has grown: to be called before the next sort. */
tobi_status tobi_cells_grow(tobi_cells *c, const tobi_particles *p, tobi_error *err);
void tobi_cells_free(tobi_cells *c);
/* Neighbours are whole numbers from the next search on: twice the memory, and no pass unpacks them. */
void tobi_cells_widen(tobi_cells *c);
/* Bytes per particle, without the neighbours; what list_far adds. */
enum { TOBI_CELLS_ROW = sizeof(tobi_record) + sizeof(uint32_t) + sizeof(uint16_t),
       TOBI_CELLS_FAR = sizeof(int32_t),
       TOBI_CELLS_LIST = 72 };           /* of the list before the first search, which uses all of it  */

/* Wraps periodic positions, sorts all state fields by cell, fills start and the records, their w from
   `payload`, a field of p; NULL = 0. */
void tobi_cells_sort(tobi_cells *c, const tobi_box *box, tobi_particles *p, const float *payload,
                     tobi_exec *x);
/* Index of the first cell of the row (y, z). */
static inline int64_t tobi_cells_row(const tobi_cells *c, int y, int z)
{
    return tobi_strip_row(c->n, c->strip, y, z);
}

/* The particles of the last sort as unknowns of a grid. */
tobi_cell_points tobi_cells_points(const tobi_cells *c, const tobi_box *box, const tobi_particles *p);

/* The list of row i, the own index in the places that are filled up with it: its length, and where it is, or
   j, where it has been unpacked to. */
static inline const int32_t *tobi_cells_neighbors(const tobi_cells *c, int64_t i, int *count,
                                                  int32_t j[TOBI_LIST_LIMIT])
{
    *count = 8*c->list_groups[i];
    return tobi_list_load(c->list, c->list_far, i, 8*(int64_t)c->list_start[i], *count, j);
}

/* Puts the own index into place k of the list of row i. */
static inline void tobi_cells_cut(const tobi_cells *c, int64_t i, int k)
{
    const int64_t at = 8*(int64_t)c->list_start[i] + k;
    if (c->list_far) ((uint16_t *)c->list)[at] = TOBI_LIST_OWN;
    else ((int32_t *)c->list)[at] = (int32_t)i;
}

/* Builds the list of all pairs nearer than h. TOBI_DIVERGED when particles crowd beyond sense. */
tobi_status tobi_cells_list(tobi_cells *c, const tobi_box *box, double h, tobi_particles *p, tobi_exec *x,
                            tobi_error *err);

/* What particles see of bodies, as it is kept; sph/boundary.h fills and reads it. */
#pragma once
#include "core/body.h"
#include "core/cells.h"
#include "sph/body_tree.h"
#include "sph/couple.k.h"

/* Points of one body by cell of width h over its box. */
typedef struct tobi_near_bins {
    int n[3];
    double lower[3];          /* m                                                                */
    int64_t start, item;      /* where its own begin in bin_start, bin_item                       */
} tobi_near_bins;

/* Particles of a row of cells near a body. */
typedef struct tobi_near_row { int32_t body, begin, end; int64_t hit; } tobi_near_row;

/* The caught particles of a block. */
typedef struct tobi_caught_block { double lower[3], upper[3]; int32_t count; } tobi_caught_block;

typedef struct tobi_near_bodies {
    tobi_near_link *link;     /* by body, then by particle                                        */
    tobi_near_entry *entry;   /* of each link                                                     */
    int64_t count, capacity, link_capacity;
    int64_t contacts;         /* particles pushed out in this step                                */
    int64_t cut_pairs;        /* fluid pairs cut because a body lies between                      */
    int64_t *first;           /* [bodies + 1] first entry of each body                            */
    double (*total)[TOBI_TOTALS];    /* [bodies] by tobi_boundary_sum                             */
    double (*answer)[6];      /* [bodies] sph/couple.k.h                                          */
    tobi_block_sum *part;     /* scratch of sums over the particles of each body                  */
    int32_t *caught;          /* [particles] of each block first those that bodies have caught    */
    tobi_caught_block *caught_block;
    double *nearest;          /* [particles] distance to the nearest body, m, INFINITY without    */
    tobi_body_tree tree;
    /* scratch of the search */
    tobi_near_bins *bins;     /* [bodies + 1]                                                     */
    double bin_width;         /* m                                                                */
    int32_t *bin_start, *bin_item;
    tobi_near_row *row;
    int64_t row_count;
    int64_t *found;           /* [row_count] particles that see the body, then entries before     */
    int32_t *hit;             /* those particles                                                  */
    int64_t first_capacity, total_capacity, answer_capacity, part_capacity, caught_capacity, blocks_capacity;
    int64_t nearest_capacity, bins_capacity, start_capacity, item_capacity, row_capacity, found_capacity;
    int64_t hit_capacity;
} tobi_near_bodies;

int64_t tobi_near_bytes(const tobi_near_bodies *near);
void tobi_near_free(tobi_near_bodies *near);

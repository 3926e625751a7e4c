/* What particles see of bodies, as it is kept; sph/boundary/boundary.h fills and reads it. */
#pragma once
#include "core/body.h"
#include "core/cells.h"
#include "sph/boundary/points.h"
#include "sph/boundary/body_tree.h"
#include "sph/boundary/couple.k.h"
#include "sph/boundary/look_loops.h"

/* Particles of a row of cells near a body. */
typedef struct tobi_boundary_row { int32_t body, begin, end; int64_t hit; } tobi_boundary_row;

/* The caught particles of a block. next: the next block with any, -1: none. */
typedef struct tobi_caught_block {
    double lower[3], upper[3];
    int64_t next;
    int32_t count;
} tobi_caught_block;

struct tobi_system;

typedef struct tobi_boundary_links {
    tobi_boundary_link *link;     /* by body, then by particle                                        */
    tobi_boundary_entry *entry;   /* of each link                                                     */
    int64_t count, capacity, link_capacity;
    int64_t contacts;         /* particles pushed out in this step                                */
    int64_t cut_pairs;        /* fluid pairs cut because a body lies between                      */
    int64_t *first;           /* [bodies + 1] first entry of each body                            */
    double (*total)[TOBI_TOTALS];    /* [bodies] by tobi_boundary_sum                             */
    double (*answer)[6];      /* [bodies] sph/boundary/couple.k.h                                          */
    struct sph_viscous_body *viscous;       /* [bodies] sph/viscous_bodies.h                      */
    tobi_block_sum *part;     /* scratch of sums over the particles of each body                  */
    int32_t *caught;          /* [particles] of each block first those that bodies have caught    */
    tobi_caught_block *caught_block;
    int64_t first_caught;     /* block                                                            */
    tobi_body_tree tree;
    /* scratch of the search */
    tobi_boundary_bins *bins;     /* [bodies + 1]                                                     */
    double bin_width;         /* m                                                                */
    int32_t *bin_start;
    tobi_boundary_point *point;   /* of all bodies, by bin                                            */
    double *point_row[TOBI_POINT_ROWS];     /* the same                                               */
    const tobi_look_loops *loops;           /* for this machine                                       */
    tobi_boundary_row *row;
    int64_t row_count;
    int64_t *found;           /* [row_count] particles that see the body, then entries before     */
    int32_t *hit;             /* those particles                                                  */
    int64_t first_capacity, total_capacity, answer_capacity, viscous_capacity, part_capacity;
    int64_t caught_capacity, blocks_capacity;
    int64_t row_room[TOBI_POINT_ROWS];
    int64_t bins_capacity, start_capacity, point_capacity, row_capacity, found_capacity;
    int64_t hit_capacity;
    uint8_t *cut_mark;        /* of each group of the neighbour list, see pairs.c                     */
    int64_t mark_capacity;
} tobi_boundary_links;

/* The particle's entry for an earlier body, NULL = none. */
static inline const tobi_boundary_entry *tobi_boundary_next(const tobi_boundary_links *n,
                                                            const tobi_boundary_entry *e)
{
    const int32_t k = n->link[e - n->entry].previous;
    return k >= 0 ? &n->entry[k] : NULL;
}

/* Grows an array of the links for `need` items, if it must; what it holds stays. */
tobi_status tobi_boundary_grow_rows(void **array, int64_t *capacity, int64_t need, size_t size,
                                    tobi_error *err);
#define tobi_boundary_grow(array, capacity, need, err) \
    tobi_boundary_grow_rows((void **)(array), capacity, need, sizeof **(array), err)

/* Puts the points of all bodies into bins, at their present pose. None is wet or covered yet; those in
   another body are buried, and nobody sees them. */
tobi_status tobi_boundary_place_points(struct tobi_system *s, tobi_error *err);

/* Calls visit for every point of a body in the bins around x, m from the lower corner of the box; stops early
   when it answers nonzero, and answers that. */
int tobi_boundary_visit(const tobi_boundary_links *links, int64_t body, const double x[3],
                        int (*visit)(void *user, int32_t point), void *user);
int64_t tobi_boundary_links_bytes(const tobi_boundary_links *links);
void tobi_boundary_links_free(tobi_boundary_links *links);

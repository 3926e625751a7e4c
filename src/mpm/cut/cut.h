/* Cuts in the material, on the grid: which particles an edge has passed, which nodes have two velocities and
   how far apart the faces of the cut are there. docs/theory/cutting.md. */
#pragma once
#include "core/system.h"
#include "mpm/cut/cross.h"
#include "mpm/grid.h"
#include "mpm/contact/solids.h"

/* A particle that remembers a cut. Those with one base node mostly follow one another: a run. */
typedef struct mpm_member {
    int32_t base[3], particle;         /* its lowest node                                         */
    int32_t sides;                     /* of any cut: 1 +, 2 -, 3 both; of the first of a run: of all */
    int32_t end;                       /* of the first of a run: where it ends                    */
} mpm_member;

typedef struct mpm_cut {
    float *side;                       /* [patches][nodes] of the first level, see mpm_view.sides */
    mpm_cut_face *cut_face;            /* [cut_face_count] of the nodes with two velocities, in order */
    int64_t cut_face_count;
    mpm_cross cross;                   /* the nodes with more                                     */
    float *tile;                       /* [tile_count] see mpm_view.sides                         */
    int64_t tile_count, tile_room;
    tobi_columns *face;                /* [particles] of each cut it remembers: normal towards the
                                          particle's side now, w: distance from the cut now, m    */
    uint32_t *hidden[MPM_LEVELS];      /* [particles], see mpm_view                               */
    mpm_member *member;                  /* [particles] those of a block from its first particle on  */
    int32_t *members;                   /* [blocks] how many                                       */
    mpm_extent *extent;                /* [blocks], see mpm/contact/solids.h                       */
    int64_t node_room, particle_room, block_room;
    double *rows;                      /* of a checkpoint, for the next step; NULL = none         */
    int64_t row_count;
} mpm_cut;

/* Passes the blades' edges over the particles: those they have passed remember it. *number: of the last cut
   made, counted up. */
void mpm_cut_mark(tobi_system *s, const mpm_view *v, double *number);
/* Finds the nodes with several velocities and makes their twins. The caller then points
   view.sides and view.hidden at what is here. */
tobi_status mpm_cut_find(mpm_cut *c, tobi_system *s, mpm_grid *g, const mpm_view *v, tobi_error *err);
/* Faces that meet push and rub: the first sweep of a step; another, while bodies push too; and at the end the
   gaps, and what friction and impact of the faces have taken, J. */
void mpm_cut_begin(mpm_cut *c, tobi_exec *x, const mpm_grid *g, double dt);
void mpm_cut_sweep(mpm_cut *c, tobi_exec *x, const mpm_grid *g, double dt);
double mpm_cut_finish(mpm_cut *c, tobi_exec *x, const mpm_grid *g, double dt);
/* The nodes with several velocities as they are now, for a checkpoint: rows of TOBI_RESTORED_ROW numbers, the
   caller's to free; and back from c->rows, after the blocks are built, instead of finding them. */
tobi_status mpm_cut_keep(const mpm_cut *c, double **rows, int64_t *count, tobi_error *err);
tobi_status mpm_cut_restore(mpm_cut *c, tobi_system *s, mpm_grid *g, const mpm_view *v, tobi_error *err);
/* The nodes of c->rows as they were, before their twins are made. */
tobi_status mpm_cut_read(mpm_cut *c, mpm_grid *g, tobi_error *err);
void mpm_cut_free(mpm_cut *c);

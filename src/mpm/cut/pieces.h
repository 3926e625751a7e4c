/* The connected pieces of solids, found anew whenever somebody asks; a step knows nothing of them.

   Two particles of one solid are linked if they are within 1.5 spacings and no remembered cut lies between
   them. Where the material keeps its neighbours (neo-Hookean, corotated) the spacings are those at rest, and
   a link is torn when the two are further apart than 1.5 spacings and than 1.5 times what the deformation
   makes of their distance: stretched rubber is one piece, and halves that touch again remain two. Material
   that flows is measured where it is. Liquids have no pieces.

   Drawback: two balls of one solid that started apart and collide are two pieces, though the grid may hold
   them together. */
#pragma once
#include "core/system.h"

typedef struct tobi_piece_list {
    tobi_pieces found;
    tobi_piece *piece;      /* owned, [found.count + found.fragments]                              */
    int32_t *of;            /* owned, [particles]: number of the piece of each row, -1 = liquid    */
} tobi_piece_list;

/* The particles that a piece has at least: those of a grid cell at its usual size. */
static inline int64_t tobi_pieces_least(int dimension) { return dimension == 3 ? 8 : 4; }

/* row_of: rows in the order of ids. `read` of the method gives J. On failure the list is empty. Same result
   for any number of threads; about 60 bytes per particle while it runs. */
tobi_status tobi_pieces_find(tobi_system *s, const int32_t *row_of, tobi_piece_list *list, tobi_error *err);
void tobi_pieces_free(tobi_piece_list *list);

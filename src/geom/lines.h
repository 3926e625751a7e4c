/* Parallel lines through a closed mesh, along z (2-D: through its section, along y), and where they
   enter and leave it. */
#pragma once
#include "geom/mesh.h"
#include "geom/section.h"

typedef struct tobi_line_cut {
    double at;                    /* along the line, from the middle                               */
    int turn;                     /* +1 enters, -1 leaves                                          */
} tobi_line_cut;

/* Lines of one pose of the mesh. Line (i, j) runs through x = middle + i fine, y = middle + j fine. */
typedef struct tobi_lines {
    double fine, middle[3];
    int64_t low[2], size[2];      /* range of i and j; 2-D: one j                                  */
    int64_t *start;               /* offsets into cuts, size[0] size[1] + 1                        */
    tobi_line_cut *cuts;          /* of each line, sorted                                           */
    int dimension;
} tobi_lines;

/* Cuts an oriented mesh (2-D: section, else NULL) by lines fine (m) apart. l must be zero before;
   free it also after a failure. Errors: TOBI_INVALID (too many lines), TOBI_NO_MEMORY. */
tobi_status tobi_lines_cut(tobi_lines *l, const tobi_mesh *mesh, const tobi_section *section,
                           double fine, tobi_error *err);
void tobi_lines_free(tobi_lines *l);

static inline int64_t tobi_line_index(const tobi_lines *l, int64_t i, int64_t j)
{
    return (i - l->low[0])*l->size[1] + j - l->low[1];
}

/* Where solids start, so that no fluid starts in the same place. */
#pragma once
#include "core/system.h"

typedef struct tobi_overlap tobi_overlap;

/* From the particles of a system of solids, for fluids of this spacing, m; freed by tobi_overlap_free. */
tobi_status tobi_overlap_create(const tobi_system *solids, double spacing, tobi_overlap **out,
                                tobi_error *err);
/* 1 if a particle of a fluid at x, m from the lower corner, would lie in a solid. NULL: no solids. */
int tobi_overlap_meets(const tobi_overlap *o, const double x[3]);
/* Notes the boxes and spheres of solids that are
   thinner than the fluid can tell from a hole. */
struct tobi_world;
tobi_status tobi_overlap_note_solids(struct tobi_world *w, tobi_error *err);
void tobi_overlap_free(tobi_overlap *o);

/* Places that are taken, as by solids that start there, so that no fluid starts in the same place. */
#pragma once
#include "core/system.h"

typedef struct tobi_overlap tobi_overlap;

/* From n places, m, which stay where they are; between: m, from one to the next, the mean of theirs and of
   those that are asked for. Freed by tobi_overlap_free. */
tobi_status tobi_overlap_create(const double (*at)[3], int64_t n, int dimension, double between,
                                tobi_overlap **out, tobi_error *err);
/* 1 if a particle at x, m in the same frame, would meet one of them. NULL: there are none. */
int tobi_overlap_meets(const tobi_overlap *o, const double x[3]);
/* Notes the boxes and spheres of solids that are
   thinner than the fluid can tell from a hole. */
struct tobi_world;
tobi_status tobi_overlap_note_solids(struct tobi_world *w, tobi_error *err);
void tobi_overlap_free(tobi_overlap *o);

/* Broad phase: which pairs of bodies can meet in a step. Boxes around the bodies, sorted along the axis
   on which they spread most, then swept: n log n and the overlaps on one axis, not n^2. */
#pragma once
#include "rigid/touch.h"

typedef struct tobi_pair { int32_t a, b; } tobi_pair;
typedef struct tobi_broad_entry tobi_broad_entry;

typedef struct tobi_broad {
    tobi_broad_entry *entries;   /* by lower end     */
    double *margin;              /* per body, m      */
    tobi_pair *pairs;            /* a < b, by number */
    int64_t pair_count, pair_capacity;
    int capacity;
} tobi_broad;

/* Finds the pairs in which at least one body moves by forces and that may come together in the next dt. */
tobi_status tobi_broad_find(tobi_broad *b, const tobi_body *bodies, const tobi_shape *shapes, int count,
                            double dt, tobi_error *err);
void tobi_broad_free(tobi_broad *b);

/* How far a body's surface may get in the step, and a little more; m. */
double tobi_broad_margin(const tobi_broad *b, int body);
/* Turns a vector from world axes into a body's rest axes. */
void tobi_broad_turn_back(const tobi_rigid *r, double x[3]);

/* Blades: bodies whose edge cuts. Where a point lies relative to the edge, in the present pose. */
#pragma once
#include "core/body.h"

/* Seen from the nearest point of the edge. */
typedef struct tobi_blade_place {
    double beyond;                     /* m, past an end of the edge; 0 beside it                 */
    double ahead;                      /* m, in the direction of cutting: > 0 is not cut yet      */
    double aside;                      /* m, along the cut's normal                               */
    double far;                        /* m, from all edges, those that cut nothing now included  */
    double normal[3];                  /* of the cut, axes as asked                               */
} tobi_blade_place;

/* A piece of the edge in world axes. */
typedef struct tobi_blade_piece {
    double middle[3];                  /* m, from the domain's corner                             */
    double rest[3];                    /* m, the same in rest axes about the body's centre        */
    double length;                     /* m; in 2-D 1, per metre of depth                         */
    int32_t number;
    double ahead[3], normal[3];        /* direction of cutting, normal of the cut                 */
} tobi_blade_piece;

/* Before the others, whenever the body has moved or has other velocities: where its edges cut now. */
void tobi_blade_update(tobi_body *b, int dimension);
/* x: m, from the body's centre, in the body's rest axes, as the normal found. 0 if the edge has no direction:
   it is tagged and stands still; only `far` is found then. */
int tobi_blade_locate(const tobi_body *b, int dimension, const double x[3], tobi_blade_place *out);
/* The same for x in world axes, from the domain's corner, and a normal in world axes. */
int tobi_blade_locate_world(const tobi_body *b, int dimension, const double x[3], tobi_blade_place *out);
/* The box around the edge, m, grown by `reach`. */
void tobi_blade_box(const tobi_body *b, double reach, double low[3], double high[3]);
/* Cuts the edge into pieces of at most `size` (m), in the order of the edges; returns how many there are and
   writes the first `room` of them. */
int64_t tobi_blade_pieces(const tobi_body *b, int dimension, double size, tobi_blade_piece *out,
                          int64_t room);
/* Makes room for what `count` pieces pushed with, 0 if that was another number before. */
tobi_status tobi_blade_restore(tobi_body *b, int64_t count, tobi_error *err);

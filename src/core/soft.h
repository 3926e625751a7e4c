/* What a liquid sees of soft solids: each of their particles is a point with a volume. The liquid presses the
   points; the solids' method gives that to their particles. The world owns it, one method fills it, the other
   reads it: rows are those of the solids' particles, good until these are sorted again. */
#pragma once
#include "exec/portable.h"

struct tobi_system;

/* m3 now, 0: in a body that the liquid sees anyway; 1/kg: the answer of a point to a force, 0: it does not
   move; 1 where liquid sticks, else 0. */
typedef struct tobi_soft_size { float volume, inverse_mass, grip; } tobi_soft_size;

typedef struct tobi_soft {
    struct tobi_system *solids;      /* NULL: no liquid beside solids in this world                 */
    int64_t count;
    const tobi_double3 *position;    /* m, from the lower corner of the domain                      */
    const tobi_float4 *velocity;     /* m/s                                                         */
    const tobi_soft_size *size;
    tobi_float4 *push;               /* N: by the liquid, in the last step, then in this one        */
    struct tobi_overlap *start;      /* where they are, while fluids are placed; else NULL          */
    const uint8_t *solid;            /* which solid a point is of                                   */
    const uint8_t *touched;          /* [solids] bit 2 axis + side: it comes to that side through liquid */
    double speed;                    /* m/s, of the fastest point near the liquid                   */
} tobi_soft;

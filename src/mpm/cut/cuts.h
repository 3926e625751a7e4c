/* What particles remember of cuts. A cut is a surface that the edge of a blade has swept through the
   material; every particle near it keeps for good on which side of it it lies: the blade may leave, the
   halves may part and touch again, and they never become one. docs/theory/cutting.md.

   A particle's cuts are three columns: c[k].xyz is the way from the cut to the particle, square to the cut,
   m, in the material at rest; c[k].w the number of the cut, 1 to 2^24, with the sign of the particle's side.
   0 = none, and none after it. */
#pragma once
#include "exec/portable.h"

enum { TOBI_CUTS_EACH = 3 };           /* cuts that one particle can remember                      */

/* 1 if a cut lies between two particles. */
static inline int tobi_cuts_apart(const tobi_columns *a, const tobi_columns *b)
{
    for (int i = 0; i < TOBI_CUTS_EACH && a->c[i].w != 0; i++)
        for (int k = 0; k < TOBI_CUTS_EACH && b->c[k].w != 0; k++)
            if (a->c[i].w == -b->c[k].w) return 1;
    return 0;
}

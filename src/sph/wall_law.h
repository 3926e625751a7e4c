/* Friction of a liquid on a wall that it sticks to, docs/theory/dfsph.md. */
#pragma once
#include "exec/portable.h"

/* Stress on the wall over that of a linear profile, mu u/s, for a liquid that moves at u relative to it at
   the distance s; reynolds = u s/nu. Above 1 where a turbulent layer lies below s, eq. (14b): u+ = 8.3
   (y+)^(1/7) [Werner & Wengle 1991]. Roots, since powf differs between mathematics libraries. */
TOBI_FN float tobi_wall_law(float reynolds)
{
    const float share = 0.0246384f*sqrtf(reynolds)*sqrtf(sqrtf(reynolds));     /* 8.3^(-7/4) Re^(3/4) */
    return share > 1 ? share : 1;
}

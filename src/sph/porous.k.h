/* The drag of porous zones per particle: of v->porous[i], w and the vector s make c P, eq. (3) of
   docs/theory/porous.md. All directions: w = c, s = 0. Across n: w = c, s = sqrt(c) n. Along n: w = 0,
   s = sqrt(c) n. */
#pragma once
#include "exec/portable.h"

/* c: dt times the drag per velocity. */
TOBI_FN float sph_porous_drag(tobi_float4 d) { return d.w > 0 ? d.w : d.x*d.x + d.y*d.y + d.z*d.z; }

/* The part of x that feels the drag, times c. */
TOBI_FN void sph_porous_part(tobi_float4 d, const float x[3], float out[3])
{
    const float along = (d.w > 0 ? -1 : 1)*(d.x*x[0] + d.y*x[1] + d.z*x[2]);
    out[0] = d.w*x[0] + along*d.x;
    out[1] = d.w*x[1] + along*d.y;
    out[2] = d.w*x[2] + along*d.z;
}

/* M x, eq. (2). */
TOBI_FN void sph_porous_yield(tobi_float4 d, float x[3])
{
    const float c = sph_porous_drag(d);
    float part[3];
    if (!(c > 0)) return;
    sph_porous_part(d, x, part);
    for (int a = 0; a < 3; a++) x[a] = (x[a] - part[a]/c) + part[a]/(c*(1 + c));
}

TOBI_FN tobi_float4 sph_porous_give(tobi_float4 d, tobi_float4 a)
{
    float x[3] = {a.x, a.y, a.z};
    sph_porous_yield(d, x);
    const tobi_float4 out = {x[0], x[1], x[2], a.w};
    return out;
}

/* The mean of M over all directions. */
TOBI_FN float sph_porous_mean(tobi_float4 d, int dimension)
{
    const float c = sph_porous_drag(d), s2 = d.x*d.x + d.y*d.y + d.z*d.z;
    const float trace = d.w > 0 ? (float)dimension*d.w - s2 : s2;
    return 1 - trace/((float)dimension*(1 + c));
}

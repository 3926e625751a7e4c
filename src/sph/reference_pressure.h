/* The reference pressure of still water in an open vessel, eq. (18) of docs/theory/dfsph.md: hydrostatic
   below a level that lies under the whole free surface, zero above it, smooth between. Its exact gradient is
   taken from gravity, and pressure solves know only what differs from it. It depends on height alone. */
#pragma once
#include "exec/portable.h"

typedef struct tobi_reference {
    double down[3];             /* unit vector of gravity along axes with walls                */
    double corner[3];           /* of the box, m, the highest: depths are counted from it      */
    double level;               /* m, depth of the lowest of the free surface                  */
    double cover, ramp;         /* m below it: nothing yet; all of it `ramp` deeper            */
    double rest;                /* m of water below, that the solve keeps as pressure          */
    double push;                /* Pa/m, density times gravity; 0 = no reference               */
} tobi_reference;

/* Metres below the highest corner of the box. */
TOBI_FN double tobi_reference_depth(const tobi_reference *w, const double *x)
{
    return w->down[0]*(x[0] - w->corner[0]) + w->down[1]*(x[1] - w->corner[1]) +
           w->down[2]*(x[2] - w->corner[2]);
}

/* The pressure, Pa: a cubic from 0, level, to `push` times the depth. */
TOBI_FN double tobi_reference_pressure(const tobi_reference *w, const double *x)
{
    if (!(w->push > 0)) return 0;
    double s = tobi_reference_depth(w, x) - w->level, end = w->cover + w->ramp - w->rest;
    double t = (s - w->cover)/w->ramp;
    return w->push*(t <= 0 ? 0 : t >= 1 ? s - w->rest : t*t*((3 - 2*t)*end + (t - 1)*w->ramp));
}

/* Its gradient over that of water at rest: the share of gravity it takes, eq. (19); above 1 in the ramp. */
TOBI_FN double tobi_reference_share(const tobi_reference *w, const double *x)
{
    if (!(w->push > 0)) return 0;
    double s = tobi_reference_depth(w, x) - w->level, end = w->cover + w->ramp - w->rest;
    double t = (s - w->cover)/w->ramp;
    return t <= 0 ? 0 : t >= 1 ? 1 : t*(6*(1 - t)*end/w->ramp + 3*t - 2);
}

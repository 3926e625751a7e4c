/* Where the reference pressure of still water begins (sph/reference_pressure.h), step by step. */
#pragma once
#include "core/system.h"
#include "sph/stages.h"

/* The reference below a depth of `low`, m; 0 and a vessel without gravity across its walls have none. That of
   the lightest fluid, so that none is left to rise. */
tobi_reference sph_reference_make(const tobi_system *s, double low);
/* Takes it for the liquid; by dfsph and wcsph soft solids feel the same. */
void sph_reference_set(tobi_system *s, double low);
/* Drop of the free surface, m, but for the few deepest of its particles, which disorder may have made; 0
   where it has no more. After sph_measure_density, which leaves the depths in particles.surface_depth. Leaves
   their median in the state. */
double sph_reference_surface(tobi_system *s);
/* `low`, m, or the depth of the air beside soft solids where that is deeper (sph/soft_still.c). */
double sph_reference_below_air(tobi_system *s, double low);
/* That of the free surface. */
double sph_reference_low(tobi_system *s);
/* Drop of those parts of it that lie where still water presses, but from which the air above is to be seen,
   as under a gate that is drawn up; 0 without. Leaves these parts alone in particles.surface_depth; nothing
   else where still water presses stays in particles.surface. After sph_reference_low. */
double sph_reference_open(tobi_system *s);
/* *level, the drop of the last step, becomes that of the step at hand, by the surface of the last, `low` and
   `open`: down to `open` at once, down to `low` by `speed` (m/s, of the fastest particle or body) at most, up
   slowly. *before: the reference that pressures refer to until then. */
void sph_reference_move(tobi_system *s, tobi_reference *before, double low, double open, double speed,
                        double *level);

/* What a method remembers of its free surface, and how it finds it. */
typedef struct sph_surface {
    double *vessel;                          /* SPH_VESSEL_*                            */
    double *low, *level;                     /* m, depths of the surface and of still water */
    double (*find)(tobi_system *s);      /* the first of them now                   */
    int rests;                               /* 1: the method takes still water         */
} sph_surface;
/* Whether water may begin at rest: nothing else acts at the start that is no small part of gravity. */
int sph_reference_begins(const tobi_system *s);
/* Gravity has changed (tobi_method.follow_gravity). Before the first step everything is found anew. Else the
   pressures stay what they are in sum, and refer to water at rest below the present surface under the new
   gravity. */
void sph_reference_follow(tobi_system *s, sph_view *v, const sph_kernels *k, const sph_surface *f);

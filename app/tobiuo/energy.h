/* Energy that liquid and solids gain where nothing can give it (tobi_world_closed). */
#pragma once
#include "tobiuo/tobiuo.h"

typedef struct energy_watch {
    int closed;              /* 0: something drives the scene, nothing is judged                    */
    double bodies;           /* J, of free bodies at the start: they may give it                    */
    double start;            /* J, of liquid and solids at the start                                */
    double least;            /* J, the least so far; the start where bodies are free                */
    double gain, time;       /* J, s: the most above it, and when                                   */
    double kinetic;          /* J, the last                                                         */
} energy_watch;

/* Of a world that is as it was at the start. */
void energy_begin(energy_watch *e, const tobi_world *world, double kinetic, double potential,
                  double elastic);
/* At an output. */
void energy_look(energy_watch *e, double time, double kinetic, double potential, double elastic);
/* Whether more was gained than errors of the method explain; and whether beyond all doubt. */
int energy_gained(const energy_watch *e);
int energy_absurd(const energy_watch *e);

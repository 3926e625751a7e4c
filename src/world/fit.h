/* The spacing at which whole layers of particles hold as much liquid as the scene says. */
#pragma once
#include "world/world.h"

typedef struct tobi_fit {
    double spacing;     /* m: of particles, each of which stands for its square or cube               */
    double stretch;     /* 1: the most by which layers lie nearer or farther apart than that          */
} tobi_fit;

/* Of all boxes of fluid, near `wish`, m: that itself where layers fit, and where nothing near it does. */
tobi_fit tobi_fit_find(const tobi_world *w, double wish);
/* Adds a note if the world has taken another spacing than its definition's, or one that does not fit. */
tobi_status tobi_fit_note(tobi_world *w, tobi_error *err);

/* Bodies that change their shape, in isph. */
#pragma once
#include "sph/isph/bodies.h"

/* Adds to this system's load on each such body what pressure does by the change. After isph_forces_load. */
void isph_shape_load(isph_solver *m, tobi_system *s);

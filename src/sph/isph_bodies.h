/* What isph sees of bodies, and what it does to them. */
#pragma once
#include "sph/isph_solve.h"

/* A mirror for each entry of s->near; v->behind. After sph_see_walls. */
tobi_status isph_bodies_see(isph_solver *m, tobi_system *s, tobi_error *err);
/* Takes back what sph_apply_forces gave for the weight of images: those of the pressure equation know it. */
void isph_bodies_unlift(tobi_system *s);
/* Adds dt times near.answer to the velocities of the mirrors at bodies that move by forces. */
void isph_bodies_push(isph_solver *m, tobi_system *s, double dt);

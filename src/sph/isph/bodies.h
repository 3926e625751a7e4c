/* What isph sees of bodies, and what it does to them. */
#pragma once
#include "sph/isph/solve.h"

/* A mirror for each entry of s->links; v->body_share. After sph_find_boundaries. */
tobi_status isph_bodies_find_mirrors(isph_solver *m, tobi_system *s, tobi_error *err);
/* Takes back what sph_apply_forces gave for the weight of images: those of the pressure equation know it. */
void isph_bodies_remove_hydrostatic(tobi_system *s);
/* Adds dt times links.answer to the velocities of the mirrors at bodies that move by forces. */
void isph_bodies_accelerate(isph_solver *m, tobi_system *s, double dt);
/* The images as their mirrors move now: after changes of those. */
void isph_bodies_refresh_images(isph_solver *m);
/* Force and torque of a push of 1 N along the normal at point k. */
void isph_bodies_lever(const tobi_body *b, int64_t k, double lever[6]);
/* f += those of such a push of `push` N. */
void isph_bodies_push(const tobi_body *b, int64_t k, double push, double f[6]);

/* Water in gaps between bodies and sides that particles do not enter, eq. (12c). */
#pragma once
#include "sph/isph/solve.h"

/* The gaps of body k, of which point[] are the points, weighed if particles see it: their marks and the gaps
   of m->body[k]. Adds to f what is not linear in the pressures of the particles. After
   tobi_boundary_find_neighbors. */
void isph_gaps_find(isph_solver *m, tobi_system *s, int k, isph_point *point, double f[6]);
/* push += what gaps add to the force and torque of a pressure of -1 at point k. */
void isph_gaps_add(const isph_body *b, const tobi_body *body, const isph_point *point, int64_t k,
                   double push[6]);
/* f += the force on the body through gaps at sides, along their normals, of a pressure at point p, the k-th,
   which has the share `share` of it. */
void isph_gaps_add_side(const isph_body *b, const tobi_body *body, const isph_point *p, int64_t k,
                        double share, double f[3]);
/* Adds to the rest_force of bodies what still water beside soft solids presses them with where these lie on
   them. After isph_gaps_find and sph_soft_find_dry. */
void isph_gaps_add_still(isph_solver *m, tobi_system *s);

/* Porous zones that bodies carry in the pressure equation of isph: by pairs, as the drag itself, eq. (9) of
   docs/theory/porous.md. All do nothing without bodies that move by forces and carry zones. */
#pragma once
#include "sph/isph/solve.h"

/* Before bodies are predicted: how the pressure of each particle pushes the carrier of a zone near it. */
void isph_carry_find(isph_solver *m, tobi_system *s);
/* Adds to force and torque on a body, N, N m, what its zones take: of the fall of the liquid, and besides
   what moves on with the body as it is; by pressures. */
void isph_carry_add_known(const isph_solver *m, tobi_system *s, int body, double f[6]);
void isph_carry_press(const isph_solver *m, tobi_system *s, int body, const double *pressure, double f[6]);
/* Adds links.answer of the bodies to rows of the equation. */
void isph_carry_spread(const isph_solver *m, tobi_system *s, double *rows);
/* The trace of what that adds for a body, over the diagonal. */
double isph_carry_trace(const isph_solver *m, tobi_system *s, int body);
/* The liquid in zones moves on by share times links.answer. */
void isph_carry_move(tobi_system *s, double share);
/* After all: bodies have what the liquid has lost; both move by what differs from the equation's forces. */
void isph_carry_settle(const isph_solver *m, tobi_system *s);

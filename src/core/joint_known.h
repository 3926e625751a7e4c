/* What springs and dampers of joints between bodies give in a step, where it begins: the pressure of a liquid
   answers it, or a stiff spring would kick bodies that the water around them makes heavy
   (docs/decisions/0166-slides.md). */
#pragma once
#include "core/constraint.h"

/* Adds to force and torque on a body, N and N m about its centre. */
void tobi_constraints_add_known(const tobi_constraints *c, const tobi_body *bodies, int body, double load[6]);

/* Sides of the domain that particles of solids touch themselves. */
#pragma once
#include "core/system.h"
#include "mpm/contact/contact.h"
#include "mpm/grid.h"

/* touched: of each solid, bit 2 axis + side, in a world with a liquid those at which none of it starts. v: of
   all solids. The world's solids beside a liquid know `touched` from then on. */
void mpm_sides_find(const tobi_system *s, mpm_view *v, uint8_t touched[]);
/* Marks the nodes that obey a side, where not all do, mpm_patch.obey, in every step: those of solids that do
   not touch it themselves, but for nodes that a clamp moves. */
void mpm_sides_mark(const tobi_system *s, mpm_grid *g, const mpm_view *v);
/* As tobi_contact_find, of a side; *b becomes a body that stands for it. */
tobi_status mpm_sides_list(tobi_contacts *c, const tobi_system *s, int side, const tobi_contact_step *step,
                           tobi_body *b, tobi_error *err);

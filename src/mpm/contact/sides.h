/* Sides of the domain that particles of solids touch themselves. */
#pragma once
#include "core/system.h"
#include "mpm/contact/contact.h"

/* Bit 2 axis + side of each: of a world with a liquid those at which no solid starts. Others act on the
   nodes. */
int mpm_sides_find(const tobi_system *s);
/* As tobi_contact_find, of a side; *b becomes a body that stands for it. */
tobi_status mpm_sides_list(tobi_contacts *c, const tobi_system *s, int side, const tobi_contact_step *step,
                           tobi_body *b, tobi_error *err);

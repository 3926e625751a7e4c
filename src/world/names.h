/* Names of the objects of a world: each is the only one of its kind, as in scenes. */
#pragma once
#include "world/world.h"

/* TOBI_INVALID if a fluid, solid or body has that name: files, tables and clamps know these by it. `kind`:
   of the new one, for the message. */
tobi_status tobi_names_check_matter(const tobi_world *w, const char *kind, const char *name, tobi_error *err);
tobi_status tobi_names_check_probe(const tobi_world *w, const char *name, tobi_error *err);
tobi_status tobi_names_check_line(const tobi_world *w, const char *name, tobi_error *err);
tobi_status tobi_names_check_joint(const tobi_world *w, const char *name, tobi_error *err);
tobi_status tobi_names_check_porous(const tobi_world *w, const char *name, tobi_error *err);
tobi_status tobi_names_check_opening(const tobi_world *w, int outlet, const char *name, tobi_error *err);

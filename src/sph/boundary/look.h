/* What one particle sees of one body. */
#pragma once
#include "core/system.h"
#include "sph/boundary/links.h"

/* Fills link and entry of particle i; what it sees of the body's points they remember as wet and covered.
   alone: no other thread looks at the body. */
void tobi_boundary_look(const tobi_system *s, int32_t i, int body, int alone, tobi_boundary_link *link,
                        tobi_boundary_entry *entry);

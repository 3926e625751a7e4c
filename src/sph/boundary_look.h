/* What one particle sees of one body. */
#pragma once
#include "core/system.h"
#include "sph/boundary_links.h"

/* How much of a point counts, by the particle's height above its plane and its distance from the body, m. A
   particle beyond an edge would see the next face at once when it passes the plane of that face. */
static inline double tobi_boundary_rise(double height, double distance, double spacing)
{
    const double width = distance < 0.25*spacing ? distance : 0.25*spacing;
    return height < width ? height/width : 1;
}

/* Fills link and entry of particle i; what it sees of the body's points they remember as wet and covered. */
void tobi_boundary_look(const tobi_system *s, int32_t i, int body, tobi_boundary_link *link,
                        tobi_boundary_entry *entry);

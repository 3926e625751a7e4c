/* The section of a closed mesh with the plane z = 0: directed line pieces, the inside on their left
   seen from +z. In 2-D a body is this section. */
#pragma once
#include "geom/mesh.h"

/* One piece per triangle that the plane cuts. Ends are barycentric in their triangle (a and b) and
   as points (from, to; x and y in m). */
typedef struct tobi_section {
    int64_t count;
    int32_t *triangle;
    double (*a)[3], (*b)[3];
    double (*from)[2], (*to)[2];
} tobi_section;

/* Cuts an oriented mesh. Vertices at z = 0 count as above the plane, so that the pieces always form
   closed loops. No piece at all is TOBI_INVALID, with the z range of the mesh in the text. */
tobi_status tobi_section_cut(const tobi_mesh *mesh, tobi_section *out, tobi_error *err);
void tobi_section_free(tobi_section *section);

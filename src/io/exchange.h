/* Plain files for other programs: PLY of points, OBJ of triangles. In metres; each appears whole or not at
   all (base/file.h). Failures: TOBI_IO with path and reason, TOBI_NO_MEMORY. Arrays are borrowed. */
#pragma once
#include "base/error.h"

/* Binary little-endian PLY with float x, y, z. */
tobi_status tobi_ply_write(const char *path, int64_t n, const double (*points)[3], tobi_error *err);
/* Text with 9 digits; triangles are indices into vertices. */
tobi_status tobi_obj_write(const char *path, int64_t vertex_count, const double (*vertices)[3],
                           int64_t triangle_count, const int32_t (*triangles)[3], tobi_error *err);

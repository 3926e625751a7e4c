/* Reading the files that io/vtk.h writes. */
#pragma once
#include "base/error.h"
#include "tobiuo/results.h"

/* Particles of a VTU file: count, positions, fields. TOBI_DAMAGED with path and reason. What was read
   before a failure stays in *moment, to be freed by its owner. */
tobi_status tobi_vtu_read(const char *path, tobi_moment *moment, tobi_error *err);
/* Vertices and triangles of a VTP file. The same failures. */
tobi_status tobi_vtp_read(const char *path, tobi_moment_surface *surface, tobi_error *err);

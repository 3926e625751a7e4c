/* Surfaces of particles as files; the public calls are in tobiuo/surface.h. */
#pragma once
#include "io/vtk.h"
#include "tobiuo/surface.h"

/* As VTP, with all its fields, whole or not at all; errors are those of tobi_vtp_write. */
tobi_status tobi_surface_write_vtp(const char *path, tobi_compression compression,
                                   const tobi_surface *surface,
                                   tobi_error *err);

/* Of each vertex red, green, blue (sRGB) and opacity, 0 to 1: the field "color" of four components, or
   NULL. */
const float *tobi_surface_colors(const tobi_surface *surface);

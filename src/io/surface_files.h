/* Surfaces of particles as files; the public calls are in tobiuo/surface.h. */
#pragma once
#include "io/vtk.h"
#include "tobiuo/surface.h"

tobi_status tobi_surface_write_vtp(const char *path, tobi_compression compression,
                                   const tobi_surface *surface,
                                   tobi_error *err);

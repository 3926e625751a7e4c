/* A polygon, from a text or a table, and the prism over it. */
#pragma once
#include "geom/mesh.h"
#include "tobiuo/outline.h"

/* at: owned. */
typedef struct tobi_outline { double (*at)[2]; int64_t count; } tobi_outline;

/* The two axes of the plane across an axis: 0 x, 1 z of y; 0 x, 1 y of z; 0 y, 1 z of x. */
void tobi_outline_axes(int axis, int plane[2]);
/* "0,0 5,0.25 5,0": m. TOBI_INVALID: no such text. Free it in any case. */
tobi_status tobi_outline_parse(const char *text, tobi_outline *out, tobi_error *err);
/* A CSV table whose first line names both coordinates, letters of x, y and z, in m or with their unit, as
   "x [mm]"; other columns do not count. TOBI_NOT_FOUND, TOBI_IO, TOBI_INVALID with the line. Free it in any
   case. */
tobi_status tobi_outline_read(const char *path, const int plane[2], tobi_outline *out, tobi_error *err);
/* A line that goes to the right becomes the polygon between it and the height `base`. TOBI_INVALID. */
tobi_status tobi_outline_fill(tobi_outline *line, double base, tobi_error *err);
void tobi_outline_free(tobi_outline *outline);

/* A copy without points on straight sides, counterclockwise, owned. whose: as "body 'bed'", for messages.
   TOBI_INVALID: fewer than three corners, sides that cross, no area. */
tobi_status tobi_outline_clean(const char *whose, const tobi_outline *given, tobi_outline *out,
                               tobi_error *err);
/* The prism over a polygon of any sense, from `from` to `to` (m, above it) along an axis. Errors: as of
   the last. */
tobi_status tobi_mesh_prism(const char *whose, const tobi_outline *outline, int axis, double from, double to,
                            tobi_mesh *out, tobi_error *err);

/* 1: there is one. */
int tobi_outline_given(const tobi_outline_def *def);
/* Its points as they are given, and its axis, 2 in 2-D. TOBI_INVALID, TOBI_NOT_FOUND, TOBI_IO. Free it in any
   case. */
tobi_status tobi_outline_load(const char *whose, const tobi_outline_def *def, int dimension, int *axis,
                              tobi_outline *out, tobi_error *err);
/* Its mesh, in 2-D far to both sides of the plane. TOBI_INVALID, TOBI_NOT_FOUND, TOBI_IO. */
tobi_status tobi_mesh_outline(const char *whose, const tobi_outline_def *def, int dimension, tobi_mesh *out,
                              tobi_error *err);

/* Lists of points of two or three numbers, and tables of them. */
#pragma once
#include "base/error.h"
#include <stdint.h>

/* at: owned, count x width numbers. */
typedef struct tobi_points { double *at; int64_t count; int width; } tobi_points;

/* TOBI_INVALID: there are `most` already. */
tobi_status tobi_points_add(tobi_points *points, const double *at, int64_t most, tobi_error *err);
/* A CSV table whose first line names the coordinates, the letters of `names`, in m or with their unit, as
   "x [mm]"; other columns do not count. Free it in any case. TOBI_NOT_FOUND, TOBI_IO, TOBI_INVALID with the
   line. */
tobi_status tobi_points_read(const char *path, const char *names, int64_t most, tobi_points *out,
                             tobi_error *err);
void tobi_points_free(tobi_points *points);

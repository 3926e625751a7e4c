/* What a column of a table comes to. */
#pragma once
#include "table.h"

/* rows: how many values. Extremes have their times. NaN, and infinite extremes, where there is none. */
typedef struct digest { double last, mean, low, high, low_time, high_time; size_t rows; } digest;

/* Of rows whose `name` is that one, NULL: of all. Extremes and means are of the time from `from` on. Columns
   are numbers; second is added to the first, -1: there is none. */
digest digest_column(const table *t, const char *name, int first, int second, double from);
/* Whether a row is of that name. */
int digest_belongs(const table *t, const char *name, size_t row);
/* Adds mean_motion_power to a table of bodies: what the motion of a body gave since its last row, W. Nothing
   where there is no motion_work. */
void digest_add_power(table *t);

/* What the files of sampling share: points sorted by cells. */
#pragma once
#include "base/error.h"
#include "exec/exec.h"
#include "tobiuo/sample.h"
#include <math.h>
#include <stdbool.h>

/* Points in cells over a box, those beyond it in its outermost cells. Entry k is point row[k] at x[k]. */
typedef struct sample_cells {
    int dimension;
    double low[3], edge;
    int64_t n[3], cells, count;
    int32_t *begin;              /* cells + 2; points that are not finite stand in the last */
    int32_t *row;
    double (*x)[3];
    uint32_t *key;
} sample_cells;

/* cells.c. edge: at least, m; it becomes wider where there would be too many. */
tobi_status sample_fill_cells(sample_cells *c, tobi_exec *exec, const tobi_sample_def *def, double edge,
                              int64_t count, const double (*points)[3], tobi_error *err);
void sample_free_cells(sample_cells *c);
/* The next run of entries that may lie within `reach` of x; from state 0 on. False: there is none. */
bool sample_next_run(const sample_cells *c, const double x[3], double reach, int64_t *state, int32_t *begin,
                     int32_t *end);

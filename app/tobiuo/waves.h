/* One call of tobiuo waves: what its files share. */
#pragma once
#include "picture.h"
#include "table.h"
#include "wave_analysis.h"
#include <jansson.h>

enum { GROUPS = 16, MEMBERS = 16, RESPONSES = 16 };

typedef struct wave_options {
    const char *dir, *format, *groups[GROUPS], *responses[RESPONSES];
    int group_count, response_count;
    double from, until, depth;         /* s; m, below 0: that of the scene */
} wave_options;

typedef struct wave_run {
    const wave_options *options;
    table levels;                      /* probes.csv */
    json_t *scene;                     /* resolved.json */
    int dimension, up;                 /* 2 or 3; the axis against gravity */
    wave_set set;
    int group[GROUPS][MEMBERS], members[GROUPS];
    wave_group result[GROUPS];
} wave_run;

typedef void wave_table_writer(FILE *out, const void *what);

/* Ways of the gauges of a group along the line from the first to the last, m, and its direction; or a
   complaint. */
int waves_line_up(const wave_run *w, int group, double at[MEMBERS], double way[3]);
/* DIR/name as write writes it of what. */
int waves_write_table(const wave_run *w, const char *name, wave_table_writer *write, const void *what);
/* A curve over the frequencies of the set, of every stride-th value; beyond CURVE_LIMIT there is none. */
void waves_add_curve(const wave_run *w, panel *a, const char *label, const double *value, size_t stride);
/* DIR/plots/name.FORMAT. */
int waves_draw(const wave_run *w, const picture *p, const char *name);

/* wave_responses.c: all --response, after wave_measure: tables, a picture, and lines on the terminal. */
int tell_responses(const wave_run *w);

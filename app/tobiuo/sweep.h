/* The product of some values of some keys of a scene: one run each, in a process of its own. */
#pragma once
#include "app.h"
#include "table.h"
#include <jansson.h>

enum { SWEEP_RUNS = 10000 };

/* One --set with its values. */
typedef struct sweep_axis {
    char *path;                     /* "isph.support"                                          */
    char *label;                    /* of names and columns: its last key, if no other has it  */
    char **value;
    int count;
} sweep_axis;

typedef enum sweep_state { SWEEP_NEW, SWEEP_BEGUN, SWEEP_DONE, SWEEP_FAILED } sweep_state;

typedef struct sweep {
    const char *scene, *dir;        /* as given; where the runs go                             */
    char *own_dir;                  /* owned: dir without --out                                */
    sweep_axis *axes;
    int axis_count, runs;
    const char *until, *plot, *waves;        /* NULL: not given                                */
    double from;                    /* mean, largest and least values are from this time on, s */
    int jobs, slurm, only, table;   /* only: one run by its number, -1 = all                   */
} sweep;

/* sweep.c: the value of an axis in a run; the name of its folder, owned by the caller. */
const char *sweep_value(const sweep *s, int run, int axis);
char *sweep_name(const sweep *s, int run);
/* A path in the sweep's folder, "%s/" before the rest; owned by the caller. */
char *sweep_path(const sweep *s, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* The summary of a run, NULL if it has none. */
json_t *sweep_summary(const sweep *s, int run);

/* sweep_run.c: what became of a run so far, and the time that it shall end at, s, where it has begun. Results
   of another scene, or beyond that time, are told, and code set. */
sweep_state sweep_look(const sweep *s, int run, double *end, int *code);
/* Runs all that is not complete, `jobs` at a time. Returns the exit code. */
int sweep_run(const sweep *s);
int sweep_write_slurm(const sweep *s);

/* sweep_table.c: sweep.csv and sweep.txt of what there is. */
int sweep_write_table(const sweep *s);
/* What is read of a row: a column, or the sum of two; first -1: nothing. */
typedef struct sweep_reading { int first, second; } sweep_reading;
sweep_reading sweep_find_reading(const table *t, const char *column);
/* A table of all runs; empty where there is none. units: left in the names. */
table *sweep_read_all(const sweep *s, const char *file, int units);
void sweep_free_tables(table *list, int count);
/* The first table with columns: all runs of a sweep have the same sensors unless they are swept. */
const table *sweep_first_table(const table *list, int count);
int sweep_dimension(const sweep *s);

/* sweep_plot.c: sweep.svg, and sweep_means.svg where a value that is swept is a number. */
int sweep_draw(const sweep *s);
/* A text as a cell of a CSV table, between quotes where it must be. */
void sweep_put_cell(FILE *out, const char *text);

/* sweep_waves.c: tobiuo waves of all complete runs: sweep_waves.csv, sweep_wave_groups.csv and
   sweep_wave_responses.csv. The exit code of the worst. */
int sweep_analyse_waves(const sweep *s);
/* Before the runs: whether tobiuo waves knows these options, and the scene the gauges. Leaves with the
   message of tobiuo waves if it knows an option not. */
int sweep_check_waves(const sweep *s, const tobi_scene *scene);

/* tobiuo sample: what its files share. */
#pragma once
#include "moment.h"
#include "table.h"
#include "tobiuo/sample.h"

enum { SAMPLE_LINES = 12, SAMPLE_SHOWN = 6 };

typedef struct sample_options {
    const char *dir, *name, *points, *box, *fields, *body, *fluid, *solid, *format;
    const char *line[SAMPLE_LINES];
    int line_count, mean, threads, count;
    double cell, from, until;          /* m, 0: the spacing; s */
} sample_options;

/* Where fields are asked for, as the user gives it. */
typedef struct sample_places {
    int64_t count;
    double (*x)[3];                    /* m */
    double *way;                       /* m from the start of its line; NULL: no lines */
    int *line;                         /* its line, from 0 */
    int is_grid;
    double origin[3], cell[3];
    int64_t n[3];
} sample_places;

/* A field, or one component of it, and its values at an output. */
typedef struct sample_field {
    const char *name, *unit;           /* unit "" = none */
    int components;
    double *at;
    const char *source;                /* the field in the files, "velocity" of "velocity_x" */
    int component;                     /* -1: all of it */
    int all;                           /* components of the source */
    double *read;                      /* its values; of a whole field these are `at` */
    tobi_sample_mean *mean;            /* NULL: not asked for */
} sample_field;

/* The frame of a body at an output: where it is and how it is turned (columns: its axes of the start). */
typedef struct sample_frame { double place[3], axes[3][3], velocity[3], spin[3]; } sample_frame;

/* Values of all fields at an output that a picture shows. */
typedef struct sample_shown { double time; double *values[TOBI_SAMPLE_FIELD_LIMIT]; } sample_shown;

typedef struct sample_run {
    const sample_options *options;
    const char *name;                  /* of the files */
    tobi_scene *scene;
    tobi_looks looks;
    tobi_results *results;
    int64_t first, end;                /* outputs */
    int material;                      /* -1: all liquids */
    double spacing;                    /* m, of its particles */
    sample_places places;
    int field_count;
    sample_field field[TOBI_SAMPLE_FIELD_LIMIT];
    char names[TOBI_SAMPLE_FIELD_LIMIT][40];
    uint8_t *wet;
    double (*moved)[3];                /* places in the domain; NULL without a body */
    table bodies;                      /* bodies.csv, with a body */
    sample_frame start, now;
    int finer;                         /* some body has particles nearer to each other than the liquid */
    thinned thinned;
    sample_shown shown[SAMPLE_SHOWN];
    int shown_count;
} sample_run;

/* All return 0, or an exit code after a complaint. */
/* sample_places.c: the places of the options; those beyond the domain are refused. */
int sample_find_places(sample_run *s);
/* sample_frame.c: looks for the body; its frame at an output; values of the sources into its axes. */
int sample_find_body(sample_run *s);
int sample_move_places(sample_run *s, double time);
void sample_turn_values(sample_run *s);
/* sample_files.c: DIR/sample/NAME.csv, begun and ended, or a grid for each output; means at the end. */
typedef struct sample_table { FILE *file; char *path, *part; } sample_table;
int sample_begin_table(const sample_run *s, sample_table *t);
int sample_write_rows(const sample_run *s, double time, sample_table *t);
int sample_end_table(sample_table *t, int code);
int sample_write_grid(const sample_run *s, int64_t output);
int sample_write_means(const sample_run *s);
/* "x" of "velocity"; "" of a number alone. */
const char *sample_component(int components, int k);
/* sample_plot.c: profiles along the lines. */
int sample_draw(const sample_run *s);

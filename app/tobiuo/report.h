/* The page of `tobiuo report`: what its parts share. */
#pragma once
#include "app.h"
#include "language.h"
#include "table.h"
#include <jansson.h>

typedef struct report {
    const char *dir;
    FILE *file;                         /* the page                                               */
    json_t *scene, *summary, *inputs;   /* resolved.json, summary.json, inputs.json; NULL: not there */
    char damaged[80];                   /* names of those that are there and cannot be read       */
    tobi_world *world;                  /* made of the scene, not started; NULL: see why          */
    tobi_scene *loaded;
    char why[300];                      /* why there is no world                                  */
    table history, bodies, probes, lines, joints, zones, scalars;   /* without columns: no such file */
    int has_links;                      /* the page lies in dir: to pages of nests                */
    double from;                        /* s: means and extremes are of the time from it on        */
    int dimension;
    double spacing;                     /* m; 0: not known                                        */
    const char *method;                 /* borrowed from scene; ""                                */
} report;

/* html.c: text with its special characters as entities. */
void html_text(FILE *file, const char *text);
/* The attribute's value "data:TYPE;base64,..." of a file. -1: it cannot be read, or has more than 32 MiB. */
int html_data(FILE *file, const char *type, const char *path);
/* A cell <th> for each text, in the page's language, up to NULL. An empty one is of class doc. */
void html_heads(FILE *file, const char *const *texts);

/* The scene's value at "a.b", NULL if there is none. */
const json_t *report_value(const report *r, const char *path);

/* report_tables.c: each column's last, mean and extreme values; where the time went. */
void write_tables(const report *r);
void write_times(const report *r);
/* report_waves.c: height and period of the waves at level sensors. */
void write_waves(const report *r);
/* report_nests.c: a page for each nest, a table of them. */
int report_nests(const report *r, int (*make)(const char *dir, double from, int force), int force);
void write_nests(const report *r);
/* report_trust.c */
void write_trust(const report *r);

/* report_widths.c: how fine a body's mesh is, both in m. */
typedef struct widths {
    double narrow;      /* least width between two parallel planes                                */
    double thin;        /* thickness along the normal that a tenth of the surface falls below     */
    double low[3], high[3];
} widths;
/* -1: there is no such surface. Some thousand rays against all triangles: below a second. */
int measure_widths(const tobi_world *world, int body, int dimension, widths *w);

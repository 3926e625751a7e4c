/* What `tobiuo plot` draws: which columns share a panel, and in which unit. */
#pragma once
#include "picture.h"

enum { PLOT_CURVES = 9, PLOT_SUM = 4 };

typedef struct curve_row {
    const char *label, *column;
    const char *plus;               /* a column to add, or NULL                     */
    curve_style style;
    int colour;
    const char *needs;              /* drawn only if this column has a value other than 0, or NULL */
    const char *const *too;         /* PLOT_SUM more at most, that the table has, ended by NULL; or NULL */
} curve_row;

typedef struct panel_row {
    const char *y_label;
    const char *unit;               /* after scaling; ""                            */
    double scale;                   /* of the column, 0 = 1                         */
    int per_depth;                  /* in 2-D the values are per metre of depth     */
    int logarithmic;
    int from_start;                 /* the change since the first row               */
    int of_steps;                   /* values of a step: the row before any step has none */
    curve_row curves[PLOT_CURVES];  /* ended by a row without column, if not full    */
} panel_row;

typedef struct picture_row {
    const char *file, *title;       /* of a body or solid the title has %s for its name */
    int optional;                   /* nothing is said of a picture without values  */
    panel_row panels[PANEL_LIMIT];  /* ended by a row without y_label               */
} picture_row;

/* A picture of a table with columns NAME_WHAT: a panel for each what, with a curve for each name. */
typedef struct columns_row { const char *file, *title, *what[PANEL_LIMIT]; } columns_row;

/* Of history.csv, of one body in bodies.csv, one solid in solids.csv; of probes.csv, lines.csv, joints.csv;
   ended by a row without file. */
extern const picture_row plot_history[], plot_body[], plot_solid[];
extern const columns_row plot_probes[], plot_lines[], plot_joints[];
/* The unit of any column of the tables, "" if it has none; with "/m" in two dimensions. */
const char *plot_unit(const char *column, int dimension);

/* plot.c: the pictures of a run in DIR/plots; the exit code. scene: NULL takes the references of the run.
   files: what was drawn, to be freed by plot_files_free after failures too. */
typedef struct plot_files { char *folder, **name; int count; } plot_files;
int draw_plots(const char *dir, const char *scene, const char *format, plot_files *files);
void plot_files_free(plot_files *files);

/* Pictures of curves, written as commands of gnuplot.

   A picture is panels above each other with one axis below, of time as a rule; a panel is curves with
   one y axis. Texts of users (names, labels) reach gnuplot as letters and character codes, values as
   digits, so that nothing in a file can become a command. */
#pragma once
#include <stddef.h>
#include <stdio.h>

enum { PANEL_LIMIT = 3, CURVE_LIMIT = 12 };

typedef enum curve_style { CURVE_LINE, CURVE_THIN, CURVE_DASHED, CURVE_POINTS } curve_style;

typedef struct curve {
    const char *label;              /* borrowed                                       */
    curve_style style;
    int colour;                     /* index into a palette, any number               */
    size_t count;
    double *x, *y;                  /* owned; what is not finite is not drawn         */
} curve;

typedef struct panel {
    char y_label[80];               /* with the unit                                  */
    int logarithmic;                /* wish: a panel without positive values is linear */
    int curves;
    curve curve[CURVE_LIMIT];
} panel;

typedef struct picture {
    char title[256];
    const char *x_label;            /* borrowed; NULL: "time, s"                      */
    double begin, end;              /* of the axis all panels share                   */
    int panels;
    panel panel[PANEL_LIMIT];
} picture;

/* Writes "quantity, unit" beside a panel, the unit from English, or "". */
void picture_label(panel *a, const char *quantity, const char *unit);
/* The head of a script: format is "svg" or "png". */
void picture_begin_script(FILE *script, const char *format);
/* The commands that draw the picture into `file`, in gnuplot's working directory. */
void picture_write(FILE *script, const picture *p, const char *file);
void picture_free(picture *p);
/* Whether the panel has a finite value to draw between the picture's begin and end. */
int panel_has_values(const picture *p, const panel *a);

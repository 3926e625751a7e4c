/* The state of the window, shared by its parts. */
#pragma once
#include "screen.h"
#include "window.h"
#include "../tobiuo/language.h"
#include "../tobiuo/table.h"
#include "tobiuo/overlay.h"
#include <stdio.h>

enum { PICKS = 2, GRAPH_CURVES = 3 };

#define NEST_PICK ((int64_t)1 << 48)

/* Curves of the run's tables, of one body or of the whole. */
typedef struct graph {
    char title[160];
    int curves;
    const char *label[GRAPH_CURVES];
    size_t count;
    double *time, *value[GRAPH_CURVES];        /* owned */
} graph;

typedef struct viewer {
    window_def def;
    screen *screen;
    painter *painter;
    tobi_results *results;              /* NULL: none yet                                         */
    int64_t outputs, shown;             /* shown = outputs: the present of a run that goes on     */
    shared_moment *moment;
    look look;
    int flat;                           /* the field had one value so far: high is a stand-in        */
    int factor;                         /* pixels of the window per pixel of a picture, each way  */
    int dirty, changed;                 /* a picture is needed; what is over it has changed       */
    int playing, paused, help, asks, ends;      /* playing: results; paused: a run        */
    double play_at;                     /* s of the wall clock, of the next output                */
    int graph_number;                   /* -1: none                                               */
    graph graph;
    int64_t picks[PICKS];               /* particle ids, of a nest + its number NEST_PICK; or -1  */
    painting painting;                  /* the last picture                                       */
    int drag;                           /* 0 none, 1 orbit, 2 pan, 3 time line                    */
    double drag_x, drag_y, moved;
    int wants_shot;                     /* a screenshot, when the picture is whole                */
    char *recording;                    /* folder of the pictures of a movie, or NULL             */
    int64_t recorded, painted, kept;    /* pictures of the movie; of the painter; last in the movie */
    char note[300];                     /* a line at the bottom                                   */
    const char *keys;                   /* of def.keys, those to come                             */
    unsigned char *pixels;              /* of the window, width x height x 3                      */
    int width, height;
    tobi_letters *letters;              /* NULL: the system has no font                           */
} viewer;

/* keys.c: what events do. */
void viewer_event(viewer *v, const event *e);
/* Shows an output, or the present; takes care of the range of the field. */
void viewer_show(viewer *v, int64_t output);
void viewer_adopt(viewer *v, shared_moment *m);
void viewer_note(viewer *v, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Where the time line is; pixels. */
void time_line_place(const viewer *v, int *x, int *y, int *width, int *height);
double viewer_end(const viewer *v);

/* window.c: the text in the language of the user, if there are letters for it. */
const char *window_text(const viewer *v, const char *english) __attribute__((format_arg(2)));

/* record.c: pictures and movies of the window. */
void take_shot(viewer *v);
void toggle_recording(viewer *v);
void record_picture(viewer *v);

/* legend.c: what is written over the picture. */
void draw_legend(viewer *v);
/* graph.c */
void graph_read(viewer *v);
void graph_free(graph *g);

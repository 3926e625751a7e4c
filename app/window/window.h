/* The window on a run: one that goes on, or results that are there. Everything about it is in this folder;
   the commands call window_show alone. */
#pragma once
#include "live.h"
#include "painter.h"

typedef struct window_def {
    const char *title, *dir;            /* of the results; pictures and movies of the window go there too */
    tobi_looks looks;                   /* the caller's                                             */
    struct nest_results *nests;         /* the caller's, or NULL                                    */
    int alone;                          /* 1: at first the scene alone is shown                     */
    double up[3];                       /* against gravity                                          */
    double eye[3], target[3], angle;    /* the camera of the scene; angle 0: a view that fits             */
    const char *keys; /* typed at the start, each when the picture before is there; or NULL */
    int width, height;                  /* pixels at the start; 0: 1280 x 720                              */
    live *live;                         /* NULL: finished results                                         */
} window_def;

/* Opens the window and stays in it until it is closed. Called by the program's first thread. 0; -1: there
   is no window, and a sentence says why on stderr. */
int window_show(const window_def *def);

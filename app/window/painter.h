/* A thread that draws pictures of moments, so that the window answers meanwhile. It takes the newest order
   only. */
#pragma once
#include "camera.h"
#include "tobiuo/drawing.h"

/* A moment that several threads look at; the last to let go frees it. */
typedef struct shared_moment shared_moment;
shared_moment *moment_share(tobi_moment *m); /* takes m over; NULL without memory: m is freed */
const tobi_moment *moment_of(const shared_moment *m);
shared_moment *moment_hold(shared_moment *m);
void moment_drop(shared_moment *m);                         /* NULL is fine */

enum { NAME_ROOM = 64 };

/* How a moment is looked at. */
typedef struct look {
    camera camera;
    char field[NAME_ROOM];              /* "": as pictures of a run are                             */
    double low, high;                   /* of the field                                             */
    int clip_axis;                      /* -1: none                                                 */
    int clip_below;                     /* 1: what lies below the plane is hidden, 0: above         */
    double clip;                        /* m                                                        */
    int alone;                          /* 1: the scene's liquid in the boxes of nests, too         */
    int width, height;
} look;

typedef struct painting {
    unsigned char *rgb;                 /* width x height x 3, owned                                */
    look look;
    shared_moment *moment;              /* what it shows, held                                      */
    double seconds;                     /* that it took                                             */
    char why[200];                      /* why there is none; ""                                    */
} painting;

typedef struct painter painter;
/* done(user) is called by the painter's thread after each picture. */
/* s: borrowed. */
painter *painter_create(const tobi_looks *s, void (*done)(void *user), void *user);
void painter_order(painter *p, shared_moment *m, const look *l);
int painter_is_idle(painter *p);
/* 1: *out is the newest picture, the caller's from now on. */
int painter_take(painter *p, painting *out);
void painting_free(painting *p);
void painter_free(painter *p);

/* NULL: the moment does not have it. */
const tobi_moment_field *find_field(const tobi_moment *m, const char *name);
/* Colour of a share 0 to 1 of the colour map, sRGB 0 to 1. */
void map_color(double share, float color[3]);
/* 1: hidden by the clip plane. */
int is_clipped(const look *l, const double point[3]);

/* A picture and what it points to, shared by drawing.c and palette.c. */
#pragma once
#include "tobiuo/drawing.h"

struct tobi_drawing {
    tobi_picture picture;              /* of what follows                               */
    const tobi_looks *looks;
    const tobi_moment *moment;
    const tobi_view_def *view;
    const tobi_moment_field *material, *part, *piece, *at_rest;      /* of the moment, or NULL */
    char title[64], label[160];
    int64_t count;                     /* particles that are shown                      */
    double (*positions)[3], (*velocities)[3];
    float *values;                     /* of the field; with a palette its colour's number */
    float (*own)[3];                   /* colours, see field_of; red below 0: by value; or NULL */
    uint8_t *opaque;
    int32_t *group;                    /* kind, material or piece                       */
    double *radii;                     /* m; NULL: all particles have one               */
    uint8_t *nest;                     /* see tobi_moment; NULL: no nests are shown     */
    float (*palette)[3];
    int colors;                        /* in the palette                                */
    int has_palette;                   /* 0: colours by a field                         */
    uint8_t *tint;                     /* of each piece                                 */
    int64_t pieces;
    tobi_picture_mesh *meshes;
    tobi_picture_path *paths;
    tobi_picture_skin *skins;          /* of materials with a texture                   */
    int16_t *skin;                     /* of particles, or NULL                         */
    double (*rest)[3];
    double (*edges)[2][3];             /* of porous zones, with those that bodies carry, or NULL */
};

/* The colours of all materials, if any has one or if there are several liquids. */
tobi_status tobi_drawing_make_palette(tobi_drawing *d, const tobi_moment_field *id, tobi_error *err);
/* The number of a colour in the palette. */
int tobi_drawing_color(const tobi_drawing *d, int material, int part, int piece);
/* A body or line by the name of its surface, or -1. */
int tobi_drawing_find_body(const tobi_looks *s, const char *name);

/* Edges of porous zones where bodies have them at the moment. zones.c */
tobi_status view_take_zones(tobi_drawing *d, tobi_error *err);

/* Spacings: how far from the place where it is shown a liquid is kept, for its surface there. */
#define VIEW_NEST_MARGIN 6.0

/* Of a particle: 0 of the scene, or 1 + the nest. In the moment of a nest alone all are the first's. */
static inline int view_moment_nest(const tobi_moment *m, int64_t i)
{
    return m->nest ? m->nest[i] : m->nest_count > 0;
}

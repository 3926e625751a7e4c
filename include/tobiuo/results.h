/* Reading the results of a run back: particles, their fields, and the surfaces of bodies, output by output.
   Only files of tobi_run are read (fluid/NAME.vtu and surfaces/NAME.vtp, raw, zlib, LZ4 or ASCII), by their
   list all.pvd, which is whole at every moment: a run that still goes on can be read. */
#ifndef TOBIUO_RESULTS_H
#define TOBIUO_RESULTS_H
#include "tobiuo/base.h"
#include "tobiuo/nest.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tobi_results tobi_results;

/* A field of particles as it stands in the file. */
typedef struct tobi_moment_field {
    char   *name;                      /* "velocity"                                              */
    int     components;
    double *values;                    /* count x components, row-major                           */
} tobi_moment_field;

/* The surface of a body. */
typedef struct tobi_moment_surface {
    char   *name;                      /* of the body                                             */
    int64_t vertex_count, triangle_count;
    double (*vertices)[3];             /* m                                                       */
    int32_t (*triangles)[3];
} tobi_moment_surface;

/* Where the centre of mass of a body has been, from output to output. */
typedef struct tobi_moment_track {
    char    body[64];                  /* its name                                                */
    int64_t count, room;
    double (*points)[3];               /* m, room of them                                         */
} tobi_moment_track;

/* All that one output holds. Owned by the caller: tobi_moment_free. */
typedef struct tobi_moment {
    double  time;                      /* s                                                       */
    int64_t count;                     /* particles of fluids and solids                          */
    double (*positions)[3];            /* m                                                       */
    int     field_count, surface_count;
    tobi_moment_field *fields;
    tobi_moment_surface *surfaces;
    int     track_count;               /* 0 until tobi_tracks_read                                */
    tobi_moment_track *tracks;
    int64_t foam_count;                /* 0 until tobi_results_read_foam                          */
    double (*foam)[3];                 /* m                                                       */
    uint8_t *foam_kind;                /* TOBI_SPRAY, TOBI_FOAM, TOBI_BUBBLE of tobiuo/foam.h      */
    int     nest_count;                /* 0 until tobi_moment_add_nest                            */
    double  nests[TOBI_NEST_LIMIT][2][3];      /* m, corners of their boxes, infinite where a side of the
                                          domain is nearer than the rim is wide                   */
    double  nest_spacing[TOBI_NEST_LIMIT];     /* m                                               */
    uint8_t *nest;                     /* of each particle: 1 + its nest, 0: it is of the scene; NULL: all
                                          are of the first nest, if there is one                  */
} tobi_moment;

/* Opens the results in dir. TOBI_NOT_FOUND: there is no run; TOBI_DAMAGED: its list is no list. */
TOBI_API tobi_status tobi_results_open(const char *dir, tobi_results **results, tobi_error *err);
/* Looks for outputs that came since; on failure the list is as it was. */
TOBI_API tobi_status tobi_results_refresh(tobi_results *results, tobi_error *err);
/* Outputs by number from 0, and the time of each, s. */
TOBI_API int64_t tobi_results_count(const tobi_results *results);
TOBI_API double tobi_results_time(const tobi_results *results, int64_t output);
/* Reads an output; surfaces whose file is missing are left out. TOBI_INVALID: there is no such output;
   TOBI_DAMAGED: a file that this library did not write, or a part of one. On failure *moment is empty. */
TOBI_API tobi_status tobi_results_read(const tobi_results *results, int64_t output, tobi_moment *moment,
                                       tobi_error *err);
/* Fills the foam of a moment from DIR/foam, which tobi_foam_write wrote; none without that file. */
TOBI_API tobi_status tobi_results_read_foam(const tobi_results *results, int64_t output, tobi_moment *moment,
                                            tobi_error *err);
/* The particles that fill the bodies at an output, m, in the same order at each; none without such a file.
   *positions is malloc'ed and the caller's. */
TOBI_API tobi_status tobi_results_read_bodies(const tobi_results *results, int64_t output,
                                              double (**positions)[3], int64_t *count, tobi_error *err);
/* Fills the tracks of a moment from bodies.csv of the run in dir, up to its time; none without that file. */
TOBI_API tobi_status tobi_tracks_read(const char *dir, tobi_moment *moment, tobi_error *err);
/* Adds a point to the track of a body, which is made if there is none. */
TOBI_API tobi_status tobi_track_add(tobi_moment *moment, const char *body, const double point[3],
                                    tobi_error *err);
TOBI_API void tobi_moment_free(tobi_moment *moment);           /* leaves it empty */
TOBI_API void tobi_results_free(tobi_results *results);        /* NULL is fine    */

#ifdef __cplusplus
}
#endif
#endif

/* Openings: patches through which liquid comes in and goes out. Behind an inlet's plane, and beyond an
   outlet's, lies a buffer: particles there are seen by the others, but pressure and forces do not move them.
   Those of an inlet have its velocities and are let go as they cross the plane. */
#pragma once
#include <stdint.h>

enum { TOBI_OPENING_LIMIT = 64 };

/* Particles of an inlet come in columns along its normal. */
typedef struct tobi_inlet_column {
    double along, across;            /* m, from the centre of the patch                             */
    double factor;                   /* 1: its speed over the mean                                  */
    double phase;                    /* steps that it is ahead of others                            */
} tobi_inlet_column;

/* What the pressure of an outlet is: none, or that of liquid at rest up to a level, or from one at the centre
   of the patch on. */
enum { TOBI_GIVES_NOTHING, TOBI_GIVES_LEVEL, TOBI_GIVES_PRESSURE };

/* A row of a flow in time; linear between rows, constant before and after. */
typedef struct tobi_flow_row {
    double time, speed;              /* s; m/s, mean over the patch                                 */
    double way;                      /* m, that the mean flow has gone since time 0                 */
} tobi_flow_row;

/* Places are those of the box: from the domain's lower corner. */
typedef struct tobi_opening {
    char name[64];
    int outlet;                      /* 1: an outlet, 0: an inlet                                   */
    int fluid;                       /* number of what comes in                                     */
    double centre[3];                /* m                                                           */
    double normal[3], along[3], across[3];     /* unit vectors; the flow goes along normal          */
    double half[2], radius;          /* m: half sides, or the radius of a disc, else 0              */
    double depth;                    /* m, of the buffer                                            */
    /* inlets */
    int parabolic;
    double speed;                    /* m/s, mean over the patch                                    */
    double scale;                    /* 1: makes the mean over all columns exact                    */
    double start, stop, ramp;        /* s; stop 0 = never                                           */
    tobi_flow_row *rows;             /* owned: speed is the largest; NULL = a constant flow         */
    int64_t row_count;
    double step;                     /* m, between particles of a column                            */
    tobi_inlet_column *columns;            /* owned                                                       */
    int64_t column_count;
    double way;                      /* m that the mean flow has gone; survives a restart           */
    /* outlets */
    double level, pressure;          /* m, along gravity, upwards; Pa, at the centre                */
    int gives;                       /* TOBI_GIVES_*                                                */
} tobi_opening;

/* Coordinates of a place: along normal, along, across, from the middle of the patch, m. */
void tobi_opening_locate(const tobi_opening *o, const double x[3], double at[3]);
/* Whether a place with these coordinates lies before or behind the patch, at any distance. */
int tobi_opening_faces(const tobi_opening *o, const double at[3]);
/* m2; in 2-D m. */
double tobi_opening_area(const tobi_opening *o, int dimension);
/* Number of the opening in whose buffer a place lies, -1 = none. Buffers of outlets have no end. */
int tobi_opening_find(const tobi_opening *o, int count, const double x[3]);
/* The integral of the rows of an inlet that has some: the way at any time, also before 0, m. */
double tobi_opening_way_at(const tobi_opening *o, double t);
/* How far the mean flow of an inlet has gone from time 0 to t, m. */
double tobi_opening_way(const tobi_opening *o, double t);
/* Mean speed of an inlet from t to t + dt, m/s. */
double tobi_opening_speed(const tobi_opening *o, double t, double dt);
/* Speed at coordinates over the mean. */
double tobi_opening_factor(const tobi_opening *o, double along, double across);

/* Spray, foam and bubbles of breaking water, after a run and for pictures only: the water does not feel them.
   Arrays of the liquid at one output after the other in, diffuse particles out.

   Ihmsen, Akinci, Akinci & Teschner, Unified spray, foam and air bubbles for particle-based fluids, The
   Visual Computer 28, 2012. docs/decisions/0130-spray-foam-bubbles.md has the scales. The same input gives
   the same bits for any number of threads. */
#ifndef TOBIUO_FOAM_H
#define TOBIUO_FOAM_H
#include "tobiuo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { TOBI_SPRAY, TOBI_FOAM, TOBI_BUBBLE };

/* Obtain from tobi_default_foam and change members. */
typedef struct tobi_foam_def {
    int dimension;                     /* 2 (z is 0) or 3                                               */
    double spacing;                    /* m between particles of the liquid                             */
    double gravity[3];                 /* m/s2; of none, scales are those of 9.81                       */
    double box_min[3], box_max[3];     /* m, the domain                                                 */
    double amount;                     /* times as many particles as usual, above 0 to 1000             */
    double lifetime;                   /* s, the mean of foam; 0 = 60 sqrt(spacing/g)                   */
    int64_t most;                      /* diffuse particles at a time, 1 to 2^30                        */
    int threads;                       /* 0 = all cores                                                 */
} tobi_foam_def;

/* The liquid at an output, borrowed for a call. */
typedef struct tobi_foam_water {
    double time;                       /* s                                                             */
    int64_t count;
    const double (*positions)[3];      /* m                                                             */
    const double (*velocities)[3];     /* m/s                                                           */
    const int64_t *ids;                /* rising; NULL = rows are the same particles at every output    */
    int64_t solid_count;
    const double (*solids)[3];         /* m, points that fill bodies, about a spacing apart: there is no
                                          air; the same rows at every output                            */
} tobi_foam_water;

/* What there is; valid until the next call. */
typedef struct tobi_foam_particles {
    int64_t count;
    const double (*positions)[3];      /* m                                                             */
    const float (*velocities)[3];      /* m/s                                                           */
    const uint8_t *kind;               /* TOBI_SPRAY, TOBI_FOAM, TOBI_BUBBLE                            */
    const float *age, *life;           /* s since it was made; s that are left of it as foam            */
    const int64_t *ids;
    double left_out;                   /* how many were not made since the start, for lack of room      */
} tobi_foam_particles;

typedef struct tobi_foam tobi_foam;
TOBI_API tobi_foam_def tobi_default_foam(void);
/* TOBI_INVALID for numbers out of range, TOBI_NO_MEMORY. On failure *foam is NULL. */
TOBI_API tobi_status tobi_foam_create(const tobi_foam_def *def, tobi_foam **foam, tobi_error *err);
/* The next output: diffuse particles move from the one before to it, and new ones are made. At the first
   there are none. TOBI_INVALID: time does not rise, ids do not, arrays are missing. After a failure the foam
   can only be freed. */
TOBI_API tobi_status tobi_foam_advance(tobi_foam *foam, const tobi_foam_water *water, tobi_error *err);
/* Adds one, to be followed. TOBI_INVALID beyond `most`. */
TOBI_API tobi_status tobi_foam_add(tobi_foam *foam, const double position[3], const double velocity[3],
                                   double life, tobi_error *err);
TOBI_API tobi_status tobi_foam_read(tobi_foam *foam, tobi_foam_particles *particles, tobi_error *err);
TOBI_API void tobi_foam_free(tobi_foam *foam);       /* NULL is fine */

/* As VTP: points with velocity, kind, age, life, id. The file appears whole or not at all. */
TOBI_API tobi_status tobi_foam_write(const char *path, const tobi_foam_particles *particles, tobi_error *err);

#ifdef __cplusplus
}
#endif
#endif

/* Fields of particles at places that a caller chooses, and their means over time. Arrays in, arrays out;
   tobi_results_read and tobi_world_read give the arrays of a run and of a world.

   Moving least squares of first order over the particles within two spacings, exact for fields that are
   linear; where these lie to one side or are few, their weighted mean. The particles also tell whether there
   is liquid at a place: a place in a body or in air is dry and has no values. docs/decisions/
   0147-fields-at-places.md has the rules. The same input gives the same bits for any number of threads. */
#ifndef TOBIUO_SAMPLE_H
#define TOBIUO_SAMPLE_H
#include "tobiuo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { TOBI_SAMPLE_FIELD_LIMIT = 32 };

typedef struct tobi_sample_field {
    int components;                    /* 1 to 9                                                         */
    const double *values;              /* particle_count x components                                    */
    double *at;                        /* place_count x components, written; NaN where it is dry         */
} tobi_sample_field;

/* Everything borrowed for the call. Obtain from tobi_default_sample and change members. */
typedef struct tobi_sample_def {
    int dimension;                     /* 2 (z is not looked at) or 3                                    */
    double spacing;                    /* m between particles                                            */
    double box_min[3], box_max[3];     /* m, the domain; places beyond it are dry                        */
    int periodic[3];                   /* not 0: what leaves along this axis comes in again              */
    int64_t particle_count;            /* below 2^31                                                     */
    const double (*positions)[3];      /* m; not finite = left out                                       */
    int64_t solid_count;               /* below 2^31                                                     */
    const double (*solids)[3];         /* m, points that fill bodies, about a spacing apart              */
    int64_t place_count;
    const double (*places)[3];         /* m; not finite = dry                                            */
    const tobi_sample_field *fields;
    int field_count;                   /* at most TOBI_SAMPLE_FIELD_LIMIT                                */
    uint8_t *wet;                      /* of each place, written: 1 = there is liquid; NULL = not asked  */
    int threads;                       /* 0 = all cores                                                  */
} tobi_sample_def;

TOBI_API tobi_sample_def tobi_default_sample(void);
/* Fills `at` of the fields and `wet`. TOBI_INVALID for numbers out of range and for NULL where something must
   stand, TOBI_NO_MEMORY. */
TOBI_API tobi_status tobi_sample_make(const tobi_sample_def *def, tobi_error *err);

/* Means over outputs of one field at places; each output at which a place is wet counts the same. */
typedef struct tobi_sample_mean tobi_sample_mean;
/* components: 1 to 9. TOBI_INVALID, TOBI_NO_MEMORY; on failure *mean is NULL. */
TOBI_API tobi_status tobi_sample_mean_create(int64_t place_count, int components, int threads,
                                             tobi_sample_mean **mean, tobi_error *err);
/* An output: wet and values (place_count x components) as tobi_sample_make fills them. */
TOBI_API tobi_status tobi_sample_mean_add(tobi_sample_mean *mean, const uint8_t *wet, const double *values,
                                          tobi_error *err);
/* What there is so far; each array may be NULL. share: of the outputs at which a place was wet. mean and rms
   (root mean square of the fluctuations): place_count x components, NaN where it was never wet. products:
   means of the products of two fluctuations, place_count x components (components + 1)/2, in the order xx,
   xy, xz, yy, yz, zz: of the velocity these are the Reynolds stresses over the density. */
TOBI_API tobi_status tobi_sample_mean_read(const tobi_sample_mean *mean, double *share, double *average,
                                           double *rms, double *products, tobi_error *err);
TOBI_API void tobi_sample_mean_free(tobi_sample_mean *mean);       /* NULL is fine */

/* Values on a regular grid of points, x running fastest. */
typedef struct tobi_sample_array {
    const char *name;
    int components;
    const double *values;              /* points x components                                            */
} tobi_sample_array;

typedef struct tobi_sample_grid {
    double origin[3], cell[3];         /* m: the first point, the distances between points (above 0)     */
    int64_t count[3];                  /* of points along each axis, 1 or more                           */
    const tobi_sample_array *arrays;
    int array_count;
    const uint8_t *wet;                /* of each point; NULL = left out                                 */
} tobi_sample_grid;

/* Writes a grid as VTK's image data (.vti, zlib). The file appears whole or not at all. TOBI_INVALID,
   TOBI_IO, TOBI_NO_MEMORY. */
TOBI_API tobi_status tobi_sample_write(const char *path, const tobi_sample_grid *grid, tobi_error *err);

#ifdef __cplusplus
}
#endif
#endif

/* What the files of diffuse particles share. Water at an output is kept with its potentials; between two
   outputs it lies in cells. Lengths are m, times s. */
#pragma once
#include "base/error.h"
#include "exec/exec.h"
#include "tobiuo/foam.h"
#include <math.h>
#include <stdbool.h>

/* Fullness: sum of the weights around over that of a full lattice. */
#define FOAM_SPRAY 0.2f          /* below is spray */
#define FOAM_BUBBLE 0.75f        /* above are bubbles */
#define FOAM_SURFACE 0.78f       /* below, a particle of water is at the surface */

/* The water at an output. */
typedef struct foam_water {
    double time;
    int64_t count, room;
    double (*x)[3], (*v)[3];
    int64_t *id;                 /* the number of the row if they have none */
    float *rate;                 /* 1/s, new particles                              */
    float *spread;               /* m/s, velocity differences around                */
    int32_t *partner;            /* row at the next output, -1 = none               */
    int64_t solids, solid_room;  /* points of bodies: rows behind those of water    */
    double (*solid)[3];
} foam_water;

/* Water and its images in the sides, in cells. `of`: row; -1 - row of an image. */
typedef struct foam_cells {
    double low[3], edge, reach;
    int64_t n[3], cells, cell_room;
    int32_t *begin;              /* cells + 1 */
    int64_t count, room;
    tobi_float4 *place;          /* from low; w: 1, 2, 4 for an image across x, y, z; 8: of a body */
    tobi_float4 *move;           /* velocity */
    int32_t *of;
    tobi_float4 *place_raw, *move_raw;
    int32_t *of_raw, *order, *order2;
    uint32_t *key, *key2;
    int64_t *first;              /* of each row, where its entries begin */
    int64_t first_room;
    int64_t *histogram;
} foam_cells;

#define FOAM_SOLID 8.0f

/* A diffuse particle. */
typedef struct foam_drop {
    double x[3], v[3];
    float age, life;
    int32_t kind;                /* -1 = gone */
    int64_t id;
} foam_drop;

struct tobi_foam {
    tobi_foam_def def;
    tobi_exec exec;
    double scale;                /* m/s, sqrt(g d)  */
    double pull;                 /* m/s2, g, or 9.81 */
    double up[3];                /* unit vector against gravity, or 0 */
    double rise, relax;          /* m/s, s, of bubbles */
    double lifetime;             /* s */
    float full;                  /* sum of weights of a lattice */
    bool begun;
    foam_water before, after;
    foam_cells cells;
    float (*normal)[4];          /* of rows: unit vector out of the water, fullness */
    int64_t normal_room;
    int64_t *number;             /* of each row: new particles, then where they begin */
    int64_t number_room;
    foam_drop *drop, *spare;
    int64_t count, drop_room, spare_room;
    int64_t next_id, substep;
    double left_out;
    void *out[6];                /* arrays of tobi_foam_read */
};

/* splitmix64 of Steele, Lea & Flood 2014 (OOPSLA), as a hash: a number from 0 to 1 of three. */
static inline double foam_chance(int64_t id, int64_t substep, int channel)
{
    uint64_t x = (uint64_t)id*0x9e3779b97f4a7c15u + (uint64_t)substep;
    for (int k = 0; k < 2; k++) {
        x += 0x9e3779b97f4a7c15u*(uint64_t)(k ? channel + 1 : 1);
        x = (x ^ x >> 30)*0xbf58476d1ce4e5b9u;
        x = (x ^ x >> 27)*0x94d049bb133111ebu;
        x ^= x >> 31;
    }
    return (double)(x >> 11)*0x1p-53;
}

static inline float foam_ramp(double x, double low, double high)
{
    return x <= low ? 0 : x >= high ? 1 : (float)((x - low)/(high - low));
}

tobi_status foam_no_memory(tobi_error *err);
/* Room for so many entries of an array of this size, what is in it lost; false: no memory. */
bool foam_room(void *array, int64_t *room, int64_t count, size_t size);

/* cells.c: the water between two outputs, at share s of the time, or with `after` NULL as it is. */
bool foam_find_row(const foam_water *before, const foam_water *after, double s, int64_t i, double x[3],
                   double u[3]);
tobi_status foam_fill_cells(tobi_foam *f, const foam_water *before, const foam_water *after, double s,
                            tobi_error *err);
void foam_free_cells(foam_cells *c);
/* Runs of entries that may be within reach of p (from low): calls for each row of cells. */
typedef struct foam_runs { int64_t from[3], to[3], y, z; } foam_runs;
foam_runs foam_first_run(const foam_cells *c, const float p[3]);
bool foam_next_run(const foam_cells *c, foam_runs *r, int64_t *begin, int64_t *end);

/* potential.c: rate and spread of the water. */
tobi_status foam_find_potentials(tobi_foam *f, foam_water *w, tobi_error *err);
/* make.c: new ones of a substep of dt around share s of the way to the next output. */
tobi_status foam_make(tobi_foam *f, double s, double dt, tobi_error *err);
/* move.c: all through a substep; those that are gone leave. */
tobi_status foam_move(tobi_foam *f, double dt, tobi_error *err);

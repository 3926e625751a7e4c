/* The fluid's particle arrays. One list says every field: allocation, sorting, checkpoint, hashing
   and output read it. Arrays are laid out [own | ghost] (no ghosts on one rank) and padded so that
   eight rows may be read past the end. */
#pragma once
#include "base/error.h"
#include "exec/portable.h"

/* STATE fields survive a step: they are sorted with the particles and stored in checkpoints. SCRATCH
   fields are recomputed every step. */
enum { TOBI_STATE, TOBI_SCRATCH };
/* Who needs a field: every method, the SPH methods, those with surface tension, the material point
   method, scenes with blades, liquids with bodies in them. The fields of the others are NULL. */
enum { TOBI_ALL = 1, TOBI_SPH = 2, TOBI_TENSION = 4, TOBI_MPM = 8, TOBI_BLADES = 16, TOBI_WETTED = 32 };

/*   type          name                 life, owner                unit     meaning */
#define TOBI_PARTICLE_FIELDS(X) \
    X(tobi_double3, position,     TOBI_STATE,   TOBI_ALL,     "m",    "position from the lower corner") \
    X(tobi_float4,  velocity,     TOBI_STATE,   TOBI_ALL,     "m/s",  "velocity; w: eq. (6b), 0 to 1") \
    X(float,        pressure,     TOBI_STATE,   TOBI_SPH,     "Pa",   "pressure") \
    X(int64_t,      id,           TOBI_STATE,   TOBI_ALL,     "1",    "stable particle id") \
    X(uint8_t,      fluid,        TOBI_STATE,   TOBI_ALL,     "1",    "number of the fluid or solid") \
    X(tobi_columns, strain,       TOBI_STATE,   TOBI_MPM,     "1",    "F - I; w: see mpm/view.h") \
    X(tobi_columns, affine,       TOBI_STATE,   TOBI_MPM,     "1/s",  "velocity gradient") \
    X(tobi_float4,  rest,         TOBI_STATE,   TOBI_MPM,     "m",    "at the start; w: 1 in the core") \
    X(tobi_columns, cuts,         TOBI_STATE,   TOBI_BLADES,  "1",    "remembered cuts, core/cuts.h") \
    X(tobi_record,  record,       TOBI_SCRATCH, TOBI_SPH,     "1",    "fixed-point position, payload") \
    X(tobi_float4,  accel,        TOBI_SCRATCH, TOBI_SPH,     "m/s2", "acceleration of the pass") \
    X(tobi_float4,  wall,         TOBI_SCRATCH, TOBI_SPH,     "1/m",  "wall gradient G; w = G . v_wall") \
    X(tobi_float4,  stretch,      TOBI_SCRATCH, TOBI_WETTED,  "1",    "T, eq. (7b), (7c): xx, yy, zz, xy") \
    X(tobi_float4,  shear,        TOBI_SCRATCH, TOBI_WETTED,  "1",    "T: yz, zx") \
    X(uint8_t,      beside,       TOBI_SCRATCH, TOBI_WETTED,  "1",    "1: it or a neighbour sees a body") \
    X(float,        density,      TOBI_SCRATCH, TOBI_SPH,     "1",    "density over rest density") \
    X(float,        diagonal,     TOBI_SCRATCH, TOBI_SPH,     "m/kg", "diagonal of the pressure operator") \
    X(float,        precondition, TOBI_SCRATCH, TOBI_SPH,     "kg/m", "1/diagonal, 0 where p is held") \
    X(float,        residual,     TOBI_SCRATCH, TOBI_SPH,     "1/s2", "residual of the pressure equation") \
    X(float,        product,      TOBI_SCRATCH, TOBI_SPH,     "1/s2", "A q in a solve; else mean pressure") \
    X(float,        delta,        TOBI_SCRATCH, TOBI_SPH,     "Pa",   "pressure change of this solve") \
    X(float,        correction,   TOBI_SCRATCH, TOBI_SPH,     "Pa",   "of the position correction") \
    X(tobi_float4,  normal,       TOBI_SCRATCH, TOBI_TENSION, "1",    "normal of the surface; w = weight") \
    X(float,        capillary,    TOBI_SCRATCH, TOBI_TENSION, "Pa",   "surface tension times curvature") \
    X(uint8_t,      surface,      TOBI_SCRATCH, TOBI_SPH,     "1",    "1 at a free surface") \
    X(int32_t,      near,         TOBI_SCRATCH, TOBI_SPH,     "1",    "last near-body entry, -1 = none") \
    X(uint32_t,     list_start,   TOBI_SCRATCH, TOBI_SPH,     "8",    "first neighbour, in groups of 8") \
    X(uint16_t,     list_groups,  TOBI_SCRATCH, TOBI_SPH,     "8",    "neighbour groups of 8")

typedef struct tobi_particles {
    int64_t count, capacity;
#define X(type, name, life, owner, unit, doc) type *name;
    TOBI_PARTICLE_FIELDS(X)
#undef X
} tobi_particles;

/* Allocates the fields of `owners` (a sum) for `capacity` particles; count becomes 0. */
tobi_status tobi_particles_create(tobi_particles *p, int64_t capacity, int owners, tobi_error *err);
void tobi_particles_free(tobi_particles *p);
/* Room for at most `capacity` particles that tobi_particles_add places: state fields only, and memory only
   for those that are placed. tobi_particles_fit then makes all fields, for as many as there are: capacity
   becomes count. On failure nothing is left to free. */
tobi_status tobi_particles_reserve(tobi_particles *p, int64_t capacity, int owners, tobi_error *err);
/* A new particle, all zero: its number. There must be room. */
int64_t tobi_particles_add(tobi_particles *p);
tobi_status tobi_particles_fit(tobi_particles *p, int owners, tobi_error *err);
/* Bytes per particle of the fields of `owners`, without neighbour lists. */
int64_t tobi_particles_row_bytes(int owners);

/* Reorders every STATE field: row k takes the old row order[k]. scratch holds count rows of the widest
   state field (tobi_particles_widest bytes each, of the fields of `owners`). */
void tobi_particles_permute(tobi_particles *p, const int32_t *order, void *scratch, int threads);
int64_t tobi_particles_widest(int owners);

/* Copies the STATE fields of row `from` over row `to`. */
void tobi_particles_copy(tobi_particles *p, int64_t from, int64_t to);

/* Walks the state fields, for checkpoints: name and pointer by index, NULL past the end. */
typedef struct tobi_field_ref { const char *name; void *data; size_t bytes; } tobi_field_ref;
tobi_field_ref tobi_particles_state(tobi_particles *p, int index);

/* The particle fields of the SPH methods. Those of neighbour lists are in core/cells.h. */
#pragma once
#include "core/particles.h"

/* Scenes with surface tension; liquids with bodies in them; inlets and outlets; several liquids;
   implicit viscosity; the filter (13b) with a free surface; liquids whose viscosity depends on the flow;
   porous zones; temperature or concentration; isph with porous zones that bodies carry. */
enum { SPH_NEED_TENSION = 1, SPH_NEED_WETTED = 2, SPH_NEED_OPENINGS = 4, SPH_NEED_PHASES = 8,
       SPH_NEED_IMPLICIT = 16, SPH_NEED_FILTER = 32, SPH_NEED_APPARENT = 64,
       SPH_NEED_POROUS = 128, SPH_NEED_SCALARS = 256, SPH_NEED_CARRIED = 512 };

/* Stages of a step: boundaries; density; forces; the pressure by an equation, or by that of state; the
   correction of positions; forces on walls and bodies, new positions. Between steps: a derived output. */
enum { SPH_SEE = 1, SPH_FORCES = 2, SPH_SOLVE = 4, SPH_TAIT = 8, SPH_CORRECT = 16, SPH_MOVE = 32,
       SPH_DERIVE = 64, SPH_BOUNDARIES = 128, SPH_VISCOUS = SPH_FORCES | SPH_DERIVE,
       SPH_AFTER_SEEING = SPH_FORCES | SPH_SOLVE | SPH_TAIT | SPH_CORRECT | SPH_MOVE | SPH_DERIVE };

#define SPH_FIELDS(X) \
    X(float,       TOBI_F32, 1, pressure,     TOBI_STATE,   0, "Pa",   "pressure") \
    X(tobi_float4, TOBI_F32, 4, accel,        TOBI_SCRATCH, 0, "m/s2", "acceleration of the pass") \
    X(tobi_float4, TOBI_F32, 4, wall,         TOBI_SCRATCH, 0, "1/m",  "wall gradient G; w = G . v_wall") \
    X(tobi_float4, TOBI_F32, 4, stretch,      TOBI_SCRATCH, SPH_NEED_WETTED, "1", \
      "T, eq. (7b), (7c): xx, yy, zz, xy") \
    X(tobi_float4, TOBI_F32, 4, shear,        TOBI_SCRATCH, SPH_NEED_WETTED, "1", "T: yz, zx") \
    X(uint8_t,     TOBI_U8,  1, near_body,    TOBI_SCRATCH, SPH_NEED_WETTED, "1", \
      "1: it or a neighbour sees a body") \
    X(float,       TOBI_F32, 1, density,      TOBI_SCRATCH, 0, "1",    "density over rest density") \
    X(float,       TOBI_F32, 1, diagonal,     TOBI_SCRATCH, 0, "m/kg", "diagonal of the pressure operator") \
    X(float,       TOBI_F32, 1, body_distance, SPH_BOUNDARIES, SPH_NEED_WETTED, "m", \
      "from the nearest body seen") \
    X(float,       TOBI_F32, 1, mean,         SPH_SEE | SPH_DERIVE, 0, "Pa", "kernel average of p") \
    X(float,       TOBI_F32, 1, surface_depth,     SPH_SEE, 0, "m", "of the free surface here, 0 = none") \
    X(tobi_float4, TOBI_F32, 4, moment,       SPH_SEE | SPH_FORCES, \
      SPH_NEED_WETTED | SPH_NEED_FILTER, "1/m", "eq. (13b)") \
    X(tobi_float4, TOBI_F32, 4, roughness,    SPH_FORCES, SPH_NEED_WETTED | SPH_NEED_FILTER, "1/m3/s", \
      "R, eq. (13b)") \
    X(float,       TOBI_F32, 1, target_divergence, SPH_FORCES | SPH_SOLVE, SPH_NEED_WETTED, "1/s", \
      "eq. (10d)") \
    X(float,       TOBI_F32, 1, wetness,      SPH_AFTER_SEEING, 0, "1", "eq. (6b)") \
    X(float,       TOBI_F32, 1, precondition, SPH_SOLVE | SPH_CORRECT, 0, "kg/m", \
      "1/diagonal, 0: p is held") \
    X(float,       TOBI_F32, 1, residual,     SPH_SOLVE | SPH_CORRECT, 0, "1/s2", \
      "of the pressure equation") \
    X(float,       TOBI_F32, 1, product,      SPH_SOLVE | SPH_CORRECT, 0, "1/s2", "A q") \
    X(float,       TOBI_F32, 1, delta,        SPH_SOLVE | SPH_CORRECT, 0, "Pa",   "change of the pressure") \
    X(float,       TOBI_F32, 1, correction,   SPH_CORRECT, 0, "Pa", "pressure that corrects positions") \
    X(float,       TOBI_F32, 1, damped,       SPH_TAIT | SPH_MOVE, 0, "Pa", "pressure and damping of sound") \
    X(tobi_float4, TOBI_F32, 4, saved_velocity, SPH_DERIVE, 0, "m/s", "velocity meanwhile, then its change") \
    X(tobi_float4, TOBI_F32, 4, normal,       TOBI_SCRATCH, SPH_NEED_TENSION, "1", \
      "normal of the surface; w = weight") \
    X(float,       TOBI_F32, 1, capillary,    TOBI_SCRATCH, SPH_NEED_TENSION, "Pa", \
      "surface tension times curvature") \
    X(tobi_float4, TOBI_F32, 4, phase,        TOBI_SCRATCH, SPH_NEED_PHASES, "1", \
      "kg/m3, Pa s, m, 1: density, viscosity, distance from the interface, fluid") \
    X(tobi_float4, TOBI_F32, 4, interface,    TOBI_SCRATCH, SPH_NEED_PHASES, "1", \
      "normal of the interface, out of the fluid; w = curvature, 1/m") \
    X(tobi_float4, TOBI_F32, 4, viscous_velocity, SPH_VISCOUS, SPH_NEED_IMPLICIT, "m/s", \
      "that viscosity leaves, while it is solved for") \
    X(tobi_float4, TOBI_F32, 4, viscous_expected, SPH_VISCOUS | SPH_TAIT, SPH_NEED_IMPLICIT, "m/s", \
      "what gravity and pressure are expected to add") \
    X(tobi_float4, TOBI_F32, 4, viscous_residual, SPH_VISCOUS, SPH_NEED_IMPLICIT, "kg/m2/s", \
      "of its equation") \
    X(tobi_float4, TOBI_F32, 4, viscous_direction, SPH_VISCOUS, SPH_NEED_IMPLICIT, "m/s", \
      "of the search") \
    X(tobi_float4, TOBI_F32, 4, viscous_product, SPH_VISCOUS, SPH_NEED_IMPLICIT, "kg/m2/s", \
      "A q") \
    X(tobi_float4, TOBI_F32, 4, viscous_inverse, SPH_VISCOUS, SPH_NEED_IMPLICIT, "m3/kg", \
      "of the diagonal") \
    X(tobi_float4, TOBI_F32, 4, viscous_turning, SPH_VISCOUS, SPH_NEED_IMPLICIT, "1", \
      "inverse of J of viscosity.md, eq. (2): xx, yy, zz, xy") \
    X(tobi_float4, TOBI_F32, 4, viscous_lack, SPH_VISCOUS, SPH_NEED_IMPLICIT, "1", \
      "the same: yz, zx; z: r of eq. (3b); w: s of eq. (2c)") \
    X(tobi_float4, TOBI_F32, 4, viscous_fit, SPH_VISCOUS, SPH_NEED_IMPLICIT, "1", \
      "m^(1/2) A of viscosity.md, eq. (2b), scaled: xx, yy, zz, xy") \
    X(tobi_float4, TOBI_F32, 4, viscous_fit_shear, SPH_VISCOUS, SPH_NEED_IMPLICIT, "1", \
      "the same: yz, zx") \
    X(tobi_float4, TOBI_F32, 4, viscous_spread, SPH_VISCOUS, SPH_NEED_IMPLICIT, "1/s", \
      "s beta E of viscosity.md, eq. (2b): xx, yy, zz; w: y of the operand, m/s") \
    X(tobi_float4, TOBI_F32, 4, viscous_slant, SPH_VISCOUS, SPH_NEED_IMPLICIT, "1/s", \
      "the same: xy, yz, zx; w: z of the operand, m/s") \
    X(tobi_float4, TOBI_F32, 4, apparent,     TOBI_SCRATCH, SPH_NEED_APPARENT, "Pa s", \
      "x: viscosity at the shear rate y, 1/s, eq. (6) of viscosity.md") \
    X(uint8_t,     TOBI_U8,  1, surface,      TOBI_SCRATCH, 0, "1",    "at a free surface 1; sparse: 2") \
    X(tobi_float4, TOBI_F32, 4, held,         TOBI_SCRATCH, SPH_NEED_OPENINGS, "m/s", \
      "velocity in a buffer; w: 1 + number of an inlet, < 0 of an outlet, 0: none") \
    X(tobi_float4, TOBI_F32, 4, porous,       TOBI_SCRATCH, SPH_NEED_POROUS, "1", \
      "drag of its zone in the step, sph/porous.k.h") \
    X(tobi_float4, TOBI_F32, 4, porous_before, TOBI_SCRATCH, SPH_NEED_POROUS, "m/s", \
      "velocity before the step; w: 1 + number of its zone, 0: none, -1: held") \
    X(tobi_float4, TOBI_F32, 4, porous_taken, TOBI_SCRATCH, SPH_NEED_POROUS, "m/s", \
      "what zones have taken of the velocity in the step; of isph, and of zones that bodies carry") \
    X(tobi_float4, TOBI_F32, 4, porous_kept,  TOBI_SCRATCH, SPH_NEED_POROUS, "m/s", \
      "velocity before the pressure; likewise") \
    X(tobi_float4, TOBI_F32, 4, zone_push,    TOBI_SCRATCH, SPH_NEED_CARRIED, "m2", \
      "z, eq. (9) of porous.md: force of its pressure on the carrier; w: the number of that from 1") \
    X(tobi_float4, TOBI_F32, 4, zone_turn,    TOBI_SCRATCH, SPH_NEED_CARRIED, "m3", "z: the torque") \
    X(tobi_float4, TOBI_F32, 4, zone_fall,    TOBI_SCRATCH, SPH_NEED_CARRIED, "N", \
      "what zones take of gravity") \
    X(tobi_double2, TOBI_F64, 2, scalars,     TOBI_STATE,   SPH_NEED_SCALARS, "1", \
      "temperature, concentration") \
    X(tobi_float4, TOBI_F32, 4, scalar_now,   TOBI_SCRATCH, SPH_NEED_SCALARS, "1", \
      "the same, from their values at the start; z: eddy viscosity, m2/s; w: density, kg/m3") \
    X(tobi_float4, TOBI_F32, 4, scalar_change, TOBI_SCRATCH, SPH_NEED_SCALARS, "1", \
      "of both in the step by diffusion, and by the shift of positions") \
    X(int32_t,     TOBI_I32, 1, last_link,    TOBI_SCRATCH, 0, "1",    "last near-body entry, -1 = none")

typedef struct sph_fields { SPH_FIELDS(TOBI_FIELD_POINTER) } sph_fields;
extern const tobi_field_list sph_field_list;

static inline sph_fields *sph_fields_of(const tobi_particles *p) { return p->own; }

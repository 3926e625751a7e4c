/* Soft solids as a liquid meets them: their particles are points with a volume (core/soft.h, decision 64 in
   docs/decisions). In the order of a step: find, add gradients; the forces of the particles; begin; product
   after each product of the pressure's operator; load. All do nothing in a world without both. */
#pragma once
#include "base/error.h"
#include "sph/reference_pressure.h"
#include "sph/soft.k.h"

struct tobi_system;
struct tobi_body;

/* Where solids are: boxes of one width around their particles. */
typedef struct sph_soft_marks {
    double low[3], inverse;          /* m, 1/m: lower corner, 1/width                               */
    int n[3];
    uint8_t *taken;                  /* [n] 1: a point of a solid is there                          */
    int64_t room;
} sph_soft_marks;

typedef struct sph_soft {
    sph_soft_link *link;             /* by point, then by particle                                  */
    int64_t count;
    int32_t *wet;                    /* [points] rows of the solids that a particle sees            */
    int64_t points;
    int64_t *first;                  /* [points + 1] first link of each                             */
    double (*answer)[3];             /* [points] m/s, or m/s2 per pressure                          */
    double (*known)[3];              /* [points] N: all that does not wait for the pressure         */
    double (*change)[3];             /* [points] m/s, in this step; of isph                         */
    tobi_float4 *velocity;           /* [points] m/s, before this step; of isph                     */
    double *layer;                   /* [points] kg: of the liquid between particles and point, whose
                                        inertia the pressure at the point has less; of isph         */
    int32_t *last;                   /* [particles] last link of each, -1 = none                    */
    int64_t *found;                  /* [rows of the solids] scratch of the search                  */
    float *dry;                      /* [rows of the solids] m: depth of what air is beside, or 0   */
    sph_soft_marks marks;
    tobi_reference still;            /* that of the liquid; by isph of what presses solids alone    */
    int solved;                      /* 1: they answer within a solve                               */
    int64_t link_room, wet_room, first_room, answer_room, known_room, change_room, velocity_room;
    int64_t layer_room, last_room, found_room, dry_room;
} sph_soft;

/* Finds which particles see which points, at their present places. */
tobi_status sph_soft_find(struct tobi_system *s, tobi_error *err);
/* Adds gradients and shares to particles.wall and particles.density. After those of sides and bodies. */
void sph_soft_add_gradients(struct tobi_system *s);
/* Adds dt times hydrostatic pressure of mirrors and friction to the velocities; keeps the reactions. */
void sph_soft_add_forces(struct tobi_system *s);
/* Of isph: takes out of the pushes of each particle what it lacks towards the solids, so that they get what
   it does not feel (decision 96). lack: [particles] 1/m, its sum of V grad W over all neighbours and walls;
   gate: [particles] 1 at a free surface, where that is no error. */
void sph_soft_balance(struct tobi_system *s, const tobi_float4 *lack, const float *gate);
/* Velocities of the points by all forces but the change of pressure, and their flux into particles.wall.
   solved: whether the pressure is solved for, with their answer; else they keep their velocities. */
void sph_soft_begin(struct tobi_system *s, int solved);
/* Adds to particles.product how the points answer the pressures in the records. totals as of
   tobi_couple_product. */
void sph_soft_product(struct tobi_system *s, double *totals);
/* The same for pressures in double: out += density times the answer to `in`. */
void sph_soft_add_answer(struct tobi_system *s, double *out, const double *in);
/* Of isph: the change of the points' velocities before the solve, and with the pressures `in`. */
void sph_soft_predict(struct tobi_system *s, int solved);
void sph_soft_correct(struct tobi_system *s, const double *in);
/* The forces of this step on the points. After the solve. */
void sph_soft_load(struct tobi_system *s);
/* N, on a point: that of pressures that no solve knows, sph/hydrostatic.h; and on all of them. */
void sph_soft_still_force(const struct tobi_system *s, int64_t point, double force[3]);
void sph_soft_still_sum(struct tobi_system *s, double force[3]);
/* Marks where they are, for the next four; sph_soft_find does it. */
tobi_status sph_soft_mark(struct tobi_system *s, tobi_error *err);
/* Whether a place is within a solid, or nearer than half of its spacing. */
int sph_soft_fills(const struct tobi_system *s, const double x[3]);
/* Whether a solid is on the line between two places. */
int sph_soft_meets(const struct tobi_system *s, const double from[3], const double to[3]);
/* Whether a solid touches a point of a body. */
int sph_soft_touches(const struct tobi_system *s, const struct tobi_body *b, int64_t point);
/* Points of bodies that a solid touches count as wet. After sph_soft_find. */
void sph_soft_wet_bodies(struct tobi_system *s);
/* Depths below a depth, m, where a solid has air beside it, into `dry`. Returns the largest. */
double sph_soft_find_dry(struct tobi_system *s, double below);
/* As tobi_couple_compliance, of the lightest point: m2/kg. */
double sph_soft_compliance(const struct tobi_system *s);
/* The longest step for the friction at points where liquid sticks, s; INFINITY without. */
double sph_soft_dt(const struct tobi_system *s);
/* m/s: of the fastest wave along a thin solid that moves; 0 without solids. */
double sph_soft_wave_speed(const struct tobi_system *s);
int64_t sph_soft_bytes(const sph_soft *q);
void sph_soft_free(sph_soft *q);

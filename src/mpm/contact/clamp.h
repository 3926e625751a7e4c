/* Particles of solids that bodies hold: docs/theory/contact.md, "Clamps", decisions 83 and 97. */
#pragma once
#include "core/system.h"
#include "mpm/feel.h"

/* One held particle in the step at hand. */
typedef struct mpm_held {
    int32_t particle;
    float   mass;                      /* kg                                                       */
    double  arm[3];                    /* m, from the centre of its body                           */
    double  aim[3];                    /* m/s, wanted: without the velocity of a body that moves by forces */
    double  velocity[3];               /* m/s, on the grid                                         */
} mpm_held;

typedef struct mpm_clamp {
    mpm_held *held;                    /* by body, then in the order of the particles              */
    uint32_t *node;                    /* [held][MPM_FELT]                                         */
    float *weight;                     /* the same                                                 */
    double (*place[3])[3];             /* [held] m, of bodies that deform: at rest, now, after the step */
    int64_t count, room;
    int64_t *first;                    /* [bodies + 1] where those of a body begin                 */
    int bodies;
    double (*velocity)[6];             /* [bodies] m/s, rad/s: of those that move by forces, after the step */
    double longest;                    /* s, step that the material allows at rest: the caller's to set */
    double work;                       /* J, of the bodies on the solids in the last step          */
} mpm_clamp;

/* The field `clamp` of particles: x, y, z in the axes of the body that holds it, about its centre of mass, of
   one that deforms at rest, m; w: 0 = none does, else 1 + its number, negative where it lies inside. */

/* The body whose clamp holds particle i, -1: none. */
int mpm_clamp_body(const tobi_system *s, int64_t i);
/* 1 if it is held and lies inside that body. */
int mpm_clamp_hides(const tobi_system *s, int64_t i);
/* For a new particle, whose body stands where it starts: whether it is held, and where. */
void mpm_clamp_place(const tobi_system *s, int64_t i);
/* Then, for one that a body holds which deforms: its place at rest, that the motion takes to where it starts;
   *stray: how far from there, m. A motion is asked by one thread at a time. */
tobi_status mpm_clamp_find_rest(const tobi_system *s, int64_t i, double *stray, tobi_error *err);
/* In every step, before contact: impulses to nodes and bodies. fresh: 1 if particles were sorted. */
tobi_status mpm_clamp_hold(mpm_clamp *c, tobi_system *s, const mpm_grid *g, const mpm_view *v, int fresh,
                           tobi_error *err);
/* The velocities of a body that moves by forces after mpm_clamp_hold; 0: it has no held particles. */
int mpm_clamp_velocity(const mpm_clamp *c, int body, double velocity[3], double spin[3]);
void mpm_clamp_free(mpm_clamp *c);

/* What a body is made of and how it would float, before a run. */
#ifndef TOBIUO_MATTER_H
#define TOBIUO_MATTER_H
#include "tobiuo/tobiuo.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A body as it starts. From draught on 0 where it does not float upright in the only liquid of the world, or
   that is not known: for vessels, bodies that deform, hold a solid, have a hinge, a guide or a joint, or a
   mesh with parts that overlap. */
typedef struct tobi_body_matter {
    int dynamics;                 /* tobi_dynamics                                                    */
    int solids;                   /* that are clamped to it; the rest is of the body alone            */
    double mass, volume;          /* kg, m3; in 2-D per metre of depth                                */
    double centre[3];             /* m, of its mass                                                   */
    double inertia[9];            /* kg m2 about the centre                                           */
    double liquid;                /* kg/m3, of the only liquid; 0: there is none, or several          */
    double draught;               /* m, from its lowest place to the level                            */
    double metacentre[3];         /* m, metacentric height for small turns about each axis            */
} tobi_body_matter;

/* TOBI_NOT_FOUND past the end. */
TOBI_API tobi_status tobi_world_body_matter(const tobi_world *world, int body, tobi_body_matter *matter);

#ifdef __cplusplus
}
#endif
#endif

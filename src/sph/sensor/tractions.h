/* What the fluid does to a place on a body's surface: the terms of the body's force, per area. */
#pragma once
#include "core/body.h"
#include "core/system.h"

/* A place on a body, m from the box's lower corner; a step's forces as its particles now stand. */
typedef struct sph_place {
    double x[3], normal[3];     /* out of the body, unit                                        */
    double velocity[3];         /* m/s                                                          */
    int64_t point;              /* the quadrature point that it belongs to                      */
} sph_place;

/* Pressure, Pa, and shear of no-slip bodies, Pa, on the body there. After a refresh. Per area, they add up to
   the body's forces but for what the text of docs/decisions/0053 names. */
void sph_surface_look(const tobi_system *s, const tobi_body *b, const sph_place *place, double *pressure,
                      double shear[3]);

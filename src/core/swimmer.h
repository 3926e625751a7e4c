/* Free swimmers: bodies whose shape a motion prescribes while forces move their centre and attitude
   (docs/swimmers.md, docs/decisions/0069-swimmers.md). */
#pragma once
#include "base/error.h"
#include <stdint.h>

struct tobi_body;

/* What a swimmer has besides a free body. Axes of the motion are those in which it gives the shape. */
typedef struct tobi_swimmer {
    int64_t count;                   /* of mass points                                             */
    double (*rest)[3];               /* m, at rest, world coordinates                              */
    double *mass;                    /* kg, of either sign                                         */
    double (*now)[3], (*next)[3];    /* m, about the centre of mass, in the motion's axes: at both ends
                                        of the step                                                */
    double centre[3], next_centre[3];    /* m: their centre of mass, in the motion's coordinates   */
    double next_inertia[9], next_inverse[9];    /* as of tobi_rigid, at the end of the step        */
    double (*shape)[3];              /* [vertices] m, in the motion's coordinates, end of the step */
    double (*flow)[3];               /* [vertices] m/s, world axes, mean over the step: what is left of
                                        the velocity without momentum and angular momentum         */
    double (*point_flow)[3];         /* [quadrature points] the same                               */
    double still[3][3];              /* what turns the motion's axes to the world's at the end of the step,
                                        where the body has no momentum                             */
    double steer[3], next_steer[3];  /* of the present shape; of the next, by the control program  */
    struct { double centre[3], position[3], orientation[4], steer[3]; } start;      /* when the step began */
    double least_inertia;            /* kg m2: less is that of no body                             */
    int dimension;
} tobi_swimmer;

/* Makes a free body with a motion a swimmer: mass points, and centre and inertia of the shape at time 0. The
   body has its mesh, its mass and its arrays. TOBI_INVALID in words for a shape without inside. */
tobi_status tobi_swimmer_create(struct tobi_body *b, int dimension, tobi_error *err);
void tobi_swimmer_free(tobi_swimmer *w);
/* The shape at t + dt by next_steer, flow over the step, and the moments between both shapes, which the drift
   reads. Changes nothing that a failed step would have to take back. */
tobi_status tobi_swimmer_predict(struct tobi_body *b, double t, double dt, tobi_error *err);
/* Then: where points of the body, in the coordinates of its motion at rest, would be at t, the end of the
   step, if it had no momentum; in world coordinates. */
tobi_status tobi_swimmer_carry(const struct tobi_body *b, double t, int64_t n, const double (*rest)[3],
                               double (*out)[3], tobi_error *err);
/* Makes the shape at the end of the step the present one, with its inertia and angular velocity. */
void tobi_swimmer_advance(struct tobi_body *b);
/* For checkpoints: rows of three doubles, count + TOBI_SWIMMER_MORE of them, that hold the present shape. */
enum { TOBI_SWIMMER_MORE = 3 };
void tobi_swimmer_save(const tobi_swimmer *w, double (*rows)[3]);
/* Takes back what tobi_swimmer_inertia has found good. */
void tobi_swimmer_restore(struct tobi_body *b, const double (*rows)[3]);
/* Inertia of the mass points about their centre, kg m2, and in 3-D its inverse; 0 if no body has it. */
int tobi_swimmer_inertia(const tobi_swimmer *w, const double (*at)[3], double inertia[9], double inverse[9]);

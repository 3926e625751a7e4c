/* Joints to the domain: a hinge lets a body turn about a fixed axis, a guide lets it slide along one. One
   coordinate is left, q: the angle or the way from the start. docs/decisions/0071-hinges-and-guides.md,
   docs/theory/rigid.md, "Joints". */
#pragma once
#include "base/error.h"
#include "tobiuo/types.h"

struct tobi_rigid;

typedef enum tobi_joint_kind { TOBI_JOINT_NONE, TOBI_JOINT_HINGE, TOBI_JOINT_GUIDE } tobi_joint_kind;

typedef struct tobi_joint {
    int kind;                        /* tobi_joint_kind                                                  */
    double axis[3];                  /* of length 1                                                      */
    double point[3];                 /* m from the domain's lower corner: on the axis, or the centre at the
                                        start                                                            */
    double arm[3];                   /* m, from the point to the centre, at the start                    */
    double mass;                     /* kg m2 about the axis, or kg                                      */
    double lower, upper;             /* rad or m: stops; both 0 = none                                   */
    double stiffness, damping;       /* N m/rad and N m s/rad, or N/m and N s/m                          */

    /* Within a step: */
    double freedom[6];               /* S at the pose that the drift began at                            */
    double pull;                     /* rad/s2 or m/s2: of the pull there                                */
    int held;                        /* 1: contact answers the pull                                      */
    int driven;                      /* 1: a liquid has set the drift                                    */
    int pulled;                      /* 1: a motor is to turn it, off a stop, too                        */
    double rate;                     /* rad/s or m/s, where the drift began                              */
    double before[3];                /* m: the centre where the drift began                              */
    double momentum[6];              /* kg m/s, kg m2/s about the point, where the drift began           */
    double other[6];                 /* N s, N m s about the point: of all but the bearing, in this step */
    double stopped, damped;          /* N m s or N s along q: of the stop, against the damper, in this step */
    tobi_joint_info info;            /* of the bearing and its stop                                      */
} tobi_joint;

/* From a definition with a hinge or a guide; after mass and inertia. lower: corner of the domain, m. */
tobi_status tobi_joint_init(struct tobi_rigid *r, const tobi_body_def *def, const double lower[3],
                            int dimension, tobi_error *err);

/* S: velocity and angular velocity (rest of the body's six) for a rate of 1, at the present pose. */
void tobi_joint_span(const struct tobi_rigid *r, double S[6]);
/* S over the root of the mass, so that M^-1 = s s^T; zero at a stop that the body rests on, and without a
   joint. */
void tobi_joint_freedom(const struct tobi_rigid *r, double s[6]);
/* q, rad between -pi and pi, or m. */
double tobi_joint_position(const struct tobi_rigid *r);
/* rad/s or m/s, from the velocities; and these from it, at the present pose. */
double tobi_joint_rate(const struct tobi_rigid *r);
void tobi_joint_set_rate(struct tobi_rigid *r, double rate);
/* The next pose, so far along from the present one, within the stops. */
void tobi_joint_place(struct tobi_rigid *r, double way);
/* q'' by the pull of the body and the spring, at the present pose. */
double tobi_joint_pull(const struct tobi_rigid *r);
/* Adds force and torque of the spring. */
void tobi_joint_add_spring(const struct tobi_rigid *r, double load[6]);
/* By drifting dt at the rate that the pull makes. */
void tobi_joint_drift(struct tobi_rigid *r, double dt);
/* The kick of a body after its drift: impulse and twist (N s, N m s about the centre) came where the drift
   began, `damped` (N, N m) acts here. */
void tobi_joint_kick(struct tobi_rigid *r, double dt, const double impulse[6], const double damped[6]);
/* Stops: a body that runs into one bounces by its restitution, or rests if it is slower than `bounce` times
   its pull. impulse: what contact gave a body that rested, N s and N m s. */
void tobi_joint_stop(struct tobi_rigid *r, double dt, double bounce, const double impulse[6]);

/* joint_load.c, the load of the bearing by what else acts: where the drift begins. */
void tobi_joint_load_open(struct tobi_rigid *r);
/* Before the kick, with the pull of the step before. */
void tobi_joint_load_begin(struct tobi_rigid *r, double dt);
/* As tobi_joint_kick, which calls it. */
void tobi_joint_load_kick(struct tobi_rigid *r, double dt, const double impulse[6], const double damped[6]);
/* Impulse and twist about the centre (N s, N m s) of contact and joints to other bodies, after the kick. */
void tobi_joint_load_add(struct tobi_rigid *r, const double impulse[6]);
/* After the step, dt long, s; 0: the load is not known. */
void tobi_joint_report(struct tobi_rigid *r, double dt);

/* J: of its spring. */
double tobi_joint_energy(const struct tobi_rigid *r);
/* s: a third of a radian of the spring's swing; INFINITY without. */
double tobi_joint_step_limit(const struct tobi_rigid *r);

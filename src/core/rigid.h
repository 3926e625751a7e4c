/* The state of a rigid body and how it drifts. Doubles throughout.

   The orientation is a unit quaternion w x y z that takes the rest pose's axes to the world's. The angular
   momentum is kept in world axes: without torque it is a constant, so that a spinning body keeps it to the
   last bit, and implicit midpoint in the body frame keeps the energy (docs/theory/rigid.md). */
#pragma once
#include "base/error.h"
#include "core/acceleration.h"
#include "core/joint.h"
#include "geom/massprops.h"
#include "tobiuo/types.h"

typedef struct tobi_rigid {
    int kind;                        /* tobi_dynamics                                                   */
    int locked;                      /* bits 0-2: shifts along x, y, z; bits 3-5: turns about them      */
    double mass;                     /* kg                                                              */
    double inertia[9], inverse[9];   /* kg m2 about the centre in rest axes, and its inverse            */
    double restitution, friction;    /* 1, against other bodies and sides                               */
    int yields;                      /* 1: no friction was given, that of the other body counts          */
    double air_resistance;           /* 1/s                                                             */
    double force[3], torque[3];      /* N, N m: constant, in world axes                                 */
    tobi_control_fn control;         /* of a controlled body                                            */
    void *control_user;
    double memory[TOBI_CONTROL_STATE];  /* numbers that it keeps, in checkpoints                        */
    tobi_joint joint;

    /* The state: TOBI_RIGID_DOUBLES doubles from here on, all that a restart needs. */
    double position[3];              /* m, centre of mass from the domain's lower corner                */
    double orientation[4];
    double velocity[3];              /* m/s; of a prescribed body the mean of the last step             */
    double angular_velocity[3];      /* rad/s                                                           */
    double momentum[3];              /* kg m2/s, angular, about the centre                              */
    double push[3], turn[3];         /* m, rad: takes out overlaps with the next drift, no momentum     */
    double impulse[3], twist[3];     /* N s, N m s about the centre: of particles in this step          */
    double contact_force[3], contact_torque[3];   /* N, N m: mean over the last step                    */
    double pull[3], pull_torque[3];  /* m/s2, N m: constant over the next drift; 0 where contact holds  */
    double contact_before[6];        /* N, N m: of contact with bodies and sides in the last step       */
    double held[6];                  /* N, N m: what was so in both of the last two steps               */
    double before[6];                /* m/s, rad/s: that a liquid was made to follow in the last step   */
    double phase, phase_start;       /* of the control program; s                                       */
    double cut;                      /* number of the cut that a blade is making, 0 = none              */
    double hold;                     /* bits like `locked`, asked for by the control program            */

    double next_position[3];         /* at the end of the step that is being made                       */
    double next_orientation[4];
    double inertial[6];              /* N, N m about the centre: of what acts besides gravity           */
    double given[6];                 /* N, N m about the centre: by force, torque and control program, in the
                                        last step                                                       */
    double air[6];                   /* N, N m about the centre: of air resistance in the last step     */
    double finer[6];                 /* N, N m about the centre: what a nest's liquid has more than the one
                                        here, in the last steps                                         */
    int finer_by;                    /* the number of that nest, from 1; 0 = none                       */
    int deforms;                     /* 1: a swimmer, which drifts by `moments`                         */
    double moments[3][3];            /* kg m2, rest axes: sum of m y0 y1^T, places about the centre at both
                                        ends of the step                                                */
    double span;                     /* s, over which `impulse` is the mean force; 0 = the step         */
    double constraint[6];            /* N s, N m s about the centre: of joints to other bodies, where the
                                        step began; core/constraint.h                                   */
    int is_corrected, is_clamped;    /* 1: by tobi_body_correct, a clamp in this step                   */

    /* Within the step of a liquid, sph/boundary/boundary.h: */
    double driven[6];                             /* m/s, rad/s: by tobi_body_set_velocity, last        */
    double predicted[3], predicted_spin[3];         /* m/s, rad/s: at the end of the step                 */
    double mobility[3], turn_mobility[3][3];      /* 1/kg, 1/(kg m2): velocities per impulse            */
    double joint_mobility[6];                     /* s of the joint, M^-1 = s s^T                       */
} tobi_rigid;

#define TOBI_RIGID_STATE(r) ((r)->position)
enum {
    TOBI_RIGID_DOUBLES = (int)((offsetof(tobi_rigid, next_position) - offsetof(tobi_rigid, position)) /
                               sizeof(double))
};

/* Mass, inertia, starting velocities from the definition and the mesh's integrals. Centre: the position at
   rest, from the domain's lower corner. TOBI_INVALID in words if the numbers make no body. */
tobi_status tobi_rigid_init(tobi_rigid *r, const tobi_body_def *def, const tobi_massprops *rest,
                            const double centre[3], int dimension, tobi_error *err);

/* Bits of a text of axes separated by commas: x, y, z, turn_x, turn_y, turn_z, shift, turn; -1 if a word
   is none of them, which is copied to unknown. */
int tobi_rigid_axes(const char *words, char unknown[32]);

/* The pose after dt under the pull and the air resistance, of second order and without air exact for the
   position, into next_position and next_orientation. The velocities are left to the kick. */
void tobi_rigid_drift(tobi_rigid *r, double dt);
/* The same by the present velocities alone. */
void tobi_rigid_drift_freely(tobi_rigid *r, double dt);
/* The same by other velocities, m/s and rad/s. */
void tobi_rigid_drift_by(tobi_rigid *r, const double velocity[3], const double spin[3], double dt);

/* Inverse of mass times the unit matrix, as a diagonal, and of inertia in world axes at the present
   orientation; locked degrees of freedom give 0. Those of a body with a joint are 0, tobi_joint_freedom has
   its own. */
void tobi_rigid_inverse(const tobi_rigid *r, double shift[3], double turn[3][3]);
/* What is kept of a velocity over dt by air and the damper of a joint, 1. */
double tobi_rigid_keep(const tobi_rigid *r, double dt);
/* Velocities by an impulse f, N s and N m s about the centre, by the mobility that a liquid works with. */
void tobi_rigid_answer(const tobi_rigid *r, const double f[6], double out[6]);
/* Whether it has a pull; and drops it, with the same answer. */
int tobi_rigid_has_pull(const tobi_rigid *r);
int tobi_rigid_drop_pull(tobi_rigid *r);
/* Drops what locked degrees of freedom do not allow; brings angular_velocity up to date. */
void tobi_rigid_apply_locks(tobi_rigid *r);
/* J, of velocity and angular velocity; against fixed walls and bodies nobody else has it. */
double tobi_rigid_kinetic_energy(const tobi_rigid *r);

/* Coulomb friction of two bodies, 1. */
double tobi_rigid_friction(const tobi_rigid *a, const tobi_rigid *b);

/* Finds `inertial`: force and torque of the field over the body's mass, at its present velocities. */
void tobi_rigid_feel(tobi_rigid *r, const tobi_acceleration *field);

/* The inverse of a 3 x 3 matrix; 0 if its determinant is not positive. */
int tobi_rigid_invert(const double m[9], double out[9]);
void tobi_quaternion_matrix(const double q[4], double m[3][3]);
/* From a's rest axes to b's: x in a is turn x + shift in b, shift in m. */
void tobi_rigid_between(const tobi_rigid *a, const tobi_rigid *b, double turn[3][3], double shift[3]);
void tobi_quaternion_product(const double p[4], const double q[4], double out[4]);
/* Turns q by the rotation vector w (rad, world axes), for small w; unit length again after. */
void tobi_quaternion_turn(double q[4], const double w[3]);

/* Joints between two bodies, or of a body and the domain, as constraints: rows of a matrix J. With W, the
   inverse mass and inertia of the bodies, impulses l = -(J W J^T)^-1 (J v - pace) make velocities obey.
   docs/decisions/0074-joints-between-bodies.md, docs/theory/rigid.md, "Joints between bodies". */
#pragma once
#include "core/body.h"

enum { TOBI_CONSTRAINT_ROWS = 7 };       /* of a hinge in 3-D with stops and a motor                    */
enum { TOBI_BETWEEN_MOTOR = 4 };         /* besides tobi_joint_between: the motor of a body's own joint  */

/* What a motor is told: nothing, how fast, how far, how strong. */
typedef enum tobi_motor_kind {
    TOBI_MOTOR_NONE, TOBI_MOTOR_SPEED, TOBI_MOTOR_ANGLE, TOBI_MOTOR_TORQUE
} tobi_motor_kind;

/* The motor of a hinge: a row about its axis whose impulse is bounded, or a torque (core/motor.c). Of a guide
   a row along it, and a force; then rad is m, and N m is N. */
typedef struct tobi_motor {
    int kind;                            /* tobi_motor_kind                                             */
    double most;                         /* N m, INFINITY: no bound                                     */
    double before, value;                /* rad/s, rad, N m: asked for when the step begins and ends     */
    double rate, goal;                   /* rad/s, rad: what it tries in the step                       */
    double impulse;                      /* N m s about the axis on the body, in this step              */
    double guess[3];                     /* N m on the body, where a liquid's step begins: of a torque, or
                                            of a motor at its bound                                     */
    double known;                        /* N m s, of its row, before a liquid's pressure                */
    int over;                            /* 1, -1: the pressure of this step has shown that it is at its
                                            bound                                                       */
    int is_set;                          /* 1: a control program tells it: `set` from the next step on   */
    double set, last;                    /* that, and `value` of the last step that was made             */
} tobi_motor;

/* A row: the change of one number by velocity and angular velocity of both bodies. */
typedef struct tobi_constraint_row {
    double axis[3];                      /* of length 1                                                 */
    int turns;                           /* 1: about the axis, 0: along it                              */
    int stop;                            /* 1: of the stops of a hinge or slide                         */
    int motor;                           /* 1: of a motor by speed or angle, -1: by torque, never a row */
    int active;                          /* of a stop: -1 at the lower, 1 at the upper; of a motor: 1;
                                            0: no row now                                               */
    int released;                        /* 1: it has let go in the round at hand                       */
    int slot[2];                         /* of the bodies, -1: none that moves by forces                */
    double jacobian[2][6], answer[2][6]; /* J and W J^T                                                 */
    double pace;                         /* m/s, rad/s: what the motion of the other side asks for      */
    double gap;                          /* m, rad, of the next pose                                    */
    double most, taken;                  /* N m s, of a motor: bound of its impulse in the step, and what it
                                            gave in earlier stages of it                                */
    double mobility;                     /* 1/(kg m2), of a motor: how fast its torque turns the hinge   */
    int first;                           /* first column of this row of the factor that is not 0        */
    double inverse;                      /* of the factor's diagonal; 0: others determine this row      */
} tobi_constraint_row;

typedef struct tobi_constraint {
    char name[64];
    int kind;                            /* tobi_joint_between                                          */
    int body[2];                         /* that is joined, and to which; -1: the domain                */
    double point[2][3], axis[2][3];      /* m, in rest axes about the bodies' centres; of the domain from
                                            its lower corner                                            */
    double way[3];                       /* of a slide: its axis, in rest axes of the other side. Then `axis`
                                            is that which the bodies would turn about                   */
    int slides;                          /* 1: a slide, or the motor of a guide: then rad is m, N m is N */
    double lower, upper;                 /* rad: stops; both 0 = none                                   */
    double stiffness, rest, damping;     /* N m/rad, rad, N m s/rad, about the axis                     */
    double load[2][6], before[2][6], damped[2][6];       /* N, N m about the centre, on each side: of spring
                                            and torque, now and a step before, and of the damper        */
    double arm[2][3];                    /* m, of a slide: from the centres to the place of the body where
                                            the step begins                                             */
    double start[4];                     /* how the body is turned against the other at the start       */
    double next_point[3], next_axis[3], next_turn[4];   /* at the end of the step, of a body that is
                                            prescribed: place, axis, orientation                        */
    double spin[3], velocity[3];         /* rad/s, m/s, of such a body in the step, and of its place    */
    double impulse[6];                   /* N s, N m s at the joint: on the body, in this step          */
    tobi_motor motor;
    double rate_before;                  /* rad/s, when the step began                                  */
    tobi_joint_info info;
} tobi_constraint;

typedef struct tobi_constraints {
    tobi_constraint *at;
    int count, dimension;
    int *body;                           /* [slots] bodies that joints hold and forces move             */
    int slots;
    double (*inverse)[6][6];             /* [slots] W                                                   */
    double (*speed)[6];                  /* [slots] m/s, rad/s: what is projected                       */
    tobi_constraint_row *row;
    int rows;
    double *factor;                      /* [rows][rows] of J W J^T, lower triangle                     */
    double *impulse, *change;            /* [rows] N s, N m s                                           */
    double reach;                        /* m, to compare gaps with                                     */
    double dt;                           /* s, of the step at hand; 0: none yet                         */
    int driven;                          /* 1: a liquid has set the drift of this step, by
                                            tobi_rigid.predicted                                        */
} tobi_constraints;

/* Takes constraints whose names, kinds, bodies, points and axes are given, over; then `at` is the list's. */
tobi_status tobi_constraints_start(tobi_constraints *c, const tobi_body *bodies, int dimension,
                                   tobi_error *err);
void tobi_constraints_free(tobi_constraints *c);
/* Whether a joint holds both bodies: then they do not touch each other. */
int tobi_constraints_join(const tobi_constraints *c, int a, int b);

/* Of a body, -1: no joint holds it, or no force moves it. */
int tobi_constraints_slot(const tobi_constraints *c, int body);

/* Where one side of a joint is, m from the domain's lower corner, and its axis; next: at the next pose. */
void tobi_constraint_end(const tobi_constraint *j, int side, const tobi_body *bodies, int next,
                         double point[3], double axis[3]);
/* joint_rows.c: the way of a slide, likewise; what parts both places, m, of a slide across its way. */
void tobi_constraint_way(const tobi_constraint *j, const tobi_body *bodies, int next, double way[3]);
void tobi_constraint_part(const tobi_constraint *j, const tobi_body *bodies, int next, double apart[3]);
/* How many rows a joint has; that of its motor, before that of its stops, NULL: none. */
int tobi_constraint_row_count(const tobi_constraints *c, const tobi_constraint *j);
tobi_constraint_row *tobi_constraint_motor_row(const tobi_constraints *c, const tobi_constraint *j,
                                               tobi_constraint_row *row);
/* J at the present pose; gaps at the next one. */
void tobi_constraint_make_rows(const tobi_constraints *c, const tobi_constraint *j, const tobi_body *bodies,
                               tobi_constraint_row *row);
void tobi_constraint_find_gap(const tobi_constraints *c, const tobi_constraint *j, const tobi_body *bodies,
                              tobi_constraint_row *row);
/* Where a motor and the motion of a prescribed body take a joint in a step from t on, and how fast that opens
   it; of a slide anew for rows at another pose, whose axis has turned. */
tobi_status tobi_constraint_set_pace(const tobi_constraints *c, tobi_constraint *j, const tobi_body *bodies,
                                     double t, double dt, tobi_constraint_row *row, tobi_error *err);
void tobi_constraint_turn_pace(const tobi_constraints *c, const tobi_constraint *j, const tobi_body *bodies,
                               tobi_constraint_row *row);
/* joint_angle.c: of the body against the other since the start, rad, -pi to pi; next: at the next pose. */
double tobi_constraint_angle(const tobi_constraint *j, const tobi_body *bodies, int next);
/* joint_motion.c: where a prescribed body takes its side of the joint in a step of dt from t on; arm: m, of
   the place that shows the axis. */
tobi_status tobi_constraint_follow(tobi_constraint *j, const tobi_body *bodies, double arm, double t,
                                   double dt, tobi_error *err);
/* joint_angle.c: how fast the angle grows, rad/s, m/s. */
double tobi_constraint_rate(const tobi_constraint *j, const tobi_body *bodies);
/* -1, 1: at the lower or upper stop within rounding, in the present pose, or beyond it; else 0. */
int tobi_constraint_at_stop(const tobi_constraint *j, double angle);
/* The axis that spring, motor and stops act about or along, at the present pose. */
void tobi_constraint_axis(const tobi_constraint *j, const tobi_body *bodies, double axis[3]);
/* Of a guide or slide m, of others that angle. */
double tobi_constraint_place(const tobi_constraint *j, const tobi_body *bodies, int next);
/* Torques of springs and dampers at the present poses; those of the last call become `before`. */
void tobi_constraints_update_springs(tobi_constraints *c, const tobi_body *bodies);
/* J: of its spring. */
double tobi_constraint_energy(const tobi_constraint *j, const tobi_body *bodies);
/* Adds to force and torque on a body: `now` of the springs, `before` of them a step ago, `damped` of
   dampers. */
void tobi_constraints_add_springs(const tobi_constraints *c, int body, double now, double before,
                                  double damped, double force[3], double torque[3]);
/* motor.c: where a step of dt begins, before W is taken. */
void tobi_motors_begin(tobi_constraints *c, tobi_body *bodies, double dt);
/* What a motor tries in it, with the mobility of its row. */
void tobi_motor_aim(tobi_constraint *j, const tobi_body *bodies, double dt, double mobility);
/* Adds to force and torque on a body what motors at their bound, and those by torque, give in this step. */
void tobi_motors_add_guess(const tobi_constraints *c, int body, double load[6]);
/* How far the next pose is from that, rad, m. */
double tobi_motor_gap(const tobi_constraint *j, const tobi_body *bodies);
/* Whether the hinge does what the motor was told when the step began. */
int tobi_motor_follows(const tobi_constraint *j, const tobi_body *bodies);
/* Sets the bound of a row, of a share of the step. */
void tobi_motor_bound(const tobi_constraints *c, const tobi_constraint *j, tobi_constraint_row *row,
                      double share);
/* Whether the impulse of a row is beyond its bound: then it is brought there, and the row is no row. */
int tobi_motor_limit(tobi_constraints *c, int row);
/* Whether a row that is none has an impulse within its bound, or wants one: then it is a row again. */
int tobi_motor_engage(const tobi_constraints *c, tobi_constraint_row *row, double impulse);
/* For liquids that may solve for their pressure again. Keeps the impulses of rows as `known`, N s, N m s. */
void tobi_motors_know(tobi_constraints *c);
/* Whether there are motors by speed or angle with a bound. */
int tobi_motors_bounded(const tobi_constraints *c);
/* With those of the pressure in `impulse`, N, N m: whether motors are beyond their bound, which then are
   `over` and act at it. */
int tobi_motors_overrun(tobi_constraints *c, double dt);
/* N m or N, and W that damper and motor take from the bodies, after a step of dt; 0: not known. */
void tobi_motor_report(tobi_constraint *j, const tobi_body *bodies, double dt);

/* s: a third of a radian of the fastest swing that springs and dampers make; INFINITY: none. */
double tobi_constraints_step_limit(const tobi_constraints *c, const tobi_body *bodies);

/* W of a body as it is: its velocities by an impulse, without joints to other bodies. */
void tobi_constraint_inverse(const tobi_rigid *r, double w[6][6]);
/* W of all bodies. */
void tobi_constraints_take_inverse(tobi_constraints *c, const tobi_body *bodies);
/* J at the present pose and the factor of J W J^T, for W in `inverse`. */
void tobi_constraints_factor(tobi_constraints *c, const tobi_body *bodies);
/* Makes `speed` obey; impulses are added to `impulse`. moving: 0 for accelerations, that bodies with a motion
   do not have in this step. */
void tobi_constraints_project(tobi_constraints *c, int moving);
/* The same for velocities, with the stops that bodies run into; those that would pull are let go. */
void tobi_constraints_obey(tobi_constraints *c, const tobi_body *bodies);
/* Adds `change` to an impulse, c->change[row], with what it does to `speed`. */
void tobi_constraints_change(tobi_constraints *c, int row, double change);
/* Adds J^T impulse to f, N s and N m s about the centre of the body in a slot. */
void tobi_constraints_add_load(const tobi_constraints *c, int slot, double f[6]);

/* After all bodies were predicted from t to t + dt: joints are closed at the next pose, too; the impulses for
   that are in tobi_rigid.constraint. */
tobi_status tobi_constraints_close(tobi_constraints *c, tobi_body *bodies, double t, double dt,
                                   tobi_error *err);
/* The same where a liquid lets them drift by velocities of its own, in `speed`, which then obey; after
   tobi_constraints_factor. */
void tobi_constraints_drive(tobi_constraints *c, tobi_body *bodies, double dt);

/* constraint_press.c, after the liquid. The velocities of a joined body before a solid presses it, by what is
   known so far, m/s, rad/s; 0: no joint holds it, and velocity stays as it is. */
int tobi_constraints_expect(tobi_constraints *c, const tobi_body *bodies, int body, double dt,
                            double velocity[6]);
/* The block of P W of a body (R.25); W of one that no joint holds. */
void tobi_constraints_inverse(tobi_constraints *c, const tobi_body *bodies, int body, double w[6][6]);
/* After the systems: where solids have corrected the drift of a joined body, all joined ones drift by what is
   known, closed. */
void tobi_constraints_settle(tobi_constraints *c, tobi_body *bodies, double dt);

/* What contact holds on one side of a joint drifts without the pull on the other side, too. */
void tobi_constraints_hold(const tobi_constraints *c, tobi_body *bodies);
/* Adds the impulses of the last projections to what the joints did in this step. */
void tobi_constraints_count(tobi_constraints *c);
/* Force, moment, angle and gap after a step of dt, s; 0: force and moment are not known. */
void tobi_constraints_report(tobi_constraints *c, const tobi_body *bodies, double dt);

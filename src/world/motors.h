/* What the motors of hinges and guides are told in the course of time. */
#pragma once
#include "io/store.h"
#include "world/world.h"

/* Takes a motor of joint `joint` (of sim.constraints), or with joint -1 of the hinge of a body, with slides 1
   of its guide; slides 2: the joint is a slide; one that is not given is none. key: of the motor in the
   definition of that. */
tobi_status tobi_motors_add(tobi_world *w, const tobi_motor_def *def, const char *key, int slides, int joint,
                            int body, tobi_error *err);
/* At the start: the motors of bodies' own joints become constraints, behind the joints; all are told what
   the time 0 asks for. */
tobi_status tobi_motors_start(tobi_world *w, tobi_error *err);
/* Then: notes on motors that set a body off in one step. */
tobi_status tobi_motors_note(tobi_world *w, tobi_error *err);
/* What a step of dt from t on is to begin and to end with. */
tobi_status tobi_motors_tell(tobi_world *w, double t, double dt, tobi_error *err);
/* The motor of a body's own joint, NULL if there is none. */
const tobi_constraint *tobi_motors_of_body(const tobi_world *w, int body);
/* Joints between bodies: constraints without motors of bodies' own. */
int tobi_motors_joint_count(const tobi_world *w);
void tobi_motors_free(tobi_world *w);

/* What control programs have told motors, for checkpoints. *rows: of all motors, owned by the caller. */
enum { TOBI_MOTOR_DOUBLES = 3 };
tobi_status tobi_motors_put(const tobi_world *w, tobi_store *f, tobi_error *err);
tobi_status tobi_motors_read(const tobi_world *w, tobi_store *f, double (**rows)[TOBI_MOTOR_DOUBLES],
                             tobi_error *err);
void tobi_motors_take(tobi_world *w, const double (*rows)[TOBI_MOTOR_DOUBLES]);

/* Bodies that move by forces. Each step of the world, the method lets them drift (tobi_body_predict and
   tobi_body_advance) and gathers what particles do to them; then tobi_rigid_step changes their velocities:
   gravity, particles, constant forces, control programs, air resistance, contact. */
#pragma once
#include "rigid/lines.h"
#include "rigid/solve.h"

/* The surroundings of a step. */
typedef struct tobi_rigid_world {
    double gravity[3];           /* m/s2                                                        */
    double size[3];              /* m, of the domain; its sides are at 0 and size               */
    int dimension;
    int wall[3];                 /* sides along this axis: 1 the lower, 2 the upper, 3 both     */
    const tobi_fixed_plane *planes;   /* owned by the caller, must outlive the state             */
    int plane_count;
    tobi_line *lines;            /* owned by the caller, must outlive the state                 */
    int line_count;
    tobi_constraints *constraints;    /* joints between bodies, the caller's                    */
    int threads;                 /* that look for contacts; they do not change the result       */
} tobi_rigid_world;

typedef struct tobi_dynamics_state tobi_dynamics_state;

/* Prepares the bodies' surfaces for contact, once. notes (room bytes) receives a line for what is odd,
   beginning with a body's name: bodies that overlap, that nothing can touch, that are taken for balls. The
   caller owns *out; the array of bodies must stay where it is. */
tobi_status tobi_rigid_start(tobi_body *bodies, int count, const tobi_rigid_world *world, char *notes,
                             size_t room, tobi_dynamics_state **out, tobi_error *err);
void tobi_rigid_free(tobi_dynamics_state *state);

/* The kick at time t after a drift over dt. TOBI_SCRIPT when a control program fails, TOBI_DIVERGED when a
   velocity is no number. */
tobi_status tobi_rigid_step(tobi_dynamics_state *state, double t, double dt, tobi_error *err);

/* Between steps: gravity, m/s2, or a body's constant force and torque, N, N m, from the next drift on. What
   contact holds drifts by its velocities still, once. */
void tobi_rigid_set_gravity(tobi_dynamics_state *state, const double gravity[3]);
void tobi_rigid_set_force(tobi_dynamics_state *state, int body, const double force[3],
                          const double torque[3]);
/* What a nest's liquid presses the body with more than the liquid here: force and torque about the centre. */
void tobi_rigid_set_finer(tobi_dynamics_state *state, int body, const double finer[6]);
/* The same gravity where the state is a checkpoint's, whose pull is of it already. */
void tobi_rigid_restore_gravity(tobi_dynamics_state *state, const double gravity[3]);

/* Loads of the lines and surfaces that deform where the bodies are, after a checkpoint has placed them. */
void tobi_rigid_follow(tobi_dynamics_state *state);

/* s: 1/60, or more where all bodies are large, but a step in which gravity does little to the smallest body
   that moves and the fastest turns by half a radian, less where bodies are thin or their shape changes:
   contact looks ahead along straight lines. */
double tobi_rigid_step_limit(const tobi_dynamics_state *state);

/* Contacts of the last step that carried a force, and the sweeps of the solver. */
void tobi_rigid_count(const tobi_dynamics_state *state, int64_t *touching, int *sweeps);

/* The impulses that the next step starts from, for checkpoints: rows of TOBI_WARM doubles, their number is
   returned. rows may be NULL. */
enum { TOBI_WARM = 8 };
int64_t tobi_rigid_warm(const tobi_dynamics_state *state, double *rows);
/* Takes them back; rows that name no body are TOBI_DAMAGED, and none is taken. */
tobi_status tobi_rigid_set_warm(tobi_dynamics_state *state, int64_t count, const double *rows,
                                tobi_error *err);

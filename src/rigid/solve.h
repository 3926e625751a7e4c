/* Sequential impulses: the impulses of all contacts of one step, restitution and Coulomb friction included,
   each pair of them equal and opposite at one point. Overlaps are taken out by small displacements that
   leave no momentum behind. docs/theory/rigid.md, R.6 to R.10. */
#pragma once
#include "core/constraint.h"
#include "rigid/touch.h"

typedef struct tobi_solve_row tobi_solve_row;
typedef struct tobi_solve_body tobi_solve_body;

/* Scratch of the solver; grows when needed. */
typedef struct tobi_solver {
    tobi_solve_row *rows;
    tobi_solve_body *bodies;
    int64_t row_capacity, body_capacity;
    tobi_constraints *joints;    /* the caller's, in this call */
    const tobi_body *owners;     /* the same: the bodies       */
    int sweeps;                  /* of the last step */
} tobi_solver;

/* Changes velocities, momenta, push and turn of the bodies and the impulses of the contacts, which hold
   those of the step before on entry. Joints hold before, after and between the sweeps. bounce: m/s, slower
   approaches are plastic. */
tobi_status tobi_solve(tobi_solver *s, tobi_body *bodies, int body_count, tobi_touch_list *contacts,
                       tobi_constraints *joints, double dt, double bounce, tobi_error *err);
/* Makes velocities and momenta obey the joints alone. */
void tobi_solve_joints(tobi_body *bodies, tobi_constraints *joints);
void tobi_solver_free(tobi_solver *s);

/* Joined bodies that solids press: how they answer through their joints, and how all of them drift by what is
   known (docs/decisions/0089-joints-where-liquids-and-solids-are.md). Drawback: a body that is pressed first
   does not know what presses the next one. */
#include "core/constraint.h"
#include "geom/vec3.h"
#include <string.h>

/* Velocities by all that is known, without joints. Contact alone answers the pull of the step before, which
   the velocities have already; clamps answer that of this one, and bodies joined to clamped ones go along. */
static void take_known(tobi_constraints *c, const tobi_body *bodies, int touched, double dt)
{
    int clamped = 0;
    for (int k = 0; k < c->slots; k++) clamped |= bodies[c->body[k]].rigid.is_clamped;
    for (int k = 0; k < c->slots; k++) {
        const tobi_rigid *r = &bodies[c->body[k]].rigid;
        const int first = (r->is_corrected || c->body[k] == touched) && !r->is_clamped;
        const int driven = c->driven && !first, pulled = clamped && !c->driven && !first;
        double impulse[6], w[6][6];
        tobi_constraint_inverse(r, w);
        memcpy(c->speed[k], driven ? r->predicted : r->velocity, sizeof r->velocity);
        memcpy(c->speed[k] + 3, driven ? r->predicted_spin : r->angular_velocity, sizeof r->velocity);
        for (int a = 0; a < 3; a++) {
            impulse[a] = r->impulse[a] + (pulled ? dt*r->mass*r->pull[a] : 0);
            impulse[3 + a] = r->twist[a] + (pulled ? dt*r->pull_torque[a] : 0);
        }
        double load[6] = { 0 };
        if (!driven) tobi_motors_add_guess(c, c->body[k], load);
        for (int a = 0; a < 6; a++) impulse[a] += dt*load[a];
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < 6; j++) c->speed[k][i] += w[i][j]*impulse[j];
    }
}

int tobi_constraints_expect(tobi_constraints *c, const tobi_body *bodies, int body, double dt,
                            double velocity[6])
{
    const int slot = tobi_constraints_slot(c, body);
    if (slot < 0) return 0;
    take_known(c, bodies, body, dt);
    tobi_constraints_project(c, 1);
    memcpy(velocity, c->speed[slot], sizeof *c->speed);
    return 1;
}

void tobi_constraints_inverse(tobi_constraints *c, const tobi_body *bodies, int body, double w[6][6])
{
    const int slot = tobi_constraints_slot(c, body);
    tobi_constraint_inverse(&bodies[body].rigid, w);
    for (int j = 0; j < 6 && slot >= 0; j++) {
        memset(c->speed, 0, (size_t)c->slots*sizeof *c->speed);
        for (int i = 0; i < 6; i++) c->speed[slot][i] = w[i][j];
        tobi_constraints_project(c, 0);
        for (int i = 0; i < 6; i++) w[i][j] = c->speed[slot][i];
    }
}

void tobi_constraints_settle(tobi_constraints *c, tobi_body *bodies, double dt)
{
    int any = 0;
    for (int k = 0; k < c->slots; k++) any |= bodies[c->body[k]].rigid.is_corrected;
    if (!any) return;
    take_known(c, bodies, -1, dt);
    tobi_constraints_take_inverse(c, bodies);
    tobi_constraints_factor(c, bodies);
    tobi_constraints_drive(c, bodies, dt);
}

/* What bodies, springs and lines have of energy, and are given. An impulse J does the work J u on a free
   body, u the mean of its velocities before and after the step: then all impulses together give just the
   kinetic energy that it gains (R.27). Drawback: what a swimmer has in the motion of its parts against each
   other is left out. */
#include "world/energies.h"
#include "base/error.h"
#include "rigid/lines.h"
#include "world/world.h"

static tobi_body_energy find_energy(const tobi_world *w, const tobi_body *b)
{
    tobi_body_energy e = { .power = b->power[TOBI_BY_PARTICLES], .contact_power = b->power[TOBI_BY_CONTACT],
                           .motion_power = b->power[TOBI_BY_MOTION], .force_power = b->power[TOBI_BY_FORCE],
                           .air_power = b->power[TOBI_BY_AIR], .field_power = b->power[TOBI_BY_FIELD],
                           .nest_power = b->power[TOBI_BY_NEST] };
    if (b->rigid.kind == TOBI_PRESCRIBED) return e;
    e.kinetic = tobi_rigid_kinetic_energy(&b->rigid);
    for (int a = 0; a < w->sim.def.dimension; a++)
        e.potential -= b->rigid.mass*w->sim.def.gravity[a]*b->rigid.position[a];
    return e;
}

void tobi_energy_sum_bodies(const tobi_world *w, tobi_energy *sum)
{
    *sum = (tobi_energy){ 0 };
    for (int k = 0; k < w->sim.body_count; k++) {
        const tobi_body_energy e = find_energy(w, &w->sim.bodies[k]);
        sum->kinetic += e.kinetic;
        sum->potential += e.potential;
        sum->motion_power += e.motion_power;
        sum->force_power += e.force_power;
        sum->air_power += e.air_power;
        sum->field_power += e.field_power;
        sum->nest_power += e.nest_power;
    }
}

double tobi_energy_line_power(const tobi_world *w)
{
    double sum = 0;
    for (int k = 0; k < w->line_count; k++) sum += tobi_line_power(&w->lines[k], w->sim.bodies);
    return sum;
}

tobi_status tobi_world_body_energy(const tobi_world *w, int body, tobi_body_energy *energy)
{
    if (!w || !energy) return TOBI_INVALID;
    if (body < 0 || body >= w->sim.body_count) return TOBI_NOT_FOUND;
    *energy = find_energy(w, &w->sim.bodies[body]);
    return TOBI_OK;
}

tobi_status tobi_world_energy(const tobi_world *w, tobi_energy *energy)
{
    tobi_joint_info joint;
    if (!w || !energy) return TOBI_INVALID;
    const tobi_constraints *c = &w->sim.constraints;
    tobi_energy_sum_bodies(w, energy);
    for (int k = 0; k < w->sim.body_count; k++) energy->springs += tobi_joint_energy(&w->sim.bodies[k].rigid);
    for (int k = 0; k < c->count; k++) energy->springs += tobi_constraint_energy(&c->at[k], w->sim.bodies);
    for (int k = 0; k < w->line_count; k++) energy->springs += tobi_line_energy(&w->lines[k]);
    for (int k = 0; tobi_world_joint(w, k, &joint); k++) energy->joint_power += joint.power;
    energy->line_power = tobi_energy_line_power(w);
    for (int k = 0; k < w->sim.porous_count; k++) energy->porous_power += w->sim.porous[k].power;
    energy->buoyancy_power = w->sim.scalar_power;
    return TOBI_OK;
}
